// What one command of the program is to `main`: to add one, write its file and its row in alhazen.cpp.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace alhazen {

struct Command {
  CLI::App* parser;          // knows whether the command line names it
  std::function<int()> run;  // after parsing; returns the exit status
};

}  // namespace alhazen
