// A case on its own: what was asked, and what is known of the answer, as a JSON object. The records of a cross-check
// are such objects.
#pragma once

#include <optional>
#include <string>

#include "crosscheck/judge.h"
#include "crosscheck/subject_json.h"

namespace alhazen::crosscheck {

struct StatedCase {
  Subject subject;
  Rayf ray;
  bool robust_native = false;           // the flag of B's scene
  std::optional<Judgement> truth = {};  // as far as stated: hit, t, face and tie
  std::string about = {};               // for people
};

/// Reads
///
///     {"subject": as `to_json` writes it, "ray": as well,
///      "J": {"hit", "t", "face", "tie"}, "embree": {"scene_flags_B": "robust"}, "about": a sentence}
///
/// of which the second line may be missing; what else there is does not matter. Numbers are hexadecimal floats in
/// quotes, or JSON's own. Throws LoadError with `file`, the JSON pointer, what was found and what is expected: missing
/// members, rays that are not of floats, surfaces that are none, numbers larger than 1e18.
[[nodiscard]] StatedCase stated_case(const Json& json, const std::string& file);

/// Whether the judge says what was stated.
[[nodiscard]] bool is_as_stated(const Judgement& truth, const StatedCase& stated);

}  // namespace alhazen::crosscheck
