#include "renderer/lane_surfaces.h"

#include <array>
#include <bit>

#include "accel/line_map.h"
#include "accel/shapes/polygon_plane.h"
#include "renderer/shape_point.h"

namespace alhazen {
namespace {

using F = ShadingLanes;
using D = DoubleOf<F>;
using U = UintOf<F>;

void set_mesh_points(const LaneTriangles& triangles, const LaneHits& hits, const Attributes& has, bool measure,
                     BasicSurfacePoint<F>& s) {
  const F u = hits.u.load(), v = hits.v.load();
  interpolate_attributes(triangles.corners, has, u, v, s);
  // Compiled twice, so that what lies in the world asks for no map again and again.
  const auto set_points = [&](const LaneMap* map) __attribute__((always_inline)) {
    if (measure) measure_uvs(triangles.corners, has, map, s);
    place(triangles.corners, has, u, v, map, triangles.roundings, s);
  };
  if (const LaneMap* const map = triangles.map())
    set_points(map);
  else
    set_points(nullptr);
}

/// What lanes are on, where it is of one kind.
template <class Kind>
using EachLanes = std::array<const Kind*, kWidthOf<F>>;

/// Points on shapes and their unit normals, in the shapes' own spaces.
struct ObjectPoints {
  Vec3<D> p, n;
};

/// One sphere, or sphere by sphere; as the kinds after it.
struct LaneSpheres {
  using Kind = Sphere;
  D radius;

  explicit LaneSpheres(const Sphere& sphere) : radius(sphere.radius) {}
  explicit LaneSpheres(const EachLanes<Sphere>& spheres) : radius([&](auto k) { return spheres[k]->radius; }) {}

  [[nodiscard]] ObjectPoints near(const Vec3<D>& p_object) const {
    const Vec3<D> p = normalize(p_object) * radius;
    return {p, normalize(p)};
  }
};

struct LaneCylinders {
  using Kind = Cylinder;
  CylinderWall<D> wall;

  explicit LaneCylinders(const Cylinder& c) : wall{D(c.height), D(c.radius_bottom), D(c.radius_top)} {}
  explicit LaneCylinders(const EachLanes<Cylinder>& cylinders)
      : wall{D([&](auto k) { return cylinders[k]->height; }), D([&](auto k) { return cylinders[k]->radius_bottom; }),
             D([&](auto k) { return cylinders[k]->radius_top; })} {}

  [[nodiscard]] ObjectPoints near(const Vec3<D>& p_object) const {
    const Vec3<D> p = project(wall, p_object);
    return {p, normal(wall, p)};
  }
};

struct LaneQuadrics {
  using Kind = Quadric;
  std::array<D, 10> coefficients;

  explicit LaneQuadrics(const Quadric& quadric) {
    for (size_t c = 0; c < coefficients.size(); ++c) coefficients[c] = D(quadric.coefficients[c]);
  }
  explicit LaneQuadrics(const EachLanes<Quadric>& quadrics) {
    for (size_t c = 0; c < coefficients.size(); ++c)
      coefficients[c] = D([&](auto k) { return quadrics[k]->coefficients[c]; });
  }

  [[nodiscard]] ObjectPoints near(const Vec3<D>& p_object) const {
    const Vec3<D> p = project_to_wall(coefficients, p_object);
    return {p, wall_normal(coefficients, p)};
  }
};

/// Caps and other flat faces.
struct LaneFlatFaces {
  using Kind = FlatFace<double>;
  FlatFace<D> face;

  explicit LaneFlatFaces(const Kind& one) : face{D(one.axis), D(one.coordinate), D(one.side)} {}
  explicit LaneFlatFaces(const EachLanes<Kind>& faces)
      : face{D([&](auto k) { return faces[k]->axis; }), D([&](auto k) { return faces[k]->coordinate; }),
             D([&](auto k) { return faces[k]->side; })} {}

  [[nodiscard]] ObjectPoints near(const Vec3<D>& p_object) const { return {project(face, p_object), normal(face)}; }
};

/// Where shapes stand: all lanes' at one place, or each at its own.
struct LanePlaces {
  Affine3<D> world_from_object, object_from_world;
  D stretch;  // of volumes, below 0 where the map mirrors

