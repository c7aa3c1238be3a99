#include <gtest/gtest.h>

#include <numbers>

#include "accel/shapes/polygon.h"
#include "decide.h"
#include "tests/trials.h"

namespace alhazen {
namespace {

using Loop = std::vector<Vec3d>;
using Loops = std::vector<Loop>;

// ---- an oracle that shares nothing with the polygon: rationals, straight from the definitions

Rational at(const Vec3<Rational>& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

Vec3<Rational> newell(const Loop& loop) {
  Vec3<Rational> n;
  for (size_t i = 0; i < loop.size(); ++i) {
    const Vec3<Rational> p = exact(loop[i]), q = exact(loop[(i + 1) % loop.size()]);
    n.x += (p.y - q.y) * (p.z + q.z), n.y += (p.z - q.z) * (p.x + q.x), n.z += (p.x - q.x) * (p.y + q.y);
  }
  return n;
}

/// Whether the half line from (x, y) towards greater x crosses an odd number of edges that are closed below.
bool odd_crossings(const Loops& loops, int i, int j, const Rational& x, const Rational& y) {
  bool odd = false;
  for (const Loop& loop : loops)
    for (size_t k = 0; k < loop.size(); ++k) {
      const Vec3<Rational> p = exact(loop[k]), q = exact(loop[(k + 1) % loop.size()]);
      const Rational px = at(p, i), py = at(p, j), qx = at(q, i), qy = at(q, j);
      if (std::min(py, qy) <= y && y < std::max(py, qy) && px + (y - py) / (qy - py) * (qx - px) > x) odd = !odd;
    }
  return odd;
}

std::optional<Rational> oracle(const Loops& loops, const ExactLine& line) {
  const Vec3<Rational> n = newell(loops[0]);
  Rational speed, distance;
  for (int k = 0; k < 3; ++k) {
    Rational mean;
    for (const Vec3d& p : loops[0]) mean += exact(p[k]);
    mean /= Rational(static_cast<unsigned long>(loops[0].size()));
    speed += at(n, k) * at(line.direction, k), distance += at(n, k) * (mean - at(line.origin, k));
  }
  if (sgn(speed) == 0) return std::nullopt;
  const Rational t = distance / speed;
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (abs(at(n, k)) > abs(at(n, axis))) axis = k;
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  const Rational x = at(line.origin, i) + t * at(line.direction, i), y = at(line.origin, j) + t * at(line.direction, j);
  return odd_crossings(loops, i, j, x, y) ? std::optional(t) : std::nullopt;
}

// ---- random polygons

Loop star(Rng& rng, int n, double radius) {
  Loop loop;
  for (int i = 0; i < n; ++i) {
    const double phi = 2 * std::numbers::pi * (i + uniform(rng, 0, 0.9)) / n, r = radius * uniform(rng, 0.3, 1);
    loop.push_back({r * std::cos(phi), r * std::sin(phi), 0});
  }
  return loop;
}

/// Turned to any orientation, moved by `offset`, rounded to double: planar up to that.
Loops placed(Rng& rng, const Loops& loops, const Vec3d& offset) {
  const Vec3d x = normalize(uniform_vector(rng, -1, 1)), y = normalize(cross(x, uniform_vector(rng, -1, 1)));
  Loops out = loops;
  for (Loop& loop : out)
    for (Vec3d& p : loop) p = offset + x * p.x + y * p.y;
  return out;
}

/// Points of a lattice in an axis-parallel plane, or in x + y + z = const, where all axes tie. They cross and touch
/// themselves at will.
Loops lattice_loops(Rng& rng) {
  Loops loops(size_t(uniform_int(rng, 1, 3)));
  const int plane = uniform_int(rng, 0, 3), height = uniform_int(rng, -1, 1);
  for (Loop& loop : loops)
    for (int i = uniform_int(rng, 3, 9); i > 0; --i) {
      const double u = uniform_int(rng, -2, 2), v = uniform_int(rng, -2, 2), w = height;
      loop.push_back(plane == 0   ? Vec3d{w, u, v}
                     : plane == 1 ? Vec3d{u, w, v}
                     : plane == 2 ? Vec3d{u, v, w}
                                  : Vec3d{u, v, w - u - v});
    }
  return loops;
}

Loops random_loops(Rng& rng, int kind, Vec3d& middle) {
  middle = {};
  switch (kind) {
    case 0:
      return placed(rng, {star(rng, uniform_int(rng, 3, 12), 1)}, middle);
    case 1:
      return placed(rng, {star(rng, 8, 1), star(rng, 5, 0.3)}, middle);
    case 2:
      middle = Vec3d(Vec3f(uniform_vector(rng, -1e4, 1e4)));
      return placed(rng, {star(rng, 6, 1)}, middle);
    case 3:
      return placed(rng, {star(rng, uniform_int(rng, 100, 300), 1)}, middle);
    default:
      return lattice_loops(rng);
  }
}
constexpr int kPolygonKinds = 5;

/// Until they make a polygon.
Loops random_valid_loops(Rng& rng, int kind, Vec3d& middle) {
  for (;;) {
    Loops loops = random_loops(rng, kind, middle);
    try {
      (void)make_polygon(loops);
      return loops;
    } catch (const PolygonError&) {
    }
  }
}

Vec3d random_target(Rng& rng, const Loops& loops) {
  const Loop& loop = loops[size_t(uniform_int(rng, 0, int(loops.size()) - 1))];
  const size_t i = size_t(uniform_int(rng, 0, int(loop.size()) - 1));
  const Vec3d &p = loop[i], &q = loop[(i + 1) % loop.size()];
  const int kind = uniform_int(rng, 0, 3);
  return kind == 0 ? p : kind == 1 ? (p + q) * 0.5 : kind == 2 ? p + (q - p) * uniform(rng, 0, 1) : (p + loop[0]) * 0.5;
}

TEST(Polygon, IsDecidedAsRationalsDecideByEveryNumberTypeThatIsSure) {
  Rng rng(21);
  DecisionCount count;
  for (int i = 0; i < trials(500); ++i) {
    Vec3d middle;
    const Loops loops = random_valid_loops(rng, i % kPolygonKinds, middle);
    const Polygon polygon = make_polygon(loops);
    for (int j = 0; j < 8 * kAwkwardKinds; ++j) {
      const FloatLine line = awkward_line(rng, j % kAwkwardKinds, random_target(rng, loops), middle);
      check_line(polygon, line.origin, line.direction, count);
      if (HasFailure()) FAIL() << "polygon " << i << " line " << j;
    }
  }
  EXPECT_EQ(count.rounded_wrongly, 0) << "of " << count.rays();
  EXPECT_GT(count.by_double, count.rays() / 2);
}

TEST(Polygon, IsWhatItsDefinitionSays) {
  Rng rng(22);
  for (int i = 0; i < trials(400); ++i) {
    Vec3d middle;
    const Loops loops = random_valid_loops(rng, i % kPolygonKinds, middle);
    const Polygon polygon = make_polygon(loops);
    for (int j = 0; j < 4 * kAwkwardKinds; ++j) {
      const FloatLine line = awkward_line(rng, j % kAwkwardKinds, random_target(rng, loops), middle);
      const ExactLine exactly = exact_line(line.origin, line.direction);
      const auto expected = oracle(loops, exactly);
      const auto found = exact_crossings(polygon, exactly);
      ASSERT_EQ(found.size(), expected ? 1u : 0u) << "polygon " << i << " line " << j;
      if (expected) {
        ASSERT_EQ(found[0].t.p, *expected);
      }
    }
  }
}

TEST(Polygon, NeedsOnlyDoublesOnUniformRays) {
  Rng rng(23);
  DecisionCount count;
  for (int i = 0; i < 400; ++i) {
    Vec3d middle;
    const Polygon polygon = make_polygon(random_valid_loops(rng, i % 4 == 2 ? 0 : i % 4, middle));
    for (int j = 0; j < 50; ++j) {
      const FloatLine line = awkward_line(rng, 0, {}, middle);
      check_line(polygon, line.origin, line.direction, count);
    }
  }
  EXPECT_EQ(count.rounded_wrongly, 0);
  EXPECT_LE(count.by_quad + count.by_rationals, 2);
}

TEST(Polygon, NeedsOnlyDoublesForRaysAlongItsPlaneButOffIt) {
  const Polygon polygon = make_polygon({{{-1, 0.5, -1}, {-1, 0.5, 1}, {1, 0.5, 1}, {1, 0.5, -1}}});
  for (const float y : {0.25f, 0.4999999f, 0.75f}) {
    const auto found = crossings(polygon, exact_object_line<double>({-3, y, 0.25f}, {1, 0, 0.125f}));
    EXPECT_FALSE(found.doubtful || found.at[0].present);
  }
}

TEST(Polygon, KeepsItsErrorBoundsOnLinesThatAreRoundedThemselves) {
  Rng rng(24);
  int sure = 0, rays = 0;
  for (int i = 0; i < 600; ++i) {
    Vec3d middle;
    const Loops loops = random_valid_loops(rng, i % kPolygonKinds, middle);
    const Polygon polygon = make_polygon(loops);
    for (int j = 0; j < 20; ++j, ++rays) {
      const UncertainLine line = uncertain_line(rng, random_target(rng, loops), middle);
      sure += expect_exact(crossings(polygon, line.known), exact_crossings(polygon, line.exactly));
      if (HasFailure()) FAIL() << "polygon " << i << " line " << j;
    }
  }
  EXPECT_GT(sure, rays / 10);
}

TEST(Polygon, BoundsContainEveryHit) {
  Rng rng(25);
  int hits = 0;
  for (int i = 0; i < trials(500); ++i) {
    Vec3d middle;
    Loops loops = random_valid_loops(rng, i % kPolygonKinds, middle);
    if (i % 2)  // off the plane, within what is allowed
      for (Vec3d& p : loops[0]) p += uniform_vector(rng, -1, 1) * 2e-5;
    const Polygon polygon = make_polygon(loops);
    const Bounds3d box = bounds(polygon);
    for (int j = 0; j < 30; ++j) {
      const FloatLine line = awkward_line(rng, 1 + j % 4, random_target(rng, loops), middle);
      const ExactLine exactly = exact_line(line.origin, line.direction);
      for (const ExactCrossing& c : exact_crossings(polygon, exactly))
        for (int k = 0; k < 3; ++k, ++hits) {
          const Rational p = at(exactly.origin, k) + c.t.p * at(exactly.direction, k);
          ASSERT_LE(exact(box.lower[k]), p);
          ASSERT_GE(exact(box.upper[k]), p);
        }
    }
  }
  EXPECT_GT(hits, trials(5000));
}

// ---- who owns an edge

/// As a renderer decides: double, binary128, rationals.
bool is_hit(const Polygon& polygon, const FloatLine& line) {
  const auto found = crossings(polygon, exact_object_line<double>(line.origin, line.direction));
  if (!found.doubtful) return found.at[0].present;
  const auto wide = crossings(polygon, exact_object_line<Quad>(line.origin, line.direction));
  if (!wide.doubtful) return wide.at[0].present;
  return !exact_crossings(polygon, exact_line(line.origin, line.direction)).empty();
}

/// Whether the point (x, y, 0) belongs to a polygon in the plane z = 0; seen obliquely.
bool contains(const Polygon& polygon, float x, float y) {
  const Vec3f direction{0.5f, -0.25f, -1};
  return is_hit(polygon, {Vec3f{x, y, 0} - direction, direction});
}

/// A polygon in the plane z = 0.
Loop flat(const std::vector<Vec2d>& points) {
  Loop loop;
  for (const Vec2d& p : points) loop.push_back({p.x, p.y, 0});
  return loop;
}
Loop square(double x, double y, double size) {
  return flat({{x, y}, {x + size, y}, {x + size, y + size}, {x, y + size}});
}
Loop reversed(Loop loop) { return {loop.rbegin(), loop.rend()}; }

/// The square [0, 4]² cut into polygons: cells, halved along either diagonal, some merged into one concave piece.
std::vector<Loops> random_tiling(Rng& rng) {
  std::vector<Loops> pieces;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      const double x = i, y = j;
      const Vec2d p{x, y}, q{x + 1, y}, r{x + 1, y + 1}, s{x, y + 1};
      switch (uniform_int(rng, 0, 3)) {
        case 0:
          pieces.push_back({flat({p, q, r})}), pieces.push_back({flat({r, s, p})});
          break;
        case 1:
          pieces.push_back({flat({p, s, q})}), pieces.push_back({flat({q, s, r})});
          break;
        case 2: {  // a frame and its filling
          const Loop hole = flat({{x + 0.25, y + 0.25}, {x + 0.75, y + 0.25}, {x + 0.5, y + 0.75}});
          pieces.push_back({flat({p, q, r, s}), hole}), pieces.push_back({reversed(hole)});
          break;
        }
        default: {  // concave against its complement
          const Vec2d m{x + 0.5, y + 0.25};
          pieces.push_back({flat({p, q, r, m})}), pieces.push_back({flat({m, r, s, p})});
        }
      }
    }
  return pieces;
}

TEST(Polygon, OfATilingExactlyOneOwnsEachPointEdgesAndVerticesIncluded) {
  Rng rng(26);
  for (int m = 0; m < 12; ++m) {
    // In the plane z = 0, in one where two axes tie, or in one where all do.
    const auto lift = [&](const Vec3d& p) -> Vec3d {
      return m % 3 == 0 ? p : m % 3 == 1 ? Vec3d{p.x, p.y, p.y} : Vec3d{p.x, p.y, -p.x - p.y};
    };
    std::vector<Polygon> pieces;
    for (Loops loops : random_tiling(rng)) {
      for (Loop& loop : loops)
        for (Vec3d& p : loop) p = lift(p);
      pieces.push_back(make_polygon(loops));
    }
    for (int i = 0; i < 300; ++i) {
      const Vec3d target = lift({uniform_int(rng, 1, 31) / 8.0, uniform_int(rng, 1, 31) / 8.0, 0});
      const Vec3f origin = uniform_lattice(rng, 9) + Vec3f{0, 0, 10.5f};
      int owners = 0;
      for (const Polygon& piece : pieces) owners += is_hit(piece, {origin, Vec3f(target) - origin});
      ASSERT_EQ(owners, 1) << target.x << " " << target.y;
    }
  }
}

TEST(Polygon, EdgesBelongToTheSideOfGreaterCoordinates) {
  const Polygon polygon = make_polygon({square(0, 0, 1)});
  EXPECT_TRUE(contains(polygon, 0, 0) && contains(polygon, 0.5f, 0) && contains(polygon, 0, 0.5f));
  EXPECT_FALSE(contains(polygon, 1, 0) || contains(polygon, 0, 1) || contains(polygon, 1, 1) ||
               contains(polygon, 1, 0.5f) || contains(polygon, 0.5f, 1));
}

// ---- named cases

/// That two polygons in the plane z = 0 are the same set, on a lattice that meets all their edges and vertices.
void expect_same_points(const Loops& a, const Loops& b) {
  const Polygon p = make_polygon(a), q = make_polygon(b);
  for (int i = -4; i <= 20; ++i)
    for (int j = -4; j <= 20; ++j)
      EXPECT_EQ(contains(p, float(i) / 4, float(j) / 4), contains(q, float(i) / 4, float(j) / 4)) << i << " " << j;
}

TEST(Polygon, CollinearAdjacentVerticesChangeNothing) {
  expect_same_points({flat({{0, 0}, {1, 0}, {2, 0}, {4, 0}, {4, 2}, {4, 4}, {0, 4}, {0, 1}})}, {square(0, 0, 4)});
}

TEST(Polygon, ZeroLengthEdgesAndSpikesChangeNothing) {
  expect_same_points({flat({{0, 0}, {0, 0}, {4, 0}, {4, 4}, {4, 4}, {4, 4}, {0, 4}, {0, 0}})}, {square(0, 0, 4)});
  expect_same_points({flat({{0, 0}, {4, 0}, {5, 0}, {4, 0}, {4, 4}, {0, 4}})}, {square(0, 0, 4)});
}

TEST(Polygon, EqualPointsThatAreNotAdjacentJoinTwoParts) {
  const Polygon bow = make_polygon({flat({{0, 0}, {2, 2}, {4, 0}, {4, 4}, {2, 2}, {0, 3}})});
  EXPECT_TRUE(contains(bow, 0.5f, 1) && contains(bow, 3.5f, 2));
  EXPECT_FALSE(contains(bow, 2, 1) || contains(bow, 2, 3));
}

TEST(Polygon, SelfIntersectionIsEvenOdd) {
  // A pentagram: its middle is wound twice, hence outside (the nonzero rule would have it inside).
  Loop star5;
  for (int i = 0; i < 5; ++i) {
    const double phi = 4 * std::numbers::pi * i / 5;
    star5.push_back({std::cos(phi), std::sin(phi), 0});
  }
  const Polygon polygon = make_polygon({star5});
  EXPECT_FALSE(contains(polygon, 0, 0));
  EXPECT_TRUE(contains(polygon, 0.75f, 0));
}

TEST(Polygon, AHoleMayTouchTheBoundaryAtAPoint) {
  const Polygon polygon = make_polygon({square(0, 0, 4), flat({{0, 2}, {2, 1}, {2, 3}})});
  EXPECT_FALSE(contains(polygon, 1, 2));
  EXPECT_TRUE(contains(polygon, 0.25f, 1) && contains(polygon, 0.25f, 3) && contains(polygon, 3, 2));
}

TEST(Polygon, AHoleAlongAnEdgeIsANotch) {
  expect_same_points({square(0, 0, 4), square(0, 1, 2)},
                     {flat({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 3}, {2, 3}, {2, 1}, {0, 1}})});
}

TEST(Polygon, AHoleOutsideIsAnIsland) {
  const Polygon polygon = make_polygon({square(0, 0, 1), square(2, 0, 1)});
  EXPECT_TRUE(contains(polygon, 0.5f, 0.5f) && contains(polygon, 2.5f, 0.5f));
  EXPECT_FALSE(contains(polygon, 1.5f, 0.5f));
}

TEST(Polygon, NestedHolesAlternate) {
  const Polygon polygon = make_polygon({square(0, 0, 5), square(1, 1, 3), square(2, 2, 1)});
  EXPECT_TRUE(contains(polygon, 0.5f, 2.5f) && contains(polygon, 2.5f, 2.5f));
  EXPECT_FALSE(contains(polygon, 1.5f, 2.5f));
}

TEST(Polygon, OrientationOfHolesDoesNotMatter) {
  expect_same_points({square(0, 0, 4), square(1, 1, 2)}, {square(0, 0, 4), reversed(square(1, 1, 2))});
  expect_same_points({square(0, 0, 4), square(1, 1, 2)}, {reversed(square(0, 0, 4)), square(1, 1, 2)});
}

TEST(Polygon, TheSameLoopTwiceIsNothing) {
  const Polygon polygon = make_polygon({square(0, 0, 4), square(0, 0, 4)});
  EXPECT_FALSE(contains(polygon, 2, 2) || contains(polygon, 0, 0));
}

TEST(Polygon, VerticesBesideAPointInItsRowCountOnce) {
  // To the right of the point: a vertex passed, one touched from above, one from below, and a horizontal edge.
  const Polygon polygon =
      make_polygon({flat({{0, 0}, {1, 1}, {2, 0}, {3, 2}, {4, 1}, {5, 1}, {5, 4}, {2, 1}, {1, 4}, {0.5, 1}, {0, 4}})});
  EXPECT_TRUE(contains(polygon, 0.25f, 1));
  EXPECT_FALSE(contains(polygon, -1, 1) || contains(polygon, -1, 0) || contains(polygon, -1, 4));
}

TEST(Polygon, RaysAimedAtVerticesWithinTheRowsOfOthersAreDecided) {
  const Loops loops{flat({{0, 0}, {4, 0}, {4, 2}, {2, 2}, {2, 4}, {0, 4}})};
  const Polygon polygon = make_polygon(loops);
  for (const Vec3d& p : loops[0]) {
    const ExactLine line = exact_line(Vec3f(p) + Vec3f{0, 0, 1}, {0, 0, -1});
    EXPECT_EQ(contains(polygon, float(p.x), float(p.y)), oracle(loops, line).has_value());
  }
}

TEST(Polygon, AmongEqualComponentsOfTheNormalTheFirstAxisIsDropped) {
  EXPECT_EQ(make_polygon({{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}).dropped_axis, 0);
  EXPECT_EQ(make_polygon({{{0, 0, 0}, {1, 0, 0}, {0, 1, -1}}}).dropped_axis, 1);
  EXPECT_EQ(make_polygon({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}).dropped_axis, 2);
}

TEST(Polygon, RaysInItsPlaneMiss) {
  const Polygon axis = make_polygon({square(0, 0, 1)}), tilted = make_polygon({{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}});
  EXPECT_FALSE(is_hit(axis, {{-1, 0.5f, 0}, {1, 0, 0}}) || is_hit(axis, {{0.5f, 0.5f, 0}, {1, 0, 0}}));
  EXPECT_FALSE(is_hit(tilted, {{1, 0, 0}, {-1, 0.5f, 0.5f}}) || is_hit(tilted, {{0, 0, 0}, {0, 0, 0}}));
}

TEST(Polygon, NaNAndInfinitiesAreInDoubt) {
  const Polygon polygon = make_polygon({{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}});
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  for (const float bad : {nan, inf, -inf})
    for (int axis = 0; axis < 6; ++axis) {
      float v[6] = {0.25f, 0.25f, 3, 0.125f, 0.125f, -1};
      v[axis] = bad;
      const Vec3f o{v[0], v[1], v[2]}, d{v[3], v[4], v[5]};
      EXPECT_TRUE(crossings(polygon, exact_object_line<double>(o, d)).doubtful);
      EXPECT_TRUE(crossings(polygon, exact_object_line<Quad>(o, d)).doubtful);
    }
}

/// A regular polygon of n vertices.
Loop regular(int n) {
  Loop loop;
  for (int i = 0; i < n; ++i) {
    const double phi = 2 * std::numbers::pi * i / n;
    loop.push_back({std::cos(phi), std::sin(phi), 0});
  }
  return loop;
}

TEST(Polygon, HasFromThreeToAHundredThousandVertices) {
  Rng rng(27);
  for (const int n : {3, 4, 5, 64, 65, 1000, trials(100000)}) {
    const Loops loops{regular(n)};
    const Polygon polygon = make_polygon(loops);
    EXPECT_LE(polygon.edges.size(), 3u * size_t(n));
    for (int i = 0; i < (n > 1000 ? 1 : trials(50)); ++i) {
      const FloatLine line = aimed(rng, random_target(rng, loops), {0.25, 0.5, 1}, 1);
      EXPECT_EQ(is_hit(polygon, line), oracle(loops, exact_line(line.origin, line.direction)).has_value());
    }
    EXPECT_TRUE(contains(polygon, -0.25f, 0.125f) && !contains(polygon, 0.75f, 0.75f));
  }
}

TEST(Polygon, ACombOfLongTeethKeepsItsIndexSmall) {
  for (const bool upright : {false, true}) {
    Loop comb;
    for (int i = 0; i < 10000; ++i) {
      comb.push_back(upright ? Vec3d{i + 0.0, 0, 0} : Vec3d{0, i + 0.0, 0});
      comb.push_back(upright ? Vec3d{i + 0.5, 5000, 0} : Vec3d{5000, i + 0.5, 0});
    }
    comb.push_back(upright ? Vec3d{10000, -1, 0} : Vec3d{-1, 10000, 0});
    comb.push_back(upright ? Vec3d{0, -1, 0} : Vec3d{-1, 0, 0});
    const Polygon polygon = make_polygon({comb});
    EXPECT_LE(polygon.edges.size(), 3 * comb.size());
    for (int i = 0; i < 10000; i += 997)
      for (const float y : {1.0f, 2500.0f, 4999.0f}) {
        const float inside = float(i) + 0.5f, outside = float(i) + 1;
        EXPECT_TRUE(upright ? contains(polygon, inside, y) : contains(polygon, y, inside));
        EXPECT_FALSE(upright ? contains(polygon, outside, y) : contains(polygon, y, outside));
      }
  }
}

// ---- what is no polygon

size_t loop_in_error(const Loops& loops) {
  try {
    (void)make_polygon(loops);
  } catch (const PolygonError& error) {
    EXPECT_NE(std::string(error.what()).find("expected"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("found"), std::string::npos);
    return error.loop;
  }
  ADD_FAILURE() << "accepted";
  return size_t(-1);
}

TEST(Polygon, FewerThanThreeDistinctPointsAreAnError) {
  EXPECT_EQ(loop_in_error({}), 0u);
  EXPECT_EQ(loop_in_error({{}}), 0u);
  EXPECT_EQ(loop_in_error({{{1, 2, 3}}}), 0u);
  EXPECT_EQ(loop_in_error({{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}}), 0u);
  EXPECT_EQ(loop_in_error({square(0, 0, 4), {{1, 1, 0}, {2, 1, 0}, {1, 1, 0}, {2, 1, 0}}}), 1u);
}

TEST(Polygon, OnlyCollinearPointsAreAnError) {
  EXPECT_EQ(loop_in_error({{{0, 0, 0}, {1, 2, 3}, {2, 4, 6}, {-1, -2, -3}}}), 0u);
  EXPECT_EQ(loop_in_error({square(0, 0, 4), {{1, 1, 0}, {2, 2, 0}, {3, 3, 0}}}), 1u);
}

TEST(Polygon, CollinearityIsDecidedExactly) {
  const double third = 1.0 / 3;
  EXPECT_EQ(loop_in_error({{{0, 0, 0}, {third, third, 0}, {1, 1, 0}}}), 0u);
  EXPECT_EQ(make_polygon({{{0, 0, 0}, {third, std::nextafter(third, 1), 0}, {1, 1, 0}}}).vertices.size(), 3u);
}

TEST(Polygon, AFirstLoopWhoseLobesCancelIsAnError) {
  EXPECT_EQ(loop_in_error({flat({{-1, -1}, {1, 1}, {1, -1}, {-1, 1}})}), 0u);
}

TEST(Polygon, VerticesOffThePlaneAreAnErrorThatSaysHowFar) {
  // Of a square of side 2, one corner lifted by h: the plane turns with it, and all corners end up h/4 off.
  const auto lifted = [](double h) -> Loops { return {{{-1, -1, 0}, {1, -1, 0}, {1, 1, h}, {-1, 1, 0}}}; };
  EXPECT_EQ(make_polygon(lifted(7.9e-4)).vertices.size(), 4u);
  EXPECT_EQ(loop_in_error(lifted(8.1e-4)), 0u);
  Loops hole{square(0, 0, 4), square(1, 1, 2)};
  hole[1][2].z = 5e-4;
  EXPECT_EQ(loop_in_error(hole), 1u);
  try {
    (void)make_polygon(hole);
  } catch (const PolygonError& error) {
    EXPECT_STREQ(error.what(),
                 "expected vertices within 0.0001 of the longest side, 0.0004, from the plane, found [3, 3, 0.0005] "
                 "at a distance of 0.0005");
  }
}

// ---- what shading asks

TEST(Polygon, NormalIsNewellsOfTheFirstLoopRightHanded) {
  EXPECT_EQ(normal(make_polygon({square(0, 0, 1)}), {}, 0), (Vec3d{0, 0, 1}));
  EXPECT_EQ(normal(make_polygon({reversed(square(0, 0, 1)), square(0.25, 0.25, 0.5)}), {}, 0), (Vec3d{0, 0, -1}));
  Rng rng(28);
  for (int i = 0; i < 200; ++i) {
    Vec3d middle;
    const Loops loops = random_valid_loops(rng, i % kPolygonKinds, middle);
    const Vec3<Rational> n = newell(loops[0]);
    const Vec3d expected = normalize(Vec3d{n.x.get_d(), n.y.get_d(), n.z.get_d()});
    EXPECT_LE(length(normal(make_polygon(loops), {}, 0) - expected), 1e-14);
  }
}

TEST(Polygon, ProjectsToTheNearestPointOfThePlane) {
  Rng rng(29);
  for (int i = 0; i < 500; ++i) {
    const Polygon polygon = make_polygon(placed(rng, {star(rng, 5, 1)}, {1, 2, 3}));
    const Vec3d p = uniform_vector(rng, -5, 5), q = project(polygon, p, 0), n = normal(polygon, p, 0);
    EXPECT_LE(length(cross(p - q, n)), 1e-14);
    EXPECT_NEAR(dot(q - polygon.center, n), 0, 1e-14);
  }
}

TEST(Polygon, TexturesRunAlongTheFirstEdgeAndDownTheOther) {
  // A wall in the plane z = 3, seen from +z: 4 wide, 2 high, with a wider island above.
  const Polygon wall = make_polygon({{{0, 0, 3}, {4, 0, 3}, {4, 2, 3}, {0, 2, 3}}});
  EXPECT_EQ(texture_coordinates(wall, {0, 2, 3}, 0), (Vec2f{0, 0}));
  EXPECT_EQ(texture_coordinates(wall, {4, 0, 3}, 0), (Vec2f{1, 1}));
  EXPECT_EQ(texture_coordinates(wall, {1, 1, 3}, 0), (Vec2f{0.25f, 0.5f}));
  EXPECT_EQ(u_tangent(wall, {}, 0), (Vec3d{4, 0, 0}));
  const Polygon both = make_polygon({{{0, 0, 3}, {4, 0, 3}, {4, 2, 3}, {0, 2, 3}}, {{-4, 2, 3}, {4, 2, 3}, {4, 4, 3}}});
  EXPECT_EQ(texture_coordinates(both, {0, 0, 3}, 0), (Vec2f{0.5f, 1}));
  EXPECT_EQ(texture_coordinates(both, {4, 4, 3}, 0), (Vec2f{1, 0}));
}

TEST(Polygon, TexturesFillTheUnitSquareWithItsTangentAlongU) {
  Rng rng(30);
  for (int i = 0; i < 300; ++i) {
    Vec3d middle;
    const Loops loops = random_valid_loops(rng, i % kPolygonKinds, middle);
    const Polygon polygon = make_polygon(loops);
    Vec2f lower{2, 2}, upper{-2, -2};
    for (const Loop& loop : loops)
      for (const Vec3d& p : loop) {
        const Vec2f uv = texture_coordinates(polygon, p, 0);
        lower = {std::min(lower.x, uv.x), std::min(lower.y, uv.y)};
        upper = {std::max(upper.x, uv.x), std::max(upper.y, uv.y)};
      }
    EXPECT_NEAR(lower.x, 0, 1e-6);
    EXPECT_NEAR(lower.y, 0, 1e-6);
    EXPECT_NEAR(upper.x, 1, 1e-6);
    EXPECT_NEAR(upper.y, 1, 1e-6);
    const Vec3d p = polygon.center, q = p + u_tangent(polygon, p, 0) * 0.25;
    const Vec2f step = texture_coordinates(polygon, q, 0) - texture_coordinates(polygon, p, 0);
    EXPECT_NEAR(step.x, 0.25, 1e-6);
    EXPECT_NEAR(step.y, 0, 1e-6);
  }
}

}  // namespace
}  // namespace alhazen
