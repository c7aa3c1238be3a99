#include "reflectance/brdf_csv.h"

#include <array>
#include <charconv>
#include <cmath>
#include <string>

#include "reflectance/directions.h"

namespace alhazen {
namespace {

int steps_below(double end, double step) { return int(std::ceil(end / step - 1e-9)); }

template <class T>
void append(std::string& text, T value, char after) {
  std::array<char, 32> digits;
  const auto [last, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  text.append(digits.data(), last) += after;
}

/// All exitant directions for light from one.
std::string rows_of(const Brdf& brdf, double theta_i, double phi_i, double step) {
  std::string text;
  const Vec3f s = direction_at(theta_i, phi_i);
  for (int i = 0; i < steps_below(90, step); ++i)
    for (int k = 0; k < steps_below(360, step); ++k) {
      const Rgb value = brdf(s, direction_at(i * step, k * step));
      for (const double angle : {theta_i, phi_i, i * step, k * step}) append(text, angle, ',');
      append(text, value.r, ','), append(text, value.g, ','), append(text, value.b, '\n');
    }
  return text;
}

}  // namespace

double brdf_csv_rows(double step, bool isotropic) noexcept {
  const double thetas = steps_below(90, step), phis = steps_below(360, step);
  return thetas * (isotropic ? 1 : phis) * thetas * phis;
}

void write_brdf_csv(const Brdf& brdf, double step, bool isotropic, const std::function<void(std::string_view)>& write) {
  write(std::string(kBrdfCsvHeader) + "\n");
  for (int i = 0; i < steps_below(90, step); ++i)
    for (int k = 0; k < (isotropic ? 1 : steps_below(360, step)); ++k) write(rows_of(brdf, i * step, k * step, step));
}

}  // namespace alhazen
