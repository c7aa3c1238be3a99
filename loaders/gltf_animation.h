// glTF animations: which properties of the file they set, and to what at which time.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "loaders/animated_properties.h"
#include "loaders/gltf_accessor.h"
#include "loaders/keyframes.h"

namespace alhazen {

/// One property under its keys. A core channel is the JSON pointer of its node's property.
struct Channel {
  PointerTokens target;
  AnimatedProperty property;
  Keyframes keys;
};

/// The channels of the animation of that name or index, for an empty text of the first, for "all" of all in their
/// order, for "none" of none. Makes places in the JSON for properties that are at their defaults.
///
/// What an animation that is not chosen holds is not looked at. Throws UsageError where there is no such animation,
/// LoadError for keys that are not finite, fall, or are not as many as the values; for values that the property cannot
/// take; and for a node that is animated and has a matrix. Pointers that nothing here answers to give one warning.
[[nodiscard]] std::vector<Channel> read_channels(GltfSource& source, const GltfBuffers& buffers,
                                                 const std::string& wanted);

struct TimeSpan {
  double first = 0, last = 0;  // seconds
};

/// From the first key to the last; at 0 where there are none.
[[nodiscard]] TimeSpan time_span(std::span<const Channel> channels);

/// Writes what the channels say at `seconds` into the file's JSON, the later of two that set one property last.
void write_pose(std::span<const Channel> channels, double seconds, nlohmann::json& root);

}  // namespace alhazen
