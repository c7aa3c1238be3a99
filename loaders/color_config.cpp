#include "loaders/color_config.h"

#include <OpenImageIO/color.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

#include "core/error.h"
#include "materials/texture.h"

namespace alhazen {
namespace {

// What configurations call scene-linear light with Rec. 709 primaries, the commonest first.
constexpr const char* kLinearNames[] = {"lin_rec709",
                                        "Linear Rec.709 (sRGB)",
                                        "Utility - Linear - Rec.709",
                                        "Utility - Linear - sRGB",
                                        "lin_srgb",
                                        "Linear Rec.709",
                                        "Linear sRGB",
                                        "lin_rec709_srgb"};

template <class Name>
std::vector<std::string> names(int count, const Name& name) {
  std::vector<std::string> all;
  for (int i = 0; i < count; ++i) all.emplace_back(name(i));
  return all;
}

std::string joined(const std::vector<std::string>& all) {
  std::string text;
  for (const std::string& name : all) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// `name`, or the default where it is empty; one of `known`.
std::string chosen(const char* option, const std::string& name, const char* otherwise,
                   const std::vector<std::string>& known) {
  if (name.empty() && otherwise) return otherwise;
  if (std::find(known.begin(), known.end(), name) != known.end()) return name;
  throw UsageError(std::string(option) + ": unknown '" + name + "', the configuration has " + joined(known));
}

std::string linear_space(const OIIO::ColorConfig& config, const std::string& file) {
  const std::vector<std::string> known = config.getColorSpaceNames();
  for (const char* name : kLinearNames)
    if (std::find(known.begin(), known.end(), name) != known.end()) return name;
  if (const char* role = config.getColorSpaceNameByRole("scene_linear")) return role;
  throw LoadError(file, "",
                  "has neither a colour space lin_rec709 (or of another usual name for linear light with Rec. 709 "
                  "primaries) nor a role scene_linear, it has " +
                      joined(known));
}

}  // namespace

struct DisplayTransform::Impl {
  OIIO::ColorProcessorHandle processor;
};

DisplayTransform::DisplayTransform(const DisplayView& wanted) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(wanted.config, ignored))
    throw LoadError(wanted.config, "", "there is no such file");
  OIIO::ColorConfig config(wanted.config);
  if (config.has_error()) throw LoadError(wanted.config, "", "no configuration that can be read: " + config.geterror());
  const std::string display =
      chosen("--display", wanted.display, config.getDefaultDisplayName(),
             names(config.getNumDisplays(), [&](int i) { return config.getDisplayNameByIndex(i); }));
  const std::string view =
      chosen("--view", wanted.view, config.getDefaultViewName(display),
             names(config.getNumViews(display), [&](int i) { return config.getViewNameByIndex(display, i); }));
  auto processor = config.createDisplayTransform(display, view, linear_space(config, wanted.config));
  if (!processor)
    throw LoadError(wanted.config, "", "cannot show '" + view + "' of '" + display + "': " + config.geterror());
  impl_ = std::make_unique<const Impl>(Impl{std::move(processor)});
}

DisplayTransform::~DisplayTransform() = default;

void DisplayTransform::apply(ColorImage& image) const {
  const auto for_each_straight = [&](const auto& change) {
    for (size_t i = 0; i + 3 < image.pixels.size(); i += 4)
      if (image.pixels[i + 3] > 0) change(&image.pixels[i], image.pixels[i + 3]);
  };
  for_each_straight([](float* p, float alpha) {
    for (int k = 0; k < 3; ++k) p[k] /= alpha;
  });
  constexpr OIIO::stride_t kChannel = sizeof(float), kPixel = 4 * sizeof(float);
  impl_->processor->apply(image.pixels.data(), image.width, image.height, 3, kChannel, kPixel, kPixel * image.width);
  for_each_straight([](float* p, float alpha) {
    for (int k = 0; k < 3; ++k) p[k] = alpha * linear_from_srgb(p[k] > 0 ? std::min(p[k], 1.0f) : 0.0f);
  });
}

}  // namespace alhazen
