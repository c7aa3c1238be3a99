// What rays stand for: curvature against closed forms, cones against the neighbours of rays that are really mirrored
// and refracted, pictures against many samples.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "accel/accelerated_scene.h"
#include "materials/mipmap.h"
#include "renderer/camera_ray.h"
#include "renderer/render.h"
#include "renderer/surface.h"

namespace alhazen {
namespace {

Cone deflected(const Cone& cone, const Vec3f& d, const Vec3f& n, const Vec3f& direction, float eta, float curvature) {
  return {cone.width, deflected_spread(cone.width, cone.spread, d, n, direction, eta, curvature)};
}

/// Turned, moved and scaled by 3.
Affine3d somewhere() {
  Affine3d m;
  m.x = Vec3d{0.8, 0.36, 0.48} * 3.0, m.y = Vec3d{-0.6, 0.48, 0.64} * 3.0, m.z = Vec3d{0, -0.8, 0.6} * 3.0;
  m.origin = {30, 10, -20};
  return m;
}

/// A shape three times as large, and the point that p_object is nearest to on that face.
struct OneShape {
  Scene scene;
  HitIds ids;
  SurfacePoint point;

  OneShape(const Shape& shape, const Vec3d& p_object, int face) : ids{0, uint32_t(face), 0} {
    scene.materials.emplace_back();
    scene.geometry.shapes.push_back(shape);
    const Affine3d m = somewhere();
    scene.geometry.shape_instances.push_back({0, 0, 0, m});
    std::visit(
        [&](const auto& s) {
          const Vec3d p = project(s, p_object, face);
          point.p_world = transform_point(m, p);
          point.ng_world = point.ns_world = Vec3f(normalize(transform_normal(m, normal(s, p, face))));
        },
        shape);
  }
};

float curvature_of(const Shape& shape, const Vec3d& p_object, int face = kWallFace, float width = 1e-4f) {
  const OneShape one(shape, p_object, face);
  return mean_curvature(one.scene, one.ids, one.point, width);
}

float uv_per_metre_of(const Shape& shape, const Vec3d& p_object, int face = kWallFace) {
  OneShape one(shape, p_object, face);
  measure_shape_uvs(one.scene, one.ids, 0.01f, 0, one.point);
  EXPECT_GT(one.point.uv_per_metre[0], 0);
  return one.point.uv_per_metre[0];
}

Quadric quadric(const std::array<double, 10>& coefficients) {
  Quadric q;
  q.coefficients = coefficients;
  q.box = {{-2, -2, -2}, {2, 2, 2}};
  return q;
}

TEST(Curvature, OfShapesIsThatOfTheirFormulas) {
  EXPECT_NEAR(curvature_of(Sphere{2}, {0.3, -0.8, 0.5}), 1 / 6.0, 1e-4);
  EXPECT_NEAR(curvature_of(Cylinder{4, 2, 2, true}, {0.3, -0.8, 0.5}), 1 / 12.0, 1e-4);
  EXPECT_NEAR(curvature_of(Box{{1, 2, 3}}, {0.3, 1, 0.5}, 3), 0, 1e-6);
  // The bowl and the saddle y = x² ± z² at the origin; outside is where the form is positive, below the bowl.
  EXPECT_NEAR(std::abs(curvature_of(quadric({1, 0, 1, 0, 0, 0, 0, -0.5, 0, 0}), {0, 0, 0})), 2 / 3.0, 1e-3);
  EXPECT_NEAR(curvature_of(quadric({1, 0, -1, 0, 0, 0, 0, -0.5, 0, 0}), {0, 0, 0}), 0, 1e-3);
}

TEST(Curvature, OverMoreThanTheShapeIsBoundedByTheWidth) {
  for (const float width : {10.0f, 1e4f, 1e8f}) {
    const float turn = curvature_of(Sphere{2}, {0.3, -0.8, 0.5}, kWallFace, width) * width;
    EXPECT_GT(turn, 0.8f);
    EXPECT_LE(turn, 1.0001f);
  }
}

TEST(ShapeTextures, GoOverASurfaceAsFastAsTheirCoordinatesSay) {
  const double pi = std::numbers::pi;
  const Vec3d p = normalize(Vec3d{0.3, -0.8, 0.5}) * 2.0;
  const double on_sphere = 1 / std::sqrt(2 * pi * 3 * std::hypot(p.x, p.z) * pi * 6);
  EXPECT_NEAR(uv_per_metre_of(Sphere{2}, p), on_sphere, 0.01 * on_sphere);
  EXPECT_NEAR(uv_per_metre_of(Sphere{2}, {1e-9, 0, -2}), 1 / std::sqrt(2 * pi * 6 * pi * 6), 1e-3);  // at the seam
  EXPECT_NEAR(uv_per_metre_of(Cylinder{4, 2, 2, true}, {0.3, -0.8, 0.5}), 1 / std::sqrt(2 * pi * 6 * 12), 1e-3);
  EXPECT_NEAR(uv_per_metre_of(Box{{1, 2, 3}}, {0.3, 1, 0.5}, 3), 1 / std::sqrt(3.0 * 9), 1e-3);
}

/// A ball of radius 1 as rings of triangles with its normals.
TriangleMesh ball(int rings) {
  TriangleMesh mesh;
  const double pi = std::numbers::pi;
  for (int j = 0; j <= rings; ++j)
    for (int i = 0; i <= 2 * rings; ++i) {
      const double a = pi * i / rings, b = pi * j / rings;
      mesh.positions.push_back(Vec3f(Vec3d{std::sin(b) * std::sin(a), std::cos(b), std::sin(b) * std::cos(a)}));
    }
  const auto at = [&](int i, int j) { return uint32_t(j * (2 * rings + 1) + i); };
  for (int j = 1; j + 1 < rings; ++j)
    for (int i = 0; i < 2 * rings; ++i) {
      mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
      mesh.triangles.push_back({at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)});
    }
  mesh.normals = mesh.positions;
  return mesh;
}

TEST(Curvature, OfTrianglesIsThatOfTheirNormals) {
  Scene scene;
  scene.materials.emplace_back();
  scene.geometry.meshes = {{"ball", {ball(40)}}, {"facets", {ball(40)}}};
  scene.geometry.meshes[1].parts[0].normals.clear();
  Affine3d mirrored = somewhere();
  mirrored.x = -mirrored.x;
  scene.geometry.mesh_instances = {{0, 0, somewhere()}, {0, 1, mirrored}, {1, 2, somewhere()}};
  for (uint32_t triangle = 0; triangle < scene.geometry.meshes[0].parts[0].triangles.size(); triangle += 7) {
    EXPECT_NEAR(mean_curvature(scene, {0, 0, triangle}, {}, 1), 1 / 3.0, 1e-3);
    EXPECT_NEAR(mean_curvature(scene, {1, 0, triangle}, {}, 1), 1 / 3.0, 1e-3);
    EXPECT_EQ(mean_curvature(scene, {2, 0, triangle}, {}, 1), 0);
  }
}

/// How far apart rays leave a sphere of radius 1 for each metre that they arrive apart: across the plane of incidence
/// and along it. `out(d, n)`: where a ray goes on to.
template <class Out>
std::array<double, 2> turns(const Vec3d& d, const Vec3d& n, const Out& out) {
  const Vec3d across = normalize(cross(d, n)), along = cross(across, d);
  const auto neighbour = [&](const Vec3d& step) {
    const Vec3d q = n + step, b = d * dot(q, d);  // on the line q + t d, the nearest crossing before q
    const Vec3d foot = q - b;
    return normalize(foot - d * std::sqrt(1 - dot(foot, foot)));
  };
  constexpr double kStep = 1e-5;
  const Vec3d middle = out(d, n);
  const auto turn = [&](const Vec3d& side) {
    const Vec3d m = neighbour(side * kStep);
    const Vec3d moved = (m - n) - middle * dot(m - n, middle), turned = out(d, m) - middle;
    return std::array{length(turned) / kStep, length(moved) / kStep};
  };
  return {turn(across)[0], turn(along)[0]};
}

TEST(RayCone, WidensAtASphereAsTheNeighboursOfItsRayDo) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  const float width = 0.01f;
  for (int k = 0; k < 1000; ++k) {
    const Vec3d n = normalize(Vec3d{unit(rng), unit(rng), unit(rng)});
    const Vec3d d = normalize(Vec3d{unit(rng), unit(rng), unit(rng)}) - n;
    const Vec3d in = normalize(d);
    if (dot(in, n) > -0.2 || dot(in, n) < -0.999) continue;
    const auto mirror = [](const Vec3d& v, const Vec3d& m) { return v - m * (2 * dot(v, m)); };
    const auto mirrored = turns(in, n, mirror);
    const Cone a = deflected({width, 0}, Vec3f(in), Vec3f(n), Vec3f(mirror(in, n)), 1, 1);
    EXPECT_NEAR(a.spread / width, std::sqrt(mirrored[0] * mirrored[1]), 2e-3);
    EXPECT_NEAR(a.spread / width, 2, 2e-3);
    for (const double eta : {1 / 1.5, 1.2}) {
      const auto refract = [&](const Vec3d& v, const Vec3d& m) {
        const double c = -dot(v, m), sin2 = eta * eta * (1 - c * c);
        return v * eta + m * (eta * c - std::sqrt(std::max(0.0, 1 - sin2)));
      };
      if (eta * eta * (1 - dot(in, n) * dot(in, n)) > 0.9) continue;
      const auto refracted = turns(in, n, refract);
      const Cone b = deflected({width, 0}, Vec3f(in), Vec3f(n), Vec3f(refract(in, n)), float(eta), 1);
      EXPECT_NEAR(std::abs(b.spread) / width, std::sqrt(refracted[0] * refracted[1]), 3e-3);
      EXPECT_EQ(b.spread < 0, eta < 1);  // glass that bulges gathers light
    }
  }
}

