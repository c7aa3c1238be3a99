#include "loaders/merl_file.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "core/error.h"

namespace alhazen {
namespace {

constexpr size_t kHeaderBytes = 3 * sizeof(int32_t);
constexpr int kMostOfAnAngle = 1024;
constexpr uint64_t kBytesInMemory = sizeof(Rgb) + 6;  // and what filling gaps takes, of an entry
constexpr std::array kScales{1 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0};
constexpr std::array kChannels{"red", "green", "blue"};

template <class T>
T read(std::span<const uint8_t> file, size_t at) {
  T value;
  std::memcpy(&value, file.data() + at, sizeof value);
  return value;
}

std::string counts_text(int h, int d, int p) {
  return std::to_string(h) + " x " + std::to_string(d) + " x " + std::to_string(p);
}

std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

class MerlFile {
 public:
  MerlFile(std::span<const uint8_t> file, const std::string& place) : file_(file), place_(place) {}

  MeasuredTable parse(LoadBudget& budget) const {
    MeasuredTable table{grid(), {}};
    check_length(table.grid);
    budget.take(place_, table.grid.size() * kBytesInMemory);
    table.values.resize(table.grid.size());
    bool any = false;
    for (size_t i = 0; i < table.values.size(); ++i) any |= read_entry(table.values, i);
    if (!any) fail("has no entry that is known: each is negative in some channel");
    return table;
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const { throw LoadError(place_, "", reason); }

  [[nodiscard]] MeasuredGrid grid() const {
    if (file_.size() < kHeaderBytes)
      fail("is " + std::to_string(file_.size()) +
           " bytes long, expected a MERL file, which begins with 12 bytes of counts");
    const MeasuredGrid grid{read<int32_t>(file_, 0), read<int32_t>(file_, 4), read<int32_t>(file_, 8)};
    for (const int count : {grid.theta_h, grid.theta_d, grid.phi_d})
      if (count < 1 || count > kMostOfAnAngle)
        fail("its header says " + counts_text(grid.theta_h, grid.theta_d, grid.phi_d) +
             " entries, expected a MERL file's 90 x 90 x 180, or others from 1 to 1024 for each angle");
    return grid;
  }

  void check_length(const MeasuredGrid& grid) const {
    const uint64_t expected = kHeaderBytes + uint64_t{grid.size()} * 3 * sizeof(double);
    if (file_.size() == expected) return;
    fail("is " + std::to_string(file_.size()) + " bytes long, " + std::to_string(expected) + " are expected for the " +
         counts_text(grid.theta_h, grid.theta_d, grid.phi_d) + " entries that its header says" +
         (file_.size() < expected ? ": is it cut off?" : ""));
  }

  /// Whether the entry is known.
  bool read_entry(std::vector<Rgb>& values, size_t i) const {
    std::array<double, 3> f;
    for (size_t c = 0; c < 3; ++c) f[c] = channel(values.size(), i, c);
    const bool known = f[0] >= 0 && f[1] >= 0 && f[2] >= 0;
    values[i] = known ? Rgb{float(f[0]), float(f[1]), float(f[2])} : Rgb{-1};
    return known;
  }

  /// In 1/sr.
  [[nodiscard]] double channel(size_t entries, size_t i, size_t c) const {
    const auto stored = read<double>(file_, kHeaderBytes + (c * entries + i) * sizeof(double));
    const double value = stored * kScales[c];
    if (std::isfinite(value) && value <= kLargestBrdf) return value;
    fail("entry " + std::to_string(i) + " of " + kChannels[c] + " is " + number_text(stored) +
         ", expected a number that stands for at most 1e9 1/sr; negative ones are entries that are not known");
  }

  std::span<const uint8_t> file_;
  const std::string& place_;
};

}  // namespace

MeasuredTable parse_merl(std::span<const uint8_t> file, const std::string& place, LoadBudget& budget) {
  return MerlFile(file, place).parse(budget);
}

}  // namespace alhazen
