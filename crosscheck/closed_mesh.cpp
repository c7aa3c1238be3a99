#include "crosscheck/closed_mesh.h"

#include <numbers>

namespace alhazen::crosscheck {
namespace {

constexpr uint32_t kRows = 16, kColumns = 16, kNeedles = 16;

Vec3d as_floats(const Vec3d& v) { return Vec3d(Vec3f(v)); }

Vec3d spherical(double radius, double theta, double phi) {
  return {radius * std::sin(theta) * std::cos(phi), radius * std::cos(theta), radius * std::sin(theta) * std::sin(phi)};
}

/// Poles, then rings of vertices from the upper to the lower pole.
ClosedMesh bumpy(Random& random, const std::string& name, const Vec3d& center) {
  const auto point = [&](double theta, double phi) {
    return as_floats(center + spherical(random.uniform(1, 6), theta, phi));
  };
  ClosedMesh mesh{name, {point(0, 0), point(std::numbers::pi, 0)}, {}, center, 20};
  for (uint32_t i = 1; i < kRows; ++i)
    for (uint32_t j = 0; j < kColumns; ++j)
      mesh.vertices.push_back(point(std::numbers::pi * i / kRows, 2 * std::numbers::pi * j / kColumns));
  const auto at = [](uint32_t i, uint32_t j) { return 2 + (i - 1) * kColumns + j % kColumns; };
  for (uint32_t j = 0; j < kColumns; ++j) {
    mesh.faces.push_back({0, at(1, j + 1), at(1, j)});
    mesh.faces.push_back({1, at(kRows - 1, j), at(kRows - 1, j + 1)});
    for (uint32_t i = 1; i + 1 < kRows; ++i) {
      mesh.faces.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
      mesh.faces.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
    }
  }
  return mesh;
}

ClosedMesh box() {
  ClosedMesh mesh{"box", {}, {}, {0, 0, 0}, 10};
  for (int k = 0; k < 8; ++k) mesh.vertices.push_back({k & 1 ? 1.5 : -1.5, k & 2 ? 1.0 : -1.0, k & 4 ? 2.0 : -2.0});
  for (uint32_t axis = 0; axis < 3; ++axis) {
    const uint32_t u = 1u << (axis + 1) % 3, v = 1u << (axis + 2) % 3, upper = 1u << axis;
    mesh.faces.push_back({upper, upper + u, upper + u + v}), mesh.faces.push_back({upper, upper + u + v, upper + v});
    mesh.faces.push_back({0, u + v, u}), mesh.faces.push_back({0, v, u + v});
  }
  return mesh;
}

/// A ring of vertices between two far apexes.
ClosedMesh fan() {
  ClosedMesh mesh{"fan", {{0, 500, 0}, {0, -500, 0}}, {}, {0, 0, 0}, 2000};
  for (uint32_t k = 0; k < kNeedles; ++k)
    mesh.vertices.push_back(as_floats(spherical(0.5, std::numbers::pi / 2, 2 * std::numbers::pi * k / kNeedles)));
  for (uint32_t k = 0; k < kNeedles; ++k) {
    const uint32_t a = 2 + k, b = 2 + (k + 1) % kNeedles;
    mesh.faces.push_back({0, b, a}), mesh.faces.push_back({1, a, b});
  }
  return mesh;
}

}  // namespace

std::vector<ClosedMesh> closed_meshes(uint64_t seed) {
  Random near{seed, 1}, far{seed, 1};
  return {bumpy(near, "bumpy", {0, 0, 0}), bumpy(far, "bumpy-far", {148376, 1234, -223423}), box(), fan()};
}

}  // namespace alhazen::crosscheck
