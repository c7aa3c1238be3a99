// Whether closed meshes leak: the watertight triangle beside the two textbook ones and Embree's own.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "crosscheck/closed_mesh.h"

namespace alhazen::crosscheck {

/// Where a ray from within a mesh points.
enum class Aim : uint8_t {
  anywhere,
  vertex,  // exactly, or off by the roundings of its direction
  edge,
};
inline constexpr int kAims = 3;
[[nodiscard]] const char* name_of(Aim aim);

/// What one kind of triangle test does with the rays. All start within; every one leaves once more than it enters.
struct LeakCount {
  uint64_t misses = 0;  // nothing is met
  uint64_t odd = 0;     // not left once more than entered, or from outside not as often: the parity is wrong
  uint64_t shared = 0;  // of the rays from the centre, exact ties: not met by exactly one face
};

/// One mesh and aim. Every fourth ray starts outside, every sixteenth at the centre, from where ties are exact.
struct MeshTally {
  std::string mesh;
  Aim aim = Aim::anywhere;
  uint64_t rays = 0, from_outside = 0, from_center = 0;
  LeakCount watertight = {}, half_spaces = {}, cramer = {};
  uint64_t not_nearest = 0;                       // closest hits of the watertight triangle that were not the closest
  uint64_t native_misses = 0, robust_misses = 0;  // Embree's triangles
  std::string first_failure = {};                 // of the watertight triangle, as text

  [[nodiscard]] uint64_t failures() const {
    return watertight.misses + watertight.odd + watertight.shared + not_nearest;
  }
};

/// `rays` of each aim, shared among the meshes. Calls `done` for each pair, in order.
void check_meshes(uint64_t rays, uint64_t seed, const std::function<bool()>& stop,
                  const std::function<void(const MeshTally&)>& done);

}  // namespace alhazen::crosscheck
