#include "accel/shapes/polygon.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <sstream>
#include <type_traits>

namespace alhazen {
namespace {

/// Products below this may have lost digits to underflow: no bound may be smaller.
constexpr double kUnderflow = 0x1p-800;
constexpr size_t kEdgesOfOneStrip = 64;  // so few are faster looked at than looked up

using ExactVec = Vec3<Rational>;

using Integer = mpz_class;
using IntegerVec = Vec3<Integer>;

template <class N>
bool is_zero(const Vec3<N>& a) {
  return sgn(a.x) == 0 && sgn(a.y) == 0 && sgn(a.z) == 0;
}

/// `v` in the cyclic order that puts `last_axis` last, and back.
template <class T>
Vec3<T> to_plane_axes(const Vec3<T>& v, int last_axis) {
  return last_axis == 0 ? Vec3<T>{v.y, v.z, v.x} : last_axis == 1 ? Vec3<T>{v.z, v.x, v.y} : v;
}
template <class T>
Vec3<T> from_plane_axes(const Vec3<T>& v, int last_axis) {
  return last_axis == 0 ? Vec3<T>{v.z, v.x, v.y} : last_axis == 1 ? Vec3<T>{v.y, v.z, v.x} : v;
}

// ---- making a polygon

using Loops = std::vector<std::vector<Vec3d>>;

/// x 2^bits as it is, a number without places after the point.
Integer scaled(double x, int bits) {
  int exponent = 0;
  const Integer mantissa(std::ldexp(std::frexp(x, &exponent), 53));
  const int shift = exponent - 53 + bits;
  return shift >= 0 ? Integer(mantissa << mp_bitcnt_t(shift)) : Integer(mantissa >> mp_bitcnt_t(-shift));
}

/// Loops as integers, in units of 2^-bits: exact, and much faster than rationals.
struct IntegerLoops {
  std::vector<std::vector<IntegerVec>> loops;
  int bits = 0;

  explicit IntegerLoops(const Loops& rounded) : loops(rounded.size()) {
    const auto places = [](double x) { return x == 0 ? 0 : 52 - std::ilogb(x); };
    for (const auto& loop : rounded)
      for (const Vec3d& p : loop) bits = std::max({bits, places(p.x), places(p.y), places(p.z)});
    for (size_t i = 0; i < loops.size(); ++i)
      for (const Vec3d& p : rounded[i]) loops[i].push_back({scaled(p.x, bits), scaled(p.y, bits), scaled(p.z, bits)});
  }

