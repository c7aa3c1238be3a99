#include "apps/sample_statistics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace alhazen {
namespace {

/// Linear between the sorted samples; `share` in [0, 1].
double quantile(const std::vector<double>& sorted, double share) {
  const double x = share * double(sorted.size() - 1);
  const auto k = size_t(x);
  return k + 1 < sorted.size() ? std::lerp(sorted[k], sorted[k + 1], x - double(k)) : sorted.back();
}

/// In how many orders of n and m samples u pairs have the first above the second, for u = 0 ... n m: the coefficients
/// of the Gaussian binomial, by the recurrence of the paper.
std::vector<double> orders_by_u(size_t n, size_t m) {
  std::vector<std::vector<std::vector<double>>> f(n + 1, std::vector<std::vector<double>>(m + 1));
  for (size_t i = 0; i <= n; ++i)
    for (size_t j = 0; j <= m; ++j) {
      f[i][j].assign(i * j + 1, i * j == 0 ? 1.0 : 0.0);
      if (i * j == 0) continue;
      for (size_t u = 0; u <= i * j; ++u) {
        const double largest_first = u >= j && u - j <= (i - 1) * j ? f[i - 1][j][u - j] : 0;
        f[i][j][u] = largest_first + (u <= i * (j - 1) ? f[i][j - 1][u] : 0);
      }
    }
  return f[n][m];
}

double exact_probability(double u, size_t n, size_t m) {
  const std::vector<double> orders = orders_by_u(n, m);
  const auto smaller = size_t(std::min(u, double(n * m) - u));
  double all = 0, as_extreme = 0;
  for (size_t k = 0; k < orders.size(); ++k) all += orders[k], as_extreme += k <= smaller ? orders[k] : 0;
  return std::min(1.0, 2 * as_extreme / all);
}

/// `tied` is the sum of t^3 - t over the groups of t equal samples.
double approximate_probability(double u, double n, double m, double tied) {
  const double all = n + m, variance = n * m / 12 * (all + 1 - tied / (all * (all - 1)));
  if (!(variance > 0)) return 1;
  const double z = std::max(0.0, std::abs(u - n * m / 2) - 0.5) / std::sqrt(variance);
  return std::erfc(z / std::sqrt(2.0));
}

/// Over the groups of t equal samples.
double sum_of_ties(std::vector<double> all) {
  std::ranges::sort(all);
  double sum = 0;
  for (size_t i = 0; i < all.size();) {
    const auto end = std::ranges::upper_bound(all, all[i]);
    const auto t = double(end - all.begin()) - double(i);
    sum += t * t * t - t;
    i = size_t(end - all.begin());
  }
  return sum;
}

}  // namespace

double median(std::vector<double> samples) {
  std::ranges::sort(samples);
  return quantile(samples, 0.5);
}

double relative_spread(std::vector<double> samples) {
  std::ranges::sort(samples);
  return (quantile(samples, 0.75) - quantile(samples, 0.25)) / 2 / quantile(samples, 0.5);
}

double mann_whitney(const std::vector<double>& a, const std::vector<double>& b) {
  double u = 0;
  for (const double x : a)
    for (const double y : b) u += x > y ? 1 : x == y ? 0.5 : 0;
  std::vector<double> all = a;
  all.insert(all.end(), b.begin(), b.end());
  const double tied = sum_of_ties(all);
  if (tied == 0 && all.size() <= 40) return exact_probability(u, a.size(), b.size());
  return approximate_probability(u, double(a.size()), double(b.size()), tied);
}

}  // namespace alhazen
