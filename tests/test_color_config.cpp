// Views of displays that an OpenColorIO configuration defines.
#include "loaders/color_config.h"

#include <gtest/gtest.h>

#include <cmath>

#include "gltf_builder.h"
#include "materials/texture.h"

namespace alhazen {
namespace {

constexpr const char* kConfig = R"(ocio_profile_version: 1
search_path: ""
roles:
  default: %LINEAR%
  scene_linear: %LINEAR%
displays:
  Screen:
    - !<View> {name: Halved, colorspace: halved}
    - !<View> {name: Root, colorspace: root}
  Wall:
    - !<View> {name: Swapped, colorspace: swapped}
colorspaces:
  - !<ColorSpace>
    name: %LINEAR%
  - !<ColorSpace>
    name: halved
    from_reference: !<MatrixTransform> {matrix: [0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1]}
  - !<ColorSpace>
    name: root
    from_reference: !<ExponentTransform> {value: [0.5, 0.5, 0.5, 1]}
  - !<ColorSpace>
    name: swapped
    from_reference: !<MatrixTransform> {matrix: [0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}
)";

std::string config(const std::string& linear) {
  std::string text = kConfig;
  for (size_t at; (at = text.find("%LINEAR%")) != std::string::npos;) text.replace(at, 8, linear);
  return text;
}

class ColorConfig : public testing::Test {
 protected:
  DisplayView view(const std::string& display, const std::string& name) const {
    return {file_.string(), display, name};
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.write("config.ocio", config("lin_rec709"));
};

/// What the display gets of a colour.
Rgb shown(const DisplayView& view, const Rgb& color, float alpha = 1) {
  ColorImage image{1, 1, {"R", "G", "B", "A"}, {color.r * alpha, color.g * alpha, color.b * alpha, alpha}};
  DisplayTransform(view).apply(image);
  EXPECT_EQ(image.pixels[3], alpha);
  const auto encoded = [&](size_t k) { return srgb_from_linear(image.pixels[k] / alpha); };
  return {encoded(0), encoded(1), encoded(2)};
}

void expect_color(const Rgb& found, const Rgb& expected) {
  EXPECT_NEAR(found.r, expected.r, 2e-3f);
  EXPECT_NEAR(found.g, expected.g, 2e-3f);
  EXPECT_NEAR(found.b, expected.b, 2e-3f);
}

TEST_F(ColorConfig, TheDisplayGetsWhatTheViewSays) {
  expect_color(shown(view("Screen", "Halved"), {0.2f, 0.8f, 4}), {0.1f, 0.4f, 1});
  expect_color(shown(view("Screen", "Root"), {0.25f, 0.81f, 0}), {0.5f, 0.9f, 0});
  expect_color(shown(view("Wall", "Swapped"), {0.25f, 0.5f, 1}), {0.5f, 0.25f, 1});
}

TEST_F(ColorConfig, StraightColoursAreTransformed) {
  expect_color(shown(view("Screen", "Root"), {0.25f, 0.81f, 0}, 0.3f), {0.5f, 0.9f, 0});
}

TEST_F(ColorConfig, DefaultsAreTheConfigurations) {
  expect_color(shown(view("", ""), {0.2f, 0.8f, 4}), {0.1f, 0.4f, 1});
  expect_color(shown(view("Wall", ""), {0.25f, 0.5f, 1}), {0.5f, 0.25f, 1});
}

TEST_F(ColorConfig, TheRoleSceneLinearStandsInForTheUsualNames) {
  const auto other = folder_.write("other.ocio", config("house_linear"));
  expect_color(shown({other.string(), "Wall", "Swapped"}, {0.25f, 0.5f, 1}), {0.5f, 0.25f, 1});
}

template <class Error>
std::string error_of(const DisplayView& view) {
  try {
    DisplayTransform transform(view);
    return {};
  } catch (const Error& error) {
    return error.what();
  }
}

TEST_F(ColorConfig, SaysWhatThereIs) {
  EXPECT_EQ(error_of<UsageError>(view("Scren", "Root")),
            "--display: unknown 'Scren', the configuration has Screen, Wall");
  EXPECT_EQ(error_of<UsageError>(view("Screen", "Swapped")),
            "--view: unknown 'Swapped', the configuration has Halved, Root");
  const std::string absent = (folder_ / "absent.ocio").string();
  EXPECT_EQ(error_of<LoadError>({absent, "", ""}), absent + ": there is no such file");
  const auto broken = folder_.write("broken.ocio", "roles: [");
  EXPECT_NE(error_of<LoadError>({broken.string(), "", ""}), "");
}

}  // namespace
}  // namespace alhazen
