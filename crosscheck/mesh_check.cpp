#include "crosscheck/mesh_check.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdio>
#include <cstring>

#include "accel/traversal_bounds.h"
#include "core/fork_join.h"
#include "crosscheck/ball.h"
#include "crosscheck/embree_scene.h"
#include "crosscheck/subject.h"
#include "crosscheck/triangle_scene.h"

namespace alhazen::crosscheck {
namespace {

constexpr uint64_t kChunkRays = 4096;
constexpr size_t kChunksAtOnce = 32;

/// What one ray meets in all of its length, by one kind of test.
struct Passage {
  int met = 0, net = 0;  // faces; left less entered
  void add(int direction) { ++met, net += direction; }
};

struct RayPassages {
  Passage watertight, half_spaces, cramer;
  float nearest = HUGE_VALF;
};

/// 1 where the ray leaves through the triangle, -1 where it enters. Exact.
int outward(const Triangle& t, const Rayf& ray) {
  try {
    const Vec3<Ball<double>> a(t.a), b(t.b), c(t.c), d(Vec3d(ray.direction));
    return sign(dot(cross(b - a, c - a), d));
  } catch (const InDoubt&) {
    const Vec3<Rational> a = exact(t.a), b = exact(t.b), c = exact(t.c);
    return sgn(dot(cross(b - a, c - a), exact(Vec3d(ray.direction))));
  }
}

/// A user geometry that lets every ray pass and notes what it meets.
struct Notebook {
  std::span<const Triangle> triangles;
  std::vector<RayPassages> of_ray;
};

void write_bounds(const RTCBoundsFunctionArguments* args) {
  const Bounds3f b =
      traversal_bounds(bounds(static_cast<const Notebook*>(args->geometryUserPtr)->triangles[args->primID]));
  *args->bounds_o = {b.lower.x, b.lower.y, b.lower.z, 0, b.upper.x, b.upper.y, b.upper.z, 0};
}

void note(const RTCIntersectFunctionNArguments* args) {
  Notebook& book = *static_cast<Notebook*>(args->geometryUserPtr);
  const Triangle& triangle = book.triangles[args->primID];
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    embree::reject(args, i);
    const Rayf ray = ray_of(args, i);
    RayPassages& passages = book.of_ray[RTCRayN_id(RTCRayHitN_RayN(args->rayhit, args->N), args->N, i)];
    if (const auto t = hit_triangle(triangle, ray)) {
      passages.watertight.add(outward(triangle, ray));
      passages.nearest = std::min(passages.nearest, *t);
    }
    const Rayd wide{Vec3d(ray.origin), Vec3d(ray.direction), ray.t_min, ray.t_max};
    if (intersect_by_half_spaces(triangle, wide)) passages.half_spaces.add(outward(triangle, ray));
    if (intersect_by_cramer(triangle, wide)) passages.cramer.add(outward(triangle, ray));
  }
}

std::vector<Triangle> triangles_of(const ClosedMesh& mesh) {
  std::vector<Triangle> list;
  for (const auto& f : mesh.faces) list.push_back({mesh.vertices[f[0]], mesh.vertices[f[1]], mesh.vertices[f[2]]});
  return list;
}

/// Embree's own triangles.
void attach_native(EmbreeScene& scene, const ClosedMesh& mesh) {
  RTCGeometry g = embree::new_geometry(EmbreeScene::device(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* v = static_cast<Vec3f*>(
      rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), mesh.vertices.size()));
  for (size_t k = 0; k < mesh.vertices.size(); ++k) v[k] = Vec3f(mesh.vertices[k]);
  void* indices =
      rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), mesh.faces.size());
  std::memcpy(indices, mesh.faces.data(), mesh.faces.size() * sizeof(mesh.faces[0]));
  scene.attach(g);
  scene.commit();
}

enum class Start : uint8_t { near_center, center, outside };

struct AimedRay {
  Rayf ray;
  Start start = Start::near_center;
};

AimedRay aimed_ray(const ClosedMesh& mesh, Aim aim, uint64_t number, Random random) {
  const auto& face = mesh.faces[random.bits() % mesh.faces.size()];
  const Vec3d &a = mesh.vertices[face[0]], &b = mesh.vertices[face[1]], &c = mesh.vertices[face[2]];
  AimedRay out;
  out.start = number % 16 == 1 ? Start::center : number % 4 == 0 ? Start::outside : Start::near_center;
  Vec3d origin = mesh.center;
  if (out.start == Start::near_center) origin += random.in_cube(0.1);
  if (out.start == Start::outside) origin += random.on_sphere() * mesh.outside;
  out.ray.origin = Vec3f(origin);
  const double s = random.coin() ? 0.5 : random.uniform(0, 1), r = random.uniform(0, 1);
  const Vec3d on_edge = a + (b - a) * s;
  const Vec3d target = aim == Aim::vertex ? a : aim == Aim::edge ? on_edge : on_edge + (c - on_edge) * r;
  const Vec3d to = target - Vec3d(out.ray.origin);
  out.ray.direction = Vec3f(random.coin() || out.start == Start::center ? to : normalize(to));
  return out;
}

