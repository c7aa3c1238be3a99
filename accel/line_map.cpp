#include "accel/line_map.h"

#include <cmath>

namespace alhazen {
namespace {

template <class N>
Vec3<N> magnitudes(const Vec3<N>& v) {
  return {absolute(v.x), absolute(v.y), absolute(v.z)};
}

/// cross(|a|, |b|) with sums in place of differences: what the rounding of cross(a, b) is relative to.
template <class N>
Vec3<N> cross_magnitude(const Vec3<N>& a, const Vec3<N>& b) {
  const Vec3<N> p = magnitudes(a), q = magnitudes(b);
  return {p.y * q.z + p.z * q.y, p.z * q.x + p.x * q.z, p.x * q.y + p.y * q.x};
}

/// One entry, a power of two: multiplying by the row does not round, and its inverse was found without rounding.
template <class N>
bool is_exact(const Vec3<N>& row) {
  int entries = 0;
  for (int axis = 0; axis < 3; ++axis) {
    int exponent;
    if (const double entry = double(row[axis]); entry != 0)
      entries += std::abs(std::frexp(entry, &exponent)) == 0.5 && N(entry) == row[axis] ? 1 : 2;
  }
  return entries == 1;
}

template <class N>
N sum(const Vec3<N>& v) {
  return v.x + v.y + v.z;
}

/// By cofactors. `entry_error`: absolute, of the linear part's entries.
template <class N>
LineMap<N> inverted(const Affine3<N>& m, N entry_error) {
  const double u = kUnitRoundoff<N>;
  const Vec3<N> cx = cross(m.y, m.z), cy = cross(m.z, m.x), cz = cross(m.x, m.y);
  const Vec3<N> ex = cross_magnitude(m.y, m.z), ey = cross_magnitude(m.z, m.x), ez = cross_magnitude(m.x, m.y);
  const N det = dot(m.x, cx), det_error = dot(magnitudes(m.x), ex) * N(8 * u);
  const N size = absolute(det), det_relative = det_error / size;
  LineMap<N> map{cx / det, cy / det, cz / det, m.origin, {}, {}};
  const bool map_is_exact = entry_error == 0 && is_exact(map.row_x) && is_exact(map.row_y) && is_exact(map.row_z);
  const N columns = sum(magnitudes(map.row_x)) + sum(magnitudes(map.row_y)) + sum(magnitudes(map.row_z));
  // A row's own error for each unit of the vector; a subtraction, a rounded row and a sum of three products on top.
  const auto relative = [&](const Vec3<N>& row, const Vec3<N>& e) {
    const N row_size = sum(magnitudes(row));
    if (map_is_exact) return row_size * N(u);
    const N row_error =
        (sum(e) * N(4 * u) / size + row_size * det_relative) * N(1.25) + row_size * entry_error * columns * 2;
    return row_error + row_size * N(6 * u);
  };
  map.relative_error = {relative(map.row_x, ex), relative(map.row_y, ey), relative(map.row_z, ez)};
  const N inf = N(HUGE_VAL);
  if (!(det_relative < N(0.125))) map.relative_error = {inf, inf, inf};  // everything is doubtful
  return map;
}

double max_entry(const Affine3d& m) {
  return std::max(max_component(abs(m.x)), std::max(max_component(abs(m.y)), max_component(abs(m.z))));
}

}  // namespace

LineMap<double> line_map(const Affine3d& world_from_object) { return inverted(world_from_object, 0.0); }

LineMap<Quad> quad_line_map(std::span<const Affine3d> chain) {
  const Affine3d& first = chain.front();
  if (chain.size() == 1 && first == Affine3d{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, first.origin}) {  // quickly done
    const Quad u = kUnitRoundoff<Quad>;
    return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, Vec3<Quad>(first.origin), {u, u, u}, {}};
  }
  Affine3<Quad> product(chain.front());
  Quad entries = max_entry(chain.front()), origins = max_component(abs(chain.front().origin));
  for (const Affine3d& inner : chain.subspan(1)) {
    product = product * Affine3<Quad>(inner);
    origins = origins + entries * 3 * Quad(max_component(abs(inner.origin)));
    entries = entries * 3 * Quad(max_entry(inner));
  }
  const Quad rounding = chain.size() > 1 ? Quad(8 * kUnitRoundoff<Quad>) * Quad(double(chain.size())) : Quad(0);
  LineMap<Quad> map = inverted(product, entries * rounding);
  const Quad center_error = origins * rounding;
  const auto mapped = [&](const Vec3<Quad>& row, Quad relative) {
    return (sum(magnitudes(row)) + relative) * center_error;
  };
  map.origin_error = {mapped(map.row_x, map.relative_error.x), mapped(map.row_y, map.relative_error.y),
                      mapped(map.row_z, map.relative_error.z)};
  return map;
}

LineMap<double> line_map(std::span<const Affine3d> chain) {
  if (chain.size() == 1) return line_map(chain.front());
  const LineMap<Quad> fine = quad_line_map(chain);
  LineMap<double> map{Vec3d(fine.row_x),  Vec3d(fine.row_y),          Vec3d(fine.row_z),
                      Vec3d(fine.center), Vec3d(fine.relative_error), Vec3d(fine.origin_error)};
  // What rounding the rows and the centre costs, and the sums in double.
  const double u = kUnitRoundoff<double>;
  const Vec3d rows{sum(abs(map.row_x)), sum(abs(map.row_y)), sum(abs(map.row_z))}, lost = abs(map.center) * u;
  const Vec3d cost{dot(abs(map.row_x), lost), dot(abs(map.row_y), lost), dot(abs(map.row_z), lost)};
  map.relative_error = map.relative_error * 1.01 + rows * (6 * u);
  map.origin_error = (map.origin_error + cost) * 1.01;
  return map;
}

ExactLine exact_line(const Rayf& ray_world) {
  return {exact(Vec3d(ray_world.origin)), exact(Vec3d(ray_world.direction))};
}

ExactLine exact_line(std::span<const Affine3d> chain, const ExactLine& outer) {
  ExactLine line = outer;
  const auto product = [](const Vec3<Rational>& a, const Vec3<Rational>& b) {
    return Rational(a.x * b.x + a.y * b.y + a.z * b.z);
  };
  const auto crossed = [](const Vec3<Rational>& a, const Vec3<Rational>& b) -> Vec3<Rational> {
    return {Rational(a.y * b.z - a.z * b.y), Rational(a.z * b.x - a.x * b.z), Rational(a.x * b.y - a.y * b.x)};
  };
  for (const Affine3d& m : chain) {
    if (m == Affine3d{}) continue;
    const Vec3<Rational> x = exact(m.x), y = exact(m.y), z = exact(m.z), origin = exact(m.origin);
    const Vec3<Rational> cx = crossed(y, z), cy = crossed(z, x), cz = crossed(x, y);
    const Rational det = product(x, cx);
    const auto apply = [&](const Vec3<Rational>& v) -> Vec3<Rational> {
      return {Rational(product(cx, v) / det), Rational(product(cy, v) / det), Rational(product(cz, v) / det)};
    };
    const Vec3<Rational> from_center{Rational(line.origin.x - origin.x), Rational(line.origin.y - origin.y),
                                     Rational(line.origin.z - origin.z)};
    line = {apply(from_center), apply(line.direction)};
  }
  return line;
}

}  // namespace alhazen
