#include "loaders/draw_text.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

namespace alhazen {

bool draw_text(ColorImage& image, int x, int y, const std::string& text, int height, const Rgb& color) {
  const int channels = int(image.channels.size());
  OIIO::ImageBuf pixels(OIIO::ImageSpec(image.width, image.height, channels, OIIO::TypeDesc::FLOAT),
                        image.pixels.data());
  const float ink[4] = {color.r, color.g, color.b, 1};
  const OIIO::cspan<float> used(ink, channels);
  for (const char* font : {"DejaVuSans", "LiberationSans-Regular", "NotoSans-Regular", ""})
    if (OIIO::ImageBufAlgo::render_text(pixels, x, y, text, height, font, used)) return true;
  (void)pixels.geterror();
  return false;
}

}  // namespace alhazen
