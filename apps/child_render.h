// `alhazen render` in a process of its own: nothing that it does, or dies of, harms the caller.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace alhazen {

struct ChildRender {
  int status = 0;  // exit status; 128 + signal where one ended it
  bool timed_out = false;
  double load_s = 0, build_s = 0, render_s = 0;
  uint64_t peak_bytes = 0;  // resident
  std::string error;        // what it said last, empty where it went well
  std::vector<std::string> warnings;
};

/// Renders `scene` to `picture`, with more `options` if any; `scratch` is a folder for what it prints. It is ended
/// after `limit_s` seconds, or when `stop` is set. Throws std::system_error where no process can be started.
[[nodiscard]] ChildRender render_in_child(const std::filesystem::path& scene, const std::filesystem::path& picture,
                                          const std::vector<std::string>& options, const std::filesystem::path& scratch,
                                          double limit_s, const std::atomic<bool>& stop);

}  // namespace alhazen
