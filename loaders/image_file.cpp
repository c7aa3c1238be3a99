#include "loaders/image_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fcntl.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string_view>

#include "core/error.h"

namespace alhazen {
namespace {

namespace fs = std::filesystem;

// ---- In ----

/// OpenImageIO's name of the format by the file's first bytes; empty: none that is read here.
std::string format_of(const std::vector<uint8_t>& bytes) {
  const std::string_view head(reinterpret_cast<const char*>(bytes.data()), std::min<size_t>(bytes.size(), 16));
  if (head.starts_with("\x89PNG")) return "png";
  if (head.starts_with("\xff\xd8\xff")) return "jpeg";
  if (head.starts_with("RIFF") && head.size() >= 12 && head.substr(8, 4) == "WEBP") return "webp";
  if (head.starts_with("\x76\x2f\x31\x01")) return "openexr";
  if (head.starts_with("#?")) return "hdr";
  if (head.starts_with("BM")) return "bmp";
  if (head.starts_with("DDS ")) return "dds";
  return {};
}

template <class T>
void read_samples(OIIO::ImageInput& in, OIIO::TypeDesc type, TextureImage& image) {
  std::vector<T> samples(size_t(image.width) * size_t(image.height) * size_t(image.channels));
  if (!in.read_image(0, 0, 0, image.channels, type, samples.data())) throw std::runtime_error(in.geterror());
  image.samples = std::move(samples);
}

TextureImage decode(const std::vector<uint8_t>& bytes) {
  const std::string format = format_of(bytes);
  if (format.empty()) throw std::runtime_error("unknown image format");
  OIIO::Filesystem::IOMemReader reader(bytes.data(), bytes.size());
  const auto in = OIIO::ImageInput::create(format);
  if (!in) throw std::runtime_error(OIIO::geterror());
  if (!in->supports("ioproxy") || !in->set_ioproxy(&reader))
    throw std::runtime_error(format + " images cannot be read from memory");
  OIIO::ImageSpec config, spec;
  config["oiio:UnassociatedAlpha"] = 1;
  if (!in->open("image." + format, spec, config)) throw std::runtime_error(in->geterror());
  if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0) throw std::runtime_error("no pixels");

  TextureImage image;
  image.width = spec.width, image.height = spec.height, image.channels = std::min(spec.nchannels, 4);
  if (spec.format == OIIO::TypeDesc::UINT8)
    read_samples<uint8_t>(*in, OIIO::TypeDesc::UINT8, image);
  else if (spec.format == OIIO::TypeDesc::UINT16)
    read_samples<uint16_t>(*in, OIIO::TypeDesc::UINT16, image);
  else
    read_samples<float>(*in, OIIO::TypeDesc::FLOAT, image);
  in->close();
  return image;
}

// ---- Out ----

std::string system_error() { return std::strerror(errno); }

/// `file`, or what it points to: a link stays one.
fs::path resolve(const fs::path& file) {
  std::error_code error;
  if (!fs::is_symlink(file, error)) return file;
  const fs::path target = fs::weakly_canonical(file, error);
  return error ? file : target;
}

/// A new file beside its target that vanishes unless it is renamed to it.
class PartFile {
 public:
  explicit PartFile(const fs::path& file)
      : file_(file), target_(resolve(file)), part_(target_.parent_path() / part_name(target_)) {
    fd_ = ::open(part_.c_str(), O_CREAT | O_TRUNC | O_WRONLY | O_CLOEXEC, 0666);
    if (fd_ < 0) throw WriteError(file_.string(), "cannot create a file in its folder: " + system_error());
  }
  ~PartFile() {
    if (fd_ >= 0) ::close(fd_);
    if (!renamed_) ::unlink(part_.c_str());
  }
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  [[nodiscard]] const fs::path& path() const { return part_; }

