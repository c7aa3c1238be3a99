// A program of one's own that checks its intersector: the naive sphere as an object, linked with alhazen::crosscheck.
// Ends with status 5 where the intersector is wrong, as `alhazen crosscheck` does.
#include <cstdio>

#include "crosscheck/check_intersector.h"

namespace {

struct NaiveSphere : alhazen::crosscheck::Intersector {
  const alhazen_intersector& c = *alhazen_get_intersector();  // naive_sphere.cpp

  std::string name() const override { return "naive sphere"; }
  std::string surface() const override { return "sphere 1"; }
  void bounds(float lower[3], float upper[3]) const override { c.bounds(lower, upper); }
  bool intersect(const alhazen_ray& ray, alhazen_hit& hit) const override { return c.intersect(&ray, &hit) != 0; }
};

}  // namespace

int main() {
  const auto report = alhazen::crosscheck::check_intersector(NaiveSphere(), {.rays = 10000});
  std::printf("%sWrong about %llu of %llu rays.\n", report.text.c_str(), (unsigned long long)report.wrong,
              (unsigned long long)report.rays);
  return report.wrong > 0 ? 5 : 0;
}
