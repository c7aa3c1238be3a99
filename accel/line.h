// A line as a shape sees it, and where the line crosses the shape: the common language of all closed forms.
//
// Closed forms are written once for several number types T (core/real.h): lanes of doubles inside packets, double for
// single rays, binary128 where double leaves a doubt. What even that cannot decide goes to exact arithmetic.
#pragma once

#include <array>
#include <type_traits>

#include "core/real.h"
#include "core/vec.h"
#include "exact/surd.h"

namespace alhazen {

/// The points origin + t direction in a shape's own space. Rounded: the exact line's components lie within the errors.
template <class T>
struct ObjectLine {
  Vec3<T> origin, direction;
  Vec3<T> origin_error, direction_error;  // absolute, >= 0
};

/// The point of the line at `t`, a number taken as exact, as the origin of another line.
template <class T>
ObjectLine<T> moved_origin(const ObjectLine<T>& line, const T& t) {
  const double u = kUnitRoundoff<T>;
  ObjectLine<T> moved = line;
  const T size = absolute(t);
  const auto axis = [&](const T& o, const T& d, const T& oe, const T& de, T& p, T& pe) {
    p = o + t * d;
    pe = oe + size * (de + absolute(d) * (2.1 * u)) + absolute(o) * (1.1 * u);  // a product, a sum
  };
  axis(line.origin.x, line.direction.x, line.origin_error.x, line.direction_error.x, moved.origin.x,
       moved.origin_error.x);
  axis(line.origin.y, line.direction.y, line.origin_error.y, line.direction_error.y, moved.origin.y,
       moved.origin_error.y);
  axis(line.origin.z, line.direction.z, line.origin_error.z, line.direction_error.z, moved.origin.z,
       moved.origin_error.z);
  return moved;
}

/// Which part of a shape's surface: 2 axis + side for the planes of a box (side 1: the upper), or the curved wall.
inline constexpr int kWallFace = 6;

/// Parameters at which a line crosses a surface, ascending, at most four. The exact parameter lies within `error`.
/// A closed body is entered and left in turns. Where `doubtful`, the rest means nothing: ask a wider number type.
template <class T>
struct LineCrossings {
  struct Crossing {
    T t{}, error{};
    T face{};  // an integer
    MaskOf<T> present{false};
  };
  std::array<Crossing, 4> at;
  MaskOf<T> doubtful{false};
};

/// One place where a line enters or leaves, exactly: what `exact_crossings` of a shape lists, ascending.
struct ExactCrossing {
  Surd t;
  int face = kWallFace;
};

/// As accurate as a parameter must be to be rounded to float: error bounds of 2^-34 relative. True errors are mostly
/// below a tenth of their bounds, so that even the worst that pass round to the wrong side less than once in 2^12.
inline constexpr double kParameterAccuracy = 0x1p-34;

}  // namespace alhazen
