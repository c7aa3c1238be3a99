// A scene as plain data: indices instead of pointers; nothing here knows files, Embree or threads.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "accel/geometry.h"
#include "core/transform.h"
#include "materials/material.h"
#include "materials/measured_brdf.h"
#include "renderer/environment.h"

namespace alhazen {

/// KHR_lights_punctual, placed. Directions are unit length in world space.
struct Light {
  enum class Kind : uint8_t { directional, point, spot };
  std::string name;
  Kind kind = Kind::point;
  Rgb intensity;                                 // colour x intensity: lux (directional) or candela
  Vec3d p_world;                                 // of a point or spot light
  Vec3d direction_world{0, 0, -1};               // along which a directional or spot light shines
  float range = 0;                               // metres; 0: unlimited
  float cos_inner = 1, cos_outer = 0.70710678f;  // spot cone
  bool attenuated = true;                        // inverse-square and range; false: ALHAZEN_lights "none"
  Track<Light> track;                            // while the shutter is open
};

/// Looks along its own -z, y up. `world_from_camera` is a rotation and a translation, never a scale.
struct Camera {
  enum class Kind : uint8_t { perspective, orthographic };
  std::string name;
  Kind kind = Kind::perspective;
  double yfov = 0.8;  // radians, the whole vertical angle
  double ymag = 1;    // metres, half the height of an orthographic view
  Affine3d world_from_camera;
  Track<Camera> track;  // while the shutter is open
};

struct Scene {
  Geometry geometry;
  std::vector<Material> materials;  // the file's, then glTF's default material as the last one
  std::vector<Texture> textures;
  std::vector<TextureImage> images;
  std::vector<MeasuredBrdf> measured;
  std::vector<Light> lights;
  std::vector<Camera> cameras;          // one for each node that carries one, in node order
  std::vector<uint32_t> camera_index;   // for each of `cameras`, its index in the file's `cameras`
  std::vector<std::string> node_names;  // by glTF node index
  Rgb ambient{0.0f}, background{0.0f};
  bool has_ambient = false, has_background = false;  // whether the file says
  std::optional<Environment> environment;            // light from all around, in addition to the ambient light
};

[[nodiscard]] inline TextureTable texture_table(const Scene& scene) { return {&scene.textures, &scene.images}; }

/// Of a material whose model is `measured`.
[[nodiscard]] inline MeasuredBsdf measured_bsdf(const Scene& scene, const Material& material) {
  return {&scene.measured[material.measured.brdf], material.measured.scale};
}

}  // namespace alhazen
