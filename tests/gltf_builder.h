// Small glTF files for the tests of the loader, put together in memory and written to a folder of their own.
#pragma once

#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/error.h"
#include "loaders/gltf.h"

namespace alhazen {

using nlohmann::json;

/// A folder that vanishes with its contents.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "alhazen_test_XXXXXX").string();
    if (!::mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  std::filesystem::path write(const std::string& name, const std::string& contents) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << contents;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

inline std::string base64(const std::string& bytes) {
  static const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t word = 0;
    for (size_t k = 0; k < 3; ++k) word = word << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k) out += i + k <= bytes.size() ? digits[word >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

template <class T>
std::string raw_bytes(const std::vector<T>& values) {
  std::string out(values.size() * sizeof(T), '\0');
  if (!out.empty()) std::memcpy(out.data(), values.data(), out.size());
  return out;
}

/// A document whose one buffer grows with what is put in.
struct GltfBuilder {
  json root = {{"asset", {{"version", "2.0"}}}};
  std::string bytes;

  int add(const char* key, json element) {
    root[key].push_back(std::move(element));
    return int(root[key].size()) - 1;
  }
  int view(const std::string& data, int stride = 0) {
    bytes.resize((bytes.size() + 3) / 4 * 4);
    json v = {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", data.size()}};
    if (stride) v["byteStride"] = stride;
    bytes += data;
    return add("bufferViews", v);
  }
  template <class T>
  int accessor(const std::vector<T>& values, const char* type, int component_type, size_t count,
               bool normalized = false) {
    json a = {
        {"bufferView", view(raw_bytes(values))}, {"type", type}, {"componentType", component_type}, {"count", count}};
    if (normalized) a["normalized"] = true;
    return add("accessors", a);
  }
  int vec3(const std::vector<float>& values) { return accessor(values, "VEC3", 5126, values.size() / 3); }
  int vec2(const std::vector<float>& values) { return accessor(values, "VEC2", 5126, values.size() / 2); }
  int index(const std::vector<uint16_t>& values) { return accessor(values, "SCALAR", 5123, values.size()); }
  /// A mesh of one primitive on a node of its own.
  int mesh(json primitive) {
    const int m = add("meshes", {{"primitives", {std::move(primitive)}}});
    add("nodes", {{"mesh", m}});
    return m;
  }

  /// The whole with its buffer as a data URI.
  [[nodiscard]] json document() const {
    json all = root;
    if (!bytes.empty())
      all["buffers"] = {
          {{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}}};
    return all;
  }
};

/// Three vertices of a right triangle in z = 0.
inline const std::vector<float> kTriangle{0, 0, 0, 1, 0, 0, 0, 1, 0};

struct Loaded {
  LoadedScene loaded;
  std::vector<std::string> warnings;
  [[nodiscard]] const Scene& scene() const { return loaded.scene; }
  [[nodiscard]] const TriangleMesh& part(size_t mesh = 0) const {
    return loaded.scene.geometry.meshes.at(mesh).parts.at(0);
  }
};

inline Loaded load_file(const std::filesystem::path& file) {
  Loaded result;
  result.loaded = load_gltf(file, [&](const std::string& text) { result.warnings.push_back(text); });
  return result;
}
inline Loaded load_json(const json& document) {
  const TemporaryFolder folder;
  return load_file(folder.write("scene.gltf", document.dump()));
}
inline Loaded load(const GltfBuilder& builder) { return load_json(builder.document()); }

/// What the loader says is wrong, after the file's name; empty if it loads.
inline std::string error_of_file(const std::filesystem::path& file) {
  try {
    (void)load_file(file);
    return {};
  } catch (const LoadError& error) {
    const std::string what = error.what(), name = file.string() + ": ";
    return what.starts_with(name) ? what.substr(name.size()) : "not named: " + what;
  }
}
inline std::string error_of(const json& document) {
  const TemporaryFolder folder;
  return error_of_file(folder.write("scene.gltf", document.dump()));
}

}  // namespace alhazen
