// Rays on their way to pixels, as rows: what Whitted's waves are made of.
#pragma once

#include <array>
#include <utility>

#include "accel/wave.h"
#include "renderer/camera_ray.h"
#include "renderer/media.h"

namespace alhazen {

/// What a ray is for. A `straight` ray continues the view of its camera ray through surfaces with alpha.
enum class RayKind : uint32_t { camera, mirror, refracted, straight };

[[nodiscard]] inline bool is_view(RayKind kind) { return kind == RayKind::camera || kind == RayKind::straight; }

/// How a path goes on from a hit.
enum class Bounce : uint8_t { straight, mirror, refracted };
inline constexpr size_t kBounces = 3;

/// What the ray that goes on is for. Straight on, a view stays one.
[[nodiscard]] inline RayKind kind_after(RayKind before, Bounce bounce) {
  switch (bounce) {
    case Bounce::straight:
      return is_view(before) ? RayKind::straight : before;
    case Bounce::mirror:
      return RayKind::mirror;
    case Bounce::refracted:
      return RayKind::refracted;
  }
  return before;
}

/// What a ray brings along: on whose behalf it is traced, and through what.
struct Path {
  uint32_t pixel = 0;  // index of the sample's pixel within the cell
  Rgb weight{1.0f};
  uint32_t depth = 0;
  RayKind kind = RayKind::camera;
  Media media{};        // around its origin
  Cone cone{};          // around it, as wide as its share of the picture
  float roughness = 0;  // of the surfaces that sent it here: how blurred it sees the environment
};

/// What is left of a ray's weight after a distance.
[[nodiscard]] inline Rgb arriving_weight(const Path& path, const std::vector<Material>& materials, float t) {
  return path.media.count > 0 ? path.weight * transmittance(path.media, materials, t) : path.weight;
}

/// The paths of a wave.
struct PathRows {
  Lanes<uint32_t> pixel, depth;
  Lanes<RayKind> kind;
  Lanes<float> red, green, blue;  // the weight
  Lanes<float> cone_width, cone_spread, roughness;
  Lanes<Media> media;  // may be shorter than the others: what is beyond its end is in no body

  [[nodiscard]] size_t size() const { return pixel.size(); }
  void resize(size_t n) {
    pixel.resize(n), depth.resize(n), kind.resize(n), red.resize(n), green.resize(n), blue.resize(n);
    cone_width.resize(n), cone_spread.resize(n), roughness.resize(n);
    if (media.size() > n) media.resize(n);
  }

  [[nodiscard]] Rgb weight(size_t i) const { return {red[i], green[i], blue[i]}; }
  [[nodiscard]] Media media_of(size_t i) const { return i < media.size() ? media[i] : Media{}; }
  void set_media(size_t i, const Media& m) {
    if (m.count == 0 && i >= media.size()) return;
    while (media.size() <= i) media.push({});
    media[i] = m;
  }

  [[nodiscard]] Path operator[](size_t i) const {
    return {pixel[i], weight(i), depth[i], kind[i], media_of(i), {cone_width[i], cone_spread[i]}, roughness[i]};
  }
  void push(const Path& path) {
    pixel.push(path.pixel), depth.push(path.depth), kind.push(path.kind);
    red.push(path.weight.r), green.push(path.weight.g), blue.push(path.weight.b);
    cone_width.push(path.cone.width), cone_spread.push(path.cone.spread), roughness.push(path.roughness);
    set_media(size() - 1, path.media);
  }
  /// The others' from `first` on.
  void append(const PathRows& other, size_t first) {
    for (size_t i = first; i < other.media.size(); ++i) set_media(size() + i - first, other.media[i]);
    pixel.append(other.pixel, first), depth.append(other.depth, first), kind.append(other.kind, first);
    red.append(other.red, first), green.append(other.green, first), blue.append(other.blue, first);
    cone_width.append(other.cone_width, first), cone_spread.append(other.cone_spread, first);
    roughness.append(other.roughness, first);
  }
};

/// A wave of rays on their way to pixels.
struct PathWave {
  RayWave rays;
  PathRows paths;

  [[nodiscard]] size_t size() const { return rays.size(); }
  void resize(size_t n) { rays.resize(n), paths.resize(n); }
  void push(const Rayf& ray, const Path& path) { rays.push(ray), paths.push(path); }
  void append(const PathWave& other, size_t first) { rays.append(other.rays, first), paths.append(other.paths, first); }
};

/// What a wave spawns, one wave for each bounce: neighbours' mirrored rays run together, as do their refracted ones,
/// but not the ones with the others.
struct SpawnedWaves {
  std::array<PathWave, kBounces> by_bounce;

  PathWave& operator[](Bounce bounce) { return by_bounce[size_t(bounce)]; }
  /// To the end of `pending`, in the order of bounces.
  void move_to(PathWave& pending) {
    for (PathWave& wave : by_bounce) {
      if (pending.size() == 0)
        std::swap(pending, wave);
      else if (wave.size() > 0)
        pending.append(wave, 0);
      wave.resize(0);
    }
  }
};

/// Shadow rays and what their pixels get of the light where nothing is in its way.
struct ShadowWave {
  RayWave rays;
  Lanes<uint32_t> pixel;
  Lanes<float> red, green, blue;
  Lanes<uint32_t> number;  // in the order of asking, for an observer; else of no elements

  [[nodiscard]] size_t size() const { return pixel.size(); }
  void clear() { rays.resize(0), pixel.resize(0), red.resize(0), green.resize(0), blue.resize(0), number.resize(0); }
  void append(const ShadowWave& other) {
    rays.append(other.rays), pixel.append(other.pixel), number.append(other.number);
    red.append(other.red), green.append(other.green), blue.append(other.blue);
  }
};

}  // namespace alhazen
