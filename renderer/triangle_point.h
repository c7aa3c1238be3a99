// A point on a triangle from its corners, written once for a float and for lanes of floats. What is called once is
// inlined by order: lanes of doubles go through memory in calls.
#pragma once

#include <array>

#include "renderer/surface.h"

namespace alhazen {

inline constexpr double kUlp = 0x1p-24;  // half the spacing of floats, relative

/// What a triangle brings from the corners of its part, as far as the part has it. What it mostly lacks is kept in
/// memory that nobody sets to 0.
template <class F>
struct Corners {
  std::array<Vec3Array<F>, 3> p_object, n_object, t_object;
  Vec3<F> n_polygon;  // in object space
  F handedness;       // of the first tangent
  std::array<std::array<Vec2Array<F>, 3>, kMaxUvSets> uvs;
  std::array<RgbArray<F>, 3> colors;
  std::array<LaneArray<F>, 3> alphas;
};

/// The three corners' values.
template <class Array>
auto loaded(const std::array<Array, 3>& corner) {
  return std::array{corner[0].load(), corner[1].load(), corner[2].load()};
}

template <class V, class F>
V interpolated(const std::array<V, 3>& corner, const F& u, const F& v) {
  return corner[0] * (F(1) - u - v) + corner[1] * u + corner[2] * v;
}

/// (M^-1)^T n times |det M|.
template <class D>
Vec3<D> outer_normal(const Affine3<D>& m, const D& stretch, const Vec3<D>& n) {
  const Vec3<D> v = cross(m.y, m.z) * n.x + cross(m.z, m.x) * n.y + cross(m.x, m.y) * n.z;
  return select(stretch < D(0), -v, v);
}

/// Traversal computes a triangle's normal in floats in object space, as a cross product of its edges, and with it the
/// plane's distance from a ray that starts up to the longest edge away from a vertex: wrong by this over twice the
/// area. For needles that is many roundings; for a triangle of no area, more than its size would hide nothing any more.
template <class F>
[[gnu::always_inline]] inline DoubleOf<F> plane_error(const std::array<Vec3<F>, 3>& corner,
                                                      const DoubleOf<F>& twice_area) {
  using D = DoubleOf<F>;
  const F ab = length(corner[1] - corner[0]), bc = length(corner[2] - corner[1]), ca = length(corner[0] - corner[2]);
  const F low = smaller(ab, bc), high = larger(ab, bc);
  const F shortest = smaller(low, ca), middle = larger(low, smaller(high, ca)), longest = larger(high, ca);
  return convert<D>(longest) * smaller(D(D(8 * kUlp) * convert<D>(shortest) * convert<D>(middle)), twice_area);
}

/// Position, normals and their errors. `m`: to the world, or null for a part that lies there, to the same bits as with
/// the identity; `roundings`: of the position, in units of kUlp.
template <class F>
[[gnu::always_inline]] inline void place(const Corners<F>& corners, const Attributes& has, const F& u, const F& v,
                                         const Affine3<DoubleOf<F>>* m, const DoubleOf<F>& roundings,
                                         BasicSurfacePoint<F>& s) {
  using D = DoubleOf<F>;
  const auto vertex = [&](size_t k) { return convert<D>(corners.p_object[k].load()); };
  const Vec3<D> origin = vertex(0), e1 = vertex(1) - origin, e2 = vertex(2) - origin;
  const Vec3<D> p = origin + e1 * convert<D>(u) + e2 * convert<D>(v);
  s.p_world = m ? transform_point(*m, p) : p;
  const Vec3<D> across = cross(e1, e2),
                outward = m ? cross(transform_vector(*m, e1), transform_vector(*m, e2)) : across;
  const D squared = dot(outward, outward), length_outward = square_root(squared), reciprocal = D(1) / length_outward;
  const D stretch = m ? determinant(*m) : D(1);
  const Vec3<D> ng = select(squared > D(0), outward * reciprocal, outward);
  s.ng_world = s.ns_world = convert<F>(select(stretch < D(0), -ng, ng));

  const auto size_of = [](const Vec3<D>& x) { return larger(absolute(x.x), larger(absolute(x.y), absolute(x.z))); };
  const D twice_area = m ? length(across) : length_outward;
  D size = size_of(s.p_world), error = plane_error(loaded(corners.p_object), twice_area);
  if (m) size = size + size_of(m->origin), error = error * absolute(stretch);
  s.offset = convert<F>(D(D(kUlp) * roundings * size + error * reciprocal));

  if (has.normals || has.polygon_normals) {
    const Vec3<F> n = has.normals ? interpolated(loaded(corners.n_object), u, v) : corners.n_polygon;
    const Vec3<F> n_world =
        unit_vector(m ? convert<F>(outer_normal(*m, stretch, convert<D>(n)) * D(D(1) / absolute(stretch))) : n);
    const F n_squared = dot(n_world, n_world);
    s.ns_world = select(MaskOf<F>(n_squared > F(0) && n_squared - n_squared == F(0)), n_world, s.ns_world);
  }
  if (has.tangents) {
    const Vec3<F> t = interpolated(loaded(corners.t_object), u, v);
    s.tangent_world = unit_vector(m ? convert<F>(transform_vector(*m, convert<D>(t))) : t);
    s.bitangent_sign = select(convert_mask<F>(stretch < D(0)), F(-corners.handedness), corners.handedness);
  }
}

/// Texture coordinates and colour. How fast the coordinates go is left as unknown.
template <class F>
[[gnu::always_inline]] inline void interpolate_attributes(const Corners<F>& corners, const Attributes& has, const F& u,
                                                          const F& v, BasicSurfacePoint<F>& s) {
  s.uv_count = int(has.uv_sets);
  for (size_t k = 0; k < has.uv_sets; ++k)
    s.uvs[k] = interpolated(loaded(corners.uvs[k]), u, v), s.uv_per_metre[k] = F(0);
  if (!has.colors) return;
  s.color = {interpolated(loaded(corners.colors), u, v), interpolated(loaded(corners.alphas), u, v)};
}

/// How fast the texture coordinates go over the triangle: the root of the ratio of the areas.
template <class F>
[[gnu::always_inline]] inline void measure_uvs(const Corners<F>& corners, const Attributes& has,
                                               const Affine3<DoubleOf<F>>* m, BasicSurfacePoint<F>& s) {
  using D = DoubleOf<F>;
  const auto vertex = [&](size_t k) {
    const Vec3<D> p = convert<D>(corners.p_object[k].load());
    return m ? transform_point(*m, p) : p;
  };
  const Vec3<D> p0 = vertex(0);
  const F area = convert<F>(length(cross(vertex(1) - p0, vertex(2) - p0)));
  for (size_t k = 0; k < has.uv_sets; ++k) {
    const auto [a, b, c] = loaded(corners.uvs[k]);
    const F uv_area = absolute(F((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)));
    s.uv_per_metre[k] = select(area > F(0), square_root(F(uv_area / area)), F(0));
  }
}

/// Half the divergence of the normals, which are linear between the corners. Not a number where the triangle is none.
template <class F>
F mesh_curvature(const Corners<F>& corners, const Affine3<DoubleOf<F>>* m) {
  using D = DoubleOf<F>;
  const std::array<Vec3<F>, 3> p = loaded(corners.p_object);
  const D stretch = m ? determinant(*m) : D(1);
  const auto edge = [&](size_t k) {
    const Vec3<D> e = convert<D>(p[k]) - convert<D>(p[0]);
    return convert<F>(m ? transform_vector(*m, e) : e);
  };
  const auto normal = [&](size_t k) {
    const Vec3<F> n = corners.n_object[k].load();
    return normalize(m ? convert<F>(outer_normal(*m, stretch, convert<D>(n))) : n);
  };
  const Vec3<F> e1 = edge(1), e2 = edge(2), across = cross(e1, e2), n0 = normal(0);
  // Per unit of each edge, times the vector that is 1 along it and 0 along the other.
  const F divergence = dot(normal(1) - n0, cross(e2, across)) + dot(normal(2) - n0, cross(across, e1));
  return divergence / (F(2) * dot(across, across));
}

/// Where curvature is not a number, there is none.
template <class N>
N finite_or_0(const N& x) {
  return select(x - x == N(0), x, N(0));
}

}  // namespace alhazen
