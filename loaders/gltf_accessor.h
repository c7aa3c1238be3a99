// The numbers in a glTF file's buffers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "loaders/gltf_buffer_views.h"

namespace alhazen {

/// Calls `f` with a value of the component type TINYGLTF_COMPONENT_TYPE_...
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
    case TINYGLTF_COMPONENT_TYPE_DOUBLE:
      return f(double{});
    default:
      return f(float{});
  }
}

[[nodiscard]] size_t component_size(int type);  // bytes

/// Any accessor, every byte of which was checked to lie in what holds it.
struct AccessorView {
  uint64_t count = 0;     // elements
  size_t components = 0;  // 1 to 16, matrices column by column
  size_t rows = 0;        // of a matrix; else as many as components
  int type = 0;           // TINYGLTF_COMPONENT_TYPE_...
  bool normalized = false;
  uint64_t stride = 0;                    // bytes from one element to the next
  const uint8_t* data = nullptr;          // null: zeros
  std::vector<uint32_t> replaced;         // sparse: which elements, increasing
  const uint8_t* replacements = nullptr;  // sparse: their values, tightly packed
  uint64_t replacement_stride = 0;        // bytes

  [[nodiscard]] bool is_unsigned_integer() const;
};

class GltfBuffers {
 public:
  /// Reads all buffers and checks all buffer views and accessors. Throws LoadError for a buffer that cannot be read or
  /// is too short, and for whatever lies outside of what holds it.
  explicit GltfBuffers(const GltfSource& source);

  [[nodiscard]] const AccessorView& accessor(int i) const { return accessors_[size_t(i)]; }
  [[nodiscard]] std::span<const uint8_t> buffer_view(int i) const { return views_[i]; }

 private:
  [[nodiscard]] AccessorView check_accessor(const JsonRef& r, const tinygltf::Model& model,
                                            const tinygltf::Accessor& a) const;
  void check_sparse(const JsonRef& r, const tinygltf::Accessor& a, AccessorView& view) const;

  GltfBufferViews views_;
  std::vector<AccessorView> accessors_;
};

/// The components of the given elements, one element after the other; integers normalised where the accessor says so.
[[nodiscard]] std::vector<float> floats(const AccessorView& accessor, std::span<const uint32_t> elements);
/// Of a scalar accessor of unsigned integers: all of them, never normalised.
[[nodiscard]] std::vector<uint32_t> indices(const AccessorView& accessor);
/// As many of them as `out` takes, from element `first` on.
void indices(const AccessorView& accessor, uint64_t first, std::span<uint32_t> out);

}  // namespace alhazen
