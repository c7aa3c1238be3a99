#include "loaders/gltf_accessor.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <set>
#include <type_traits>

namespace alhazen {
namespace {

constexpr uint64_t kMaxZeros = uint64_t{1} << 24;  // elements of an accessor that no bytes stand behind

/// Where the components of an element lie. Columns of matrices begin at multiples of 4 bytes.
struct ElementLayout {
  size_t components, rows, size;  // size: bytes of a component

  [[nodiscard]] size_t column() const { return rows == components ? rows * size : (rows * size + 3) / 4 * 4; }
  [[nodiscard]] size_t offset(size_t k) const { return k / rows * column() + k % rows * size; }
  [[nodiscard]] size_t used() const { return offset(components - 1) + size; }  // bytes, without trailing padding
  [[nodiscard]] size_t padded() const { return components / rows * column(); }
};

ElementLayout layout_of(const AccessorView& a) { return {a.components, a.rows, component_size(a.type)}; }

size_t rows_of(int type, size_t components) {
  return type == TINYGLTF_TYPE_MAT2 ? 2 : type == TINYGLTF_TYPE_MAT3 ? 3 : type == TINYGLTF_TYPE_MAT4 ? 4 : components;
}

template <class T>
float to_float(T value, bool normalized) {
  if constexpr (std::is_floating_point_v<T>) return float(value);
  if (!normalized) return float(value);
  return float(std::max(double(value) / double(std::numeric_limits<T>::max()), -1.0));
}

template <class T>
T load(const uint8_t* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

/// Where element i lies; null: zeros.
const uint8_t* element(const AccessorView& a, uint32_t i) {
  if (!a.replaced.empty()) {
    const auto at = std::lower_bound(a.replaced.begin(), a.replaced.end(), i);
    if (at != a.replaced.end() && *at == i)
      return a.replacements + uint64_t(at - a.replaced.begin()) * a.replacement_stride;
  }
  return a.data ? a.data + i * a.stride : nullptr;
}

// ---- Checks ----

std::string bytes_text(uint64_t n) { return std::to_string(n) + (n == 1 ? " byte" : " bytes"); }

/// Where `count` (> 0) elements begin, after the check that all lie in the buffer view.
const uint8_t* elements_in(const JsonRef& r, std::span<const uint8_t> view, uint64_t offset, uint64_t count,
                           uint64_t stride, uint64_t used) {
  const bool inside =
      offset <= view.size() && used <= view.size() - offset && count - 1 <= (view.size() - offset - used) / stride;
  if (!inside)
    r.fail(std::to_string(count) + " elements, " + bytes_text(stride) + " apart from byte " + std::to_string(offset) +
           " on, exceed the buffer view's " + bytes_text(view.size()));
  return view.data() + offset;
}

/// The accessors whose numbers a Draco stream holds instead of a buffer view.
std::set<int> draco_accessors(const GltfSource& source) {
  std::set<int> all;
  for (const JsonRef& mesh : source.root().elements("meshes"))
    for (const JsonRef& primitive : mesh.elements("primitives")) {
      const auto draco = primitive.extension("KHR_draco_mesh_compression");
      if (!draco) continue;
      if (const auto index = primitive.find("indices")) all.insert(index->as<int>());
      for (const auto& item : (*draco)["attributes"].value().items())
        if (const auto at = primitive["attributes"].find(item.key())) all.insert(at->as<int>());
    }
  return all;
}

}  // namespace

size_t component_size(int type) {
  return with_component_type(type, [](auto c) { return sizeof c; });
}

bool AccessorView::is_unsigned_integer() const {
  return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

GltfBuffers::GltfBuffers(const GltfSource& source) : views_(source) {
  const tinygltf::Model& model = source.model;
  const std::set<int> elsewhere = draco_accessors(source);
  for (size_t i = 0; i < model.accessors.size(); ++i) {
    const JsonRef r = source.at("accessors", i);
    if (model.accessors[i].sparse.isSparse)
      source.budget->take(r, uint64_t(model.accessors[i].sparse.count), sizeof(uint32_t));
    accessors_.push_back(check_accessor(r, model, model.accessors[i]));
    if (!accessors_.back().data && accessors_.back().count > kMaxZeros && !elsewhere.contains(int(i)))
      r["count"].expected("at most " + std::to_string(kMaxZeros) + " without a bufferView");
  }
}

AccessorView GltfBuffers::check_accessor(const JsonRef& r, const tinygltf::Model& model,
                                         const tinygltf::Accessor& a) const {
  AccessorView view;
  view.count = a.count;
  view.components = size_t(tinygltf::GetNumComponentsInType(uint32_t(a.type)));
  view.rows = rows_of(a.type, view.components);
  view.type = a.componentType;
  view.normalized = a.normalized;
  const ElementLayout layout = layout_of(view);
  view.stride = layout.padded();
  if (a.bufferView != zeros_view(model)) {
    if (const size_t stride = model.bufferViews[size_t(a.bufferView)].byteStride) view.stride = stride;
    if (view.stride < layout.used())
      r.fail("elements of " + bytes_text(layout.used()) + " overlap, the buffer view's byteStride is " +
             std::to_string(view.stride));
    view.data = elements_in(r, views_[a.bufferView], a.byteOffset, a.count, view.stride, layout.used());
  }
  if (a.sparse.isSparse) check_sparse(r["sparse"], a, view);
  return view;
}

void GltfBuffers::check_sparse(const JsonRef& r, const tinygltf::Accessor& a, AccessorView& view) const {
  const auto count = uint64_t(a.sparse.count);
  if (count > a.count) r["count"].expected("at most the accessor's count of " + std::to_string(a.count));
  AccessorView replaced;
  replaced.count = count;
  replaced.components = replaced.rows = 1;
  replaced.type = a.sparse.indices.componentType;
  replaced.stride = component_size(replaced.type);
  replaced.data = elements_in(r["indices"], views_[a.sparse.indices.bufferView], uint64_t(a.sparse.indices.byteOffset),
                              count, replaced.stride, replaced.stride);
  view.replaced = indices(replaced);
  const ElementLayout layout = layout_of(view);
  view.replacement_stride = layout.padded();
  view.replacements = elements_in(r["values"], views_[a.sparse.values.bufferView], uint64_t(a.sparse.values.byteOffset),
                                  count, layout.padded(), layout.used());
  for (size_t i = 0; i < view.replaced.size(); ++i) {
    if (view.replaced[i] >= a.count)
      r["indices"].fail("index " + std::to_string(view.replaced[i]) + " out of range, the accessor has " +
                        std::to_string(a.count) + " elements");
    if (i > 0 && view.replaced[i] <= view.replaced[i - 1])
      r["indices"].fail("expected increasing indices, found " + std::to_string(view.replaced[i - 1]) + " before " +
                        std::to_string(view.replaced[i]));
  }
}

std::vector<float> floats(const AccessorView& a, std::span<const uint32_t> elements) {
  const ElementLayout layout = layout_of(a);
  std::vector<float> out(elements.size() * a.components);
  const size_t bytes = a.components * sizeof(float);
  if (a.type == TINYGLTF_COMPONENT_TYPE_FLOAT && a.data && a.replaced.empty() && layout.used() == bytes) {
    for (size_t i = 0; i < elements.size(); ++i)
      std::memcpy(&out[i * a.components], a.data + elements[i] * a.stride, bytes);
    return out;
  }
  with_component_type(a.type, [&](auto c) {
    for (size_t i = 0; i < elements.size(); ++i) {
      const uint8_t* from = element(a, elements[i]);
      for (size_t k = 0; from && k < a.components; ++k)
        out[i * a.components + k] = to_float(load<decltype(c)>(from + layout.offset(k)), a.normalized);
    }
  });
  return out;
}

std::vector<uint32_t> indices(const AccessorView& a) {
  std::vector<uint32_t> out(a.count);
  indices(a, 0, out);
  return out;
}

void indices(const AccessorView& a, uint64_t first, std::span<uint32_t> out) {
  if (out.empty()) return;
  const bool packed = a.data && a.replaced.empty() && a.stride == sizeof(uint32_t);
  if (packed && a.type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
    return void(std::memcpy(out.data(), a.data + first * sizeof(uint32_t), out.size_bytes()));
  with_component_type(a.type, [&](auto c) {
    for (size_t i = 0; i < out.size(); ++i) {
      const uint8_t* from = element(a, uint32_t(first + i));
      out[i] = from ? uint32_t(load<decltype(c)>(from)) : 0;
    }
  });
}

}  // namespace alhazen
