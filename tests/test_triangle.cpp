#include <gtest/gtest.h>

#include <bit>
#include <numbers>

#include "accel/shapes/triangle.h"
#include "decide.h"

namespace alhazen {
namespace {

Vec3d as_floats(const Vec3d& v) { return Vec3d(Vec3f(v)); }

/// Unit triangles, needles, lattice triangles and ones far from the origin.
Triangle random_triangle(Rng& rng, int kind, Vec3d& middle) {
  middle = kind == 3 ? as_floats(uniform_vector(rng, -1e4, 1e4)) : Vec3d{};
  if (kind == 1) {
    const auto at = [&] { return Vec3d(uniform_lattice(rng, 3)); };
    return {at(), at(), at()};
  }
  const auto at = [&] { return as_floats(middle + uniform_vector(rng, -1, 1)); };
  Triangle t{at(), at(), at()};
  if (kind == 2)
    t.c = as_floats(t.a + (t.b - t.a) * 0.7 + uniform_vector(rng, -1, 1) * std::pow(10, uniform(rng, -6, -2)));
  return t;
}

/// A vertex, a point of an edge, or one of the face.
Vec3d random_target(Rng& rng, const Triangle& t) {
  const int kind = uniform_int(rng, 0, 2);
  if (kind == 0) return t.b;
  const double u = uniform_int(rng, 0, 1) ? 0.5 : uniform(rng, 0, 1);
  const Vec3d edge = t.a + (t.b - t.a) * u;
  return kind == 1 ? edge : edge + (t.c - edge) * uniform(rng, 0, 1);
}

bool exactly_hit(const Triangle& t, const FloatLine& line) {
  return !exact_crossings(t, exact_line(line.origin, line.direction)).empty();
}
std::optional<double> exact_parameter(const Triangle& t, const FloatLine& line) {
  const auto found = exact_crossings(t, exact_line(line.origin, line.direction));
  return found.empty() ? std::nullopt : std::optional(double(to_quad(found[0].t)));
}

TEST(Triangle, IsDecidedAsRationalsDecideByEveryNumberTypeThatIsSure) {
  Rng rng(11);
  DecisionCount count;
  for (int i = 0; i < 60000; ++i) {
    Vec3d middle;
    const Triangle t = random_triangle(rng, i % 4, middle);
    const FloatLine line = awkward_line(rng, (i / 4) % kAwkwardKinds, random_target(rng, t), middle);
    check_line(t, line.origin, line.direction, count);
    if (HasFailure()) FAIL() << "line " << i;
  }
  EXPECT_EQ(count.rounded_wrongly, 0) << "of " << count.rays();
  EXPECT_GT(count.by_double, count.rays() / 2);
}

TEST(Triangle, NeedsOnlyDoublesOnUniformRays) {
  Rng rng(12);
  DecisionCount count;
  for (int i = 0; i < 20000; ++i) {
    Vec3d middle;
    const Triangle t = random_triangle(rng, 0, middle);
    const FloatLine line = awkward_line(rng, 0, {}, middle);
    check_line(t, line.origin, line.direction, count);
  }
  EXPECT_EQ(count.rounded_wrongly, 0);
  EXPECT_LE(count.by_quad + count.by_rationals, 2);
}

TEST(Triangle, KeepsItsErrorBoundsOnLinesThatAreRoundedThemselves) {
  Rng rng(13);
  int sure = 0;
  for (int i = 0; i < 20000; ++i) {
    Vec3d middle;
    const Triangle t = random_triangle(rng, i % 4, middle);
    const UncertainLine line = uncertain_line(rng, random_target(rng, t), middle);
    sure += expect_exact(crossings(t, line.known), exact_crossings(t, line.exactly));
    if (HasFailure()) FAIL() << "line " << i;
  }
  EXPECT_GT(sure, 5000);
}

template <int N>
void expect_lanes_to_cross(const Triangle& t, const std::vector<FloatLine>& lines, uint32_t crossing) {
  for (size_t first = 0; first < lines.size(); first += N) {
    const auto lanes = [&](auto component) {
      return FloatLanes<N>([&](auto i) { return component(lines[first + i]); });
    };
    const Vec3<FloatLanes<N>> o{lanes([](const FloatLine& l) { return l.origin.x; }),
                                lanes([](const FloatLine& l) { return l.origin.y; }),
                                lanes([](const FloatLine& l) { return l.origin.z; })};
    const Vec3<FloatLanes<N>> d{lanes([](const FloatLine& l) { return l.direction.x; }),
                                lanes([](const FloatLine& l) { return l.direction.y; }),
                                lanes([](const FloatLine& l) { return l.direction.z; })};
    const uint32_t missing = crossing >> first & ~lanes_that_may_cross<N>(t, o, d) & ((uint64_t(1) << N) - 1);
    EXPECT_EQ(missing, 0u);
  }
}

TEST(Triangle, NoLookInFloatsLeavesOutALineThatCrosses) {
  Rng rng(14);
  int crossings_seen = 0, left_out = 0;
  for (int i = 0; i < 4000; ++i) {
    Vec3d middle;
    const Triangle t = random_triangle(rng, i % 4, middle);
    std::vector<FloatLine> lines;
    uint32_t crossing = 0, sure = 0;
    for (uint32_t k = 0; k < 16; ++k) {
      lines.push_back(awkward_line(rng, int(k) % kAwkwardKinds, random_target(rng, t), middle));
      crossing |= uint32_t(exactly_hit(t, lines.back())) << k;
      const Vec3<FloatLanes<1>> o(lines.back().origin), d(lines.back().direction);
      sure |= (lanes_that_may_cross<1>(t, o, d) & 1) << k;
    }
    crossings_seen += std::popcount(crossing), left_out += 16 - std::popcount(sure);
    expect_lanes_to_cross<1>(t, lines, crossing), expect_lanes_to_cross<4>(t, lines, crossing);
    expect_lanes_to_cross<8>(t, lines, crossing), expect_lanes_to_cross<16>(t, lines, crossing);
    if (HasFailure()) FAIL() << "triangle " << i;
  }
  EXPECT_GT(crossings_seen, 10000);
  EXPECT_GT(left_out, 10000);
}

// ---- closed meshes

using Mesh = std::vector<Triangle>;

/// A closed bumpy mesh about 0, its vertices multiples of 1/1024, every face with its own order of vertices.
Mesh bumpy_mesh(Rng& rng, int rows, int columns) {
  std::vector<std::vector<Vec3d>> grid(size_t(rows + 1), std::vector<Vec3d>(size_t(columns)));
  for (int i = 0; i <= rows; ++i)
    for (int j = 0; j < columns; ++j) {
      const double theta = std::numbers::pi * i / rows, phi = 2 * std::numbers::pi * j / columns;
      const double r = uniform(rng, 1, 6);
      const Vec3d p{r * std::sin(theta) * std::cos(phi), r * std::cos(theta), r * std::sin(theta) * std::sin(phi)};
      const bool pole = i == 0 || i == rows;
      const auto snap = [](double x) { return std::round(x * 1024) / 1024; };
      grid[size_t(i)][size_t(j)] = pole ? Vec3d{0, i == 0 ? 4.0 : -4.0, 0} : Vec3d{snap(p.x), snap(p.y), snap(p.z)};
    }
  Mesh mesh;
  const auto add = [&](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    if (a == b || b == c || c == a) return;
    const int turn = uniform_int(rng, 0, 2);
    mesh.push_back(turn == 0 ? Triangle{a, b, c} : turn == 1 ? Triangle{b, c, a} : Triangle{c, a, b});
  };
  for (size_t i = 0; i < size_t(rows); ++i)
    for (size_t j = 0; j < size_t(columns); ++j) {
      const size_t k = (j + 1) % size_t(columns);
      add(grid[i][j], grid[i][k], grid[i + 1][k]);
      add(grid[i][j], grid[i + 1][k], grid[i + 1][j]);
    }
  return mesh;
}

/// Faces entered and left, in front of the origin and behind it.
struct Passage {
  int entered_before = 0, left_before = 0, entered_after = 0, left_after = 0;

