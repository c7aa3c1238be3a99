// Claims about files of measured BRDFs, and about scenes that use them.
#include <gtest/gtest.h>

#include <cstring>

#include "accel/accelerated_scene.h"
#include "gltf_builder.h"
#include "loaders/brdf_csv.h"
#include "loaders/measured_file.h"
#include "loaders/merl_file.h"
#include "loaders/scattered_brdf.h"
#include "measured_files.h"
#include "renderer/render.h"
#include "trials.h"

namespace alhazen {
namespace {

namespace fs = std::filesystem;

constexpr Vec3f kUp{0, 0, 1};
const MeasuredGrid kSmall{12, 10, 8};
const std::string kHeader = "theta_i,phi_i,theta_o,phi_o,r,g,b\n";

std::span<const uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const uint8_t*>(text.data()), text.size()};
}

/// What is wrong, after the name; empty if it is read.
std::string error_of_bytes(const std::string& file, const LoadLimits& limits = {}) {
  LoadBudget budget(limits);
  budget.take_file("x", file.size());
  try {
    (void)parse_measured_brdf(bytes_of(file), "x", budget);
    return {};
  } catch (const LoadError& error) {
    return std::string(error.what()).substr(3);
  }
}

std::string header(int32_t h, int32_t d, int32_t p) {
  const int32_t counts[] = {h, d, p};
  return {reinterpret_cast<const char*>(counts), sizeof counts};
}

std::string with_double(std::string file, size_t entry, double value) {
  std::memcpy(file.data() + 12 + entry * 8, &value, sizeof value);
  return file;
}

// ---- MERL ----

TEST(MerlFile, ComesBackAsItWasWritten) {
  const MeasuredTable written = table_of(ggx_brdf({0.3f, 0.2f, 0.1f}, Rgb{0.5f}, 0.4f), kSmall);
  LoadBudget budget;
  const MeasuredTable read = parse_merl(bytes_of(merl_bytes(written)), "x", budget);
  ASSERT_EQ(read.grid.size(), written.grid.size());
  for (size_t i = 0; i < read.values.size(); ++i) {
    EXPECT_FLOAT_EQ(read.values[i].r, written.values[i].r);
    EXPECT_FLOAT_EQ(read.values[i].g, written.values[i].g);
    EXPECT_FLOAT_EQ(read.values[i].b, written.values[i].b);
  }
}

TEST(MerlFile, ChannelsHaveTheDatabasesScales) {
  std::string file = header(1, 1, 1) + std::string(24, '\0');
  for (size_t i = 0; i < 3; ++i) file = with_double(file, i, 1500);
  LoadBudget budget;
  const MeasuredTable table = parse_merl(bytes_of(file), "x", budget);
  EXPECT_FLOAT_EQ(table.values[0].r, 1);
  EXPECT_FLOAT_EQ(table.values[0].g, 1.15f);
  EXPECT_FLOAT_EQ(table.values[0].b, 1.66f);
}

