// Our spheres (user geometry, exact to a rounding), also as general quadrics, beside Embree's own (SPHERE_POINT), one
// thread, the same packets.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <map>
#include <memory>

#include "accel/accelerated_scene.h"
#include "bench/baseline.h"
#include "bench/pairs.h"
#include "bench/scenes.h"
#include "renderer/render.h"

namespace alhazen {
namespace {

constexpr int kImageSize = 512;  // pixels a side; a multiple of the camera wave's blocks

/// A field of spheres in Embree's form and one of ours, and the three kinds of rays. Built when first asked for and
/// kept, since the largest takes a second.
struct Field {
  Field(int count, const std::string& form)
      : spheres(sphere_field(count)),
        geometry(form == "quadric" ? as_quadrics(spheres) : spheres),
        ours(geometry, {}),
        embree(spheres),
        camera(camera_wave(framing_camera(geometry, 1), kImageSize)) {
    HitWave hits;
    ours.intersect(camera, Coherence::coherent, hits);
    shadow = shadow_wave(camera, hits, {3, 5, 4});
    scattered = scattered_wave(camera, hits);
  }

  Geometry spheres, geometry;
  AcceleratedScene ours;
  EmbreeBaseline embree;
  RayWave camera, shadow, scattered;
};

const Field& field(int count, const std::string& form) {
  static std::map<std::pair<int, std::string>, std::unique_ptr<Field>> fields;
  auto& slot = fields[{count, form}];
  if (!slot) slot = std::make_unique<Field>(count, form);
  return *slot;
}

using Rays = RayWave Field::*;

void register_closest_hit(const std::string& form, const std::string& kind, int count, Rays rays, Coherence coherence) {
  const std::string what = "intersect/" + form + "/", how = "/" + kind + "/" + std::to_string(count);
  register_pair({what + "embree_builtin" + how, what + "user_geometry" + how, "Mray/s",
                 [=] {
                   const Field& f = field(count, form);
                   const RayWave& wave = f.*rays;
                   return Work{[&, coherence] { benchmark::DoNotOptimize(f.embree.intersect(wave, coherence)); },
                               double(wave.size())};
                 },
                 [=] {
                   const Field& f = field(count, form);
                   const RayWave& wave = f.*rays;
                   const auto hits = std::make_shared<HitWave>();
                   return Work{[&, coherence, hits] { f.ours.intersect(wave, coherence, *hits); }, double(wave.size())};
                 }});
}

void register_shadow(const std::string& form, int count) {
  const std::string what = "intersect/" + form + "/", how = "/shadow/" + std::to_string(count);
  register_pair({what + "embree_builtin" + how, what + "user_geometry" + how, "Mray/s",
                 [=] {
                   const Field& f = field(count, form);
                   return Work{[&] { benchmark::DoNotOptimize(f.embree.occluded(f.shadow, Coherence::coherent)); },
                               double(f.shadow.size())};
                 },
                 [=] {
                   const Field& f = field(count, form);
                   const auto visible = std::make_shared<Lanes<Rgb>>();
                   return Work{[&, visible] { f.ours.transmittance(f.shadow, Coherence::coherent, *visible); },
                               double(f.shadow.size())};
                 }});
}

[[maybe_unused]] const bool registered = [] {
  for (const int count : {1, 10'000, 1'000'000}) {
    for (const std::string form : {"sphere", "quadric"}) {
      register_closest_hit(form, "camera", count, &Field::camera, Coherence::coherent);
      register_shadow(form, count);
      register_closest_hit(form, "incoherent", count, &Field::scattered, Coherence::incoherent);
    }
  }
  return true;
}();

}  // namespace
}  // namespace alhazen
