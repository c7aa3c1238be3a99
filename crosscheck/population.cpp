#include "crosscheck/population.h"

#include <algorithm>
#include <limits>

#include "crosscheck/feature_point.h"

namespace alhazen::crosscheck {
namespace {

/// 0, ±1, ±2, ±4 ... ±64.
int few_floats(Random& random) {
  const int k = random.integer(-7, 7);
  return k == 0 ? 0 : k < 0 ? -(1 << (-k - 1)) : 1 << (k - 1);
}

Vec3f nudged(const Vec3f& v, Random& random) {
  const float x = moved_by_floats(v.x, few_floats(random)), y = moved_by_floats(v.y, few_floats(random));
  return {x, y, moved_by_floats(v.z, few_floats(random))};
}

/// The parameter of the closest hit, or some number.
float hit_or_some(const Judge& judge, const Rayf& ray, Random& random) {
  const Judgement j = judge.closest(ray);
  return j.hit ? j.t : float(random.uniform(0, 2));
}

}  // namespace

const char* name_of(Population population) {
  constexpr const char* names[kPopulations] = {"uniform", "aimed",   "silhouette", "lattice", "axis",  "length",
                                               "range",   "spawned", "inside",     "special", "camera"};
  return names[size_t(population)];
}

Vec3d RayMaker::in_box(double scale, Random& random) const {
  return center() + random.in_cube(scale) * ((box_.upper - box_.lower) * 0.5);
}

Vec3d RayMaker::outer_origin(Random& random) const {
  const double size = max_component(box_.upper - box_.lower);
  return center() + random.on_sphere() * (size * random.decades(0, random.coin() ? 0.5 : 3));
}

/// A ray in the world from points of the subject's space: of unit length, as cameras make them, or reaching to the
/// target.
Rayf RayMaker::through(const Vec3d& origin_object, const Vec3d& target_object, Random& random) const {
  const Vec3f origin(transform_point(subject_->world_from_object, origin_object));
  const Vec3d to = transform_point(subject_->world_from_object, target_object) - Vec3d(origin);
  return {origin, Vec3f(random.coin() ? normalize(to) : to)};
}

Rayf RayMaker::uniform_ray(Random& random) const {
  const Vec3d origin = outer_origin(random);
  return through(origin, in_box(1, random), random);
}

/// Of a flat subject mostly beside its plane: lines within the plane are ties.
Vec3d RayMaker::near_box(double scale, Random& random) const {
  const Vec3d p = in_box(scale, random), size = box_.upper - box_.lower;
  const double off = max_component(size) * random.decades(-6, 0) * random.uniform();
  if (random.integer(0, 15) == 0) return p;
  return p + Vec3d{size.x == 0 ? off : 0, size.y == 0 ? off : 0, size.z == 0 ? off : 0};
}

Vec3d RayMaker::on_surface(Random& random) const {
  for (int tries = 0; tries < 4; ++tries) {
    const Rayf ray = uniform_ray(random);
    const Judgement j = judge_->closest(ray);
    if (!j.hit) continue;
    const Vec3d p_world = Vec3d(ray.origin) + Vec3d(ray.direction) * double(j.t);
    return transform_point(inverse(subject_->world_from_object), p_world);
  }
  return feature_point(subject_->surface, random);
}

Rayf RayMaker::silhouette_ray(Random& random) const {
  const Surface& surface = subject_->surface;
  const bool is_box = std::holds_alternative<Box>(surface),
             has_edges = is_box || std::holds_alternative<Composite>(surface);
  const Vec3d p = is_box ? feature_point(surface, random) : on_surface(random);
  const Vec3d n =
      has_edges ? normalize(p - center()) : std::visit([&](const auto& s) { return normal(s, p, kWallFace); }, surface);
  const Vec3d along = normalize(cross(n, random.on_sphere()));
  const double size = max_component(box_.upper - box_.lower);
  const double off = size * std::exp2(-random.integer(0, 30)) * (random.coin() ? 1 : -1);
  return through(p + n * off - along * (size * random.decades(0, 2)), p + n * off, random);
}

Rayf RayMaker::lattice_ray(Random& random) const {
  const double step = subject_->lattice_step;
  const Vec3d middle = transform_point(subject_->world_from_object, center()) / step;
  const Vec3d whole{std::round(middle.x), std::round(middle.y), std::round(middle.z)};
  const Vec3d origin = whole + random.on_lattice(16);
  Vec3d direction = random.coin() ? random.on_lattice(4) : whole + random.on_lattice(8) - origin;
  if (direction == Vec3d{}) direction = {1, 0, 0};
  return {Vec3f(origin * step), Vec3f(direction * step)};
}

Rayf RayMaker::axis_ray(Random& random) const {
  const int axis = random.integer(0, 2), other = random.integer(0, 2);  // alike: along that axis
  const auto component = [&](int k) {
    const double zero = random.coin() ? 0.0 : -0.0;
    return k == axis || k == other ? random.uniform(0.5, 1) * (random.coin() ? 1 : -1) : zero;
  };
  const double dx = component(0), dy = component(1);
  const Vec3d direction{dx, dy, component(2)};
  const Vec3d target = random.coin() ? feature_point(subject_->surface, random) : in_box(1, random);
  const Vec3d p = transform_point(subject_->world_from_object, target);
  const double away = max_component(abs(p)) + max_component(box_.upper - box_.lower);
  return {Vec3f(p - direction * (away * random.uniform(-1, 2))), Vec3f(direction)};
}

/// Of ranges from 0 on that are more than a single number, as Embree takes them.
Rayf RayMaker::clipped_ray(Random& random) const {
  Rayf ray = random.coin() ? uniform_ray(random) : through(near_box(1, random), in_box(1, random), random);
  const float t = moved_by_floats(hit_or_some(*judge_, ray, random), random.integer(-4, 4));
  if (random.coin())
    ray.t_min = std::max(0.0f, t);
  else
    ray.t_max = std::max(std::numeric_limits<float>::denorm_min(), t);
  return ray;
}

Rayf RayMaker::ray(Population population, Random& random) const {
  const auto feature = [&] { return feature_point(subject_->surface, random); };
  switch (population) {
    case Population::aimed: {
      const Vec3d origin = outer_origin(random);
      Rayf ray = through(origin, feature(), random);
      ray.direction = nudged(ray.direction, random);
      return ray;
    }
    case Population::silhouette:
      return silhouette_ray(random);
    case Population::lattice:
      return lattice_ray(random);
    case Population::axis:
      return axis_ray(random);
    case Population::length: {
      Rayf ray = uniform_ray(random);
      ray.direction = Vec3f(normalize(Vec3d(ray.direction)) * std::exp2(random.integer(-60, 60)));
      return ray;
    }
    case Population::range:
      return clipped_ray(random);
    case Population::spawned: {
      const Vec3d p = on_surface(random);
      const Vec3d target = random.coin() ? in_box(1, random) : p + random.on_sphere();
      Rayf ray = through(p, target, random);
      const float x = moved_by_floats(ray.origin.x, random.integer(-4, 4));
      const float y = moved_by_floats(ray.origin.y, random.integer(-4, 4));
      ray.origin = {x, y, moved_by_floats(ray.origin.z, random.integer(-4, 4))};
      return ray;
    }
    case Population::inside: {
      const Vec3d origin = near_box(0.7, random);
      return through(origin, in_box(1, random), random);
    }
    case Population::special: {
      const Vec3d origin = random.coin() ? center() : feature();
      return through(origin, random.coin() ? feature() : in_box(1, random), random);
    }
    default:
      return uniform_ray(random);
  }
}

}  // namespace alhazen::crosscheck
