// Keyframes against closed forms, and what of a document they reach.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "gltf_builder.h"
#include "loaders/animated_properties.h"
#include "loaders/gltf_file.h"
#include "loaders/keyframes.h"

namespace alhazen {
namespace {

std::mt19937 g_random(71);
double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(g_random); }

Keyframes scalar_keys(Interpolation interpolation, std::vector<float> times, std::vector<float> values) {
  return {.interpolation = interpolation, .width = 1, .times = std::move(times), .values = std::move(values)};
}

/// A unit quaternion about the axis.
std::vector<double> about(const Vec3d& axis, double angle) {
  const Vec3d v = normalize(axis) * std::sin(angle / 2);
  return {v.x, v.y, v.z, std::cos(angle / 2)};
}

TEST(Keyframes, BeforeTheFirstAndAfterTheLastKeyHoldTheEnds) {
  for (const auto interpolation : {Interpolation::step, Interpolation::linear}) {
    const Keyframes keys = scalar_keys(interpolation, {1, 2, 4}, {10, 20, 50});
    for (const double early : {-1e9, 0.0, 1.0}) EXPECT_EQ(value_at(keys, early)[0], 10);
    for (const double late : {4.0, 5.0, 1e9}) EXPECT_EQ(value_at(keys, late)[0], 50);
  }
  const Keyframes cubic = scalar_keys(Interpolation::cubic_spline, {1, 2}, {7, 10, 7, 7, 20, 7});
  EXPECT_EQ(value_at(cubic, 0)[0], 10);
  EXPECT_EQ(value_at(cubic, 3)[0], 20);
}

TEST(Keyframes, OneKeyHoldsForever) {
  for (const double t : {-1.0, 0.5, 9.0}) {
    EXPECT_EQ(value_at(scalar_keys(Interpolation::linear, {0.5f}, {3}), t)[0], 3);
    EXPECT_EQ(value_at(scalar_keys(Interpolation::cubic_spline, {0.5f}, {1, 3, 1}), t)[0], 3);
  }
}

TEST(Keyframes, OfTwoKeysAtOneTimeTheLaterHoldsFromThereOn) {
  const Keyframes keys = scalar_keys(Interpolation::linear, {0, 1, 1, 2}, {0, 10, 100, 110});
  EXPECT_NEAR(value_at(keys, 1 - 1e-9)[0], 10, 1e-6);
  EXPECT_EQ(value_at(keys, 1)[0], 100);
  EXPECT_DOUBLE_EQ(value_at(keys, 1.5)[0], 105);
}

TEST(Keyframes, StepsHoldUntilTheNextKeyAndLinesRunStraight) {
  const Keyframes step = scalar_keys(Interpolation::step, {0, 1, 3}, {5, 6, 7});
  const Keyframes linear = scalar_keys(Interpolation::linear, {0, 1, 3}, {5, 6, 8});
  for (int i = 0; i < 1000; ++i) {
    const double t = uniform(0, 3);
    EXPECT_EQ(value_at(step, t)[0], t < 1 ? 5 : 6);
    EXPECT_NEAR(value_at(linear, t)[0], 5 + t, 1e-12);
  }
}

TEST(Keyframes, CubicSplinesReproduceAnyCubicPolynomial) {
  for (int i = 0; i < 200; ++i) {
    const double a = uniform(-2, 2), b = uniform(-2, 2), c = uniform(-2, 2), d = uniform(-2, 2);
    const auto p = [&](double t) { return ((a * t + b) * t + c) * t + d; };
    const auto slope = [&](double t) { return (3 * a * t + 2 * b) * t + c; };
    Keyframes keys{.interpolation = Interpolation::cubic_spline, .times = {}, .values = {}};
    for (float t = 0; t < 3; t += float(uniform(0.25, 1))) {
      keys.times.push_back(t);
      for (const double v : {slope(double(t)), p(double(t)), slope(double(t))}) keys.values.push_back(float(v));
    }
    const double t = uniform(0, double(keys.times.back()));
    EXPECT_NEAR(value_at(keys, t)[0], p(t), 2e-5);
  }
}

TEST(Keyframes, RotationsTurnAtEvenSpeedTheShorterWay) {
  for (int i = 0; i < 500; ++i) {
    const Vec3d axis{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    const double from = uniform(-3, 3), turn = uniform(-3.1, 3.1), s = uniform(0, 1);  // |turn| < pi
    const double sign = uniform(-1, 1) < 0 ? -1 : 1;                                   // q and -q are one rotation
    Keyframes keys{.rotations = true, .width = 4, .times = {0, 1}, .values = {}};
    for (const double v : about(axis, from)) keys.values.push_back(float(v));
    for (const double v : about(axis, from + turn)) keys.values.push_back(float(sign * v));
    const auto found = value_at(keys, s), expected = about(axis, from + s * turn);
    double product = 0, norm = 0;
    for (size_t k = 0; k < 4; ++k) product += found[k] * expected[k], norm += found[k] * found[k];
    EXPECT_NEAR(std::abs(product), 1, 1e-6);
    EXPECT_NEAR(norm, 1, 1e-12);
  }
}

TEST(Keyframes, CubicRotationsAreUnitLength) {
  for (int i = 0; i < 200; ++i) {
    Keyframes keys{
        .interpolation = Interpolation::cubic_spline, .rotations = true, .width = 4, .times = {0, 1}, .values = {}};
    for (int k = 0; k < 24; ++k) keys.values.push_back(float(uniform(-1, 1)));
    double norm = 0;
    for (const double v : value_at(keys, uniform(0, 1))) norm += v * v;
    EXPECT_NEAR(norm, 1, 1e-12);
  }
}

TEST(AnimatedProperties, AreFoundByTheirPointers) {
  const auto found = [](const std::string& pointer) {
    const auto tokens = pointer_tokens(pointer);
    return tokens && animated_property(*tokens).has_value();
  };
  for (const char* known :
       {"/nodes/0/translation", "/nodes/12/rotation", "/nodes/0/weights", "/nodes/3/weights/1",
        "/nodes/0/extensions/KHR_node_visibility/visible", "/meshes/1/weights", "/cameras/0/perspective/yfov",
        "/materials/3/pbrMetallicRoughness/baseColorFactor", "/materials/0/extensions/KHR_materials_ior/ior",
        "/extensions/KHR_lights_punctual/lights/2/spot/outerConeAngle", "/materials/0/alphaCutoff",
        "/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/offset",
        "/materials/0/extensions/KHR_materials_clearcoat/clearcoatTexture/extensions/KHR_texture_transform/rotation"})
    EXPECT_TRUE(found(known)) << known;
  for (const char* unknown : {"", "nodes/0/translation", "/nodes/x/translation", "/nodes/0/translation/0", "/nodes/0",
                              "/nodes//scale", "/materials/0/doubleSided", "/nodes/99999999999999999999/scale"})
    EXPECT_FALSE(found(unknown)) << unknown;
  EXPECT_EQ(pointer_tokens("/a~1b/~0c//"), (PointerTokens{"a/b", "~c", "", ""}));
}

// ---- Animations in files ----

/// A triangle's node under an animation; `b.root["animations"][0]` is there to be changed.
struct AnimatedFile {
  GltfBuilder b;
  int input, output;

  AnimatedFile(const std::string& path, const std::vector<float>& times, const std::vector<float>& values,
               const char* type, size_t count) {
    b.mesh({{"attributes", {{"POSITION", b.vec3(kTriangle)}}}});
    input = b.accessor(times, "SCALAR", 5126, times.size());
    output = b.accessor(values, type, 5126, count);
    b.add("animations", {{"name", "go"},
                         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}},
                         {"samplers", {{{"input", input}, {"output", output}}}}});
  }
  json& channel() { return b.root["animations"][0]["channels"][0]; }
  json& sampler() { return b.root["animations"][0]["samplers"][0]; }
};

