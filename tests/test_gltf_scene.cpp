// What the loader makes of valid files: meshes, materials, nodes, cameras, lights, shapes.
#include <gtest/gtest.h>

#include <random>

#include "gltf_builder.h"

namespace alhazen {
namespace {

using Triangles = std::vector<std::array<uint32_t, 3>>;

// ---- Meshes ----

GltfBuilder five_vertices(int mode, bool indexed) {
  GltfBuilder b;
  json primitive = {{"attributes", {{"POSITION", b.vec3(std::vector<float>(15, 1.0f))}}}, {"mode", mode}};
  if (indexed) primitive["indices"] = b.index({4, 3, 2, 1, 0});
  b.mesh(primitive);
  return b;
}

TEST(GltfMesh, StripsAndFansBecomeTheTrianglesOfTheSpecification) {
  EXPECT_EQ(load(five_vertices(5, false)).part().triangles, (Triangles{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}));
  EXPECT_EQ(load(five_vertices(6, false)).part().triangles, (Triangles{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}}));
  EXPECT_EQ(load(five_vertices(5, true)).part().triangles, (Triangles{{4, 3, 2}, {3, 1, 2}, {2, 1, 0}}));
  EXPECT_EQ(load(five_vertices(6, true)).part().triangles, (Triangles{{3, 2, 4}, {2, 1, 4}, {1, 0, 4}}));
}

TEST(GltfMesh, TrianglesThatLackAVertexAreLeftOutWithAWarning) {
  const Loaded loaded = load(five_vertices(4, true));
  EXPECT_EQ(loaded.part().triangles, (Triangles{{4, 3, 2}}));
  ASSERT_EQ(loaded.warnings.size(), 1u);
  EXPECT_TRUE(loaded.warnings[0].ends_with("/meshes/0/primitives/0: its last 2 vertices make no triangle"));
}

TEST(GltfMesh, PointsAndLinesAreLeftOutWithOneWarning) {
  GltfBuilder b;
  for (int mode = 0; mode < 4; ++mode) b.mesh({{"attributes", {{"POSITION", b.vec3(kTriangle)}}}, {"mode", mode}});
  const Loaded loaded = load(b);
  for (const Mesh& mesh : loaded.scene().geometry.meshes) EXPECT_TRUE(mesh.parts.empty());
  ASSERT_EQ(loaded.warnings.size(), 1u);
  EXPECT_TRUE(loaded.warnings[0].ends_with("points and lines are left out"));
}

TEST(GltfMesh, PrimitivesAreCountedThroughTheirMesh) {
  GltfBuilder b;
  const int p = b.vec3({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
  const json strip = {{"attributes", {{"POSITION", p}}}, {"mode", 5}},
             line = {{"attributes", {{"POSITION", p}}}, {"mode", 1}};
  b.add("meshes", {{"primitives", {strip, line, strip, strip}}});
  const auto parts = load(b).scene().geometry.meshes.at(0).parts;
  ASSERT_EQ(parts.size(), 3u);
  for (uint32_t i = 0; i < 3; ++i) EXPECT_EQ(parts[i].first_primitive, 2 * i);
}

TEST(GltfMesh, WithoutNormalsHasNoneAndIgnoresItsTangents) {
  GltfBuilder b;
  b.mesh({{"attributes",
           {{"POSITION", b.vec3(kTriangle)}, {"TANGENT", b.accessor(std::vector<float>(12, 1.0f), "VEC4", 5126, 3)}}}});
  EXPECT_TRUE(load(b).part().normals.empty());
  EXPECT_TRUE(load(b).part().tangents.empty());
}

TEST(GltfMesh, NormalsBecomeUnitAndThoseWithoutDirectionTheFaces) {
  GltfBuilder b;
  b.mesh({{"attributes", {{"POSITION", b.vec3(kTriangle)}, {"NORMAL", b.vec3({0, 3, 4, 0, 0, 0, 1e-30f, 0, 0})}}}});
  const auto normals = load(b).part().normals;
  EXPECT_EQ(normals[0], (Vec3f{0, 0.6f, 0.8f}));
  EXPECT_EQ(normals[1], (Vec3f{0, 0, 1}));
  EXPECT_EQ(normals[2], (Vec3f{1, 0, 0}));
}

TEST(GltfMesh, ColorsComeAsRgbOrRgbaInFloatsOrNormalisedIntegers) {
  for (const bool alpha : {false, true})
    for (const int type : {5126, 5121, 5123}) {
      const size_t n = alpha ? 4 : 3;
      GltfBuilder b;
      const char* shape = alpha ? "VEC4" : "VEC3";
      // 0.2, 0.4, 0.6, 0.8 in each; the bytes of RGB need not be aligned to be read.
      std::vector<float> values;
      for (size_t i = 0; i < 3 * n; ++i) values.push_back(0.2f * float(i % n + 1));
      int accessor = 0;
      if (type == 5126) accessor = b.accessor(values, shape, type, 3);
      if (type == 5121) {
        std::vector<uint8_t> bytes;
        for (const float v : values) bytes.push_back(uint8_t(std::lround(v * 255)));
        accessor = b.accessor(bytes, shape, type, 3, true);
      }
      if (type == 5123) {
        std::vector<uint16_t> words;
        for (const float v : values) words.push_back(uint16_t(std::lround(v * 65535)));
        accessor = b.accessor(words, shape, type, 3, true);
      }
      b.mesh({{"attributes", {{"POSITION", b.vec3(kTriangle)}, {"COLOR_0", accessor}}}});
      const Loaded loaded = load(b);
      for (const Vec4f& c : loaded.part().colors) {
        EXPECT_FLOAT_EQ(c.x, 0.2f);
        EXPECT_FLOAT_EQ(c.y, 0.4f);
        EXPECT_FLOAT_EQ(c.z, 0.6f);
        EXPECT_FLOAT_EQ(c.w, alpha ? 0.8f : 1.0f);
      }
    }
}

TEST(GltfMesh, KeepsAllItsUvSets) {
  GltfBuilder b;
  json attributes = {{"POSITION", b.vec3(kTriangle)}};
  for (int i = 0; i < 3; ++i) attributes["TEXCOORD_" + std::to_string(i)] = b.vec2(std::vector<float>(6, float(i)));
  attributes["TEXCOORD_3"] = b.accessor(std::vector<uint16_t>(6, 65535), "VEC2", 5123, 3, true);
  b.mesh({{"attributes", attributes}});
  const auto uvs = load(b).part().uvs;
  ASSERT_EQ(uvs.size(), 4u);
  EXPECT_EQ(uvs[2][1], (Vec2f{2, 2}));
  EXPECT_EQ(uvs[3][2], (Vec2f{1, 1}));
}

TEST(GltfMesh, TakesOnlyTheVerticesThatItUsesFromALargeSharedBuffer) {
  GltfBuilder b;
  std::vector<float> positions, uvs;
  for (int i = 0; i < 1000; ++i) {
    positions.insert(positions.end(), {float(i), 0, float(i % 7)});
    uvs.insert(uvs.end(), {float(i), 1});
  }
  b.mesh({{"attributes", {{"POSITION", b.vec3(positions)}, {"TEXCOORD_0", b.vec2(uvs)}}},
          {"indices", b.index({900, 5, 77})}});
  const TriangleMesh part = load(b).part();
  EXPECT_EQ(part.positions.size(), 3u);
  const float expected[] = {900, 5, 77};
  for (size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(part.positions[part.triangles[0][k]].x, expected[k]);
    EXPECT_EQ(part.uvs[0][part.triangles[0][k]].x, expected[k]);
  }
}

TEST(GltfMesh, GetsTangentsWhereItsMaterialHasANormalTexture) {
  GltfBuilder b;
  b.root["images"] = {{{"uri", "data:,"}}};
  b.root["textures"] = {{{"source", 0}}};
  b.root["materials"] = {json::object(), {{"normalTexture", {{"index", 0}, {"texCoord", 1}}}}};
  const json attributes = {{"POSITION", b.vec3(kTriangle)},
                           {"NORMAL", b.vec3({0, 0, 1, 0, 0, 1, 0, 0, 1})},
                           {"TEXCOORD_0", b.vec2({0, 0, 1, 0, 0, 1})},
                           {"TEXCOORD_1", b.vec2({0, 0, 0, 1, 1, 0})}};
  b.mesh({{"attributes", attributes}, {"material", 0}});
  b.mesh({{"attributes", attributes}, {"material", 1}});
  const Loaded loaded = load(b);
  EXPECT_TRUE(loaded.part(0).tangents.empty());
  ASSERT_EQ(loaded.part(1).tangents.size(), 3u);
  for (const Vec4f& t : loaded.part(1).tangents) EXPECT_EQ(t, (Vec4f{0, 1, 0, 1}));
}

TEST(GltfMesh, CannotUnfoldASmallFileIntoAHugeScene) {
  GltfBuilder b;
  json sparse = {{"type", "VEC3"}, {"count", 1000000}, {"componentType", 5126}};
  const int position = b.add("accessors", sparse);
  json primitives;
  for (int i = 0; i < 1000; ++i) primitives.push_back({{"attributes", {{"POSITION", position}}}});
  b.add("meshes", {{"primitives", primitives}});
  EXPECT_TRUE(error_of(b.document()).ends_with("--max-memory raises the limit"));
}

// ---- Materials ----

TEST(GltfMaterial, LeftOutIsTheDefaultOneAfterTheFiles) {
  GltfBuilder b;
  b.root["materials"] = {{{"name", "first"}}};
  b.mesh({{"attributes", {{"POSITION", b.vec3(kTriangle)}}}});
  const Loaded loaded = load(b);
  EXPECT_EQ(loaded.scene().materials.size(), 2u);
  EXPECT_EQ(loaded.part().material, 1u);
  for (const Material& m : loaded.scene().materials) {
    EXPECT_EQ(m.base_color.rgb, Rgb{1.0f});
    EXPECT_EQ(m.metallic, 1);
    EXPECT_EQ(m.roughness, 1);
    EXPECT_EQ(m.alpha_mode, AlphaMode::opaque);
    EXPECT_EQ(m.alpha_cutoff, 0.5f);
    EXPECT_EQ(m.emissive, Rgb{0.0f});
    EXPECT_EQ(m.ior, 1.5f);
    EXPECT_FALSE(m.base_color_texture || m.normal_texture || m.occlusion_texture || m.emissive_texture);
  }
}

json textured(json material) {
  return {{"asset", {{"version", "2.0"}}},
          {"images", {{{"uri", "data:,"}}}},
          {"samplers", json::array()},
          {"textures", {{{"source", 0}}, {{"source", 0}}, {{"source", 0}}, {{"source", 0}}, {{"source", 0}}}},
          {"materials", {std::move(material)}}};
}

TEST(GltfMaterial, KeepsEverythingThatTheCoreSays) {
  const Material m = load_json(textured({{"alphaMode", "MASK"},
                                         {"alphaCutoff", 0.25},
                                         {"doubleSided", true},
                                         {"pbrMetallicRoughness",
                                          {{"baseColorFactor", {0.125, 0.25, 0.5, 0.75}},
                                           {"baseColorTexture", {{"index", 0}}},
                                           {"metallicFactor", 0.5},
                                           {"roughnessFactor", 0.25},
                                           {"metallicRoughnessTexture", {{"index", 1}, {"texCoord", 1}}}}},
                                         {"normalTexture", {{"index", 2}, {"scale", -2}}},
                                         {"occlusionTexture", {{"index", 3}, {"strength", 0.5}}},
                                         {"emissiveFactor", {0.25, 0.5, 1}},
                                         {"emissiveTexture", {{"index", 4}, {"texCoord", 7}}}}))
                         .scene()
                         .materials[0];
  EXPECT_EQ(m.alpha_mode, AlphaMode::mask);
  EXPECT_EQ(m.alpha_cutoff, 0.25f);
  EXPECT_TRUE(m.double_sided);
  EXPECT_EQ(m.base_color.rgb, (Rgb{0.125f, 0.25f, 0.5f}));
  EXPECT_EQ(m.base_color.a, 0.75f);
  EXPECT_EQ(m.base_color_texture.texture, 0u);
  EXPECT_EQ(m.metallic, 0.5f);
  EXPECT_EQ(m.roughness, 0.25f);
  EXPECT_EQ(m.metallic_roughness_texture.texture, 1u);
  EXPECT_EQ(m.metallic_roughness_texture.uv_set, 1u);
  EXPECT_EQ(m.normal_texture.texture, 2u);
  EXPECT_EQ(m.normal_scale, -2);
  EXPECT_EQ(m.occlusion_texture.texture, 3u);
  EXPECT_EQ(m.occlusion_strength, 0.5f);
  EXPECT_EQ(m.emissive, (Rgb{0.25f, 0.5f, 1}));
  EXPECT_EQ(m.emissive_texture.texture, 4u);
  EXPECT_EQ(m.emissive_texture.uv_set, 7u);
}

TEST(GltfMaterial, KeepsTheKhronosExtensions) {
  const Material m = load_json(textured({{"emissiveFactor", {0.5, 0.5, 0.5}},
                                         {"extensions",
                                          {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}},
                                           {"KHR_materials_ior", {{"ior", 1.25}}},
                                           {"KHR_materials_transmission",
                                            {{"transmissionFactor", 0.5}, {"transmissionTexture", {{"index", 1}}}}},
                                           {"KHR_materials_specular",
                                            {{"specularFactor", 0.25},
                                             {"specularTexture", {{"index", 2}}},
                                             {"specularColorFactor", {2, 1, 0}},
                                             {"specularColorTexture", {{"index", 3}}}}}}}}))
                         .scene()
                         .materials[0];
  EXPECT_EQ(m.emissive, Rgb{4.0f});
  EXPECT_EQ(m.ior, 1.25f);
  EXPECT_EQ(m.transmission, 0.5f);
  EXPECT_EQ(m.transmission_texture.texture, 1u);
  EXPECT_EQ(m.specular, 0.25f);
  EXPECT_EQ(m.specular_texture.texture, 2u);
  EXPECT_EQ(m.specular_color, (Rgb{2, 1, 0}));
  EXPECT_EQ(m.specular_color_texture.texture, 3u);
  const json unlit = {{"extensions", {{"KHR_materials_unlit", json::object()}}}};
  EXPECT_EQ(load_json(textured(unlit)).scene().materials[0].model, ShadingModel::unlit);
}

PhongParameters phong(json fields) {
  const Material m =
      load_json(textured({{"extensions", {{"ALHAZEN_materials_phong", std::move(fields)}}}})).scene().materials[0];
  EXPECT_EQ(m.model, ShadingModel::phong);
  return m.phong;
}

TEST(GltfMaterial, PhongDefaultsFollowItsOtherFields) {
  const PhongParameters all_default = phong(json::object());
  EXPECT_EQ(all_default.diffuse, Rgb{0.8f});
  EXPECT_EQ(all_default.ambient, Rgb{0.8f});
  EXPECT_EQ(all_default.specular, Rgb{0.0f});
  EXPECT_EQ(all_default.reflection, Rgb{0.0f});
  EXPECT_EQ(all_default.transmission, Rgb{0.0f});
  EXPECT_EQ(all_default.shininess, 32);
  EXPECT_EQ(all_default.ior, 1.5f);
  EXPECT_FALSE(all_default.fresnel);

  PhongParameters p =
      phong({{"diffuseFactor", {1, 0, 0}}, {"specularFactor", {0, 1, 0}}, {"diffuseTexture", {{"index", 1}}}});
  EXPECT_EQ(p.ambient, (Rgb{1, 0, 0}));
  EXPECT_EQ(p.ambient_texture.texture, 1u);
  EXPECT_EQ(p.reflection, (Rgb{0, 1, 0}));
  p = phong({{"ambientFactor", {0, 0, 1}},
             {"diffuseTexture", {{"index", 1}}},
             {"reflectionFactor", {0, 0, 0}},
             {"specularFactor", {1, 1, 1}}});
  EXPECT_EQ(p.ambient, (Rgb{0, 0, 1}));
  EXPECT_FALSE(p.ambient_texture);
  EXPECT_EQ(p.reflection, Rgb{0.0f});
  p = phong({{"ambientTexture", {{"index", 2}}}, {"diffuseTexture", {{"index", 1}}}});
  EXPECT_EQ(p.ambient_texture.texture, 2u);
  EXPECT_EQ(p.diffuse_texture.texture, 1u);
}

TEST(GltfTexture, TransformIsTranslationRotationScale) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> u(-3, 3);
  for (int i = 0; i < 50; ++i) {
    const double ox = u(rng), oy = u(rng), sx = u(rng), sy = u(rng), a = u(rng);
    const json transform = {{"offset", {ox, oy}}, {"scale", {sx, sy}}, {"rotation", a}, {"texCoord", 2}};
    const TextureUse t =
        load_json(textured({{"emissiveTexture",
                             {{"index", 1}, {"texCoord", 1}, {"extensions", {{"KHR_texture_transform", transform}}}}}}))
            .scene()
            .materials[0]
            .emissive_texture;
    EXPECT_EQ(t.texture, 1u);
    EXPECT_EQ(t.uv_set, 2u);
    const double x = u(rng), y = u(rng);
    // The extension's own words: rotation [[cos, sin], [-sin, cos]] of the scaled point.
    EXPECT_NEAR(double(t.xx) * x + double(t.xy) * y + double(t.x0), std::cos(a) * sx * x + std::sin(a) * sy * y + ox,
                1e-5);
    EXPECT_NEAR(double(t.yx) * x + double(t.yy) * y + double(t.y0), -std::sin(a) * sx * x + std::cos(a) * sy * y + oy,
                1e-5);
  }
}

