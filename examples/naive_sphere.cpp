// A sphere as it is first written: the quadratic in float, the textbook's formula. `alhazen crosscheck` finds what is
// wrong with it; docs/crosscheck.md walks through.
#include <cmath>

#include "crosscheck/intersector_plugin.h"

namespace {

float dot(const float a[3], const float b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

void bounds(float lower[3], float upper[3]) {
  for (int k = 0; k < 3; ++k) lower[k] = -1.001f, upper[k] = 1.001f;  // a little larger, so that no ray is lost
}

int intersect(const alhazen_ray* ray, alhazen_hit* hit) {
  const float a = dot(ray->direction, ray->direction);
  const float b = 2 * dot(ray->origin, ray->direction);
  const float c = dot(ray->origin, ray->origin) - 1;
  const float discriminant = b * b - 4 * a * c;
  if (discriminant < 0) return 0;
  const float root = std::sqrt(discriminant);
  float t = (-b - root) / (2 * a);
  if (t < ray->t_min) t = (-b + root) / (2 * a);
  if (!(t >= ray->t_min && t <= ray->t_max)) return 0;
  hit->t = t;
  hit->face = ALHAZEN_NO_FACE;
  for (int k = 0; k < 3; ++k) hit->normal[k] = ray->origin[k] + t * ray->direction[k];
  return 1;
}

const alhazen_intersector kNaiveSphere = {
    ALHAZEN_INTERSECTOR_VERSION, "naive-sphere", "sphere 1", bounds, intersect, nullptr,
};

}  // namespace

const alhazen_intersector* alhazen_get_intersector() { return &kNaiveSphere; }