  void write(const std::vector<unsigned char>& bytes) {
    for (size_t done = 0; done < bytes.size();) {
      const ssize_t n = ::write(fd_, bytes.data() + done, bytes.size() - done);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) throw WriteError(file_.string(), "cannot write: " + system_error());
      done += size_t(n);
    }
  }

  void commit() {
    if (::fsync(fd_) != 0) throw WriteError(file_.string(), "cannot write: " + system_error());
    const int fd = std::exchange(fd_, -1);
    if (::close(fd) != 0) throw WriteError(file_.string(), "cannot close: " + system_error());
    if (::rename(part_.c_str(), target_.c_str()) != 0)
      throw WriteError(file_.string(), "cannot rename to it: " + system_error());
    renamed_ = true;
  }

 private:
  static std::string part_name(const fs::path& file) {
    return "." + file.stem().string() + "." + std::to_string(::getpid()) + ".part" + file.extension().string();
  }

  fs::path file_, target_, part_;
  int fd_ = -1;
  bool renamed_ = false;
};

std::unique_ptr<OIIO::ImageOutput> create_output(const fs::path& file) {
  const std::string extension = file.extension().string();
  auto out = extension.empty() ? nullptr : OIIO::ImageOutput::create("image" + extension);
  const std::string reason = OIIO::geterror();  // fetched, or it is printed at exit
  if (!out || std::strcmp(out->format_name(), "null") == 0 || std::strcmp(out->format_name(), "term") == 0)
    throw WriteError(file.string(), "unknown image format '" + extension + "' (known are .exr, .png, .jpg, .tif)");
  return out;
}

bool is_exr(const OIIO::ImageOutput& out) { return std::strcmp(out.format_name(), "openexr") == 0; }

void write_pixels(const fs::path& file, OIIO::ImageOutput& out, OIIO::ImageSpec spec, OIIO::TypeDesc type,
                  const void* pixels, const Metadata& metadata) {
  for (const auto& [name, value] : metadata) spec.attribute(name, value);
  PartFile part(file);
  const auto check = [&](bool ok) {
    if (!ok) throw WriteError(file.string(), out.geterror());
  };
  if (out.supports("ioproxy")) {  // encoded in memory, so that every failing write is seen
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput writer(bytes);
    check(out.set_ioproxy(&writer));
    check(out.open(part.path().string(), spec));
    check(out.write_image(type, pixels));
    check(out.close());
    part.write(bytes);
  } else {
    check(out.open(part.path().string(), spec));
    check(out.write_image(type, pixels));
    check(out.close());
  }
  part.commit();
}

uint8_t to_byte(float v) { return uint8_t(std::lround(255.0f * std::clamp(std::isnan(v) ? 0.0f : v, 0.0f, 1.0f))); }

/// A colour for every node below 2^24, no two the same; black for none alone.
std::array<uint8_t, 3> node_color(uint32_t node) {
  constexpr uint32_t mask = 0xffffff;
  uint32_t h = (node + 1) & mask;  // each step is a bijection of 24 bits that keeps 0
  h = (h * 0x9e3779u) & mask, h ^= h >> 12;
  h = (h * 0x85ebcbu) & mask, h ^= h >> 11;
  h = (h * 0xc2b2afu) & mask, h ^= h >> 12;
  return {uint8_t(h >> 16), uint8_t(h >> 8), uint8_t(h)};
}

template <class T, class F>
void for_each_pixel(const PixelBuffer<T>& image, F f) {
  tbb::parallel_for(0, image.height, [&](int y) {
    for (int x = 0; x < image.width; ++x) f(image.at(x, y), size_t(y) * size_t(image.width) + size_t(x));
  });
}

OIIO::ImageSpec srgb_spec(int width, int height, int channels) {
  OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("oiio:UnassociatedAlpha", 1);
  spec.attribute("CompressionQuality", 95);
  return spec;
}

}  // namespace

