#include "loaders/gltf.h"

#include <tbb/parallel_for.h>
#include <tiny_gltf.h>

#include <cstring>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <set>
#include <span>

#include "core/error.h"
#include "loaders/tangents.h"

namespace alhazen {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Bytes = std::vector<uint8_t>;

constexpr int kMaxDepth = 64;
constexpr uint64_t kMaxImplicitCount = uint64_t{1} << 24;  // elements of an accessor that no bytes stand behind

/// A JSON value that knows where it is, so that whatever is wrong with it can be said with its place.
class Ref {
 public:
  Ref(const json& value, std::string pointer, const std::string& file)
      : value_(&value), pointer_(std::move(pointer)), file_(&file) {}
  [[noreturn]] void fail(const std::string& reason) const { throw LoadError(*file_, pointer_, reason); }
  [[nodiscard]] const std::string& pointer() const { return pointer_; }
  [[nodiscard]] const json& value() const { return *value_; }
  [[nodiscard]] bool has(const std::string& key) const { return value_->contains(key); }
  [[nodiscard]] size_t size() const { return value_->size(); }

  [[nodiscard]] Ref operator[](const std::string& key) const {
    if (!has(key)) fail("`" + key + "` is missing");
    std::string escaped;
    for (const char c : key) escaped += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
    return {(*value_)[key], pointer_ + "/" + escaped, *file_};
  }
  [[nodiscard]] Ref operator[](size_t i) const { return {(*value_)[i], pointer_ + "/" + std::to_string(i), *file_}; }

  const Ref& object() const { return value_->is_object() ? *this : (expected("an object"), *this); }
  const Ref& array() const { return value_->is_array() ? *this : (expected("an array"), *this); }
  [[nodiscard]] std::string string() const {
    if (!value_->is_string()) expected("a string");
    return value_->get<std::string>();
  }
  [[nodiscard]] bool boolean() const {
    if (!value_->is_boolean()) expected("true or false");
    return value_->get<bool>();
  }
  [[nodiscard]] double number() const {
    if (!value_->is_number()) expected("a number");
    const double d = value_->get<double>();
    if (!std::isfinite(float(d))) expected("a finite number");
    return d;
  }
  [[nodiscard]] uint64_t natural() const {
    if (value_->is_number_unsigned()) return value_->get<uint64_t>();
    if (value_->is_number_float()) {
      const double d = value_->get<double>();
      if (d >= 0 && d < 9007199254740992.0 && d == std::floor(d)) return uint64_t(d);
    }
    expected("an integer of at least 0");
  }
  [[nodiscard]] uint32_t index(size_t limit, const char* of) const {
    const uint64_t i = natural();
    if (i >= limit) fail("index " + std::to_string(i) + " out of range, there are " + std::to_string(limit) + " " + of);
    return uint32_t(i);
  }
  template <size_t N>
  [[nodiscard]] std::array<double, N> numbers() const {
    if (!value_->is_array() || value_->size() != N) expected("an array of " + std::to_string(N) + " numbers");
    std::array<double, N> a{};
    for (size_t i = 0; i < N; ++i) a[i] = (*this)[i].number();
    return a;
  }
  [[nodiscard]] Rgb rgb() const {
    const auto a = numbers<3>();
    for (size_t i = 0; i < 3; ++i)
      if (a[i] < 0) (*this)[i].expected("a number of at least 0");
    return {float(a[0]), float(a[1]), float(a[2])};
  }
  [[nodiscard]] Ref extension(const std::string& name) const { return (*this)["extensions"][name].object(); }
  [[nodiscard]] bool has_extension(const std::string& name) const {
    return has("extensions") && (*this)["extensions"].object().has(name);
  }
  /// The objects of an array, none where the key is missing.
  [[nodiscard]] std::vector<Ref> list(const std::string& key) const {
    std::vector<Ref> all;
    if (!has(key)) return all;
    const Ref a = (*this)[key].array();
    all.reserve(a.size());
    for (size_t i = 0; i < a.size(); ++i) all.push_back(a[i].object());
    return all;
  }
  void only(const std::set<std::string>& keys) const {
    object();
    for (const auto& [key, unused] : value_->items())
      if (key != "extensions" && key != "extras" && !keys.contains(key)) (*this)[key].fail("unknown key `" + key + "`");
  }
  [[noreturn]] void expected(const std::string& what) const {
    std::string found = value_->dump(-1, ' ', false, json::error_handler_t::replace);
    if (found.size() > 40) found = found.substr(0, 40) + "...";
    fail("found " + found + ", expected " + what);
  }

  double number_or(const std::string& k, double d, double low = -3.4e38, double high = 3.4e38) const {
    if (!has(k)) return d;
    const Ref r = (*this)[k];
    const double v = r.number();
    if (v < low || v > high) r.fail("found " + r.value().dump() + ", out of range");
    return v;
  }
  bool boolean_or(const std::string& k, bool d) const { return has(k) ? (*this)[k].boolean() : d; }
  Rgb rgb_or(const std::string& k, Rgb d) const { return has(k) ? (*this)[k].rgb() : d; }
  std::string string_or(const std::string& k, const char* d = "") const { return has(k) ? (*this)[k].string() : d; }
  uint64_t natural_or(const std::string& k, uint64_t d) const { return has(k) ? (*this)[k].natural() : d; }

 private:
  const json* value_;
  std::string pointer_;
  const std::string* file_;
};

std::optional<Bytes> read_file(const fs::path& path) {
  std::error_code ec;
  if (!fs::is_regular_file(path, ec)) return {};
  std::ifstream in(path, std::ios::binary);
  const auto size = fs::file_size(path, ec);
  if (!in || ec) return {};
  Bytes bytes(size);
  if (size && !in.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(size))) return {};
  return bytes;
}