TEST(MerlFile, SaysWhatIsWrongAndWhatWouldDo) {
  const std::string good = merl_bytes(table_of(lambert_brdf(Rgb{0.5f}), kSmall));
  const size_t entries = kSmall.size();
  EXPECT_EQ(error_of_bytes(good), "");
  EXPECT_EQ(error_of_bytes(good.substr(0, good.size() - 1)),
            "is 23051 bytes long, 23052 are expected for the 12 x 10 x 8 entries that its header says: is it cut off?");
  EXPECT_EQ(error_of_bytes(good + '\0'),
            "is 23053 bytes long, 23052 are expected for the 12 x 10 x 8 entries that its header says");
  EXPECT_EQ(error_of_bytes(good.substr(0, 7)),
            "is 7 bytes long, expected a MERL file, which begins with 12 bytes of counts");
  EXPECT_EQ(error_of_bytes(header(90, -1, 180)),
            "its header says 90 x -1 x 180 entries, expected a MERL file's 90 x 90 x 180, or others from 1 to 1024 for "
            "each angle");
  EXPECT_TRUE(error_of_bytes(header(0, 90, 180)).starts_with("its header says 0 x 90 x 180 entries"));
  EXPECT_TRUE(error_of_bytes(header(0x7fffffff, 90, 180)).starts_with("its header says 2147483647 x"));
  EXPECT_TRUE(error_of_bytes(header(1024, 1024, 1024)).starts_with("is 12 bytes long, 25769803788 are expected"));
  EXPECT_EQ(error_of_bytes(with_double(good, entries + 5, std::numeric_limits<double>::quiet_NaN())),
            "entry 5 of green is nan, expected a number that stands for at most 1e9 1/sr; negative ones are entries "
            "that are not known");
  EXPECT_TRUE(error_of_bytes(with_double(good, 2 * entries, -std::numeric_limits<double>::infinity()))
                  .starts_with("entry 0 of blue is -inf, expected"));
  EXPECT_TRUE(error_of_bytes(with_double(good, 3, 1e300)).starts_with("entry 3 of red is 1e+300, expected"));
  std::string unknown = good;
  for (size_t i = 0; i < entries; ++i) unknown = with_double(std::move(unknown), i, -1);
  EXPECT_EQ(error_of_bytes(unknown), "has no entry that is known: each is negative in some channel");
  EXPECT_EQ(error_of_bytes(""), "is empty, expected a MERL file or comma-separated text");
}

TEST(MerlFile, KeepsToTheLimitOfMemory) {
  const std::string file = merl_bytes(table_of(lambert_brdf(Rgb{0.5f}), {30, 30, 30}));
  EXPECT_TRUE(error_of_bytes(file, {.memory = file.size() + 1000}).find("--max-memory raises the limit") !=
              std::string::npos);
  EXPECT_EQ(error_of_bytes(file, {.memory = 2 * file.size()}), "");
}

TEST(MerlFile, EndsInATableOrAnErrorWhateverItsBytes) {
  const std::string good = merl_bytes(table_of(lambert_brdf(Rgb{0.5f}), {3, 3, 4}));
  std::mt19937 random(5);
  int errors = 0;
  for (int i = 0; i < trials(2000); ++i) {
    std::string file = good.substr(0, i % 4 ? good.size() : random() % good.size());
    for (int k = 0; k < 3 && !file.empty(); ++k)
      file[random() % (k ? file.size() : std::min<size_t>(file.size(), 12))] = char(random());
    errors += !error_of_bytes(file).empty();
  }
  EXPECT_GT(errors, 0);
}

// ---- Comma-separated text ----

TEST(BrdfCsv, ReadsDegreesCommentsAndOtherSides) {
  LoadBudget budget;
  const std::string text =
      "# made up\r\n theta_i, phi_i,theta_o,phi_o,r,g,b\r\n\n30,0,-60,0,0.1,0.2,3e-1\r\n # more\n0, 0, 45, 90, 1,1,1";
  const std::vector<BrdfSample> samples = parse_brdf_csv(text, "x", budget);
  ASSERT_EQ(samples.size(), 2u);
  EXPECT_NEAR(length(samples[0].directions.s - Vec3f{0.5f, 0, 0.8660254f}), 0, 1e-6);
  EXPECT_NEAR(length(samples[0].directions.b - Vec3f{-0.8660254f, 0, 0.5f}), 0, 1e-6);
  EXPECT_EQ(samples[0].value, Rgb(0.1f, 0.2f, 0.3f));
  EXPECT_NEAR(length(samples[1].directions.b - Vec3f{0, 0.70710678f, 0.70710678f}), 0, 1e-6);
}