std::vector<TextureImage> decode_images(const std::vector<EncodedImage>& encoded, const WarningSink& warn) {
  std::vector<TextureImage> images(encoded.size());
  std::mutex warning;
  tbb::parallel_for(size_t(0), encoded.size(), [&](size_t i) {
    if (encoded[i].bytes.empty()) return;
    const auto failed = [&](const std::string& reason) {
      const std::lock_guard lock(warning);
      if (warn) warn(encoded[i].place + ": cannot decode the image, white is used: " + reason);
    };
    try {
      images[i] = decode(encoded[i].bytes);
    } catch (const std::bad_alloc&) {
      failed("out of memory");
    } catch (const std::exception& error) {
      failed(error.what());
    } catch (...) {
      failed("unknown error");
    }
  });
  return images;
}

void check_writable(const fs::path& file) {
  if (!file.has_filename()) throw WriteError(file.string(), "names no file");
  (void)create_output(file);
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) throw WriteError(file.string(), "is not a regular file");
  const PartFile part(file);
}

void write_image(const fs::path& file, const ColorImage& image, const Metadata& metadata) {
  const auto out = create_output(file);
  const int stored = int(image.channels.size());
  const auto alpha_at = std::find(image.channels.begin(), image.channels.end(), "A");
  const int alpha = alpha_at == image.channels.end() ? -1 : int(alpha_at - image.channels.begin());
  if (is_exr(*out)) {
    OIIO::ImageSpec spec(image.width, image.height, stored, OIIO::TypeDesc::FLOAT);
    spec.channelnames = image.channels;
    spec.alpha_channel = alpha;
    spec.attribute("compression", "zip");
    spec.attribute("oiio:ColorSpace", "Linear");
    write_pixels(file, *out, spec, OIIO::TypeDesc::FLOAT, image.pixels.data(), metadata);
    return;
  }

  const int colors = std::min(alpha < 0 ? stored : alpha, 3);
  const bool with_alpha = alpha >= 0 && out->supports("alpha");
  const int channels = colors + int(with_alpha);
  std::vector<uint8_t> bytes(size_t(image.width) * size_t(image.height) * size_t(channels));
  for_each_pixel(image, [&](const float* in, size_t pixel) {
    uint8_t* to = &bytes[pixel * size_t(channels)];
    const float scale = with_alpha && in[alpha] > 0 ? 1 / in[alpha] : 1.0f;  // straight where alpha is kept
    for (int c = 0; c < colors; ++c) {
      const float v = in[c] * scale;
      to[c] = to_byte(srgb_from_linear(v > 0 ? std::min(v, 1.0f) : 0.0f));
    }
    if (with_alpha) to[colors] = to_byte(in[alpha]);
  });
  write_pixels(file, *out, srgb_spec(image.width, image.height, channels), OIIO::TypeDesc::UINT8, bytes.data(),
               metadata);
}

void write_image(const fs::path& file, const IdImage& image, const Metadata& metadata) {
  const auto out = create_output(file);
  if (is_exr(*out)) {
    OIIO::ImageSpec spec(image.width, image.height, int(image.channels.size()), OIIO::TypeDesc::UINT32);
    spec.channelnames = image.channels;
    spec.alpha_channel = spec.z_channel = -1;
    spec.attribute("compression", "zip");
    write_pixels(file, *out, spec, OIIO::TypeDesc::UINT32, image.pixels.data(), metadata);
    return;
  }
  std::vector<uint8_t> bytes(size_t(image.width) * size_t(image.height) * 3);
  for_each_pixel(image, [&](const uint32_t* in, size_t pixel) {
    const auto color = node_color(in[0]);
    std::copy(color.begin(), color.end(), bytes.begin() + ptrdiff_t(pixel * 3));
  });
  write_pixels(file, *out, srgb_spec(image.width, image.height, 3), OIIO::TypeDesc::UINT8, bytes.data(), metadata);
}

}  // namespace alhazen
