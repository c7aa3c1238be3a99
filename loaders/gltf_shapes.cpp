#include "loaders/gltf_shapes.h"

#include <algorithm>
#include <string>
#include <utility>

namespace alhazen {
namespace {

/// One row for each kind of shape: its key, what its fields have to be, and what they make.
struct Kind {
  std::string key;
  Check fields;
  Shape (*read)(const JsonRef& fields);  // may throw LoadError for what no single field can be blamed for
};

Shape read_sphere(const JsonRef& r) { return Sphere{r.get("radius", 1.0f)}; }

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all{
      {"sphere", closed_object({{"radius", number_above(0)}}), read_sphere},
  };
  return all;
}

const Kind* find_kind(const std::string& key) {
  const auto at = std::find_if(kinds().begin(), kinds().end(), [&](const Kind& k) { return k.key == key; });
  return at == kinds().end() ? nullptr : &*at;
}

/// The keys of a shape that are not glTF's own.
std::vector<std::string> kind_keys(const JsonRef& shape) {
  std::vector<std::string> keys;
  for (const auto& item : shape.value().items())
    if (item.key() != "name" && item.key() != "extensions" && item.key() != "extras") keys.push_back(item.key());
  return keys;
}

std::string known_keys() {
  std::string keys;
  for (const Kind& kind : kinds()) keys += (keys.empty() ? "" : ", ") + kind.key;
  return keys;
}

void check_shape(const JsonRef& r) {
  object({{"name", text()}})(r);
  const std::vector<std::string> keys = kind_keys(r);
  for (const std::string& key : keys)
    if (!find_kind(key)) r.fail("unknown shape \"" + key + "\", expected one of " + known_keys());
  if (keys.size() != 1) r.fail("found " + std::to_string(keys.size()) + " shapes, expected one of " + known_keys());
  find_kind(keys[0])->fields(r[keys[0]]);
}

}  // namespace

Check shape_description() { return check_shape; }

std::vector<Shape> read_shapes(const JsonRef& extension) {
  std::vector<Shape> shapes;
  for (const JsonRef& r : extension.elements("shapes")) {
    const std::string key = kind_keys(r)[0];
    shapes.push_back(find_kind(key)->read(r[key]));
  }
  return shapes;
}

}  // namespace alhazen
