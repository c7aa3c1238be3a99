// Checks an intersector of your own from a program of your own: link `alhazen::crosscheck` and include this alone.
// docs/crosscheck.md shows an example.
#pragma once

#include <cstdint>
#include <string>

#include "crosscheck/intersector_plugin.h"

namespace alhazen::crosscheck {

/// A ray intersector. Its functions are called from several threads at once.
class Intersector {
 public:
  virtual ~Intersector() = default;

  /// For the report.
  [[nodiscard]] virtual std::string name() const = 0;
  /// What it claims to be: "sphere 1", "box 1 2 3" and so on, as `alhazen_intersector::surface`.
  [[nodiscard]] virtual std::string surface() const = 0;
  /// A box that holds the surface: rays that miss it are not asked.
  virtual void bounds(float lower[3], float upper[3]) const = 0;

  /// The closest hit with t_min <= t <= t_max: fills `hit`, or returns false.
  [[nodiscard]] virtual bool intersect(const alhazen_ray& ray, alhazen_hit& hit) const = 0;
  /// The same for several rays at once, `found` being 1 or 0 for each. To be overridden where packets are faster, or
  /// otherwise made.
  virtual void intersect_packet(const alhazen_ray* rays, int count, alhazen_hit* hits, int* found) const {
    for (int k = 0; k < count; ++k) found[k] = intersect(rays[k], hits[k]);
  }
};

struct IntersectorCheck {
  uint64_t rays = 100000;  // of each population
  uint64_t seed = 1;
  double t_ulp = 1;  // by how many floats t may be off
};

struct IntersectorReport {
  uint64_t rays = 0, hits = 0;
  uint64_t wrong = 0;  // rays about which it is wrong: 0 is the aim
  std::string text;    // a table of all populations, every kind of error, and the shortest case of each as JSON
};

/// Rays of every population, judged exactly. Throws std::invalid_argument for a surface that is not known.
[[nodiscard]] IntersectorReport check_intersector(const Intersector& intersector, const IntersectorCheck& check = {});

}  // namespace alhazen::crosscheck