TEST(GltfTexture, KeepsEveryWrapAndFilterMode) {
  const std::pair<int, Wrap> wraps[] = {
      {10497, Wrap::repeat}, {33071, Wrap::clamp_to_edge}, {33648, Wrap::mirrored_repeat}};
  for (const auto& [s, wrap_u] : wraps)
    for (const auto& [t, wrap_v] : wraps)
      for (const int mag : {0, 9728, 9729})
        for (const int min : {9728, 9729, 9984, 9985, 9986, 9987}) {
          json sampler = {{"wrapS", s}, {"wrapT", t}, {"minFilter", min}};
          if (mag) sampler["magFilter"] = mag;
          json document = textured(json::object());
          document["samplers"] = {sampler};
          document["textures"] = {{{"source", 0}, {"sampler", 0}}, {{"source", 0}}, json::object()};
          const auto textures = load_json(document).scene().textures;
          EXPECT_EQ(textures[0].wrap_u, wrap_u);
          EXPECT_EQ(textures[0].wrap_v, wrap_v);
          EXPECT_EQ(textures[0].nearest, mag == 9728);
          EXPECT_EQ(textures[1].wrap_u, Wrap::repeat);
          EXPECT_FALSE(textures[1].nearest);
          EXPECT_EQ(textures[2].image, kNone);
        }
}

