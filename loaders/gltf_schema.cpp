#include "loaders/gltf_schema.h"

#include <numbers>

#include "accel/geometry.h"
#include "loaders/gltf_layers.h"
#include "loaders/gltf_shapes.h"
#include "loaders/json_check.h"

namespace alhazen {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr uint64_t kMaxOffset = uint64_t{1} << 53;
const char* const kLights = "/extensions/KHR_lights_punctual/lights";
const char* const kImageLights = "/extensions/EXT_lights_image_based/lights";

void check_version(const JsonRef& r) {
  text()(r);
  if (!r.as<std::string>().starts_with("2.")) r.expected("version 2.x");
}

// ---- Buffers ----

Check buffer() { return object({{"byteLength", integer(0, kMaxOffset), required}, {"uri", text()}}); }

Check multiple_of_4(uint64_t low, uint64_t high) {
  return both(integer(low, high), [](const JsonRef& r) {
    if (r.as<uint64_t>() % 4) r.expected("a multiple of 4");
  });
}

/// What the mode and the filter ask of stride and count.
void check_meshopt_layout(const JsonRef& r) {
  const auto mode = r["mode"].as<std::string>(), filter = r.get("filter", std::string("NONE"));
  const bool attributes = mode == "ATTRIBUTES";
  const auto stride_is = [&](std::vector<uint64_t> strides) { one_of(std::move(strides))(r["byteStride"]); };
  if (attributes) multiple_of_4(4, 256)(r["byteStride"]);
  if (!attributes) stride_is({2, 4});
  if (!attributes && filter != "NONE") r["filter"].expected("NONE, as mode " + mode + " has it");
  if (mode == "TRIANGLES" && r["count"].as<uint64_t>() % 3) r["count"].expected("a multiple of 3");
  if (filter == "OCTAHEDRAL" || filter == "COLOR") stride_is({4, 8});
  if (filter == "QUATERNION") stride_is({8});
}

Check meshopt(std::vector<std::string> filters) {
  return both(object({{"buffer", index_into("/buffers"), required},
                      {"byteOffset", integer(0, kMaxOffset)},
                      {"byteLength", integer(0, kMaxOffset), required},
                      {"byteStride", integer(1, 256), required},
                      {"count", integer(1, kNone - 1), required},
                      {"mode", one_of(std::vector<std::string>{"ATTRIBUTES", "TRIANGLES", "INDICES"}), required},
                      {"filter", one_of(std::move(filters))}}),
              check_meshopt_layout);
}

Check buffer_view() {
  return object(
      {{"buffer", index_into("/buffers"), required},
       {"byteOffset", integer(0, kMaxOffset)},
       {"byteLength", integer(0, kMaxOffset), required},
       {"byteStride", multiple_of_4(0, 252)},
       {"extensions",
        object({{"EXT_meshopt_compression", meshopt({"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"})},
                {"KHR_meshopt_compression", meshopt({"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL", "COLOR"})}})}});
}

Check accessor() {
  const Check indices = object({{"bufferView", index_into("/bufferViews"), required},
                                {"byteOffset", integer()},
                                {"componentType", one_of(std::vector<uint64_t>{5121, 5123, 5125}), required}});
  const Check values = object({{"bufferView", index_into("/bufferViews"), required}, {"byteOffset", integer()}});
  const Check sparse =
      object({{"count", integer(1), required}, {"indices", indices, required}, {"values", values, required}});
  return object(
      {{"bufferView", index_into("/bufferViews")},
       {"byteOffset", integer(0, kMaxOffset)},
       {"componentType", one_of(std::vector<uint64_t>{5120, 5121, 5122, 5123, 5125, 5126, 5130}), required},
       {"normalized", boolean()},
       {"count", integer(1, kNone - 1), required},
       {"type", one_of(std::vector<std::string>{"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"}), required},
       {"sparse", sparse}});
}

// ---- Materials ----

Check image() { return object({{"name", text()}, {"uri", text()}, {"bufferView", index_into("/bufferViews")}}); }

Check sampler() {
  const Check wrap = one_of(std::vector<uint64_t>{10497, 33071, 33648});
  return object({{"magFilter", one_of(std::vector<uint64_t>{9728, 9729})},
                 {"minFilter", one_of(std::vector<uint64_t>{9728, 9729, 9984, 9985, 9986, 9987})},
                 {"wrapS", wrap},
                 {"wrapT", wrap}});
}

Check texture() {
  const Check other = object({{"source", index_into("/images")}});
  return object({{"name", text()},
                 {"source", index_into("/images")},
                 {"sampler", index_into("/samplers")},
                 {"extensions",
                  object({{"KHR_texture_basisu", other}, {"EXT_texture_webp", other}, {"MSFT_texture_dds", other}})}});
}

Check texture_info(std::vector<Property> more = {}) {
  const Check uv_set = integer(0, kMaxUvSets - 1);
  const Check transform =
      object({{"offset", numbers(2)}, {"rotation", number()}, {"scale", numbers(2)}, {"texCoord", uv_set}});
  more.push_back({"index", index_into("/textures"), required});
  more.push_back({"texCoord", uv_set});
  more.push_back({"extensions", object({{"KHR_texture_transform", transform}})});
  return object(std::move(more));
}

Check phong() {
  return closed_object({{"ambientFactor", color()},
                        {"diffuseFactor", color()},
                        {"specularFactor", color()},
                        {"shininess", number_above(0)},
                        {"reflectionFactor", color()},
                        {"transmissionFactor", color()},
                        {"ior", number(1)},
                        {"fresnel", boolean()},
                        {"priority", integer(0, 255)},
                        {"ambientTexture", texture_info()},
                        {"diffuseTexture", texture_info()}});
}

Check material_extensions() {
  const Check zero_or_from_one = both(number(0), [](const JsonRef& r) {
    if (r.as<double>() > 0 && r.as<double>() < 1) r.expected("0 or a number >= 1");
  });
  std::vector<Property> all = layer_properties(texture_info);
  all.insert(all.end(),
             {{"KHR_materials_unlit", object({})},
              {"KHR_materials_emissive_strength", object({{"emissiveStrength", number(0)}})},
              {"KHR_materials_ior", object({{"ior", zero_or_from_one}})},
              {"KHR_materials_transmission",
               object({{"transmissionFactor", number(0, 1)}, {"transmissionTexture", texture_info()}})},
              {"KHR_materials_specular", object({{"specularFactor", number(0, 1)},
                                                 {"specularTexture", texture_info()},
                                                 {"specularColorFactor", color()},
                                                 {"specularColorTexture", texture_info()}})},
              {"KHR_materials_pbrSpecularGlossiness", object({{"diffuseFactor", numbers(4, 0, 1)},
                                                              {"diffuseTexture", texture_info()},
                                                              {"specularFactor", numbers(3, 0, 1)},
                                                              {"glossinessFactor", number(0, 1)},
                                                              {"specularGlossinessTexture", texture_info()}})},
              {"ALHAZEN_materials_measured", closed_object({{"uri", text(), required}, {"scale", number(0)}})},
              {"ALHAZEN_materials_phong", phong()}});
  return object(std::move(all));
}

Check material() {
  const Check metallic_roughness = object({{"baseColorFactor", numbers(4, 0, 1)},
                                           {"baseColorTexture", texture_info()},
                                           {"metallicFactor", number(0, 1)},
                                           {"roughnessFactor", number(0, 1)},
                                           {"metallicRoughnessTexture", texture_info()}});
  return object({{"name", text()},
                 {"pbrMetallicRoughness", metallic_roughness},
                 {"normalTexture", texture_info({{"scale", number()}})},
                 {"occlusionTexture", texture_info({{"strength", number(0, 1)}})},
                 {"emissiveTexture", texture_info()},
                 {"emissiveFactor", color()},
                 {"alphaMode", one_of(std::vector<std::string>{"OPAQUE", "MASK", "BLEND"})},
                 {"alphaCutoff", number(0)},
                 {"doubleSided", boolean()},
                 {"extensions", material_extensions()}});
}

// ---- Meshes, cameras, lights, nodes ----

Check mesh() {
  const Check mapping =
      object({{"material", index_into("/materials"), required},
              {"variants", list_of(index_into("/extensions/KHR_materials_variants/variants")), required}});
  const Check variants = object({{"mappings", list_of(mapping), required}});
  const Check draco = object(
      {{"bufferView", index_into("/bufferViews"), required}, {"attributes", map_of(integer(0, kNone - 1)), required}});
  const Check attributes = map_of(index_into("/accessors"));
  const Check primitive = object({{"attributes", attributes, required},
                                  {"indices", index_into("/accessors")},
                                  {"material", index_into("/materials")},
                                  {"mode", integer(0, 6)},
                                  {"targets", list_of(attributes)},
                                  {"extensions", object({{"FB_ngon_encoding", object({})},
                                                         {"KHR_draco_mesh_compression", draco},
                                                         {"KHR_materials_variants", variants}})}});
  return object({{"name", text()}, {"primitives", list_of(primitive), required}, {"weights", list_of(number())}});
}

Check camera() {
  const Check below_pi = both(number_above(0), [](const JsonRef& r) {
    if (!(r.as<double>() < kPi)) r.expected("an angle below pi");
  });
  const Check not_zero = both(number(), [](const JsonRef& r) {
    if (r.as<float>() == 0) r.expected("a number other than 0");
  });
  const Check perspective = object(
      {{"yfov", below_pi, required}, {"znear", number(), required}, {"zfar", number()}, {"aspectRatio", number()}});
  const Check orthographic = object({{"xmag", number(), required},
                                     {"ymag", not_zero, required},
                                     {"znear", number(), required},
                                     {"zfar", number(), required}});
  return both(object({{"name", text()},
                      {"type", one_of(std::vector<std::string>{"perspective", "orthographic"}), required},
                      {"perspective", perspective},
                      {"orthographic", orthographic}}),
              [](const JsonRef& r) {
                object({{r["type"].as<std::string>(), anything(), required}})(r);
              });
}

Check light() {
  const Check spot =
      both(object({{"innerConeAngle", number(0, kPi / 2)}, {"outerConeAngle", number(0, kPi / 2 + 1e-6)}}),
           [](const JsonRef& r) {
             if (!(r.get("innerConeAngle", 0.0) < r.get("outerConeAngle", kPi / 4)))
               r.fail("expected innerConeAngle < outerConeAngle");
           });
  const Check attenuation = one_of(std::vector<std::string>{"inverse-square", "none"});
  return object({{"name", text()},
                 {"type", one_of(std::vector<std::string>{"directional", "point", "spot"}), required},
                 {"color", color()},
                 {"intensity", number(0)},
                 {"range", number_above(0)},
                 {"spot", spot},
                 {"extensions", object({{"ALHAZEN_lights", closed_object({{"attenuation", attenuation}})}})}});
}

Check node() {
  const Check extensions =
      object({{"KHR_lights_punctual", object({{"light", index_into(kLights), required}})},
              {"ALHAZEN_shapes", closed_object({{"shape", index_into("/extensions/ALHAZEN_shapes/shapes"), required},
                                                {"material", index_into("/materials")}})},
              {"EXT_mesh_gpu_instancing", object({{"attributes", map_of(index_into("/accessors")), required}})},
              {"KHR_node_visibility", object({{"visible", boolean()}})},
              {"MSFT_lod", object({{"ids", list_of(index_into("/nodes")), required}})}});
  return object({{"name", text()},
                 {"children", list_of(index_into("/nodes"))},
                 {"matrix", numbers(16)},
                 {"translation", numbers(3)},
                 {"rotation", numbers(4)},
                 {"scale", numbers(3)},
                 {"mesh", index_into("/meshes")},
                 {"skin", index_into("/skins")},
                 {"weights", list_of(number())},
                 {"camera", index_into("/cameras")},
                 {"extensions", extensions}});
}

Check skin() {
  return object({{"name", text()},
                 {"joints", list_of(index_into("/nodes"), 1), required},
                 {"inverseBindMatrices", index_into("/accessors")},
                 {"skeleton", index_into("/nodes")}});
}

Check animation() {
  const Check pointer = object({{"pointer", text(), required}});
  const Check target = object({{"node", index_into("/nodes")},
                               {"path", text(), required},
                               {"extensions", object({{"KHR_animation_pointer", pointer}})}});
  const Check channel = object({{"sampler", integer(), required}, {"target", target, required}});
  const Check sampler = object({{"input", index_into("/accessors"), required},
                                {"output", index_into("/accessors"), required},
                                {"interpolation", one_of(std::vector<std::string>{"LINEAR", "STEP", "CUBICSPLINE"})}});
  return object({{"name", text()}, {"channels", list_of(channel), required}, {"samplers", list_of(sampler), required}});
}

/// Six images a level, nine colours.
Check image_based_light() {
  const auto array_of = [](size_t count, const char* what, const Check& element) {
    return both(list_of(element), [=](const JsonRef& r) {
      if (r.value().size() != count) r.expected("an array of " + std::to_string(count) + " " + what);
    });
  };
  return object({{"name", text()},
                 {"intensity", number(0)},
                 {"rotation", numbers(4)},
                 {"irradianceCoefficients", array_of(9, "colours", numbers(3)), required},
                 {"specularImageSize", integer(1), required},
                 {"specularImages", list_of(array_of(6, "images", index_into("/images")), 1), required}});
}

Check scene() {
  const Check lights = closed_object({{"ambient", color()}, {"background", color()}});
  const Check image_light = object({{"light", index_into(kImageLights), required}});
  return object({{"name", text()},
                 {"nodes", list_of(index_into("/nodes"))},
                 {"extensions", object({{"ALHAZEN_lights", lights}, {"EXT_lights_image_based", image_light}})}});
}

Check gltf() {
  const Check variant = object({{"name", text(), required}});
  const Check extensions = object({{"KHR_lights_punctual", object({{"lights", list_of(light())}})},
                                   {"EXT_lights_image_based", object({{"lights", list_of(image_based_light())}})},
                                   {"KHR_materials_variants", object({{"variants", list_of(variant), required}})},
                                   {"ALHAZEN_shapes", closed_object({{"shapes", list_of(shape_description())}})}});
  return object({{"asset", object({{"version", check_version, required}}), required},
                 {"extensionsUsed", list_of(text())},
                 {"extensionsRequired", list_of(text())},
                 {"buffers", list_of(buffer())},
                 {"bufferViews", list_of(buffer_view())},
                 {"accessors", list_of(accessor())},
                 {"images", list_of(image())},
                 {"samplers", list_of(sampler())},
                 {"textures", list_of(texture())},
                 {"materials", list_of(material())},
                 {"meshes", list_of(mesh())},
                 {"cameras", list_of(camera())},
                 {"nodes", list_of(node())},
                 {"skins", list_of(skin())},
                 {"animations", list_of(animation())},
                 {"scenes", list_of(scene())},
                 {"scene", index_into("/scenes")},
                 {"extensions", extensions}});
}

}  // namespace

void check_gltf(const JsonRef& root) {
  static const Check whole = gltf();
  whole(root);
}

}  // namespace alhazen
