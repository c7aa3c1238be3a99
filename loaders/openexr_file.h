// OpenEXR files, encoded by OpenEXR itself.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "loaders/image_file.h"

namespace alhazen {

enum class ExrType : uint8_t { half, float32, uint32 };  // half: stored so; floats in memory

/// One channel as it lies in memory: floats, or integers for `uint32`.
struct ExrChannel {
  std::string name;
  ExrType type;
  const void* values;
  size_t stride;  // values from pixel to pixel
};

struct ExrPart {
  std::string name;  // where there are several
  std::vector<ExrChannel> channels;
  std::string compression;  // one of `kExrCompressions`
  Metadata metadata{};
};

/// The first is what is taken where nothing is chosen.
inline constexpr const char* kExrCompressions[] = {"zip",   "none", "rle",  "zips", "piz",
                                                   "pxr24", "b44",  "b44a", "dwaa", "dwab"};

/// The bytes of a file with these parts, all of one size. Halves are clamped, brighter floats would become infinite.
/// Throws std::exception with OpenEXR's reason.
[[nodiscard]] std::vector<uint8_t> encoded_exr(int width, int height, std::span<const ExrPart> parts);

/// Of the library.
[[nodiscard]] const char* openexr_version();

}  // namespace alhazen
