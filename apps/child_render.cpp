#include "apps/child_render.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>
#include <thread>

namespace alhazen {
namespace {

namespace fs = std::filesystem;

pid_t start(std::vector<std::string> arguments, const fs::path& out, const fs::path& err) {
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  pid_t child = 0;
  const int failed = posix_spawn(&child, "/proc/self/exe", &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) throw std::system_error(failed, std::generic_category(), "cannot start a render");
  return child;
}

/// Waits for it, and kills it when it is too late.
void wait(pid_t child, double limit_s, const std::atomic<bool>& stop, ChildRender& run) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(limit_s);
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    run.timed_out = Clock::now() > end;
    if (run.timed_out || stop) kill(child, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  run.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// Lines of "error: ..." and "warning: ...".
void read_complaints(const fs::path& file, ChildRender& run) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("warning: ")) run.warnings.push_back(line.substr(9));
    if (line.starts_with("error: ")) run.error = line.substr(7);
  }
  if (run.timed_out) run.error = "took too long";
  if (run.status != 0 && run.error.empty()) run.error = "ended with status " + std::to_string(run.status);
}

void read_facts(const fs::path& file, ChildRender& run) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    const auto json = nlohmann::json::parse(line, nullptr, false);
    if (!json.is_object() || json.value("event", "") != "done") continue;
    const auto& seconds = json["seconds"];
    run.load_s = seconds["load"], run.build_s = seconds["build"], run.render_s = seconds["render"];
    run.peak_bytes = json["peak_bytes"];
  }
}

}  // namespace

ChildRender render_in_child(const fs::path& scene, const fs::path& picture, const std::vector<std::string>& options,
                            const fs::path& scratch, double limit_s, const std::atomic<bool>& stop) {
  std::vector<std::string> arguments = {"alhazen", "render", scene, "-o", picture, "--progress", "json"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const fs::path out = scratch / "out", err = scratch / "err";
  ChildRender run;
  wait(start(std::move(arguments), out, err), limit_s, stop, run);
  read_complaints(err, run);
  read_facts(out, run);
  return run;
}

}  // namespace alhazen
