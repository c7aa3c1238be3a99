#include "loaders/keyframes.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

namespace alhazen {
namespace {

using Value = std::vector<double>;

/// What the key holds: its value, or one of a cubic spline's three.
enum class Row : uint8_t { in_tangent, value, out_tangent };

Value row(const Keyframes& keys, size_t key, Row which = Row::value) {
  const bool cubic = keys.interpolation == Interpolation::cubic_spline;
  const size_t first = (cubic ? 3 * key + size_t(which) : key) * keys.width;
  const auto begin = keys.values.begin() + ptrdiff_t(first);
  return {begin, begin + ptrdiff_t(keys.width)};
}

Value mix(const Value& a, double wa, const Value& b, double wb) {
  Value out(a.size());
  for (size_t i = 0; i < a.size(); ++i) out[i] = wa * a[i] + wb * b[i];
  return out;
}

double inner_product(const Value& a, const Value& b) { return std::inner_product(a.begin(), a.end(), b.begin(), 0.0); }

/// `otherwise` where there is no direction.
Value unit(const Value& v, const Value& otherwise) {
  const double length = std::sqrt(inner_product(v, v));
  return length > 0 ? mix(v, 1 / length, v, 0) : otherwise;
}

/// The rotation that is `s` of the shorter way from a to b; both of unit length.
Value slerp(const Value& a, const Value& b, double s) {
  const double cosine = inner_product(a, b), sign = cosine < 0 ? -1 : 1;
  const double angle = std::acos(std::min(1.0, std::abs(cosine)));
  if (angle < 1e-6) return unit(mix(a, 1 - s, b, sign * s), a);  // where sines have no digits left to divide
  const double scale = 1 / std::sin(angle);
  return mix(a, std::sin((1 - s) * angle) * scale, b, sign * std::sin(s * angle) * scale);
}

/// Hermite's spline between `key` and the next, `span` seconds later; s in [0, 1].
Value spline(const Keyframes& keys, size_t key, double s, double span) {
  const double s2 = s * s, s3 = s2 * s;
  const Value values = mix(row(keys, key), 2 * s3 - 3 * s2 + 1, row(keys, key + 1), 3 * s2 - 2 * s3);
  const Value slopes = mix(row(keys, key, Row::out_tangent), span * (s3 - 2 * s2 + s),
                           row(keys, key + 1, Row::in_tangent), span * (s3 - s2));
  return mix(values, 1, slopes, 1);
}

Value between(const Keyframes& keys, size_t key, double seconds) {
  const double span = double(keys.times[key + 1]) - double(keys.times[key]);
  const double s = (seconds - double(keys.times[key])) / span;
  if (keys.interpolation == Interpolation::step) return row(keys, key);
  if (keys.interpolation == Interpolation::cubic_spline) return spline(keys, key, s, span);
  const Value a = row(keys, key), b = row(keys, key + 1);
  return keys.rotations ? slerp(unit(a, a), unit(b, b), s) : mix(a, 1 - s, b, s);
}

}  // namespace

std::vector<double> value_at(const Keyframes& keys, double seconds) {
  const auto after = std::upper_bound(keys.times.begin(), keys.times.end(), seconds,
                                      [](double t, float key) { return t < double(key); });
  const auto next = size_t(after - keys.times.begin());
  const size_t key = next == 0 ? 0 : next - 1;
  const bool clamped = next == 0 || next == keys.times.size() || seconds == double(keys.times[key]);
  const Value value = clamped ? row(keys, key) : between(keys, key, seconds);
  return keys.rotations ? unit(value, row(keys, key)) : value;
}

}  // namespace alhazen
