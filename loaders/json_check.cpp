#include "loaders/json_check.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace alhazen {
namespace {

using nlohmann::json;

std::string written(double x) {
  return json(x == std::floor(x) && std::abs(x) < 1e15 ? json(int64_t(x)) : json(x)).dump();
}

std::string within(double low, double high) {
  if (high == kUnbounded) return low == -kUnbounded ? "" : " >= " + written(low);
  return low == -kUnbounded ? " <= " + written(high) : " from " + written(low) + " to " + written(high);
}

bool is_finite_number(const json& value) {
  return value.is_number() && std::isfinite(value.get<double>()) && std::isfinite(value.get<float>());
}

template <class T>
std::string listed(const std::vector<T>& all) {
  std::string out;
  for (const T& one : all) {
    if constexpr (std::is_same_v<T, std::string>)
      out += (out.empty() ? "" : ", ") + one;
    else
      out += (out.empty() ? "" : ", ") + std::to_string(one);
  }
  return out;
}

void check_properties(const JsonRef& r, const std::vector<Property>& properties) {
  if (!r.value().is_object()) r.expected("an object");
  for (const Property& p : properties) {
    if (const auto value = r.find(p.name))
      p.check(*value);
    else if (p.presence == required)
      r.fail("`" + p.name + "` is missing");
  }
}

}  // namespace

Check anything() {
  return [](const JsonRef&) {};
}

Check boolean() {
  return [](const JsonRef& r) {
    if (!r.value().is_boolean()) r.expected("true or false");
  };
}

Check text() {
  return [](const JsonRef& r) {
    if (!r.value().is_string()) r.expected("a string");
  };
}

Check one_of(std::vector<std::string> texts) {
  return [texts = std::move(texts)](const JsonRef& r) {
    if (!r.value().is_string() || std::find(texts.begin(), texts.end(), r.as<std::string>()) == texts.end())
      r.expected("one of " + listed(texts));
  };
}

Check one_of(std::vector<uint64_t> integers) {
  return [integers = std::move(integers)](const JsonRef& r) {
    if (!r.value().is_number_unsigned() ||
        std::find(integers.begin(), integers.end(), r.as<uint64_t>()) == integers.end())
      r.expected("one of " + listed(integers));
  };
}

Check number(double low, double high) {
  return [=](const JsonRef& r) {
    const bool good = is_finite_number(r.value()) && r.as<double>() >= low && r.as<double>() <= high;
    if (!good) r.expected("a finite number" + within(low, high));
  };
}

Check number_above(double low) {
  return [=](const JsonRef& r) {
    // A number that vanishes as a float is not above 0.
    if (!is_finite_number(r.value()) || !(r.as<float>() > float(low))) r.expected("a finite number > " + written(low));
  };
}

Check integer(uint64_t low, uint64_t high) {
  return [=](const JsonRef& r) {
    if (!r.value().is_number_unsigned() || r.as<uint64_t>() < low || r.as<uint64_t>() > high)
      r.expected("an integer from " + std::to_string(low) + " to " + std::to_string(high));
  };
}

Check numbers(size_t count, double low, double high) {
  return [=, each = number(low, high)](const JsonRef& r) {
    if (!r.value().is_array() || r.value().size() != count)
      r.expected("an array of " + std::to_string(count) + " numbers");
    for (size_t i = 0; i < count; ++i) each(r[i]);
  };
}

Check color() { return numbers(3, 0); }

Check index_into(const std::string& pointer) {
  return [at = json::json_pointer(pointer), pointer](const JsonRef& r) {
    const json& root = r.root().value();
    const size_t size = root.contains(at) ? root.at(at).size() : 0;
    if (!r.value().is_number_unsigned()) r.expected("an index into " + pointer);
    if (r.as<uint64_t>() >= size)
      r.fail("index " + r.value().dump() + " out of range, " + pointer + " has " + std::to_string(size));
  };
}

Check list_of(Check element, size_t at_least) {
  return [element = std::move(element), at_least](const JsonRef& r) {
    if (!r.value().is_array()) r.expected("an array");
    if (r.value().size() < at_least) r.expected("an array of " + std::to_string(at_least) + " or more");
    for (size_t i = 0; i < r.value().size(); ++i) element(r[i]);
  };
}

Check map_of(Check value) {
  return [value = std::move(value)](const JsonRef& r) {
    if (!r.value().is_object()) r.expected("an object");
    for (const auto& item : r.value().items()) value(r[item.key()]);
  };
}

Check object(std::vector<Property> properties) {
  return [properties = std::move(properties)](const JsonRef& r) { check_properties(r, properties); };
}

Check closed_object(std::vector<Property> properties) {
  properties.insert(properties.end(), {{"extensions", map_of(anything())}, {"extras", anything()}});
  return [properties = std::move(properties)](const JsonRef& r) {
    check_properties(r, properties);
    std::string known;
    for (size_t i = 0; i + 2 < properties.size(); ++i) known += (i ? ", " : "") + properties[i].name;
    for (const auto& item : r.value().items())
      if (std::none_of(properties.begin(), properties.end(), [&](const Property& p) { return p.name == item.key(); }))
        r[item.key()].fail("unknown key, expected one of " + known);
  };
}

Check both(Check first, Check second) {
  return [first = std::move(first), second = std::move(second)](const JsonRef& r) {
    first(r);
    second(r);
  };
}

}  // namespace alhazen