/// One mesh inside every kind of scene.
class MeshScenes {
 public:
  explicit MeshScenes(const ClosedMesh& mesh)
      : triangles_(triangles_of(mesh)), notebook_{triangles_, {}}, watertight_(triangles_) {
    attach_native(native_, mesh);
    attach_native(robust_, mesh);
    RTCGeometry g = embree::new_geometry(EmbreeScene::device(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(g, unsigned(triangles_.size()));
    rtcSetGeometryUserData(g, &notebook_);
    rtcSetGeometryBoundsFunction(g, write_bounds, nullptr);
    rtcSetGeometryIntersectFunction(g, note);
    noting_.attach(g);
    noting_.commit();
  }

  /// Everything that each ray meets.
  const std::vector<RayPassages>& passages(std::span<const Rayf> rays) {
    notebook_.of_ray.assign(rays.size(), {});
    noting_.trace(rays, [](auto&&...) {});
    return notebook_.of_ray;
  }
  [[nodiscard]] std::vector<float> closest(std::span<const Rayf> rays) const {
    std::vector<float> t(rays.size(), HUGE_VALF);
    watertight_.trace(rays, [&](size_t k, uint32_t, float at) { t[k] = at; });
    return t;
  }
  [[nodiscard]] std::vector<bool> native_hits(std::span<const Rayf> rays, bool robust) const {
    std::vector<bool> hit(rays.size(), false);
    (robust ? robust_ : native_).trace(rays, [&](size_t k, auto&&...) { hit[k] = true; });
    return hit;
  }

 private:
  std::vector<Triangle> triangles_;
  Notebook notebook_;
  TriangleScene watertight_;
  EmbreeScene native_{false}, robust_{true}, noting_{true};
};

/// False where something is wrong with what the ray meets.
bool count(LeakCount& leaks, const Passage& passage, Start start) {
  const bool miss = start != Start::outside && passage.met == 0;
  const bool odd = !miss && passage.net != (start == Start::outside ? 0 : 1);
  const bool shared = !miss && start == Start::center && passage.met != 1;
  leaks.misses += miss, leaks.odd += odd, leaks.shared += shared;
  return !miss && !odd && !shared;
}

std::string described(const Rayf& r, uint64_t number) {
  char text[300];
  std::snprintf(text, sizeof text, "ray %llu: origin (%a, %a, %a), direction (%a, %a, %a)",
                static_cast<unsigned long long>(number), double(r.origin.x), double(r.origin.y), double(r.origin.z),
                double(r.direction.x), double(r.direction.y), double(r.direction.z));
  return text;
}

void check_chunk(MeshScenes& scenes, const ClosedMesh& mesh, uint64_t first, uint64_t end, uint64_t seed,
                 MeshTally& tally) {
  std::vector<AimedRay> aimed;
  std::vector<Rayf> rays;
  for (uint64_t k = first; k < end; ++k) {
    aimed.push_back(aimed_ray(mesh, tally.aim, k, {seed, uint64_t(tally.aim), k, 4}));
    rays.push_back(aimed.back().ray);
  }
  const std::vector<RayPassages>& passages = scenes.passages(rays);
  const std::vector<float> closest = scenes.closest(rays);
  const std::vector<bool> native = scenes.native_hits(rays, false), robust = scenes.native_hits(rays, true);
  for (size_t k = 0; k < rays.size(); ++k) {
    const Start start = aimed[k].start;
    ++tally.rays, tally.from_outside += start == Start::outside, tally.from_center += start == Start::center;
    const bool tight = count(tally.watertight, passages[k].watertight, start);
    count(tally.half_spaces, passages[k].half_spaces, start), count(tally.cramer, passages[k].cramer, start);
    const bool nearest = closest[k] == passages[k].nearest;
    tally.not_nearest += !nearest;
    if (start != Start::outside) tally.native_misses += !native[k], tally.robust_misses += !robust[k];
    if ((!tight || !nearest) && tally.first_failure.empty()) tally.first_failure = described(rays[k], first + k);
  }
}

void add(LeakCount& sum, const LeakCount& more) {
  sum.misses += more.misses, sum.odd += more.odd, sum.shared += more.shared;
}
void add(MeshTally& sum, const MeshTally& more) {
  sum.rays += more.rays, sum.from_outside += more.from_outside, sum.from_center += more.from_center;
  add(sum.watertight, more.watertight), add(sum.half_spaces, more.half_spaces), add(sum.cramer, more.cramer);
  sum.not_nearest += more.not_nearest;
  sum.native_misses += more.native_misses, sum.robust_misses += more.robust_misses;
  if (sum.first_failure.empty()) sum.first_failure = more.first_failure;
}

MeshTally check_mesh(const ClosedMesh& mesh, Aim aim, uint64_t rays, uint64_t seed, const std::function<bool()>& stop) {
  MeshTally sum{.mesh = mesh.name, .aim = aim};
  const uint64_t chunks = (rays + kChunkRays - 1) / kChunkRays;
  for (uint64_t from = 0; from < chunks && !stop(); from += kChunksAtOnce) {
    std::vector<MeshTally> tallies(std::min<uint64_t>(kChunksAtOnce, chunks - from), {.mesh = mesh.name, .aim = aim});
    {
      const ForkJoin order;
      tbb::parallel_for(size_t(0), tallies.size(), order.task([&](size_t k) {
        const uint64_t first = (from + k) * kChunkRays;
        MeshScenes scenes(mesh);
        check_chunk(scenes, mesh, first, std::min(first + kChunkRays, rays), seed, tallies[k]);
      }));
    }
    for (const MeshTally& tally : tallies) add(sum, tally);
  }
  return sum;
}

}  // namespace

const char* name_of(Aim aim) {
  constexpr const char* names[kAims] = {"anywhere", "vertex", "edge"};
  return names[size_t(aim)];
}

void check_meshes(uint64_t rays, uint64_t seed, const std::function<bool()>& stop,
                  const std::function<void(const MeshTally&)>& done) {
  const std::vector<ClosedMesh> meshes = closed_meshes(seed);
  const uint64_t each = (rays + meshes.size() - 1) / meshes.size();
  for (const ClosedMesh& mesh : meshes)
    for (int aim = 0; aim < kAims; ++aim)
      if (!stop()) done(check_mesh(mesh, Aim(aim), each, seed, stop));
}

}  // namespace alhazen::crosscheck
