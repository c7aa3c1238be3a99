#include "accel/shape_hits.h"

namespace alhazen {
namespace {

/// Keeps a crossing if it is in range; false where that, or the rounding of t, is not certain.
template <class T>
bool keep(const T& t, const T& error, int face, const Rayf& ray, std::vector<ShapeHit>& hits) {
  if (!may_round_into(t, error, T(ray.t_min), T(ray.t_max))) return true;
  const float rounded = float(t + error);
  if (!(rounded == float(t - error))) return false;
  if (rounded >= ray.t_min && rounded <= ray.t_max) hits.push_back({rounded, uint32_t(face)});
  return true;
}

template <class T, class S>
bool try_hits(const S& shape, const ObjectLine<T>& line, const Rayf& ray, std::vector<ShapeHit>& hits) {
  const LineCrossings<T> found = crossings(shape, line);
  if (found.doubtful) return false;
  for (const auto& c : found.at)
    if (c.present && !keep(c.t, c.error, int(c.face), ray, hits)) return false;
  return true;
}

template <class T>
bool try_hits(const Composite& shape, const ObjectLine<T>& line, const Rayf& ray, std::vector<ShapeHit>& hits) {
  thread_local std::vector<CompositeCrossing<T>> found;
  found.clear();
  if (!append_crossings(shape, line, found)) return false;
  for (const auto& c : found)
    if (!keep(c.t, c.error, c.face, ray, hits)) return false;
  return true;
}

template <class S>
void exact_hits(const S& shape, const Affine3d& world_from_object, const Rayf& ray, std::vector<ShapeHit>& hits) {
  for (const ExactCrossing& c : exact_crossings(shape, exact_line({&world_from_object, 1}, exact_line(ray)))) {
    const float t = to_float(c.t);
    if (t >= ray.t_min && t <= ray.t_max) hits.push_back({t, uint32_t(c.face)});
  }
}

template <class T>
Vec3<T> widened(const Vec3f& v) {
  return {T(v.x), T(v.y), T(v.z)};
}

template <class S>
void append_hits_of(const S& shape, const LineMap<double>& object_from_world, const Affine3d& world_from_object,
                    const Rayf& ray, std::vector<ShapeHit>& hits) {
  if (!is_finite(ray.origin) || !is_finite(ray.direction) || ray.direction == Vec3f{}) return;
  const size_t first = hits.size();
  const auto line = object_line(object_from_world, widened<double>(ray.origin), widened<double>(ray.direction));
  if (try_hits<double>(shape, line, ray, hits)) return;
  hits.resize(first);
  ++doubt_counts().quad;
  const LineMap<Quad> map = quad_line_map({&world_from_object, 1});
  if (try_hits<Quad>(shape, object_line(map, widened<Quad>(ray.origin), widened<Quad>(ray.direction)), ray, hits))
    return;
  hits.resize(first);
  ++doubt_counts().exact;
  exact_hits(shape, world_from_object, ray, hits);
}

}  // namespace

DoubtCounts& doubt_counts() noexcept {
  thread_local DoubtCounts counts;
  return counts;
}

void append_hits(const PlacedShape& placed, const Rayf& ray, std::vector<ShapeHit>& hits) {
  std::visit(
      [&](const auto& shape) { append_hits_of(shape, placed.object_from_world, *placed.world_from_object, ray, hits); },
      *placed.shape);
}

void append_hits(const Triangle& triangle, const LineMap<double>& object_from_world, const Affine3d& world_from_object,
                 const Rayf& ray, std::vector<ShapeHit>& hits) {
  append_hits_of(triangle, object_from_world, world_from_object, ray, hits);
}

}  // namespace alhazen