/// Images that no material uses are not read.
void use_images(GltfBuilder& b) {
  for (size_t i = 0; i < b.root["images"].size(); ++i) {
    const int texture = b.add("textures", {{"source", i}});
    b.add("materials", {{"emissiveTexture", {{"index", texture}}}});
  }
}

TEST(GltfImage, ComesFromAFileAnUriOrABufferView) {
  const TemporaryFolder folder;
  folder.write("a b.png", "file");
  GltfBuilder b;
  b.add("images", {{"bufferView", b.view("view")}, {"mimeType", "image/png"}});
  b.add("images", {{"uri", "a%20b.png"}});
  b.add("images", {{"uri", "data:image/webp;base64," + base64("data")}});
  use_images(b);
  const auto encoded = load_file(folder.write("scene.gltf", b.document().dump())).loaded.encoded;
  ASSERT_EQ(encoded.size(), 3u);
  const char* expected[] = {"view", "file", "data"};
  for (size_t i = 0; i < 3; ++i) EXPECT_EQ(std::string(encoded[i].bytes.begin(), encoded[i].bytes.end()), expected[i]);
  EXPECT_TRUE(encoded[1].place.ends_with("scene.gltf: /images/1"));
}

TEST(GltfImage, ThatIsMissingIsAWarning) {
  GltfBuilder b;
  b.root["images"] = {{{"uri", "absent.png"}}, {{"name", "nothing"}}};
  use_images(b);
  const Loaded loaded = load(b);
  ASSERT_EQ(loaded.warnings.size(), 2u);
  EXPECT_TRUE(loaded.warnings[0].ends_with("/images/0/uri: cannot read `absent.png`, taken as white"));
  EXPECT_TRUE(loaded.warnings[1].ends_with("/images/1: has neither `uri` nor `bufferView`, taken as white"));
}

