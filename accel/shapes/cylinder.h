// Cylinder, frustum or cone about the y axis, centred on the origin: a wall whose radius is linear in y, and two disks.
#pragma once

#include "accel/shapes/flat_face.h"
#include "accel/shapes/quadric_body.h"
#include "core/ray.h"

namespace alhazen {

struct Cylinder {
  double height = 1, radius_bottom = 0.5, radius_top = 0.5;  // one radius may be 0: a cone
  bool caps = true;                                          // with them, a closed body
};

/// The wall without caps: of one cylinder, or those of several lanes.
template <class N>
struct CylinderWall {
  N height, radius_bottom, radius_top;
};

/// A point of the wall nearly nearest to a point: the nearest at its height.
template <class N>
[[nodiscard]] Vec3<N> project(const CylinderWall<N>& wall, const Vec3<N>& p_object) {
  const N half = wall.height / N(2), distance = square_root(p_object.x * p_object.x + p_object.z * p_object.z);
  const N y = larger(-half, smaller(half, p_object.y));
  const N radius =  // exactly 0 at an apex
      wall.radius_top + (wall.radius_bottom - wall.radius_top) * ((half - y) / wall.height);
  // A hit beside an apex may round onto the axis; any point of the wall is as near then.
  const auto aside = distance > N(0);
  const N outward = radius / select(aside, distance, N(1));
  return {select(aside, p_object.x * outward, radius), y, select(aside, p_object.z * outward, N(0))};
}

/// Away from the axis; up or down at an apex, where there is no normal.
template <class N>
[[nodiscard]] Vec3<N> normal(const CylinderWall<N>& wall, const Vec3<N>& p_object) {
  const N distance = square_root(p_object.x * p_object.x + p_object.z * p_object.z);
  const N slope = (wall.radius_top - wall.radius_bottom) / wall.height;
  const auto aside = distance > N(0);
  const N length = select(aside, distance, N(1)), axial = select(slope < N(0), N(1), N(-1));
  return normalize(Vec3<N>{p_object.x / length, select(aside, N(-slope), axial), p_object.z / length});
}

/// x² + z² <= (m + k y)² for -height/2 <= y <= height/2. The planes in x and z touch nothing.
template <class N>
[[nodiscard]] QuadricBody<N> quadric_body(const Cylinder& cylinder) {
  const N h(cylinder.height), bottom(cylinder.radius_bottom), top(cylinder.radius_top);
  const N middle = (bottom + top) / 2, slope = (top - bottom) / h, half = h / 2, beyond = 2 * (bottom + top);
  QuadricBody<N> body;
  body.a = body.c = N(1);
  body.b = -(slope * slope), body.h = -(middle * slope), body.j = -(middle * middle);
  body.lower = Vec3<N>(N(-beyond), N(-half), N(-beyond)), body.upper = Vec3<N>(beyond, half, beyond);
  body.solid = cylinder.caps;
  return body;
}

/// With caps, where a line enters and leaves the body; without, its points of the wall. Faces 2 and 3 are the caps.
template <class T>
[[nodiscard]] LineCrossings<T> crossings(const Cylinder& cylinder, const ObjectLine<T>& line) {
  return body_crossings<BodyForm::revolution>(quadric_body<CoefficientOf<T>>(cylinder), line);
}
[[nodiscard]] std::vector<ExactCrossing> exact_crossings(const Cylinder& cylinder, const ExactLine& line);

[[nodiscard]] Bounds3d bounds(const Cylinder& cylinder) noexcept;
[[nodiscard]] std::optional<FlatFace<double>> flat_face(const Cylinder& cylinder, int face) noexcept;
[[nodiscard]] Vec3d project(const Cylinder& cylinder, const Vec3d& p_object, int face) noexcept;

/// Away from the axis on the wall (up at an apex, where there is no normal), along the axis on the caps.
[[nodiscard]] Vec3d normal(const Cylinder& cylinder, const Vec3d& p_object, int face) noexcept;

/// Wall: u = 0.5 + atan2(x, z) / 2π, v = 0.5 - y / height. Caps: u = 0.5 + x / 2R, v = 0.5 + z / 2R.
[[nodiscard]] Vec2f texture_coordinates(const Cylinder& cylinder, const Vec3d& p_object, int face) noexcept;
[[nodiscard]] Vec3d u_tangent(const Cylinder& cylinder, const Vec3d& p_object, int face) noexcept;

}  // namespace alhazen