TEST(RayCone, PassesThroughTheFocusOfAHollowMirrorAndIsLeftAloneByAFlatOne) {
  const Vec3f down{0, 0, -1}, up{0, 0, 1};
  const Cone hollow = deflected({0.1f, 0}, down, up, up, 1, -0.5f);  // radius 2: the focus lies 1 away
  EXPECT_NEAR(hollow.at(1).width, 0, 1e-7f);
  EXPECT_NEAR(hollow.at(1.5f).width, 0.05f, 1e-7f);
  EXPECT_NEAR(hollow.at(2).width, 0.1f, 1e-7f);
  EXPECT_NEAR(hollow.at(2).at(1).width, 0.2f, 1e-6f);  // it goes on as it went
  const Vec3f slanted = normalize(Vec3f{1, 0, -1}), mirrored = normalize(Vec3f{1, 0, 1});
  const Cone flat = deflected({0.1f, 0.02f}, slanted, up, mirrored, 1, 0);
  EXPECT_EQ(flat.width, 0.1f);
  EXPECT_EQ(flat.spread, 0.02f);
  const Cone wild = deflected({1e30f, 0}, down, up, up, 1, 1e30f);
  EXPECT_TRUE(std::isfinite(wild.at(1e30f).width));
}

/// A ball over a floor of small black and white squares, seen from above.
struct BallOverChecker {
  Scene scene;
  Camera camera;

