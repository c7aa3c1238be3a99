// Extensions that choose, hide and stand in: variants, scenes, visibility, levels of detail, other image formats.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <regex>
#include <sstream>

#include "gltf_builder.h"
#include "loaders/gltf_extensions.h"
#include "loaders/image_decode.h"
#include "loaders/image_ktx.h"

namespace alhazen {
namespace {

LoadedScene load_chosen(const json& document, const SceneChoice& choice) {
  const TemporaryFolder folder;
  return load_gltf(folder.write("scene.gltf", document.dump()), {}, choice);
}
std::string usage_error_of(const json& document, const SceneChoice& choice) {
  try {
    (void)load_chosen(document, choice);
    return {};
  } catch (const UsageError& error) {
    return error.what();
  }
}

/// A triangle whose own material is 0 and which variants 0 and 1 give material 1, variant 2 material 2.
json with_variants() {
  GltfBuilder b;
  b.mesh({{"attributes", {{"POSITION", b.vec3(kTriangle)}}},
          {"material", 0},
          {"extensions",
           {{"KHR_materials_variants",
             {{"mappings",
               {{{"material", 1}, {"variants", {0, 1}}}, {{"material", 2}, {"variants", json::array({2})}}}}}}}}});
  for (int i = 0; i < 3; ++i) b.add("materials", json::object());
  json document = b.document();
  document["extensions"]["KHR_materials_variants"]["variants"] = {
      {{"name", "beach"}}, {{"name", "street"}}, {{"name", "0"}}};
  return document;
}

TEST(GltfVariants, AreChosenByNameOrIndex) {
  const auto material = [&](const char* variant) {
    return load_chosen(with_variants(), {.scene = "", .variant = variant}).scene.geometry.meshes[0].parts[0].material;
  };
  EXPECT_EQ(material(""), 0u);
  EXPECT_EQ(material("beach"), 1u);
  EXPECT_EQ(material("street"), 1u);
  EXPECT_EQ(material("1"), 1u);
  EXPECT_EQ(material("0"), 2u) << "a name goes before an index";
  EXPECT_EQ(usage_error_of(with_variants(), {.scene = "", .variant = "snow"}),
            "--variant: there is no variant 'snow'; the file has 0 'beach', 1 'street', 2 '0'");
  EXPECT_EQ(usage_error_of({{"asset", {{"version", "2.0"}}}}, {.scene = "", .variant = "snow"}),
            "--variant: there is no variant 'snow'; the file has none");
}

TEST(GltfVariants, FaultsAreNamedAtTheirPlace) {
  json document = with_variants();
  const std::string at = "/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings/0";
  document[json::json_pointer(at + "/material")] = 9;
  EXPECT_EQ(error_of(document), at + "/material: index 9 out of range, /materials has 3");
  document = with_variants();
  document[json::json_pointer(at + "/variants/1")] = 7;
  EXPECT_EQ(error_of(document),
            at + "/variants/1: index 7 out of range, /extensions/KHR_materials_variants/variants has 3");
}

TEST(GltfScenes, AreChosenByNameOrIndex) {
  GltfBuilder b;
  for (int i = 0; i < 3; ++i) b.mesh({{"attributes", {{"POSITION", b.vec3(kTriangle)}}}});
  b.root["scenes"] = {{{"name", "inside"}, {"nodes", {0}}}, {{"nodes", {1}}}, {{"name", "outside"}, {"nodes", {2}}}};
  b.root["scene"] = 1;
  const auto node = [&](const char* scene) {
    return load_chosen(b.document(), {.scene = scene, .variant = ""}).scene.geometry.mesh_instances[0].node;
  };
  EXPECT_EQ(node(""), 1u);
  EXPECT_EQ(node("inside"), 0u);
  EXPECT_EQ(node("2"), 2u);
  EXPECT_EQ(usage_error_of(b.document(), {.scene = "3", .variant = ""}),
            "--scene: there is no scene '3'; the file has 0 'inside', 1, 2 'outside'");
}

/// The nodes whose meshes are seen.
std::vector<uint32_t> seen(const GltfBuilder& b) {
  const Loaded loaded = load(b);
  std::vector<uint32_t> nodes;
  for (const MeshInstance instance : loaded.scene().geometry.mesh_instances) nodes.push_back(instance.node);
  return nodes;
}

TEST(GltfNodeVisibility, HidesANodeAndAllBelowButItsCameras) {
  GltfBuilder b;
  for (int i = 0; i < 5; ++i) b.mesh({{"attributes", {{"POSITION", b.vec3(kTriangle)}}}});
  b.root["nodes"][0]["children"] = {1, 2};
  b.root["nodes"][2]["children"] = {3};
  b.root["nodes"][2]["extensions"]["KHR_node_visibility"]["visible"] = false;
  b.root["nodes"][3]["extensions"]["KHR_node_visibility"]["visible"] = true;
  b.root["nodes"][3]["camera"] =
      b.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}});
  EXPECT_EQ(seen(b), (std::vector<uint32_t>{0, 1, 4}));
  EXPECT_EQ(load(b).scene().cameras.size(), 1u);
}

