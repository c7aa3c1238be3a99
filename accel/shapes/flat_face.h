// Faces that are flat across an axis of their shape's space: those of boxes and disks, and caps.
#pragma once

#include <optional>

#include "core/lane_vec.h"

namespace alhazen {

/// Of one face, or those of several lanes.
template <class N>
struct FlatFace {
  N axis;        // 0, 1 or 2
  N coordinate;  // along it
  N side;        // 1 or -1: where the normal points along it
};

/// As faces of boxes are numbered: 2 axis + side, side 1 being the upper.
[[nodiscard]] inline FlatFace<double> flat_face(int face, double coordinate) {
  return {double(face / 2), coordinate, face & 1 ? 1.0 : -1.0};
}

/// A face of a shape, where it is one of these: shapes that have some answer for themselves.
template <class Shape>
[[nodiscard]] std::optional<FlatFace<double>> flat_face(const Shape&, int) {
  return {};
}

template <class N>
[[nodiscard]] Vec3<N> project(const FlatFace<N>& face, const Vec3<N>& p_object) {
  const auto put = [&](int axis, const N& x) { return select(face.axis == N(axis), face.coordinate, x); };
  return {put(0, p_object.x), put(1, p_object.y), put(2, p_object.z)};
}

template <class N>
[[nodiscard]] Vec3<N> normal(const FlatFace<N>& face) {
  const auto along = [&](int axis) { return select(face.axis == N(axis), face.side, N(0)); };
  return {along(0), along(1), along(2)};
}

}  // namespace alhazen
