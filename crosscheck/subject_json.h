// Subjects and rays as JSON, every number as a hexadecimal float: what is written is what was tested, and can be read
// back.
#pragma once

#include <nlohmann/json.hpp>

#include "crosscheck/subject.h"

namespace alhazen::crosscheck {

using Json = nlohmann::ordered_json;

[[nodiscard]] std::string hex(double x);
[[nodiscard]] Json hex(const Vec3d& v);
[[nodiscard]] Json to_json(const Subject& subject);
[[nodiscard]] Json to_json(const Rayf& ray);

}  // namespace alhazen::crosscheck
