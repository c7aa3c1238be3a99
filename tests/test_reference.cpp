// The reference accelerators and Embree see the same scenes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <random>

#include "accel/accelerated_scene.h"
#include "accel/reference/ladder.h"
#include "decide.h"
#include "loaders/gltf.h"
#include "loaders/image_decode.h"
#include "renderer/camera_ray.h"
#include "renderer/render.h"
#include "renderer/surface.h"
#include "tests/trials.h"

namespace alhazen {
namespace {

TriangleMesh bumpy_sheet(Rng& rng, int cells) {
  TriangleMesh part;
  for (int y = 0; y <= cells; ++y)
    for (int x = 0; x <= cells; ++x)
      part.positions.push_back(
          {float(x) / float(cells) - 0.5f, float(y) / float(cells) - 0.5f, float(uniform(rng, -0.1, 0.1))});
  for (int y = 0; y < cells; ++y)
    for (int x = 0; x < cells; ++x) {
      const auto at = [&](int i, int k) { return uint32_t(k * (cells + 1) + i); };
      part.triangles.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
      part.triangles.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
    }
  part.positions.reserve(part.positions.size() + 2);
  return part;
}

Affine3d random_place(Rng& rng, double reach) {
  return {uniform_vector(rng, -1, 1), uniform_vector(rng, -1, 1), uniform_vector(rng, -1, 1),
          uniform_vector(rng, -reach, reach)};
}

/// Shapes of all kinds and meshes, placed by maps that shear, mirror and scale, at the ends of a random tree of nodes;
/// one material in three lets light through.
Scene random_scene(uint32_t seed) {
  Rng rng(seed);
  Scene scene;
  scene.materials.resize(4);
  scene.materials[1].alpha_mode = AlphaMode::blend;
  scene.materials[1].base_color.a = 0.5f;
  Geometry& geometry = scene.geometry;
  geometry.meshes.push_back({"a", {bumpy_sheet(rng, 6), bumpy_sheet(rng, 3)}});
  geometry.meshes.push_back({"b", {bumpy_sheet(rng, 4)}});
  geometry.meshes[0].parts[1].first_primitive = 72, geometry.meshes[0].parts[1].material = 2;
  geometry.shapes = {Sphere{0.8f}, Cylinder{1.5f, 0.6f, 0.2f, true}, Disk{0.9f, 0.3f}, Box{{1, 0.7f, 1.2f}},
                     make_polygon({{{-1, -1, 0}, {1, -1, 0}, {0, 0, 0}, {1, 1, 0}, {-1, 1, 0}}})};
  constexpr uint32_t kNodes = 60;
  for (uint32_t node = 0; node < kNodes; ++node)
    geometry.parent_of_node.push_back(node < 3 ? kNone : uint32_t(uniform_int(rng, 0, int(node) - 1)));
  for (uint32_t node = 10; node < 20; ++node)
    geometry.mesh_instances.push_back({uint32_t(uniform_int(rng, 0, 1)), node, random_place(rng, 4)});
  for (uint32_t node = 15; node < kNodes; ++node)
    geometry.shape_instances.push_back({uint32_t(uniform_int(rng, 0, int(geometry.shapes.size()) - 1)), node,
                                        uint32_t(uniform_int(rng, 0, 2)), random_place(rng, 4)});
  return scene;
}

Camera perspective_camera() {
  Geometry ten_units;
  ten_units.shapes.push_back(Box{{10, 10, 10}});
  ten_units.shape_instances.push_back({0, 0, 0, {}});
  return framing_camera(ten_units, 4.0 / 3);
}
Camera orthographic_camera() {
  Camera camera = perspective_camera();
  camera.kind = Camera::Kind::orthographic, camera.ymag = 6;
  return camera;
}
Camera camera_inside() {
  Camera camera = perspective_camera();
  camera.world_from_camera.origin = {0.3, -0.2, 0.1}, camera.yfov = 2;
  return camera;
}

RayWave camera_rays(const Camera& camera, int width, int height) {
  RayWave rays;
  rays.resize(size_t(width) * size_t(height));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      rays.set(size_t(y * width + x), camera_ray(camera, width, height, x + 0.5, y + 0.5));
  return rays;
}

RayWave random_segments(uint32_t seed, size_t count) {
  Rng rng(seed);
  RayWave rays;
  rays.resize(count);
  for (size_t i = 0; i < count; ++i)
    rays.set(i, {Vec3f(uniform_vector(rng, -6, 6)), Vec3f(uniform_vector(rng, -1, 1)), 0, float(uniform(rng, 0, 20))});
  return rays;
}

/// A scene with what its accelerators refer to.
struct Subject {
  const Scene& scene;
  std::vector<Opacity> opacities;
  SurfaceFilter filter = surface_filter(scene, opacities);
  std::vector<Rung> rungs;
  AcceleratedScene embree{scene.geometry, filter};