TEST(GltfLod, TheFinestLevelIsSeen) {
  GltfBuilder b;
  for (int i = 0; i < 4; ++i) b.mesh({{"attributes", {{"POSITION", b.vec3(kTriangle)}}}});
  b.root["nodes"][1]["extensions"]["MSFT_lod"]["ids"] = {0, 3};
  EXPECT_EQ(seen(b), (std::vector<uint32_t>{1, 2}));
}

/// A triangle instanced by `attributes` on a node at (10, 0, 0).
GltfBuilder instanced(const std::function<json(GltfBuilder&)>& attributes) {
  GltfBuilder b;
  b.mesh({{"attributes", {{"POSITION", b.vec3(kTriangle)}}}});
  b.root["nodes"][0]["translation"] = {10, 0, 0};
  b.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = attributes(b);
  return b;
}

TEST(GpuInstancing, PlacesAMeshByTranslationRotationAndScale) {
  const float half = std::sqrt(0.5f);
  const GltfBuilder b = instanced([&](GltfBuilder& g) {
    return json{{"TRANSLATION", g.vec3({0, 0, 0, 1, 2, 3})},
                {"ROTATION", g.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, half, half}, "VEC4", 5126, 2)},
                {"SCALE", g.vec3({1, 1, 1, 2, 3, 4})}};
  });
  const Loaded loaded = load(b);
  const auto& placed = loaded.scene().geometry.mesh_instances;
  ASSERT_EQ(placed.size(), 2u);
  EXPECT_EQ(placed[0].world_from_object.origin, (Vec3d{10, 0, 0}));
  // A quarter turn about z after the scale: x goes to 2 y, y to -3 x.
  const Vec3d p = transform_point(placed[1].world_from_object, Vec3d{1, 1, 1});
  EXPECT_NEAR(p.x, 11 - 3, 1e-6);
  EXPECT_NEAR(p.y, 2 + 2, 1e-6);
  EXPECT_NEAR(p.z, 3 + 4, 1e-6);
  EXPECT_EQ(placed[1].node, 0u);
}

TEST(GpuInstancing, RotationsMayBeNormalizedIntegers) {
  for (const int component : {5120, 5122}) {
    const GltfBuilder b = instanced([&](GltfBuilder& g) {
      return json{{"ROTATION", component == 5120
                                   ? g.accessor(std::vector<int8_t>{0, 0, 127, 0}, "VEC4", component, 1, true)
                                   : g.accessor(std::vector<int16_t>{0, 0, 32767, 0}, "VEC4", component, 1, true)}};
    });
    const Loaded loaded = load(b);
    const Affine3d m = loaded.scene().geometry.mesh_instances[0].world_from_object;
    EXPECT_NEAR(m.x.x, -1, 1e-12);
    EXPECT_NEAR(m.z.z, 1, 1e-12);
  }
}