AnimatedFile moving() { return {"translation", {0, 2}, {0, 0, 0, 4, 0, 0}, "VEC3", 2}; }

TimeChoice play(const std::string& animation, std::optional<double> time = std::nullopt) { return {animation, time}; }

Loaded load_at(const GltfBuilder& b, const TimeChoice& time) {
  const TemporaryFolder folder;
  Loaded result;
  const auto warn = [&](const std::string& text) { result.warnings.push_back(text); };
  result.loaded = GltfFile(folder.write("scene.gltf", b.document().dump()), warn, {}, time).load(time.time.value_or(0));
  return result;
}

double x_at(const GltfBuilder& b, const TimeChoice& choice) {
  return load_at(b, choice).scene().geometry.mesh_instances[0].world_from_object.origin.x;
}

std::string error_at(const GltfBuilder& b, const TimeChoice& choice = play("0")) {
  try {
    (void)load_at(b, choice);
    return {};
  } catch (const LoadError& error) {
    const std::string what = error.what();
    return what.substr(what.find("gltf: ") + 6);
  }
}

TEST(GltfAnimation, TheRestPoseIsSeenUnlessATimeOrAnAnimationIsNamed) {
  AnimatedFile f = moving();
  f.b.root["nodes"][0]["translation"] = {9, 0, 0};
  EXPECT_EQ(x_at(f.b, {}), 9);
  EXPECT_EQ(x_at(f.b, play("none", 1)), 9);
  EXPECT_EQ(x_at(f.b, play("", 1)), 2);
  EXPECT_EQ(x_at(f.b, play("go")), 0);
  EXPECT_EQ(x_at(f.b, play("0", 0.5)), 1);
  EXPECT_EQ(x_at(f.b, play("all", 99)), 4);
  EXPECT_THROW((void)load_at(f.b, play("stop")), UsageError);
}