  [[nodiscard]] Rational from_units(const Rational& in_units) const {
    Rational out = in_units;
    mpq_div_2exp(out.get_mpq_t(), out.get_mpq_t(), mp_bitcnt_t(bits));
    return out;
  }
};

/// That the loop has three points which are not on one line.
void check_loop(const std::vector<IntegerVec>& loop, size_t index) {
  const auto differs = [&](const IntegerVec& p) { return !(p == loop.front()); };
  const auto second = std::find_if(loop.begin(), loop.end(), differs);
  const auto third = std::find_if(second, loop.end(), [&](const auto& p) { return differs(p) && !(p == *second); });
  if (third == loop.end()) {
    const int distinct = loop.empty() ? 0 : second == loop.end() ? 1 : 2;
    throw PolygonError(index, "expected 3 or more distinct points, found " + std::to_string(distinct));
  }
  const IntegerVec origin = loop.front(), along = *second - origin;
  if (std::all_of(third, loop.end(), [&](const IntegerVec& p) { return is_zero(cross(along, p - origin)); }))
    throw PolygonError(index, "expected points that enclose an area, found all of them on one line");
}

/// Twice the loop's vector area.
IntegerVec newell_normal(const std::vector<IntegerVec>& loop) {
  IntegerVec normal, previous = loop.back() - loop.front();
  for (const IntegerVec& p : loop) {
    const IntegerVec next = p - loop.front();
    normal += cross(previous, next);
    previous = next;
  }
  if (is_zero(normal))
    throw PolygonError(0, "expected a loop that turns more to one side than to the other, found a Newell normal of 0");
  return normal;
}

IntegerVec sum(const std::vector<IntegerVec>& points) {
  IntegerVec total;
  for (const IntegerVec& p : points) total += p;
  return total;
}

/// The mean of the first loop's vertices.
ExactVec mean_point(const IntegerLoops& exactly) {
  const IntegerVec total = sum(exactly.loops[0]);
  const auto mean = [&](const Integer& x) { return exactly.from_units(Rational(x) / exactly.loops[0].size()); };
  return {mean(total.x), mean(total.y), mean(total.z)};
}

/// The first of the axes along which `normal` is largest.
int largest_axis(const IntegerVec& normal) {
  const Integer x = abs(normal.x), y = abs(normal.y), z = abs(normal.z);
  return x >= y && x >= z ? 0 : y >= z ? 1 : 2;
}

Rational longest_side(const Loops& loops) {
  Bounds3d box;
  for (const auto& loop : loops)
    for (const Vec3d& p : loop) extend(box, p);
  const ExactVec size = exact(box.upper) - exact(box.lower);
  return std::max(size.x, std::max(size.y, size.z));
}

/// That no vertex is too far from the plane through the mean of the first loop's vertices.
void check_planar(const Loops& rounded, const IntegerLoops& exactly, const IntegerVec& normal) {
  const Rational planarity(1, 10000), reach = longest_side(rounded) * planarity;
  const Integer count = exactly.loops[0].size(), squared_normal = dot(normal, normal);
  const Integer mean_height = dot(normal, sum(exactly.loops[0]));  // times count
  // Of a height times |normal|, times count, in units.
  Rational limit = reach * reach * squared_normal * count * count;
  mpq_mul_2exp(limit.get_mpq_t(), limit.get_mpq_t(), 2 * mp_bitcnt_t(exactly.bits));
  const Integer squared_limit = limit.get_num() / limit.get_den();
  for (size_t i = 0; i < rounded.size(); ++i)
    for (size_t k = 0; k < rounded[i].size(); ++k) {
      const Integer height = dot(normal, exactly.loops[i][k]) * count - mean_height, squared = height * height;
      if (squared <= squared_limit) continue;
      const Rational ratio = Rational(squared) / limit;
      const Vec3d& p = rounded[i][k];
      std::ostringstream reason;
      reason << "expected vertices within " << planarity.get_d() << " of the longest side, " << reach.get_d()
             << ", from the plane, found [" << p.x << ", " << p.y << ", " << p.z << "] at a distance of "
             << reach.get_d() * std::sqrt(ratio.get_d());
      throw PolygonError(i, reason.str());
    }
}

void set_plane(Polygon& polygon, const ExactVec& point, const IntegerVec& normal) {
  const int axis = largest_axis(normal);
  const IntegerVec n = to_plane_axes(normal, axis);
  polygon.dropped_axis = axis;
  polygon.center = {point.x.get_d(), point.y.get_d(), point.z.get_d()};
  const ExactVec p = to_plane_axes(point - exact(polygon.center), axis);
  HeightPlane<Rational>& plane = polygon.exact_plane;
  plane = {Rational(-n.x) / n.z, Rational(-n.y) / n.z, Rational()};
  plane.offset = p.z - plane.slope_x * p.x - plane.slope_y * p.y;
  polygon.quad_plane = {to_quad(plane.slope_x), to_quad(plane.slope_y), to_quad(plane.offset)};
  const HeightPlane<Quad>& quad = polygon.quad_plane;
  polygon.plane = {double(quad.slope_x), double(quad.slope_y), double(quad.offset)};
  const double side = sgn(n.z);
  const Vec3d upward{-polygon.plane.slope_x, -polygon.plane.slope_y, 1};
  polygon.unit_normal = from_plane_axes(normalize(upward) * side, axis);
}

/// The point of the plane above `vertex`, less the center.
Vec3d lifted(const Polygon& polygon, const Vec3d& vertex) {
  const Vec3d p = to_plane_axes(vertex - polygon.center, polygon.dropped_axis);
  const double z = polygon.plane.offset + polygon.plane.slope_x * p.x + polygon.plane.slope_y * p.y;
  return from_plane_axes(Vec3d{p.x, p.y, z}, polygon.dropped_axis);
}

void set_texture_axes(Polygon& polygon, size_t first_loop_size) {
  Vec3d u{};
  for (size_t i = 0; i < first_loop_size && u == Vec3d{}; ++i) {
    const Vec3d& next = polygon.vertices[i + 1 < first_loop_size ? i + 1 : 0];
    u = normalize(lifted(polygon, next) - lifted(polygon, polygon.vertices[i]));
  }
  const Vec3d v = -cross(polygon.unit_normal, u);
  const double inf = std::numeric_limits<double>::infinity();
  Vec2d lower{inf, inf}, upper{-inf, -inf};
  for (const Vec3d& vertex : polygon.vertices) {
    const Vec3d p = lifted(polygon, vertex);
    const Vec2d at{dot(p, u), dot(p, v)};
    lower = {std::min(lower.x, at.x), std::min(lower.y, at.y)};
    upper = {std::max(upper.x, at.x), std::max(upper.y, at.y)};
  }
  polygon.u_length = upper.x - lower.x;
  polygon.u_direction = u / (upper.x - lower.x);
  polygon.v_direction = v / (upper.y - lower.y);
  polygon.uv_origin = {-lower.x / (upper.x - lower.x), -lower.y / (upper.y - lower.y)};
}

std::vector<Polygon::Edge> edges_of(const Polygon& polygon, const Loops& loops) {
  std::vector<Polygon::Edge> edges;
  const auto at = [&](uint32_t i) { return to_plane_axes(polygon.vertices[i] - polygon.center, polygon.dropped_axis); };
  uint32_t first = 0;
  for (const auto& loop : loops) {
    const auto end = uint32_t(first + loop.size());
    for (uint32_t i = first; i < end; ++i) {
      const uint32_t next = i + 1 < end ? i + 1 : first;
      const Vec3d p = at(i), q = at(next);
      if (polygon.vertices[i] == polygon.vertices[next]) continue;
      edges.push_back({p.x, p.y, q.x, q.y, std::abs(q.x - p.x) + std::abs(q.y - p.y), i, next});
    }
    first = end;
  }
  return edges;
}

/// The strip of height y; the nearest for y outside of all.
size_t strip_of(const Polygon& polygon, double y) {
  const double strip = (y - polygon.strips_lower) * polygon.strips_per_y;
  const size_t last = polygon.strips.size() - 2;
  return strip > 0 ? std::min(last, size_t(std::min(strip, double(last)))) : 0;
}

struct StripRange {
  size_t first, last;
};

StripRange strips_of(const Polygon& polygon, const Polygon::Edge& edge) {
  return {strip_of(polygon, std::min(edge.y0, edge.y1) - polygon.strip_margin),
          strip_of(polygon, std::max(edge.y0, edge.y1) + polygon.strip_margin)};
}

/// As many strips as keep each edge in three of them on average.
void choose_strips(Polygon& polygon, const std::vector<Polygon::Edge>& edges) {
  double lower = edges.front().y0, upper = lower;
  for (const auto& edge : edges) lower = std::min(lower, edge.y0), upper = std::max(upper, edge.y0);
  polygon.strips_lower = lower;
  for (size_t n = edges.size() > kEdgesOfOneStrip ? std::bit_floor(edges.size() / 4) : 1;; n /= 2) {
    polygon.strips.assign(n + 1, 0);
    polygon.strips_per_y = double(n) / (upper - lower);
    polygon.strip_margin = n == 1 ? std::numeric_limits<double>::infinity() : (upper - lower) / double(n) / 64;
    size_t entries = 0;
    for (const auto& edge : edges) {
      const StripRange range = strips_of(polygon, edge);
      entries += range.last - range.first + 1;
    }
    if (n == 1 || entries <= 3 * edges.size()) return;
  }
}

void set_edges(Polygon& polygon, const std::vector<Polygon::Edge>& edges) {
  choose_strips(polygon, edges);
  std::vector<uint32_t>& strips = polygon.strips;
  const auto for_each_entry = [&](const auto& visit) {
    for (const auto& edge : edges) {
      const StripRange range = strips_of(polygon, edge);
      for (size_t s = range.first; s <= range.last; ++s) visit(s, edge);
    }
  };
  for_each_entry([&](size_t s, const auto&) { ++strips[s + 1]; });
  for (size_t s = 1; s < strips.size(); ++s) strips[s] += strips[s - 1];
  polygon.edges.resize(strips.back());
  std::vector<uint32_t> next(strips.begin(), strips.end() - 1);
  for_each_entry([&](size_t s, const auto& edge) { polygon.edges[next[s]++] = edge; });
}

// ---- crossing a polygon

template <class T>
struct Bounded {
  T value, error;  // the exact value lies within `error`
};

/// A point of the plane, within `error` in x and in y.
template <class T>
struct PlanePoint {
  T x, y, error;
};

template <class T>
struct Inside {
  MaskOf<T> odd{false}, doubtful{false};
};

/// The plane as T takes it.
template <class T>
const auto& plane_of(const Polygon& polygon) {
  if constexpr (std::is_same_v<T, Quad>)
    return polygon.quad_plane;
  else
    return polygon.plane;
}

template <class T>
T largest(const Vec3<T>& v) {
  return larger(absolute(v.x), larger(absolute(v.y), absolute(v.z)));
}

/// The line in plane coordinates.
template <class T>
ObjectLine<T> in_plane_coordinates(const Polygon& polygon, const ObjectLine<T>& line) {
  const int axis = polygon.dropped_axis;
  const double u = kUnitRoundoff<T>;
  const Vec3<T> o = to_plane_axes(line.origin - Vec3<T>(polygon.center), axis);
  const Vec3<T> error = to_plane_axes(line.origin_error, axis);
  return {o,
          to_plane_axes(line.direction, axis),
          {error.x + absolute(o.x) * (2 * u), error.y + absolute(o.y) * (2 * u), error.z + absolute(o.z) * (2 * u)},
          to_plane_axes(line.direction_error, axis)};
}

/// v.z - slope_x v.x - slope_y v.y.
template <class T>
Bounded<T> rise(const Polygon& polygon, const Vec3<T>& v, const Vec3<T>& v_error) {
  const double u = kUnitRoundoff<T>;
  const T sx(plane_of<T>(polygon).slope_x), sy(plane_of<T>(polygon).slope_y);
  return {v.z - (sx * v.x + sy * v.y), (v_error.z + absolute(v.z) * (16 * u)) +
                                           (v_error.x + absolute(v.x) * (16 * u)) * absolute(sx) +
                                           (v_error.y + absolute(v.y) * (16 * u)) * absolute(sy) + kUnderflow};
}

/// Whether a line nearly parallel to the plane stays clear of it for as long as it is near the polygon.
template <class T>
MaskOf<T> stays_clear(const Polygon& polygon, const ObjectLine<T>& line, const Bounded<T>& height,
                      const Bounded<T>& speed) {
  const T gap = absolute(height.value) - height.error;
  const T stride = largest(line.direction) - largest(line.direction_error);
  const T way = largest(line.origin) + largest(line.origin_error) + T(std::max(polygon.radius, polygon.height));
  return (gap > T(0)) && (stride > T(0)) && (gap * stride > (absolute(speed.value) + speed.error) * way * 1.01);
}

template <class T>
PlanePoint<T> point_at(const Polygon& polygon, const ObjectLine<T>& line, const Bounded<T>& t) {
  const double u = kUnitRoundoff<T>;
  const T size = absolute(t.value) + t.error;
  const auto error = [&](const T& o, const T& d, const T& o_error, const T& d_error) {
    return o_error + size * d_error + absolute(d) * t.error + (absolute(o) + size * absolute(d)) * (4 * u);
  };
  const T x_error = error(line.origin.x, line.direction.x, line.origin_error.x, line.direction_error.x);
  const T y_error = error(line.origin.y, line.direction.y, line.origin_error.y, line.direction_error.y);
  // The last term is for the vertices, rounded too, and for what follows.
  return {line.origin.x + t.value * line.direction.x, line.origin.y + t.value * line.direction.y,
          larger(x_error, y_error) + polygon.radius * (8 * u) + kUnderflow};
}

template <class T>
struct EdgeEnds {
  T x0, y0, x1, y1;
};

template <class T>
EdgeEnds<T> ends_of(const Polygon& polygon, const Polygon::Edge& edge) {
  if constexpr (std::is_same_v<T, Quad>) {
    const auto at = [&](uint32_t i) {
      return to_plane_axes(Vec3<Quad>(polygon.vertices[i]) - Vec3<Quad>(polygon.center), polygon.dropped_axis);
    };
    const Vec3<Quad> p = at(edge.first), q = at(edge.second);
    return {p.x, p.y, q.x, q.y};
  } else {
    return {T(edge.x0), T(edge.y0), T(edge.x1), T(edge.y1)};
  }
}

/// The parity of the edges of strip `strip` that run to the right of `p`, towards greater x. Doubtful where one comes
/// within the point's error: only there can the parity of the exact point be another.
template <class T>
Inside<T> inside_strip(const Polygon& polygon, size_t strip, const PlanePoint<T>& p) {
  Inside<T> inside;
  const T e2 = p.error * 2, e3 = p.error * 3, e6 = p.error * 6;
  for (uint32_t i = polygon.strips[strip]; i < polygon.strips[strip + 1]; ++i) {
    const Polygon::Edge& edge = polygon.edges[i];
    const EdgeEnds<T> ends = ends_of<T>(polygon, edge);
    const T x0 = ends.x0 - p.x, y0 = ends.y0 - p.y, x1 = ends.x1 - p.x, y1 = ends.y1 - p.y;
    const MaskOf<T> above0 = y0 > T(0), above1 = y1 > T(0), in_rows = above0 != above1;
    const T area = x0 * y1 - x1 * y0;
    inside.odd = inside.odd != (in_rows && ((area > T(0)) == above1));
    // The edge's line comes within the error only where the area is within the first bound; the edge itself, if its
    // box comes near as well. Far from the box nothing cancels, so there underflow alone can hide the area's sign.
    const MaskOf<T> close = !(absolute(area) > e3 * (T(edge.span) + e6) + kUnderflow);
    if (any_of(close)) [[unlikely]] {
      const MaskOf<T> far =
          (absolute(x0 + x1) > absolute(x1 - x0) + e2) || (absolute(y0 + y1) > absolute(y1 - y0) + e2);
      inside.doubtful = inside.doubtful || (close && (!far || (in_rows && !(absolute(area) > T(kUnderflow)))));
    }
  }
  return inside;
}

template <class T>
Inside<T> inside_of(const Polygon& polygon, const PlanePoint<T>& p) {
  if (polygon.strips.size() == 2) return inside_strip(polygon, 0, p);
  if constexpr (std::is_same_v<T, DoubleLanes>) {
    Inside<T> inside;
    for (size_t i = 0; i < T::size(); ++i) {
      const auto lane = inside_of(polygon, PlanePoint<double>{p.x[i], p.y[i], p.error[i]});
      inside.odd[i] = lane.odd, inside.doubtful[i] = lane.doubtful;
    }
    return inside;
  } else {
    if (!(p.error < polygon.strip_margin / 2)) return {false, true};
    return inside_strip(polygon, strip_of(polygon, double(p.y)), p);
  }
}

/// inside_of, exactly; p in space less the center, as the exact vertices are.
bool exactly_inside(const Polygon& polygon, const Rational& x, const Rational& y) {
  const size_t strip = strip_of(polygon, y.get_d());
  const ExactVec center = exact(polygon.center);
  bool odd = false;
  for (uint32_t i = polygon.strips[strip]; i < polygon.strips[strip + 1]; ++i) {
    const Polygon::Edge& edge = polygon.edges[i];
    const ExactVec p = to_plane_axes(exact(polygon.vertices[edge.first]) - center, polygon.dropped_axis);
    const ExactVec q = to_plane_axes(exact(polygon.vertices[edge.second]) - center, polygon.dropped_axis);
    const bool above0 = p.y > y, above1 = q.y > y;
    if (above0 == above1) continue;
    const int area = sgn(Rational((p.x - x) * (q.y - y) - (q.x - x) * (p.y - y)));
    odd = odd != (above1 ? area > 0 : area < 0);
  }
  return odd;
}

}  // namespace

Polygon make_polygon(const Loops& loops) {
  if (loops.empty()) throw PolygonError(0, "expected one or more loops, found none");
  const IntegerLoops exactly(loops);
  for (size_t i = 0; i < loops.size(); ++i) check_loop(exactly.loops[i], i);
  const IntegerVec normal = newell_normal(exactly.loops[0]);
  check_planar(loops, exactly, normal);
  Polygon polygon;
  for (const auto& loop : loops) polygon.vertices.insert(polygon.vertices.end(), loop.begin(), loop.end());
  set_plane(polygon, mean_point(exactly), normal);
  const std::vector<Polygon::Edge> edges = edges_of(polygon, loops);
  for (const auto& edge : edges) polygon.radius = std::max({polygon.radius, std::abs(edge.x0), std::abs(edge.y0)});
  polygon.radius = std::nextafter(polygon.radius, HUGE_VAL);  // the exact coordinates may be larger than the rounded
  polygon.height = 1.01 * (2 * polygon.radius + std::abs(polygon.plane.offset));
  set_edges(polygon, edges);
  set_texture_axes(polygon, loops.front().size());
  return polygon;
}

template <class T>
LineCrossings<T> crossings(const Polygon& polygon, const ObjectLine<T>& line_object) {
  LineCrossings<T> out;
  const ObjectLine<T> line = in_plane_coordinates(polygon, line_object);
  const T offset(plane_of<T>(polygon).offset);
  Bounded<T> height = rise(polygon, line.origin, line.origin_error);
  height = {height.value - offset,
            height.error + (absolute(height.value) + absolute(offset)) * (16 * kUnitRoundoff<T>)};
  const Bounded<T> speed = rise(polygon, line.direction, line.direction_error);
  const MaskOf<T> steep = absolute(speed.value) > speed.error * 4;
  if (any_of(!steep)) [[unlikely]]
    out.doubtful = !steep && !stays_clear(polygon, line, height, speed);

  const T inverse = T(1) / select(steep, speed.value, T(1)), t = -(height.value * inverse);
  const T t_error =
      (height.error + absolute(t) * speed.error) * absolute(inverse) * 1.4 + absolute(t) * (4 * kUnitRoundoff<T>);
  const PlanePoint<T> p = point_at(polygon, line, Bounded<T>{t, t_error});
  // Written so that NaN is not clear of the polygon.
  const T reach = polygon.radius + p.error;
  const MaskOf<T> near = steep && !((absolute(p.x) > reach) || (absolute(p.y) > reach));
  if (!any_of(near)) return out;
  const Inside<T> inside = inside_of(polygon, p);
  out.at[0] = {t, t_error, T(kWallFace), near && inside.odd};
  out.doubtful = out.doubtful || (near && (inside.doubtful || !(t_error < HUGE_VAL)));
  return out;
}

template LineCrossings<DoubleLanes> crossings(const Polygon&, const ObjectLine<DoubleLanes>&);
template LineCrossings<double> crossings(const Polygon&, const ObjectLine<double>&);
template LineCrossings<Quad> crossings(const Polygon&, const ObjectLine<Quad>&);

std::vector<ExactCrossing> exact_crossings(const Polygon& polygon, const ExactLine& line) {
  const HeightPlane<Rational>& plane = polygon.exact_plane;
  const ExactVec o = to_plane_axes(line.origin - exact(polygon.center), polygon.dropped_axis);
  const ExactVec d = to_plane_axes(line.direction, polygon.dropped_axis);
  const Rational speed = d.z - plane.slope_x * d.x - plane.slope_y * d.y;
  if (sgn(speed) == 0) return {};
  const Rational t = (plane.offset + plane.slope_x * o.x + plane.slope_y * o.y - o.z) / speed;
  if (!exactly_inside(polygon, o.x + t * d.x, o.y + t * d.y)) return {};
  return {{Surd(t)}};
}

Bounds3d bounds(const Polygon& polygon) {
  Bounds3d box;
  for (const Vec3d& vertex : polygon.vertices) extend(box, lifted(polygon, vertex) + polygon.center);
  // Rounding moves no coordinate by more than this.
  const double size = 8 * kUnitRoundoff<double> * (polygon.height + max_component(abs(polygon.center)));
  const Vec3d margin{size, size, size};
  return {box.lower - margin, box.upper + margin};
}

Vec3d project(const Polygon& polygon, const Vec3d& p_object, int) {
  const Vec3d p = p_object - polygon.center, n = polygon.unit_normal;
  const Vec3d p_plane = to_plane_axes(p, polygon.dropped_axis);
  const double rise_of_p =
      p_plane.z - polygon.plane.slope_x * p_plane.x - polygon.plane.slope_y * p_plane.y - polygon.plane.offset;
  return p_object - n * (rise_of_p * n[polygon.dropped_axis]);
}

Vec3d normal(const Polygon& polygon, const Vec3d&, int) { return polygon.unit_normal; }

Vec2f texture_coordinates(const Polygon& polygon, const Vec3d& p_object, int) {
  const Vec3d p = p_object - polygon.center;
  return {float(polygon.uv_origin.x + dot(p, polygon.u_direction)),
          float(polygon.uv_origin.y + dot(p, polygon.v_direction))};
}

Vec3d u_tangent(const Polygon& polygon, const Vec3d&, int) { return normalize(polygon.u_direction) * polygon.u_length; }

}  // namespace alhazen
