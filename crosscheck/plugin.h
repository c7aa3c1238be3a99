// Intersectors from shared libraries.
#pragma once

#include <memory>
#include <string>

#include "crosscheck/check_intersector.h"
#include "crosscheck/subject.h"

namespace alhazen::crosscheck {

/// A library that stays loaded as long as this lives.
class Plugin {
 public:
  /// Throws LoadError naming the file: cannot be loaded, exports no intersector, of another version, incomplete, or
  /// claims to be a surface that is not known.
  explicit Plugin(const std::string& file);

  [[nodiscard]] const Intersector& intersector() const { return *intersector_; }

 private:
  struct Close {
    void operator()(void* library) const;
  };
  std::unique_ptr<void, Close> library_;
  std::unique_ptr<const Intersector> intersector_;
};

/// "sphere 1" and the like, as crosscheck/intersector_plugin.h lists them. Throws std::invalid_argument.
[[nodiscard]] Surface parse_surface(const std::string& text);

/// Of one subject: the surface that an intersector claims to be. Throws std::invalid_argument.
[[nodiscard]] Family family_of(const Intersector& intersector);

}  // namespace alhazen::crosscheck
