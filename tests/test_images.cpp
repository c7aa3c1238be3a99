// Claims about whole pictures as the program writes them: analytic answers first, then references, one test for each
// scene of a folder. docs/testing.md says how to add a scene and how to renew a reference.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <sstream>

#include "loaders/image_file.h"

namespace alhazen {
namespace {

namespace fs = std::filesystem;

const fs::path kScenes = ALHAZEN_TEST_IMAGES, kExamples = ALHAZEN_EXAMPLES, kOutput = "image-tests";
constexpr int kWidth = 96, kHeight = 72;  // of new references
constexpr size_t kListedPixels = 20;

// ---- the program, and pictures read again

std::string quoted(const fs::path& path) { return "'" + path.string() + "'"; }

/// Whether the program renders the scene to `picture`.
[[nodiscard]] bool rendered(const fs::path& scene, const fs::path& picture, int width, int height,
                            const std::string& options) {
  fs::create_directories(picture.parent_path());
  const std::string command = quoted(ALHAZEN_PROGRAM) + " render " + quoted(scene) + " -o " + quoted(picture) +
                              " --size " + std::to_string(width) + "x" + std::to_string(height) + " --quiet " + options;
  return std::system(command.c_str()) == 0;
}

template <class T>
PixelBuffer<T> read_picture(const fs::path& file) {
  const auto in = OIIO::ImageInput::open(file.string());
  if (!in) throw std::runtime_error(file.string() + ": " + OIIO::geterror());
  const OIIO::ImageSpec& spec = in->spec();
  PixelBuffer<T> picture{spec.width, spec.height, spec.channelnames, {}};
  picture.pixels.resize(size_t(spec.width) * size_t(spec.height) * size_t(spec.nchannels));
  if (!in->read_image(0, 0, 0, spec.nchannels, OIIO::BaseTypeFromC<T>::value, picture.pixels.data()))
    throw std::runtime_error(file.string() + ": " + in->geterror());
  return picture;
}

template <class T>
size_t channel(const PixelBuffer<T>& picture, const std::string& name) {
  const auto found = std::find(picture.channels.begin(), picture.channels.end(), name);
  if (found == picture.channels.end()) throw std::runtime_error("the picture has no channel " + name);
  return size_t(found - picture.channels.begin());
}

// ---- comparing

struct Pixel {
  int x, y;
};

/// How much of a picture has to agree, and how well.
struct Tolerance {
  double relative, absolute;  // of a number, the larger counts
  double differing;           // share of the pixels compared
};
// The references are rounded to 11 bits. A pixel in a thousand may see the other side of an edge.
constexpr Tolerance kOwnColors{0.001 + 0x1p-11, 1e-4, 0.001}, kOwnIds{0, 0, 0.001};
// As their description says.
constexpr Tolerance kExampleColors{0.001, 1e-4, 0.001}, kExampleIds{0, 0, 0};

bool agree(double found, double expected, const Tolerance& tolerance) {
  return std::abs(found - expected) <= std::max(tolerance.relative * std::abs(expected), tolerance.absolute);
}

/// Which pixels to compare in a channel.
using Mask = std::function<bool(const std::string& channel, Pixel)>;

template <class T>
struct Comparison {
  const PixelBuffer<T>&found, &expected;
  size_t compared = 0;
  std::vector<Pixel> different;

  [[nodiscard]] std::string values(const PixelBuffer<T>& picture, Pixel p) const {
    std::ostringstream text;
    for (const std::string& name : expected.channels) text << ' ' << picture.at(p.x, p.y)[channel(picture, name)];
    return text.str();
  }
  [[nodiscard]] std::string listing() const {
    std::ostringstream text;
    text << different.size() << " of " << compared << " pixels differ";
    for (size_t i = 0; i < std::min(different.size(), kListedPixels); ++i)
      text << "\n  (" << different[i].x << ", " << different[i].y << "): found" << values(found, different[i])
           << ", expected" << values(expected, different[i]);
    return text.str();
  }
};

/// All channels of `expected`; both of the same size.
template <class T>
Comparison<T> compare(const PixelBuffer<T>& found, const PixelBuffer<T>& expected, const Tolerance& tolerance,
                      const Mask& mask) {
  Comparison<T> result{found, expected, 0, {}};
  for (int y = 0; y < expected.height; ++y)
    for (int x = 0; x < expected.width; ++x) {
      bool compared = false, same = true;
      for (size_t c = 0; c < expected.channels.size(); ++c) {
        const std::string& name = expected.channels[c];
        if (!mask(name, {x, y})) continue;
        compared = true;
        same = same && agree(double(found.at(x, y)[channel(found, name)]), double(expected.at(x, y)[c]), tolerance);
      }
      result.compared += compared;
      if (!same) result.different.push_back({x, y});
    }
  return result;
}

/// The absolute difference, ten times as bright.
ColorImage difference_picture(const Comparison<float>& comparison) {
  ColorImage picture{comparison.expected.width, comparison.expected.height, {"R", "G", "B", "A"}, {}};
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      for (const char* name : {"R", "G", "B"})
        picture.pixels.push_back(10 * std::abs(comparison.found.at(x, y)[channel(comparison.found, name)] -
                                               comparison.expected.at(x, y)[channel(comparison.expected, name)]));
      picture.pixels.push_back(1);
    }
  return picture;
}

/// White where something differs.
ColorImage difference_picture(const Comparison<uint32_t>& comparison) {
  ColorImage picture{comparison.expected.width, comparison.expected.height, {"R", "G", "B", "A"}, {}};
  picture.pixels.assign(size_t(picture.width) * size_t(picture.height) * 4, 0);
  for (const Pixel& p : comparison.different) std::fill_n(picture.at(p.x, p.y), 4, 1.0f);
  return picture;
}

// ---- references

struct Reference {
  fs::path scene, picture;

