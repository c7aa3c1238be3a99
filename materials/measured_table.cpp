#include "materials/measured_table.h"

#include <array>
#include <cstdint>
#include <limits>
#include <numbers>

namespace alhazen {
namespace {

constexpr float kPi = std::numbers::pi_v<float>, kHalfPi = kPi / 2;

// ---- Gaps ----

constexpr uint16_t kFar = std::numeric_limits<uint16_t>::max();

bool is_known(const Rgb& value) { return value.r >= 0; }

/// Calls `visit(entry)` with the neighbours of one: two along each angle, where there are any.
template <class Visit>
void visit_neighbours(const MeasuredGrid& grid, size_t entry, const Visit& visit) {
  const size_t row = size_t(grid.phi_d), plane = row * size_t(grid.theta_d);
  const size_t p = entry % row, d = entry / row % size_t(grid.theta_d), h = entry / plane;
  visit(entry - p + (p + 1) % row);
  visit(entry - p + (p + row - 1) % row);
  if (d > 0) visit(entry - row);
  if (d + 1 < size_t(grid.theta_d)) visit(entry + row);
  if (h > 0) visit(entry - plane);
  if (h + 1 < size_t(grid.theta_h)) visit(entry + plane);
}

/// All entries by their distance from those that are known, in steps from neighbour to neighbour, nearest first.
struct Reach {
  std::vector<uint16_t> steps;  // by entry
  std::vector<uint32_t> order;  // the known ones, then the others
};

Reach reach_from_known(const MeasuredTable& table) {
  Reach reach{std::vector<uint16_t>(table.values.size(), kFar), {}};
  reach.order.reserve(table.values.size());
  for (size_t i = 0; i < table.values.size(); ++i)
    if (is_known(table.values[i])) reach.steps[i] = 0, reach.order.push_back(uint32_t(i));
  for (size_t next = 0; next < reach.order.size(); ++next) {
    const uint32_t from = reach.order[next];
    visit_neighbours(table.grid, from, [&](size_t to) {
      if (reach.steps[to] != kFar) return;
      reach.steps[to] = uint16_t(reach.steps[from] + 1), reach.order.push_back(uint32_t(to));
    });
  }
  return reach;
}

// ---- Look-ups ----

/// Two neighbouring cells of an angle, and how far the place is from the middle of the first to that of the second.
struct Between {
  size_t first, second;
  float share;
};

/// theta_h and theta_d: before the first middle and beyond the last the end's value holds. At 0 that is what smoothness
/// asks: on the other side of the pole are the same entries again, since phi_d + pi stands for phi_d.
Between between(float position, int count) {
  const float inside = std::min(std::max(0.0f, position), float(count - 1));
  const size_t first = size_t(inside);
  return {first, std::min(first + 1, size_t(count - 1)), inside - float(first)};
}

Between between_wrapped(float position, int count) {
  const float below = std::floor(position);
  const int first = (int(below) + count) % count;
  return {size_t(first), size_t((first + 1) % count), position - below};
}

Rgb interpolated(const MeasuredTable& table, const Between& h, const Between& d, const Between& p) {
  const auto along_phi = [&](size_t row) {
    const Rgb* values = table.values.data() + row * size_t(table.grid.phi_d);
    return lerp(values[p.first], values[p.second], p.share);
  };
  const auto along_theta_d = [&](size_t plane) {
    const size_t row = plane * size_t(table.grid.theta_d);
    return lerp(along_phi(row + d.first), along_phi(row + d.second), d.share);
  };
  return lerp(along_theta_d(h.first), along_theta_d(h.second), h.share);
}

}  // namespace

RusinkiewiczAngles cell_middle(const MeasuredGrid& grid, int theta_h, int theta_d, int phi_d) noexcept {
  const auto middle = [](int cell, int count) { return (float(cell) + 0.5f) / float(count); };
  const float root = middle(theta_h, grid.theta_h);
  return {kHalfPi * root * root, kHalfPi * middle(theta_d, grid.theta_d), kPi * middle(phi_d, grid.phi_d)};
}

size_t fill_gaps(MeasuredTable& table) {
  const Reach reach = reach_from_known(table);
  size_t known = 0;
  for (const uint32_t entry : reach.order) {
    const uint16_t steps = reach.steps[entry];
    if (steps == 0) {
      ++known;
      continue;
    }
    Rgb sum;
    int count = 0;
    visit_neighbours(table.grid, entry, [&](size_t from) {
      if (reach.steps[from] < steps) sum += table.values[from], ++count;
    });
    table.values[entry] = sum * (1 / float(count));
  }
  return known;
}

Rgb evaluate(const MeasuredTable& table, const Vec3f& n, const Vec3f& s, const Vec3f& b) noexcept {
  if (!(dot(n, s) > 0 && dot(n, b) > 0)) return {};
  const RusinkiewiczAngles angles = rusinkiewicz(n, s, b);
  const MeasuredGrid& grid = table.grid;
  const Between h = between(std::sqrt(angles.theta_h / kHalfPi) * float(grid.theta_h) - 0.5f, grid.theta_h);
  const Between d = between(angles.theta_d / kHalfPi * float(grid.theta_d) - 0.5f, grid.theta_d);
  const Between p = between_wrapped(angles.phi_d / kPi * float(grid.phi_d) - 0.5f, grid.phi_d);
  return interpolated(table, h, d, p);
}

}  // namespace alhazen
