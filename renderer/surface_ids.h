// The scene signature of a hit: which node, polygon and material of the file a ray meets.
#pragma once

#include <array>
#include <bit>

#include "core/lane_memory.h"
#include "renderer/scene.h"

namespace alhazen {

struct HitIds {
  uint32_t object, part, primitive;
};

/// What the scene signature says of a surface.
struct SurfaceIds {
  uint32_t node;       // glTF's
  uint32_t primitive;  // polygon in the node's mesh, 0 on a shape
  uint32_t material;   // glTF's; kNone for the default material
  friend bool operator==(const SurfaceIds&, const SurfaceIds&) = default;
};
[[nodiscard]] SurfaceIds surface_ids(const Scene& scene, const HitIds& hit) noexcept;

/// The same of many hits, several at once: most are on the part that was hit before.
class SurfaceIdReader {
 public:
  explicit SurfaceIdReader(const Scene& scene) : scene_(scene) {}

  /// Node, primitive and material of the first `count` lanes; all kNone where `object` is.
  template <class U>
  [[nodiscard]] std::array<U, 3> operator()(const U& object, const U& part, const U& primitive, size_t count) noexcept {
    std::array<U, 3> ids{U(kNone), U(kNone), U(kNone)};
    for (uint32_t left = lane_bits(object != U(kNone)) & ((1u << count) - 1); left != 0;) {
      const auto lane = size_t(std::countr_zero(left));
      turn_to(object[lane], part[lane]);
      const auto here = object == U(object_) && part == U(part_);
      left &= ~lane_bits(here);
      const U triangle = select(here, primitive, U(0));
      const U polygon = polygon_of_triangle_ ? gather<U>(polygon_of_triangle_, convert<IntOf<U>>(triangle)) : triangle;
      ids = {select(here, U(node_), ids[0]), select(here, polygon + U(first_primitive_), ids[1]),
             select(here, U(material_), ids[2])};
    }
    return ids;
  }

  [[nodiscard]] SurfaceIds operator()(const HitIds& hit) noexcept {
    turn_to(hit.object, hit.part);
    return {node_, first_primitive_ + (polygon_of_triangle_ ? polygon_of_triangle_[hit.primitive] : hit.primitive),
            material_};
  }

 private:
  void turn_to(uint32_t object, uint32_t part) noexcept {
    if (object != object_ || part != part_) look_up(object, part);
  }
  void look_up(uint32_t object, uint32_t part) noexcept;

  const Scene& scene_;
  uint32_t object_ = kNone, part_ = 0;  // of the hit before
  uint32_t node_ = 0, material_ = 0, first_primitive_ = 0;
  const uint32_t* polygon_of_triangle_ = nullptr;  // null: a polygon each
};

}  // namespace alhazen
