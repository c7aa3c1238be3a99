// Any analytic shape, and the verbs that all of them answer.
#pragma once

#include <variant>

#include "accel/shapes/sphere.h"

namespace alhazen {

using Shape = std::variant<Sphere>;

}  // namespace alhazen