  explicit LanePlaces(const Affine3d& m)
      : world_from_object(broadcast(m)), object_from_world(broadcast(inverse(m))), stretch(determinant(m)) {}
  explicit LanePlaces(const Affine3<D>& m)
      : world_from_object(m), object_from_world(inverse(m)), stretch(determinant(m)) {}
};

/// The hits in the shapes' spaces, about where their surfaces are.
Vec3<D> object_points(const LaneHits& hits, const LanePlaces& places) {
  const Vec3<D> along = convert<D>(hits.direction.load()) * convert<D>(hits.t.load());
  const Vec3<D> from_middle = convert<D>(hits.origin.load()) - places.world_from_object.origin;
  return transform_vector(places.object_from_world, from_middle + along);
}

/// What `shape_point` does with a point on a shape, but for texture coordinates.
void place(const ObjectPoints& points, const LanePlaces& places, const LaneHits& hits, BasicSurfacePoint<F>& s) {
  const Affine3<D>& m = places.world_from_object;
  s.p_world = transform_point(m, points.p);
  const Vec3<F> n = convert<F>(normalize(outer_normal(m, places.stretch, points.n)));
  s.ng_world = s.ns_world = select(dot(n, n) > F(0), n, -hits.direction.load());  // but at a singular point
  s.offset = shape_offset<F>(s.p_world);
}

/// For one polygon, with its texture coordinates: in all lanes lie one plane's.
void set_points_on(const Polygon& polygon, const Affine3d& m, const LaneHits& hits, BasicSurfacePoint<F>& s) {
  const Vec3d ng = normalize(transform_normal(m, polygon.unit_normal)), center = polygon.center;
  const LanePlaces places(m);
  const Vec3<D> p = nearest_in_plane(polygon, object_points(hits, places));
  s.p_world = transform_point(places.world_from_object, p);
  s.ng_world = s.ns_world = broadcast<F>(Vec3f(ng));
  s.offset = shape_offset<F>(s.p_world);
  s.tangent_world = broadcast<F>(Vec3f(normalize(transform_vector(m, u_tangent(polygon, center, 0)))));
  s.bitangent_sign = F(bitangent_sign(m));
  const Vec2<D> uv = uv_in_plane(polygon, p);
  s.uvs[0] = {convert<F>(uv.x), convert<F>(uv.y)};
}

std::optional<FlatFace<double>> flat_face_of(const Shape& shape, int face) {
  return std::visit([&](const auto& kind) { return flat_face(kind, face); }, shape);
}

/// On one face of one shape that all hits are on; none where it has no lanes' form.
std::optional<ObjectPoints> points_on_one(const Shape& shape, int face, const Vec3<D>& p_object) {
  if (const auto flat = flat_face_of(shape, face)) return LaneFlatFaces(*flat).near(p_object);
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return LaneSpheres(*sphere).near(p_object);
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) return LaneCylinders(*cylinder).near(p_object);
  if (const auto* quadric = std::get_if<Quadric>(&shape)) return LaneQuadrics(*quadric).near(p_object);
  return {};
}

/// Sets the points of those lanes that are on a shape of this kind; nulls in `each` are those that are not.
template <class LaneKind>
void add_points_on(EachLanes<typename LaneKind::Kind> each, const Vec3<D>& p_object, ObjectPoints& points,
                   uint32_t& left) {
  LaneArray<U> here;
  const typename LaneKind::Kind* some = nullptr;
  for (size_t k = 0; k < each.size(); ++k) here[k] = each[k] != nullptr, some = each[k] ? each[k] : some;
  if (!some) return;
  for (auto& shape : each) shape = shape ? shape : some;
  const ObjectPoints of_kind = LaneKind(each).near(p_object);
  const auto set = here.load() != U(0);
  const auto set_double = convert_mask<D>(set);
  points = {select(set_double, of_kind.p, points.p), select(set_double, of_kind.n, points.n)};
  left &= ~lane_bits(set);
}

/// On the shapes of each lane. Sets the lanes that are `left`.
ObjectPoints points_on_each(const std::array<const Shape*, kWidthOf<F>>& shapes, const LaneHits& hits,
                            const Vec3<D>& p_object, uint32_t& left) {
  std::array<FlatFace<double>, kWidthOf<F>> faces;
  EachLanes<FlatFace<double>> flat{};
  EachLanes<Sphere> spheres{};
  EachLanes<Cylinder> cylinders{};
  EachLanes<Quadric> quadrics{};
  for (size_t k = 0; k < shapes.size(); ++k) {
    if (hits.part[k] == kWallFace) {
      spheres[k] = std::get_if<Sphere>(shapes[k]), cylinders[k] = std::get_if<Cylinder>(shapes[k]),
      quadrics[k] = std::get_if<Quadric>(shapes[k]);
    } else if (const auto face = flat_face_of(*shapes[k], int(hits.part[k]))) {
      faces[k] = *face, flat[k] = &faces[k];
    }
  }
  ObjectPoints points{p_object, p_object};
  left = kEveryLane;
  add_points_on<LaneFlatFaces>(flat, p_object, points, left);
  add_points_on<LaneSpheres>(spheres, p_object, points, left);
  add_points_on<LaneCylinders>(cylinders, p_object, points, left);
  add_points_on<LaneQuadrics>(quadrics, p_object, points, left);
  return points;
}

/// Answers the lanes that are left.
uint32_t set_points_in_lanes(const Scene& scene, const LaneHits& hits, bool has_textures, BasicSurfacePoint<F>& s) {
  const Geometry& geometry = scene.geometry;
  std::array<const Shape*, kWidthOf<F>> shapes;
  std::array<const Affine3d*, kWidthOf<F>> maps;
  const auto find = [&](size_t k) {
    const ShapeInstance& placed = shape_instance(geometry, hits.object[k]);
    shapes[k] = &geometry.shapes[placed.shape], maps[k] = &placed.world_from_object;
  };
  find(0);
  if (lane_bits(on_part_of(hits, 0)) == kEveryLane) {
    if (const auto* polygon = std::get_if<Polygon>(shapes[0])) return set_points_on(*polygon, *maps[0], hits, s), 0;
    if (has_textures) return kEveryLane;
    const LanePlaces places(*maps[0]);
    const auto points = points_on_one(*shapes[0], int(hits.part[0]), object_points(hits, places));
    if (points) place(*points, places, hits, s);
    return points ? 0 : kEveryLane;
  }
  if (has_textures) return kEveryLane;
  for (size_t k = 1; k < kWidthOf<F>; ++k) find(k);
  const LanePlaces places(lane_maps(maps));
  uint32_t left = 0;
  const ObjectPoints points = points_on_each(shapes, hits, object_points(hits, places), left);
  place(points, places, hits, s);
  return left;
}

void set_points_one_by_one(const Scene& scene, const LaneHits& hits, bool has_textures, uint32_t lanes,
                           BasicSurfacePoint<F>& s) {
  Vec3Array<D> p;
  LaneArray<F> offset, bitangent_sign, u, v;
  Vec3Array<F> ng, ns, tangent;
  p.store(s.p_world), offset.store(s.offset), ng.store(s.ng_world), ns.store(s.ns_world);
  tangent.store(s.tangent_world), bitangent_sign.store(s.bitangent_sign);
  u.store(s.uvs[0].x), v.store(s.uvs[0].y);
  for (; lanes; lanes &= lanes - 1) {
    const auto k = size_t(std::countr_zero(lanes));
    const Rayf ray{hits.origin.get(k), hits.direction.get(k)};
    const SurfacePoint one = shape_point(scene, ray, hits.ids(k), hits.t[k], 0, has_textures);
    p.set(k, one.p_world), ng.set(k, one.ng_world), ns.set(k, one.ns_world), tangent.set(k, one.tangent_world);
    offset[k] = one.offset, bitangent_sign[k] = one.bitangent_sign;
    u[k] = one.uvs[0].x, v[k] = one.uvs[0].y;
  }
  s.p_world = p.load(), s.offset = offset.load();
  s.ng_world = ng.load(), s.ns_world = ns.load(), s.tangent_world = tangent.load();
  s.bitangent_sign = bitangent_sign.load();
  s.uvs[0] = {u.load(), v.load()};
}

void set_shape_points(const Scene& scene, const LaneHits& hits, bool has_textures, BasicSurfacePoint<F>& s) {
  const uint32_t left = set_points_in_lanes(scene, hits, has_textures, s);
  if (left != 0) set_points_one_by_one(scene, hits, has_textures, left, s);
  s.uv_count = 1;
}

}  // namespace