std::optional<Bytes> from_base64(std::string_view text) {
  Bytes out;
  out.reserve(text.size() / 4 * 3);
  uint32_t word = 0;
  int bits = 0;
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  for (const char c : text) {
    const int v = c >= 'A' && c <= 'Z'     ? c - 'A'
                  : c >= 'a' && c <= 'z'   ? c - 'a' + 26
                  : c >= '0' && c <= '9'   ? c - '0' + 52
                  : c == '+' || c == '-'   ? 62
                  : c == '/' || c == '_'   ? 63
                  : c == '\n' || c == '\r' ? -2
                                           : -1;
    if (v == -2) continue;
    if (v < 0) return {};
    word = word << 6 | uint32_t(v);
    if ((bits += 6) >= 8) out.push_back(uint8_t(word >> (bits -= 8)));
  }
  return out;
}

std::string percent_decode(const std::string& text) {
  std::string out;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size() && std::isxdigit(uint8_t(text[i + 1])) &&
        std::isxdigit(uint8_t(text[i + 2]))) {
      out += char(std::stoi(text.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out;
}

struct BufferView {
  uint64_t buffer = 0, offset = 0, length = 0, stride = 0;
};

int component_size(int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

template <class T>
T load(const uint8_t* p) {
  T t;
  std::memcpy(&t, p, sizeof t);
  return t;
}

double component(const uint8_t* p, int type, bool normalized) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: {
      const double v = load<int8_t>(p);
      return normalized ? std::max(v / 127, -1.0) : v;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return normalized ? *p / 255.0 : *p;
    case TINYGLTF_COMPONENT_TYPE_SHORT: {
      const double v = load<int16_t>(p);
      return normalized ? std::max(v / 32767, -1.0) : v;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<uint16_t>(p) / (normalized ? 65535.0 : 1.0);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return load<uint32_t>(p);
    default:
      return load<float>(p);
  }
}

struct Accessor {
  uint64_t count = 0, stride = 0, element = 0;
  int components = 0, type = 0;
  bool normalized = false;
  const uint8_t* data = nullptr;  // null: zeros
  uint64_t sparse_count = 0;
  int sparse_type = 0;
  const uint8_t *sparse_indices = nullptr, *sparse_values = nullptr;
};

template <class T>
std::vector<T> values(const Accessor& a) {
  std::vector<T> out;
  const size_t n = size_t(a.components), size = size_t(component_size(a.type));
  out.reserve(a.count * n + 6);
  out.resize(a.count * n);
  if (a.data)
    for (uint64_t i = 0; i < a.count; ++i)
      for (size_t k = 0; k < n; ++k)
        out[i * n + k] = T(component(a.data + i * a.stride + k * size, a.type, a.normalized));
  for (uint64_t i = 0; i < a.sparse_count; ++i) {
    const auto at =
        uint64_t(component(a.sparse_indices + i * uint64_t(component_size(a.sparse_type)), a.sparse_type, false));
    for (size_t k = 0; k < n; ++k)
      out[at * n + k] = T(component(a.sparse_values + i * a.element + k * size, a.type, a.normalized));
  }
  return out;
}

class Loader {
 public:
  Loader(const fs::path& path, const WarningSink& warn) : path_(path), file_(path.string()), warn_(warn) {}

  LoadedScene load() {
    parse();
    const Ref root(json_, "", file_);
    root.object();
    header(root);
    buffers(root);
    accessors(root);
    check_core(root);
    images(root);
    textures(root);
    materials(root);
    lights(root);
    shapes(root);
    meshes(root);
    tangents();
    nodes(root);
    return std::move(out_);
  }

 private:
  fs::path path_;
  std::string file_;
  const WarningSink& warn_;
  std::set<std::string> warned_;
  Bytes bytes_;
  std::span<const uint8_t> bin_;
  json json_;
  tinygltf::Model model_;
  std::vector<Bytes> external_;
  std::vector<std::span<const uint8_t>> buffers_;
  std::vector<BufferView> views_;
  std::vector<Accessor> accessors_;
  std::vector<Light> lights_;
  LoadedScene out_;

  void warn(const std::string& text) {
    if (warn_ && warned_.insert(text).second) warn_(file_ + ": " + text);
  }
  [[noreturn]] void fail(const std::string& reason) const { throw LoadError(file_, "", reason); }

  void parse() {
    auto bytes = read_file(path_);
    if (!bytes) fail("cannot be read, expected a glTF file");
    bytes_ = std::move(*bytes);
    std::string_view text(reinterpret_cast<const char*>(bytes_.data()), bytes_.size());
    if (text.starts_with("glTF")) {
      if (bytes_.size() < 20) fail("GLB header cut short");
      const auto word = [&](uint64_t at) { return uint64_t(alhazen::load<uint32_t>(bytes_.data() + at)); };
      if (word(4) != 2) fail("GLB version " + std::to_string(word(4)) + ", expected 2");
      const uint64_t end = word(8), json_size = word(12);
      if (end > bytes_.size() || end < 20) fail("GLB of " + std::to_string(end) + " bytes cut short");
      if (word(16) != 0x4E4F534A) fail("first GLB chunk is not JSON");
      if (json_size > end - 20) fail("GLB JSON chunk longer than the file");
      text = text.substr(20, json_size);
      const uint64_t next = 20 + (json_size + 3) / 4 * 4;
      if (next + 8 <= end && word(next + 4) == 0x004E4942) {
        if (word(next) > end - next - 8) fail("GLB BIN chunk longer than the file");
        bin_ = std::span<const uint8_t>(bytes_).subspan(next + 8, word(next));
      }
    }
    int depth = 0;
    bool quoted = false;
    for (size_t i = 0; i < text.size(); ++i) {
      const char c = text[i];
      if (quoted) {
        if (c == '\\') ++i;
        if (c == '"') quoted = false;
      } else if (c == '"') {
        quoted = true;
      } else if (c == '[' || c == '{') {
        if (++depth > kMaxDepth) fail("JSON nested more than " + std::to_string(kMaxDepth) + " deep");
      } else if (c == ']' || c == '}') {
        --depth;
      }
    }
    try {
      json_ = json::parse(text);
    } catch (const json::exception& e) {
      const std::string what = e.what();
      const size_t cut = what.find("] ");
      fail("not valid JSON: " + (cut == std::string::npos ? what : what.substr(cut + 2)));
    }
  }

  void header(const Ref& root) {
    const Ref version = root["asset"].object()["version"];
    if (!version.string().starts_with("2.")) version.expected("version 2.x");
    static const std::set<std::string> known{"KHR_lights_punctual",    "KHR_texture_transform",
                                             "KHR_materials_unlit",    "KHR_materials_emissive_strength",
                                             "KHR_materials_ior",      "KHR_materials_transmission",
                                             "KHR_materials_specular", "ALHAZEN_materials_phong",
                                             "ALHAZEN_lights",         "ALHAZEN_shapes"};
    const auto each_in = [&](const char* key, auto&& each) {
      if (!root.has(key)) return;
      const Ref list = root[key].array();
      for (size_t i = 0; i < list.size(); ++i) each(list[i]);
    };
    std::set<std::string> required;
    each_in("extensionsRequired", [&](const Ref& r) {
      if (!known.contains(r.string())) r.fail("requires the extension " + r.string() + ", which is not supported");
      required.insert(r.string());
    });
    std::string ignored;
    each_in("extensionsUsed", [&](const Ref& r) {
      const std::string name = r.string();
      out_.extensions.push_back({name, required.contains(name), known.contains(name)});
      if (!known.contains(name)) ignored += (ignored.empty() ? "" : ", ") + name;
    });
    if (!ignored.empty()) warn("extensions ignored: " + ignored);
  }

  /// The bytes behind a URI; none where there is no such file.
  std::optional<Bytes> resolve(const Ref& ref) {
    const std::string uri = ref.string();
    if (uri.starts_with("data:")) {
      const size_t comma = uri.find(',');
      if (comma == std::string::npos) ref.fail("data URI without a comma");
      if (!std::string_view(uri).substr(0, comma).ends_with(";base64")) {
        const std::string raw = percent_decode(uri.substr(comma + 1));
        return Bytes(raw.begin(), raw.end());
      }
      auto bytes = from_base64(std::string_view(uri).substr(comma + 1));
      if (!bytes) ref.fail("data URI is not valid base64");
      return bytes;
    }
    const std::string name = percent_decode(uri);
    if (name.empty() || name.find('\0') != std::string::npos) ref.fail("not the name of a file");
    if (name.find("://") != std::string::npos) return {};
    std::error_code ec;
    const fs::path folder = fs::weakly_canonical(fs::absolute(path_).parent_path(), ec);
    const fs::path target = fs::weakly_canonical(folder / name, ec);
    if (ec) return {};
    const auto [a, b] = std::mismatch(folder.begin(), folder.end(), target.begin(), target.end());
    if (a != folder.end()) ref.fail("`" + name + "` lies outside the scene's folder");
    return read_file(target);
  }

  void buffers(const Ref& root) {
    const auto list = root.list("buffers");
    external_.resize(list.size());
    for (size_t i = 0; i < list.size(); ++i) {
      const uint64_t length = list[i]["byteLength"].natural();
      if (list[i].has("uri")) {
        auto bytes = resolve(list[i]["uri"]);
        if (!bytes) {
          std::string uri = list[i]["uri"].string();
          if (uri.size() > 80) uri.resize(80);
          list[i]["uri"].fail("cannot read `" + uri + "`");
        }
        external_[i] = std::move(*bytes);
        buffers_.emplace_back(external_[i]);
      } else if (i == 0 && bin_.data()) {
        buffers_.push_back(bin_);
      } else {
        list[i].fail("has no `uri`, and there is no GLB BIN chunk for it");
      }
      if (buffers_[i].size() < length)
        list[i].fail("holds " + std::to_string(buffers_[i].size()) + " bytes, expected byteLength " +
                     std::to_string(length));
      buffers_[i] = buffers_[i].first(length);
    }
    for (const Ref& r : root.list("bufferViews")) {
      BufferView v;
      v.buffer = r["buffer"].index(buffers_.size(), "buffers");
      v.offset = r.natural_or("byteOffset", 0);
      v.length = r["byteLength"].natural();
      v.stride = r.natural_or("byteStride", 0);
      const uint64_t size = buffers_[v.buffer].size();
      if (v.offset > size || v.length > size - v.offset)
        r.fail("bytes " + std::to_string(v.offset) + " + " + std::to_string(v.length) + " exceed the buffer's " +
               std::to_string(size));
      if (v.stride > 252) r["byteStride"].expected("at most 252");
      views_.push_back(v);
    }
  }

  /// Where `count` elements begin, after the check that all lie in the buffer view.
  const uint8_t* range(const Ref& r, const BufferView& v, uint64_t offset, uint64_t count, uint64_t stride,
                       uint64_t element) const {
    if (offset > v.length || element > v.length - offset || (count - 1) > (v.length - offset - element) / stride)
      r.fail(std::to_string(count) + " elements exceed the buffer view's " + std::to_string(v.length) + " bytes");
    return buffers_[v.buffer].data() + v.offset + offset;
  }

  void accessors(const Ref& root) {
    static const std::map<std::string, int> shapes{{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
                                                   {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16}};
    for (const Ref& r : root.list("accessors")) {
      Accessor a;
      const std::string shape = r["type"].string();
      if (!shapes.contains(shape)) r["type"].expected("SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4");
      a.components = shapes.at(shape);
      a.type = int(std::min<uint64_t>(r["componentType"].natural(), 1u << 30));
      const auto size = uint64_t(component_size(a.type));
      if (!size) r["componentType"].expected("5120, 5121, 5122, 5123, 5125 or 5126");
      a.element = size * uint64_t(a.components);
      if (size == 1 && shape == "MAT2") a.element = 8;
      if (size < 4 && shape == "MAT3") a.element = 12 * size;
      a.normalized = r.boolean_or("normalized", false);
      a.count = r["count"].natural();
      if (a.count == 0) r["count"].expected("at least 1");
      const uint64_t offset = r.natural_or("byteOffset", 0);
      if (r.has("bufferView")) {
        const BufferView& v = views_[r["bufferView"].index(views_.size(), "buffer views")];
        a.stride = v.stride ? v.stride : a.element;
        if (a.stride < a.element) r.fail("byteStride of its buffer view is less than an element's size");
        a.data = range(r, v, offset, a.count, a.stride, a.element);
      } else if (a.count > kMaxImplicitCount) {
        r["count"].expected("at most " + std::to_string(kMaxImplicitCount) + " without a bufferView");
      }
      if (r.has("sparse")) {
        const Ref s = r["sparse"].object(), si = s["indices"].object(), sv = s["values"].object();
        a.sparse_count = s["count"].natural();
        if (a.sparse_count == 0 || a.sparse_count > a.count) s["count"].expected("1 to the accessor's count");
        const uint64_t type = si["componentType"].natural();
        if (type != 5121 && type != 5123 && type != 5125) si["componentType"].expected("5121, 5123 or 5125");
        a.sparse_type = int(type);
        const auto isize = uint64_t(component_size(a.sparse_type));
        a.sparse_indices = range(si, views_[si["bufferView"].index(views_.size(), "buffer views")],
                                 si.natural_or("byteOffset", 0), a.sparse_count, isize, isize);
        a.sparse_values = range(sv, views_[sv["bufferView"].index(views_.size(), "buffer views")],
                                sv.natural_or("byteOffset", 0), a.sparse_count, a.element, a.element);
        for (uint64_t i = 0; i < a.sparse_count; ++i)
          if (component(a.sparse_indices + i * isize, a.sparse_type, false) >= double(a.count))
            si.fail("sparse index " + std::to_string(i) + " is out of range");
      }
      accessors_.push_back(a);
    }
  }

  /// Gives the parser a copy in which no byte and no file is left to read: those are resolved here.
  void check_core(const Ref& root) {
    for (const char* key : {"images", "textures", "samplers", "materials", "meshes", "nodes", "scenes", "cameras"})
      for (const Ref& r : root.list(key))
        if (r.has("name")) (void)r["name"].string();
    json copy = json_;
    const json dummy = {{"byteLength", 1}, {"uri", "data:application/octet-stream;base64,AA=="}};
    for (const char* key : {"animations", "skins", "extensions", "extras"}) copy.erase(key);
    copy["buffers"] = json::array({dummy});
    copy["bufferViews"] = json::array({{{"buffer", 0}, {"byteLength", 1}}});
    if (copy.contains("accessors"))
      for (json& a : copy["accessors"]) {
        a.erase("sparse");
        a["bufferView"] = 0;
        a["byteOffset"] = 0;
      }
    if (copy.contains("images"))
      for (json& i : copy["images"]) i = {{"uri", "data:image/png;base64,AA=="}};
    if (copy.contains("nodes"))
      for (json& n : copy["nodes"]) n.erase("skin");
    try {
      tinygltf::TinyGLTF parser;
      parser.SetImageLoader([](tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*,
                               int, void*) { return true; },
                            nullptr);
      std::string error, warning;
      const std::string text = copy.dump();
      if (!parser.LoadASCIIFromString(&model_, &error, &warning, text.c_str(), unsigned(text.size()), "")) fail(error);
    } catch (const LoadError&) {
      throw;
    } catch (const std::exception& e) {
      fail(e.what());
    }
    for (const auto& [key, size] :
         {std::pair{"nodes", model_.nodes.size()}, std::pair{"meshes", model_.meshes.size()},
          std::pair{"textures", model_.textures.size()}, std::pair{"samplers", model_.samplers.size()}})
      if (root.list(key).size() != size) root[key].fail("could not be read");
  }

  void images(const Ref& root) {
    for (const Ref& r : root.list("images")) {
      EncodedImage image{file_ + ": " + r.pointer(), {}};
      if (r.has("bufferView")) {
        const BufferView& v = views_[r["bufferView"].index(views_.size(), "buffer views")];
        const auto part = buffers_[v.buffer].subspan(v.offset, v.length);
        image.bytes.assign(part.begin(), part.end());
      } else if (r.has("uri")) {
        if (auto bytes = resolve(r["uri"]))
          image.bytes = std::move(*bytes);
        else
          warn(r.pointer() + ": cannot read `" + r["uri"].string().substr(0, 80) + "`, taken as white");
      } else {
        warn(r.pointer() + ": has neither `uri` nor `bufferView`, taken as white");
      }
      out_.encoded.push_back(std::move(image));
    }
    out_.scene.images.resize(out_.encoded.size());
  }

  void textures(const Ref& root) {
    const auto samplers = root.list("samplers");
    const auto wrap = [](const Ref& s, const char* key, int value) {
      if (s.has(key)) (void)s[key].natural();
      if (value == TINYGLTF_TEXTURE_WRAP_REPEAT) return Wrap::repeat;
      if (value == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) return Wrap::mirrored_repeat;
      if (value != TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) s[key].expected("10497, 33071 or 33648");
      return Wrap::clamp_to_edge;
    };
    const auto list = root.list("textures");
    for (size_t i = 0; i < list.size(); ++i) {
      Texture t;
      if (list[i].has("source")) t.image = list[i]["source"].index(out_.encoded.size(), "images");
      if (list[i].has("sampler")) {
        const uint32_t s = list[i]["sampler"].index(samplers.size(), "samplers");
        const tinygltf::Sampler& sampler = model_.samplers[s];
        t.wrap_u = wrap(samplers[s], "wrapS", sampler.wrapS);
        t.wrap_v = wrap(samplers[s], "wrapT", sampler.wrapT);
        t.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
      }
      out_.scene.textures.push_back(t);
    }
  }

  TextureUse use(const Ref& owner, const char* key) {
    TextureUse u;
    if (!owner.has(key)) return u;
    const Ref r = owner[key].object();
    u.texture = r["index"].index(out_.scene.textures.size(), "textures");
    if (r.has("texCoord")) u.uv_set = r["texCoord"].index(kMaxUvSets, "texture coordinate sets");
    if (r.has_extension("KHR_texture_transform")) {
      const Ref t = r.extension("KHR_texture_transform");
      if (t.has("texCoord")) u.uv_set = t["texCoord"].index(kMaxUvSets, "texture coordinate sets");
      const auto offset = t.has("offset") ? t["offset"].numbers<2>() : std::array<double, 2>{0, 0};
      const auto scale = t.has("scale") ? t["scale"].numbers<2>() : std::array<double, 2>{1, 1};
      const double angle = t.number_or("rotation", 0), c = std::cos(angle), s = std::sin(angle);
      u.xx = float(c * scale[0]), u.xy = float(s * scale[1]), u.x0 = float(offset[0]);
      u.yx = float(-s * scale[0]), u.yy = float(c * scale[1]), u.y0 = float(offset[1]);
    }
    return u;
  }

  void phong(const Ref& r, PhongParameters& p) {
    r.only({"ambientFactor", "diffuseFactor", "specularFactor", "shininess", "reflectionFactor", "transmissionFactor",
            "ior", "fresnel", "ambientTexture", "diffuseTexture"});
    p.diffuse = r.rgb_or("diffuseFactor", p.diffuse);
    p.diffuse_texture = use(r, "diffuseTexture");
    p.ambient = r.rgb_or("ambientFactor", p.diffuse);
    p.ambient_texture = use(r, "ambientTexture");
    if (!r.has("ambientFactor") && !r.has("ambientTexture")) p.ambient_texture = p.diffuse_texture;
    p.specular = r.rgb_or("specularFactor", p.specular);
    p.shininess = float(r.number_or("shininess", p.shininess, 1e-30));
    p.reflection = r.rgb_or("reflectionFactor", p.specular);
    p.transmission = r.rgb_or("transmissionFactor", p.transmission);
    p.ior = float(r.number_or("ior", p.ior, 1));
    p.fresnel = r.boolean_or("fresnel", p.fresnel);
  }

  void materials(const Ref& root) {
    for (const Ref& r : root.list("materials")) {
      Material m;
      m.name = r.string_or("name");
      const std::string mode = r.string_or("alphaMode", "OPAQUE");
      if (mode != "OPAQUE" && mode != "MASK" && mode != "BLEND") r["alphaMode"].expected("OPAQUE, MASK or BLEND");
      m.alpha_mode = mode == "MASK" ? AlphaMode::mask : mode == "BLEND" ? AlphaMode::blend : AlphaMode::opaque;
      m.alpha_cutoff = float(r.number_or("alphaCutoff", 0.5, 0));
      m.double_sided = r.boolean_or("doubleSided", false);
      m.emissive = r.rgb_or("emissiveFactor", m.emissive);
      m.emissive_texture = use(r, "emissiveTexture");
      m.normal_texture = use(r, "normalTexture");
      if (m.normal_texture) m.normal_scale = float(r["normalTexture"].number_or("scale", 1));
      m.occlusion_texture = use(r, "occlusionTexture");
      if (m.occlusion_texture) m.occlusion_strength = float(r["occlusionTexture"].number_or("strength", 1, 0, 1));
      if (r.has("pbrMetallicRoughness")) {
        const Ref p = r["pbrMetallicRoughness"].object();
        if (p.has("baseColorFactor")) {
          const auto c = p["baseColorFactor"].numbers<4>();
          m.base_color = {Rgb{float(c[0]), float(c[1]), float(c[2])}, float(c[3])};
        }
        m.base_color_texture = use(p, "baseColorTexture");
        m.metallic = float(p.number_or("metallicFactor", 1, 0, 1));
        m.roughness = float(p.number_or("roughnessFactor", 1, 0, 1));
        m.metallic_roughness_texture = use(p, "metallicRoughnessTexture");
      }
      if (r.has_extension("KHR_materials_unlit")) m.model = ShadingModel::unlit;
      if (r.has_extension("KHR_materials_emissive_strength"))
        m.emissive =
            m.emissive * float(r.extension("KHR_materials_emissive_strength").number_or("emissiveStrength", 1, 0));
      if (r.has_extension("KHR_materials_ior")) {
        const Ref e = r.extension("KHR_materials_ior");
        m.ior = float(e.number_or("ior", 1.5, 0));
        if (m.ior > 0 && m.ior < 1) e["ior"].expected("0 or at least 1");
      }
      if (r.has_extension("KHR_materials_transmission")) {
        const Ref e = r.extension("KHR_materials_transmission");
        m.transmission = float(e.number_or("transmissionFactor", 0, 0, 1));
        m.transmission_texture = use(e, "transmissionTexture");
      }
      if (r.has_extension("KHR_materials_specular")) {
        const Ref e = r.extension("KHR_materials_specular");
        m.specular = float(e.number_or("specularFactor", 1, 0, 1));
        m.specular_texture = use(e, "specularTexture");
        m.specular_color = e.rgb_or("specularColorFactor", m.specular_color);
        m.specular_color_texture = use(e, "specularColorTexture");
      }
      if (r.has_extension("ALHAZEN_materials_phong")) {
        m.model = ShadingModel::phong;
        phong(r.extension("ALHAZEN_materials_phong"), m.phong);
      }
      out_.scene.materials.push_back(std::move(m));
    }
    out_.scene.materials.emplace_back();  // glTF's default
  }

  void lights(const Ref& root) {
    if (!root.has_extension("KHR_lights_punctual")) return;
    for (const Ref& r : root.extension("KHR_lights_punctual").list("lights")) {
      Light l;
      l.name = r.string_or("name");
      const std::string type = r["type"].string();
      if (type != "directional" && type != "point" && type != "spot") r["type"].expected("directional, point or spot");
      l.kind = type == "point" ? Light::Kind::point : type == "spot" ? Light::Kind::spot : Light::Kind::directional;
      l.intensity = r.rgb_or("color", Rgb{1.0f}) * float(r.number_or("intensity", 1, 0));
      if (r.has("range")) {
        l.range = float(r["range"].number());
        if (!(l.range > 0)) r["range"].expected("more than 0");
      }
      const double inner = r.has("spot") ? r["spot"].object().number_or("innerConeAngle", 0, 0) : 0;
      const double outer =
          r.has("spot") ? r["spot"].number_or("outerConeAngle", std::numbers::pi / 4, 0) : std::numbers::pi / 4;
      if (l.kind == Light::Kind::spot && (inner >= outer || outer > std::numbers::pi / 2 + 1e-6))
        r["spot"].expected("innerConeAngle < outerConeAngle <= pi / 2");
      l.cos_inner = float(std::cos(inner)), l.cos_outer = float(std::cos(outer));
      if (r.has_extension("ALHAZEN_lights")) {
        const Ref e = r.extension("ALHAZEN_lights");
        e.only({"attenuation"});
        const std::string a = e.string_or("attenuation", "inverse-square");
        if (a != "inverse-square" && a != "none") e["attenuation"].expected("inverse-square or none");
        l.attenuated = a != "none";
      }
      lights_.push_back(std::move(l));
    }
  }

  void shapes(const Ref& root) {
    if (!root.has_extension("ALHAZEN_shapes")) return;
    const Ref extension = root.extension("ALHAZEN_shapes");
    extension.only({"shapes"});
    static const std::set<std::string> known{"cylinder", "disk", "box", "polygon", "quadric", "composite"};
    for (const Ref& r : extension.list("shapes")) {
      std::vector<std::string> kinds;
      for (const auto& [key, unused] : r.value().items())
        if (key != "name" && key != "extensions" && key != "extras") kinds.push_back(key);
      const char* all = "sphere, cylinder, disk, box, polygon, quadric, composite";
      for (const std::string& k : kinds) {
        if (k != "sphere" && !known.contains(k)) r.fail("unknown shape \"" + k + "\", expected one of " + all);
      }
      if (kinds.size() != 1) r.fail("found " + std::to_string(kinds.size()) + " shapes, expected one of " + all);
      if (kinds[0] != "sphere") r.fail("the shape \"" + kinds[0] + "\" is not supported yet");
      const Ref s = r["sphere"];
      s.only({"radius"});
      const double radius = s.number_or("radius", 1);
      if (!(radius > 0)) s["radius"].expected("more than 0");
      out_.scene.geometry.shapes.emplace_back(Sphere{float(radius)});
    }
  }

  uint32_t accessor(const Ref& r) const { return r.index(accessors_.size(), "accessors"); }

  template <class T, int N, class Make>
  std::vector<T> attribute(const Ref& attributes, const std::string& key, size_t count, Make make) {
    std::vector<T> all;
    if (!attributes.has(key)) return all;
    const Ref r = attributes[key];
    const Accessor& a = accessors_[accessor(r)];
    if (a.count != count)
      r.fail("accessor of " + std::to_string(a.count) + " elements, expected " + std::to_string(count));
    if (a.components != N && !(N == 4 && a.components == 3 && key == "COLOR_0"))
      r.fail("accessor of " + std::to_string(a.components) + " components, expected " + std::to_string(N));
    const std::vector<float> v = values<float>(a);
    for (const float f : v)
      if (!std::isfinite(f)) r.fail("accessor holds a number that is not finite");
    all.reserve(count + 2);  // Embree reads 16 bytes for each vertex
    for (size_t i = 0; i < count; ++i) all.push_back(make(v.data() + i * size_t(a.components), a.components));
    return all;
  }

  bool primitive(const Ref& r, TriangleMesh& part) {
    const uint64_t mode = r.natural_or("mode", TINYGLTF_MODE_TRIANGLES);
    if (mode > 6) r["mode"].expected("0 to 6");
    const Ref attributes = r["attributes"].object();
    part.material = r.has("material") ? r["material"].index(out_.scene.materials.size() - 1, "materials")
                                      : uint32_t(out_.scene.materials.size() - 1);
    if (mode < 4) return warn("points and lines are not rendered"), false;
    if (!attributes.has("POSITION")) return warn("primitives without POSITION are not rendered"), false;
    const uint64_t count = accessors_[accessor(attributes["POSITION"])].count;
    if (count >= kNone) attributes["POSITION"].fail("too many vertices");
    const auto vec3 = [](const float* v, int) { return Vec3f{v[0], v[1], v[2]}; };
    part.positions = attribute<Vec3f, 3>(attributes, "POSITION", count, vec3);
    part.normals = attribute<Vec3f, 3>(attributes, "NORMAL", count, vec3);
    part.tangents = attribute<Vec4f, 4>(attributes, "TANGENT", count, [](const float* v, int) {
      const Vec3f t = normalize(Vec3f{v[0], v[1], v[2]});
      return Vec4f{t.x, t.y, t.z, v[3] < 0 ? -1.0f : 1.0f};
    });
    if (part.normals.empty()) part.tangents.clear();  // as the specification asks
    part.colors = attribute<Vec4f, 4>(attributes, "COLOR_0", count, [](const float* v, int n) {
      return Vec4f{v[0], v[1], v[2], n == 4 ? v[3] : 1.0f};
    });
    for (size_t i = 0; i < kMaxUvSets && attributes.has("TEXCOORD_" + std::to_string(i)); ++i)
      part.uvs.push_back(
          attribute<Vec2f, 2>(attributes, "TEXCOORD_" + std::to_string(i), count, [](const float* v, int) {
            return Vec2f{v[0], v[1]};
          }));
    std::vector<uint32_t> index;
    if (r.has("indices")) {
      const Ref ref = r["indices"];
      const Accessor& a = accessors_[accessor(ref)];
      if (a.components != 1 || (a.type != 5121 && a.type != 5123 && a.type != 5125))
        ref.fail("expected an accessor of unsigned integers");
      Accessor plain = a;
      plain.normalized = false;
      index = values<uint32_t>(plain);
      for (size_t i = 0; i < index.size(); ++i)
        if (index[i] >= count)
          ref.fail("vertex index " + std::to_string(index[i]) + " at " + std::to_string(i) +
                   " is out of range, there are " + std::to_string(count) + " vertices");
    } else {
      index.resize(count);
      for (uint32_t i = 0; i < count; ++i) index[i] = i;
    }
    const size_t n = index.size();
    if (mode == TINYGLTF_MODE_TRIANGLES) {
      if (n % 3) r.fail(std::to_string(n) + " vertices, expected a multiple of 3");
      part.triangles.reserve(n / 3);
      for (size_t i = 0; i + 2 < n; i += 3) part.triangles.push_back({index[i], index[i + 1], index[i + 2]});
    } else {
      const bool strip = mode == TINYGLTF_MODE_TRIANGLE_STRIP;
      for (size_t i = 0; i + 2 < n; ++i)
        part.triangles.push_back(strip ? std::array{index[i], index[i + 1 + i % 2], index[i + 2 - i % 2]}
                                       : std::array{index[i + 1], index[i + 2], index[0]});
    }
    // A normal of no length gives way to that of a face around it.
    bool lacking = false;
    for (Vec3f& normal : part.normals) {
      normal = Vec3f(normalize(Vec3d(normal)));
      lacking |= normal == Vec3f{};
    }
    if (lacking) {
      for (const auto& t : part.triangles)
        for (const uint32_t v : t)
          if (part.normals[v] == Vec3f{}) {
            const Vec3d a(part.positions[t[0]]), b(part.positions[t[1]]), c(part.positions[t[2]]);
            part.normals[v] = Vec3f(normalize(cross(b - a, c - a)));
          }
      for (Vec3f& normal : part.normals)
        if (normal == Vec3f{}) normal = {0, 1, 0};
    }
    return true;
  }

  void meshes(const Ref& root) {
    const auto list = root.list("meshes");
    for (size_t i = 0; i < list.size(); ++i) {
      Mesh mesh;
      mesh.name = model_.meshes[i].name;
      uint64_t first = 0;
      (void)list[i]["primitives"];
      for (const Ref& r : list[i].list("primitives")) {
        TriangleMesh part;
        if (!primitive(r, part)) continue;
        part.first_primitive = uint32_t(first);
        if ((first += part.triangles.size()) >= kNone) list[i].fail("too many triangles");
        mesh.parts.push_back(std::move(part));
      }
      out_.scene.geometry.meshes.push_back(std::move(mesh));
    }
  }

  /// Tangents where a normal texture needs them and the mesh has none.
  void tangents() {
    std::vector<TriangleMesh*> lacking;
    for (Mesh& mesh : out_.scene.geometry.meshes)
      for (TriangleMesh& part : mesh.parts)
        if (part.tangents.empty() && out_.scene.materials[part.material].normal_texture) lacking.push_back(&part);
    tbb::parallel_for(size_t{0}, lacking.size(), [&](size_t i) {
      generate_tangents(*lacking[i], out_.scene.materials[lacking[i]->material].normal_texture.uv_set);
    });
  }

  static Affine3d local(const Ref& r) {
    if (r.has("matrix")) {
      const auto m = r["matrix"].numbers<16>();
      if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) r["matrix"].expected("an affine map (last row 0 0 0 1)");
      return {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
    }
    const auto t = r.has("translation") ? r["translation"].numbers<3>() : std::array<double, 3>{0, 0, 0};
    const auto s = r.has("scale") ? r["scale"].numbers<3>() : std::array<double, 3>{1, 1, 1};
    auto q = r.has("rotation") ? r["rotation"].numbers<4>() : std::array<double, 4>{0, 0, 0, 1};
    const double size = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(size > 0)) r["rotation"].expected("a unit quaternion");
    for (double& c : q) c /= size;
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    return {Vec3d{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)} * s[0],
            Vec3d{2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)} * s[1],
            Vec3d{2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)} * s[2],
            {t[0], t[1], t[2]}};
  }

  /// The map's position and rotation; the direction -z and the up vector are kept as far as they go together.
  Affine3d rigid(const Affine3d& m, const Ref& r) {
    const Vec3d z = normalize(m.z), y = normalize(m.y - z * dot(m.y, z)), x = cross(y, z);
    if (is_finite(x) && length(x) > 0.5) return {x, y, z, m.origin};
    warn(r.pointer() + ": its camera or light has no direction under this scale");
    return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, m.origin};
  }

  std::vector<uint32_t> scene_roots(const Ref& root, const std::vector<uint32_t>& parent) {
    const auto scenes = root.list("scenes");
    const uint32_t chosen = root.has("scene") ? root["scene"].index(scenes.size(), "scenes") : 0;
    std::vector<uint32_t> roots;
    if (scenes.empty()) {
      for (uint32_t i = 0; i < parent.size(); ++i)
        if (parent[i] == kNone) roots.push_back(i);
      return roots;
    }
    std::set<uint32_t> seen;
    for (size_t s = 0; s < scenes.size(); ++s) {
      if (!scenes[s].has("nodes")) continue;
      const Ref list = scenes[s]["nodes"].array();
      for (size_t i = 0; i < list.size(); ++i) {
        const uint32_t n = list[i].index(parent.size(), "nodes");
        if (s != chosen) continue;
        if (parent[n] != kNone) list[i].fail("node " + std::to_string(n) + " is not a root, it is a child of another");
        if (!seen.insert(n).second) list[i].fail("node " + std::to_string(n) + " is listed twice");
        roots.push_back(n);
      }
    }
    if (scenes[chosen].has_extension("ALHAZEN_lights")) {
      const Ref e = scenes[chosen].extension("ALHAZEN_lights");
      e.only({"ambient", "background"});
      out_.scene.has_ambient = e.has("ambient"), out_.scene.has_background = e.has("background");
      out_.scene.ambient = e.rgb_or("ambient", Rgb{0.0f}), out_.scene.background = e.rgb_or("background", Rgb{0.0f});
    }
    return roots;
  }

  void camera(const Ref& r, uint32_t index, const Affine3d& world_from_node, const Ref& node) {
    Camera c;
    c.name = r.string_or("name");
    const std::string type = r["type"].string();
    if (type == "perspective") {
      const Ref p = r["perspective"].object();
      c.yfov = p["yfov"].number();
      if (!(c.yfov > 0 && c.yfov < std::numbers::pi)) p["yfov"].expected("an angle between 0 and pi");
    } else if (type == "orthographic") {
      const Ref p = r["orthographic"].object();
      c.kind = Camera::Kind::orthographic;
      c.ymag = std::abs(p["ymag"].number());
      if (!(c.ymag > 0)) p["ymag"].expected("anything but 0");
    } else {
      r["type"].expected("perspective or orthographic");
    }
    c.world_from_camera = rigid(world_from_node, node);
    out_.scene.cameras.push_back(std::move(c));
    out_.scene.camera_index.push_back(index);
  }

  void nodes(const Ref& root) {
    const auto list = root.list("nodes");
    const auto cameras = root.list("cameras");
    std::vector<uint32_t> parent(list.size(), kNone);
    std::vector<std::vector<uint32_t>> children(list.size());
    std::vector<Affine3d> world(list.size());
    for (uint32_t i = 0; i < list.size(); ++i) {
      out_.scene.node_names.push_back(model_.nodes[i].name);
      world[i] = local(list[i]);
      if (!list[i].has("children")) continue;
      const Ref c = list[i]["children"].array();
      for (size_t k = 0; k < c.size(); ++k) {
        const uint32_t child = c[k].index(list.size(), "nodes");
        if (parent[child] != kNone) c[k].fail("node " + std::to_string(child) + " has a parent already");
        parent[child] = i;
        children[i].push_back(child);
      }
    }
    // Every node has one parent at most, so that what no root reaches lies on or under a cycle.
    std::vector<uint32_t> stack;
    std::vector<char> reached(list.size()), in_scene(list.size());
    for (uint32_t i = 0; i < list.size(); ++i)
      if (parent[i] == kNone) stack.push_back(i);
    while (!stack.empty()) {
      const uint32_t i = stack.back();
      stack.pop_back();
      reached[i] = 1;
      for (const uint32_t c : children[i]) {
        world[c] = world[i] * world[c];
        stack.push_back(c);
      }
    }
    for (uint32_t i = 0; i < list.size(); ++i)
      if (!reached[i]) list[i].fail("is its own ancestor, or below one that is");
    stack = scene_roots(root, parent);
    while (!stack.empty()) {
      const uint32_t i = stack.back();
      stack.pop_back();
      in_scene[i] = 1;
      stack.insert(stack.end(), children[i].begin(), children[i].end());
    }
    for (uint32_t i = 0; i < list.size(); ++i) place(list[i], i, world[i], in_scene[i] != 0, cameras);
  }

  void place(const Ref& r, uint32_t node, const Affine3d& world_from_node, bool shown,
             const std::vector<Ref>& cameras) {
    Geometry& geometry = out_.scene.geometry;
    if (shown && !is_finite(world_from_node)) r.fail("its global matrix is not finite");
    if (r.has("mesh")) {
      const uint32_t mesh = r["mesh"].index(geometry.meshes.size(), "meshes");
      if (shown && is_invertible(world_from_node))
        geometry.mesh_instances.push_back({mesh, node, world_from_node});
      else if (shown)
        warn(r.pointer() + ": its mesh is left out, its matrix cannot be inverted");
    }
    if (r.has("camera")) {
      const uint32_t index = r["camera"].index(cameras.size(), "cameras");
      if (shown) camera(cameras[index], index, world_from_node, r);
    }
    if (r.has_extension("KHR_lights_punctual")) {
      const Ref e = r.extension("KHR_lights_punctual");
      Light light = lights_.empty() ? Light{} : lights_[e["light"].index(lights_.size(), "lights")];
      if (lights_.empty()) (void)e["light"].index(0, "lights");
      const Affine3d m = rigid(world_from_node, r);
      light.p_world = m.origin;
      light.direction_world = -m.z;
      if (shown) out_.scene.lights.push_back(std::move(light));
    }
    if (r.has_extension("ALHAZEN_shapes")) {
      const Ref e = r.extension("ALHAZEN_shapes");
      e.only({"shape", "material"});
      const uint32_t shape = e["shape"].index(geometry.shapes.size(), "shapes");
      const auto fallback = uint32_t(out_.scene.materials.size() - 1);
      const uint32_t material = e.has("material") ? e["material"].index(fallback, "materials") : fallback;
      if (shown && !is_invertible(world_from_node)) r.fail("places a shape by a matrix that cannot be inverted");
      if (shown) geometry.shape_instances.push_back({shape, node, material, world_from_node});
    }
  }
};

}  // namespace

LoadedScene load_gltf(const std::filesystem::path& file, const WarningSink& warn) { return Loader(file, warn).load(); }

}  // namespace alhazen
