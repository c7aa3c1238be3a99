// Images that materials look up at the same places, texel beside texel: what a hit needs of all of them lies in one or
// two lines of the cache, and is mixed at once.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "materials/texture.h"

namespace alhazen {

struct Material;

/// Texels of several images of bytes, a record of them for each place.
struct TexelRecords {
  static constexpr size_t kMostBytes = 16;   // of a record
  static constexpr size_t kMostEncoded = 8;  // of images in sRGB, which come first
  static constexpr size_t kLeastBytes = 9;   // below, images apart are looked up as fast
  size_t size = 0;                           // bytes of a record
  uint32_t encoded = 0;                      // bit k: byte k is of a colour in sRGB
  size_t bytes = 0;                          // of all
  std::unique_ptr<uint8_t[]> data;           // level after level, as images have them

  /// For so many texels; not set to anything. Kept readable behind the last record, to its kMostBytes.
  TexelRecords(size_t record_size, size_t texels)
      : size(record_size),
        bytes(texels * record_size + kMostBytes),
        data(std::make_unique_for_overwrite<uint8_t[]>(bytes)) {
    std::fill_n(data.get() + texels * record_size, kMostBytes, uint8_t{0});
  }
};

/// Lays the texels of images that a metallic-roughness material looks up alike into common records; the images keep
/// none of their own. Each goes into one at most, the first that a material asks for. Only where lanes are so wide that
/// it pays, and as far as `spare` bytes of memory hold the records of one group beside its images.
void lay_side_by_side(std::span<const Material> materials, std::span<const Texture> textures,
                      std::vector<TextureImage>& images, uint64_t spare = std::numeric_limits<uint64_t>::max());

/// What a hit in each lane sees of all bytes of the records, where the lookup's texels lie: as look-ups of single
/// images would mix them, to the bit. Only where lanes are so wide, too.
void mix_records(const TexelRecords& records, TextureLookup<ShadingLanes>& lookup) noexcept;

/// Of what was mixed, that of one image.
[[nodiscard]] BasicRgba<ShadingLanes> part_of(const TextureLookup<ShadingLanes>::Mixed& mixed,
                                              const TextureImage& image) noexcept;

}  // namespace alhazen
