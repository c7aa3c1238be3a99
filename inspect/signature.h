// What can be said of scene signatures: which objects are seen, and where two signatures disagree.
#pragma once

#include <cstdint>
#include <vector>

#include "core/image.h"
#include "core/vec.h"

namespace alhazen {

/// How much of a signature shows one node.
struct SeenNode {
  uint32_t node;  // kNone: the background
  uint64_t pixels;
};

/// By ascending node, the background last.
[[nodiscard]] std::vector<SeenNode> seen_nodes(const IdImage& ids);

/// Where two signatures of one size disagree.
struct SignatureDiff {
  uint64_t nodes = 0;    // pixels that show different nodes
  uint64_t details = 0;  // pixels of the same node, but another primitive or material
  ColorImage picture;    // R, G, B, A, linear: the first signature faded, different nodes red, details yellow

  [[nodiscard]] bool empty() const { return nodes == 0 && details == 0; }
};
[[nodiscard]] SignatureDiff difference(const IdImage& ids, const IdImage& other);

/// `node_color`, linear.
[[nodiscard]] Rgb linear_node_color(uint32_t node) noexcept;

/// As `write_image` shows it in 8 bits: R, G, B, A, linear, a colour for each node.
[[nodiscard]] ColorImage node_picture(const IdImage& ids);

}  // namespace alhazen
