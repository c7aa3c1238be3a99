#include "loaders/json_ref.h"

#include <array>

#include "core/error.h"

namespace alhazen {
namespace {

using nlohmann::json;

std::string escaped(const std::string& key) {  // RFC 6901
  std::string out;
  for (const char c : key) out += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return out;
}

std::string excerpt(const json& value) {
  constexpr size_t kLongest = 40;
  if (value.is_array() && value.size() > kLongest) return "an array of " + std::to_string(value.size());
  if (value.is_object()) return "an object";
  std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
  return text.size() > kLongest ? text.substr(0, kLongest) + "..." : text;
}

}  // namespace

void JsonRef::fail(const std::string& reason) const { throw LoadError(document_->file, pointer_, reason); }
void JsonRef::expected(const std::string& what) const { fail("expected " + what + ", found " + excerpt(*value_)); }

JsonRef JsonRef::operator[](const std::string& key) const {
  const auto at = value_->find(key);
  if (at == value_->end()) fail("`" + key + "` is missing");
  return {*document_, *at, pointer_ + "/" + escaped(key)};
}
JsonRef JsonRef::operator[](size_t i) const { return {*document_, value_->at(i), pointer_ + "/" + std::to_string(i)}; }

std::string JsonRef::place() const { return document_->file + (pointer_.empty() ? "" : ": " + pointer_); }

std::optional<JsonRef> JsonRef::find(const std::string& key) const {
  if (!has(key)) return std::nullopt;
  return (*this)[key];
}
std::optional<JsonRef> JsonRef::extension(const std::string& name) const {
  const auto all = find("extensions");
  return all ? all->find(name) : std::nullopt;
}

std::vector<JsonRef> JsonRef::elements() const {
  std::vector<JsonRef> all;
  all.reserve(value_->size());
  for (size_t i = 0; i < value_->size(); ++i) all.push_back((*this)[i]);
  return all;
}
std::vector<JsonRef> JsonRef::elements(const std::string& key) const {
  return has(key) ? (*this)[key].elements() : std::vector<JsonRef>{};
}

Rgb JsonRef::get(const std::string& key, const Rgb& otherwise) const {
  if (!has(key)) return otherwise;
  const auto c = value_->at(key).get<std::array<float, 3>>();
  return {c[0], c[1], c[2]};
}

}  // namespace alhazen
