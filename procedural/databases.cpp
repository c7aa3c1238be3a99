#include "procedural/databases.h"

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "procedural/teapot.h"

namespace alhazen {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr Rgb kSky{0.078f, 0.361f, 0.753f};

/// About a unit axis, by the right hand.
Vec3d rotated(const Vec3d& v, const Vec3d& axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return v * c + cross(axis, v) * s + axis * (dot(axis, v) * (1 - c));
}

/// Two unit vectors across n and each other, so that (x, y, n) is right-handed.
std::array<Vec3d, 2> across(const Vec3d& n) {
  const Vec3d x = normalize(cross(std::abs(n.x) < 0.9 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0}, n));
  return {x, cross(n, x)};
}

void add_square(NffScene& scene, uint32_t material, double half, double z) {
  scene.polygons.push_back({{{half, half, z}, {-half, half, z}, {-half, -half, z}, {half, -half, z}}, {}, material});
}

// ---- Balls: each carries nine a third as large, six about its equator and three above ----

/// The directions to the nine children of a ball whose parent lies along -z.
std::array<Vec3d, 9> child_directions() {
  const double d = 1 / std::sqrt(2.0);
  std::array<Vec3d, 9> all;
  const std::array<Vec3d, 3> trio = {Vec3d{d, d, 0}, Vec3d{d, 0, -d}, Vec3d{0, d, -d}};
  const Vec3d axis = normalize(Vec3d{1, -1, 0});
  for (size_t k = 0; k < 3; ++k) {
    const Vec3d tilted = rotated(trio[k], axis, std::asin(2 / std::sqrt(6.0)));
    for (size_t turn = 0; turn < 3; ++turn) all[3 * k + turn] = rotated(tilted, {0, 0, 1}, double(turn) * 2 * kPi / 3);
  }
  return all;
}

void add_balls(NffScene& scene, uint32_t material, int depth, const Vec3d& center, double radius,
               const Vec3d& outward) {
  scene.spheres.push_back({center, radius, material});
  if (depth == 0) return;
  static const std::array<Vec3d, 9> children = child_directions();
  const auto [x, y] = across(outward);
  for (const Vec3d& child : children) {
    const Vec3d direction = x * child.x + y * child.y + outward * child.z;
    add_balls(scene, material, depth - 1, center + direction * (radius * 4 / 3), radius / 3, direction);
  }
}

NffScene balls(int size) {
  NffScene scene;
  scene.view = {{2.1, 1.3, 1.7}, {0, 0, 0}, {0, 0, 1}, 45};
  scene.background = kSky;
  scene.lights = {{{4, 3, 2}}, {{1, -4, 4}}, {{-3, 1, 5}}};
  add_square(scene, scene.add({{1, 0.75f, 0.33f}, 0.8f, 0, 0, 0, 1}), 12, -0.5);
  add_balls(scene, scene.add({{1, 0.9f, 0.7f}, 0.5f, 0.5f, 3.0827f, 0, 1}), size, {}, 0.5, {0, 0, 1});
  return scene;
}

// ---- Gears: a block of glassy wheels that mesh with each other ----

constexpr int kTeeth = 36;
constexpr double kThickness = 0.4;

/// One wheel: two faces of four vertices a tooth, and a wall.
void add_gear(NffScene& scene, uint32_t material, const Vec3d& center, double phase) {
  std::vector<Vec3d> rim;
  for (int k = 0; k < 4 * kTeeth; ++k) {
    const double radius = k % 4 < 2 ? 1.05 : 0.95;
    const double angle = phase + 2 * kPi * (k / 4 + std::array{-0.19, 0.19, 0.31, 0.69}[size_t(k % 4)]) / kTeeth;
    rim.push_back({radius * std::cos(angle), radius * std::sin(angle), kThickness / 2});
  }
  NffPolygon top{{}, {}, material}, bottom{{}, {}, material};
  for (const Vec3d& p : rim) {
    top.vertices.push_back(center + p);
    bottom.vertices.insert(bottom.vertices.begin(), center + Vec3d{p.x, p.y, -p.z});
  }
  for (size_t k = 0; k < rim.size(); ++k) {
    const Vec3d a = center + rim[k], b = center + rim[(k + 1) % rim.size()], down{0, 0, kThickness};
    scene.polygons.push_back({{a, a - down, b - down, b}, {}, material});
  }
  scene.polygons.push_back(std::move(top));
  scene.polygons.push_back(std::move(bottom));
}