// ---- Nodes ----

Vec3d rotated(const std::array<double, 4>& q, const Vec3d& v) {
  const Vec3d axis{q[0], q[1], q[2]};
  return v + cross(axis, cross(axis, v) + v * q[3]) * 2.0;
}

TEST(GltfNode, TransformsAreTranslationRotationScaleThroughTheHierarchy) {
  std::mt19937 rng(4);
  std::uniform_real_distribution<double> u(-2, 2);
  for (int i = 0; i < 200; ++i) {
    GltfBuilder b;
    const int mesh = b.add("meshes", {{"primitives", {{{"attributes", {{"POSITION", b.vec3(kTriangle)}}}}}}});
    std::vector<std::array<double, 4>> q(3);
    std::vector<Vec3d> t, s;
    for (int n = 0; n < 3; ++n) {
      auto& r = q[size_t(n)];
      do r = {u(rng), u(rng), u(rng), u(rng)};
      while (r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3] < 0.1);
      const double norm = std::sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3]);
      for (double& c : r) c /= norm;
      t.push_back({u(rng), u(rng), u(rng)});
      s.push_back({u(rng), u(rng), u(rng)});
      json node = {{"translation", {t[size_t(n)].x, t[size_t(n)].y, t[size_t(n)].z}},
                   {"rotation", r},
                   {"scale", {s[size_t(n)].x, s[size_t(n)].y, s[size_t(n)].z}}};
      if (n < 2) node["children"] = {n + 1};
      if (n == 2) node["mesh"] = mesh;
      b.add("nodes", node);
    }
    const Loaded loaded = load(b);
    ASSERT_EQ(loaded.scene().geometry.mesh_instances.size(), 1u);
    const MeshInstance instance = loaded.scene().geometry.mesh_instances[0];
    EXPECT_EQ(instance.node, 2u);
    Vec3d p{u(rng), u(rng), u(rng)};
    const Vec3d found = transform_point(instance.world_from_object, p);
    for (size_t n = 3; n-- > 0;) p = rotated(q[n], p * s[n]) + t[n];
    EXPECT_NEAR(length(found - p), 0, 1e-12 * (1 + length(p)));
  }
}

