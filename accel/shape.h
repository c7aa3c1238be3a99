// Any analytic shape, and the verbs that all of them answer.
//
//   crossings<T>(shape, line)        where a line meets it (composites: append_crossings)
//   exact_crossings(shape, line)     the same, exactly
//   bounds(shape)                    a box around it
//   project, normal, texture_coordinates, u_tangent (shape, p_object, face)
//   flat_face(shape, face)           the plane of a face across an axis
#pragma once

#include <variant>

#include "accel/shapes/box.h"
#include "accel/shapes/composite.h"
#include "accel/shapes/cylinder.h"
#include "accel/shapes/disk.h"
#include "accel/shapes/polygon.h"
#include "accel/shapes/quadric.h"
#include "accel/shapes/sphere.h"

namespace alhazen {

using Shape = std::variant<Sphere, Cylinder, Disk, Box, Polygon, Quadric, Composite>;

}  // namespace alhazen