  [[nodiscard]] bool is_signature() const { return picture.stem().string().ends_with("-signature"); }
  /// Colours: what NAME.options beside the scene says, where there is one.
  [[nodiscard]] std::string options() const {
    if (is_signature()) return "--integrator signature";
    std::string line;
    std::ifstream in(fs::path(scene).replace_extension(".options"));
    std::getline(in, line);
    return line;
  }
};

void PrintTo(const Reference& reference, std::ostream* out) { *out << reference.picture; }

/// Two for each scene of the folder: NAME.exr and NAME-signature.exr.
std::vector<Reference> references(const fs::path& folder) {
  std::vector<Reference> all;
  if (!fs::is_directory(folder)) return all;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".gltf") continue;
    const fs::path stem = fs::path(entry.path()).replace_extension();
    all.push_back({entry.path(), stem.string() + ".exr"});
    all.push_back({entry.path(), stem.string() + "-signature.exr"});
  }
  std::sort(all.begin(), all.end(), [](const Reference& a, const Reference& b) { return a.picture < b.picture; });
  return all;
}

/// A name as GoogleTest takes it.
std::string test_name(const ::testing::TestParamInfo<Reference>& info) {
  std::string name = info.param.picture.stem().string();
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
  return name;
}

/// Leaves what helps to see the failure, and says where.
template <class T>
std::string evidence(const Comparison<T>& comparison, const Reference& reference, const fs::path& picture) {
  const fs::path stem = fs::path(picture).replace_extension();
  const fs::path expected = stem.string() + "-reference.exr", difference = stem.string() + "-difference.png";
  fs::copy_file(reference.picture, expected, fs::copy_options::overwrite_existing);
  write_image(difference, difference_picture(comparison), {}, {});
  return comparison.listing() + "\nfound       " + fs::absolute(picture).string() + "\nexpected    " +
         fs::absolute(expected).string() + "\ndifference  " + fs::absolute(difference).string();
}

template <class T>
void expect_like(const Reference& reference, const fs::path& folder, const Tolerance& tolerance, const Mask& mask) {
  const auto expected = read_picture<T>(reference.picture);
  const fs::path picture = kOutput / folder / reference.picture.filename();
  ASSERT_TRUE(rendered(reference.scene, picture, expected.width, expected.height, reference.options()));
  const auto found = read_picture<T>(picture);
  const Comparison<T> comparison = compare(found, expected, tolerance, mask);
  if (!comparison.different.empty()) std::printf("%s\n", comparison.listing().c_str());
  EXPECT_GT(comparison.compared, 0u);
  EXPECT_LE(double(comparison.different.size()), tolerance.differing * double(comparison.compared))
      << evidence(comparison, reference, picture);
}

class SceneOfOurOwn : public ::testing::TestWithParam<Reference> {};

TEST_P(SceneOfOurOwn, LooksLikeItsReference) {
  const Reference& reference = GetParam();
  if (std::getenv("ALHAZEN_RENEW_REFERENCES")) {
    ASSERT_TRUE(rendered(reference.scene, reference.picture, kWidth, kHeight,
                         reference.options() + (reference.is_signature() ? "" : " --half")));
    GTEST_SKIP() << "renewed " << reference.picture;
  }
  ASSERT_TRUE(fs::exists(reference.picture)) << "docs/testing.md says how to make it";
  const Mask everything = [](const std::string& name, Pixel) { return name != "A"; };
  if (reference.is_signature())
    expect_like<uint32_t>(reference, "own", kOwnIds, everything);
  else
    expect_like<float>(reference, "own", kOwnColors, everything);
}

INSTANTIATE_TEST_SUITE_P(Images, SceneOfOurOwn, ::testing::ValuesIn(references(kScenes)), test_name);

// ---- scenes beside the project, computed by another renderer

