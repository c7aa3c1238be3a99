#include "crosscheck/json_reader.h"

#include <cmath>
#include <cstdlib>

namespace alhazen::crosscheck {
namespace {

constexpr double kLargestNumber = 1e18;  // of a surface: what traversal can hold
constexpr size_t kMostShown = 60;        // characters of what was found

}  // namespace

void JsonReader::fail(const std::string& expected) const {
  std::string found = json_->dump(-1, ' ', false, Json::error_handler_t::replace);
  if (found.size() > kMostShown) found = found.substr(0, kMostShown) + "...";
  throw LoadError(*file_, pointer_.empty() ? "/" : pointer_, "expected " + expected + ", found " + found);
}

JsonReader JsonReader::operator[](const char* name) const {
  if (!has(name)) fail("an object with '" + std::string(name) + "'");
  return {(*json_)[name], *file_, pointer_ + "/" + name};
}

std::vector<JsonReader> JsonReader::elements() const {
  expect(json_->is_array(), "an array");
  std::vector<JsonReader> list;
  for (size_t k = 0; k < json_->size(); ++k) list.emplace_back((*json_)[k], *file_, pointer_ + "/" + std::to_string(k));
  return list;
}

std::vector<JsonReader> JsonReader::elements(size_t count) const {
  if (!json_->is_array() || json_->size() != count) fail("an array of " + std::to_string(count));
  return elements();
}

double JsonReader::number() const {
  if (json_->is_number()) return json_->get<double>();
  expect(json_->is_string(), "a number");
  const auto& text = json_->get_ref<const std::string&>();
  char* end = nullptr;
  const double x = std::strtod(text.c_str(), &end);
  expect(!text.empty() && end == text.c_str() + text.size(), "a number such as \"0x1.8p+1\"");
  return x;
}

double JsonReader::finite_number() const {
  const double x = number();
  expect(std::abs(x) <= kLargestNumber, "a number up to 1e18");
  return x;
}

float JsonReader::float_number() const {
  const double x = number();
  expect(double(float(x)) == x || std::isnan(x), "a number that a float holds");
  return float(x);
}

Vec3d JsonReader::finite_vector() const {
  const auto list = elements(3);
  return {list[0].finite_number(), list[1].finite_number(), list[2].finite_number()};
}

Vec3f JsonReader::float_vector() const {
  const auto list = elements(3);
  return {list[0].float_number(), list[1].float_number(), list[2].float_number()};
}

bool JsonReader::boolean() const {
  expect(json_->is_boolean(), "true or false");
  return json_->get<bool>();
}

std::string JsonReader::text() const {
  expect(json_->is_string(), "a text");
  return json_->get<std::string>();
}

}  // namespace alhazen::crosscheck
