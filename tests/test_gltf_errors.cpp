// What is wrong with a file is said with its place, what was found and what was expected.
#include <gtest/gtest.h>

#include "gltf_builder.h"

namespace alhazen {
namespace {

/// A valid document that uses everything the loader reads.
json everything() {
  GltfBuilder b;
  const int position = b.vec3(kTriangle), normal = b.vec3({0, 0, 1, 0, 0, 1, 0, 0, 1}), uv = b.vec2({0, 0, 1, 0, 0, 1});
  const int tangent = b.accessor(std::vector<float>(12, 1.0f), "VEC4", 5126, 3);
  const int color = b.accessor(std::vector<uint8_t>(12, 255), "VEC4", 5121, 3, true);
  const int index = b.index({0, 1, 2});
  const int sparse_where = b.view(raw_bytes(std::vector<uint16_t>{0, 2})),
            sparse_values = b.view(std::string(24, '\0'));
  const int sparse = b.add("accessors", {{"type", "VEC3"},
                                         {"count", 3},
                                         {"componentType", 5126},
                                         {"sparse",
                                          {{"count", 2},
                                           {"indices", {{"bufferView", sparse_where}, {"componentType", 5123}}},
                                           {"values", {{"bufferView", sparse_values}, {"byteOffset", 0}}}}}});
  b.root["images"] = {{{"uri", "data:,"}}, {{"bufferView", 0}, {"mimeType", "image/png"}}};
  b.root["samplers"] = {{{"magFilter", 9728}, {"minFilter", 9984}, {"wrapS", 33071}, {"wrapT", 33648}}};
  b.root["textures"] = {{{"source", 0}, {"sampler", 0}}, {{"source", 1}}};
  const json info = {
      {"index", 0},
      {"texCoord", 0},
      {"extensions",
       {{"KHR_texture_transform", {{"offset", {0, 1}}, {"rotation", 1}, {"scale", {1, 2}}, {"texCoord", 0}}}}}};
  json normal_info = info, occlusion_info = info;
  normal_info["scale"] = 1;
  occlusion_info["strength"] = 1;
  const json phong = {{"ambientFactor", {1, 1, 1}},
                      {"diffuseFactor", {1, 1, 1}},
                      {"specularFactor", {1, 1, 1}},
                      {"shininess", 50},
                      {"ior", 1.5},
                      {"reflectionFactor", {1, 1, 1}},
                      {"transmissionFactor", {0, 0, 0}},
                      {"fresnel", true},
                      {"ambientTexture", info},
                      {"diffuseTexture", info}};
  const json extensions = {{"KHR_materials_unlit", json::object()},
                           {"KHR_materials_emissive_strength", {{"emissiveStrength", 2}}},
                           {"KHR_materials_ior", {{"ior", 1.5}}},
                           {"KHR_materials_transmission", {{"transmissionFactor", 1}, {"transmissionTexture", info}}},
                           {"KHR_materials_specular",
                            {{"specularFactor", 1},
                             {"specularTexture", info},
                             {"specularColorFactor", {1, 1, 1}},
                             {"specularColorTexture", info}}},
                           {"ALHAZEN_materials_phong", phong}};
  b.root["materials"] = {{{"name", "all"},
                          {"alphaMode", "MASK"},
                          {"alphaCutoff", 0.5},
                          {"doubleSided", true},
                          {"emissiveFactor", {1, 1, 1}},
                          {"emissiveTexture", info},
                          {"normalTexture", normal_info},
                          {"occlusionTexture", occlusion_info},
                          {"pbrMetallicRoughness",
                           {{"baseColorFactor", {1, 1, 1, 1}},
                            {"baseColorTexture", info},
                            {"metallicFactor", 1},
                            {"roughnessFactor", 1},
                            {"metallicRoughnessTexture", info}}},
                          {"extensions", extensions}}};
  b.root["meshes"] = {
      {{"name", "mesh"},
       {"weights", {0}},
       {"primitives",
        {{{"attributes",
           {{"POSITION", position}, {"NORMAL", normal}, {"TANGENT", tangent}, {"TEXCOORD_0", uv}, {"COLOR_0", color}}},
          {"indices", index},
          {"material", 0},
          {"mode", 4},
          {"targets", {{{"POSITION", sparse}}}}},
         {{"attributes", {{"POSITION", sparse}}}}}}}};
  b.root["cameras"] = {{{"name", "p"},
                        {"type", "perspective"},
                        {"perspective", {{"yfov", 1}, {"znear", 0.1}, {"zfar", 10}, {"aspectRatio", 1}}}},
                       {{"name", "o"},
                        {"type", "orthographic"},
                        {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0.1}, {"zfar", 10}}}}};
  b.root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "spot"},
       {"name", "l"},
       {"color", {1, 1, 1}},
       {"intensity", 1},
       {"range", 1},
       {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.2}}}},
      {{"type", "point"}, {"extensions", {{"ALHAZEN_lights", {{"attenuation", "none"}}}}}}};
  b.root["extensions"]["ALHAZEN_shapes"]["shapes"] = {{{"name", "s"}, {"sphere", {{"radius", 1}}}}};
  b.root["nodes"] = {
      {{"name", "root"},
       {"children", {1}},
       {"translation", {0, 0, 0}},
       {"rotation", {0, 0, 0, 1}},
       {"scale", {1, 1, 1}},
       {"mesh", 0}},
      {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}},
       {"camera", 1},
       {"extensions", {{"KHR_lights_punctual", {{"light", 1}}}, {"ALHAZEN_shapes", {{"shape", 0}, {"material", 0}}}}}}};
  b.root["scenes"] = {{{"name", "scene"},
                       {"nodes", {0}},
                       {"extensions", {{"ALHAZEN_lights", {{"ambient", {0, 0, 0}}, {"background", {0, 0, 0}}}}}}}};
  b.root["scene"] = 0;
  b.root["extensionsUsed"] = {"KHR_texture_transform", "ALHAZEN_shapes"};
  b.root["extensionsRequired"] = {"ALHAZEN_shapes"};
  return b.document();
}

