// OpenImageIO and OpenColorIO behind a table of functions, in a library of their own that is loaded when it is first
// needed: on Debian they bring 250 others along, which take a third of a second and 80 MB to load. What most runs need,
// OpenEXR and PNG files out, does without them (openexr_file.h, png_file.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/image.h"
#include "core/vec.h"

namespace alhazen {

struct DisplayView;

enum class SampleType : uint8_t { uint8, uint16, uint32, float32 };

/// What a file says of its picture.
struct ImageLayout {
  int width = 0, height = 0, depth = 1;
  std::vector<std::string> channels;
  SampleType type = SampleType::float32;  // nearest to what is stored that loses nothing
};

/// A picture in a file or in memory. Both throw std::runtime_error with the library's reason.
class ImageReader {
 public:
  virtual ~ImageReader() = default;
  [[nodiscard]] virtual const ImageLayout& layout() const = 0;
  /// The first channels, from the top row on, `stride` bytes from pixel to pixel.
  virtual void read(int channels, SampleType type, void* pixels, ptrdiff_t stride) = 0;
};

struct ImageWriterFormat {
  std::string name;  // "jpeg", "targa", ...
  bool alpha = false;
  bool memory = false;  // can write to memory
};

/// Pixels on their way to a format; only the first channels are written.
struct StoredPicture {
  int width, height, channels;
  SampleType type;
  const void* pixels;
  ptrdiff_t stride;                                          // bytes
  std::vector<std::pair<std::string, std::string>> texts{};  // attributes by OpenImageIO's names
  std::vector<std::pair<std::string, int>> numbers{};
};

/// From scene-linear to encoded colours of a display: R, G, B of four floats a pixel, in place.
class DisplayProcessor {
 public:
  virtual ~DisplayProcessor() = default;
  virtual void apply(float* pixels, int width, int height) const = 0;
};

/// All throw std::runtime_error with the library's reason unless they say something else. May be called from any
/// thread.
struct ImageLibrary {
  std::unique_ptr<ImageReader> (*open_file)(const std::string& path);
  std::unique_ptr<ImageReader> (*open_memory)(const std::string& format, std::span<const uint8_t> bytes);
  /// By extension, with its dot; none: not written.
  std::optional<ImageWriterFormat> (*writer_format)(const std::string& extension);
  /// To `path`, or into `bytes` what would be there.
  void (*write)(const std::string& path, const StoredPicture& picture, std::vector<uint8_t>* bytes);
  /// Throws LoadError, UsageError: see DisplayTransform.
  std::unique_ptr<DisplayProcessor> (*display_processor)(const DisplayView& wanted);
  /// See draw_text.h; neither throws.
  bool (*draw_text)(ColorImage& image, int x, int y, const std::string& text, int height, const Rgb& color);
  int (*text_width)(const std::string& text, int height);
};

/// Waits until it is loaded. Throws Error where its file is missing or what it needs itself.
[[nodiscard]] const ImageLibrary& image_library();

/// Starts loading it beside what else goes on: call this as soon as it is known that it will be needed.
void preload_image_library();

/// Waits while it is being loaded. To be called before the program ends: handlers for the end that a library has set up
/// already would run beside the rest of its start.
void await_image_library() noexcept;

}  // namespace alhazen
