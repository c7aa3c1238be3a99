// The ways in which a run can fail, each with the exit status that scripts rely on.
#pragma once

#include <stdexcept>
#include <string>

namespace alhazen {

enum class ExitStatus : int {
  done = 0,
  internal = 1,
  usage = 2,
  input = 3,
  output = 4,
  regressed = 6,  // against earlier measurements or pictures
  interrupted = 130,
  terminated = 143
};

class Error : public std::runtime_error {
 public:
  Error(const std::string& what, ExitStatus status) : std::runtime_error(what), status_(status) {}
  [[nodiscard]] ExitStatus exit_status() const noexcept { return status_; }

 private:
  ExitStatus status_;
};

/// The command line asks for something that there is not.
struct UsageError : Error {
  explicit UsageError(const std::string& what) : Error(what, ExitStatus::usage) {}
};

/// The input cannot be read or is invalid: file, place in it (a JSON pointer, may be empty), what was found and
/// expected.
struct LoadError : Error {
  LoadError(const std::string& file, const std::string& pointer, const std::string& reason)
      : Error(file + ": " + (pointer.empty() ? "" : pointer + ": ") + reason, ExitStatus::input) {}
};

/// The output cannot be written.
struct WriteError : Error {
  WriteError(const std::string& file, const std::string& reason) : Error(file + ": " + reason, ExitStatus::output) {}
};

}  // namespace alhazen
