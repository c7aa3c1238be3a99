// From crossings to hits: those within a ray's range, parameters rounded once to float, doubts settled.
#pragma once

#include <vector>

#include "accel/line_map.h"
#include "accel/shape.h"
#include "accel/shapes/triangle.h"
#include "core/ray.h"

namespace alhazen {

struct ShapeHit {
  float t;        // in lengths of the ray's direction
  uint32_t face;  // which part of the surface, as the shape counts them
};

/// Where and how a shape stands in the world. The map and the shape must outlive it.
struct PlacedShape {
  LineMap<double> object_from_world;
  const Affine3d* world_from_object;
  const Shape* shape;
};

/// How often the calling thread's rays needed more than double.
struct DoubtCounts {
  uint64_t quad = 0, exact = 0;
};
[[nodiscard]] DoubtCounts& doubt_counts() noexcept;

/// Appends all hits with t_min <= t <= t_max, t as rounded to float, nearest first. Rays that are not finite, or
/// without direction, hit nothing.
///
/// accuracy  hit or miss, order and face are those of exact arithmetic on the given numbers; t is correctly rounded.
/// cost      double, then binary128 for the doubtful, then rational numbers for what is left: see `doubt_counts`.
void append_hits(const PlacedShape& placed, const Rayf& ray_world, std::vector<ShapeHit>& hits);

/// The same for a triangle in an object's space.
void append_hits(const Triangle& triangle, const LineMap<double>& object_from_world, const Affine3d& world_from_object,
                 const Rayf& ray_world, std::vector<ShapeHit>& hits);

/// The first hit in range, without leaving T: where `doubtful`, ask `append_hits`.
template <class T>
struct Nearest {
  T t, face;  // t as rounded to float
  MaskOf<T> hit, doubtful;
};

inline double rounded_to_float(double x) { return double(float(x)); }
inline DoubleLanes rounded_to_float(const DoubleLanes& x) {
  std::array<float, DoubleLanes::size()> buffer;
  x.copy_to(buffer.data(), std::experimental::element_aligned);
  return DoubleLanes(buffer.data(), std::experimental::element_aligned);
}

/// Whether a parameter, rounded to float, may come to lie in [t_min, t_max]: it need not be in there itself.
template <class T>
MaskOf<T> may_round_into(const T& t, const T& error, const T& t_min, const T& t_max) {
  // Half the distance of floats, relative, and that of subnormal ones.
  const auto half_step = [](const T& x) { return absolute(x) * 0x1p-24 + 0x1p-150; };
  return !(t + error < t_min - half_step(t_min)) && !(t - error > t_max + half_step(t_max));
}

template <class T>
[[nodiscard]] Nearest<T> nearest(const LineCrossings<T>& crossings, const T& t_min, const T& t_max) {
  using Mask = MaskOf<T>;
  Nearest<T> found{T(0), T(0), Mask(false), crossings.doubtful};
  for (const auto& c : crossings.at) {
    const Mask candidate = c.present && !found.hit && !found.doubtful && may_round_into(c.t, c.error, t_min, t_max);
    if (!any_of(candidate)) continue;  // as most behind the first
    const T t = rounded_to_float(c.t + c.error);
    found.doubtful = found.doubtful || (candidate && !(t == rounded_to_float(c.t - c.error)));
    const Mask hit = candidate && !found.doubtful && t >= t_min && t <= t_max;
    found.t = select(hit, t, found.t), found.face = select(hit, c.face, found.face);
    found.hit = found.hit || hit;
  }
  return found;
}

/// Whether anything is hit in range: no parameter need be accurate.
template <class T>
struct Blocked {
  MaskOf<T> blocked, doubtful;
};
template <class T>
[[nodiscard]] Blocked<T> blocked(const LineCrossings<T>& crossings, const T& t_min, const T& t_max) {
  Blocked<T> found{MaskOf<T>(false), crossings.doubtful};
  for (const auto& c : crossings.at) {
    if (!any_of(c.present)) continue;
    found.blocked = found.blocked || (c.present && c.t - c.error > t_min && c.t + c.error < t_max);
    found.doubtful = found.doubtful || (c.present && may_round_into(c.t, c.error, t_min, t_max));
  }
  found.blocked = found.blocked && !crossings.doubtful;
  found.doubtful = found.doubtful && !found.blocked;
  return found;
}

/// The crossings in range, all of them, where that is certain.
template <class T>
struct Passed {
  std::array<MaskOf<T>, 4> crossing;
  MaskOf<T> doubtful;
};
template <class T>
[[nodiscard]] Passed<T> passed(const LineCrossings<T>& crossings, const T& t_min, const T& t_max) {
  Passed<T> found;
  found.doubtful = crossings.doubtful;
  for (size_t k = 0; k < found.crossing.size(); ++k) {
    const auto& c = crossings.at[k];
    found.crossing[k] = c.present && c.t - c.error > t_min && c.t + c.error < t_max;
    found.doubtful = found.doubtful || (c.present && !found.crossing[k] && may_round_into(c.t, c.error, t_min, t_max));
  }
  return found;
}

}  // namespace alhazen
