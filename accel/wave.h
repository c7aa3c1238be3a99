// Waves: many rays, and what they hit, as structures of arrays. The unit of every query.
#pragma once

#include "core/lanes.h"
#include "core/ray.h"
#include "core/vec.h"

namespace alhazen {

struct Vec3Lanes {
  Lanes<float> x, y, z;

  void resize(size_t n) { x.resize(n), y.resize(n), z.resize(n); }
  [[nodiscard]] Vec3f get(size_t i) const { return {x[i], y[i], z[i]}; }
  void set(size_t i, const Vec3f& v) { x[i] = v.x, y[i] = v.y, z[i] = v.z; }
  void append(const Vec3Lanes& other, size_t first = 0) {
    x.append(other.x, first), y.append(other.y, first), z.append(other.z, first);
  }
};

/// World-space rays. Lane i of every array is ray i.
struct RayWave {
  Vec3Lanes origin, direction;
  Lanes<float> t_min, t_max;
  Lanes<float> time;  // of the shutter, in [0, 1]; of no elements where all are at 0

  [[nodiscard]] size_t size() const { return t_min.size(); }
  void resize(size_t n) { origin.resize(n), direction.resize(n), t_min.resize(n), t_max.resize(n); }
  [[nodiscard]] Rayf get(size_t i) const { return {origin.get(i), direction.get(i), t_min[i], t_max[i]}; }
  void set(size_t i, const Rayf& r) {
    origin.set(i, r.origin), direction.set(i, r.direction);
    t_min[i] = r.t_min, t_max[i] = r.t_max;
  }
  void push(const Rayf& ray) {
    resize(size() + 1);
    set(size() - 1, ray);
  }
  /// The other's rays from `first` on, without `time`.
  void append(const RayWave& other, size_t first = 0) {
    origin.append(other.origin, first), direction.append(other.direction, first);
    t_min.append(other.t_min, first), t_max.append(other.t_max, first);
  }
};

/// The closest hits of a wave. `object` is kNone where a ray hits nothing; the other arrays then hold nothing of
/// meaning.
struct HitWave {
  Lanes<float> t;                           // in lengths of the ray's direction
  Lanes<float> u, v;                        // barycentric weights of a triangle's second and third vertex
  Lanes<uint32_t> object, part, primitive;  // Geometry's object number; part of its mesh; triangle within the part
                                            // (shapes: face in place of the part, 0)

  void resize(size_t n) {
    t.resize(n), u.resize(n), v.resize(n), object.resize(n), part.resize(n), primitive.resize(n);
  }
};

/// Whether neighbouring rays of a wave are known to run side by side; else each packet is looked at. The traversal is
/// several times faster where they do and it is told so, and half as fast where it is told so and they do not.
enum class Coherence : uint8_t { incoherent, coherent };

}  // namespace alhazen
