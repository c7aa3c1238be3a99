// Geometry in motion: at each time of the shutter, rays meet it where it stands then.
#include <gtest/gtest.h>

#include <random>

#include "accel/accelerated_scene.h"
#include "accel/posed.h"

namespace alhazen {
namespace {

class Random {
 public:
  explicit Random(uint64_t seed) : rng_(seed) {}
  double uniform(double lower = -1, double upper = 1) {
    return std::uniform_real_distribution<double>(lower, upper)(rng_);
  }
  Vec3d in_cube(double half = 1) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }

 private:
  std::mt19937_64 rng_;
};

/// Turned, sheared, stretched a little.
Affine3d random_place(Random& random) {
  return {Vec3d{1, 0, 0} + random.in_cube(0.4), Vec3d{0, 1, 0} + random.in_cube(0.4),
          Vec3d{0, 0, 1} + random.in_cube(0.4), random.in_cube(3)};
}

Track<Affine3d> random_track(Random& random, const Affine3d& opening, size_t poses) {
  Track<Affine3d> track{opening};
  while (track.size() < poses) {
    const Affine3d next = random_place(random);
    track.push_back(mix(opening, next, 0.5f));
  }
  return track;
}

/// Triangles anywhere, with normals.
TriangleMesh random_part(Random& random, size_t triangles) {
  TriangleMesh part;
  for (uint32_t i = 0; i < triangles; ++i) {
    const Vec3d center = random.in_cube();
    for (int k = 0; k < 3; ++k) {
      part.positions.push_back(Vec3f(center + random.in_cube(0.5)));
      part.normals.push_back(Vec3f(normalize(random.in_cube())));
    }
    part.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return part;
}

Track<MeshPose> random_deformation(Random& random, const Mesh& mesh, size_t poses) {
  Track<MeshPose> track;
  for (size_t k = 0; k < poses; ++k) {
    MeshPose pose;
    for (const TriangleMesh& part : mesh.parts) {
      PartPose p{part.positions, part.normals, {}, {}};
      for (Vec3f& v : p.positions)
        if (k > 0) v = v + Vec3f(random.in_cube(0.3));
      pose.push_back(p);
    }
    track.push_back(pose);
  }
  return track;
}

/// A mesh that stands still, one that is moved, one that deforms, one that does both, placed twice; shapes of several
/// kinds, every second of which moves.
Geometry random_geometry(Random& random) {
  Geometry geometry;
  for (int i = 0; i < 4; ++i) geometry.meshes.push_back({"", {random_part(random, 20), random_part(random, 5)}});
  geometry.mesh_instances = {
      {0, 0, {}}, {1, 1, {}}, {2, 2, {}}, {3, 3, random_place(random)}, {3, 4, random_place(random)}};
  geometry.shapes = {Sphere{0.4}, Box{{0.5, 0.7, 0.3}}, Cylinder{1, 0.3, 0.2, true}, Disk{0.6, 0.2}};
  for (uint32_t i = 0; i < 12; ++i) geometry.shape_instances.push_back({i % 4, 5 + i, 0, random_place(random)});
  Motion& motion = geometry.motion;
  motion.meshes.resize(4), motion.places.resize(17);
  for (const size_t mesh : {2u, 3u}) motion.meshes[mesh] = random_deformation(random, geometry.meshes[mesh], mesh + 1);
  for (const uint32_t object : {1u, 3u, 6u, 8u, 10u, 12u, 14u, 16u})
    motion.places[object] = random_track(random, world_from_object(geometry, object, 0), 2 + object % 4);
  return geometry;
}

/// What stands there at that time, and does not move.
Geometry geometry_at(const Geometry& moving, float time) {
  Geometry still = moving;
  still.motion = {};
  for (uint32_t i = 0; i < still.mesh_instances.size(); ++i)
    still.mesh_instances.place(i, world_from_object(moving, i, time));
  for (uint32_t i = 0; i < still.shape_instances.size(); ++i)
    still.shape_instances[i].world_from_object =
        world_from_object(moving, uint32_t(still.mesh_instances.size()) + i, time);
  for (uint32_t m = 0; m < still.meshes.size(); ++m)
    for (size_t part = 0; part < still.meshes[m].parts.size(); ++part) {
      const PosedPart posed(moving.meshes[m].parts[part], part, track_of_mesh(moving, m), time);
      std::vector<Vec3f>& positions = still.meshes[m].parts[part].positions;
      for (size_t v = 0; v < positions.size(); ++v) positions[v] = posed.position(v);
    }
  return still;
}

RayWave random_rays(Random& random, size_t count) {
  RayWave rays;
  rays.resize(count);
  for (size_t i = 0; i < count; ++i) {
    const Vec3d origin = normalize(random.in_cube()) * 8.0;
    rays.set(i, {Vec3f(origin), Vec3f(normalize(random.in_cube(2) - origin))});
  }
  return rays;
}

void expect_hits_of_stills(bool watertight, Coherence coherence) {
  Random random(11);
  const BuildOptions options{.watertight = watertight};
  size_t hit = 0, different = 0, all = 0;
  for (int scene = 0; scene < 5; ++scene) {
    const Geometry geometry = random_geometry(random);
    const AcceleratedScene moving(geometry, {}, options);
    RayWave rays = random_rays(random, 1003);
    constexpr std::array<float, 8> kTimes{0, 0.125f, 0.2f, 0.37f, 0.5f, 0.71f, 0.93f, 1};
    rays.time.resize(rays.size());
    for (size_t i = 0; i < rays.size(); ++i) rays.time[i] = kTimes[i % kTimes.size()];  // side by side in each packet
    HitWave hits, expected;
    Lanes<Rgb> visible, expected_visible;
    moving.intersect(rays, coherence, hits);
    moving.transmittance(rays, coherence, visible);
    for (size_t t = 0; t < kTimes.size(); ++t) {
      const Geometry still = geometry_at(geometry, kTimes[t]);
      const AcceleratedScene accelerated(still, {}, options);
      accelerated.intersect(rays, Coherence::incoherent, expected);
      accelerated.transmittance(rays, Coherence::incoherent, expected_visible);
      for (size_t i = t; i < rays.size(); i += kTimes.size()) {
        ++all;
        const bool miss = hits.object[i] == kNone;
        const bool same = hits.object[i] == expected.object[i] &&
                          (miss || (hits.part[i] == expected.part[i] && hits.primitive[i] == expected.primitive[i]));
        different += !same || visible[i].r != expected_visible[i].r;
        if (!same || miss) continue;
        ++hit;
        if (is_shape(geometry, hits.object[i]))
          EXPECT_EQ(hits.t[i], expected.t[i]);
        else
          EXPECT_NEAR(hits.t[i], expected.t[i], 2e-5f);
      }
    }
  }
  EXPECT_GT(hit, all / 4);
  EXPECT_LE(different, all / 2000) << "of " << all;  // triangles' edges, by a rounding
}

TEST(Motion, RaysHitWhatStandsThereAtTheirTime) {
  expect_hits_of_stills(false, Coherence::incoherent);
  expect_hits_of_stills(false, Coherence::coherent);
}

TEST(Motion, WatertightTrianglesToo) { expect_hits_of_stills(true, Coherence::incoherent); }

TEST(Motion, AMeshMayTurnInsideOutBetweenTwoPoses) {
  Geometry geometry;
  TriangleMesh part;
  part.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, part.triangles = {{0, 1, 2}, {0, 2, 3}};
  geometry.meshes = {{"", {part}}}, geometry.mesh_instances = {{0, 0, {}}};
  const Affine3d half_turn{{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {}};  // through a point
  geometry.motion.places = {{Affine3d{}, half_turn}};
  const AcceleratedScene accelerated(geometry, {});
  RayWave rays;
  rays.resize(64), rays.time.resize(64);
  for (size_t i = 0; i < rays.size(); ++i) rays.set(i, {{0.5f, 0.5f, 3}, {0, 0, -1}}), rays.time[i] = float(i) / 64;
  HitWave hits;
  accelerated.intersect(rays, Coherence::incoherent, hits);
  for (size_t i = 0; i < rays.size(); ++i)
    EXPECT_TRUE(i == 16 || i == 48 || (hits.object[i] == 0) == (i < 16 || i > 48)) << i;
}

TEST(Motion, MomentsRunThroughAllPosesAndEndAtTheLast) {
  for (const size_t poses : {2u, 3u, 9u, 129u}) {
    EXPECT_EQ(moment(poses, 0).before, 0u);
    EXPECT_EQ(moment(poses, 0).fraction, 0.0f);
    EXPECT_EQ(moment(poses, 1).before, poses - 2);
    EXPECT_EQ(moment(poses, 1).fraction, 1.0f);
    for (size_t k = 0; k + 1 < poses; ++k) {
      const Moment m = moment(poses, (float(k) + 0.5f) / float(poses - 1));
      EXPECT_EQ(m.before, k);
      EXPECT_NEAR(m.fraction, 0.5f, 1e-4f);
    }
  }
}

}  // namespace
}  // namespace alhazen
