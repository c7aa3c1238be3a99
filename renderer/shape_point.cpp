#include "renderer/shape_point.h"

#include <algorithm>
#include <cmath>

#include "accel/posed.h"
#include "materials/microfacet.h"

namespace alhazen {
namespace {

/// `m`: from the shape's space to the world; `has_textures`: whether anybody asks for texture coordinates and tangents.
SurfacePoint shape_point(const Scene& scene, uint32_t object, int face, const Affine3d& m, const Vec3d& p_near_object,
                         bool has_textures) {
  const ShapeInstance& placed = shape_instance(scene.geometry, object);
  SurfacePoint s;
  s.material = placed.material;
  std::visit(
      [&](const auto& shape) {
        const Vec3d p = project(shape, p_near_object, face);
        s.p_world = transform_point(m, p);
        s.ng_world = s.ns_world = Vec3f(normalize(transform_normal(m, normal(shape, p, face))));
        if (!has_textures) return;
        s.tangent_world = Vec3f(normalize(transform_vector(m, u_tangent(shape, p, face))));
        s.bitangent_sign = bitangent_sign(m);
        s.uvs[0] = texture_coordinates(shape, p, face);
      },
      scene.geometry.shapes[placed.shape]);
  s.uv_count = 1;
  s.offset = shape_offset<float>(s.p_world);
  return s;
}

bool is_flat(const Shape& shape) {
  return std::holds_alternative<Box>(shape) || std::holds_alternative<Disk>(shape) ||
         std::holds_alternative<Polygon>(shape);
}

/// A shape's surface about a point of it.
class ShapeSurroundings {
 public:
  /// Steps of about `width` metres to two sides of a point on that face.
  ShapeSurroundings(const Affine3d& world_from_object, const Shape& shape, int face, const Vec3d& p_world,
                    const Vec3f& ng_world, double width)
      : world_from_object_(world_from_object),
        object_from_world_(inverse(world_from_object)),
        shape_(shape),
        face_(face),
        p_world_(p_world),
        ng_world_(ng_world),
        step_(std::max(width, 1e-6 * max_component(abs(p_world)))) {  // well above the rounding of double
    const ShadingFrame frame = frame_about(ng_world);
    sides_ = {Vec3d(frame.t), Vec3d(frame.b)};
  }

  /// From how far the normal leans outward at the steps, put back on the surface.
  [[nodiscard]] double mean_curvature() const {
    const Vec3d n(ng_world_);
    double turns = 0;
    for (const Vec3d& side : sides_) turns += dot(normal_near(p_world_ + side * step_) - n, side) / step_;
    return turns / 2;
  }

  /// The root of the ratio of the areas that the steps span.
  [[nodiscard]] float uv_per_metre() const {
    const Vec2f uv = uv_near(p_world_);
    std::array<Vec2d, 2> d;
    for (size_t k = 0; k < 2; ++k) {
      const Vec2f moved = uv_near(p_world_ + sides_[k] * step_);
      d[k] = {double(moved.x) - double(uv.x), double(moved.y) - double(uv.y)};
      d[k].x -= std::round(d[k].x);  // u starts anew at a seam
    }
    return float(std::sqrt(std::abs(d[0].x * d[1].y - d[0].y * d[1].x)) / step_);
  }

 private:
  /// f(shape, point of its surface near p_world, face).
  template <class F>
  [[nodiscard]] auto near(const Vec3d& p_world, const F& f) const {
    const Vec3d p_object = transform_point(object_from_world_, p_world);
    return std::visit([&](const auto& shape) { return f(shape, project(shape, p_object, face_), face_); }, shape_);
  }
  [[nodiscard]] Vec3d normal_near(const Vec3d& p_world) const {
    return normalize(transform_normal(
        world_from_object_,
        near(p_world, [](const auto& shape, const Vec3d& p, int face) { return normal(shape, p, face); })));
  }
  [[nodiscard]] Vec2f uv_near(const Vec3d& p_world) const {
    return near(p_world,
                [](const auto& shape, const Vec3d& p, int face) { return texture_coordinates(shape, p, face); });
  }

  Affine3d world_from_object_, object_from_world_;
  const Shape& shape_;
  int face_;
  Vec3d p_world_;
  Vec3f ng_world_;
  double step_;
  std::array<Vec3d, 2> sides_;
};

/// How much larger everything gets; 0 where the map does not keep shapes as they are.
double similarity_scale(const Affine3d& m) {
  const double squared = dot(m.x, m.x), tolerance = 1e-6 * squared;
  const bool square =
      std::abs(dot(m.x, m.y)) < tolerance && std::abs(dot(m.y, m.z)) < tolerance && std::abs(dot(m.z, m.x)) < tolerance;
  const bool alike = std::abs(dot(m.y, m.y) - squared) < tolerance && std::abs(dot(m.z, m.z) - squared) < tolerance;
  return square && alike ? std::sqrt(squared) : 0;
}

}  // namespace

SurfacePoint shape_point(const Scene& scene, const Rayf& ray_world, const HitIds& ids, float t, float time,
                         bool has_textures) {
  const Affine3d m = world_from_object(scene.geometry, ids.object, time);
  SurfacePoint s = shape_point(scene, ids.object, int(ids.part), m, object_point(m, ray_world, t), has_textures);
  if (!(dot(s.ng_world, s.ng_world) > 0)) s.ng_world = s.ns_world = -ray_world.direction;  // a singular point
  return s;
}

ShapeCurvature::ShapeCurvature(const Scene& scene, uint32_t object, float time)
    : world_from_object_(world_from_object(scene.geometry, object, time)),
      shape_(scene.geometry.shapes[shape_instance(scene.geometry, object).shape]),
      is_flat_(is_flat(shape_)) {
  const auto* sphere = std::get_if<Sphere>(&shape_);
  radius_ = sphere ? sphere->radius * similarity_scale(world_from_object_) : 0;
}

float ShapeCurvature::at(int face, const Vec3d& p_world, const Vec3f& ng_world, float width) const {
  if (is_even()) return even(width);
  return float(ShapeSurroundings(world_from_object_, shape_, face, p_world, ng_world, double(width)).mean_curvature());
}

void measure_shape_uvs(const Scene& scene, const HitIds& ids, float width, float time, SurfacePoint& point) noexcept {
  if (!is_shape(scene.geometry, ids.object)) return;
  const Shape& shape = scene.geometry.shapes[shape_instance(scene.geometry, ids.object).shape];
  const float density = ShapeSurroundings(world_from_object(scene.geometry, ids.object, time), shape, int(ids.part),
                                          point.p_world, point.ng_world, double(width))
                            .uv_per_metre();
  point.uv_per_metre[0] = std::isfinite(density) ? density : 0;
}

}  // namespace alhazen
