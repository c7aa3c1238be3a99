#include "loaders/openexr_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <OpenEXRConfig.h>
#include <tbb/info.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <mutex>
#include <utility>

namespace alhazen {
namespace {

constexpr float kLargestHalf = 65504;

constexpr Imf::Compression kCompressions[] = {
    Imf::ZIP_COMPRESSION,   Imf::NO_COMPRESSION,  Imf::RLE_COMPRESSION,  Imf::ZIPS_COMPRESSION, Imf::PIZ_COMPRESSION,
    Imf::PXR24_COMPRESSION, Imf::B44_COMPRESSION, Imf::B44A_COMPRESSION, Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION};
static_assert(std::size(kCompressions) == std::size(kExrCompressions));

// OpenEXR's names of what other formats call otherwise.
constexpr std::pair<const char*, const char*> kNames[] = {{"DateTime", "capDate"}, {"ImageDescription", "comments"}};

/// A file in memory: OpenEXR goes back in it, which a file that is being written out cannot.
class Memory : public Imf::OStream {
 public:
  explicit Memory(std::vector<uint8_t>& bytes) : OStream("memory"), bytes_(bytes) {}
  void write(const char* from, int count) override {
    if (bytes_.size() < at_ + size_t(count)) bytes_.resize(at_ + size_t(count));
    std::memcpy(bytes_.data() + at_, from, size_t(count));
    at_ += size_t(count);
  }
  uint64_t tellp() override { return at_; }
  void seekp(uint64_t position) override { at_ = position; }

 private:
  std::vector<uint8_t>& bytes_;
  size_t at_ = 0;
};

Imf::PixelType pixel_type(ExrType type) {
  return type == ExrType::half ? Imf::HALF : type == ExrType::float32 ? Imf::FLOAT : Imf::UINT;
}

Imf::Compression compression_of(const std::string& name) {
  const auto* const known = std::find(std::begin(kExrCompressions), std::end(kExrCompressions), name);
  return known == std::end(kExrCompressions) ? kCompressions[0] : kCompressions[known - std::begin(kExrCompressions)];
}

Imf::Header header_of(int width, int height, const ExrPart& part) {
  Imf::Header header(width, height);
  header.compression() = compression_of(part.compression);
  for (const ExrChannel& channel : part.channels)
    header.channels().insert(channel.name, Imf::Channel(pixel_type(channel.type)));
  for (const auto& [given, value] : part.metadata) {
    const std::string& name = given;
    const auto* const known =
        std::find_if(std::begin(kNames), std::end(kNames), [&](auto& n) { return name == n.first; });
    header.insert(known == std::end(kNames) ? name : known->second, Imf::StringAttribute(value));
  }
  return header;
}

/// What OpenEXR reads the channels from, and the halves that are made for it.
struct Frame {
  std::vector<std::vector<half>> halves;
  Imf::FrameBuffer buffer;

  Frame(int width, int height, const ExrPart& part) {
    for (const ExrChannel& channel : part.channels) {
      const void* values = channel.values;
      size_t value_bytes = sizeof(float), stride = channel.stride;
      if (channel.type == ExrType::half) {
        auto& made = halves.emplace_back(size_t(width) * size_t(height));
        const auto* floats = static_cast<const float*>(values);
        for (size_t i = 0; i < made.size(); ++i) made[i] = std::clamp(floats[i * stride], -kLargestHalf, kLargestHalf);
        values = made.data(), value_bytes = sizeof(half), stride = 1;
      }
      auto* const base = static_cast<char*>(const_cast<void*>(values));  // only read
      buffer.insert(channel.name, Imf::Slice(pixel_type(channel.type), base, value_bytes * stride,
                                             value_bytes * stride * size_t(width)));
    }
  }
};

/// As many threads to compress as there are to render.
void use_all_threads() {
  static std::once_flag once;
  std::call_once(once, [] { Imf::setGlobalThreadCount(tbb::info::default_concurrency()); });
}

}  // namespace

std::vector<uint8_t> encoded_exr(int width, int height, std::span<const ExrPart> parts) {
  use_all_threads();
  std::vector<uint8_t> bytes;
  Memory memory(bytes);
  if (parts.size() == 1) {
    Imf::OutputFile file(memory, header_of(width, height, parts[0]));
    const Frame frame(width, height, parts[0]);
    file.setFrameBuffer(frame.buffer);
    file.writePixels(height);
  } else {
    std::vector<Imf::Header> headers;
    for (const ExrPart& part : parts) {
      headers.push_back(header_of(width, height, part));
      headers.back().setName(part.name);
      headers.back().setType(Imf::SCANLINEIMAGE);
    }
    Imf::MultiPartOutputFile file(memory, headers.data(), int(headers.size()));
    for (size_t i = 0; i < parts.size(); ++i) {
      const Frame frame(width, height, parts[i]);
      Imf::OutputPart part(file, int(i));
      part.setFrameBuffer(frame.buffer);
      part.writePixels(height);
    }
  }
  return bytes;  // complete: what the files write at their ends is there
}

const char* openexr_version() { return OPENEXR_VERSION_STRING; }

}  // namespace alhazen
