// How geometry moves while the shutter is open. Its times run from 0, when the shutter opens, to 1, when it closes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/transform.h"
#include "core/vec.h"

namespace alhazen {

/// What something is at even steps of the shutter's time, the first at 0, the last at 1, linear in between. Empty where
/// it does not move, else of two poses at least.
template <class T>
using Track = std::vector<T>;

/// The most poses that traversal takes.
inline constexpr size_t kMostPoses = 129;

/// Between which two poses a time lies, and how far from the first to the second.
struct Moment {
  size_t before;
  float fraction;
};

/// In the floats that traversal uses for it, so that both see the same moment.
[[nodiscard]] inline Moment moment(size_t poses, float time) {
  const float steps = float(poses - 1), at = time * steps;
  const float before = std::clamp(std::floor(at), 0.0f, steps - 1);
  return {size_t(before), at - before};
}

[[nodiscard]] inline Vec3f mix(const Vec3f& a, const Vec3f& b, float f) { return a * (1 - f) + b * f; }
[[nodiscard]] inline Vec3d mix(const Vec3d& a, const Vec3d& b, float f) { return a * (1 - double(f)) + b * double(f); }
[[nodiscard]] inline Affine3d mix(const Affine3d& a, const Affine3d& b, float f) {
  return {mix(a.x, b.x, f), mix(a.y, b.y, f), mix(a.z, b.z, f), mix(a.origin, b.origin, f)};
}

/// `track`, which is not empty, at a time.
template <class T>
[[nodiscard]] T at_time(const Track<T>& track, float time) {
  const Moment m = moment(track.size(), time);
  return mix(track[m.before], track[m.before + 1], m.fraction);
}

/// What deforming changes of a TriangleMesh: arrays as long as there.
struct PartPose {
  std::vector<Vec3f> positions, normals;
  std::vector<Vec4f> tangents;
  std::vector<Vec3f> polygon_normals;
};

/// By part.
using MeshPose = std::vector<PartPose>;

/// Both lists are empty where nothing moves.
struct Motion {
  std::vector<Track<Affine3d>> places;  // by object: maps from its space to the world
  std::vector<Track<MeshPose>> meshes;  // by mesh, in its own space; the first pose is that of the mesh itself

  [[nodiscard]] bool empty() const { return places.empty() && meshes.empty(); }
};

}  // namespace alhazen