TEST(GpuInstancing, FaultsAreNamedAtTheirPlace) {
  const std::string at = "/nodes/0/extensions/EXT_mesh_gpu_instancing";
  EXPECT_EQ(error_of(instanced([](GltfBuilder& g) {
                       return json{{"TRANSLATION", g.vec3({0, 0, 0, 1, 2, 3})}, {"SCALE", g.vec3({1, 1, 1})}};
                     }).document()),
            at + "/attributes/SCALE: expected an accessor of 2 elements as the others have, it has 1");
  EXPECT_TRUE(error_of(instanced([](GltfBuilder& g) {
                         return json{{"ROTATION", g.vec3({0, 0, 0})}};
                       }).document())
                  .starts_with(at + "/attributes/ROTATION: expected an accessor of 4 components"));
  EXPECT_EQ(error_of(instanced([](GltfBuilder& g) {
                       return json{{"SCALE", g.vec3({1, std::numeric_limits<float>::infinity(), 1})}};
                     }).document()),
            at + "/attributes/SCALE: expected finite numbers, the accessor holds others");
  const auto zeros = [](GltfBuilder& g) {
    return json{{"TRANSLATION", g.add("accessors", {{"type", "VEC3"}, {"componentType", 5126}, {"count", 1 << 22}})}};
  };
  EXPECT_TRUE(error_of(instanced(zeros).document()).ends_with("--max-memory raises the limit"));
  const Loaded flat = load(instanced([](GltfBuilder& g) { return json{{"SCALE", g.vec3({1, 1, 1, 0, 0, 0})}}; }));
  EXPECT_EQ(flat.scene().geometry.mesh_instances.size(), 1u);
  ASSERT_EQ(flat.warnings.size(), 1u);
  EXPECT_TRUE(flat.warnings[0].ends_with("1 of its 2 instances are left out, their matrices cannot be inverted"));
}

TEST(GltfTextures, TakeTheBestFormatThatIsDecoded) {
  GltfBuilder b;
  for (int i = 0; i < 4; ++i) b.add("images", {{"uri", "data:image/png;base64,AAAA"}});
  const auto extension = [](const char* name, int source) { return json{{name, {{"source", source}}}}; };
  b.add("textures", {{"source", 0}, {"extensions", extension("EXT_texture_webp", 1)}});
  b.add("textures", {{"source", 0}, {"extensions", extension("KHR_texture_basisu", 2)}});
  b.add("textures", {{"extensions", extension("KHR_texture_basisu", 2)}});
  b.add("textures", {{"source", 0}, {"extensions", extension("MSFT_texture_dds", 3)}});
  for (int i = 0; i < 4; ++i) b.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", i}}}}}});
  const Loaded loaded = load(b);
  EXPECT_EQ(loaded.scene().textures[0].image, 1u);
  EXPECT_EQ(loaded.scene().textures[1].image, kDecodesKtx ? 2u : 0u);
  EXPECT_EQ(loaded.scene().textures[2].image, kDecodesKtx ? 2u : kNone);
  EXPECT_EQ(loaded.scene().textures[3].image, 3u);
  if (!kDecodesKtx) {
    ASSERT_EQ(loaded.warnings.size(), 1u);
    EXPECT_NE(loaded.warnings[0].find("/textures: those of KHR_texture_basisu alone are left out: "),
              std::string::npos);
  }
}

TEST(GltfImages, ThatNoMaterialUsesAreNotRead) {
  GltfBuilder b;
  b.add("images", {{"uri", "absent.png"}});
  b.add("textures", {{"source", 0}});
  EXPECT_TRUE(load(b).warnings.empty());
  b.add("materials", {{"emissiveTexture", {{"index", 0}}}});
  EXPECT_EQ(load(b).warnings.size(), 1u);
}