NffScene gears(int size) {
  NffScene scene;
  const double middle = size - 1.0, reach = 2.0 * size;
  scene.view = {{-1.1 * reach, -2.1 * reach, 1.5 * reach}, {middle, middle, -0.1 * reach}, {0, 0, 1}, 35};
  scene.background = kSky;
  for (const Vec3d& p : {Vec3d{5, -5, 10}, Vec3d{-5, -5, 8}, Vec3d{0, -9, 6}, Vec3d{8, 2, 9}, Vec3d{-8, 6, 12}})
    scene.lights.push_back({p * (0.5 * reach) + Vec3d{middle, middle, 0}});
  add_square(scene, scene.add({{1, 0.75f, 0.33f}, 0.8f, 0, 0, 0, 1}), 12.0 * size, -2.0 * size);
  const std::array materials = {scene.add({{0.9f, 0.25f, 0.2f}, 0.35f, 0.15f, 60, 0.6f, 1.1f}),
                                scene.add({{0.25f, 0.8f, 0.3f}, 0.35f, 0.15f, 60, 0.6f, 1.1f}),
                                scene.add({{0.3f, 0.4f, 0.95f}, 0.35f, 0.15f, 60, 0.6f, 1.1f})};
  for (int x = 0; x < size; ++x)
    for (int y = 0; y < size; ++y)
      for (int z = 0; z < size; ++z)  // neighbours turn against each other: tooth to gap
        add_gear(scene, materials[size_t(x + y + z) % 3], {2.0 * x, 2.0 * y, -1.0 * z},
                 (x + y) % 2 == 0 ? 0 : kPi / kTeeth);
  return scene;
}

// ---- Mountain: a fractal height field and four balls of glass ----

/// (2^size + 1)² heights in [0, 1]² by moving midpoints (A. Fournier, D. Fussell, L. Carpenter, "Computer Rendering of
/// Stochastic Models", CACM 25(6), 1982).
std::vector<double> fractal_heights(int size) {
  const int n = 1 << size;
  const auto side = size_t(n) + 1;
  std::vector<double> heights(side * side, 0);
  std::minstd_rand random(1987);  // the same everywhere
  const auto spread = [&](double by) {
    return by * (2 * double(random() - 1) / double(std::minstd_rand::modulus - 2) - 1);
  };
  const auto at = [&](int x, int y) -> double& { return heights[size_t(y) * side + size_t(x)]; };
  for (int step = n; step > 1; step /= 2) {
    const int half = step / 2;
    const double by = 0.45 * std::pow(double(step) / n, 0.95);
    for (int y = 0; y <= n; y += step)
      for (int x = half; x < n; x += step) at(x, y) = (at(x - half, y) + at(x + half, y)) / 2 + spread(by);
    for (int y = half; y < n; y += step)
      for (int x = 0; x <= n; x += half) at(x, y) = (at(x, y - half) + at(x, y + half)) / 2 + spread(by);
  }
  return heights;
}

NffScene mountain(int size) {
  NffScene scene;
  scene.view = {{-1.6, 1.6, 1.7}, {0, 0, 0}, {0, 0, 1}, 45};
  scene.background = kSky;
  scene.lights = {{{-100, -100, 100}}};
  const uint32_t rock = scene.add({{0.5f, 0.45f, 0.35f}, 1, 0, 0, 0, 1});
  const std::vector<double> heights = fractal_heights(size);
  const int n = 1 << size;
  const auto vertex = [&](int x, int y) {
    return Vec3d{2.0 * x / n - 1, 2.0 * y / n - 1, heights[size_t(y) * (size_t(n) + 1) + size_t(x)]};
  };
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      scene.polygons.push_back({{vertex(x, y), vertex(x + 1, y), vertex(x + 1, y + 1)}, {}, rock});
      scene.polygons.push_back({{vertex(x, y), vertex(x + 1, y + 1), vertex(x, y + 1)}, {}, rock});
    }
  const uint32_t glass = scene.add({{1, 0.9f, 0.7f}, 0.05f, 0.25f, 200, 0.8f, 1.5f});
  for (const Vec3d& p :
       {Vec3d{-0.8, 0.8, 1.00}, Vec3d{-0.66, 0.78, 0.935}, Vec3d{-0.8, 0.65, 0.935}, Vec3d{-0.72, 0.74, 0.82}})
    scene.spheres.push_back({p, 0.085, glass});
  return scene;
}