/// Red says where to compare the colours, green `node` and `material`, blue `primitive`.
Mask fair_comparison(const PixelBuffer<uint8_t>& robust) {
  return [&](const std::string& name, Pixel p) {
    const size_t c = name == "primitive" ? 2 : name == "node" || name == "material" ? 1 : 0;
    return robust.at(p.x, p.y)[c] != 0;
  };
}

class Example : public ::testing::TestWithParam<Reference> {};

TEST_P(Example, AgreesWithAnotherRenderer) {
  const Reference& reference = GetParam();
  const auto robust = read_picture<uint8_t>(fs::path(reference.scene).replace_extension().string() + "-robust.png");
  if (reference.is_signature())
    expect_like<uint32_t>(reference, "examples", kExampleIds, fair_comparison(robust));
  else
    expect_like<float>(reference, "examples", kExampleColors, fair_comparison(robust));
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Example);
INSTANTIATE_TEST_SUITE_P(Images, Example, ::testing::ValuesIn(references(kExamples)), test_name);

TEST(Example, LiesBesideTheProject) {
  if (!fs::is_directory(kExamples)) GTEST_SKIP() << "there is no " << kExamples;
  EXPECT_FALSE(references(kExamples).empty());
}

// ---- analytic answers

constexpr double kAlbedo = 0.6, kIntensity = 5, kRadius = 2;

/// A sphere seen from inside, a point light in its centre.
std::string lit_from_its_centre(const std::string& material, double camera_x) {
  std::ostringstream text;
  text << R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0, 1, 2]}], "nodes": [
    {"camera": 0, "translation": [)"
       << camera_x << R"(, 0.25, -0.5]},
    {"translation": [0, 0.25, -0.5], "extensions": {"KHR_lights_punctual": {"light": 0}}},
    {"translation": [0, 0.25, -0.5], "extensions": {"ALHAZEN_shapes": {"shape": 0, "material": 0}}}],
    "cameras": [{"type": "perspective", "perspective": {"yfov": 2, "znear": 0.1}}],
    "materials": [)"
       << material << R"(],
    "extensionsUsed": ["KHR_lights_punctual", "ALHAZEN_shapes", "ALHAZEN_materials_phong", "KHR_materials_specular"],
    "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": )"
       << kIntensity << R"(}]},
                   "ALHAZEN_shapes": {"shapes": [{"sphere": {"radius": )"
       << kRadius << "}}]}}}";
  return text.str();
}

void expect_everywhere(const std::string& name, const std::string& scene, double expected) {
  const fs::path file = kOutput / "analytic" / (name + ".gltf"), picture = fs::path(file).replace_extension(".exr");
  fs::create_directories(file.parent_path());
  std::ofstream(file) << scene;
  ASSERT_TRUE(rendered(file, picture, 64, 48, ""));
  const auto found = read_picture<float>(picture);
  for (int y = 0; y < found.height; ++y)
    for (int x = 0; x < found.width; ++x)
      for (size_t c = 0; c < 3; ++c) ASSERT_NEAR(double(found.at(x, y)[c]), expected, 1e-5 * expected) << x << " " << y;
}

TEST(SphereLitFromItsCentre, ShowsAlbedoTimesIrradianceOverPi) {
  const std::string material = R"({"pbrMetallicRoughness":
    {"baseColorFactor": [0.6, 0.6, 0.6, 1], "metallicFactor": 0, "roughnessFactor": 1},
    "extensions": {"KHR_materials_specular": {"specularFactor": 0}}})";
  expect_everywhere("diffuse", lit_from_its_centre(material, 1.25),
                    kAlbedo * kIntensity / (std::numbers::pi * kRadius * kRadius));
}

TEST(SphereLitFromItsCentre, ShowsFresnelsShareOfARoughSurfaceSeenFromThereToo) {
  // Light and view are along the normal: F = 0.04, and GGX of roughness 1 is D V = 1/pi x 1/4.
  const std::string material = R"({"pbrMetallicRoughness":
    {"baseColorFactor": [0.6, 0.6, 0.6, 1], "metallicFactor": 0, "roughnessFactor": 1}})";
  const double f = 0.04, brdf = ((1 - f) * kAlbedo + f / 4) / std::numbers::pi;
  expect_everywhere("rough", lit_from_its_centre(material, 0), brdf * kIntensity / (kRadius * kRadius));
}

TEST(SphereLitFromItsCentre, ShowsPhongsDiffuseTermWithoutPi) {
  const std::string material = R"({"extensions": {"ALHAZEN_materials_phong": {"diffuseFactor": [0.6, 0.6, 0.6]}}})";
  expect_everywhere("phong", lit_from_its_centre(material, -1.25), kAlbedo * kIntensity / (kRadius * kRadius));
}

}  // namespace
}  // namespace alhazen