TEST(GltfAnimation, OfSeveralTheLaterOneWins) {
  AnimatedFile f = moving();
  json second = f.b.root["animations"][0];
  second["samplers"][0]["output"] = f.b.vec3({0, 0, 0, 8, 0, 0});
  f.b.root["animations"].push_back(second);
  EXPECT_EQ(x_at(f.b, play("all", 1)), 4);
  EXPECT_EQ(x_at(f.b, play("1", 1)), 4);
  EXPECT_EQ(x_at(f.b, play("0", 1)), 2);
}

TEST(GltfAnimation, ValuesMayBeNormalisedIntegers) {
  AnimatedFile f = moving();
  f.channel()["target"]["path"] = "rotation";
  f.sampler()["output"] = f.b.accessor(std::vector<int8_t>{0, 0, 0, 127, 0, 0, 127, 0}, "VEC4", 5120, 2, true);
  const Affine3d m = load_at(f.b, play("", 1)).scene().geometry.mesh_instances[0].world_from_object;
  EXPECT_NEAR(m.x.y, 1, 1e-12);  // half of a half turn about z
}

TEST(GltfAnimation, NamesThePlaceOfWhatIsWrong) {
  const auto error = [](const auto& spoil) {
    AnimatedFile f = moving();
    spoil(f);
    return error_at(f.b);
  };
  EXPECT_EQ(error([](AnimatedFile& f) {
              f.sampler()["input"] = f.b.accessor(std::vector<float>{1, 0}, "SCALAR", 5126, 2);
            }),
            "/animations/0/samplers/0/input: expected times that rise, found key 1 earlier than the one before");
  EXPECT_EQ(error([](AnimatedFile& f) {
              f.sampler()["input"] = f.b.accessor(std::vector<float>{0, NAN}, "SCALAR", 5126, 2);
            }),
            "/animations/0/samplers/0/input: expected finite numbers, the accessor holds others");
  EXPECT_EQ(error([](AnimatedFile& f) { f.sampler()["input"] = f.output; }),
            "/animations/0/samplers/0/input: expected an accessor of type SCALAR, of floats, found 2");
  EXPECT_TRUE(error([](AnimatedFile& f) {
                f.sampler()["interpolation"] = "CUBICSPLINE";
              }).starts_with("/animations/0/samplers/0/output: expected 18 numbers"));
  EXPECT_EQ(error([](AnimatedFile& f) { f.channel()["sampler"] = 1; }),
            "/animations/0/channels/0/sampler: index 1 out of range, the animation has 1 samplers");
  EXPECT_TRUE(error([](AnimatedFile& f) {
                f.channel()["target"]["node"] = 7;
              }).starts_with("/animations/0/channels/0/target/node: index 7 out of range"));
  EXPECT_TRUE(error([](AnimatedFile& f) {
                f.sampler()["interpolation"] = "CUBIC";
              }).starts_with("/animations/0/samplers/0/interpolation: expected one of"));
  EXPECT_TRUE(error([](AnimatedFile& f) {
                f.b.root["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
              }).starts_with("/animations/0/channels/0: animates the translation of node 0, which has a matrix"));
  EXPECT_EQ(error([](AnimatedFile& f) {
              f.channel()["target"]["path"] = "rotation";
              f.sampler()["output"] = f.b.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 0}, "VEC4", 5126, 2);
            }),
            "/animations/0/samplers/0/output: expected unit quaternions, found 0 0 0 0 at key 1");
  EXPECT_EQ(error([](AnimatedFile& f) { f.channel()["target"]["path"] = "weights"; }),
            "/animations/0/channels/0: animates the weights of a mesh that has no morph targets");
}