TEST(GltfNode, MatricesAreReadColumnByColumn) {
  GltfBuilder b;
  b.mesh({{"attributes", {{"POSITION", b.vec3(kTriangle)}}}});
  b.root["nodes"][0]["matrix"] = {1, 2, 3, 0, 4, 5, -6, 0, 7, 8, 10, 0, 11, 12, 13, 1};
  const Affine3d m = load(b).scene().geometry.mesh_instances[0].world_from_object;
  EXPECT_EQ(m, (Affine3d{{1, 2, 3}, {4, 5, -6}, {7, 8, 10}, {11, 12, 13}}));
}

GltfBuilder three_meshes() {
  GltfBuilder b;
  const int p = b.vec3(kTriangle);
  for (int i = 0; i < 3; ++i) b.mesh({{"attributes", {{"POSITION", p}}}});
  b.root["nodes"][0]["children"] = {2};
  return b;
}

std::vector<uint32_t> shown_nodes(const json& document) {
  std::vector<uint32_t> nodes;
  const Loaded loaded = load_json(document);
  for (const MeshInstance instance : loaded.scene().geometry.mesh_instances) nodes.push_back(instance.node);
  return nodes;
}

TEST(GltfScene, IsTheFilesOneElseTheFirstElseAllRoots) {
  json document = three_meshes().document();
  EXPECT_EQ(shown_nodes(document), (std::vector<uint32_t>{0, 1, 2}));
  document["scenes"] = {{{"nodes", {1}}}, {{"nodes", {0}}}, json::object()};
  EXPECT_EQ(shown_nodes(document), (std::vector<uint32_t>{1}));
  document["scene"] = 1;
  EXPECT_EQ(shown_nodes(document), (std::vector<uint32_t>{0, 2}));
  document["scene"] = 2;
  EXPECT_TRUE(shown_nodes(document).empty());
}

