// Pictures to files, in the format that the file's name asks for.
#pragma once

#include <array>
#include <filesystem>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/image.h"

namespace alhazen {

/// How a format stores a picture.
struct ImageFormat {
  std::string name;                                    // "openexr", "png", "jpeg", "tiff", ...
  bool linear = false;                                 // scene-linear floats; otherwise 8 bits, sRGB, clamped to [0, 1]
  bool alpha = false;                                  // keeps alpha
  bool premultiplied = false;                          // stores colour times alpha
  bool half = false;                                   // may store 16-bit floats
  bool quality = false;                                // lossy, as good as is asked
  int largest_side = std::numeric_limits<int>::max();  // pixels
  std::vector<std::string> compressions;               // the first is the default; empty: nothing to choose
};

/// By the file's extension. Throws WriteError for one that is unknown.
[[nodiscard]] ImageFormat image_format(const std::filesystem::path& file);

/// What may be chosen about a format.
struct ImageEncoding {
  bool half = false;
  std::string compression = {};  // empty: the format's default
  int quality = 0;               // 1 to 100; 0: 95
};

/// Throws UsageError for a choice that the file's format does not have.
void check_encoding(const std::filesystem::path& file, const ImageEncoding& encoding);

/// Finds out before the work is done whether a picture of this size can be written: throws WriteError for an unknown
/// format, one that has no pictures so large, a missing folder, no permission. Leaves nothing behind; what writes the
/// format is being loaded from now on.
void check_writable(const std::filesystem::path& file, int width, int height);

/// Names and values; each format keeps those that it has a place for.
using Metadata = std::vector<std::pair<std::string, std::string>>;

/// Writes R, G, B, A (colour premultiplied). `file` is the old one or complete, see PartFile. Throws WriteError.
void write_image(const std::filesystem::path& file, const ColorImage& image, const ImageEncoding& encoding,
                 const Metadata& metadata);

/// What stands for a node in 8 bits, sRGB: a colour for every node below 2^24, no two the same; black for none alone.
[[nodiscard]] std::array<uint8_t, 3> node_color(uint32_t node) noexcept;

/// OpenEXR: the 32-bit UINT channels node, primitive, material. Other formats: `node_color`.
void write_image(const std::filesystem::path& file, const IdImage& image, const ImageEncoding& encoding,
                 const Metadata& metadata);

/// The bytes of a PNG file: R, G, B, A, sRGB. Throws WriteError.
[[nodiscard]] std::vector<uint8_t> encoded_png(const ColorImage& image);

/// "OpenImageIO 2.4.7.1, OpenEXR 3.1.5, libpng 1.6.39": what reads and writes images.
[[nodiscard]] std::string image_library_versions();

}  // namespace alhazen