const std::string kPhong = "/materials/0/extensions/ALHAZEN_materials_phong";
const std::string kSpot = "/extensions/KHR_lights_punctual/lights/0/spot";

struct Fault {
  std::string at;     // what is changed
  json to;            // null: taken away
  std::string error;  // beginning of the message
};

std::string error_with(const Fault& fault) {
  json document = everything();
  const json::json_pointer at(fault.at);
  if (fault.to.is_null())
    document[at.parent_pointer()].erase(at.back());
  else
    document[at] = fault.to;
  return error_of(document);
}

TEST(GltfErrors, AreNoneInAValidFile) { EXPECT_EQ(error_of(everything()), ""); }

TEST(GltfErrors, NameThePlaceWhatWasFoundAndWhatWasExpected) {
  const Fault faults[] = {
      {"/asset", nullptr, "`asset` is missing"},
      {"/asset/version", nullptr, "/asset: `version` is missing"},
      {"/asset/version", "1.0", "/asset/version: expected version 2.x, found \"1.0\""},
      {"/buffers/0/byteLength", nullptr, "/buffers/0: `byteLength` is missing"},
      {"/buffers/0/byteLength", 100000, "/buffers/0/byteLength: expected 100000 bytes, the buffer has "},
      {"/buffers/0/byteLength", -1, "/buffers/0/byteLength: expected an integer from 0 to 9007199254740992, found -1"},
      {"/buffers/0/uri", nullptr, "/buffers/0: `uri` is missing, and the file has no GLB chunk for this buffer"},
      {"/buffers/0/uri", "absent.bin", "/buffers/0/uri: cannot read `absent.bin`"},
      {"/bufferViews/0/buffer", 1, "/bufferViews/0/buffer: index 1 out of range, /buffers has 1"},
      {"/bufferViews/0/byteStride", 6, "/bufferViews/0/byteStride: expected a multiple of 4, found 6"},
      {"/bufferViews/0/byteStride", 256, "/bufferViews/0/byteStride: expected an integer from 0 to 252, found 256"},
      {"/accessors/0/bufferView", 99, "/accessors/0/bufferView: index 99 out of range, /bufferViews has 8"},
      {"/accessors/0/bufferView", -5, "/accessors/0/bufferView: expected an index into /bufferViews, found -5"},
      {"/accessors/0/componentType", 5124,
       "/accessors/0/componentType: expected one of 5120, 5121, 5122, 5123, 5125, 5126, 5130, found 5124"},
      {"/accessors/0/type", "VEC5",
       "/accessors/0/type: expected one of SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3, MAT4, found \"VEC5\""},
      {"/accessors/0/normalized", 1, "/accessors/0/normalized: expected true or false, found 1"},
      {"/accessors/6/sparse/indices/componentType", 5126,
       "/accessors/6/sparse/indices/componentType: expected one of 5121, 5123, 5125"},
      {"/images/1/bufferView", 8, "/images/1/bufferView: index 8 out of range, /bufferViews has 8"},
      {"/images/0/uri", "../x.png", "/images/0/uri: `../x.png` lies outside the scene's folder"},
      {"/samplers/0/wrapS", 1, "/samplers/0/wrapS: expected one of 10497, 33071, 33648, found 1"},
      {"/samplers/0/magFilter", 9984, "/samplers/0/magFilter: expected one of 9728, 9729, found 9984"},
      {"/textures/0/source", 2, "/textures/0/source: index 2 out of range, /images has 2"},
      {"/textures/0/sampler", 1, "/textures/0/sampler: index 1 out of range, /samplers has 1"},
      {"/materials/0/name", 5, "/materials/0/name: expected a string, found 5"},
      {"/materials/0/alphaMode", "GLASS",
       "/materials/0/alphaMode: expected one of OPAQUE, MASK, BLEND, found \"GLASS\""},
      {"/materials/0/emissiveFactor",
       {1, 1},
       "/materials/0/emissiveFactor: expected an array of 3 numbers, found [1,1]"},
      {"/materials/0/emissiveFactor/1", -1, "/materials/0/emissiveFactor/1: expected a finite number >= 0, found -1"},
      {"/materials/0/emissiveFactor/1", 1e39,
       "/materials/0/emissiveFactor/1: expected a finite number >= 0, found 1e+39"},
      {"/materials/0/normalTexture/index", 2,
       "/materials/0/normalTexture/index: index 2 out of range, /textures has 2"},
      {"/materials/0/normalTexture/texCoord", 8,
       "/materials/0/normalTexture/texCoord: expected an integer from 0 to 7, found 8"},
      {"/materials/0/occlusionTexture/strength", 2,
       "/materials/0/occlusionTexture/strength: expected a finite number from 0 to 1, found 2"},
      {"/materials/0/pbrMetallicRoughness", 7, "/materials/0/pbrMetallicRoughness: expected an object, found 7"},
      {"/materials/0/pbrMetallicRoughness/roughnessFactor", "1",
       "/materials/0/pbrMetallicRoughness/roughnessFactor: expected a finite number from 0 to 1, found \"1\""},
      {"/materials/0/extensions/KHR_materials_ior/ior", 0.5,
       "/materials/0/extensions/KHR_materials_ior/ior: expected 0 or a number >= 1, found 0.5"},
      {kPhong + "/shininess", 0, kPhong + "/shininess: expected a finite number > 0, found 0"},
      {kPhong + "/ior", 0.9, kPhong + "/ior: expected a finite number >= 1, found 0.9"},
      {kPhong + "/shinyness", 5, kPhong + "/shinyness: unknown key, expected one of ambientFactor, "},
      {kPhong + "/a~1b~0c", 5, kPhong + "/a~1b~0c: unknown key"},
      {kPhong + "/fresnel", "yes", kPhong + "/fresnel: expected true or false, found \"yes\""},
      {kPhong + "/diffuseFactor", json::object(),
       kPhong + "/diffuseFactor: expected an array of 3 numbers, found an object"},
      {"/meshes/0/primitives", nullptr, "/meshes/0: `primitives` is missing"},
      {"/meshes/0/primitives/0/attributes", nullptr, "/meshes/0/primitives/0: `attributes` is missing"},
      {"/meshes/0/primitives/0/attributes/POSITION", 99,
       "/meshes/0/primitives/0/attributes/POSITION: index 99 out of range, /accessors has 7"},
      {"/meshes/0/primitives/0/attributes/POSITION", 2,
       "/meshes/0/primitives/0/attributes/POSITION: expected an accessor of 3 components, it has 2"},
      {"/meshes/0/primitives/0/attributes/NORMAL", 5,
       "/meshes/0/primitives/0/attributes/NORMAL: expected an accessor of 3 components, it has 1"},
      {"/accessors/1/count", 2,
       "/meshes/0/primitives/0/attributes/NORMAL: expected an accessor of 3 elements as POSITION has, it has 2"},
      {"/accessors/0/count", 2, "/meshes/0/primitives/0/indices: index 2 out of range, POSITION has 2 vertices"},
      {"/meshes/0/primitives/0/indices", 0,
       "/meshes/0/primitives/0/indices: expected an accessor of unsigned integers"},
      {"/meshes/0/primitives/0/material", 1, "/meshes/0/primitives/0/material: index 1 out of range, /materials has 1"},
      {"/meshes/0/primitives/0/mode", 7, "/meshes/0/primitives/0/mode: expected an integer from 0 to 6, found 7"},
      {"/cameras/0/type", "fisheye", "/cameras/0/type: expected one of perspective, orthographic, found \"fisheye\""},
      {"/cameras/0/perspective", nullptr, "/cameras/0: `perspective` is missing"},
      {"/cameras/0/perspective/yfov", 3.2, "/cameras/0/perspective/yfov: expected an angle below pi, found 3.2"},
      {"/cameras/1/orthographic/ymag", 0, "/cameras/1/orthographic/ymag: expected a number other than 0, found 0"},
      {kSpot + "/innerConeAngle", 0.3, kSpot + ": expected innerConeAngle < outerConeAngle"},
      {"/extensions/KHR_lights_punctual/lights/0/range", 0,
       "/extensions/KHR_lights_punctual/lights/0/range: expected a finite number > 0, found 0"},
      {"/extensions/KHR_lights_punctual/lights/1/extensions/ALHAZEN_lights/attenuation", "linear",
       "/extensions/KHR_lights_punctual/lights/1/extensions/ALHAZEN_lights/attenuation: expected one of "
       "inverse-square, none, found \"linear\""},
      {"/nodes/1/extensions/KHR_lights_punctual/light", 2,
       "/nodes/1/extensions/KHR_lights_punctual/light: index 2 out of range, /extensions/KHR_lights_punctual/lights "
       "has 2"},
      {"/extensions/KHR_lights_punctual", nullptr,
       "/nodes/1/extensions/KHR_lights_punctual/light: index 1 out of range, /extensions/KHR_lights_punctual/lights "
       "has 0"},
      {"/nodes/1/extensions/ALHAZEN_shapes/shape", 1,
       "/nodes/1/extensions/ALHAZEN_shapes/shape: index 1 out of range, /extensions/ALHAZEN_shapes/shapes has 1"},
      {"/nodes/1/extensions/ALHAZEN_shapes/shape", nullptr, "/nodes/1/extensions/ALHAZEN_shapes: `shape` is missing"},
      {"/nodes/1/matrix/15", 2, "/nodes/1/matrix: expected 0, 0, 0, 1 as the matrix's last row, found "},
      {"/nodes/1/matrix/0", 0, "/nodes/1: places a shape by a global matrix that cannot be inverted"},
      {"/nodes/0/rotation", {0, 0, 0, 0}, "/nodes/0/rotation: expected a unit quaternion, found [0,0,0,0]"},
      {"/nodes/0/mesh", 1, "/nodes/0/mesh: index 1 out of range, /meshes has 1"},
      {"/nodes/1/camera", 2, "/nodes/1/camera: index 2 out of range, /cameras has 2"},
      {"/nodes/0/children/0", 2, "/nodes/0/children/0: index 2 out of range, /nodes has 2"},
      {"/nodes/0/children", {1, 1}, "/nodes/0/children/1: node 1 is a child of node 0 already"},
      {"/nodes/1/children", {0}, "/nodes/0: is its own ancestor, or below one that is"},
      {"/scenes/0/nodes", {1}, "/scenes/0/nodes/0: node 1 is no root but a child of another node"},
      {"/scenes/0/nodes", {0, 0}, "/scenes/0/nodes/1: node 0 is listed twice"},
      {"/scenes/0/nodes", {5}, "/scenes/0/nodes/0: index 5 out of range, /nodes has 2"},
      {"/scene", 1, "/scene: index 1 out of range, /scenes has 1"},
      {"/scenes/0/extensions/ALHAZEN_lights/ambiant",
       {0, 0, 0},
       "/scenes/0/extensions/ALHAZEN_lights/ambiant: unknown key, expected one of ambient, background"},
      {"/extensionsUsed", "KHR_x", "/extensionsUsed: expected an array, found \"KHR_x\""},
  };
  for (const Fault& fault : faults) {
    const std::string error = error_with(fault);
    EXPECT_TRUE(error.starts_with(fault.error))
        << fault.at << " = " << fault.to << "\n  found:    " << error << "\n  expected: " << fault.error;
  }
}