TEST(GltfScene, AmbientAndBackgroundAreItsOwn) {
  json document = {{"asset", {{"version", "2.0"}}}, {"scene", 1}};
  document["scenes"] = {json::object(),
                        {{"extensions", {{"ALHAZEN_lights", {{"ambient", {1, 2, 3}}, {"background", {4, 5, 6}}}}}}}};
  const Loaded loaded = load_json(document);
  EXPECT_TRUE(loaded.scene().has_ambient && loaded.scene().has_background);
  EXPECT_EQ(loaded.scene().ambient, (Rgb{1, 2, 3}));
  EXPECT_EQ(loaded.scene().background, (Rgb{4, 5, 6}));
  document["scene"] = 0;
  EXPECT_FALSE(load_json(document).scene().has_ambient);
}

TEST(GltfNode, DeepChainsAreNoTrouble) {
  json document = {{"asset", {{"version", "2.0"}}}};
  constexpr int kDeep = 100000;
  for (int i = 0; i < kDeep; ++i)
    document["nodes"].push_back(i + 1 < kDeep ? json{{"children", {i + 1}}} : json::object());
  const TemporaryFolder folder;
  const auto budget = std::make_shared<LoadBudget>(LoadLimits{.node_depth = kDeep});
  EXPECT_NO_THROW((void)load_gltf(folder.write("deep.gltf", document.dump()), {}, {}, budget));
}