TEST(BrdfCsv, SaysWhichLineIsWrongAndWhatWouldDo) {
  EXPECT_EQ(error_of_bytes(kHeader + "0,0,0,0,1,1,1\n"), "");
  EXPECT_EQ(error_of_bytes("30,0,30,0,1,1,1\n"),
            "line 1: expected the header `theta_i,phi_i,theta_o,phi_o,r,g,b`, found `30,0,30,0,1,1,1`");
  EXPECT_EQ(error_of_bytes("# one\n\n" + kHeader + "0,0,0,1,1,1\n"),
            "line 4: expected 7 numbers with commas between them, found 6");
  EXPECT_EQ(error_of_bytes(kHeader + "0,0,95,0,1,1,1\n"),
            "line 2: theta_o is `95`, expected degrees above -90 and below 90");
  EXPECT_EQ(error_of_bytes(kHeader + "0,400,0,0,1,1,1\n"), "line 2: phi_i is `400`, expected degrees from -360 to 360");
  EXPECT_EQ(
      error_of_bytes(kHeader + "0,0,0,0,1,-0.1,1\n"),
      "line 2: g is `-0.1`, expected a number from 0 to 1e9, in 1/sr; leave lines out where nothing was measured");
  for (const char* wrong : {"nan", "inf", "1e10", "", "one", "1 1", "0x1", "1e999"})
    EXPECT_TRUE(error_of_bytes(kHeader + "0,0,0,0,1,1," + wrong).starts_with("line 2: b is `" + std::string(wrong)));
  EXPECT_EQ(error_of_bytes(kHeader + "# nothing\n"),
            "has no samples, expected lines of numbers under `theta_i,phi_i,theta_o,phi_o,r,g,b`");
}

TEST(BrdfCsv, EndsInATableOrAnErrorWhateverItsBytes) {
  const std::string good = kHeader + "0,0,10,20,1,1,1\n50,0,70,180,0.5,0.25,0.125\n";
  std::mt19937 random(6);
  for (int i = 0; i < trials(100); ++i) {
    std::string file = good;
    for (int k = 0; k < 2; ++k) file[file.size() - 1 - random() % 40] = char(random());
    (void)error_of_bytes(file);
  }
}

TEST(ScatteredBrdf, WhatIsTheSameEverywhereStaysSo) {
  for (const std::string& text :
       {kHeader + "20,0,70,100,0.25,0.5,0.75\n", csv_of(lambert_brdf(Rgb{0.25f, 0.5f, 0.75f} * 3.14159265f), 30)}) {
    LoadBudget budget;
    MeasuredTable table = table_through(parse_brdf_csv(text, "x", budget));
    fill_gaps(table);
    for (const Rgb& value : table.values) {
      EXPECT_NEAR(value.r, 0.25f, 1e-6f);
      EXPECT_NEAR(value.b, 0.75f, 1e-6f);
    }
  }
}

/// The root mean square difference over the BRDF's own, where both cosines are above 0.3.
double scattered_error(const Brdf& brdf) {
  LoadBudget budget;
  MeasuredTable table = table_through(parse_brdf_csv(csv_of(brdf, 10), "x", budget));
  fill_gaps(table);
  std::mt19937 random(7);
  std::uniform_real_distribution<float> cosine(0.3f, 1), turn(0, 6.2831853f);
  const auto direction = [&] {
    const float z = cosine(random), phi = turn(random), r = std::sqrt(1 - z * z);
    return Vec3f{r * std::cos(phi), r * std::sin(phi), z};
  };
  double squared = 0, all = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3f s = direction(), b = direction();
    const double found = evaluate(table, kUp, s, b).g, expected = brdf(s, b).g;
    squared += (found - expected) * (found - expected), all += expected * expected;
  }
  return std::sqrt(squared / all);
}

TEST(ScatteredBrdf, FollowsSmoothSamplesTenDegreesApart) {
  EXPECT_LE(scattered_error(ggx_brdf({0.3f, 0.2f, 0.1f}, Rgb{0.3f}, 0.6f)), 0.06);
  EXPECT_LE(scattered_error(ggx_brdf({0.3f, 0.2f, 0.1f}, Rgb{0.04f}, 0.4f)), 0.13);
  EXPECT_LE(scattered_error(ward_brdf({0.3f, 0.2f, 0.1f}, Rgb{0.3f}, 0.3f)), 0.03);
}

// ---- Scenes ----

json measured_scene(const std::vector<json>& materials) {
  json root = {{"asset", {{"version", "2.0"}}},
               {"extensionsUsed", {"ALHAZEN_shapes", "ALHAZEN_materials_measured", "KHR_lights_punctual"}}};
  root["extensions"]["ALHAZEN_shapes"]["shapes"] = {{{"sphere", {{"radius", 1}}}}};
  root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "directional"}, {"intensity", 3}}};
  root["materials"] = materials;
  root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}}};
  root["nodes"] = {
      {{"translation", {0, 0, 4}}, {"camera", 0}},
      {{"rotation", {-0.3826834, 0, 0, 0.9238795}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}};
  for (size_t i = 0; i < materials.size(); ++i)
    root["nodes"].push_back({{"extensions", {{"ALHAZEN_shapes", {{"shape", 0}, {"material", i}}}}}});
  return root;
}

