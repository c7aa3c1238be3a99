#include "crosscheck/extra_report.h"

#include <cstdio>

namespace alhazen::crosscheck {
namespace {

template <class... Values>
std::string formatted(const char* format, Values... values) {
  char text[400];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

using Count = unsigned long long;

std::string with_example(std::string row, const std::string& example) {
  return example.empty() ? row : row + "  " + example + "\n";
}

}  // namespace

std::string mesh_head() {
  return formatted("%-10s %-9s %10s %9s | %-23s | %-23s | %-23s | %-17s\n", "", "", "", "from the", "watertight",
                   "plane and half-spaces", "3x3 system", "Embree: misses") +
         formatted("%-10s %-9s %10s %9s | %7s %7s %7s | %7s %7s %7s | %7s %7s %7s | %8s %8s\n", "mesh", "aimed at",
                   "rays", "centre", "misses", "odd", "shared", "misses", "odd", "shared", "misses", "odd", "shared",
                   "default", "robust");
}

std::string mesh_row(const MeshTally& t) {
  const auto leaks = [](const LeakCount& c) {
    return formatted(" | %7llu %7llu %7llu", Count(c.misses), Count(c.odd), Count(c.shared));
  };
  const std::string row =
      formatted("%-10s %-9s %10llu %9llu", t.mesh.c_str(), name_of(t.aim), Count(t.rays), Count(t.from_center)) +
      leaks(t.watertight) + leaks(t.half_spaces) + leaks(t.cramer) +
      formatted(" | %8llu %8llu\n", Count(t.native_misses), Count(t.robust_misses));
  return with_example(row, t.first_failure);
}

std::string spawn_head() { return formatted("%-15s %10s %10s\n", "spawned from", "hits", "self-hits"); }

std::string spawn_row(const SpawnTally& t) {
  const std::string row = formatted("%-15s %10llu %10llu\n", t.family.c_str(), Count(t.hits), Count(t.self_hits));
  return with_example(row, t.first_failure);
}

}  // namespace alhazen::crosscheck
