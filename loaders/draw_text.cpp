#include "loaders/draw_text.h"

#include "loaders/image_library.h"

namespace alhazen {

bool draw_text(ColorImage& image, int x, int y, const std::string& text, int height, const Rgb& color) {
  return image_library().draw_text(image, x, y, text, height, color);
}

int text_width(const std::string& text, int height) { return image_library().text_width(text, height); }

}  // namespace alhazen
