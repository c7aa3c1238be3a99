// What the parts of the library of images share: see loaders/image_library.h.
#pragma once

#include <OpenImageIO/typedesc.h>

#include "loaders/image_library.h"

namespace alhazen::oiio {

[[nodiscard]] OIIO::TypeDesc type_of(SampleType type);

std::unique_ptr<ImageReader> open_file(const std::string& path);
std::unique_ptr<ImageReader> open_memory(const std::string& format, std::span<const uint8_t> bytes);
std::optional<ImageWriterFormat> writer_format(const std::string& extension);
void write(const std::string& path, const StoredPicture& picture, std::vector<uint8_t>* bytes);
std::unique_ptr<DisplayProcessor> display_processor(const DisplayView& wanted);
bool draw_text(ColorImage& image, int x, int y, const std::string& text, int height, const Rgb& color);
int text_width(const std::string& text, int height);

}  // namespace alhazen::oiio