TEST(GltfAnimation, AnInvalidOneDoesNotStopAStillThatDoesNotUseIt) {
  AnimatedFile f = moving();
  f.sampler()["output"] = f.input;
  EXPECT_NE(error_at(f.b), "");
  EXPECT_EQ(error_at(f.b, {}), "");
}

// ---- KHR_animation_pointer ----

/// The file with a pointer in place of the node's translation.
AnimatedFile pointing(const std::string& pointer, const std::vector<float>& values, const char* type, size_t count) {
  AnimatedFile f("pointer", {0, 2}, values, type, count);
  f.channel()["target"] = {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}};
  f.b.root["materials"] = {{{"normalTexture", {{"index", 0}}}}};
  f.b.root["textures"] = {json::object()};
  f.b.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
  f.b.root["nodes"][0]["camera"] = 0;
  f.b.root["extensions"] = {{"KHR_lights_punctual", {{"lights", {{{"type", "spot"}}}}}}};
  f.b.root["nodes"][0]["extensions"] = {{"KHR_lights_punctual", {{"light", 0}}}};
  return f;
}

Scene scene_pointed(const std::string& pointer, const std::vector<float>& values, const char* type, size_t count) {
  const Loaded loaded = load_at(pointing(pointer, values, type, count).b, play("", 1));
  EXPECT_TRUE(loaded.warnings.size() <= 1) << loaded.warnings.back();  // the texture has no image
  return loaded.scene();
}