BasicSurfacePoint<F> surface_points(const Scene& scene, const LaneHits& hits, const Attributes& has, bool has_textures,
                                    std::optional<LaneTriangles>& triangles) noexcept {
  BasicSurfacePoint<F> s;
  if (is_shape(scene.geometry, hits.object[0]))
    set_shape_points(scene, hits, has_textures, s);
  else
    set_mesh_points(triangles.emplace(scene, hits, has), hits, has, has_textures, s);
  return s;
}

F mean_curvature(const Scene& scene, const LaneHits& hits, const Attributes& has, const BasicSurfacePoint<F>& points,
                 const std::optional<LaneTriangles>& triangles, const F& width) noexcept {
  if (!triangles) {
    const ShapeCurvature on_first(scene, hits.object[0], 0);
    if (on_first.is_even() && lane_bits(on_object_of(hits, 0)) == kEveryLane) return on_first.even(width);
    Vec3Array<D> p;
    Vec3Array<F> ng;
    LaneArray<F> widths, curvature;
    p.store(points.p_world), ng.store(points.ng_world), widths.store(width);
    for (size_t k = 0; k < kWidthOf<F>;) {
      const uint32_t object = hits.object[k];
      const ShapeCurvature on_shape(scene, object, 0);
      for (; k < kWidthOf<F> && hits.object[k] == object; ++k)
        curvature[k] = on_shape.at(int(hits.part[k]), p.get(k), ng.get(k), widths[k]);
    }
    return finite_or_0(curvature.load());
  }
  if (!has.normals) return F(0);
  return finite_or_0(mesh_curvature(triangles->corners, triangles->map()));
}

}  // namespace alhazen
