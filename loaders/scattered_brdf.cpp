#include "loaders/scattered_brdf.h"

#include <Eigen/Dense>
#include <array>
#include <nanoflann.hpp>
#include <numbers>
#include <vector>

#include "loaders/in_parallel.h"

namespace alhazen {
namespace {

constexpr MeasuredGrid kGrid{60, 30, 36};
constexpr size_t kNeighbours = 12;
constexpr double kDark = 1e-3;  // 1/sr: below it, differences count less and less
constexpr float kPi = std::numbers::pi_v<float>;

/// Where the angles lie in a space in which near is alike: theta_h by its square root, which highlights want, theta_d,
/// and phi_d by what it matters to the polar angles of both directions, which is nothing where theta_h or theta_d is 0.
/// Reciprocal and mirrored pairs have one place.
std::array<float, 3> place_of(const RusinkiewiczAngles& angles) {
  constexpr float kHighlight = 2, kTurn = 0.2f;  // how much they weigh against theta_d
  const float turn = std::sin(angles.theta_h) * std::sin(angles.theta_d) * std::cos(2 * angles.phi_d);
  return {kHighlight * std::sqrt(angles.theta_h / (kPi / 2)), angles.theta_d / (kPi / 2), kTurn * turn};
}

/// As nanoflann looks at them.
struct Places {
  std::vector<std::array<float, 3>> all;

  [[nodiscard]] size_t kdtree_get_point_count() const { return all.size(); }
  [[nodiscard]] float kdtree_get_pt(size_t i, size_t axis) const { return all[i][axis]; }
  template <class Box>
  [[nodiscard]] bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

class Scattered {
 public:
  explicit Scattered(std::span<const BrdfSample> samples) : samples_(samples), tree_(3, places_) {
    for (const BrdfSample& sample : samples)
      places_.all.push_back(place_of(rusinkiewicz({0, 0, 1}, sample.directions.s, sample.directions.b)));
    tree_.buildIndex();
  }

  [[nodiscard]] Rgb at(const RusinkiewiczAngles& angles) const {
    const std::array<float, 3> place = place_of(angles);
    std::array<size_t, kNeighbours> index;
    std::array<float, kNeighbours> squared;
    const size_t count = tree_.knnSearch(place.data(), kNeighbours, index.data(), squared.data());
    return plane_at(place, std::span(index.data(), count), std::span(squared.data(), count));
  }

 private:
  using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Places>, Places, 3, size_t>;

  /// The value at `place` of the plane that fits the samples' logarithms best by weighted least squares.
  [[nodiscard]] Rgb plane_at(const std::array<float, 3>& place, std::span<const size_t> nearest,
                             std::span<const float> squared) const {
    constexpr double kNear = 0.005, kSlopesHeld = 1e-3;
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Matrix<double, 4, 3> right = Eigen::Matrix<double, 4, 3>::Zero();
    Eigen::Array3d least = Eigen::Array3d::Constant(1e30), largest = -least;
    const double reach = 1.01 * std::sqrt(double(squared.back())) + kNear;
    for (size_t i = 0; i < nearest.size(); ++i) {
      const auto& at = places_.all[nearest[i]];
      const Rgb& f = samples_[nearest[i]].value;
      const double distance = std::sqrt(double(squared[i])) + kNear, nearness = (reach - distance + kNear) / distance;
      const Eigen::Vector4d terms(1, at[0] - place[0], at[1] - place[1], at[2] - place[2]);
      const Eigen::Vector3d value(std::log(f.r + kDark), std::log(f.g + kDark), std::log(f.b + kDark));
      normal += nearness * nearness * terms * terms.transpose();
      right += nearness * nearness * terms * value.transpose();
      least = least.min(value.array()), largest = largest.max(value.array());
    }
    // Slopes along which the samples do not differ are 0.
    const double held = kSlopesHeld * reach * reach * normal(0, 0);
    for (int k = 1; k < 4; ++k) normal(k, k) += held;
    const Eigen::Array3d logarithm = normal.ldlt().solve(right).row(0).transpose().array().max(least).min(largest);
    const Eigen::Array3f value = (logarithm.exp() - kDark).max(0).cast<float>();
    return {value[0], value[1], value[2]};
  }

  std::span<const BrdfSample> samples_;
  Places places_;
  Tree tree_;
};

}  // namespace

MeasuredTable table_through(std::span<const BrdfSample> samples) {
  const Scattered scattered(samples);
  MeasuredTable table{kGrid, std::vector<Rgb>(kGrid.size(), Rgb{-1})};
  const auto value = [&](int h, int d, int p) -> Rgb& {
    return table.values[(size_t(h) * size_t(kGrid.theta_d) + size_t(d)) * size_t(kGrid.phi_d) + size_t(p)];
  };
  for_each_in_parallel(size_t(kGrid.theta_h), [&](size_t plane) {
    const int h = int(plane);
    for (int d = 0; d < kGrid.theta_d; ++d)
      for (int p = 0; p < kGrid.phi_d / 2; ++p) {
        const RusinkiewiczAngles angles = cell_middle(kGrid, h, d, p);
        const DirectionPair pair = directions(angles);
        if (pair.s.z > 0 && pair.b.z > 0) value(h, d, p) = value(h, d, kGrid.phi_d - 1 - p) = scattered.at(angles);
      }
  });
  return table;
}

}  // namespace alhazen