// ---- Rings: a pyramid of interlocked pentagons, six about the axes of each dodecahedron ----

/// Five cylinders and their joints around the axis.
void add_pentagon(NffScene& scene, uint32_t material, const Vec3d& center, const Vec3d& axis) {
  constexpr double kRadius = 0.42, kThick = 0.07;
  const auto [x, y] = across(axis);
  const auto corner = [&, x = x, y = y](int k) {
    return center + (x * std::cos(2 * kPi * k / 5) + y * std::sin(2 * kPi * k / 5)) * kRadius;
  };
  for (int k = 0; k < 5; ++k) {
    scene.spheres.push_back({corner(k), kThick, material});
    scene.cones.push_back({corner(k), corner(k + 1), kThick, kThick, material});
  }
}

NffScene rings(int size) {
  NffScene scene;
  const double height = 0.8 * size;
  scene.view = {{-1.5 * size, -2.3 * size, 1.15 * size}, {0, 0, 0.36 * height}, {0, 0, 1}, 36};
  scene.background = kSky;
  scene.lights = {
      {{-3.0 * size, -4.0 * size, 6.0 * size}}, {{5.0 * size, -2.0 * size, 4.0 * size}}, {{0, 3.0 * size, 7.0 * size}}};
  add_square(scene, scene.add({{1, 0.75f, 0.33f}, 0.8f, 0, 0, 0, 1}), 20.0 * size, -0.5);
  const std::array materials = {scene.add({{0.95f, 0.5f, 0.35f}, 0.55f, 0.35f, 30, 0, 1}),
                                scene.add({{0.9f, 0.8f, 0.4f}, 0.55f, 0.35f, 30, 0, 1}),
                                scene.add({{0.4f, 0.8f, 0.55f}, 0.55f, 0.35f, 30, 0, 1}),
                                scene.add({{0.4f, 0.7f, 0.9f}, 0.55f, 0.35f, 30, 0, 1}),
                                scene.add({{0.55f, 0.5f, 0.95f}, 0.55f, 0.35f, 30, 0, 1}),
                                scene.add({{0.9f, 0.5f, 0.8f}, 0.55f, 0.35f, 30, 0, 1})};
  const double golden = std::numbers::phi;
  const std::array<Vec3d, 6> axes = {Vec3d{0, 1, golden},  Vec3d{0, -1, golden}, Vec3d{1, golden, 0},
                                     Vec3d{-1, golden, 0}, Vec3d{golden, 0, 1},  Vec3d{golden, 0, -1}};
  for (int layer = 0; layer < size; ++layer) {
    const int side = size - layer;
    for (int x = 0; x < side; ++x)
      for (int y = 0; y < side; ++y)
        for (size_t k = 0; k < 6; ++k)
          add_pentagon(scene, materials[k], {x - (side - 1) / 2.0, y - (side - 1) / 2.0, 0.8 * layer},
                       normalize(axes[k]));
  }
  return scene;
}

// ---- Teapot ----

NffScene teapot(int size) {
  NffScene scene;
  scene.view = {{4.86, 7.2, 5.4}, {0, 0, 1.2}, {0, 0, 1}, 45};
  scene.background = kSky;
  scene.lights = {{{-3.1, 9.8, 12.1}}, {{11.3, 5.1, 8.8}}};
  const std::array squares = {scene.add({{1, 1, 1}, 0.8f, 0.05f, 10, 0, 1}),
                              scene.add({{0.1f, 0.1f, 0.1f}, 0.8f, 0.05f, 10, 0, 1})};
  constexpr int kSquares = 8;
  for (int x = 0; x < kSquares; ++x)
    for (int y = 0; y < kSquares; ++y) {
      const double x0 = 2.0 * x - kSquares, y0 = 2.0 * y - kSquares;
      scene.polygons.push_back(
          {{{x0, y0, 0}, {x0 + 2, y0, 0}, {x0 + 2, y0 + 2, 0}, {x0, y0 + 2, 0}}, {}, squares[size_t(x + y) % 2]});
    }
  add_teapot(scene, scene.add({{1, 0.5f, 0.1f}, 0.65f, 0.3f, 60, 0, 1}), size);
  return scene;
}