json measured_material(const std::string& uri) {
  return {{"extensions", {{"ALHAZEN_materials_measured", {{"uri", uri}}}}}};
}

/// Of the only shape that is seen: the last.
ColorImage rendered(const TemporaryFolder& folder, const json& root, const Rgb& ambient) {
  Loaded loaded = load_file(folder.write("scene.gltf", root.dump()));
  Scene& scene = loaded.loaded.scene;
  scene.ambient = ambient;
  std::vector<Opacity> opacity;
  const SurfaceFilter filter = surface_filter(scene, opacity);
  const AcceleratedScene accelerated(scene.geometry, filter);
  RenderControl control;
  return render(scene, accelerated, scene.cameras.at(0), {.width = 64, .height = 48}, control).color;
}

/// The largest difference of two pictures over the largest value of the second.
float largest_difference(const ColorImage& found, const ColorImage& expected) {
  float difference = 0, largest = 0;
  for (size_t i = 0; i < expected.pixels.size(); ++i) {
    difference = std::max(difference, std::abs(found.pixels[i] - expected.pixels[i]));
    if (i % 4 != 3) largest = std::max(largest, expected.pixels[i]);
  }
  EXPECT_GT(largest, 0);
  return difference / largest;
}

json gltf_material(const Rgb& diffuse, const Rgb& f0, float roughness, bool dielectric = true) {
  return {{"pbrMetallicRoughness",
           {{"baseColorFactor", {diffuse.r, diffuse.g, diffuse.b, 1}},
            {"metallicFactor", 0},
            {"roughnessFactor", roughness}}},
          {"extensions",
           {{"KHR_materials_ior", {{"ior", 0}}},
            {"KHR_materials_specular",
             {{"specularFactor", dielectric ? 1 : 0}, {"specularColorFactor", {f0.r, f0.g, f0.b}}}}}}};
}

TEST(MeasuredMaterial, OfLambertLooksLikeADiffuseSurface) {
  const TemporaryFolder folder;
  const Rgb color{0.7f, 0.4f, 0.2f};
  folder.write("paint.binary", merl_bytes(table_of(lambert_brdf(color), {20, 20, 20})));
  const json diffuse = gltf_material(color, Rgb{0}, 1, false);
  for (const Rgb& ambient : {Rgb{0}, Rgb{0.5f, 0.25f, 1}})
    EXPECT_LE(largest_difference(rendered(folder, measured_scene({measured_material("paint.binary")}), ambient),
                                 rendered(folder, measured_scene({diffuse}), ambient)),
              1e-5f);
}

TEST(MeasuredMaterial, OfGgxLooksLikeThatModel) {
  const TemporaryFolder folder;
  const Rgb color{0.3f, 0.2f, 0.1f}, f0{0.3f, 0.4f, 0.5f};
  folder.write("paint.binary", merl_bytes(table_of(ggx_brdf(color, f0, 0.5f))));
  EXPECT_LE(largest_difference(rendered(folder, measured_scene({measured_material("paint.binary")}), Rgb{0}),
                               rendered(folder, measured_scene({gltf_material(color, f0, 0.5f)}), Rgb{0})),
            0.005f);
}

TEST(MeasuredMaterial, ScaleMultipliesTheLight) {
  const TemporaryFolder folder;
  folder.write("paint.csv", kHeader + "20,0,20,180,0.1,0.2,0.3\n");
  json doubled = measured_material("paint.csv");
  doubled["extensions"]["ALHAZEN_materials_measured"]["scale"] = 2;
  ColorImage once = rendered(folder, measured_scene({measured_material("paint.csv")}), Rgb{1});
  for (size_t i = 0; i < once.pixels.size(); ++i) once.pixels[i] *= i % 4 == 3 ? 1.0f : 2.0f;
  EXPECT_LE(largest_difference(rendered(folder, measured_scene({doubled}), Rgb{1}), once), 1e-6f);
}

