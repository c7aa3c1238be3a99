#include "crosscheck/spawn_check.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdio>

#include "core/fork_join.h"
#include "crosscheck/population.h"
#include "renderer/surface.h"

namespace alhazen::crosscheck {
namespace {

constexpr uint64_t kChunkRays = 2048;
constexpr size_t kChunksAtOnce = 32;

void place(const Triangle& t, const Affine3d& world_from_object, Geometry& geometry) {
  TriangleMesh part;
  part.positions = {Vec3f(t.a), Vec3f(t.b), Vec3f(t.c)};
  part.triangles = {{0, 1, 2}};
  geometry.meshes.emplace_back().parts.push_back(std::move(part));
  geometry.mesh_instances.push_back({0, 0, world_from_object});
}

template <class S>
void place(const S& shape, const Affine3d& world_from_object, Geometry& geometry) {
  geometry.shapes.emplace_back(shape);
  geometry.shape_instances.push_back({0, 0, 0, world_from_object});
}

/// Triangles come at home: every other one is to be an instance.
Affine3d anywhere(uint64_t chunk, Random& random) {
  return built_in_families().front().subject(chunk, false, random).world_from_object;
}

/// As the renderer has it: triangles are Embree's own.
Geometry geometry_of(const Subject& subject) {
  Geometry geometry;
  std::visit([&](const auto& surface) { place(surface, subject.world_from_object, geometry); }, subject.surface);
  return geometry;
}

std::string described(const std::string& family, const Rayf& first, const Rayf& spawned) {
  char text[500];
  const auto v = [](const Vec3f& p) { return Vec3d(p); };
  const Vec3d o = v(first.origin), d = v(first.direction), p = v(spawned.origin), q = v(spawned.direction);
  std::snprintf(text, sizeof text, "%s: ray (%a, %a, %a) + t (%a, %a, %a) spawned (%a, %a, %a) + t (%a, %a, %a)",
                family.c_str(), o.x, o.y, o.z, d.x, d.y, d.z, p.x, p.y, p.z, q.x, q.y, q.z);
  return text;
}

/// A subject in a scene, and the rays that meet it.
class SpawnChunk {
 public:
  SpawnChunk(const Family& family, uint64_t chunk, uint64_t count, uint64_t seed, SpawnTally& tally)
      : family_(family), tally_(tally) {
    Random random{seed, chunk, uint64_t(family.name.size()), uint64_t(family.name.front()), 5};
    subject_ = family.subject(chunk, false, random);
    if (family.name == "triangle" && chunk % 2) subject_.world_from_object = anywhere(chunk, random);
    scene_.geometry = geometry_of(subject_);
    const AcceleratedScene accelerated(scene_.geometry, {}, {.threads = 1});
    std::vector<Rayf> rays;
    const Judge judge(subject_);
    const RayMaker maker(subject_, judge);
    for (uint64_t k = 0; k < count; ++k)
      rays.push_back(maker.ray(random.coin() ? Population::uniform : Population::aimed, random));
    trace(accelerated, rays, hits_);
    for (size_t k = 0; k < rays.size(); ++k)
      if (hits_.object[k] != kNone) spawn(rays[k], k, random);
    trace(accelerated, spawned_, hits_);
    for (size_t k = 0; k < spawned_.size(); ++k) judge_spawned(k);
  }

 private:
  static void trace(const AcceleratedScene& scene, const std::vector<Rayf>& rays, HitWave& hits) {
    RayWave wave;
    wave.resize(rays.size());
    for (size_t k = 0; k < rays.size(); ++k) wave.set(k, rays[k]);
    scene.intersect(wave, Coherence::incoherent, hits);
  }

  void spawn(const Rayf& ray, size_t k, Random& random) {
    const SurfacePoint point = surface_point(scene_, ray, {hits_.object[k], hits_.part[k], hits_.primitive[k]},
                                             hits_.t[k], hits_.u[k], hits_.v[k]);
    // Outward of closed bodies, to the side where the ray came from of all others.
    Vec3f direction(random.on_sphere());
    if (const Vec3f outward = away_from(ray, point); dot(outward, direction) < 0) direction = -direction;
    from_.push_back(ray);
    spawned_.push_back({spawn_origin(point, direction), direction});
  }

  [[nodiscard]] Vec3f away_from(const Rayf& ray, const SurfacePoint& point) const {
    const bool is_closed = std::holds_alternative<Sphere>(subject_.surface) ||
                           std::holds_alternative<Cylinder>(subject_.surface) ||
                           std::holds_alternative<Box>(subject_.surface);
    const bool flip = !is_closed && dot(point.ng_world, ray.direction) > 0;
    return flip ? -point.ng_world : point.ng_world;
  }

  void judge_spawned(size_t k) {
    ++tally_.hits;
    if (hits_.object[k] == kNone) return;
    ++tally_.self_hits;
    if (tally_.first_failure.empty()) tally_.first_failure = described(family_.name, from_[k], spawned_[k]);
  }

  const Family& family_;
  SpawnTally& tally_;
  Subject subject_;
  Scene scene_;
  HitWave hits_;
  std::vector<Rayf> from_, spawned_;
};

void add(SpawnTally& sum, const SpawnTally& more) {
  sum.hits += more.hits, sum.self_hits += more.self_hits;
  if (sum.first_failure.empty()) sum.first_failure = more.first_failure;
}

SpawnTally check_family(const Family& family, uint64_t hits, uint64_t seed, const std::function<bool()>& stop) {
  SpawnTally sum{.family = family.name};
  for (uint64_t from = 0; sum.hits < hits && !stop(); from += kChunksAtOnce) {
    // About every second ray meets its subject.
    const uint64_t wanted = 3 * (hits - sum.hits) / kChunkRays + 1;
    std::vector<SpawnTally> tallies(std::min<uint64_t>(kChunksAtOnce, wanted));
    {
      const ForkJoin order;
      tbb::parallel_for(size_t(0), tallies.size(),
                        order.task([&](size_t k) { SpawnChunk(family, from + k, kChunkRays, seed, tallies[k]); }));
    }
    for (const SpawnTally& tally : tallies) add(sum, tally);
  }
  return sum;
}

}  // namespace

void check_spawning(uint64_t hits, uint64_t seed, const std::function<bool()>& stop,
                    const std::function<void(const SpawnTally&)>& done) {
  for (const char* name :
       {"sphere", "ellipsoid", "cylinder", "cone", "box", "disk", "ring", "polygon", "star", "triangle"})
    for (const Family& family : built_in_families())
      if (family.name == name && !stop()) done(check_family(family, hits, seed, stop));
}

}  // namespace alhazen::crosscheck
