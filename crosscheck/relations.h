// Metamorphic checks, which need no judge: what must stay the same when the question is put in another way.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "crosscheck/party.h"

namespace alhazen::crosscheck {

enum class Relation : uint8_t {
  scaled_space,       // subject and ray larger or smaller by a power of two: the same t and face
  scaled_direction,   // the direction longer by a power of two: t shorter by it
  permuted_axes,      // x, y and z of the world renamed in turn
  moved,              // subject and ray moved by an amount that floats hold exactly
  split_range,        // [t_min, t_max] cut in two, neither a single number, which traversal takes for empty: the
                      // closest hit is that of the part that holds it
  shadow,             // a shadow ray is blocked where there is a closest hit
  identity_instance,  // the body as a composite of one operand, placed by the identity; ties are left out
  reversed_vertices,  // triangles and polygons with their vertices in the opposite order
};
inline constexpr int kRelations = 8;
[[nodiscard]] const char* name_of(Relation relation);

/// `rays`: asked once more. `first_broken`: the first ray's number.
struct RelationCount {
  uint64_t rays = 0, broken = 0;
  std::optional<uint64_t> first_broken = {};
  void add(const RelationCount& later);
};
using RelationCounts = std::array<RelationCount, kRelations>;

/// Asks the custom intersector about the rays of one subject in all of these ways. `answers`: its own to the rays as
/// they are, `first`: the number of the first. Rays that a change cannot keep exact are left out of that one. t and
/// face must be the same to the bit; t may be off by one float where the change rounds differently, in `permuted_axes`,
/// `moved` and `identity_instance`.
[[nodiscard]] RelationCounts check_relations(const Subject& subject, std::span<const Rayf> rays,
                                             std::span<const Answer> answers, uint64_t first, Random random);

}  // namespace alhazen::crosscheck
