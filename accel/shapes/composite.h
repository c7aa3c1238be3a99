// Constructive solid geometry: union, intersection and difference of closed bodies, nested as one likes.
#pragma once

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "accel/line_map.h"
#include "accel/shapes/box.h"
#include "accel/shapes/cylinder.h"
#include "accel/shapes/quadric.h"
#include "accel/shapes/sphere.h"

namespace alhazen {

using ClosedBody = std::variant<Sphere, Cylinder, Box, Quadric>;  // cylinders with caps, solid quadrics

/// A leaf of the tree: a body and its place.
struct CompositeLeaf {
  ClosedBody body;
  std::vector<Affine3d> chain;  // composite from body, map after map, the outermost first; never empty
  LineMap<double> body_from_composite;
  bool reversed = false;    // subtracted an odd number of times: its surface faces the other way
  uint32_t twin = kNoTwin;  // the first leaf, if that is another one, with the same body in the same place

  static constexpr uint32_t kNoTwin = ~uint32_t{0};
};

/// A node of the tree. Children are consecutive: leaves where `count` is 0.
struct CompositeNode {
  enum class Operation : uint8_t { leaf, unite, intersect, subtract } operation = Operation::leaf;
  uint32_t first = 0;  // the first child's index in `nodes`, or the leaf's in `leaves`
  uint32_t count = 0;
};

/// The boundary of the result. Node 0 is the root.
struct Composite {
  std::vector<CompositeLeaf> leaves;
  std::vector<CompositeNode> nodes;
};

/// An operand: a closed body or another composite, and its place.
struct CompositeOperand {
  std::variant<ClosedBody, Composite> shape;
  Affine3d composite_from_operand;
};

/// `subtract` takes all operands but the first from the first.
[[nodiscard]] Composite make_composite(CompositeNode::Operation operation, std::span<const CompositeOperand> operands);

/// Composites cross a line any number of times; a face is 8 x leaf + the body's face.
inline constexpr int kFacesPerLeaf = 8;
template <class T>
struct CompositeCrossing {
  T t, error;
  int face;
};

/// Appends where the line enters and leaves, in turns, ascending. False where it is doubtful. T: double or Quad.
template <class T>
[[nodiscard]] bool append_crossings(const Composite& composite, const ObjectLine<T>& line,
                                    std::vector<CompositeCrossing<T>>& out);

/// Exactly. Surfaces that coincide are crossed at once, and count where inside and outside change over by all of them.
[[nodiscard]] std::vector<ExactCrossing> exact_crossings(const Composite& composite, const ExactLine& line);

[[nodiscard]] Bounds3d bounds(const Composite& composite) noexcept;
[[nodiscard]] Vec3d project(const Composite& composite, const Vec3d& p_object, int face) noexcept;
[[nodiscard]] Vec3d normal(const Composite& composite, const Vec3d& p_object, int face) noexcept;
[[nodiscard]] Vec2f texture_coordinates(const Composite& composite, const Vec3d& p_object, int face) noexcept;
[[nodiscard]] Vec3d u_tangent(const Composite& composite, const Vec3d& p_object, int face) noexcept;

}  // namespace alhazen
