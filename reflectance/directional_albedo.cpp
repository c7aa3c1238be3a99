#include "reflectance/directional_albedo.h"

#include <array>
#include <numbers>
#include <queue>
#include <vector>

#include "materials/microfacet.h"
#include "reflectance/directions.h"

namespace alhazen {
namespace {

constexpr double kTolerance = 1e-4;      // of the value, or of 1 if that is more
constexpr int kMostCells = 2500;         // of 49 points each
constexpr int kRings = 6, kSectors = 8;  // cells to begin with
constexpr double kGrading = 9;           // the innermost of equal steps is e^-9 as wide as the outermost, about

// Kronrod's extension of Gauss' rule of three points to seven; every other point is one of Gauss'.
constexpr std::array<double, 7> kNodes{
    -0.960491268708020283423507092629080, -0.774596669241483377035853079956480, -0.434243749346802558002071502844628, 0,
    0.434243749346802558002071502844628,  0.774596669241483377035853079956480,  0.960491268708020283423507092629080};
constexpr std::array<double, 7> kKronrod{0.104656226026467265193823857192073, 0.268488089868333440728569280666710,
                                         0.401397414775962222905051818618432, 0.450916538658474142345110087045571,
                                         0.401397414775962222905051818618432, 0.268488089868333440728569280666710,
                                         0.104656226026467265193823857192073};
constexpr std::array<double, 7> kGauss{0, 5.0 / 9, 0, 8.0 / 9, 0, 5.0 / 9, 0};

double largest(const Vec3d& v) { return max_component(abs(v)); }

/// Directions above the surface, by two numbers in [0, 1]: t from `centre` to the horizon, u around it.
class PolarMap {
 public:
  explicit PolarMap(const Vec3f& centre) : centre_(normalize(Vec3d(centre))) {
    const ShadingFrame frame = frame_about(Vec3f(centre_));
    x_ = normalize(Vec3d(frame.t) - centre_ * dot(Vec3d(frame.t), centre_));
    y_ = cross(centre_, x_);
  }

  /// The direction, and its projected solid angle by t and u.
  [[nodiscard]] std::pair<Vec3d, double> at(double t, double u) const {
    const double psi = 2 * std::numbers::pi * u;
    const Vec3d outward = x_ * std::cos(psi) + y_ * std::sin(psi);
    const double horizon = std::atan2(centre_.z, -outward.z);
    const double delta = horizon * std::expm1(kGrading * t) / std::expm1(kGrading);
    const double stretch = horizon * kGrading * std::exp(kGrading * t) / std::expm1(kGrading);
    const Vec3d d = centre_ * std::cos(delta) + outward * std::sin(delta);
    return {d, std::max(0.0, d.z) * std::sin(delta) * stretch * 2 * std::numbers::pi};
  }

 private:
  Vec3d centre_, x_, y_;
};

/// Of the finer rule, as QUADPACK reckons it: where both agree well, it is far better than they tell.
double error_of(const Vec3d& fine, const Vec3d& coarse) {
  const double difference = largest(fine - coarse), size = largest(fine);
  return size > 0 ? std::min(difference, size * 10 * std::pow(difference / size, 1.5)) : difference;
}

struct Cell {
  double t, u, width_t, width_u;  // its lower corner
  Vec3d integral;
  double error;
  friend bool operator<(const Cell& a, const Cell& b) { return a.error < b.error; }
};

/// `f` by direction.
template <class F>
Cell integrated(const F& f, const PolarMap& map, double t, double u, double width_t, double width_u) {
  Vec3d fine, coarse;
  for (size_t i = 0; i < kNodes.size(); ++i)
    for (size_t k = 0; k < kNodes.size(); ++k) {
      const auto [d, measure] = map.at(t + width_t * (0.5 + 0.5 * kNodes[i]), u + width_u * (0.5 + 0.5 * kNodes[k]));
      const Rgb value = f(Vec3f(d));
      if (!is_finite(value)) continue;
      const Vec3d weighed = Vec3d(double(value.r), double(value.g), double(value.b)) * measure;
      fine += weighed * (kKronrod[i] * kKronrod[k]);
      coarse += weighed * (kGauss[i] * kGauss[k]);
    }
  const double area = width_t * width_u / 4;
  return {t, u, width_t, width_u, fine * area, error_of(fine, coarse) * area};
}

/// The integral of f(d) n·d over the directions d above the surface; f is steepest about `centre`.
template <class F>
Albedo integral(const F& f, const Vec3f& centre) {
  const PolarMap map(centre);
  std::priority_queue<Cell> cells;
  Vec3d sum;
  double error = 0;
  const auto add = [&](const Cell& cell) { sum += cell.integral, error += cell.error, cells.push(cell); };
  for (int i = 0; i < kRings; ++i)
    for (int k = 0; k < kSectors; ++k)
      add(integrated(f, map, double(i) / kRings, double(k) / kSectors, 1.0 / kRings, 1.0 / kSectors));
  // Quarter the worst cell until all together are good enough.
  while (error > kTolerance * std::max(1.0, largest(sum)) && cells.size() < kMostCells) {
    const Cell worst = cells.top();
    cells.pop();
    sum = sum - worst.integral, error -= worst.error;
    const double half_t = worst.width_t / 2, half_u = worst.width_u / 2;
    for (int quarter = 0; quarter < 4; ++quarter)
      add(integrated(f, map, worst.t + half_t * (quarter & 1), worst.u + half_u * (quarter >> 1), half_t, half_u));
  }
  return {{float(sum.x), float(sum.y), float(sum.z)}, std::max(0.0, error)};
}

}  // namespace

Albedo beam_albedo(const Brdf& brdf, const Vec3f& s) {
  return integral([&](const Vec3f& b) { return brdf(s, b); }, mirrored(s));
}

Albedo furnace_albedo(const Brdf& brdf, const Vec3f& b) {
  return integral([&](const Vec3f& s) { return brdf(s, b); }, mirrored(b));
}

}  // namespace alhazen