TEST(MeasuredMaterial, MaterialsOfOneFileShareOneTable) {
  const TemporaryFolder folder;
  folder.write("a.csv", kHeader + "20,0,20,180,0.1,0.2,0.3\n");
  folder.write("b.csv", kHeader + "20,0,20,180,0.5,0.5,0.5\n");
  const json root =
      measured_scene({measured_material("a.csv"), measured_material("b.csv"), measured_material("a.csv")});
  const Loaded loaded = load_file(folder.write("scene.gltf", root.dump()));
  const Scene& scene = loaded.scene();
  ASSERT_EQ(scene.measured.size(), 2u);
  EXPECT_EQ(scene.materials[0].model, ShadingModel::measured);
  EXPECT_EQ(scene.materials[0].measured.brdf, 0u);
  EXPECT_EQ(scene.materials[1].measured.brdf, 1u);
  EXPECT_EQ(scene.materials[2].measured.brdf, 0u);
  EXPECT_EQ(scene.measured[0].name, "a.csv");
  EXPECT_NEAR(scene.measured[1].table.values[0].r, 0.5f, 1e-6f);
}

TEST(MeasuredMaterial, TakesDataUrisToo) {
  const std::string text = kHeader + "20,0,20,180,0.1,0.2,0.3\n";
  EXPECT_EQ(
      load_json(measured_scene({measured_material("data:text/csv;base64," + base64(text))})).scene().measured.size(),
      1u);
}

/// The loader's complaint about a scene whose material names that file.
std::string error_of_uri(const TemporaryFolder& folder, const json& uri) {
  json material = measured_material("");
  material["extensions"]["ALHAZEN_materials_measured"]["uri"] = uri;
  return error_of_file(folder.write("scene/scene.gltf", measured_scene({material}).dump()));
}

TEST(MeasuredMaterial, StaysInTheScenesFolderAndSaysWhatIsWrong) {
  const std::string at = "/materials/0/extensions/ALHAZEN_materials_measured";
  const TemporaryFolder folder;
  const fs::path outside = folder.write("secret.csv", kHeader + "0,0,0,0,1,1,1\n");
  folder.write("scene/bad.csv", kHeader + "0,0,0,0,1,1,red\n");
  fs::create_directories(folder / "scene/folder.csv");
  fs::create_symlink(outside, folder / "scene/link.csv");
  EXPECT_EQ(error_of_uri(folder, "link.csv"), at + "/uri: `link.csv` lies outside the scene's folder");
  EXPECT_EQ(error_of_uri(folder, "../secret.csv"), at + "/uri: `../secret.csv` lies outside the scene's folder");
  EXPECT_EQ(error_of_uri(folder, outside.string()).substr(0, at.size() + 60),
            (at + "/uri: expected a path relative to the scene's folder, found \"/").substr(0, at.size() + 60));
  for (const std::string name : {"folder.csv", "absent.csv", "http://example.com/x.csv"})
    EXPECT_EQ(error_of_uri(folder, name),
              at + "/uri: cannot read `" + name + "`, expected a file in the scene's folder");
  EXPECT_TRUE(error_of_uri(folder, "bad.csv").starts_with(at + "/uri: bad.csv: line 2: b is `red`, expected a number"));
  EXPECT_EQ(error_of_uri(folder, 5), at + "/uri: expected a string, found 5");
  json material = {{"extensions", {{"ALHAZEN_materials_measured", json::object()}}}};
  EXPECT_EQ(error_of(measured_scene({material})), at + ": `uri` is missing");
  material["extensions"]["ALHAZEN_materials_measured"] = {{"uri", "x"}, {"scale", -1}};
  EXPECT_EQ(error_of(measured_scene({material})), at + "/scale: expected a finite number >= 0, found -1");
  material["extensions"]["ALHAZEN_materials_measured"] = {{"uri", "x"}, {"url", "x"}};
  EXPECT_EQ(error_of(measured_scene({material})), at + "/url: unknown key, expected one of uri, scale");
}

}  // namespace
}  // namespace alhazen
