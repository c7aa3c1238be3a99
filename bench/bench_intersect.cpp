// Our shapes, exact to a rounding, beside Embree's own, one thread, the same rays: spheres beside SPHERE_POINT, general
// quadrics beside both, watertight triangles beside Embree's, polygons beside Embree's triangles.
#include <benchmark/benchmark.h>

#include <cmath>
#include <list>
#include <map>
#include <memory>

#include "accel/accelerated_scene.h"
#include "bench/baseline.h"
#include "bench/contest.h"
#include "bench/scenes.h"
#include "renderer/render.h"

namespace alhazen {
namespace {

constexpr int kImageSize = 512;  // pixels a side; a multiple of the camera wave's blocks

/// Who traces a wave, one way or the other.
struct Tracer {
  std::function<void(const RayWave&, Coherence)> closest, shadow;
};

Tracer ours(const Geometry& geometry, const BuildOptions& options = {}) {
  const auto scene = std::make_shared<AcceleratedScene>(geometry, SurfaceFilter{}, options);
  const auto hits = std::make_shared<HitWave>();
  const auto visible = std::make_shared<Lanes<Rgb>>();
  return {[=](const RayWave& rays, Coherence coherence) { scene->intersect(rays, coherence, *hits); },
          [=](const RayWave& rays, Coherence coherence) { scene->transmittance(rays, coherence, *visible); }};
}

Tracer embree(const std::shared_ptr<EmbreeBaseline>& scene, Call call) {
  return {[=](const RayWave& rays, Coherence c) { benchmark::DoNotOptimize(scene->intersect(rays, c, call)); },
          [=](const RayWave& rays, Coherence c) { benchmark::DoNotOptimize(scene->occluded(rays, c, call)); }};
}

/// A scene, three waves of rays, and who traces them: "ours" and its rivals.
struct Field {
  std::list<Geometry> geometries;
  RayWave camera, shadow, incoherent;
  std::map<std::string, Tracer> tracers;

  void add_waves(const Geometry& geometry, const Vec3f& p_light) {
    camera = camera_wave(framing_camera(geometry, 1), kImageSize);
    HitWave hits;
    AcceleratedScene(geometry, {}).intersect(camera, Coherence::coherent, hits);
    shadow = shadow_wave(camera, hits, p_light);
    incoherent = scattered_wave(camera, hits);
  }
};

constexpr Vec3f kLight{3, 5, 4};

void add_spheres(Field& field, int count, bool as_quadric) {
  field.geometries = {sphere_field(count)};
  const Geometry& spheres = field.geometries.front();
  const auto points = std::make_shared<EmbreeBaseline>(spheres);
  field.add_waves(spheres, kLight);
  field.tracers["embree"] = embree(points, Call::packets);
  field.tracers["embree_single"] = embree(points, Call::single);
  field.tracers[as_quadric ? "sphere" : "ours"] = ours(spheres);
  if (as_quadric) field.tracers["ours"] = ours(field.geometries.emplace_back(as_quadrics(spheres)));
}

void add_triangles(Field& field, int count) {
  field.geometries = {geometry_of(hills(int(std::sqrt(count / 2.0))))};
  const Geometry& mesh = field.geometries.front();
  field.add_waves(mesh, kLight);
  field.tracers["embree_robust"] = embree(std::make_shared<EmbreeBaseline>(mesh, true), Call::packets);
  field.tracers["embree"] = embree(std::make_shared<EmbreeBaseline>(mesh, false), Call::packets);
  field.tracers["ours"] = ours(mesh, {.watertight = true});
}

void add_polygons(Field& field, int count) {
  HexagonField hexagons = hexagon_field(count);
  field.geometries.push_back(std::move(hexagons.polygons));
  field.geometries.push_back(std::move(hexagons.triangles));
  const Geometry &polygons = field.geometries.front(), &triangles = field.geometries.back();
  field.add_waves(polygons, kLight);
  field.tracers["embree_robust"] = embree(std::make_shared<EmbreeBaseline>(triangles, true), Call::packets);
  field.tracers["embree"] = embree(std::make_shared<EmbreeBaseline>(triangles, false), Call::packets);
  field.tracers["ours"] = ours(polygons);
}

std::unique_ptr<Field> make_field(const std::string& kind, int count) {
  auto field = std::make_unique<Field>();
  if (kind == "triangle")
    add_triangles(*field, count);
  else if (kind == "polygon")
    add_polygons(*field, count);
  else
    add_spheres(*field, count, kind == "quadric");
  return field;
}

/// Built when first asked for and kept, since the largest takes seconds.
const Field& field(const std::string& kind, int count) {
  static std::map<std::pair<std::string, int>, std::unique_ptr<Field>> fields;
  auto& slot = fields[{kind, count}];
  if (!slot) slot = make_field(kind, count);
  return *slot;
}

using Rays = RayWave Field::*;
using Query = std::function<void(const RayWave&, Coherence)> Tracer::*;

void register_waves(const std::string& kind, int count, const std::vector<std::string>& rivals) {
  const auto add = [&](const std::string& name, Rays rays, Query query, Coherence coherence) {
    const auto prepare = [=](const std::string& who) {
      return [=] {
        const Field& f = field(kind, count);
        return Work{[&, rays, query, coherence, who] { (f.tracers.at(who).*query)(f.*rays, coherence); },
                    double((f.*rays).size())};
      };
    };
    Contest contest{
        "intersect/" + kind + "/" + name + "/" + std::to_string(count), "Mray/s", Clock::thread, prepare("ours"), {}};
    for (const std::string& rival : rivals) contest.rivals.push_back({rival, prepare(rival)});
    register_contest(contest);
  };
  add("camera", &Field::camera, &Tracer::closest, Coherence::coherent);
  add("shadow", &Field::shadow, &Tracer::shadow, Coherence::coherent);
  add("incoherent", &Field::incoherent, &Tracer::closest, Coherence::incoherent);
}

[[maybe_unused]] const bool registered = [] {
  for (const int count : {1, 10'000, 1'000'000}) {
    register_waves("sphere", count, {"embree", "embree_single"});
    register_waves("quadric", count, {"embree", "embree_single", "sphere"});
  }
  for (const int count : {10'000, 1'000'000}) register_waves("triangle", count, {"embree_robust", "embree"});
  register_waves("polygon", 10'000, {"embree_robust", "embree"});
  return true;
}();

}  // namespace
}  // namespace alhazen
