// The first case of each kind of error, shrunk when a run is over.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <tuple>

#include "crosscheck/shortest_case.h"

namespace alhazen::crosscheck {

class ShortestCases {
 public:
  /// Of A, and of B where `of_native` asks for them. `options` must outlive it.
  ShortestCases(const Options& options, bool of_native) : options_(options), of_native_(of_native) {}

  /// `command`: shows the case.
  void add(const std::string& family, const Case& c, const std::string& command);

  /// Shrinks what was added, in seconds for each. A record a line under a title; empty where nothing can be shown.
  [[nodiscard]] std::string text() const;

 private:
  struct Found {
    std::unique_ptr<const Subject> subject;
    Case c;
    std::string command;
  };
  void add(const std::string& family, const Case& c, Blamed blamed, Fault fault, const std::string& command);

  const Options& options_;
  bool of_native_;
  std::map<std::tuple<Blamed, std::string, Fault>, Found> found_;
};

}  // namespace alhazen::crosscheck