// ---- Tetra: Sierpinski's tetrahedron ----

void add_tetra(NffScene& scene, uint32_t material, int depth, const std::array<Vec3d, 4>& corners) {
  if (depth > 0) {
    for (const Vec3d& corner : corners) {
      std::array<Vec3d, 4> half;
      for (size_t k = 0; k < 4; ++k) half[k] = (corners[k] + corner) * 0.5;
      add_tetra(scene, material, depth - 1, half);
    }
    return;
  }
  for (const auto& [a, b, c] : {std::array<size_t, 3>{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}})
    scene.polygons.push_back({{corners[a], corners[b], corners[c]}, {}, material});
}

NffScene tetra(int size) {
  NffScene scene;
  scene.view = {{1.02285, -3.17715, -2.17451}, {-0.004103, -0.004103, 0.216539}, {-0.816497, -0.816497, 0.816497}, 45};
  scene.background = kSky;
  scene.lights = {{{1.87607, -18.1346, -5.02673}}};
  add_tetra(scene, scene.add({{1, 0.2f, 0.2f}, 1, 0, 0, 0, 1}), size - 1,
            {Vec3d{1, 1, 1}, {-1, -1, 1}, {1, -1, -1}, {-1, 1, -1}});
  return scene;
}

// ---- Tree: each branch bears two ----

void add_branch(NffScene& scene, uint32_t material, int depth, const Vec3d& from, const Vec3d& along,
                const Vec3d& aside, double radius) {
  const double length_along = length(along);
  const Vec3d to = from + along, axis = along / length_along;
  const double end = radius * 0.72;
  scene.cones.push_back({from, to, radius, end, material});
  scene.spheres.push_back({to, end, material});
  if (depth == 0) return;
  const double tilts[] = {0.55, -0.72}, shares[] = {0.80, 0.72};
  for (size_t k = 0; k < 2; ++k) {
    const Vec3d direction = rotated(axis, aside, tilts[k]);
    const Vec3d next = normalize(rotated(aside, direction, 1.9));
    add_branch(scene, material, depth - 1, to, direction * (length_along * shares[k]), next,
               end * (k == 0 ? 0.98 : 0.88));
  }
}

NffScene tree(int size) {
  NffScene scene;
  scene.view = {{6, 0.5, 2.3}, {0, 0, 1.85}, {0, 0, 1}, 45};
  scene.background = kSky;
  scene.lights = {{{-5, 5, 50}},   {{30, -30, 30}}, {{-40, -30, 20}}, {{10, 30, 40}},
                  {{-30, 40, 10}}, {{50, 25, -40}}, {{5, -50, -40}}};
  add_square(scene, scene.add({{0.7f, 1, 0.5f}, 0.8f, 0, 0, 0, 1}), 50, 0);
  add_branch(scene, scene.add({{0.55f, 0.4f, 0.2f}, 1, 0, 0, 0, 1}), size, {}, {0, 0, 0.95}, {0, 1, 0}, 0.11);
  return scene;
}

}  // namespace

const std::vector<Database>& databases() {
  static const std::vector<Database> all = {
      {"balls", "spheres on spheres, which mirror each other", 4, 7, balls},
      {"gears", "meshing wheels of coloured glass, concave polygons", 4, 40, gears},
      {"mountain", "a fractal height field, seen through glass balls", 6, 11, mountain},
      {"rings", "a pyramid of rings of spheres and cylinders", 7, 60, rings},
      {"teapot", "patches with normals over a checkered floor", 12, 400, teapot},
      {"tetra", "Sierpinski's tetrahedron of triangles", 6, 12, tetra},
      {"tree", "a branching tree of cones and spheres", 11, 20, tree}};
  return all;
}

}  // namespace alhazen
