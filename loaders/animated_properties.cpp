#include "loaders/animated_properties.h"

#include <algorithm>
#include <numbers>
#include <span>
#include <string_view>

namespace alhazen {
namespace {

using enum AnimatedProperty::Kind;
using nlohmann::json;

constexpr double kHalfPi = std::numbers::pi / 2;
constexpr double kSmallest = 1e-6;  // of what has to be above 0

struct Row {
  std::string_view pattern;  // "*" stands for an index
  AnimatedProperty property;
};

constexpr AnimatedProperty kNumber{numbers}, kShare{numbers, 1, 0, 1}, kNotNegative{numbers, 1, 0},
    kPositive{numbers, 1, kSmallest}, kFromOne{numbers, 1, 1}, kVec2{numbers, 2}, kVec3{numbers, 3},
    kColor{numbers, 3, 0}, kShares3{numbers, 3, 0, 1}, kShares4{numbers, 4, 0, 1}, kTruth{truth};

constexpr Row kRows[] = {
    {"/nodes/*/translation", kVec3},
    {"/nodes/*/rotation", {rotation, 4}},
    {"/nodes/*/scale", kVec3},
    {"/nodes/*/weights", {weights, 0}},
    {"/nodes/*/weights/*", kNumber},
    {"/nodes/*/extensions/KHR_node_visibility/visible", kTruth},
    {"/meshes/*/weights", {weights, 0}},
    {"/meshes/*/weights/*", kNumber},

    {"/cameras/*/perspective/yfov", {numbers, 1, kSmallest, 2 * kHalfPi - kSmallest}},
    {"/cameras/*/perspective/aspectRatio", kNumber},
    {"/cameras/*/perspective/znear", kNumber},
    {"/cameras/*/perspective/zfar", kNumber},
    {"/cameras/*/orthographic/xmag", kNumber},
    {"/cameras/*/orthographic/ymag", kPositive},
    {"/cameras/*/orthographic/znear", kNumber},
    {"/cameras/*/orthographic/zfar", kNumber},

    {"/extensions/KHR_lights_punctual/lights/*/color", kColor},
    {"/extensions/KHR_lights_punctual/lights/*/intensity", kNotNegative},
    {"/extensions/KHR_lights_punctual/lights/*/range", kPositive},
    {"/extensions/KHR_lights_punctual/lights/*/spot/innerConeAngle", {numbers, 1, 0, kHalfPi}},
    {"/extensions/KHR_lights_punctual/lights/*/spot/outerConeAngle", {numbers, 1, kSmallest, kHalfPi}},
    {"/scenes/*/extensions/ALHAZEN_lights/ambient", kColor},
    {"/scenes/*/extensions/ALHAZEN_lights/background", kColor},

    {"/materials/*/alphaCutoff", kNotNegative},
    {"/materials/*/emissiveFactor", kColor},
    {"/materials/*/normalTexture/scale", kNumber},
    {"/materials/*/occlusionTexture/strength", kShare},
    {"/materials/*/pbrMetallicRoughness/baseColorFactor", kShares4},
    {"/materials/*/pbrMetallicRoughness/metallicFactor", kShare},
    {"/materials/*/pbrMetallicRoughness/roughnessFactor", kShare},
    {"/materials/*/extensions/KHR_materials_emissive_strength/emissiveStrength", kNotNegative},
    {"/materials/*/extensions/KHR_materials_ior/ior", kFromOne},
    {"/materials/*/extensions/KHR_materials_transmission/transmissionFactor", kShare},
    {"/materials/*/extensions/KHR_materials_specular/specularFactor", kShare},
    {"/materials/*/extensions/KHR_materials_specular/specularColorFactor", kColor},
    {"/materials/*/extensions/KHR_materials_clearcoat/clearcoatFactor", kShare},
    {"/materials/*/extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor", kShare},
    {"/materials/*/extensions/KHR_materials_clearcoat/clearcoatNormalTexture/scale", kNumber},
    {"/materials/*/extensions/KHR_materials_sheen/sheenColorFactor", kShares3},
    {"/materials/*/extensions/KHR_materials_sheen/sheenRoughnessFactor", kShare},
    {"/materials/*/extensions/KHR_materials_anisotropy/anisotropyStrength", kShare},
    {"/materials/*/extensions/KHR_materials_anisotropy/anisotropyRotation", kNumber},
    {"/materials/*/extensions/KHR_materials_iridescence/iridescenceFactor", kShare},
    {"/materials/*/extensions/KHR_materials_iridescence/iridescenceIor", kFromOne},
    {"/materials/*/extensions/KHR_materials_iridescence/iridescenceThicknessMinimum", kNotNegative},
    {"/materials/*/extensions/KHR_materials_iridescence/iridescenceThicknessMaximum", kNotNegative},
    {"/materials/*/extensions/KHR_materials_diffuse_transmission/diffuseTransmissionFactor", kShare},
    {"/materials/*/extensions/KHR_materials_diffuse_transmission/diffuseTransmissionColorFactor", kColor},
    {"/materials/*/extensions/KHR_materials_volume/thicknessFactor", kNotNegative},
    {"/materials/*/extensions/KHR_materials_volume/attenuationDistance", kPositive},
    {"/materials/*/extensions/KHR_materials_volume/attenuationColor", kShares3},
    {"/materials/*/extensions/KHR_materials_dispersion/dispersion", kNotNegative},
    {"/materials/*/extensions/ALHAZEN_materials_measured/scale", kNotNegative},
    {"/materials/*/extensions/ALHAZEN_materials_phong/ambientFactor", kColor},
    {"/materials/*/extensions/ALHAZEN_materials_phong/diffuseFactor", kColor},
    {"/materials/*/extensions/ALHAZEN_materials_phong/specularFactor", kColor},
    {"/materials/*/extensions/ALHAZEN_materials_phong/shininess", kPositive},
    {"/materials/*/extensions/ALHAZEN_materials_phong/reflectionFactor", kColor},
    {"/materials/*/extensions/ALHAZEN_materials_phong/transmissionFactor", kColor},
    {"/materials/*/extensions/ALHAZEN_materials_phong/ior", kFromOne},
};

// Below the KHR_texture_transform of any of a material's textures.
constexpr Row kTransformRows[] = {{"/offset", kVec2}, {"/rotation", kNumber}, {"/scale", kVec2}};

bool is_index(const std::string& token) {
  return !token.empty() && token.size() < 10 &&
         std::all_of(token.begin(), token.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool matches(std::string_view pattern, std::span<const std::string> tokens) {
  for (const std::string& token : tokens) {
    if (pattern.empty()) return false;
    const size_t end = std::min(pattern.find('/', 1), pattern.size());
    const std::string_view part = pattern.substr(1, end - 1);
    if (part == "*" ? !is_index(token) : part != token) return false;
    pattern.remove_prefix(end);
  }
  return pattern.empty();
}

std::optional<AnimatedProperty> find(std::span<const Row> rows, std::span<const std::string> tokens) {
  for (const Row& row : rows)
    if (matches(row.pattern, tokens)) return row.property;
  return std::nullopt;
}

bool has_element(const json& array, const std::string& token) {
  return array.is_array() && is_index(token) && std::stoul(token) < array.size();
}

bool is_texture(const std::string& token) { return token.ends_with("Texture"); }

/// Whether the object `token` of `owner` stands for defaults where it is left out.
bool may_be_created(const std::string& owner, const std::string& token) {
  return owner == "extensions" || token == "extensions" || token == "pbrMetallicRoughness" || token == "spot";
}

}  // namespace

std::optional<PointerTokens> pointer_tokens(const std::string& pointer) {
  if (!pointer.starts_with("/")) return std::nullopt;
  PointerTokens tokens;
  for (size_t i = 0; i < pointer.size(); ++i) {
    const char next = i + 1 < pointer.size() ? pointer[i + 1] : '\0';
    if (pointer[i] == '/')
      tokens.emplace_back();
    else if (pointer[i] == '~' && (next == '0' || next == '1'))
      tokens.back() += next == '0' ? '~' : '/', ++i;
    else
      tokens.back() += pointer[i];
  }
  return tokens;
}

std::optional<AnimatedProperty> animated_property(const PointerTokens& tokens) {
  const size_t n = tokens.size();
  const bool transforms = n > 5 && tokens[0] == "materials" && is_texture(tokens[n - 4]) &&
                          tokens[n - 3] == "extensions" && tokens[n - 2] == "KHR_texture_transform";
  return transforms ? find(kTransformRows, std::span(tokens).last(1)) : find(kRows, tokens);
}

bool make_place(json& root, const PointerTokens& tokens) {
  json* at = &root;
  for (size_t i = 0; i + 1 < tokens.size(); ++i) {
    if (at->is_array()) {
      if (!has_element(*at, tokens[i])) return false;
      at = &(*at)[std::stoul(tokens[i])];
      continue;
    }
    if (!at->is_object()) return false;
    if (!at->contains(tokens[i])) {
      if (i == 0 || !may_be_created(tokens[i - 1], tokens[i])) return false;
      (*at)[tokens[i]] = json::object();
    }
    at = &(*at)[tokens[i]];
  }
  return at->is_object() || has_element(*at, tokens.back());
}

}  // namespace alhazen