// ---- Cameras and lights ----

TEST(GltfCamera, KeepsPositionAndRotationButNoScale) {
  json document = {{"asset", {{"version", "2.0"}}}};
  document["cameras"] = {
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 3}, {"znear", 0}, {"zfar", 9}}}},
      {{"name", "wide"}, {"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}};
  const double h = std::sqrt(0.5);
  document["nodes"] = {{{"camera", 1}, {"translation", {1, 2, 3}}, {"rotation", {0, h, 0, h}}, {"scale", {2, 3, 4}}},
                       {{"camera", 0}}};
  const auto loaded = load_json(document);
  const auto& cameras = loaded.scene().cameras;
  ASSERT_EQ(cameras.size(), 2u);
  EXPECT_EQ(loaded.scene().camera_index, (std::vector<uint32_t>{1, 0}));
  EXPECT_EQ(cameras[0].name, "wide");
  EXPECT_EQ(cameras[0].kind, Camera::Kind::perspective);
  EXPECT_EQ(cameras[0].yfov, 0.5);
  const Affine3d& m = cameras[0].world_from_camera;  // a quarter about y: -z to -x
  EXPECT_NEAR(length(m.z - Vec3d{1, 0, 0}), 0, 1e-12);
  EXPECT_NEAR(length(m.y - Vec3d{0, 1, 0}), 0, 1e-12);
  EXPECT_NEAR(length(m.x - Vec3d{0, 0, -1}), 0, 1e-12);
  EXPECT_EQ(m.origin, (Vec3d{1, 2, 3}));
  EXPECT_EQ(cameras[1].kind, Camera::Kind::orthographic);
  EXPECT_EQ(cameras[1].ymag, 3);
}

TEST(GltfLight, KeepsEverythingThatItsExtensionsSay) {
  json document = {{"asset", {{"version", "2.0"}}}};
  document["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "spot"},
       {"name", "lamp"},
       {"color", {1, 0.5, 0.25}},
       {"intensity", 4},
       {"range", 7},
       {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}},
      {{"type", "point"}, {"extensions", {{"ALHAZEN_lights", {{"attenuation", "none"}}}}}},
      {{"type", "directional"}}};
  const double h = std::sqrt(0.5);
  for (int i = 0; i < 3; ++i)
    document["nodes"].push_back({{"translation", {i, 0, 0}},
                                 {"rotation", {h, 0, 0, h}},
                                 {"scale", {5, 5, 5}},
                                 {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
  const auto lights = load_json(document).scene().lights;
  ASSERT_EQ(lights.size(), 3u);
  EXPECT_EQ(lights[0].kind, Light::Kind::spot);
  EXPECT_EQ(lights[0].name, "lamp");
  EXPECT_EQ(lights[0].intensity, (Rgb{4, 2, 1}));
  EXPECT_EQ(lights[0].range, 7);
  EXPECT_FLOAT_EQ(lights[0].cos_inner, std::cos(0.25f));
  EXPECT_FLOAT_EQ(lights[0].cos_outer, std::cos(0.5f));
  EXPECT_TRUE(lights[0].attenuated);
  EXPECT_EQ(lights[1].kind, Light::Kind::point);
  EXPECT_EQ(lights[1].intensity, Rgb{1.0f});
  EXPECT_EQ(lights[1].range, 0);
  EXPECT_FALSE(lights[1].attenuated);
  EXPECT_EQ(lights[2].kind, Light::Kind::directional);
  for (int i = 0; i < 3; ++i) {  // a quarter about x: -z to +y
    EXPECT_NEAR(length(lights[size_t(i)].direction_world - Vec3d{0, 1, 0}), 0, 1e-12);
    EXPECT_EQ(lights[size_t(i)].p_world, (Vec3d{double(i), 0, 0}));
  }
}

// ---- Shapes ----

TEST(GltfShape, IsPlacedByItsNodes) {
  json document = {{"asset", {{"version", "2.0"}}}};
  document["extensions"]["ALHAZEN_shapes"]["shapes"] = {{{"sphere", json::object()}},
                                                        {{"name", "big"}, {"sphere", {{"radius", 2.5}}}}};
  document["materials"] = {json::object()};
  document["nodes"] = {
      {{"translation", {1, 0, 0}}, {"extensions", {{"ALHAZEN_shapes", {{"shape", 1}, {"material", 0}}}}}},
      {{"scale", {-1, 2, 3}}, {"extensions", {{"ALHAZEN_shapes", {{"shape", 1}}}}}}};
  const Loaded loaded = load_json(document);
  const Geometry& geometry = loaded.scene().geometry;
  EXPECT_EQ(std::get<Sphere>(geometry.shapes.at(0)).radius, 1);
  EXPECT_EQ(std::get<Sphere>(geometry.shapes.at(1)).radius, 2.5f);
  ASSERT_EQ(geometry.shape_instances.size(), 2u);
  EXPECT_EQ(geometry.shape_instances[0].shape, 1u);
  EXPECT_EQ(geometry.shape_instances[0].material, 0u);
  EXPECT_EQ(geometry.shape_instances[1].material, 1u);  // the default one
  EXPECT_EQ(geometry.shape_instances[1].world_from_object.x, (Vec3d{-1, 0, 0}));
}

}  // namespace
}  // namespace alhazen