TEST(GltfAnimationPointer, ReachesMaterialsLightsAndCameras) {
  const auto number = [](const std::string& pointer) { return scene_pointed(pointer, {0.25f, 0.75f}, "SCALAR", 2); };
  const std::string material = "/materials/0/", light = "/extensions/KHR_lights_punctual/lights/0/";
  EXPECT_FLOAT_EQ(number(material + "pbrMetallicRoughness/roughnessFactor").materials[0].roughness, 0.5f);
  EXPECT_FLOAT_EQ(number(material + "pbrMetallicRoughness/metallicFactor").materials[0].metallic, 0.5f);
  EXPECT_FLOAT_EQ(number(material + "normalTexture/scale").materials[0].normal_scale, 0.5f);
  EXPECT_FLOAT_EQ(number(material + "alphaCutoff").materials[0].alpha_cutoff, 0.5f);
  EXPECT_FLOAT_EQ(
      number(material + "extensions/KHR_materials_transmission/transmissionFactor").materials[0].transmission, 0.5f);
  EXPECT_FLOAT_EQ(number(material + "extensions/KHR_materials_ior/ior").materials[0].ior, 1);  // not below
  EXPECT_FLOAT_EQ(number(light + "intensity").lights[0].intensity.g, 0.5f);
  EXPECT_FLOAT_EQ(number(light + "range").lights[0].range, 0.5f);
  EXPECT_FLOAT_EQ(number(light + "spot/outerConeAngle").lights[0].cos_outer, std::cos(0.5f));
  EXPECT_DOUBLE_EQ(number("/cameras/0/perspective/yfov").cameras[0].yfov, 0.5);
  const Scene colored =
      scene_pointed(material + "pbrMetallicRoughness/baseColorFactor", {0, 0, 0, 0, 1, 0.5f, 0.25f, 3}, "VEC4", 2);
  EXPECT_EQ(colored.materials[0].base_color.rgb, (Rgb{0.5f, 0.25f, 0.125f}));
  EXPECT_EQ(colored.materials[0].base_color.a, 1);  // brought back into its range
  EXPECT_EQ(scene_pointed(light + "color", {0, 0, 0, 1, 2, 3}, "VEC3", 2).lights[0].intensity, (Rgb{0.5f, 1, 1.5f}));
  const Scene shifted =
      scene_pointed(material + "normalTexture/extensions/KHR_texture_transform/offset", {0, 0, 1, 0.5f}, "VEC2", 2);
  EXPECT_FLOAT_EQ(shifted.materials[0].normal_texture.x0, 0.5f);
  EXPECT_FLOAT_EQ(shifted.materials[0].normal_texture.y0, 0.25f);
}

TEST(GltfAnimationPointer, AnAnisotropyThatGrowsFromNothingFindsTangents) {
  AnimatedFile f = pointing("/materials/0/extensions/KHR_materials_anisotropy/anisotropyStrength", {0, 1}, "SCALAR", 2);
  json& attributes = f.b.root["meshes"][0]["primitives"][0]["attributes"];
  f.b.root["meshes"][0]["primitives"][0]["material"] = 0;
  f.b.root["materials"] = {{{"extensions", {{"KHR_materials_anisotropy", json::object()}}}}};
  attributes["NORMAL"] = f.b.vec3({0, 0, 1, 0, 0, 1, 0, 0, 1});
  attributes["TEXCOORD_0"] = f.b.vec2({0, 0, 1, 0, 0, 1});
  EXPECT_TRUE(load_at(f.b, play("none")).part().tangents.empty());
  const Loaded played = load_at(f.b, play("", 0));
  EXPECT_EQ(played.scene().materials[0].anisotropy.strength, 0);
  EXPECT_EQ(played.part().tangents.size(), 3u);
}

TEST(GltfAnimationPointer, HidesAndShowsNodes) {
  AnimatedFile f = pointing("/nodes/0/extensions/KHR_node_visibility/visible", {0, 0}, "SCALAR", 2);
  f.sampler()["output"] = f.b.accessor(std::vector<uint8_t>{1, 0}, "SCALAR", 5121, 2);
  f.sampler()["interpolation"] = "STEP";
  EXPECT_EQ(load_at(f.b, play("", 1.9)).scene().geometry.mesh_instances.size(), 1u);
  EXPECT_EQ(load_at(f.b, play("", 2)).scene().geometry.mesh_instances.size(), 0u);
}

TEST(GltfAnimationPointer, WhatItDoesNotReachIsNamedInOneWarning) {
  AnimatedFile f = pointing("/materials/0/doubleSided", {0, 0}, "SCALAR", 2);
  json other = f.channel();
  other["target"]["extensions"]["KHR_animation_pointer"]["pointer"] = "/nodes/9/scale";
  f.b.root["animations"][0]["channels"].push_back(other);
  const auto warnings = load_at(f.b, play("", 1)).warnings;
  ASSERT_FALSE(warnings.empty());
  EXPECT_TRUE(warnings[0].ends_with(
      "/animations: not animated, nothing of the picture answers to: /materials/0/doubleSided, /nodes/9/scale"))
      << warnings[0];
}

}  // namespace
}  // namespace alhazen
