#include <gtest/gtest.h>

#include "accel/accelerated_scene.h"
#include "accel/shape_hits.h"
#include "crosscheck/mesh_check.h"
#include "crosscheck/spawn_check.h"

namespace alhazen::crosscheck {
namespace {

const auto kNeverStop = [] { return false; };

TEST(ClosedMeshes, DoNotLeakAndHaveOneOwnerForEachTie) {
  uint64_t rays = 0, embree = 0;
  check_meshes(2000, 5, kNeverStop, [&](const MeshTally& tally) {
    EXPECT_EQ(tally.failures(), 0u) << tally.mesh << ", " << name_of(tally.aim) << ": " << tally.first_failure;
    EXPECT_GT(tally.from_center, 0u);
    rays += tally.rays, embree += tally.native_misses;
  });
  EXPECT_EQ(rays, 6000u);
  EXPECT_GT(embree, 0u);  // the rays are such that others leak
}

TEST(SpawnedRays, DoNotMeetWhatTheyLeft) {
  check_spawning(2000, 5, kNeverStop, [](const SpawnTally& tally) {
    EXPECT_GE(tally.hits, 2000u);
    EXPECT_EQ(tally.self_hits, 0u) << tally.first_failure;
  });
}

TEST(Traversal, LosesNoRayThatMeetsAShapeWhereItTouchesItsBounds) {
  Random random{7};
  Geometry geometry;
  geometry.shapes = {Box{{2, 2, 2}}, Sphere{1}};
  geometry.shape_instances.push_back({0, 0, 0, {}});
  for (int k = 0; k < 20; ++k) {
    Affine3d m;
    m.origin = {300.0 + 3 * k, 0, 0};
    geometry.shape_instances.push_back({1, 0, 0, m});
  }
  const AcceleratedScene scene(geometry, {});
  RayWave wave;
  wave.resize(20000);
  for (size_t k = 0; k < wave.size(); ++k) {
    Vec3d origin = random.on_sphere() * random.decades(0.5, 2.3), target = random.in_cube();
    const int axis = random.integer(0, 2);
    const double side = random.coin() ? 1 : -1, other = random.coin() ? 1 : -1;
    target = axis == 0   ? Vec3d{side, other, target.z}
             : axis == 1 ? Vec3d{target.x, side, other}
                         : Vec3d{other, target.y, side};
    wave.set(k, {Vec3f(origin), Vec3f(target - Vec3d(Vec3f(origin)))});
  }
  HitWave hits;
  scene.intersect(wave, Coherence::incoherent, hits);
  const Affine3d home;
  int met = 0;
  for (size_t k = 0; k < wave.size(); ++k) {
    std::vector<ShapeHit> found;
    append_hits({line_map(home), &home, &geometry.shapes[0]}, wave.get(k), found);
    EXPECT_EQ(hits.object[k] == 0, !found.empty());
    met += !found.empty();
  }
  EXPECT_GT(met, 10000);
}

}  // namespace
}  // namespace alhazen::crosscheck
