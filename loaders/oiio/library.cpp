#include "loaders/oiio/open_image_io.h"

extern "C" __attribute__((visibility("default"))) const alhazen::ImageLibrary* alhazen_image_library() {
  using namespace alhazen::oiio;
  static constexpr alhazen::ImageLibrary table{open_file,         open_memory, writer_format, write,
                                               display_processor, draw_text,   text_width};
  return &table;
}
