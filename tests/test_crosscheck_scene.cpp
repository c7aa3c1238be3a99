// Scenes under the cross-check: their surfaces as subjects, their camera rays against the whole.
#include <gtest/gtest.h>

#include <deque>
#include <filesystem>
#include <set>

#include "crosscheck/edge_distance.h"
#include "crosscheck/native_subject.h"
#include "crosscheck/scene_check.h"
#include "crosscheck/scene_judge.h"
#include "crosscheck/scene_subjects.h"
#include "loaders/gltf.h"
#include "renderer/camera_ray.h"
#include "renderer/render.h"

namespace alhazen::crosscheck {
namespace {

Rayf aimed(const Vec3d& from, const Vec3d& at) { return {Vec3f(from), Vec3f(at - Vec3d(Vec3f(from)))}; }

TEST(EdgeDistance, IsZeroWhereALineTouches) {
  const auto ulp = [](const Surface& surface, const Rayf& ray) { return edge_distance({surface, {}}, ray)->ulp; };
  EXPECT_EQ(ulp(Sphere{5}, {{3, 4, -9}, {0, 0, 1}}), 0);
  EXPECT_EQ(ulp(Box{{2, 2, 2}}, {{-3, -3, 0.25f}, {1, 1, 0}}), 0);
  EXPECT_EQ(ulp(Disk{5, 0}, {{3, 1, 4}, {0, -1, 0}}), 0);
  EXPECT_EQ(ulp(Cylinder{4, 2, 2, true}, {{-4, 0, 0}, {1, 1, 0}}), 0);
  EXPECT_EQ(ulp(Cylinder{4, 2, 0, true}, {{-3, 5, 0}, {1, -1, 0}}), 0);
  EXPECT_EQ(ulp(Triangle{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}, {{1, 1, 3}, {0, 0, -1}}), 0);
}

TEST(EdgeDistance, NamesWhatIsNearest) {
  const auto feature = [](const Surface& surface, const Rayf& ray) {
    return std::string(edge_distance({surface, {}}, ray)->feature);
  };
  EXPECT_EQ(feature(Sphere{5}, {{3, 4.001f, -9}, {0, 0, 1}}), "silhouette");
  EXPECT_EQ(feature(Cylinder{4, 2, 2, true}, {{1.999f, 9, 0}, {0, -1, 0}}), "rim");
  EXPECT_EQ(feature(Cylinder{4, 2, 0, true}, aimed({-3, 2, 0}, {0, 1.999, 0})), "apex");
  EXPECT_EQ(feature(Box{{2, 2, 2}}, {{-3, -3.001f, 0.25f}, {1, 1, 0}}), "edge");
  const Triangle triangle{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
  EXPECT_EQ(feature(triangle, {{1, 0.001f, 3}, {0, 0, -1}}), "edge");
  EXPECT_EQ(feature(triangle, {{0, 0, 3}, {0, 0, -1}}), "vertex");
}

/// A ray at a point of a triangle's edge, nudged by floats: as many as that away, positive on the inner side.
TEST(EdgeDistance, CountsRoundingsAndItsSignIsThatOfTheHit) {
  Random random{1};
  int inside = 0, outside = 0;
  for (int k = 0; k < 500; ++k) {
    const Triangle t{random.in_cube(), random.in_cube(), random.in_cube()};
    Rayf ray = aimed(random.in_cube(4), t.a + (t.b - t.a) * random.uniform(0.2, 0.8));
    ray.direction.x = moved_by_floats(ray.direction.x, random.integer(-8, 8));
    const Subject subject{t, {}};
    const auto edge = edge_distance(subject, ray);
    ASSERT_TRUE(edge);
    EXPECT_LT(std::abs(edge->ulp), 32);
    const bool hit = Judge(subject).closest(ray).hit;
    (hit ? inside : outside) += 1;
    EXPECT_EQ(edge->ulp > 0, hit);
  }
  EXPECT_GT(inside, 100);
  EXPECT_GT(outside, 100);
}

TEST(EdgeDistance, DoesNotDependOnTheLengthOfTheDirection) {
  const Subject subject{Sphere{1}, {}};
  const double first = edge_distance(subject, {{0, 0.99f, -7}, {0, 0, 1}})->ulp;
  for (const float length : {0x1p-40f, 0x1p40f})
    EXPECT_EQ(edge_distance(subject, {{0, 0.99f, -7}, {0, 0, length}})->ulp, first);
}

TEST(NativeSubject, RoundsToFloatsAndSaysSo) {
  EXPECT_FALSE(native_subject({Sphere{0.5}, {}})->rounded);
  const auto rounded = native_subject({Sphere{0.1}, {}});
  EXPECT_TRUE(rounded->rounded);
  EXPECT_EQ(std::get<Sphere>(rounded->subject.surface).radius, double(0.1f));
  EXPECT_FALSE(native_subject({Sphere{1e-60}, {}}));
  EXPECT_FALSE(native_subject({Quadric{}, {}}));
  EXPECT_FALSE(native_subject({make_polygon({{{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}}}), {}}));
  EXPECT_TRUE(native_subject({make_polygon({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}), {}}));
}

TriangleMesh random_mesh(int triangles, Random& random) {
  TriangleMesh mesh;
  for (int k = 0; k < 3 * triangles; ++k) {
    const Vec3d corner =
        k % 3 == 0 ? random.in_cube(2) : Vec3d(mesh.positions[size_t(k / 3 * 3)]) + random.in_cube(0.9);
    mesh.positions.push_back(Vec3f(corner));
  }
  for (uint32_t k = 0; k < uint32_t(triangles); ++k) mesh.triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
  return mesh;
}

Affine3d random_place(Random& random) {
  Affine3d m;
  do {
    m = {random.in_cube(), random.in_cube(), random.in_cube(), random.in_cube(3)};
  } while (std::abs(determinant(m)) < 0.05);
  return m;
}

/// Shapes, a mesh of two parts in its place, and one placed twice.
Geometry random_geometry(Random& random) {
  Geometry geometry;
  geometry.shapes = {Sphere{1}, Cylinder{1, 0.5, 0.2, true}, Disk{0.7, 0.2}, Box{{0.5, 0.6, 0.7}}};
  for (uint32_t k = 0; k < 12; ++k) geometry.shape_instances.push_back({k % 4, 10 + k, 0, random_place(random)});
  geometry.meshes = {{"blob", {random_mesh(60, random), random_mesh(40, random)}},
                     {"shard", {random_mesh(30, random)}}};
  geometry.mesh_instances = {{0, 0, {}}, {1, 1, random_place(random)}, {1, 2, random_place(random)}};
  return geometry;
}

const std::vector<std::string> kNames = {"blob", "left", "right"};

TEST(SceneSubjects, EverySurfaceComesOnceBeforeAnyComesAgain) {
  Random random{4};
  const Geometry geometry = random_geometry(random);
  const auto families = scene_families(geometry, kNames, "triangle");
  ASSERT_EQ(families.size(), 1u);
  std::set<std::string> seen;
  for (uint64_t chunk = 0; chunk < 160; ++chunk) seen.insert(families[0].subject(chunk, false, random).origin);
  EXPECT_EQ(seen.size(), 160u);  // 100 of the blob, 30 of each shard
}

TEST(SceneSubjects, AreFoundByKindNodeAndMesh) {
  Random random{4};
  const Geometry geometry = random_geometry(random);
  const auto count = [&](const std::string& name) { return scene_families(geometry, kNames, name).size(); };
  EXPECT_EQ(count("all"), 5u);
  for (const char* name : {"sphere", "disk", "left", "2", "shard", "blob", "21"}) EXPECT_EQ(count(name), 1u) << name;
  EXPECT_EQ(count("torus"), 0u);
  const Family node = scene_families(geometry, kNames, "right")[0];
  EXPECT_EQ(node.subject(0, false, random).world_from_object, geometry.mesh_instances[2].world_from_object);
}

TEST(SceneSubjects, NoSurfaceOfASceneIsEverWrong) {
  Random random{5};
  const Geometry geometry = random_geometry(random);
  for (const Family& family : scene_families(geometry, kNames, "all"))
    for (int p = 0; p < int(Population::camera); ++p) {
      const Tally tally = check(family, Population(p), {.rays = 512}, {});
      EXPECT_EQ(tally.failures(), 0u) << family.name << " " << name_of(Population(p));
      EXPECT_EQ(tally.rays, 512u);
    }
}

/// Against every surface one by one, for rays in all directions, some along the axes.
TEST(SceneJudge, LeavesOutNothingThatARayMeets) {
  Random random{6};
  const Geometry geometry = random_geometry(random);
  const SceneBoxes boxes(geometry);
  const SceneJudge judge(boxes);
  std::deque<Judge> all;
  for (const Family& family : scene_families(geometry, kNames, "all"))
    for (uint64_t k = 0; k < (family.name == "triangle" ? 160 : 3); ++k)
      all.emplace_back(family.subject(k, false, random));
  int hits = 0;
  for (int k = 0; k < 400; ++k) {
    Rayf ray = aimed(random.in_cube(6), random.in_cube(3));
    if (k % 4 == 0) (k % 8 == 0 ? ray.direction.x : ray.direction.y) = 0;
    Judgement nearest;
    for (const Judge& one : all)
      if (const Judgement j = one.closest(ray); j.hit && (!nearest.hit || j.t < nearest.t)) nearest = j;
    const SceneTruth truth = judge.closest(ray);
    ASSERT_EQ(truth.nearest.hit, nearest.hit) << k;
    EXPECT_EQ(truth.nearest.t, nearest.t);
    hits += nearest.hit;
  }
  EXPECT_GT(hits, 100);
}

TEST(SceneCheck, ASceneOfNothingHasNothingWrong) {
  Geometry geometry;
  geometry.meshes = {{"empty", {TriangleMesh{}}}, {"void", {}}};
  geometry.mesh_instances = {{0, 0, {}}, {1, 1, {}}};
  EXPECT_TRUE(scene_families(geometry, kNames, "all").empty());
  const SceneCheck scene(geometry, kNames);
  PictureTally picture;
  const View view{8, 8, [](int x, int y) { return Rayf{{float(x), float(y), 9}, {0, 0, -1}}; }};
  const Tally tally = scene.check(view, {}, {}, picture);
  EXPECT_EQ(tally.of(Verdict::agree), 64u);
  EXPECT_EQ(tally.hits, 0u);
}

View view_of(const Camera& camera, int width, int height) {
  return {width, height, [=](int x, int y) { return camera_ray(camera, width, height, x + 0.5, y + 0.5); }};
}

TEST(SceneCheck, NoCameraRayIsWrongAndOneAloneGetsTheSameVerdict) {
  Random random{7};
  Geometry geometry = random_geometry(random);
  const Camera camera = framing_camera(geometry, 1.5);
  const SceneCheck scene(geometry, kNames);
  PictureTally picture;
  std::vector<Verdict> verdicts(96 * 64);
  Observer observer;
  observer.judged = [&](const Case& c) { verdicts[c.index] = c.verdict; };
  const Tally tally = scene.check(view_of(camera, 96, 64), {}, observer, picture);
  EXPECT_EQ(tally.failures(), 0u);
  EXPECT_EQ(tally.rays, 96u * 64);
  EXPECT_EQ(picture.pixels, 96u * 64);
  EXPECT_GT(tally.hits, 300u);
  EXPECT_GT(tally.b_asked, 500u);
  for (uint64_t pixel = 0; pixel < verdicts.size(); pixel += 611) {
    observer.judged = [&](const Case& c) {
      EXPECT_EQ(c.index, pixel);
      EXPECT_EQ(c.verdict, verdicts[pixel]);
    };
    EXPECT_EQ(scene.check(view_of(camera, 96, 64), {.only = pixel}, observer, picture).rays, 1u);
  }
}

/// What `PictureTally` takes the renderer's picture for is what the renderer makes.
TEST(SceneCheck, TheTruthIsWhatTheSignatureShows) {
  Random random{8};
  Scene scene;
  scene.geometry = random_geometry(random);
  scene.materials.emplace_back();
  const Camera camera = framing_camera(scene.geometry, 1);
  std::vector<Opacity> opacity;
  const SurfaceFilter filter = surface_filter(scene, opacity);
  const AcceleratedScene accelerated(scene.geometry, filter);
  RenderControl control;
  const RenderResult signature =
      render(scene, accelerated, camera, {.width = 64, .height = 64, .integrator = Integrator::signature}, control);
  const SceneCheck check(scene.geometry, kNames);
  PictureTally picture;
  uint64_t different = 0;
  Observer observer;
  observer.judged = [&](const Case& c) {
    const uint32_t node = *signature.ids.at(int(c.index % 64), int(c.index / 64));
    different += node != (c.truth.hit ? node_of(scene.geometry, c.object) : kNone);
  };
  (void)check.check(view_of(camera, 64, 64), {}, observer, picture);
  EXPECT_EQ(different, picture.other_surface);
  EXPECT_LE(different, 2u);
}

/// The scenes that another renderer's pictures come with, where they lie beside the project.
TEST(SceneCheck, NoCameraRayOfTheExamplesIsWrong) {
  if (!std::filesystem::is_directory(ALHAZEN_EXAMPLES)) GTEST_SKIP() << "no " << ALHAZEN_EXAMPLES;
  for (const auto& entry : std::filesystem::directory_iterator(ALHAZEN_EXAMPLES)) {
    if (entry.path().extension() != ".gltf") continue;
    Scene scene = load_gltf(entry.path(), [](const std::string&) {}).scene;
    bake_single_instances(scene.geometry);
    const Camera camera = scene.cameras.empty() ? framing_camera(scene.geometry, 1) : scene.cameras[0];
    const SceneCheck check(scene.geometry, scene.node_names);
    PictureTally picture;
    EXPECT_EQ(check.check(view_of(camera, 128, 128), {}, {}, picture).failures(), 0u) << entry.path();
    EXPECT_EQ(picture.other_surface, 0u) << entry.path();
  }
}

}  // namespace
}  // namespace alhazen::crosscheck