  [[nodiscard]] int entered() const { return entered_before + entered_after; }
  [[nodiscard]] int left() const { return left_before + left_after; }
};

/// As a renderer decides: double, binary128, rationals.
std::optional<double> decided_parameter(const Triangle& t, const FloatLine& line) {
  const auto found = crossings(t, exact_object_line<double>(line.origin, line.direction));
  if (!found.doubtful) return found.at[0].present ? std::optional(found.at[0].t) : std::nullopt;
  const auto wide = crossings(t, exact_object_line<Quad>(line.origin, line.direction));
  if (!wide.doubtful) return wide.at[0].present ? std::optional(double(wide.at[0].t)) : std::nullopt;
  return exact_parameter(t, line);
}

Passage pass(const Mesh& mesh, const FloatLine& line) {
  Passage passage;
  for (const Triangle& t : mesh) {
    const auto at = decided_parameter(t, line);
    if (!at) continue;
    const bool entered = dot(cross(t.b - t.a, t.c - t.a), Vec3d(line.direction)) < 0, before = *at < 0;
    ++(entered  ? before ? passage.entered_before : passage.entered_after
       : before ? passage.left_before
                : passage.left_after);
  }
  return passage;
}

/// A vertex or the middle of an edge; their coordinates are multiples of 1/2048.
Vec3d vertex_or_edge(Rng& rng, const Mesh& mesh) {
  const Triangle& t = mesh[size_t(uniform_int(rng, 0, int(mesh.size()) - 1))];
  return uniform_int(rng, 0, 1) ? t.a : (t.a + t.b) * 0.5;
}

Vec3d lattice_origin(Rng& rng, double size) {
  const auto at = [&] { return std::round(uniform(rng, -size, size) * 1024) / 1024; };
  return {at(), at(), at()};
}

TEST(Triangle, ClosedMeshesAreEnteredAsOftenAsLeftThroughVerticesAndEdges) {
  Rng rng(14);
  for (int m = 0; m < 4; ++m) {
    const Mesh mesh = bumpy_mesh(rng, 12, 14);
    for (int i = 0; i < 1500; ++i) {
      const Vec3d origin = lattice_origin(rng, i % 2 ? 0.1 : 9);
      const Vec3d target = vertex_or_edge(rng, mesh);
      const FloatLine line{Vec3f(origin), Vec3f(target - origin)};
      ASSERT_EQ(Vec3d(line.origin) + Vec3d(line.direction), target);  // aimed exactly
      const Passage passage = pass(mesh, line);
      ASSERT_EQ(passage.entered(), passage.left()) << i;
      if (i % 2) {
        ASSERT_EQ(passage.left_after - passage.entered_after, 1) << i;
        ASSERT_EQ(passage.entered_before - passage.left_before, 1) << i;
      }
    }
  }
}

TEST(Triangle, ExactlyOneFaceIsEnteredAndOneLeftFromTheMiddleOfAStar) {
  Rng rng(15);
  for (int m = 0; m < 4; ++m) {
    const Mesh mesh = bumpy_mesh(rng, 12, 14);
    for (int i = 0; i < 1000; ++i) {
      const FloatLine line{{0, 0, 0}, Vec3f(vertex_or_edge(rng, mesh) * std::exp2(uniform_int(rng, -60, 60)))};
      const Passage passage = pass(mesh, line);
      ASSERT_EQ(passage.left_after, 1) << i;
      ASSERT_EQ(passage.entered_before, 1) << i;
      ASSERT_EQ(passage.entered() + passage.left(), 2) << i;
    }
  }
}

TEST(Triangle, ClosedMeshesDoNotLeakBesideVerticesAndEdgesNorFarFromTheOrigin) {
  Rng rng(16);
  for (int m = 0; m < 4; ++m) {
    Mesh mesh = bumpy_mesh(rng, 12, 14);
    const Vec3d offset = m % 2 ? Vec3d{148376, 1234, -223423} : Vec3d{};
    for (Triangle& t : mesh) t = {as_floats(t.a + offset), as_floats(t.b + offset), as_floats(t.c + offset)};
    for (int i = 0; i < 1000; ++i) {
      const Vec3d origin = offset + uniform_vector(rng, -0.1, 0.1);
      const FloatLine line = aimed(rng, vertex_or_edge(rng, mesh), origin, 1);
      const Passage passage = pass(mesh, line);
      ASSERT_EQ(passage.left_after - passage.entered_after, 1) << i;
      ASSERT_EQ(passage.entered(), passage.left()) << i;
    }
  }
}

// ---- named cases

const Triangle kUnit{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

TEST(Triangle, IsMissedByRaysInItsPlane) {
  for (const Vec3f& origin : {Vec3f{-1, 0.25f, 0}, Vec3f{0, 0, 0}, Vec3f{-1, 0, 0}, Vec3f{0.25f, 0.25f, 0}}) {
    EXPECT_FALSE(decided_parameter(kUnit, {origin, {1, 0, 0}}));
    EXPECT_FALSE(decided_parameter(kUnit, {origin, {1, -1, 0}}));
  }
}

TEST(Triangle, WithoutAreaIsNeverHit) {
  const Triangle line{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, point{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}},
      repeated{{0, 0, 0}, {1, 0, 0}, {1, 0, 0}};
  for (const Triangle& t : {line, point, repeated})
    for (const Vec3d& target : {t.a, t.b, (t.a + t.c) * 0.5})
      EXPECT_FALSE(decided_parameter(t, {{0.5f, 0.25f, 5}, Vec3f(target) - Vec3f{0.5f, 0.25f, 5}}));
}

TEST(Triangle, IsMissedByZeroDirections) { EXPECT_FALSE(decided_parameter(kUnit, {{0.25f, 0.25f, 0}, {0, 0, 0}})); }

TEST(Triangle, NaNAndInfinitiesAreInDoubt) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  for (const float bad : {nan, inf, -inf})
    for (int axis = 0; axis < 6; ++axis) {
      float v[6] = {0.25f, 0.25f, 3, 0.125f, 0.125f, -1};
      v[axis] = bad;
      const Vec3f o{v[0], v[1], v[2]}, d{v[3], v[4], v[5]};
      EXPECT_TRUE(crossings(kUnit, exact_object_line<double>(o, d)).doubtful);
      EXPECT_TRUE(crossings(kUnit, exact_object_line<Quad>(o, d)).doubtful);
    }
}

TEST(Triangle, IsMetFromAnOriginInItsPlaneOrAtItsVertexAtZero) {
  EXPECT_EQ(decided_parameter(kUnit, {{0.25f, 0.25f, 0}, {0, 0, 1}}), 0);
  // The vertex (0, 0, 0) counts as moved along +x, then +y: into the triangle.
  EXPECT_EQ(decided_parameter(kUnit, {{0, 0, 0}, {0, 0, 1}}), 0);
  EXPECT_FALSE(decided_parameter(kUnit, {{1, 0, 0}, {0, 0, 1}}));
}

TEST(Triangle, HoldsForHugeAndDenormalCoordinates) {
  for (const double size : {1e18, 1e-18, 0x1p-140}) {
    const Triangle t{as_floats({0, 0, 0}), as_floats({size, 0, 0}), as_floats({0, size, 0})};
    const auto size_f = float(size);
    EXPECT_TRUE(decided_parameter(t, {{size_f / 4, size_f / 4, size_f}, {0, 0, -1}}));
    EXPECT_FALSE(decided_parameter(t, {{size_f, size_f, size_f}, {0, 0, -1}}));
  }
}

TEST(Triangle, SharedEdgesHaveOneOwnerWhicheverWayTheyRun) {
  Rng rng(17);
  for (int i = 0; i < 2000; ++i) {
    const auto at = [&] { return Vec3d(uniform_lattice(rng, 4)); };
    const Vec3d a = at(), b = at();
    if (a == b) continue;
    // Lines that pass the middle of the edge from one side to the other of a fold: front and back count up to 0 or 2.
    const Vec3d c = at(), d = at();
    const FloatLine line{Vec3f((a + b) * 0.5) + uniform_lattice(rng, 3), Vec3f(uniform_lattice(rng, 3))};
    const FloatLine through{Vec3f((a + b) * 0.5) - line.direction, line.direction};
    for (const Triangle& t : {Triangle{a, b, c}, Triangle{b, c, a}, Triangle{c, a, b}, Triangle{b, a, c}})
      EXPECT_EQ(exactly_hit(t, through), exactly_hit({a, b, c}, through));
    // A closed tetrahedron on that edge.
    const Mesh mesh{{a, b, c}, {b, a, d}, {c, b, d}, {a, c, d}};
    const Passage passage = pass(mesh, through);
    EXPECT_EQ(passage.entered(), passage.left());
    EXPECT_LE(passage.entered(), 1);
  }
}

TEST(Triangle, TJunctionsMayLeak) {
  // b d of the large triangle is split by m on one side only, and m is off the edge by rounding: not one closed mesh.
  const Triangle large{{0, 0, 0}, {3, 0, 0}, {0, 3, 0}};
  const Vec3d m = as_floats({1.1, 1.9, 0}) + Vec3d{0x1p-20, 0x1p-20, 0};
  const Triangle lower{{3, 0, 0}, {3, 3, 0}, m}, upper{m, {3, 3, 0}, {0, 3, 0}};
  const FloatLine gap{Vec3f(Vec3d{(m.x + 3) / 2 - 0x1p-22, m.y / 2, 1}), {0, 0, -1}};
  EXPECT_FALSE(exactly_hit(large, gap) || exactly_hit(lower, gap) || exactly_hit(upper, gap));
}

TEST(Triangle, TextbookAlgorithmsAgreeWithRationalsAwayFromEdges) {
  Rng rng(18);
  for (int i = 0; i < 20000; ++i) {
    Vec3d middle;
    const Triangle t = random_triangle(rng, 0, middle);
    const FloatLine line = awkward_line(rng, 0, {}, middle);
    const Rayd ray{Vec3d(line.origin), Vec3d(line.direction), -1e300, 1e300};
    const auto exactly = exact_parameter(t, line);
    for (const auto& hit : {intersect_by_half_spaces(t, ray), intersect_by_cramer(t, ray)}) {
      ASSERT_EQ(hit.has_value(), exactly.has_value());
      if (!hit) continue;
      EXPECT_NEAR(hit->t, *exactly, 1e-9 * (1 + std::abs(*exactly)));
      const Vec3d p = t.a + (t.b - t.a) * hit->u + (t.c - t.a) * hit->v;
      EXPECT_NEAR(length(p - point_at(ray, hit->t)), 0, 1e-8 * (1 + std::abs(hit->t)));
    }
  }
}

TEST(Triangle, TextbookAlgorithmsKeepToTheRangeAndAreClosed) {
  for (const auto intersect : {intersect_by_half_spaces, intersect_by_cramer}) {
    EXPECT_TRUE(intersect(kUnit, Rayd{{0, 0, 1}, {0, 0, -1}}));
    EXPECT_TRUE(intersect(kUnit, Rayd{{0.5, 0.5, 1}, {0, 0, -1}, 1, 1}));
    EXPECT_FALSE(intersect(kUnit, Rayd{{0.25, 0.25, 1}, {0, 0, -1}, 0, 0.5}));
    EXPECT_FALSE(intersect(kUnit, Rayd{{0.25, 0.25, 1}, {0, 0, 1}}));
    EXPECT_FALSE(intersect(kUnit, Rayd{{0.25, 0.25, 0}, {1, 0, 0}}));
    EXPECT_FALSE(intersect(kUnit, Rayd{{0.25, 0.25, 0}, {0, 0, 0}}));
  }
}

}  // namespace
}  // namespace alhazen
