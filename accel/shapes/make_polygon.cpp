// Making a polygon: its plane, its edges by strips, its texture axes, and what is wrong with loops that make none.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <sstream>

#include "accel/shapes/polygon_plane.h"

namespace alhazen {
namespace {

constexpr size_t kEdgesOfOneStrip = 64;  // so few are faster looked at than looked up

using ExactVec = Vec3<Rational>;

using Integer = mpz_class;
using IntegerVec = Vec3<Integer>;

template <class N>
bool is_zero(const Vec3<N>& a) {
  return sgn(a.x) == 0 && sgn(a.y) == 0 && sgn(a.z) == 0;
}

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

}  // namespace alhazen
