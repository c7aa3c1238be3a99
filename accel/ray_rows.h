// The rays of a packet as they lie in memory: rows of floats, a lane for each ray.
#pragma once

#include "core/ray.h"
#include "core/real.h"

namespace alhazen {

/// Row r starts r times the packet's width after the first: origin x, y, z, t_min, direction x, y, z, time, t_max.
struct RayRows {
  const float* rows;
  unsigned width;

  [[nodiscard]] const float* origin(unsigned axis) const { return rows + size_t(axis) * width; }
  [[nodiscard]] const float* t_min() const { return rows + size_t(3) * width; }
  [[nodiscard]] const float* direction(unsigned axis) const { return rows + size_t(4 + axis) * width; }
  [[nodiscard]] const float* time() const { return rows + size_t(7) * width; }
  [[nodiscard]] const float* t_max() const { return rows + size_t(8) * width; }

  [[nodiscard]] Rayf ray(unsigned i) const {
    return {{origin(0)[i], origin(1)[i], origin(2)[i]},
            {direction(0)[i], direction(1)[i], direction(2)[i]},
            t_min()[i],
            t_max()[i]};
  }
};

/// Axis x, y and z of N lanes.
template <int N, class Row>
Vec3<FloatLanes<N>> load_vectors(const Row& row) {
  const auto load = [&](unsigned axis) { return FloatLanes<N>(row(axis), std::experimental::element_aligned); };
  return {load(0), load(1), load(2)};
}
template <int N>
Vec3<FloatLanes<N>> load_origins(const RayRows& rays) {
  return load_vectors<N>([&](unsigned axis) { return rays.origin(axis); });
}
template <int N>
Vec3<FloatLanes<N>> load_directions(const RayRows& rays) {
  return load_vectors<N>([&](unsigned axis) { return rays.direction(axis); });
}

/// Bit k: lane k of N is not 0.
template <int N>
uint32_t active_lanes(const int* valid) {
  return lane_bits(LanesOf<int, N>(valid, std::experimental::element_aligned) != 0);
}

/// Calls f with a packet's width as a constant.
template <class F>
auto with_width(unsigned width, const F& f) {
  switch (width) {
    case 16:
      return f(std::integral_constant<int, 16>());
    case 8:
      return f(std::integral_constant<int, 8>());
    case 4:
      return f(std::integral_constant<int, 4>());
    default:
      return f(std::integral_constant<int, 1>());
  }
}

}  // namespace alhazen
