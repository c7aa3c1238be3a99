// The judge: what a ray hits in truth. Interval arithmetic in double first, in double-double for what that leaves open,
// and rational numbers for the rest. It shares no arithmetic with the intersectors: it tells inside from outside
// between the crossings of all surfaces, where they order the crossings.
#pragma once

#include <memory>

#include "crosscheck/exact_ties.h"
#include "crosscheck/subject.h"

namespace alhazen::crosscheck {

enum class JudgedBy : uint8_t { doubles, double_doubles, rationals };  // intervals around the first two

struct Judgement {
  bool hit = false;
  float t = 0;  // correctly rounded
  int face = 0;
  int side = 0;                 // of the ray against the normal: -1 from outside, 1 from inside, 0 grazing
  Vec3d normal_object;          // unit, or zero where there is none
  double normal_tolerance = 0;  // by how much, in radians, an error of one unit in the last place of t may turn it
  double u = 0, v = 0;          // triangles: barycentric weights of the second and third vertex
  Tie tie = Tie::none;
  JudgedBy by = JudgedBy::doubles;
};

/// One ray in so many is judged by rational numbers as well.
inline constexpr uint64_t kSecondInstance = 1024;
[[nodiscard]] inline bool same_answer(const Judgement& a, const Judgement& b) {
  return a.hit == b.hit && (!a.hit || (a.t == b.t && a.face == b.face));
}

class Judge {
 public:
  explicit Judge(const Subject& subject);
  ~Judge();

  /// The nearest hit with t_min <= t <= t_max, t being the float nearest to the exact parameter. For finite rays with a
  /// direction.
  [[nodiscard]] Judgement closest(const Rayf& ray_world) const;

  /// The same by rational numbers alone.
  [[nodiscard]] Judgement closest_exactly(const Rayf& ray_world) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace alhazen::crosscheck