  Subject(const Scene& s, const Camera& camera)
      : scene(s), rungs(reference_ladder(scene.geometry, filter, film_projection(camera))) {}
};

struct Answer {
  HitWave hits;
  TestCounts counts;
};
Answer closest(const Rung& rung, const RayWave& rays) {
  Answer answer;
  rung.accelerator->intersect(rays, answer.hits, answer.counts);
  return answer;
}

SurfaceIds signature(const Scene& scene, const HitWave& hits, size_t i) {
  if (hits.object[i] == kNone) return {kNone, kNone, kNone};
  return surface_ids(scene, {hits.object[i], hits.part[i], hits.primitive[i]});
}

void expect_same_bits(const HitWave& a, const HitWave& b, const std::string& name) {
  ASSERT_EQ(a.t.size(), b.t.size()) << name;
  for (size_t i = 0; i < a.t.size(); ++i) {
    ASSERT_EQ(a.object[i], b.object[i]) << name << ", ray " << i;
    if (a.object[i] == kNone) continue;
    ASSERT_EQ(a.t[i], b.t[i]) << name << ", ray " << i;
    ASSERT_EQ(a.part[i], b.part[i]) << name << ", ray " << i;
    ASSERT_EQ(a.primitive[i], b.primitive[i]) << name << ", ray " << i;
  }
}

/// Whether the reference sees `expected` along a line that floats can hardly tell from the ray: Embree's answer is then
/// as good as ours at a silhouette or an edge.
bool is_seen_beside(const Subject& subject, const Rayf& ray, const SurfaceIds& expected) {
  constexpr size_t kLines = 64;
  Rng rng(1);
  RayWave beside;
  beside.resize(kLines);
  for (size_t i = 0; i < kLines; ++i) {
    const Vec3d d = Vec3d(ray.direction) + uniform_vector(rng, -1, 1) * (1e-6 * double(length(ray.direction)));
    beside.set(i, {ray.origin, Vec3f(d), ray.t_min, ray.t_max});
  }
  const Answer answer = closest(subject.rungs[1], beside);
  for (size_t i = 0; i < kLines; ++i)
    if (signature(subject.scene, answer.hits, i) == expected) return true;
  return false;
}

/// That Embree's signature is the reference's, but for a ray in a thousand that grazes an edge.
void expect_signature_of(const Subject& subject, const HitWave& reference, const RayWave& rays) {
  HitWave hits;
  subject.embree.intersect(rays, Coherence::coherent, hits);
  size_t grazing = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    const SurfaceIds found = signature(subject.scene, hits, i);
    if (found == signature(subject.scene, reference, i)) continue;
    EXPECT_TRUE(is_seen_beside(subject, rays.get(i), found)) << "ray " << i;
    ++grazing;
  }
  EXPECT_LE(1000 * grazing, rays.size());
}

/// That all rungs and Embree see the same; how many of the rays hit something.
size_t expect_the_same_from_all(const Scene& scene, const Camera& camera, const RayWave& rays) {
  const Subject subject(scene, camera);
  const Answer reference = closest(subject.rungs[0], rays);
  for (const Rung& rung : subject.rungs) expect_same_bits(reference.hits, closest(rung, rays).hits, rung.name);
  expect_signature_of(subject, reference.hits, rays);
  const Lanes<uint32_t>& seen = reference.hits.object;
  return size_t(std::count_if(seen.data(), seen.data() + seen.size(), [](uint32_t object) { return object != kNone; }));
}

TEST(ReferenceAccelerators, AndEmbreeGiveOneSignatureOfRandomScenes) {
  for (uint32_t seed = 0; seed < uint32_t(trials(6)); ++seed) {
    const Scene scene = random_scene(seed);
    for (const Camera& camera : {perspective_camera(), orthographic_camera(), camera_inside()})
      EXPECT_GT(expect_the_same_from_all(scene, camera, camera_rays(camera, 80, 60)), 400u) << seed;
  }
}

TEST(ReferenceAccelerators, AgreeOnRaysOfNoCamera) {
  for (uint32_t seed = 0; seed < 6; ++seed)
    EXPECT_GT(expect_the_same_from_all(random_scene(seed), perspective_camera(), random_segments(seed, 2000)), 200u);
}

TEST(ReferenceAccelerators, AndEmbreeLetTheSameLightThrough) {
  for (uint32_t seed = 0; seed < 6; ++seed) {
    const Scene scene = random_scene(seed);
    const Subject subject(scene, perspective_camera());
    const RayWave rays = random_segments(seed, 2000);
    Lanes<Rgb> expected, visible;
    subject.embree.transmittance(rays, Coherence::incoherent, expected);
    size_t partly = 0;
    for (const Rung& rung : subject.rungs) {
      TestCounts counts;
      rung.accelerator->transmittance(rays, visible, counts);
      for (size_t i = 0; i < rays.size(); ++i) {
        EXPECT_NEAR(visible[i].g, expected[i].g, 1e-6f) << rung.name << ", ray " << i;
        partly += visible[i].g > 0 && visible[i].g < 1;
      }
    }
    EXPECT_GT(partly, 0u);
  }
}

TEST(ReferenceAccelerators, AtEqualDistanceNameTheFirst) {
  Scene scene;
  scene.materials.resize(1);
  scene.geometry.shapes = {Disk{1, 0}};
  for (uint32_t node = 0; node < 3; ++node) scene.geometry.shape_instances.push_back({0, node, 0, {}});
  RayWave rays;
  rays.resize(1);
  rays.set(0, {{0.1f, 2, 0.1f}, {0, -1, 0}});
  const Subject subject(scene, perspective_camera());
  for (const Rung& rung : subject.rungs) EXPECT_EQ(closest(rung, rays).hits.object[0], 0u) << rung.name;
}

TEST(ReferenceAccelerators, CountTheirTests) {
  const Scene scene = random_scene(1);
  const Camera camera = perspective_camera();
  const Subject subject(scene, camera);
  const RayWave rays = camera_rays(camera, 40, 30);
  uint64_t primitives = scene.geometry.shape_instances.size();
  for (const MeshInstance instance : scene.geometry.mesh_instances)
    for (const TriangleMesh& part : scene.geometry.meshes[instance.mesh].parts) primitives += part.triangles.size();
  const uint64_t objects = scene.geometry.mesh_instances.size() + scene.geometry.shape_instances.size();
  const TestCounts brute = closest(subject.rungs[0], rays).counts, boxes = closest(subject.rungs[1], rays).counts,
                   tree = closest(subject.rungs[2], rays).counts, screen = closest(subject.rungs[3], rays).counts;
  EXPECT_EQ(brute.primitives, primitives * rays.size());
  EXPECT_EQ(brute.boxes, 0u);
  EXPECT_EQ(boxes.boxes, objects * rays.size());
  EXPECT_EQ(screen.boxes, objects * rays.size());
  for (const TestCounts& counts : {boxes, tree, screen}) EXPECT_LT(counts.primitives, brute.primitives / 2);
}

TEST(ReferenceAccelerators, NodeTreeLeavesOutWholeBranches) {
  // Ten branches far apart, a hundred spheres below each.
  Scene scene;
  scene.materials.resize(1);
  scene.geometry.shapes = {Sphere{0.1f}};
  Rng rng(3);
  for (uint32_t branch = 0; branch < 10; ++branch) scene.geometry.parent_of_node.push_back(kNone);
  for (uint32_t i = 0; i < 1000; ++i) {
    Affine3d m;
    m.origin = uniform_vector(rng, -1, 1) + Vec3d{3.0 * (i % 10) - 15, 0, 0};
    scene.geometry.shape_instances.push_back({0, 10 + i, 0, m});
    scene.geometry.parent_of_node.push_back(i % 10);
  }
  const Camera camera = framing_camera(scene.geometry, 1);
  const Subject subject(scene, camera);
  const RayWave rays = camera_rays(camera, 32, 32);
  EXPECT_LT(closest(subject.rungs[2], rays).counts.boxes, closest(subject.rungs[1], rays).counts.boxes / 3);
}

TEST(ReferenceAccelerators, AnswerForAnEmptyScene) {
  Scene scene;
  scene.materials.resize(1);
  const Subject subject(scene, perspective_camera());
  const RayWave rays = camera_rays(perspective_camera(), 4, 4);
  for (const Rung& rung : subject.rungs)
    for (size_t i = 0; i < rays.size(); ++i) EXPECT_EQ(closest(rung, rays).hits.object[i], kNone);
}

TEST(ReferenceAccelerators, AndEmbreeGiveOneSignatureOfTheExamplesBesideTheProject) {
  namespace fs = std::filesystem;
  if (!fs::is_directory(ALHAZEN_EXAMPLES)) GTEST_SKIP() << "there is no " << ALHAZEN_EXAMPLES;
  size_t scenes = 0;
  for (const auto& entry : fs::directory_iterator(ALHAZEN_EXAMPLES)) {
    if (entry.path().extension() != ".gltf") continue;
    ++scenes;
    SCOPED_TRACE(entry.path().filename().string());
    LoadedScene loaded = load_gltf(entry.path(), [](const std::string&) {});
    decode_textures(loaded, [](const std::string&) {});
    bake_single_instances(loaded.scene.geometry);
    const Camera& camera = loaded.scene.cameras.at(0);
    EXPECT_GT(expect_the_same_from_all(loaded.scene, camera, camera_rays(camera, 80, 60)), 0u);
  }
  EXPECT_GT(scenes, 0u);
}

}  // namespace
}  // namespace alhazen
