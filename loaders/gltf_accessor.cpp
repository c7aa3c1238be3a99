#include "loaders/gltf_accessor.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>

#include "loaders/gltf_uri.h"

namespace alhazen {
namespace {

constexpr uint64_t kMaxZeros = uint64_t{1} << 24;  // elements of an accessor that no bytes stand behind

/// Calls `f` with a value of the component type.
template <class F>
auto with_component_type(int type, F&& f) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return f(int8_t{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return f(uint8_t{});
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return f(int16_t{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return f(uint16_t{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return f(uint32_t{});
    default:
      return f(float{});
  }
}

size_t component_size(int type) {
  return with_component_type(type, [](auto c) { return sizeof c; });
}

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
  if constexpr (std::is_floating_point_v<T>) return value;
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

Bytes read_external(const JsonRef& uri, const GltfDocument& document) {
  auto bytes = resolve_uri(uri, document.folder);
  if (!bytes) uri.fail("cannot read `" + uri.as<std::string>().substr(0, 80) + "`");
  return std::move(*bytes);
}

std::span<const uint8_t> cut_to_length(const JsonRef& r, std::span<const uint8_t> all) {
  const auto length = r["byteLength"].as<uint64_t>();
  if (all.size() < length)
    r["byteLength"].fail("expected " + bytes_text(length) + ", the buffer has " + bytes_text(all.size()));
  return all.first(length);
}

std::span<const uint8_t> cut_view(const JsonRef& r, std::span<const uint8_t> buffer, const tinygltf::BufferView& v) {
  if (v.byteOffset > buffer.size() || v.byteLength > buffer.size() - v.byteOffset)
    r.fail(bytes_text(v.byteLength) + " from byte " + std::to_string(v.byteOffset) + " on exceed the buffer's " +
           bytes_text(buffer.size()));
  return buffer.subspan(v.byteOffset, v.byteLength);
}

}  // namespace

bool AccessorView::is_unsigned_integer() const {
  return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

GltfBuffers::GltfBuffers(const GltfSource& source) {
  const auto buffers = source.root().elements("buffers");
  owned_.resize(buffers.size());
  for (size_t i = 0; i < buffers.size(); ++i) {
    const JsonRef& r = buffers[i];
    const bool in_glb = i == 0 && !r.has("uri") && source.document.bin;
    if (!r.has("uri") && !in_glb) r.fail("`uri` is missing, and the file has no GLB chunk for this buffer");
    if (!in_glb) owned_[i] = read_external(r["uri"], source.document);
    buffers_.push_back(cut_to_length(r, in_glb ? *source.document.bin : std::span<const uint8_t>(owned_[i])));
    bytes_ += buffers_.back().size();
  }
  const tinygltf::Model& model = source.model;
  for (size_t i = 0; i < size_t(zeros_view(model)); ++i) {
    const tinygltf::BufferView& view = model.bufferViews[i];
    views_.push_back(cut_view(source.at("bufferViews", i), buffers_[size_t(view.buffer)], view));
  }
  for (size_t i = 0; i < model.accessors.size(); ++i)
    accessors_.push_back(check_accessor(source.at("accessors", i), model, model.accessors[i]));
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
  if (a.bufferView == zeros_view(model)) {
    if (a.count > kMaxZeros) r["count"].expected("at most " + std::to_string(kMaxZeros) + " without a bufferView");
  } else {
    if (const size_t stride = model.bufferViews[size_t(a.bufferView)].byteStride) view.stride = stride;
    if (view.stride < layout.used())
      r.fail("elements of " + bytes_text(layout.used()) + " overlap, the buffer view's byteStride is " +
             std::to_string(view.stride));
    view.data = elements_in(r, buffer_view(a.bufferView), a.byteOffset, a.count, view.stride, layout.used());
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
  replaced.data = elements_in(r["indices"], buffer_view(a.sparse.indices.bufferView),
                              uint64_t(a.sparse.indices.byteOffset), count, replaced.stride, replaced.stride);
  view.replaced = indices(replaced);
  const ElementLayout layout = layout_of(view);
  view.replacement_stride = layout.padded();
  view.replacements = elements_in(r["values"], buffer_view(a.sparse.values.bufferView),
                                  uint64_t(a.sparse.values.byteOffset), count, layout.padded(), layout.used());
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
  with_component_type(a.type, [&](auto c) {
    for (uint32_t i = 0; i < a.count; ++i)
      if (const uint8_t* from = element(a, i)) out[i] = uint32_t(load<decltype(c)>(from));
  });
  return out;
}

}  // namespace alhazen
