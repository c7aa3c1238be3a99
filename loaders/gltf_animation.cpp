#include "loaders/gltf_animation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "loaders/gltf_choice.h"

namespace alhazen {
namespace {

using nlohmann::json;

std::vector<float> all_numbers(const AccessorView& accessor) {
  std::vector<uint32_t> elements(accessor.count);
  std::iota(elements.begin(), elements.end(), 0u);
  return floats(accessor, elements);
}

void check_finite(const JsonRef& r, const std::vector<float>& values) {
  if (!std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); }))
    r.fail("expected finite numbers, the accessor holds others");
}

std::string joined(const PointerTokens& tokens) {
  std::string text;
  for (const std::string& token : tokens) text += "/" + token;
  return text;
}

/// Reads the chosen animations' channels in their order.
class ChannelReader {
 public:
  ChannelReader(GltfSource& source, const GltfBuffers& buffers) : source_(source), buffers_(buffers) {}

  void read(const JsonRef& animation) {
    for (const JsonRef& channel : animation.elements("channels")) {
      const auto target = target_of(channel);
      if (!target) continue;
      const auto property = animated_property(*target);
      if (!property || !make_place(source_.document.json.root, *target)) {
        unknown_.push_back(joined(*target));
        continue;
      }
      const JsonRef sampler = sampler_of(animation, channel);
      check_target(channel, *target);
      channels_.push_back({*target, *property, read_keys(sampler, channel, *target, *property)});
    }
  }

  std::vector<Channel> finish() {
    std::sort(unknown_.begin(), unknown_.end());
    unknown_.erase(std::unique(unknown_.begin(), unknown_.end()), unknown_.end());
    std::string text;
    for (const std::string& pointer : unknown_) text += (text.empty() ? "" : ", ") + pointer;
    if (!text.empty()) source_.warn("/animations", "not animated, nothing of the picture answers to: " + text);
    return std::move(channels_);
  }

 private:
  /// None where the channel has no target, which the specification tells readers to pass over.
  std::optional<PointerTokens> target_of(const JsonRef& channel) {
    const JsonRef target = channel["target"];
    const auto path = target["path"].as<std::string>();
    if (const auto e = target.extension("KHR_animation_pointer"); e && path == "pointer") {
      const auto tokens = pointer_tokens((*e)["pointer"].as<std::string>());
      if (!tokens) (*e)["pointer"].expected("a JSON pointer, which begins with /");
      return tokens;
    }
    const auto node = target.find("node");
    if (!node) return std::nullopt;
    return PointerTokens{"nodes", std::to_string(node->as<size_t>()), path};
  }

  static JsonRef sampler_of(const JsonRef& animation, const JsonRef& channel) {
    const JsonRef samplers = animation["samplers"], index = channel["sampler"];
    if (index.as<size_t>() >= samplers.value().size())
      index.fail("index " + index.value().dump() + " out of range, the animation has " +
                 std::to_string(samplers.value().size()) + " samplers");
    return samplers[index.as<size_t>()];
  }

  void check_target(const JsonRef& channel, const PointerTokens& target) const {
    if (target[0] != "nodes" || target.size() != 3 || target[2] == "weights") return;
    const JsonRef node = source_.at("nodes", std::stoul(target[1]));
    if (node.has("matrix"))
      channel.fail("animates the " + target[2] + " of node " + target[1] + ", which has a matrix in its place");
  }

  /// As many as the mesh that `target` means has morph targets.
  [[nodiscard]] size_t weight_count(const JsonRef& channel, const PointerTokens& target) const {
    JsonRef owner = source_.at(target[0].c_str(), std::stoul(target[1]));
    if (target[0] == "nodes") {
      const auto mesh = owner.find("mesh");
      if (!mesh) channel.fail("animates the weights of node " + target[1] + ", which has no mesh");
      owner = source_.at("meshes", mesh->as<size_t>());
    }
    const auto primitives = owner.elements("primitives");
    const size_t count = primitives.empty() ? 0 : primitives[0].elements("targets").size();
    if (count == 0) channel.fail("animates the weights of a mesh that has no morph targets");
    return count;
  }

