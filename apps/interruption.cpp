#include "apps/interruption.h"

#include <time.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>

#include "loaders/part_file.h"

namespace alhazen {
namespace {

/// timeout(1), shells and terminals may signal a process and then its group: what follows this soon is the same
/// request.
constexpr std::int64_t kOneRequestNs = 200'000'000;

std::atomic<int> g_signal{0};
std::atomic<std::int64_t> g_signal_ns{0};
std::atomic<std::atomic<bool>*> g_stop{nullptr};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free &&
              std::atomic<std::atomic<bool>*>::is_always_lock_free);

std::int64_t monotonic_ns() {
  timespec now = {};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

/// Whether this is the first request to stop, or its echo. Called by handlers that do not interrupt one another.
bool is_first_request(int signal) {
  if (g_signal != 0) return monotonic_ns() - g_signal_ns < kOneRequestNs;
  g_signal_ns = monotonic_ns();
  g_signal = signal;
  return true;
}

extern "C" void on_signal(int signal) {
  std::atomic<bool>* const stop = g_stop;
  if (is_first_request(signal) && stop) {
    *stop = true;
    return;
  }
  remove_part_file();
  _exit(128 + signal);
}

}  // namespace

void catch_signals() {
  struct sigaction action = {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM}) sigaddset(&action.sa_mask, signal);
  for (const int signal : {SIGINT, SIGTERM}) sigaction(signal, &action, nullptr);
  for (const int signal : {SIGPIPE, SIGXFSZ, SIGHUP}) std::signal(signal, SIG_IGN);
}

void stop_on_signal(std::atomic<bool>& stop) { g_stop = &stop; }

int caught_signal() { return g_signal; }

}  // namespace alhazen
