// Views of displays that an OpenColorIO configuration defines.
#pragma once

#include <memory>
#include <string>

#include "core/image.h"

namespace alhazen {

class DisplayProcessor;

struct DisplayView {
  std::string config;         // file; empty: none is wanted
  std::string display, view;  // empty: the configuration's default
};

/// From scene-linear light with Rec. 709 primaries to the encoded colours of a display. The configuration's colour
/// space of that light is found by the usual names, else it is its role scene_linear.
class DisplayTransform {
 public:
  /// Throws LoadError for a configuration that cannot be read, or that has no such colour space; UsageError, which
  /// lists those there are, for an unknown display or view.
  explicit DisplayTransform(const DisplayView& wanted);
  ~DisplayTransform();

  /// Of R, G, B, A: straight colours are transformed. What a display shows of them in 8 bits is clamped to [0, 1]; the
  /// numbers left are those whose sRGB encoding the display gets, as for `ViewTransform`.
  void apply(ColorImage& image) const;

 private:
  std::unique_ptr<const DisplayProcessor> processor_;
};

/// Throws what DisplayTransform would.
inline void check_display_view(const DisplayView& wanted) { (void)DisplayTransform(wanted); }

}  // namespace alhazen
