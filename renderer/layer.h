// Layers: what a picture is made of, pixel by pixel, from the same rays as the picture itself.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace alhazen {

/// Of the surface that a pixel's first sample hits: depth, position, uv, node, primitive, material; as the mean over
/// the samples: all others. emission, ambient, background, direct, reflected and refracted add up to the picture.
enum class Layer : uint8_t {
  albedo,            // base or diffuse colour
  normal,            // shading normal, world space, towards the eye
  geometric_normal,  // of the surface itself, world space, outward
  depth,             // metres along the camera's axis; infinite where nothing is hit
  position,          // metres, world space
  uv,                // TEXCOORD_0
  node,              // glTF's index; kNone: none
  primitive,
  material,
  emission,    // and what is unlit
  ambient,     // light without a place
  background,  // and the environment, where the view meets it
  direct,      // of all lights
  lights,      // the same of each light: a layer for each
  reflected,   // all that comes by mirror rays
  refracted,   // all that comes by refracted rays
  shadow,      // share of the lights' light that arrives; 1 where none could
  samples,
  rays,  // of all kinds, for a sample
  cost,  // microseconds of one processor for a sample: shading, and an even share of what the traversal of waves took
  crypto_node,  // mattes of everything named: Cryptomatte, six ranks in three images
  crypto_mesh,
  crypto_material,
};
inline constexpr size_t kLayers = 23;

[[nodiscard]] const char* layer_name(Layer layer);

/// The pixels of a layer: floats, or the integers of ids.
struct LayerImage {
  std::string name;                   // as OpenEXR names layers: "albedo", "direct.lamp"
  std::vector<std::string> channels;  // "R", "G", "B"; "X", "Y", "Z"; "U", "V"; "Z"; "Y"
  std::vector<float> floats;          // interleaved; empty where the layer holds ids
  std::vector<uint32_t> ids;
  bool exact = false;                                           // its floats must arrive to the bit
  std::vector<std::pair<std::string, std::string>> attributes;  // of the file that holds it
};

}  // namespace alhazen
