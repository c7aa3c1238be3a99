#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <stdexcept>

#include "loaders/oiio/open_image_io.h"

namespace alhazen::oiio {
namespace {

SampleType type_of(const OIIO::ImageSpec& spec) {
  if (spec.format == OIIO::TypeDesc::UINT8) return SampleType::uint8;
  if (spec.format == OIIO::TypeDesc::UINT16) return SampleType::uint16;
  if (spec.format == OIIO::TypeDesc::UINT32) return SampleType::uint32;
  return SampleType::float32;
}

ImageLayout layout_of(const OIIO::ImageSpec& spec) {
  return {spec.width, spec.height, spec.depth, spec.channelnames, type_of(spec)};
}

class Reader : public ImageReader {
 public:
  explicit Reader(const std::string& path) : in_(OIIO::ImageInput::open(path)) {
    if (!in_) throw std::runtime_error(OIIO::geterror());
    layout_ = layout_of(in_->spec());
  }

  Reader(const std::string& format, std::span<const uint8_t> bytes)
      : memory_(std::make_unique<OIIO::Filesystem::IOMemReader>(const_cast<uint8_t*>(bytes.data()), bytes.size())),
        in_(OIIO::ImageInput::create(format)) {
    if (!in_) throw std::runtime_error(OIIO::geterror());
    if (!in_->supports("ioproxy") || !in_->set_ioproxy(memory_.get()))
      throw std::runtime_error(format + " images cannot be read from memory");
    OIIO::ImageSpec config, spec;
    config["oiio:UnassociatedAlpha"] = 1;
    if (!in_->open("image." + format, spec, config)) throw std::runtime_error(in_->geterror());
    layout_ = layout_of(spec);
  }

  const ImageLayout& layout() const override { return layout_; }

  void read(int channels, SampleType type, void* pixels, ptrdiff_t stride) override {
    if (!in_->read_image(0, 0, 0, channels, oiio::type_of(type), pixels, stride))
      throw std::runtime_error(in_->geterror());
  }

 private:
  std::unique_ptr<OIIO::Filesystem::IOMemReader> memory_;  // outlives what reads from it
  std::unique_ptr<OIIO::ImageInput> in_;
  ImageLayout layout_;
};

}  // namespace

OIIO::TypeDesc type_of(SampleType type) {
  constexpr OIIO::TypeDesc::BASETYPE kTypes[] = {OIIO::TypeDesc::UINT8, OIIO::TypeDesc::UINT16, OIIO::TypeDesc::UINT32,
                                                 OIIO::TypeDesc::FLOAT};
  return kTypes[size_t(type)];
}

std::unique_ptr<ImageReader> open_file(const std::string& path) { return std::make_unique<Reader>(path); }

std::unique_ptr<ImageReader> open_memory(const std::string& format, std::span<const uint8_t> bytes) {
  return std::make_unique<Reader>(format, bytes);
}

}  // namespace alhazen::oiio
