#include "crosscheck/subject.h"

#include <numbers>

namespace alhazen {

Bounds3d bounds(const Triangle& t) noexcept { return {min(t.a, min(t.b, t.c)), max(t.a, max(t.b, t.c))}; }

Vec3d project(const Triangle& t, const Vec3d& p, int face) noexcept {
  const Vec3d n = normal(t, p, face);
  return p - n * dot(p - t.a, n);
}

Vec3d normal(const Triangle& t, const Vec3d&, int) noexcept { return normalize(cross(t.b - t.a, t.c - t.a)); }

}  // namespace alhazen

namespace alhazen::crosscheck {
namespace {

double as_float(double x) { return double(float(x)); }
Vec3d as_float(const Vec3d& v) { return Vec3d(Vec3f(v)); }

/// A size: an even integer on the lattice, else a float over four decades.
double size(Random& random, bool lattice) {
  return lattice ? 2 * random.integer(1, 5) : as_float(random.decades(-2, 2));
}

Surface make_sphere(Random& random, bool lattice) {
  constexpr double kLatticeRadii[] = {5, 13, 3, 1};  // 3-4-5 and 5-12-13: tangents that are rational
  return Sphere{lattice ? kLatticeRadii[random.integer(0, 3)] : size(random, false)};
}

Surface make_cylinder(Random& random, bool lattice) {
  const double h = size(random, lattice), r = size(random, lattice);
  return Cylinder{h, r, r, true};
}

Surface make_cone(Random& random, bool lattice) {
  Cylinder c{size(random, lattice), size(random, lattice), size(random, lattice), true};
  if (random.coin()) (random.coin() ? c.radius_top : c.radius_bottom) = 0;
  return c;
}

Surface make_tube(Random& random, bool lattice) {
  Cylinder c = std::get<Cylinder>(random.coin() ? make_cylinder(random, lattice) : make_cone(random, lattice));
  c.caps = false;
  return c;
}

Surface make_disk(Random& random, bool lattice) { return Disk{lattice ? 5.0 : size(random, false), 0}; }

Surface make_ring(Random& random, bool lattice) {
  const double r = size(random, false);
  return lattice ? Disk{13, 5} : Disk{r, as_float(r * random.uniform(0.1, 0.95))};
}

Surface make_box(Random& random, bool lattice) {
  const double x = size(random, lattice), y = size(random, lattice);
  return Box{{x, y, size(random, lattice)}};
}

/// A plane through points that floats hold exactly: origin + i x + j y for multiples i, j of 2^-6 up to 1.
struct LatticePlane {
  Vec3d origin, x, y;

