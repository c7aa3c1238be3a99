// A JSON value that knows its place, so that whatever is wrong with it can be said with its pointer.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/vec.h"

namespace alhazen {

struct JsonDocument {
  std::string file;  // for messages
  nlohmann::json root;
};

/// A view into a JsonDocument, which must outlive it. The getters take a document that has passed its checks.
class JsonRef {
 public:
  explicit JsonRef(const JsonDocument& document) : document_(&document), value_(&document.root) {}

  [[nodiscard]] const nlohmann::json& value() const { return *value_; }
  [[nodiscard]] const std::string& pointer() const { return pointer_; }
  [[nodiscard]] JsonRef root() const { return JsonRef(*document_); }

  /// Throw LoadError at this place. `expected` says what was found too.
  [[noreturn]] void fail(const std::string& reason) const;
  [[noreturn]] void expected(const std::string& what) const;
  /// "scene.gltf: /images/3"
  [[nodiscard]] std::string place() const;

  [[nodiscard]] bool has(const std::string& key) const { return value_->contains(key); }
  [[nodiscard]] JsonRef operator[](const std::string& key) const;  // LoadError if the object has none
  [[nodiscard]] JsonRef operator[](size_t i) const;                // which the array has
  [[nodiscard]] std::optional<JsonRef> find(const std::string& key) const;
  [[nodiscard]] std::optional<JsonRef> extension(const std::string& name) const;

  [[nodiscard]] std::vector<JsonRef> elements() const;
  /// The elements of the array `key`; none where it is missing.
  [[nodiscard]] std::vector<JsonRef> elements(const std::string& key) const;

  template <class T>
  [[nodiscard]] T as() const {
    return value_->get<T>();
  }
  template <class T>
  [[nodiscard]] T get(const std::string& key, const T& otherwise) const {
    const auto at = value_->find(key);
    return at == value_->end() ? otherwise : at->get<T>();
  }
  [[nodiscard]] Rgb get(const std::string& key, const Rgb& otherwise) const;

 private:
  JsonRef(const JsonDocument& document, const nlohmann::json& value, std::string pointer)
      : document_(&document), value_(&value), pointer_(std::move(pointer)) {}

  const JsonDocument* document_;
  const nlohmann::json* value_;
  std::string pointer_;
};

}  // namespace alhazen
