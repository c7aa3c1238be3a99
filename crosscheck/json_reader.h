// A JSON value, where it stands, and typed ways to read it.
#pragma once

#include <string>
#include <vector>

#include "core/error.h"
#include "crosscheck/subject_json.h"

namespace alhazen::crosscheck {

/// Every way of reading throws LoadError with the file, the JSON pointer, what was found and what is expected.
class JsonReader {
 public:
  JsonReader(const Json& json, const std::string& file, std::string pointer = {})
      : json_(&json), file_(&file), pointer_(std::move(pointer)) {}

  [[noreturn]] void fail(const std::string& expected) const;
  void expect(bool good, const char* expected) const {
    if (!good) fail(expected);
  }

  [[nodiscard]] bool has(const char* name) const { return json_->is_object() && json_->contains(name); }
  [[nodiscard]] JsonReader operator[](const char* name) const;
  [[nodiscard]] std::vector<JsonReader> elements() const;
  /// Of as many elements as `count`.
  [[nodiscard]] std::vector<JsonReader> elements(size_t count) const;

  /// A number of JSON, or one in quotes: "0x1.8p+1", "-inf".
  [[nodiscard]] double number() const;
  [[nodiscard]] double finite_number() const;  // up to 1e18
  [[nodiscard]] float float_number() const;    // nothing is rounded
  [[nodiscard]] Vec3d finite_vector() const;
  [[nodiscard]] Vec3f float_vector() const;
  [[nodiscard]] bool boolean() const;
  [[nodiscard]] std::string text() const;

 private:
  const Json* json_;
  const std::string* file_;
  std::string pointer_;
};

}  // namespace alhazen::crosscheck
