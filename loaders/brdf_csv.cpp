#include "loaders/brdf_csv.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "loaders/merl_file.h"

namespace alhazen {
namespace {

constexpr std::string_view kHeader = "theta_i,phi_i,theta_o,phi_o,r,g,b", kSpaces = " \t\r";
constexpr std::array<std::string_view, 7> kNames{"theta_i", "phi_i", "theta_o", "phi_o", "r", "g", "b"};
constexpr size_t kLongestExcerpt = 40;
constexpr uint64_t kBytesOfSample = 6 * sizeof(BrdfSample);  // while the vector grows, and a tree is built

std::string_view trimmed(std::string_view text) {
  const size_t first = text.find_first_not_of(kSpaces);
  return first == std::string_view::npos ? "" : text.substr(first, text.find_last_not_of(kSpaces) + 1 - first);
}

/// The text up to `mark`, which is taken off with it.
std::string_view take_until(std::string_view& text, char mark) {
  const size_t end = std::min(text.find(mark), text.size());
  const std::string_view part = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return part;
}

std::string excerpt(std::string_view text) {
  std::string out(text.substr(0, kLongestExcerpt));
  std::replace_if(
      out.begin(), out.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return "`" + out + (text.size() > kLongestExcerpt ? "..." : "") + "`";
}

Vec3f direction(double theta_degrees, double phi_degrees) {
  const double theta = theta_degrees * std::numbers::pi / 180, phi = phi_degrees * std::numbers::pi / 180;
  return Vec3f(Vec3d{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
}

class BrdfCsv {
 public:
  BrdfCsv(std::string_view text, const std::string& place) : rest_(text), place_(place) {}

  std::vector<BrdfSample> parse(LoadBudget& budget) {
    std::vector<BrdfSample> samples;
    if (next_line()) check_header();
    while (next_line()) {
      budget.take(place_, kBytesOfSample);
      samples.push_back(sample());
    }
    if (samples.empty())
      throw LoadError(place_, "", "has no samples, expected lines of numbers under " + excerpt(kHeader));
    return samples;
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw LoadError(place_, "line " + std::to_string(number_), reason);
  }

  /// Goes to the next line that says something; false at the end.
  bool next_line() {
    while (!rest_.empty()) {
      line_ = trimmed(take_until(rest_, '\n'));
      ++number_;
      if (!line_.empty() && line_.front() != '#') return true;
    }
    return false;
  }

  void check_header() const {
    std::string squeezed(line_);
    std::erase_if(squeezed, [](char c) { return kSpaces.find(c) != std::string_view::npos; });
    if (squeezed != kHeader) fail("expected the header " + excerpt(kHeader) + ", found " + excerpt(line_));
  }

  [[nodiscard]] BrdfSample sample() const {
    if (const auto commas = std::count(line_.begin(), line_.end(), ','); commas != 6)
      fail("expected 7 numbers with commas between them, found " + std::to_string(commas + 1));
    std::string_view rest = line_;
    std::array<double, 7> f;
    for (size_t i = 0; i < f.size(); ++i) f[i] = field(i, trimmed(take_until(rest, ',')));
    return {{direction(f[0], f[1]), direction(f[2], f[3])}, {float(f[4]), float(f[5]), float(f[6])}};
  }

  [[nodiscard]] double field(size_t i, std::string_view text) const {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool polar = i == 0 || i == 2, angle = i < 4;
    const bool in_range = polar   ? std::abs(value) < 90
                          : angle ? std::abs(value) <= 360
                                  : value >= 0 && value <= kLargestBrdf;
    if (error == std::errc() && end == text.data() + text.size() && std::isfinite(value) && in_range) return value;
    fail(std::string(kNames[i]) + " is " + excerpt(text) + ", expected " +
         (polar   ? "degrees above -90 and below 90"
          : angle ? "degrees from -360 to 360"
                  : "a number from 0 to 1e9, in 1/sr; leave lines out where nothing was measured"));
  }

  std::string_view rest_, line_;
  size_t number_ = 0;
  const std::string& place_;
};

}  // namespace

std::vector<BrdfSample> parse_brdf_csv(std::string_view text, const std::string& place, LoadBudget& budget) {
  return BrdfCsv(text, place).parse(budget);
}

}  // namespace alhazen
