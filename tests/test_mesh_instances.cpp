// Lists of instances, and the clusters that traversal makes of them.
#include <gtest/gtest.h>

#include <set>

#include "accel/accelerated_scene.h"
#include "accel/instance_clusters.h"
#include "accel/instance_geometry.h"
#include "accel/shape_bounds.h"
#include "decide.h"

namespace alhazen {
namespace {

Affine3d random_map(Rng& rng, double spread) {
  return {uniform_vector(rng, -1, 1), uniform_vector(rng, -1, 1), uniform_vector(rng, -1, 1),
          uniform_vector(rng, -spread, spread)};
}

InstanceArray random_array(Rng& rng, uint32_t node, uint32_t count, bool turned, bool scaled) {
  InstanceArray array{.mesh = node % 3, .node = node, .world_from_node = random_map(rng, 10), .count = count};
  for (uint32_t k = 0; k < count; ++k) {
    array.translations.push_back(Vec3f(uniform_vector(rng, -100, 100)));
    const Vec3f v(uniform_vector(rng, -1, 1));
    if (turned) array.rotations.push_back({v.x, v.y, v.z, float(uniform(rng, -1, 1))});
    if (scaled) array.scales.push_back(Vec3f(uniform_vector(rng, 0.5, 2)));
  }
  return array;
}

bool same(const MeshInstance& a, const MeshInstance& b) {
  return a.mesh == b.mesh && a.node == b.node && a.world_from_object == b.world_from_object;
}

TEST(MeshInstances, AreNumberedAsTheyComeWhetherAloneOrInArrays) {
  Rng rng(1);
  MeshInstances placed;
  std::vector<MeshInstance> expected;
  for (uint32_t node = 0; node < 40; ++node) {
    if (uniform_int(rng, 0, 1)) {
      const MeshInstance alone{node % 3, node, random_map(rng, 10)};
      placed.push_back(alone), expected.push_back(alone);
      continue;
    }
    const auto count = uint32_t(uniform_int(rng, 0, 60));  // none, few, and more than few
    const InstanceArray array = random_array(rng, node, count, node % 2 == 0, node % 5 == 0);
    for (uint32_t k = 0; k < count; ++k) expected.push_back({array.mesh, node, world_from_object(array, k)});
    placed.append(array);
  }
  ASSERT_EQ(placed.size(), expected.size());
  for (size_t i = 0; i < expected.size(); ++i) {
    EXPECT_TRUE(same(placed[i], expected[i])) << i;
    EXPECT_EQ(placed.mesh_of(i), expected[i].mesh) << i;
    EXPECT_EQ(placed.node_of(i), expected[i].node) << i;
  }
  size_t i = 0;
  for (const MeshInstance instance : placed) EXPECT_TRUE(same(instance, expected[i++]));
  EXPECT_EQ(i, expected.size());
}

TEST(MeshInstances, ArraysPlaceByTranslationAfterRotationAfterScaleBelowTheirNode) {
  // A quarter turn about z: x goes to y. Then the node doubles everything.
  const float half = std::sqrt(0.5f);
  InstanceArray array{.world_from_node = {{2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {0, 0, 1}}, .count = 1};
  array.translations = {{10, 0, 0}}, array.rotations = {{0, 0, half, half}}, array.scales = {{3, 1, 1}};
  const Vec3d p = transform_point(world_from_object(array, 0), Vec3d{1, 0, 0});
  EXPECT_NEAR(p.x, 20, 1e-5);
  EXPECT_NEAR(p.y, 6, 1e-5);
  EXPECT_NEAR(p.z, 1, 1e-5);
  array.rotations = {{0, 0, 0, 0}};  // turns nothing
  EXPECT_NEAR(transform_point(world_from_object(array, 0), Vec3d{1, 0, 0}).x, 26, 1e-5);
}

const Bounds3d kUnitBox{{-1, -2, 0}, {1, 3, 0.5}};

TEST(InstanceClusters, HoldEveryInstanceOnceAndAllOfIt) {
  Rng rng(2);
  for (const double spread : {0.0, 1e-3, 10.0, 1e6}) {
    MeshInstances placed;
    placed.push_back({1, 0, {}});
    for (uint32_t i = 0; i < 1003; ++i) placed.push_back({0, i, random_map(rng, spread)});
    const auto clusters = cluster_instances(placed, 1, 1003, kUnitBox);
    EXPECT_EQ(clusters.size(), (1003 + InstanceCluster::kMost - 1) / InstanceCluster::kMost);
    std::multiset<uint32_t> seen;
    for (const InstanceCluster& cluster : clusters)
      for (uint32_t k = 0; k < cluster.count; ++k) {
        seen.insert(cluster.objects[k]);
        const Bounds3f wanted = instance_box(placed.world_from_object(cluster.objects[k]), kUnitBox),
                       box = cluster.box_of(k);
        for (const auto axis : {&Vec3f::x, &Vec3f::y, &Vec3f::z}) {
          EXPECT_LE(box.lower.*axis, wanted.lower.*axis);
          EXPECT_GE(box.upper.*axis, wanted.upper.*axis);
          EXPECT_LE(cluster.box.lower.*axis, wanted.lower.*axis);
          EXPECT_GE(cluster.box.upper.*axis, wanted.upper.*axis);
          // No more than two steps wider.
          EXPECT_LE(wanted.lower.*axis - box.lower.*axis, 2 * cluster.step.*axis);
          EXPECT_LE(box.upper.*axis - wanted.upper.*axis, 2 * cluster.step.*axis);
        }
        for (const Vec3d& corner : corners(kUnitBox)) {
          const Vec3d p = transform_point(placed.world_from_object(cluster.objects[k]), corner);
          EXPECT_TRUE(p.x >= box.lower.x && p.x <= box.upper.x && p.y >= box.lower.y && p.y <= box.upper.y &&
                      p.z >= box.lower.z && p.z <= box.upper.z);
        }
      }
    std::multiset<uint32_t> expected;
    for (uint32_t i = 1; i <= 1003; ++i) expected.insert(i);
    EXPECT_EQ(seen, expected);
  }
}

TEST(InstanceClusters, AreTightAroundAGrid) {
  MeshInstances placed;
  for (int x = 0; x < 16; ++x)
    for (int y = 0; y < 16; ++y)
      for (int z = 0; z < 16; ++z)
        placed.push_back({0, 0, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {10.0 * x, 10.0 * y, 10.0 * z}}});
  for (const InstanceCluster& cluster : cluster_instances(placed, 0, 4096, {{-1, -1, -1}, {1, 1, 1}}))
    EXPECT_LT(max_component(cluster.box.upper - cluster.box.lower), 12.1f);  // two in a row
}

TEST(InstanceClusters, LeaveOutOnlyWhatTraversalCannotReach) {
  MeshInstances placed;
  for (const double x : {0.0, 1e19, 3.0, 1e300, -2e18, 7.0})
    placed.push_back({0, 0, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {x, 0, 0}}});
  const auto clusters = cluster_instances(placed, 0, uint32_t(placed.size()), kUnitBox);
  ASSERT_EQ(clusters.size(), 1u);
  EXPECT_EQ(std::set<uint32_t>(clusters[0].objects.begin(), clusters[0].objects.begin() + clusters[0].count),
            (std::set<uint32_t>{0, 2, 5}));
  EXPECT_TRUE(cluster_instances(placed, 0, uint32_t(placed.size()), {}).empty());  // a mesh without triangles
}

/// What is the smaller object where several lie in one place, whichever way rays come in packets.
TEST(InstanceGroup, OfInstancesInOnePlaceTheFirstIsHit) {
  Geometry geometry;
  TriangleMesh part;
  part.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, part.triangles = {{0, 1, 2}};
  part.positions.reserve(part.positions.size() + 1);
  geometry.meshes = {{"", {part}}};
  for (uint32_t i = 0; i < 3 * kLeastInstanceGroup; ++i)
    geometry.mesh_instances.push_back(
        {0, 0, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {3.0 * (i % kLeastInstanceGroup), 0, 0}}});
  const AcceleratedScene scene(geometry, {});
  Rng rng(3);
  RayWave rays;
  rays.resize(1000);
  for (size_t i = 0; i < rays.size(); ++i)
    rays.set(i, {Vec3f(3.0f * float(i), float(uniform(rng, -0.5, 0.2)), 5), {0, 0, -1}, 0, HUGE_VALF});
  for (const Coherence coherence : {Coherence::coherent, Coherence::incoherent}) {
    HitWave hits;
    scene.intersect(rays, coherence, hits);
    for (size_t i = 0; i < rays.size(); ++i) EXPECT_EQ(hits.object[i], i);
  }
}

TEST(InstanceGroup, TakesLessThanAMatrixForEach) {
  constexpr uint32_t kCount = 100000;
  Rng rng(4);
  Geometry geometry;
  TriangleMesh part;
  part.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, part.triangles = {{0, 1, 2}};
  part.positions.reserve(part.positions.size() + 1);
  geometry.meshes = {{"", {part}}};
  for (uint32_t i = 0; i < kCount; ++i) geometry.mesh_instances.push_back({0, 0, random_map(rng, 500)});
  const AcceleratedScene scene(geometry, {});
  const double hierarchy = double(scene.bytes()) / kCount,
               clusters = double(sizeof(InstanceCluster)) / InstanceCluster::kMost;
  EXPECT_LT(hierarchy + clusters, 12 * sizeof(float));
}

}  // namespace
}  // namespace alhazen
