#include "loaders/image_ktx.h"

#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>

#ifdef ALHAZEN_KTX
#include <ktx.h>
#endif

namespace alhazen {

#ifdef ALHAZEN_KTX
namespace {

constexpr int64_t kLargestSide = 65536;

void check(KTX_error_code code) {
  if (code != KTX_SUCCESS) throw std::runtime_error(std::string("libktx: ") + ktxErrorString(code));
}

/// How many 8-bit channels a format that is not compressed has: VK_FORMAT_R8_*, R8G8_*, R8G8B8_*, R8G8B8A8_*.
int channels_of(uint32_t vk_format) {
  if (vk_format == 9 || vk_format == 15) return 1;
  if (vk_format == 16 || vk_format == 22) return 2;
  if (vk_format == 23 || vk_format == 29) return 3;
  if (vk_format == 37 || vk_format == 43) return 4;
  throw std::runtime_error("KTX 2 in the format " + std::to_string(vk_format) + ", which is not unpacked here");
}

/// libktx makes its tables at the first call behind a flag that is no lock, while images are decoded in parallel: until
/// one call has succeeded, the others wait.
void transcode(ktxTexture2* texture) {
  static std::once_flag first;
  bool done = false;
  std::call_once(first, [&] { check(ktxTexture2_TranscodeBasis(texture, KTX_TTF_RGBA32, 0)), done = true; });
  if (!done) check(ktxTexture2_TranscodeBasis(texture, KTX_TTF_RGBA32, 0));
}

}  // namespace

TextureImage decode_ktx(std::span<const uint8_t> file) {
  ktxTexture2* opened = nullptr;
  check(ktxTexture2_CreateFromMemory(file.data(), file.size(), KTX_TEXTURE_CREATE_NO_FLAGS, &opened));
  const auto destroy = [](ktxTexture2* t) { ktxTexture_Destroy(ktxTexture(t)); };
  const std::unique_ptr<ktxTexture2, decltype(destroy)> texture(opened, destroy);
  if (texture->baseWidth > kLargestSide || texture->baseHeight > kLargestSide)
    throw std::runtime_error("more than 65536 pixels a side");
  check(ktxTexture_LoadImageData(ktxTexture(texture.get()), nullptr, 0));
  if (ktxTexture2_NeedsTranscoding(texture.get())) transcode(texture.get());
  TextureImage image;
  image.width = int(texture->baseWidth), image.height = int(texture->baseHeight);
  image.channels = channels_of(texture->vkFormat);
  const size_t row = size_t(image.width) * size_t(image.channels);  // KTX 2 does not pad rows
  ktx_size_t offset = 0;
  check(ktxTexture_GetImageOffset(ktxTexture(texture.get()), 0, 0, 0, &offset));
  if (offset + row * size_t(image.height) > ktxTexture_GetDataSize(ktxTexture(texture.get())))
    throw std::runtime_error("KTX 2 file without all of its pixels");
  const uint8_t* pixels = ktxTexture_GetData(ktxTexture(texture.get())) + offset;
  image.samples = std::vector<uint8_t>(pixels, pixels + row * size_t(image.height));
  return image;
}
#else
TextureImage decode_ktx(std::span<const uint8_t>) { throw std::runtime_error("KTX 2 images need a build with libktx"); }
#endif

}  // namespace alhazen
