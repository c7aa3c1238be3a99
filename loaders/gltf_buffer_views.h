// The bytes of a glTF file: its buffers, and what its buffer views show of them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "loaders/gltf_source.h"

namespace alhazen {

class GltfBufferViews {
 public:
  /// Reads the buffers that a view needs, cuts the views, and decodes the compressed ones, in parallel. Buffers that
  /// only stand in for what is compressed are not read and need not be there. Throws LoadError for a buffer that cannot
  /// be read or is too short, for views that lie outside of it, and for streams that cannot be decoded.
  explicit GltfBufferViews(const GltfSource& source);

  [[nodiscard]] std::span<const uint8_t> operator[](int view) const { return views_[size_t(view)]; }

 private:
  void read_buffers(const GltfSource& source);
  [[nodiscard]] std::span<const uint8_t> cut(const JsonRef& view) const;
  void decode(const std::vector<JsonRef>& views, LoadBudget& budget);

  std::vector<Bytes> owned_, decoded_;
  std::vector<std::span<const uint8_t>> buffers_, views_;
};

}  // namespace alhazen
