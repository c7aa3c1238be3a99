// Hits side by side, and what they have in common.
#pragma once

#include <array>

#include "core/transform.h"
#include "renderer/surface.h"

namespace alhazen {

/// Hits side by side: all on shapes, or all on parts of meshes with the same attributes. Nothing moves.
struct LaneHits {
  LaneArray<UintOf<ShadingLanes>> object, part, primitive;
  Vec3Array<ShadingLanes> origin, direction;  // of the rays, in world space
  LaneArray<ShadingLanes> t, u, v;

  [[nodiscard]] HitIds ids(size_t k) const { return {object[k], part[k], primitive[k]}; }
};

/// Bits of all lanes.
inline constexpr uint32_t kEveryLane = (1u << kWidthOf<ShadingLanes>)-1;

/// The lanes that are on the object, part or triangle of one of them.
inline MaskOf<UintOf<ShadingLanes>> on_object_of(const LaneHits& hits, size_t lane) {
  return hits.object.load() == UintOf<ShadingLanes>(hits.object[lane]);
}
inline MaskOf<UintOf<ShadingLanes>> on_part_of(const LaneHits& hits, size_t lane) {
  return on_object_of(hits, lane) && hits.part.load() == UintOf<ShadingLanes>(hits.part[lane]);
}
inline MaskOf<UintOf<ShadingLanes>> on_triangle_of(const LaneHits& hits, size_t lane) {
  return on_part_of(hits, lane) && hits.primitive.load() == UintOf<ShadingLanes>(hits.primitive[lane]);
}

using LaneMap = Affine3<DoubleOf<ShadingLanes>>;

/// One map in every lane.
inline LaneMap broadcast(const Affine3d& m) {
  using D = DoubleOf<ShadingLanes>;
  const auto all = [](const Vec3d& v) { return Vec3<D>(D(v.x), D(v.y), D(v.z)); };
  return {all(m.x), all(m.y), all(m.z), all(m.origin)};
}
/// A map to each.
inline LaneMap lane_maps(const std::array<const Affine3d*, kWidthOf<ShadingLanes>>& maps) {
  const auto column = [&](Vec3d Affine3d::*of) {
    Vec3Array<DoubleOf<ShadingLanes>> all;
    for (size_t k = 0; k < maps.size(); ++k) all.set(k, maps[k]->*of);
    return all.load();
  };
  return {column(&Affine3d::x), column(&Affine3d::y), column(&Affine3d::z), column(&Affine3d::origin)};
}

}  // namespace alhazen
