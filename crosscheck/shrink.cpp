#include "crosscheck/shrink.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "crosscheck/simpler_number.h"

namespace alhazen::crosscheck {
namespace {

constexpr uint64_t kOfAPart = 32;  // of an array or object itself

double number_in(const Json& json) { return std::strtod(json.get_ref<const std::string&>().c_str(), nullptr); }

/// A quoted one. Other texts are left alone.
bool is_number(const Json& json) {
  if (!json.is_string()) return false;
  const auto& text = json.get_ref<const std::string&>();
  char* end = nullptr;
  (void)std::strtod(text.c_str(), &end);
  return !text.empty() && *end == '\0';
}

/// Of vectors, or of larger things: numbers of a vector cannot go.
bool has_removable_elements(const Json& json) {
  return json.is_array() && !json.empty() && json.front().is_structured();
}

/// Calls visit(array) with each array that lacks a run of elements, long runs first, until it says true.
template <class Visit>
bool for_each_shorter_array(const Json& array, const Visit& visit) {
  for (size_t count = (array.size() + 1) / 2; count > 0; count /= 2)
    for (size_t first = 0; first < array.size(); first += count) {
      Json rest = array;
      rest.erase(rest.begin() + ptrdiff_t(first), rest.begin() + ptrdiff_t(std::min(first + count, array.size())));
      if (visit(std::move(rest))) return true;
    }
  return false;
}

/// Calls visit(part) with what may stand in the place of one part of a document, the simplest first, until it says
/// true.
template <class Visit>
bool for_each_replacement(const Json& part, const std::string& name, const Visit& visit) {
  if (is_number(part))
    for (const double x : simpler_numbers(number_in(part), name == "t_max"))
      if (visit(Json(hex(x)))) return true;
  if (has_removable_elements(part)) return for_each_shorter_array(part, visit);
  if (part.is_object() && part.contains("operands"))
    for (const Json& operand : part["operands"])
      if (visit(operand)) return true;
  return false;
}

/// Calls visit(pointer, name) for each part of a document, the whole before its parts, until it says true.
template <class Visit>
bool for_each_part(const Json& json, const Json::json_pointer& pointer, const std::string& name, const Visit& visit) {
  if (visit(pointer, name)) return true;
  if (json.is_object())
    for (const auto& [key, value] : json.items())
      if (for_each_part(value, pointer / key, key, visit)) return true;
  if (json.is_array())
    for (size_t k = 0; k < json.size(); ++k)
      if (for_each_part(json[k], pointer / k, name, visit)) return true;
  return false;
}

/// Calls visit(document) with each that differs in one part and is simpler, until it says true.
template <class Visit>
bool for_each_simpler_at(const Json& document, const Json::json_pointer& pointer, const std::string& name,
                         const Visit& visit) {
  const uint64_t before = complexity(document);
  return for_each_replacement(document[pointer], name, [&](Json part) {
    Json changed = document;
    changed[pointer] = std::move(part);
    return complexity(changed) < before && visit(changed);
  });
}
template <class Visit>
bool for_each_simpler_rewrite(const Json& document, const Rewrites& rewrites, const Visit& visit) {
  const uint64_t before = complexity(document);
  const auto others = rewrites(document);
  return std::any_of(others.begin(), others.end(),
                     [&](const Json& other) { return complexity(other) < before && visit(other); });
}

/// A document on its way.
class Shrinker {
 public:
  Shrinker(Json document, const Holds& holds, const Rewrites& rewrites, int most_tries)
      : document_(std::move(document)), holds_(holds), rewrites_(rewrites), tries_left_(most_tries) {}

  [[nodiscard]] const Json& document() const { return document_; }

  /// Tries every change once, those of one part again as long as they help. Whether any did.
  bool pass() {
    bool changed = false;
    const auto repeat = [&](const auto& for_each) {
      while (for_each([&](const Json& other) { return accepts(other); }) && next_) {
        document_ = *std::exchange(next_, std::nullopt);
        changed = true;
      }
    };
    repeat([&](const auto& visit) { return for_each_simpler_rewrite(document_, rewrites_, visit); });
    std::vector<std::pair<Json::json_pointer, std::string>> parts;
    for_each_part(document_, Json::json_pointer(), "", [&](const auto& pointer, const std::string& name) {
      parts.emplace_back(pointer, name);
      return false;
    });
    for (const auto& [pointer, name] : parts)
      repeat([&, &at = pointer, &called = name](const auto& visit) {
        return document_.contains(at) && for_each_simpler_at(document_, at, called, visit);
      });
    return changed;
  }

 private:
  /// True ends the search: it holds, or nothing more is to be tried.
  bool accepts(const Json& other) {
    if (tries_left_-- <= 0) return true;
    if (holds_(other)) next_ = other;
    return next_.has_value();
  }

  Json document_;
  const Holds& holds_;
  const Rewrites& rewrites_;
  int tries_left_;
  std::optional<Json> next_;  // that holds, too
};

}  // namespace

uint64_t complexity(const Json& document) {
  if (is_number(document)) return uint64_t(complexity(number_in(document)));
  uint64_t sum = document.is_structured() ? kOfAPart : 0;
  if (document.is_structured())
    for (const Json& part : document) sum += complexity(part);
  return sum;
}

bool for_each_simpler(const Json& document, const Rewrites& rewrites, const Holds& visit) {
  return for_each_simpler_rewrite(document, rewrites, visit) ||
         for_each_part(document, Json::json_pointer(), "", [&](const auto& pointer, const std::string& name) {
           return for_each_simpler_at(document, pointer, name, visit);
         });
}

Json shrunk(Json document, const Holds& holds, const Rewrites& rewrites, int most_tries) {
  Shrinker shrinker(std::move(document), holds, rewrites, most_tries);
  while (shrinker.pass()) {
  }
  return shrinker.document();
}

}  // namespace alhazen::crosscheck
