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

using LaneShapes = std::array<const Shape*, kWidthOf<F>>;

/// One sphere, or sphere by sphere.
struct LaneSpheres {
  using Kind = Sphere;
  D radius;

  explicit LaneSpheres(const Sphere& sphere) : radius(sphere.radius) {}
  explicit LaneSpheres(const LaneShapes& shapes)
      : radius([&](auto k) { return std::get_if<Sphere>(shapes[k])->radius; }) {}

  [[nodiscard]] uint32_t doubtful(const LaneHits&) const { return 0; }
  [[nodiscard]] Vec3<D> projected(const Vec3<D>& p) const { return normalize(p) * radius; }
  [[nodiscard]] static Vec3<D> normal(const Vec3<D>& p) { return normalize(p); }
};

/// The same of quadrics; caps and double planes are left to be done one by one.
struct LaneQuadrics {
  using Kind = Quadric;
  std::array<D, 10> coefficients;

  explicit LaneQuadrics(const Quadric& quadric) {
    for (size_t c = 0; c < coefficients.size(); ++c) coefficients[c] = D(quadric.coefficients[c]);
  }
  explicit LaneQuadrics(const LaneShapes& shapes) {
    for (size_t c = 0; c < coefficients.size(); ++c)
      coefficients[c] = D([&](auto k) { return std::get_if<Quadric>(shapes[k])->coefficients[c]; });
  }

  [[nodiscard]] uint32_t doubtful(const LaneHits& hits) const {
    return lane_bits(may_be_square(coefficients)) | lane_bits(hits.part.load() != U(uint32_t(kWallFace)));
  }
  [[nodiscard]] Vec3<D> projected(const Vec3<D>& p) const { return project_to_wall(coefficients, p); }
  [[nodiscard]] Vec3<D> normal(const Vec3<D>& p) const {
    return scaled_to_unit(quadric_half_gradient(coefficients, p));
  }
};

/// The hits in the shapes' spaces, about where their surfaces are.
Vec3<D> object_points(const LaneHits& hits, const Affine3<D>& object_from_world, const Vec3<D>& origin_world) {
  const Vec3<D> along = convert<D>(hits.direction.load()) * convert<D>(hits.t.load());
  return transform_vector(object_from_world, convert<D>(hits.origin.load()) - origin_world + along);
}

/// Where shapes stand: all lanes' at one place, or each at its own.
struct LanePlaces {
  Affine3<D> world_from_object, object_from_world;
  D stretch;  // of volumes, below 0 where the map mirrors

  explicit LanePlaces(const Affine3d& m)
      : world_from_object(broadcast(m)), object_from_world(broadcast(inverse(m))), stretch(determinant(m)) {}
  explicit LanePlaces(const Affine3<D>& m)
      : world_from_object(m), object_from_world(inverse(m)), stretch(determinant(m)) {}
};

/// What `shape_point` does, for shapes of one kind, but for texture coordinates. Answers the lanes that are left.
template <class Shapes>
uint32_t set_points_on(const Shapes& shapes, const LanePlaces& places, const LaneHits& hits, BasicSurfacePoint<F>& s) {
  const Affine3<D>& m = places.world_from_object;
  const Vec3<D> p = shapes.projected(object_points(hits, places.object_from_world, m.origin));
  s.p_world = transform_point(m, p);
  s.ng_world = s.ns_world = convert<F>(normalize(outer_normal(m, places.stretch, shapes.normal(p))));
  s.offset = shape_offset<F>(s.p_world);
  return shapes.doubtful(hits);
}

/// The same for one polygon, with its texture coordinates: in all lanes lie one plane's.
void set_points_on(const Polygon& polygon, const Affine3d& m, const LaneHits& hits, BasicSurfacePoint<F>& s) {
  const Vec3d ng = normalize(transform_normal(m, polygon.unit_normal)), center = polygon.center;
  const Affine3<D> all = broadcast(m);
  const Vec3<D> p = nearest_in_plane(polygon, object_points(hits, broadcast(inverse(m)), all.origin));
  s.p_world = transform_point(all, p);
  s.ng_world = s.ns_world = broadcast<F>(Vec3f(ng));
  s.offset = shape_offset<F>(s.p_world);
  s.tangent_world = broadcast<F>(Vec3f(normalize(transform_vector(m, u_tangent(polygon, center, 0)))));
  s.bitangent_sign = F(bitangent_sign(m));
  const Vec2<D> uv = uv_in_plane(polygon, p);
  s.uvs[0] = {convert<F>(uv.x), convert<F>(uv.y)};
}

/// For one shape that all hits are on. Answers the lanes that are left.
uint32_t set_points_on_one(const ShapeInstance& placed, const Shape& shape, bool has_textures, const LaneHits& hits,
                           BasicSurfacePoint<F>& s) {
  const Affine3d& m = placed.world_from_object;
  if (const auto* polygon = std::get_if<Polygon>(&shape)) return set_points_on(*polygon, m, hits, s), 0;
  if (has_textures) return kEveryLane;
  if (const auto* sphere = std::get_if<Sphere>(&shape))
    return set_points_on(LaneSpheres(*sphere), LanePlaces(m), hits, s);
  if (const auto* quadric = std::get_if<Quadric>(&shape))
    return set_points_on(LaneQuadrics(*quadric), LanePlaces(m), hits, s);
  return kEveryLane;
}

/// For shapes that are all of one kind, else nothing. Answers the lanes that are left.
template <class Shapes>
uint32_t set_points_on_each(const std::array<const ShapeInstance*, kWidthOf<F>>& placed, const LaneShapes& shapes,
                            const LaneHits& hits, BasicSurfacePoint<F>& s) {
  std::array<const Affine3d*, kWidthOf<F>> maps;
  for (size_t k = 0; k < kWidthOf<F>; ++k) {
    if (!std::holds_alternative<typename Shapes::Kind>(*shapes[k])) return kEveryLane;
    maps[k] = &placed[k]->world_from_object;
  }
  return set_points_on(Shapes(shapes), LanePlaces(lane_maps(maps)), hits, s);
}

/// Answers the lanes that are left.
uint32_t set_points_in_lanes(const Scene& scene, const LaneHits& hits, bool has_textures, BasicSurfacePoint<F>& s) {
  const Geometry& geometry = scene.geometry;
  std::array<const ShapeInstance*, kWidthOf<F>> placed;
  LaneShapes shapes;
  const auto find = [&](size_t k) {
    placed[k] = &shape_instance(geometry, hits.object[k]), shapes[k] = &geometry.shapes[placed[k]->shape];
  };
  find(0);
  if (lane_bits(on_object_of(hits, 0)) == kEveryLane)
    return set_points_on_one(*placed[0], *shapes[0], has_textures, hits, s);
  if (has_textures) return kEveryLane;
  for (size_t k = 1; k < kWidthOf<F>; ++k) find(k);
  if (std::holds_alternative<Sphere>(*shapes[0])) return set_points_on_each<LaneSpheres>(placed, shapes, hits, s);
  if (std::holds_alternative<Quadric>(*shapes[0])) return set_points_on_each<LaneQuadrics>(placed, shapes, hits, s);
  return kEveryLane;
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
