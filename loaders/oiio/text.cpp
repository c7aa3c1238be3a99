#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include "loaders/oiio/open_image_io.h"

namespace alhazen::oiio {
namespace {

constexpr const char* kFonts[] = {"DejaVuSans", "LiberationSans-Regular", "NotoSans-Regular", ""};

}  // namespace

bool draw_text(ColorImage& image, int x, int y, const std::string& text, int height, const Rgb& color) {
  const int channels = int(image.channels.size());
  OIIO::ImageBuf pixels(OIIO::ImageSpec(image.width, image.height, channels, OIIO::TypeDesc::FLOAT),
                        image.pixels.data());
  const float ink[4] = {color.r, color.g, color.b, 1};
  const OIIO::cspan<float> used(ink, channels);
  for (const char* font : kFonts)
    if (OIIO::ImageBufAlgo::render_text(pixels, x, y, text, height, font, used)) return true;
  (void)pixels.geterror();
  return false;
}

int text_width(const std::string& text, int height) {
  for (const char* font : kFonts)
    if (const OIIO::ROI size = OIIO::ImageBufAlgo::text_size(text, height, font); size.defined()) return size.xend;
  return 0;
}

}  // namespace alhazen::oiio
