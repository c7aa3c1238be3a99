#include "bench/scenes.h"

#include <cmath>
#include <numbers>
#include <random>

namespace alhazen {
namespace {

/// Applies `make` to the points where rays hit, moved back along the ray by a little.
template <class Make>
RayWave from_hits(const RayWave& wave, const HitWave& hits, const Make& make) {
  RayWave from;
  for (size_t i = 0; i < wave.size(); ++i) {
    if (hits.object[i] == kNone) continue;
    from.resize(from.size() + 1);
    from.set(from.size() - 1, make(point_at(wave.get(i), hits.t[i] * 0.9999f)));
  }
  return from;
}

}  // namespace

Geometry sphere_field(int count) {
  Geometry geometry;
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> u(-1, 1);
  geometry.shapes.push_back(Sphere{count == 1 ? 0.9f : float(1.4 / std::sqrt(double(count)))});
  for (int i = 0; i < count; ++i) {
    Affine3d m;
    if (count > 1) m.origin = {u(rng), u(rng), u(rng)};
    geometry.shape_instances.push_back({0, uint32_t(i), 0, m});
  }
  return geometry;
}

Geometry as_quadrics(Geometry spheres) {
  for (Shape& shape : spheres.shapes) {
    const double r = std::get<Sphere>(shape).radius;
    Quadric quadric;
    quadric.coefficients[9] = -r * r;
    quadric.box = *ellipsoid_bounds(quadric.coefficients);
    quadric.solid = quadric.whole = true;
    shape = quadric;
  }
  return spheres;
}

HexagonField hexagon_field(int count) {
  HexagonField field;
  TriangleMesh mesh;
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> u(-1, 1);
  const double radius = 1.4 / std::sqrt(double(count));
  for (int i = 0; i < count; ++i) {
    const Vec3d center{u(rng), u(rng), u(rng)}, n = normalize(Vec3d{u(rng), u(rng), u(rng)});
    const Vec3d x = normalize(cross(n, Vec3d{0.3, 0.5, 0.8})), y = cross(n, x);
    const auto first = uint32_t(mesh.positions.size());
    std::vector<Vec3d> corners;
    for (int k = 0; k < 6; ++k) {
      const double angle = k * std::numbers::pi / 3;
      mesh.positions.push_back(Vec3f(center + (x * std::cos(angle) + y * std::sin(angle)) * radius));
      corners.push_back(Vec3d(mesh.positions.back()));
    }
    for (uint32_t k = 1; k + 1 < 6; ++k) mesh.triangles.push_back({first, first + k, first + k + 1});
    field.polygons.shapes.push_back(make_polygon({corners}));
    field.polygons.shape_instances.push_back({uint32_t(i), uint32_t(i), 0, {}});
  }
  field.triangles = geometry_of(std::move(mesh));
  return field;
}

Geometry geometry_of(TriangleMesh mesh) {
  Geometry geometry;
  geometry.meshes.push_back({"", {std::move(mesh)}});
  geometry.mesh_instances.push_back({0, 0, {}});
  return geometry;
}

TriangleMesh hills(int cells) {
  TriangleMesh mesh;
  const auto height = [](float x, float z) { return 0.05f * std::sin(9 * x + 2 * z) * std::cos(7 * z); };
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) {
      const float x = 2 * float(i) / float(cells) - 1, z = 2 * float(j) / float(cells) - 1;
      mesh.positions.push_back({x, height(x, z), z});
    }
  const auto at = [&](int i, int j) { return uint32_t(j * (cells + 1) + i); };
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
      mesh.triangles.push_back({at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)});
    }
  return mesh;
}

Scene spheres_over_hills() {
  Scene scene;
  Material ground, mirror;
  ground.model = mirror.model = ShadingModel::phong;
  ground.phong.diffuse = Rgb(0.6f), mirror.phong.diffuse = Rgb(0.2f), mirror.phong.reflection = Rgb(0.7f);
  scene.materials = {ground, mirror, Material{}};
  scene.geometry.meshes.push_back({"hills", {hills(200)}});
  scene.geometry.mesh_instances.push_back({0, 0, {}});
  scene.geometry.shapes.push_back(Sphere{0.07f});
  for (int i = 0; i < 100; ++i) {
    Affine3d m;
    m.origin = {0.18 * (i % 10) - 0.81, 0.12, 0.18 * (i / 10) - 0.81};
    scene.geometry.shape_instances.push_back({0, uint32_t(i + 1), uint32_t(i % 2), m});
  }
  Light light;
  light.p_world = {0.5, 2, 1}, light.intensity = Rgb(3.0f);
  scene.lights.push_back(light);
  scene.ambient = Rgb(0.1f), scene.background = Rgb(0.3f);
  return scene;
}

RayWave camera_wave(const Camera& camera, int size) {
  RayWave wave;
  wave.resize(size_t(size) * size_t(size));
  const double step = 2 * std::tan(camera.yfov / 2) / size;
  size_t i = 0;
  for (int by = 0; by < size; by += 4)
    for (int bx = 0; bx < size; bx += 4)
      for (int k = 0; k < 16; ++k) {
        const Vec3d film{(bx + k % 4 + 0.5 - size / 2.0) * step, (size / 2.0 - (by + k / 4) - 0.5) * step, -1};
        const Vec3d direction = normalize(transform_vector(camera.world_from_camera, film));
        wave.set(i++, {Vec3f(camera.world_from_camera.origin), Vec3f(direction)});
      }
  return wave;
}

RayWave shadow_wave(const RayWave& wave, const HitWave& hits, const Vec3f& p_light) {
  return from_hits(wave, hits, [&](const Vec3f& p) { return Rayf{p, p_light - p, 0, 1}; });
}

RayWave scattered_wave(const RayWave& wave, const HitWave& hits) {
  std::mt19937 rng(2);
  std::normal_distribution<float> gauss;
  return from_hits(wave, hits, [&](const Vec3f& p) {
    return Rayf{p, normalize(Vec3f{gauss(rng), gauss(rng), gauss(rng)})};
  });
}

}  // namespace alhazen
