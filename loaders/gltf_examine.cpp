#include "loaders/gltf_examine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string_view>

#include "core/error.h"
#include "loaders/gltf_examiner.h"
#include "loaders/gltf_uri.h"
#include "loaders/image_header.h"

namespace alhazen {
namespace {

using nlohmann::json;

// ---- Accessors ----

void examine_bounds(Examiner& e, const JsonRef& r, const AccessorView& accessor) {
  constexpr uint32_t kAtOnce = 4096;
  const size_t n = accessor.components;
  std::vector<double> low(n, std::numeric_limits<double>::infinity()), high(n, -low[0]);
  uint64_t not_finite = 0;
  std::vector<uint32_t> elements;
  AccessorView raw = accessor;
  raw.normalized = false;  // as min and max are
  for (uint64_t first = 0; first < accessor.count; first += kAtOnce) {
    elements.resize(std::min<uint64_t>(kAtOnce, accessor.count - first));
    std::iota(elements.begin(), elements.end(), uint32_t(first));
    const std::vector<float> values = floats(raw, elements);
    for (size_t i = 0; i < values.size(); ++i) {
      not_finite += !std::isfinite(values[i]);
      low[i % n] = std::min(low[i % n], double(values[i])), high[i % n] = std::max(high[i % n], double(values[i]));
    }
  }
  e.unless(not_finite == 0, r, std::to_string(not_finite) + " of its numbers are not finite");
  const auto compare = [&](const char* key, const std::vector<double>& found) {
    const auto declared = r.find(key);
    if (!declared || !declared->value().is_array()) return;
    e.unless(declared->value().size() == n, *declared, "expected " + std::to_string(n) + " numbers");
    for (size_t k = 0; k < std::min(n, declared->value().size()); ++k)
      if (declared->value()[k].is_number() && float(declared->value()[k].get<double>()) != float(found[k]))
        e.say((*declared)[k], "its elements have " + json(found[k]).dump());
  };
  compare("min", low), compare("max", high);
}

void examine_accessors(Examiner& e) {
  const auto accessors = e.root().elements("accessors");
  for (size_t i = 0; i < accessors.size(); ++i) {
    const JsonRef& r = accessors[i];
    const AccessorView& accessor = e.buffers.accessor(int(i));
    const auto size = component_size(accessor.type);
    if (const auto offset = r.find("byteOffset")) {
      e.unless(r.has("bufferView"), *offset, "means nothing without a bufferView");
      e.unless(offset->as<uint64_t>() % size == 0, *offset,
               "expected a multiple of the component's " + std::to_string(size) + " bytes");
    }
    const bool whole = accessor.type != TINYGLTF_COMPONENT_TYPE_FLOAT &&
                       accessor.type != TINYGLTF_COMPONENT_TYPE_DOUBLE &&
                       accessor.type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    e.unless(whole || !accessor.normalized, r, "`normalized` means nothing for its component type");
    if (accessor.data || !accessor.replaced.empty()) examine_bounds(e, r, accessor);
  }
}

// ---- Images, buffers ----

std::string_view mime_of(ImageKind kind) {
  constexpr std::string_view kMimes[] = {"image/png",          "image/jpeg", "image/webp",       "image/x-exr",
                                         "image/vnd.radiance", "image/bmp",  "image/vnd-ms.dds", "image/ktx2"};
  return kMimes[size_t(kind)];
}

void examine_image(Examiner& e, const JsonRef& r) {
  const auto uri = r.find("uri"), view = r.find("bufferView");
  e.unless(!uri || !view, r, "has both `uri` and `bufferView`, expected one of them");
  e.unless(uri || view, r, "has neither `uri` nor `bufferView`");
  e.unless(!view || r.has("mimeType"), r, "`mimeType` is missing, which a bufferView needs");
  Bytes owned;
  std::span<const uint8_t> bytes;
  if (view) {
    bytes = e.buffers.buffer_view(view->as<int>());
  } else if (uri) {
    auto found = resolve_uri(*uri, e.source.document.folder, e.files);
    if (!found) return e.say(*uri, "cannot be read");
    bytes = owned = std::move(*found);
  }
  const auto kind = image_kind(bytes);
  e.unless(kind && read_image_header(*kind, bytes), r, "its bytes are no image that is known here");
  for (const auto& [other, extension] :
       {std::pair{ImageKind::webp, "EXT_texture_webp"}, std::pair{ImageKind::dds, "MSFT_texture_dds"},
        std::pair{ImageKind::ktx2, "KHR_texture_basisu"}})
    e.unless(kind != other || e.used.contains(extension), r,
             "its image is " + std::string(mime_of(other)) + ", which needs " + extension + " in extensionsUsed");
  const auto mime = r.find("mimeType");
  if (kind && mime && mime->value().is_string())
    e.unless(mime->as<std::string>() == mime_of(*kind), *mime, "its image is " + std::string(mime_of(*kind)));
}

void examine_textures(Examiner& e) {
  for (const JsonRef& r : e.root().elements("images")) examine_image(e, r);
  for (const JsonRef& r : e.root().elements("textures"))
    if (const auto source = r.find("source")) {
      const auto mime = e.root()["images"][source->as<size_t>()].find("mimeType");
      if (mime && mime->value().is_string())
        e.unless(mime->as<std::string>() == "image/png" || mime->as<std::string>() == "image/jpeg", *source,
                 "its image is " + mime->as<std::string>() + ", expected image/png or image/jpeg");
    }
}

/// Of "data:type/subtype;name=value;base64,...": whether all between the type and base64 are such parameters.
bool has_valid_parameters(std::string_view data_uri) {
  std::string_view head = data_uri.substr(0, data_uri.find(','));
  if (head.ends_with(";base64")) head.remove_suffix(7);
  for (size_t at = head.find(';'); at != std::string_view::npos; at = head.find(';')) {
    head.remove_prefix(at + 1);
    if (head.substr(0, head.find(';')).find('=') == std::string_view::npos) return false;
  }
  return true;
}

void examine_buffers(Examiner& e) {
  for (const JsonRef& r : e.root().elements("buffers")) {
    e.unless(r["byteLength"].as<uint64_t>() > 0, r["byteLength"], "expected 1 or more");
    const auto uri = r.find("uri");
    if (!uri && r.pointer() == "/buffers/0")
      e.unless(e.source.document.bin || r.has("extensions"), r, "has no `uri`, and the file no GLB chunk for it");
    if (uri) e.unless(resolve_uri(*uri, e.source.document.folder, e.files).has_value(), *uri, "cannot be read");
  }
  for (const JsonRef& r : e.root().elements("bufferViews"))
    e.unless(r.get("byteStride", uint64_t{0}) <= r["byteLength"].as<uint64_t>(), r,
             "its byteStride exceeds its byteLength");
  for (const char* key : {"buffers", "images"})
    for (const JsonRef& r : e.root().elements(key))
      if (const auto uri = r.find("uri")) {
        const std::string text = uri->as<std::string>();
        const bool data = text.starts_with("data:");
        e.unless(!data || text.find('/') < text.find(','), *uri, "is a data URI without a media type");
        e.unless(!data || has_valid_parameters(text), *uri, "is a data URI with a parameter that is not name=value");
        e.unless(text.find_first_of(" <>\"{}|\\^`") == std::string::npos, *uri,
                 "has characters that a URI must have percent-encoded");
        if (data && std::string_view(key) == "buffers")
          e.unless(
              text.starts_with("data:application/octet-stream") || text.starts_with("data:application/gltf-buffer"),
              *uri, "expected the media type application/octet-stream or application/gltf-buffer");
      }
}

// ---- Nodes, cameras, lights ----

bool is_orthogonal(const json& matrix) {
  constexpr double kTolerance = 1e-3;
  const auto column = [&](size_t k) {
    return normalize(
        Vec3d{matrix[4 * k].get<double>(), matrix[4 * k + 1].get<double>(), matrix[4 * k + 2].get<double>()});
  };
  const Vec3d x = column(0), y = column(1), z = column(2);
  return std::abs(dot(x, y)) < kTolerance && std::abs(dot(y, z)) < kTolerance && std::abs(dot(z, x)) < kTolerance;
}

void examine_node(Examiner& e, const JsonRef& r) {
  const auto matrix = r.find("matrix");
  for (const char* key : {"translation", "rotation", "scale"})
    e.unless(!matrix || !r.has(key), r, "has both a matrix and a " + std::string(key) + "; the matrix is taken");
  if (matrix) e.unless(is_orthogonal(matrix->value()), *matrix, "is none of translation, rotation and scale");
  if (const auto rotation = r.find("rotation")) {
    const auto q = rotation->as<std::array<double, 4>>();
    const double length = std::sqrt(std::inner_product(q.begin(), q.end(), q.begin(), 0.0));
    e.unless(std::abs(length - 1) <= 1e-3, *rotation, "is no unit quaternion; repaired");
  }
  for (const char* key : {"skin", "weights"})
    e.unless(!r.has(key) || r.has("mesh"), r, "has " + std::string(key) + " without a mesh");
  if (const auto mesh = r.find("mesh"); mesh && r.has("weights")) {
    const json& primitives = e.root()["meshes"][mesh->as<size_t>()]["primitives"].value();
    e.unless(!primitives.empty() && r["weights"].value().size() == primitives[0].value("targets", json::array()).size(),
             r["weights"], "has not one weight for each morph target");
  }
}

void examine_cameras(Examiner& e) {
  for (const JsonRef& r : e.root().elements("cameras")) {
    const bool perspective = r["type"].as<std::string>() == "perspective";
    const JsonRef view = r[perspective ? "perspective" : "orthographic"];
    const double near = view.get("znear", 0.0), far = view.get("zfar", kUnbounded);
    e.unless(far > near, view, "expected zfar > znear");
    e.unless(perspective ? near > 0 : near >= 0, view["znear"],
             "expected a number above 0, or of an orthographic camera 0");
    if (perspective)
      e.unless(view.get("aspectRatio", 1.0) > 0, view, "expected an aspectRatio above 0");
    else
      e.unless(view.get("xmag", 1.0) > 0 && view.get("ymag", 1.0) > 0, view, "expected xmag and ymag above 0");
  }
}

void examine_lights(Examiner& e) {
  if (const auto all = e.root().extension("KHR_lights_punctual"))
    for (const JsonRef& r : all->elements("lights"))
      e.unless(r["type"].as<std::string>() != "spot" || r.has("spot"), r, "`spot` is missing; its defaults are taken");
}

// ---- The container ----

uint32_t word_at(std::span<const uint8_t> file, size_t at) {
  return at + 4 <= file.size()
             ? uint32_t(file[at] | file[at + 1] << 8 | file[at + 2] << 16) | uint32_t(file[at + 3]) << 24
             : 0;
}

void examine_container(Examiner& e) {
  constexpr uint32_t kBin = 0x004E4942;
  const std::span<const uint8_t> file = e.source.document.file.bytes;
  if (file.empty()) return;
  e.unless(word_at(file, 8) == file.size(), e.root(), "the GLB's length is not the file's");
  size_t number = 0;
  for (size_t at = 12; at + 8 <= file.size(); at += 8 + size_t{word_at(file, at)}, ++number) {
    e.unless(word_at(file, at) % 4 == 0, e.root(), "a GLB chunk is not padded to a multiple of 4 bytes");
    e.unless(word_at(file, at + 4) != kBin || number == 1, e.root(), "a GLB's BIN chunk is not the second; left out");
  }
}

}  // namespace

bool Examiner::unless(const Check& check, const JsonRef& r) const {
  try {
    check(r);
    return true;
  } catch (const LoadError& error) {
    const std::string what = error.what();
    source.warn("", what.substr(std::min(source.document.json.file.size() + 2, what.size())));
    return false;
  }
}

void examine_gltf(GltfSource& source, const GltfBuffers& buffers) {
  LoadBudget files(source.budget->limits());
  Examiner e{source, buffers, files, {}};
  for (const JsonRef& r : source.root().elements("extensionsUsed")) e.used.insert(r.as<std::string>());
  examine_container(e);
  examine_values(e);
  examine_accessors(e);
  examine_buffers(e);
  examine_textures(e);
  examine_meshes(e);
  for (const JsonRef& r : source.root().elements("nodes")) examine_node(e, r);
  examine_cameras(e);
  examine_lights(e);
  examine_motion(e);
}

}  // namespace alhazen
