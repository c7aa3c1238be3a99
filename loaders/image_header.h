// What an image says of itself in its first bytes, before a decoder believes it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace alhazen {

enum class ImageKind : uint8_t { png, jpeg, webp, openexr, hdr, bmp, dds, ktx2 };

/// OpenImageIO's name of the kind, where it reads it.
[[nodiscard]] std::string_view name_of(ImageKind kind);

/// By the first bytes, whatever the file is called; none: no image that is read here.
[[nodiscard]] std::optional<ImageKind> image_kind(std::span<const uint8_t> file);

struct ImageHeader {
  uint64_t width = 0, height = 0;  // below 2^32, so that pixels can be counted
  uint64_t bytes_per_pixel = 0;    // once decoded, at most
  uint64_t scratch = 0;            // bytes that the decoder takes besides, at most

  [[nodiscard]] uint64_t pixels() const { return width * height; }
};

/// None: the header is cut off or makes no sense.
[[nodiscard]] std::optional<ImageHeader> read_image_header(ImageKind kind, std::span<const uint8_t> file);

}  // namespace alhazen
