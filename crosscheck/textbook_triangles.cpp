#include "crosscheck/textbook_triangles.h"

#include <algorithm>

namespace alhazen::crosscheck {
namespace {

using Way = std::optional<TriangleHit> (*)(const Triangle&, const Rayd&) noexcept;
constexpr Way kWays[kTextbookWays] = {intersect_by_half_spaces, intersect_by_cramer};

Rayd object_ray(const Affine3d& world_from_object, const Rayf& ray) {
  const Vec3d origin(ray.origin), direction(ray.direction);
  if (world_from_object == Affine3d{}) return {origin, direction, ray.t_min, ray.t_max};
  const Affine3d to_object = inverse(world_from_object);
  return {transform_point(to_object, origin), transform_vector(to_object, direction), ray.t_min, ray.t_max};
}

void count(const Answer& answer, const Judgement& truth, double t_tolerance, TextbookCount& c) {
  ++c.rays, ++c.faults[size_t(fault_of(answer, truth, t_tolerance))];
  if (!answer.hit || !truth.hit) return;
  const double off = floats_between(answer.t, truth.t);
  ++c.judged, c.exact += off == 0, c.worst = std::max(c.worst, off);
}

}  // namespace

void TextbookCount::add(const TextbookCount& o) {
  rays += o.rays, judged += o.judged, exact += o.exact, worst = std::max(worst, o.worst);
  for (size_t k = 0; k < faults.size(); ++k) faults[k] += o.faults[k];
}

void count_textbook(const Subject& subject, const Rayf& ray, const Judgement& truth, double t_tolerance,
                    TextbookCounts& counts) {
  const auto* triangle = std::get_if<Triangle>(&subject.surface);
  if (!triangle) return;
  const Rayd local = object_ray(subject.world_from_object, ray);
  for (int way = 0; way < kTextbookWays; ++way) {
    const auto hit = kWays[way](*triangle, local);
    Answer answer;
    if (hit) answer.hit = true, answer.t = float(hit->t);
    count(answer, truth, t_tolerance, counts[size_t(way)]);
  }
}

}  // namespace alhazen::crosscheck
