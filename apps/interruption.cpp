#include "apps/interruption.h"

#include <unistd.h>

#include <csignal>

#include "loaders/part_file.h"

namespace alhazen {
namespace {

std::atomic<int> g_signal{0};
std::atomic<std::atomic<bool>*> g_stop{nullptr};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<std::atomic<bool>*>::is_always_lock_free);

extern "C" void on_signal(int signal) {
  std::atomic<bool>* const stop = g_stop;
  if (g_signal.exchange(signal) == 0 && stop) {
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
  for (const int signal : {SIGINT, SIGTERM}) sigaction(signal, &action, nullptr);
  for (const int signal : {SIGPIPE, SIGXFSZ, SIGHUP}) std::signal(signal, SIG_IGN);
}

void stop_on_signal(std::atomic<bool>& stop) { g_stop = &stop; }

int caught_signal() { return g_signal; }

}  // namespace alhazen