TEST(SpecularGlossiness, IsADielectricOfThatReflectance) {
  GltfBuilder b;
  b.add("images", {{"uri", "absent.png"}});
  b.add("textures", {{"source", 0}, {"sampler", b.add("samplers", {{"wrapS", 33071}})}});
  b.add("materials", {{"pbrMetallicRoughness", {{"metallicFactor", 1}, {"baseColorFactor", {1, 0, 0, 1}}}},
                      {"extensions",
                       {{"KHR_materials_pbrSpecularGlossiness",
                         {{"diffuseFactor", {0.1, 0.2, 0.3, 0.4}},
                          {"specularFactor", {0.5, 0.6, 0.7}},
                          {"glossinessFactor", 0.75}}}}}});
  b.add("materials",
        {{"extensions",
          {{"KHR_materials_pbrSpecularGlossiness",
            {{"glossinessFactor", 0.5}, {"specularGlossinessTexture", {{"index", 0}, {"texCoord", 1}}}}}}}});
  const Loaded loaded = load(b);
  const Material& plain = loaded.scene().materials[0];
  EXPECT_EQ(plain.base_color.rgb, (Rgb{0.1f, 0.2f, 0.3f}));
  EXPECT_EQ(plain.base_color.a, 0.4f);
  EXPECT_EQ(plain.metallic, 0);
  EXPECT_EQ(plain.ior, 0) << "F0 is 1 before the specular colour";
  EXPECT_EQ(plain.specular_color, (Rgb{0.5f, 0.6f, 0.7f}));
  EXPECT_EQ(plain.roughness, 0.25f);
  const Material& textured = loaded.scene().materials[1];
  EXPECT_EQ(textured.specular_color_texture.texture, 0u);
  EXPECT_EQ(textured.metallic_roughness_texture.texture, 1u);
  EXPECT_EQ(textured.metallic_roughness_texture.uv_set, 1u);
  EXPECT_EQ(textured.roughness, 1);
  EXPECT_EQ(loaded.scene().textures[1].wrap_u, Wrap::clamp_to_edge);
  EXPECT_EQ(loaded.loaded.encoded[1].glossiness_of, 0u);
  EXPECT_EQ(loaded.loaded.encoded[1].glossiness_factor, 0.5f);
}

TEST(SpecularGlossiness, RoughnessComesFromTheAlphaOfTheTexture) {
  // A PNG of two pixels, RGBA (10, 20, 30, 255) and (10, 20, 30, 51).
  const std::string png =
      "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAAD0lEQVR4nGPgEpH7D8TGAAdnAauhYO1iAAAAAElFTkSuQmCC";
  GltfBuilder b;
  b.add("images", {{"uri", "data:image/png;base64," + png}});
  b.add("textures", {{"source", 0}});
  b.add("materials", {{"extensions",
                       {{"KHR_materials_pbrSpecularGlossiness",
                         {{"glossinessFactor", 0.5}, {"specularGlossinessTexture", {{"index", 0}}}}}}}});
  const auto images = decode_images(load(b).loaded.encoded, {});
  ASSERT_EQ(images.size(), 2u);
  ASSERT_EQ(images[0].width, 2);
  EXPECT_EQ(images[1].channels, 1);
  // And a smaller level.
  EXPECT_EQ(std::get<std::vector<uint8_t>>(images[1].samples), (std::vector<uint8_t>{128, 230, 179}));
}

TEST(GltfExtensions, AreListedInTheirOrderAndInTheDocumentation) {
  std::ifstream in(ALHAZEN_DOCS "/gltf.md");
  std::stringstream all;
  all << in.rdbuf();
  const std::string text = all.str();
  std::string_view before;
  for (const KnownExtension& e : known_extensions()) {
    EXPECT_LT(before, e.name);
    before = e.name;
    // A row of the table names it, alone or among others, with its treatment in the second column.
    constexpr const char* kTreatments[] = {"supported", "approximated", "ignored"};
    const std::string treatment = e.name == "KHR_texture_basisu" ? "supported" : kTreatments[size_t(e.treatment)];
    const std::regex row("\\| ([^|\n]*[, ])?" + std::string(e.name) + "(,[^|\n]*)? \\| " + treatment + " \\|");
    EXPECT_TRUE(std::regex_search(text, row)) << e.name << " is not in docs/gltf.md as " << treatment;
  }
}

}  // namespace
}  // namespace alhazen