TEST(GltfErrors, OfShapesNameTheShape) {
  const auto error = [](const json& shape) { return error_with({"/extensions/ALHAZEN_shapes/shapes/0", shape, ""}); };
  const std::string at = "/extensions/ALHAZEN_shapes/shapes/0";
  EXPECT_TRUE(error({{"torus", json::object()}}).starts_with(at + ": unknown shape \"torus\", expected one of sphere"));
  EXPECT_TRUE(error({{"sphere", json::object()}, {"torus", 1}}).starts_with(at + ": unknown shape \"torus\""));
  EXPECT_TRUE(error(json::object()).starts_with(at + ": found 0 shapes, expected one of sphere"));
  EXPECT_EQ(error({{"sphere", {{"radius", -0.5}}}}), at + "/sphere/radius: expected a finite number > 0, found -0.5");
  EXPECT_EQ(error({{"sphere", {{"radius", 0}}}}), at + "/sphere/radius: expected a finite number > 0, found 0");
  EXPECT_EQ(error({{"sphere", {{"radius", 1e-300}}}}),
            at + "/sphere/radius: expected a finite number > 0, found 1e-300");
  EXPECT_EQ(error({{"sphere", {{"radius", 1e300}}}}),
            at + "/sphere/radius: expected a finite number > 0, found 1e+300");
  EXPECT_EQ(error({{"sphere", {{"radius", "1"}}}}), at + "/sphere/radius: expected a finite number > 0, found \"1\"");
  EXPECT_EQ(error({{"sphere", {{"size", 1}}}}), at + "/sphere/size: unknown key, expected one of radius");
  EXPECT_EQ(error({{"sphere", 1}}), at + "/sphere: expected an object, found 1");
  EXPECT_EQ(error({{"sphere", json::object()}, {"name", "n"}, {"extras", 1}, {"extensions", json::object()}}), "");
}

