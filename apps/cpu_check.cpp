// Says so when the processor lacks what the program was built for, instead of dying of an illegal instruction.
// Compiled for any x86-64, and run before the initialisers of every other file of the program; so it uses no library
// but the system's.
#include <unistd.h>

#include <cstring>

#include "apps/cpu_features.h"
#include "core/error.h"

namespace {

void say(const char* text) { (void)!write(STDERR_FILENO, text, std::strlen(text)); }

__attribute__((constructor(101))) void check_cpu() {
  __builtin_cpu_init();
  const bool* needed = alhazen_built_for;
  bool missing = false;
  const auto check = [&](bool supported, const char* name) {
    if (!*needed++ || supported) return;
    say(missing ? ", " : "error: this program was built for a processor with instructions that this one lacks: ");
    say(name);
    missing = true;
  };
#define ALHAZEN_CHECK(macro, name) check(__builtin_cpu_supports(name) != 0, name);
  ALHAZEN_FOR_EACH_CPU_FEATURE(ALHAZEN_CHECK)
  if (!missing) return;
  say("\nBuild it on this machine, or with -DALHAZEN_PORTABLE=ON for any from 2013 on.\n");
  _exit(int(alhazen::ExitStatus::internal));
}

}  // namespace
