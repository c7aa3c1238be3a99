#include "procedural/tessellation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace alhazen {
namespace {

/// Rows of `columns` + 1 vertices, the last as the first; triangles without area are left out where `open_*` is false.
template <class Vertex>
TriangleSoup grid(int rows, int columns, bool open_first, bool open_last, const Vertex& vertex) {
  TriangleSoup soup;
  for (int i = 0; i <= rows; ++i)
    for (int k = 0; k <= columns; ++k) {
      const auto [p, n] = vertex(double(i) / rows, 2 * std::numbers::pi * (k % columns) / columns);
      soup.positions.emplace_back(p), soup.normals.emplace_back(n);
    }
  const auto at = [&](int i, int k) { return uint32_t(i * (columns + 1) + k); };
  for (int i = 0; i < rows; ++i)
    for (int k = 0; k < columns; ++k) {
      if (i > 0 || open_first) soup.triangles.push_back({at(i, k), at(i, k + 1), at(i + 1, k)});
      if (i + 1 < rows || open_last) soup.triangles.push_back({at(i, k + 1), at(i + 1, k + 1), at(i + 1, k)});
    }
  return soup;
}

struct Vertex {
  Vec3d p, n;
};

}  // namespace

TriangleSoup tessellated_sphere(int segments) {
  return grid(std::max(2, segments / 2), std::max(3, segments), false, false, [](double u, double phi) {
    const double theta = std::numbers::pi * (1 - u);
    const Vec3d p{std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi)};
    return Vertex{p, p};
  });
}

TriangleSoup tessellated_frustum(double height, double radius_bottom, double radius_top, int segments) {
  const Vec3d slope = normalize(Vec3d{height, radius_bottom - radius_top, 0});
  return grid(1, std::max(3, segments), radius_bottom > 0, radius_top > 0, [&](double u, double phi) {
    const double radius = std::lerp(radius_bottom, radius_top, u), s = std::sin(phi), c = std::cos(phi);
    return Vertex{{radius * s, height * (u - 0.5), radius * c}, {slope.x * s, slope.y, slope.x * c}};
  });
}

}  // namespace alhazen