TEST(GltfErrors, NameNumbersThatAreNotFinite) {
  GltfBuilder b;
  b.mesh({{"attributes", {{"POSITION", b.vec3({0, 0, 0, 1, std::numeric_limits<float>::quiet_NaN(), 0, 0, 1, 0})}}}});
  EXPECT_EQ(error_of(b.document()),
            "/meshes/0/primitives/0/attributes/POSITION: expected finite numbers, the accessor holds others");
  json chain = {{"asset", {{"version", "2.0"}}}};
  for (int i = 0; i < 20; ++i) chain["nodes"].push_back({{"scale", {1e38, 1, 1}}, {"children", {i + 1}}});
  chain["nodes"].push_back(json::object());
  EXPECT_TRUE(error_of(chain).ends_with(": its global matrix overflows"));
}

TEST(GltfErrors, AnExtensionThatIsMerelyUsedGivesOneWarning) {
  json document = everything();
  document["extensionsUsed"] = {"KHR_a", "KHR_texture_transform", "KHR_b"};
  const Loaded loaded = load_json(document);
  ASSERT_EQ(loaded.warnings.size(), 1u);
  EXPECT_TRUE(loaded.warnings[0].ends_with("/extensionsUsed: ignored: KHR_a, KHR_b"));
  ASSERT_EQ(loaded.loaded.extensions.size(), 4u);  // with the one that is only required
  EXPECT_EQ(loaded.loaded.extensions[0].name, "KHR_a");
  EXPECT_EQ(loaded.loaded.extensions[0].treatment, Treatment::ignored);
  EXPECT_EQ(loaded.loaded.extensions[1].treatment, Treatment::supported);
}

