#include "loaders/gltf_extensions.h"

#include <algorithm>

#include "loaders/image_ktx.h"

namespace alhazen {
namespace {

using enum Treatment;

constexpr KnownExtension kKnown[] = {
    {"ALHAZEN_lights", supported, ""},
    {"ALHAZEN_materials_measured", supported, "MERL files and tables of samples"},
    {"ALHAZEN_materials_phong", supported, ""},
    {"ALHAZEN_shapes", supported, ""},
    {"EXT_lights_image_based", supported, ""},
    {"EXT_mesh_gpu_instancing", supported, "instances of the hierarchy"},
    {"EXT_mesh_manifold", ignored, "nothing to see"},
    {"EXT_meshopt_compression", supported, "all modes and filters"},
    {"EXT_texture_webp", supported, ""},
    {"FB_ngon_encoding", supported, "polygon meshes"},
    {"KHR_accessor_float64", approximated, "numbers are rounded to 32 bits"},
    {"KHR_animation_pointer", supported, "what the picture shows"},
    {"KHR_audio_graph", ignored, "nothing to see"},
    {"KHR_collision_shapes", ignored, "colliders are not seen"},
    {"KHR_draco_mesh_compression", supported, ""},
    {"KHR_gaussian_splatting", ignored, "splats are left out"},
    {"KHR_implicit_shapes", ignored, "colliders are not seen"},
    {"KHR_interactivity", ignored, "nothing to see"},
    {"KHR_lights_punctual", supported, "range and spot cones too"},
    {"KHR_materials_anisotropy", supported, ""},
    {"KHR_materials_clearcoat", supported, "a normal texture of its own too"},
    {"KHR_materials_diffuse_transmission", supported, "for lights and ambient light"},
    {"KHR_materials_dispersion", approximated, "three wavelengths"},
    {"KHR_materials_emissive_strength", supported, ""},
    {"KHR_materials_ior", supported, "0 too"},
    {"KHR_materials_iridescence", supported, ""},
    {"KHR_materials_pbrSpecularGlossiness", supported, "as a dielectric of that reflectance"},
    {"KHR_materials_sheen", supported, ""},
    {"KHR_materials_specular", supported, ""},
    {"KHR_materials_transmission", approximated, "clear whatever the roughness"},
    {"KHR_materials_unlit", supported, ""},
    {"KHR_materials_variants", supported, "--variant chooses"},
    {"KHR_materials_volume", supported, "bodies refract and dim; shadows take the thickness"},
    {"KHR_materials_volume_scatter", ignored, "bodies are clear"},
    {"KHR_mesh_quantization", supported, ""},
    {"KHR_meshopt_compression", supported, "all modes and filters"},
    {"KHR_node_hoverability", ignored, "nothing to see"},
    {"KHR_node_selectability", ignored, "nothing to see"},
    {"KHR_node_visibility", supported, "hidden cameras can be used"},
    {"KHR_physics_rigid_bodies", ignored, "nothing moves"},
    {"KHR_texture_basisu", kDecodesKtx ? supported : approximated,
     kDecodesKtx ? "" : "built without libktx: the fallback image is seen, else the material's factor"},
    {"KHR_texture_transform", supported, "on every texture, texCoord too"},
    {"KHR_xmp", ignored, "nothing to see"},
    {"KHR_xmp_json_ld", ignored, "nothing to see"},
    {"MSFT_lod", supported, "the finest level is seen"},
    {"MSFT_texture_dds", supported, "formats that OpenImageIO decodes"},
};

}  // namespace

std::span<const KnownExtension> known_extensions() { return kKnown; }

bool is_known(const std::string& name) {
  return std::any_of(std::begin(kKnown), std::end(kKnown), [&](const KnownExtension& e) { return e.name == name; });
}

Extension treat_extension(const std::string& name, bool required) {
  const auto* known =
      std::find_if(std::begin(kKnown), std::end(kKnown), [&](const KnownExtension& e) { return e.name == name; });
  if (known == std::end(kKnown)) return {name, required, ignored, "not known, what it brings is left out"};
  return {name, required, known->treatment, std::string(known->meaning)};
}

}  // namespace alhazen
