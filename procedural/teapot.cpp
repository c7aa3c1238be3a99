#include "procedural/teapot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace alhazen {
namespace {

using Patch = std::array<std::array<Vec3d, 4>, 4>;  // by u, then v

struct ProfilePoint {
  double radius, height;
};
using Profile = std::array<ProfilePoint, 4>;

// Outlines of the round parts and halves (y <= 0) of the others: M. E. Newell's measures, as they were published with
// F. C. Crow, "The Origins of the Teapot", IEEE Computer Graphics and Applications 7(1), 1987.
constexpr Profile kProfiles[] = {
    {{{1.4, 2.4}, {1.3375, 2.53125}, {1.4375, 2.53125}, {1.5, 2.4}}},  // rim
    {{{1.5, 2.4}, {1.75, 1.875}, {2, 1.35}, {2, 0.9}}},                // body
    {{{2, 0.9}, {2, 0.45}, {1.5, 0.225}, {1.5, 0.15}}},
    {{{0, 3.15}, {0.8, 3.15}, {0, 2.85}, {0.2, 2.7}}},  // lid
    {{{0.2, 2.7}, {0.4, 2.55}, {1.3, 2.55}, {1.3, 2.4}}},
    {{{1.5, 0.15}, {1.5, 0.075}, {1.425, 0}, {0, 0}}},  // bottom
};
const Patch kHalves[] = {
    // handle
    {{{{{-1.6, 0, 2.025}, {-1.6, -0.3, 2.025}, {-1.5, -0.3, 2.25}, {-1.5, 0, 2.25}}},
      {{{-2.3, 0, 2.025}, {-2.3, -0.3, 2.025}, {-2.5, -0.3, 2.25}, {-2.5, 0, 2.25}}},
      {{{-2.7, 0, 2.025}, {-2.7, -0.3, 2.025}, {-3, -0.3, 2.25}, {-3, 0, 2.25}}},
      {{{-2.7, 0, 1.8}, {-2.7, -0.3, 1.8}, {-3, -0.3, 1.8}, {-3, 0, 1.8}}}}},
    {{{{{-2.7, 0, 1.8}, {-2.7, -0.3, 1.8}, {-3, -0.3, 1.8}, {-3, 0, 1.8}}},
      {{{-2.7, 0, 1.575}, {-2.7, -0.3, 1.575}, {-3, -0.3, 1.35}, {-3, 0, 1.35}}},
      {{{-2.5, 0, 1.125}, {-2.5, -0.3, 1.125}, {-2.65, -0.3, 0.9375}, {-2.65, 0, 0.9375}}},
      {{{-2, 0, 0.9}, {-2, -0.3, 0.9}, {-1.9, -0.3, 0.6}, {-1.9, 0, 0.6}}}}},
    // spout
    {{{{{1.7, 0, 1.425}, {1.7, -0.66, 1.425}, {1.7, -0.66, 0.6}, {1.7, 0, 0.6}}},
      {{{2.6, 0, 1.425}, {2.6, -0.66, 1.425}, {3.1, -0.66, 0.825}, {3.1, 0, 0.825}}},
      {{{2.3, 0, 2.1}, {2.3, -0.25, 2.1}, {2.4, -0.25, 2.025}, {2.4, 0, 2.025}}},
      {{{2.7, 0, 2.4}, {2.7, -0.25, 2.4}, {3.3, -0.25, 2.4}, {3.3, 0, 2.4}}}}},
    {{{{{2.7, 0, 2.4}, {2.7, -0.25, 2.4}, {3.3, -0.25, 2.4}, {3.3, 0, 2.4}}},
      {{{2.8, 0, 2.475}, {2.8, -0.25, 2.475}, {3.525, -0.25, 2.49375}, {3.525, 0, 2.49375}}},
      {{{2.9, 0, 2.475}, {2.9, -0.15, 2.475}, {3.45, -0.15, 2.5125}, {3.45, 0, 2.5125}}},
      {{{2.8, 0, 2.4}, {2.8, -0.15, 2.4}, {3.2, -0.15, 2.4}, {3.2, 0, 2.4}}}}},
};

/// A quarter of the round part, turned by `quarter` right angles; Newell's circles have their handles at 0.56.
Patch revolved(const Profile& profile, int quarter) {
  constexpr double kHandle = 0.56;
  constexpr std::array<std::array<double, 2>, 4> kArc = {{{1, 0}, {1, kHandle}, {kHandle, 1}, {0, 1}}};
  Patch patch;
  for (size_t i = 0; i < 4; ++i)
    for (size_t k = 0; k < 4; ++k) {
      double x = kArc[k][0] * profile[i].radius, y = kArc[k][1] * profile[i].radius;
      for (int turn = 0; turn < quarter; ++turn) x = -std::exchange(y, x);
      patch[i][k] = {x, y, profile[i].height};
    }
  return patch;
}

/// The other half; the order of v is reversed so that the outside stays outside.
Patch mirrored(const Patch& half) {
  Patch patch;
  for (size_t i = 0; i < 4; ++i)
    for (size_t k = 0; k < 4; ++k) {
      const Vec3d& p = half[i][3 - k];
      patch[i][k] = {p.x, -p.y, p.z};
    }
  return patch;
}

struct Jet {
  std::array<double, 4> value, slope;
};

/// The Bernstein polynomials of degree 3 and their derivatives.
Jet bernstein(double t) {
  const double s = 1 - t;
  return {{s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t},
          {-3 * s * s, 3 * s * s - 6 * s * t, 6 * s * t - 3 * t * t, 3 * t * t}};
}

struct PatchPoint {
  Vec3d p, n;
};

Vec3d sum_over(const Patch& patch, const std::array<double, 4>& a, const std::array<double, 4>& b) {
  Vec3d sum;
  for (size_t i = 0; i < 4; ++i)
    for (size_t k = 0; k < 4; ++k) sum = sum + patch[i][k] * (a[i] * b[k]);
  return sum;
}

PatchPoint point_at(const Patch& patch, double u, double v) {
  // At the lid's and bottom's poles a row is a single point: the normal is that a little beside it.
  const auto normal_at = [&](double a, double b) {
    const Jet ja = bernstein(a), jb = bernstein(b);
    return cross(sum_over(patch, ja.slope, jb.value), sum_over(patch, ja.value, jb.slope));
  };
  const Vec3d p = sum_over(patch, bernstein(u).value, bernstein(v).value);
  Vec3d n = normal_at(u, v);
  if (!(length(n) > 1e-9)) n = normal_at(std::clamp(u, 1e-4, 1 - 1e-4), v);
  return {p, normalize(n)};
}

void add_triangle(NffScene& scene, uint32_t material, const PatchPoint& a, const PatchPoint& b, const PatchPoint& c) {
  if (!(length(cross(b.p - a.p, c.p - a.p)) > 1e-12)) return;  // of no area but for rounding, at a pole
  scene.polygons.push_back({{a.p, b.p, c.p}, {a.n, b.n, c.n}, material});
}

void add_patch(NffScene& scene, uint32_t material, const Patch& patch, int size) {
  const auto at = [&](int i, int k) { return point_at(patch, double(i) / size, double(k) / size); };
  for (int i = 0; i < size; ++i)
    for (int k = 0; k < size; ++k) {
      add_triangle(scene, material, at(i, k), at(i + 1, k), at(i + 1, k + 1));
      add_triangle(scene, material, at(i, k), at(i + 1, k + 1), at(i, k + 1));
    }
}

}  // namespace

void add_teapot(NffScene& scene, uint32_t material, int size) {
  for (const Profile& profile : kProfiles)
    for (int quarter = 0; quarter < 4; ++quarter) add_patch(scene, material, revolved(profile, quarter), size);
  for (const Patch& half : kHalves) {
    add_patch(scene, material, half, size);
    add_patch(scene, material, mirrored(half), size);
  }
}

}  // namespace alhazen