  Keyframes read_keys(const JsonRef& sampler, const JsonRef& channel, const PointerTokens& target,
                      const AnimatedProperty& property) {
    const JsonRef input = sampler["input"], output = sampler["output"];
    Keyframes keys;
    const auto interpolation = sampler.get("interpolation", std::string("LINEAR"));
    const bool truth = property.kind == AnimatedProperty::Kind::truth;
    keys.interpolation = interpolation == "CUBICSPLINE"     ? Interpolation::cubic_spline
                         : interpolation == "STEP" || truth ? Interpolation::step
                                                            : Interpolation::linear;
    keys.rotations = property.kind == AnimatedProperty::Kind::rotation;
    keys.width = property.width > 0 ? property.width : weight_count(channel, target);
    keys.times = read_times(input);
    keys.values = read_values(output, keys);
    return keys;
  }

  std::vector<float> read_times(const JsonRef& input) {
    const AccessorView& accessor = buffers_.accessor(input.as<int>());
    if (accessor.components != 1 || accessor.type != TINYGLTF_COMPONENT_TYPE_FLOAT)
      input.expected("an accessor of type SCALAR, of floats");
    source_.budget->take(input, accessor.count, kNumber);
    std::vector<float> times = all_numbers(accessor);
    check_finite(input, times);
    const auto fall = std::is_sorted_until(times.begin(), times.end());
    if (fall != times.end())
      input.fail("expected times that rise, found key " + std::to_string(fall - times.begin()) +
                 " earlier than the one before");
    return times;
  }

  std::vector<float> read_values(const JsonRef& output, const Keyframes& keys) {
    const AccessorView& accessor = buffers_.accessor(output.as<int>());
    const size_t rows = keys.interpolation == Interpolation::cubic_spline ? 3 : 1;
    const uint64_t expected = keys.times.size() * rows * keys.width, found = accessor.count * accessor.components;
    if ((accessor.components != keys.width && accessor.components != 1) || found != expected)
      output.fail("expected " + std::to_string(expected) + " numbers: " + std::to_string(keys.width) +
                  (rows == 3 ? ", three times," : "") + " for each of " + std::to_string(keys.times.size()) +
                  " keys; the accessor has " + std::to_string(accessor.count) + " elements of " +
                  std::to_string(accessor.components));
    source_.budget->take(output, found, kNumber);
    std::vector<float> values = all_numbers(accessor);
    check_finite(output, values);
    if (keys.rotations) check_rotations(output, values, rows);
    return values;
  }

  static void check_rotations(const JsonRef& output, const std::vector<float>& values, size_t rows) {
    for (size_t i = rows / 2 * 4; i < values.size(); i += 4 * rows)
      if (values[i] == 0 && values[i + 1] == 0 && values[i + 2] == 0 && values[i + 3] == 0)
        output.fail("expected unit quaternions, found 0 0 0 0 at key " + std::to_string(i / (4 * rows)));
  }

  static constexpr uint64_t kNumber = sizeof(float) + sizeof(uint32_t);  // bytes: it and, while it is read, its index

  GltfSource& source_;
  const GltfBuffers& buffers_;
  std::vector<Channel> channels_;
  std::vector<std::string> unknown_;
};

json json_value(const Channel& channel, double seconds) {
  std::vector<double> value = value_at(channel.keys, seconds);
  for (double& v : value) v = std::clamp(v, channel.property.low, channel.property.high);
  if (channel.property.kind == AnimatedProperty::Kind::truth) return value[0] != 0;
  const bool single = channel.property.width == 1;
  return single ? json(value[0]) : json(value);
}

json& place(json& root, const PointerTokens& tokens) {
  json* at = &root;
  for (const std::string& token : tokens) at = at->is_array() ? &(*at)[std::stoul(token)] : &(*at)[token];
  return *at;
}

}  // namespace

std::vector<Channel> read_channels(GltfSource& source, const GltfBuffers& buffers, const std::string& wanted) {
  ChannelReader reader(source, buffers);
  for (const size_t i : choose_animations(source, wanted)) reader.read(source.at("animations", i));
  return reader.finish();
}

TimeSpan time_span(std::span<const Channel> channels) {
  if (channels.empty()) return {};
  TimeSpan span{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const Channel& channel : channels) {
    span.first = std::min(span.first, double(channel.keys.times.front()));
    span.last = std::max(span.last, double(channel.keys.times.back()));
  }
  return span;
}

void write_pose(std::span<const Channel> channels, double seconds, json& root) {
  for (const Channel& channel : channels) place(root, channel.target) = json_value(channel, seconds);
}

}  // namespace alhazen