  explicit BallOverChecker(const Material& of_ball, bool mesh, Mipmaps mipmaps) {
    constexpr int kSquares = 256;
    std::vector<uint8_t> texels;
    for (int y = 0; y < kSquares; ++y)
      for (int x = 0; x < kSquares; ++x) texels.push_back((x + y) % 2 ? 255 : 0);
    scene.images = {{kSquares, kSquares, 1, std::move(texels), {}}};
    add_smaller_levels(scene.images[0], ColorSpace::srgb);
    scene.textures = {Texture{.image = 0, .nearest = true, .mipmaps = mipmaps}};
    Material floor;
    floor.model = ShadingModel::unlit;
    floor.base_color_texture.texture = 0;
    scene.materials = {floor, of_ball, Material{}};
    TriangleMesh ground;
    ground.positions = {{-8, 0, -8}, {-8, 0, 8}, {8, 0, 8}, {8, 0, -8}};
    ground.triangles = {{0, 1, 2}, {0, 2, 3}};
    ground.uvs = {{{0, 0}, {0, 1}, {1, 1}, {1, 0}}};
    scene.geometry.meshes.push_back({"ground", {ground}});
    scene.geometry.mesh_instances.push_back({0, 0, {}});
    Affine3d m;
    m.origin = {0, 1.5, 0};
    if (mesh) {
      scene.geometry.meshes.push_back({"ball", {ball(64)}});
      scene.geometry.meshes[1].parts[0].material = 1;
      scene.geometry.mesh_instances.push_back({1, 1, m});
    } else {
      scene.geometry.shapes.push_back(Sphere{1});
      scene.geometry.shape_instances.push_back({0, 1, 1, m});
    }
    camera.yfov = 0.5;
    camera.world_from_camera.origin = {0, 1.5, 4};
  }

