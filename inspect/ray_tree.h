// The rays that one sample of a pixel is made of, as they were traced: plain data for writers and tests.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "renderer/trace_observer.h"

namespace alhazen {

/// Light that a ray adds to its pixel. Added up in ascending order, in floats, a tree's terms are the sample's value.
struct Addend {
  uint32_t order = 0;
  Rgb light;
};

struct TermAddend {
  LightTerm term;
  Addend addend;
};

/// A surface on the way to a light.
struct Occluder {
  uint32_t node, material;  // of glTF; kNone: the default material
  float distance;           // metres from the surface that is lit
  Rgb transmittance;
};

/// One light on a surface.
struct TreeLight {
  uint32_t light = 0;                 // index into Scene::lights
  Rayf shadow{};                      // the shadow ray
  float distance = 0;                 // metres to the light; infinite for directional ones
  Rgb arriving{};                     // colour x intensity x attenuation
  Rgb attenuation{};                  // what distance, range and cone leave of the light's colour x intensity
  Rgb diffuse{}, specular{};          // the surface's response to light of 1
  Rgb visible{};                      // share that the occluders let through
  std::vector<Occluder> occluders{};  // nearest first; found by tracing once more
  Addend addend{};
};

enum class RayEnd : uint8_t {
  shaded,        // at a surface; its branches, if any, are rays of their own
  unnoticed,     // at a surface within a body of higher priority: goes straight on
  missed,        // nothing hit: the background or the environment
  depth_limit,   // not traced: too deep
  weight_limit,  // not traced: counts too little
};

/// A surface that a ray hits.
struct TreeHit {
  uint32_t object;  // of Geometry
  SurfaceIds ids;
  uint32_t material;  // index into Scene::materials
  float distance;     // metres from the ray's origin
  Vec3d p_world;
  Vec3f ng_world, ns_world;  // geometric and shading normal, unit; the latter turned towards the ray's origin
  std::optional<Vec2f> uv;
  bool enters;
  float alpha;
  Rgb arriving;  // the ray's weight after what the medium took
};

struct TreeRay {
  uint32_t parent = kNone;  // index; parents come before their children
  RayKind kind = RayKind::camera;
  bool total = false;  // a mirror ray where nothing is refracted
  uint16_t depth = 0;
  Rgb weight{1.0f};  // of what it finds in the sample's value
  Rayf ray;
  std::vector<uint32_t> media;  // materials of the bodies that it starts in
  RayEnd end = RayEnd::missed;
  float uncovered = 0;  // share of the pixel that shows a transparent background
  std::optional<TreeHit> hit;
  std::optional<Interface> interface;
  std::vector<TermAddend> terms;
  std::vector<TreeLight> lights;
};

struct RayTree {
  int x = 0, y = 0, width = 0, height = 0;  // the pixel, and the picture's size
  int sample = 0, samples = 1;
  std::optional<float> time{};  // of the shutter, from 0 to 1, where anything moves
  std::vector<TreeRay> rays{};  // the camera ray first
  Rgb radiance{};               // of the sample
  Rgb pixel{};                  // of all samples, as the picture has it
  float alpha = 1;
};

/// Sums up what a ray adds to the pixel by itself.
[[nodiscard]] Rgb own_light(const TreeRay& ray) noexcept;

/// For each ray, what it and all rays that come of it add.
[[nodiscard]] std::vector<Rgb> branch_light(const RayTree& tree);

/// For each ray, the rays that it spawned, in their order.
[[nodiscard]] std::vector<std::vector<uint32_t>> children(const RayTree& tree);

/// All addends summed up in floats in their order, as the renderer does.
[[nodiscard]] Rgb sum_in_order(const RayTree& tree);

}  // namespace alhazen