TEST(GltfErrors, AnExtensionThatIsRequiredButNotKnownIsAnErrorThatNamesIt) {
  json document = everything();
  document["extensionsRequired"].push_back("ACME_unheard");
  const std::string error = error_of(document);
  EXPECT_TRUE(error.starts_with("/extensionsRequired/"));
  EXPECT_TRUE(error.ends_with(
      ": requires the extension ACME_unheard, which is not supported; --ignore-required renders what is left"));
}

TEST(GltfErrors, AnExtensionThatIsRequiredButNotKnownIsAWarningWhereThatIsAskedFor) {
  json document = everything();
  document["extensionsRequired"].push_back("ACME_unheard");
  const std::string text = document.dump();
  std::vector<std::string> warnings;
  const LoadedScene loaded = load_gltf(
      {text.begin(), text.end()}, "scene.gltf", [&](const std::string& w) { warnings.push_back(w); }, {},
      std::make_shared<LoadBudget>(LoadLimits{.ignore_required = true}));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(
      warnings[0],
      "scene.gltf: /extensionsRequired: requires ACME_unheard, which is ignored: not known, what it brings is left "
      "out");
  EXPECT_FALSE(loaded.scene.geometry.meshes.empty());
}

TEST(GltfErrors, AnExtensionThatIsRequiredAndKnownButIgnoredGivesAWarningAndAPicture) {
  json document = everything();
  document["extensionsRequired"].push_back("KHR_interactivity");
  const Loaded loaded = load_json(document);
  ASSERT_EQ(loaded.warnings.size(), 1u);
  EXPECT_TRUE(loaded.warnings[0].ends_with(
      "/extensionsRequired: requires KHR_interactivity, which is ignored: nothing to see"));
}

