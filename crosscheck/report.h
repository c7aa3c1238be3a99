// What a cross-check says: a row for each family and population, a JSON line for each disagreement.
#pragma once

#include <map>
#include <ostream>
#include <string>

#include "crosscheck/scene_check.h"

namespace alhazen::crosscheck {

/// The heads of the columns, then rows under them.
[[nodiscard]] std::string table_head();
[[nodiscard]] std::string table_row(const std::string& family, const std::string& population, const Tally& tally);

/// The text as a shell takes it for one word.
[[nodiscard]] std::string shell_word(const std::string& text);

/// The command that judges this one ray again. `source`: scene or intersector arguments, with a space in front.
[[nodiscard]] std::string reproduction(const std::string& family, Population population, uint64_t index, uint64_t seed,
                                       const std::string& source);

/// A case without where it comes from: `stated_case` reads it back, and knows the judge's answer. One line of JSON.
[[nodiscard]] std::string record(const std::string& about, const Case& c);

/// One line of JSON without its end: ray and subject in hexadecimal floats, what the parties say, how far off each is.
[[nodiscard]] std::string record(const std::string& family, const Case& c, const Options& options,
                                 const std::string& source);

/// How the renderer's own picture compares, in a sentence. `source`: as for `reproduction`.
[[nodiscard]] std::string picture_text(const PictureTally& picture, const std::string& source);

/// What the textbook's triangles did with the rays of one family and population: a head, and a row; none for others.
[[nodiscard]] std::string textbook_head();
[[nodiscard]] std::string textbook_row(const std::string& family, const std::string& population,
                                       const TextbookCounts& counts);

/// How often a party is wrong, and the first example of each fault.
class Faults {
 public:
  void add(const std::string& family, const Case& c, const std::string& command);
  /// A paragraph for each party that was wrong; empty where none was.
  [[nodiscard]] std::string text() const;

 private:
  struct Entry {
    uint64_t count = 0;
    std::string example;
  };
  using Table = std::map<std::pair<std::string, Fault>, Entry>;
  Table a_, b_;
};

/// How often each relation was asked for and did not hold, over all families and populations.
class RelationReport {
 public:
  /// `command`: of the ray of a number.
  void add(const RelationCounts& counts, const std::function<std::string(uint64_t index)>& command);
  /// A paragraph; empty where nothing was asked.
  [[nodiscard]] std::string text() const;

 private:
  RelationCounts counts_{};
  std::array<std::string, kRelations> examples_;  // the command of the first that does not hold
};

}  // namespace alhazen::crosscheck