  LatticePlane(Random& random, bool lattice) {
    const double scale = lattice ? 4 : std::exp2(random.integer(-6, 6));
    do {
      x = random.on_lattice(4) * scale, y = random.on_lattice(4) * scale;
    } while (cross(x, y) == Vec3d{});
    origin = random.on_lattice(8) * (lattice ? 1 : scale);
  }
  [[nodiscard]] Vec3d point(double radius, double turns) const {
    const auto rounded = [&](double v) { return std::round(v * 64) / 64; };
    const double angle = 2 * std::numbers::pi * turns;
    return origin + x * rounded(radius * std::cos(angle)) + y * rounded(radius * std::sin(angle));
  }
};

Surface make_convex_polygon(Random& random, bool lattice) {
  const LatticePlane plane(random, lattice);
  if (lattice || random.coin())
    return make_polygon(
        {{plane.origin - plane.x, plane.origin + plane.y, plane.origin + plane.x, plane.origin - plane.y}});
  std::vector<Vec3d> loop;
  const int n = random.integer(3, 8);
  for (int k = 0; k < n; ++k) loop.push_back(plane.point(1, double(k) / n));
  return make_polygon({loop});
}

Surface make_star(Random& random, bool lattice) {
  const LatticePlane plane(random, lattice);
  std::vector<std::vector<Vec3d>> loops(2);
  for (int k = 0; k < 9; ++k) {
    loops[0].push_back(plane.point(lattice ? 1 : random.uniform(0.4, 1), k / 9.0));
    loops[1].push_back(plane.point(0.25, k / 9.0));
  }
  return make_polygon(loops);
}

Surface make_quadric(Random& random, bool lattice) {
  Quadric q;
  if (lattice) {
    for (size_t k = 0; k < 10; ++k) q.coefficients[k] = random.integer(-2, 2);
    q.coefficients[9] *= 4;
    q.box = {{-4, -4, -4}, {4, 4, 4}};
  } else {
    for (double& c : q.coefficients) c = random.uniform(0, 1) < 0.2 ? 0 : as_float(random.uniform());
    q.coefficients[9] = as_float(q.coefficients[9] * 0.3);
  }
  q.solid = random.coin();
  if (const auto box = ellipsoid_bounds(q.coefficients); box && q.coefficients[0] > 0 && random.coin())
    q.box = *box, q.whole = true;
  return q;
}

ClosedBody closed_body(Random& random, bool lattice) {
  switch (random.integer(0, 3)) {
    case 0:
      return Sphere{lattice ? double(random.integer(1, 5)) : as_float(random.uniform(0.4, 1))};
    case 1:
      return lattice ? Cylinder{2.0 * random.integer(1, 4), 2, 2, true}
                     : Cylinder{as_float(random.uniform(0.5, 2)), as_float(random.uniform(0.2, 1)),
                                as_float(random.uniform(0.2, 1)), true};
    case 2:
      return lattice ? Box{{2.0 * random.integer(1, 4), 4, 4}}
                     : Box{as_float(Vec3d{1.2, 1.2, 1.2} + random.in_cube(0.7))};
    default: {
      auto q = std::get<Quadric>(make_quadric(random, lattice));
      q.solid = true;
      return q;
    }
  }
}

Surface make_composite_surface(Random& random, bool lattice) {
  const auto operation = [&] { return CompositeNode::Operation(random.integer(1, 3)); };
  const auto operand = [&]() -> CompositeOperand {
    Affine3d m;
    if (lattice) {
      m.origin = random.on_lattice(2);
    } else {
      do {
        m = {as_float(random.in_cube()), as_float(random.in_cube()), as_float(random.in_cube()), {}};
      } while (std::abs(determinant(m)) < 0.1);
      m.origin = as_float(random.in_cube(0.4));
    }
    return {closed_body(random, lattice), m};
  };
  const CompositeOperand inner[] = {operand(), operand(), operand()};
  CompositeOperand whole = operand();
  whole.shape = make_composite(operation(), inner);
  const CompositeOperand outer[] = {whole, operand()};
  return make_composite(operation(), outer);
}

Surface make_triangle(Random& random, bool lattice) {
  Triangle t;
  do {
    const Vec3d from = lattice ? random.on_lattice(6) : random.in_cube();
    const double width = lattice || random.coin() ? 1 : random.decades(-6, -2);  // half of them needles
    const auto edge = [&] { return lattice ? random.on_lattice(6) : random.in_cube(); };
    const Vec3d along = edge();
    t = {as_float(from), as_float(from + along), as_float(from + along * (lattice ? 0 : 0.5) + edge() * width)};
  } while (cross(t.b - t.a, t.c - t.a) == Vec3d{});
  return t;
}

/// Where it stands, in floats: at home, moved, moved and scaled by a power of two, or anyhow. Seldom at home but on the
/// lattice: exact ties, frequent there, take a hundred times as long as other rays.
Affine3d place(Random& random, bool lattice) {
  const int kind = random.integer(0, lattice ? 1 : 15);
  Affine3d m;
  if (kind == 0) return m;
  if (lattice) return {m.x, m.y, m.z, random.on_lattice(8)};
  const double far = random.decades(-1, 4);
  if (kind < 11) {
    const double scale = kind < 6 ? 1 : std::exp2(random.integer(-10, 10));
    return {m.x * scale, m.y * scale, m.z * scale, as_float(random.in_cube(far * scale))};
  }
  const double scale = random.decades(-3, 3);
  do {
    m = {as_float(random.in_cube(scale)), as_float(random.in_cube(scale)), as_float(random.in_cube(scale)), {}};
  } while (std::abs(determinant(m)) < 0.02 * scale * scale * scale);
  m.origin = as_float(random.in_cube(10 * scale));
  return m;
}

/// Stretched along the axes, on the lattice by integers.
Affine3d stretched_place(Random& random, bool lattice) {
  if (!lattice && random.coin()) {
    Affine3d m;
    do {
      m = {as_float(random.in_cube()), as_float(random.in_cube()), as_float(random.in_cube()), {}};
    } while (std::abs(determinant(m)) < 0.02);
    m.origin = as_float(random.in_cube(random.decades(-1, 4)));
    return m;
  }
  const double x = size(random, lattice), y = size(random, lattice), z = size(random, lattice);
  return {{x, 0, 0}, {0, y, 0}, {0, 0, z}, lattice ? random.on_lattice(4) : as_float(random.in_cube(10))};
}

Family family(const char* name, Surface (*make)(Random&, bool), Affine3d (*placed)(Random&, bool) = place,
              bool robust = false) {
  return {name,
          [make, placed](uint64_t, bool lattice, Random& random) {
            Surface surface = make(random, lattice);
            return Subject{std::move(surface), placed(random, lattice)};
          },
          2048, robust};
}

Affine3d at_home(Random&, bool) { return {}; }

/// A triangle for every few rays: it is made at no cost.
Family triangles(const char* name, bool robust) {
  Family f = family(name, make_triangle, at_home, robust);
  f.chunk_rays = 256;
  return f;
}

Surface make_unit_sphere(Random&, bool) { return Sphere{1}; }

}  // namespace

std::vector<std::vector<Vec3d>> loops_of(const Polygon& polygon) {
  const auto& vertices = polygon.vertices;
  std::vector<uint32_t> next(vertices.size());
  // Between equal vertices there is no edge: they follow each other, or close their loop.
  for (uint32_t k = 0; k + 1 < next.size(); ++k) next[k] = vertices[k] == vertices[k + 1] ? k + 1 : 0;
  for (const Polygon::Edge& edge : polygon.edges) next[edge.first] = edge.second;
  std::vector<std::vector<Vec3d>> loops(1);
  for (uint32_t k = 0; k < next.size(); ++k) {
    loops.back().push_back(vertices[k]);
    if (next[k] != k + 1 && k + 1 < next.size()) loops.emplace_back();
  }
  return loops;
}

const std::vector<Family>& built_in_families() {
  static const std::vector<Family> families = {family("sphere", make_sphere),
                                               family("ellipsoid", make_unit_sphere, stretched_place),
                                               family("cylinder", make_cylinder),
                                               family("cone", make_cone),
                                               family("tube", make_tube),
                                               family("disk", make_disk),
                                               family("ring", make_ring),
                                               family("box", make_box),
                                               family("polygon", make_convex_polygon),
                                               family("star", make_star),
                                               family("quadric", make_quadric),
                                               family("composite", make_composite_surface),
                                               triangles("triangle", false),
                                               triangles("triangle-robust", true)};
  return families;
}

}  // namespace alhazen::crosscheck