/// The pointers of all values in a document, those of objects and arrays too.
void collect(const json& value, const json::json_pointer& at, std::vector<json::json_pointer>& all) {
  if (!at.empty()) all.push_back(at);
  if (value.is_object())
    for (const auto& item : value.items()) collect(item.value(), at / item.key(), all);
  if (value.is_array())
    for (size_t i = 0; i < value.size(); ++i) collect(value[i], at / i, all);
}

TEST(GltfErrors, AnyValueReplacedByAnythingEndsInASceneOrAnErrorAtAPlace) {
  const json valid = everything();
  std::vector<json::json_pointer> all;
  collect(valid, json::json_pointer(), all);
  const json others[] = {
      nullptr,          true,          -1, 3, 2147483648u, 18446744073709551615u, 0.5, 1e300, "x", json::array(),
      json::array({0}), json::object()};
  int errors = 0;
  for (const auto& at : all)
    for (const json& other : others) {
      json document = valid;
      document[at] = other;
      const std::string error = error_of(document);
      errors += !error.empty();
      ASSERT_TRUE(error.empty() || error.starts_with("/") || error.starts_with("`") || error.starts_with("expected"))
          << at << " = " << other << ": " << error;
    }
  EXPECT_GT(errors, int(all.size()) * 3);
}

TEST(GltfErrors, AnyValueTakenAwayEndsInASceneOrAnErrorAtAPlace) {
  const json valid = everything();
  std::vector<json::json_pointer> all;
  collect(valid, json::json_pointer(), all);
  for (const auto& at : all) {
    json document = valid;
    json& parent = document[at.parent_pointer()];
    if (parent.is_array())
      parent.erase(std::stoul(at.back()));
    else
      parent.erase(at.back());
    const std::string error = error_of(document);
    ASSERT_TRUE(error.empty() || error.starts_with("/") || error.starts_with("`")) << at << ": " << error;
  }
}

}  // namespace
}  // namespace alhazen