  /// The ball wears the squares.
  void paint() {
    scene.materials[1] = scene.materials[0];
    scene.materials[1].base_color_texture.xx = scene.materials[1].base_color_texture.yy = 2;
  }

  [[nodiscard]] std::vector<float> picture(int samples) const {
    std::vector<Opacity> opacity;
    const AcceleratedScene accelerated(scene.geometry, surface_filter(scene, opacity));
    RenderControl control;
    RenderOptions options;
    options.width = options.height = 48, options.samples = samples;
    return render(scene, accelerated, camera, options, control).color.pixels;
  }
};

/// Root mean square of what one sample a pixel is off; without a material the ball is painted.
double error_of_one_sample(const Material* of_ball, bool mesh, Mipmaps mipmaps) {
  const auto picture = [&](Mipmaps levels, int samples) {
    BallOverChecker subject(of_ball ? *of_ball : Material{}, mesh, levels);
    if (!of_ball) subject.paint();
    return subject.picture(samples);
  };
  const std::vector<float> one = picture(mipmaps, 1), many = picture(Mipmaps::none, 256);
  double squared = 0;
  for (size_t i = 0; i < one.size(); i += 4) squared += double(one[i] - many[i]) * double(one[i] - many[i]);
  return std::sqrt(squared / double(one.size() / 4));
}

TEST(RayCone, KeepsABallAndWhatIsSeenInOneAndThroughOneFromAliasing) {
  Material mirror, glass;
  mirror.model = glass.model = ShadingModel::phong;
  mirror.phong.diffuse = glass.phong.diffuse = mirror.phong.ambient = glass.phong.ambient = Rgb(0.0f);
  mirror.phong.reflection = Rgb(1.0f);
  glass.phong.transmission = Rgb(1.0f), glass.phong.ior = 1.5f;
  // Cones that keep their spread at the mirror leave 0.58 of it.
  const auto expect_filtered = [](const Material* ball, bool mesh) {
    const double unfiltered = error_of_one_sample(ball, mesh, Mipmaps::none);
    const double filtered = error_of_one_sample(ball, mesh, Mipmaps::linear);
    EXPECT_GT(unfiltered, 0.25);
    EXPECT_LT(filtered, 0.3 * unfiltered);
  };
  expect_filtered(&mirror, false);
  expect_filtered(&mirror, true);
  expect_filtered(&glass, false);
  expect_filtered(nullptr, false);
}

}  // namespace
}  // namespace alhazen
