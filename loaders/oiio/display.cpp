#include <OpenImageIO/color.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

#include "core/error.h"
#include "loaders/color_config.h"
#include "loaders/oiio/open_image_io.h"

namespace alhazen::oiio {
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

class Processor : public DisplayProcessor {
 public:
  explicit Processor(OIIO::ColorProcessorHandle processor) : processor_(std::move(processor)) {}

  void apply(float* pixels, int width, int height) const override {
    constexpr OIIO::stride_t kChannel = sizeof(float), kPixel = 4 * sizeof(float);
    processor_->apply(pixels, width, height, 3, kChannel, kPixel, kPixel * width);
  }

 private:
  OIIO::ColorProcessorHandle processor_;
};

}  // namespace

std::unique_ptr<DisplayProcessor> display_processor(const DisplayView& wanted) {
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
  return std::make_unique<Processor>(std::move(processor));
}

}  // namespace alhazen::oiio
