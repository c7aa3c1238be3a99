#include "accel/face_triangulation.h"

#include <algorithm>
#include <cmath>

#include "exact/surd.h"

namespace alhazen {
namespace {

/// 1 where a, b, c turn left, -1 where right, 0 on a line. Exact for coordinates that are floats: nothing overflows or
/// underflows in double.
int turn(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  const double left = (b.x - a.x) * (c.y - a.y), right = (b.y - a.y) * (c.x - a.x), area = left - right;
  const bool is_sure = left == 0 || right == 0 || std::abs(area) > (std::abs(left) + std::abs(right)) * 0x1p-50;
  if (is_sure) return (area > 0) - (area < 0);
  const Rational ax = exact(a.x), ay = exact(a.y);
  return sgn(Rational((exact(b.x) - ax) * (exact(c.y) - ay) - (exact(b.y) - ay) * (exact(c.x) - ax)));
}

/// The face seen along the largest axis of its normal, from the side on which its outline runs to the left.
class Projection {
 public:
  explicit Projection(const Vec3d& normal) {
    const Vec3d size = abs(normal);
    const int dropped = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    first_ = (dropped + 1) % 3, second_ = (dropped + 2) % 3;
    if (normal[dropped] < 0) std::swap(first_, second_);
  }
  [[nodiscard]] Vec2d operator()(const Vec3f& p) const { return {double(p[first_]), double(p[second_])}; }

 private:
  int first_, second_;
};

/// What cutting off corner b takes away: a triangle that turns left.
struct Ear {
  Vec2d a, b, c;
};

struct Box {
  Vec2d lower{HUGE_VAL, HUGE_VAL}, upper{-HUGE_VAL, -HUGE_VAL};

  void extend(const Vec2d& p) {
    lower = {std::min(lower.x, p.x), std::min(lower.y, p.y)};
    upper = {std::max(upper.x, p.x), std::max(upper.y, p.y)};
  }
};

/// Whether all of the box lies to the right of the line from p to q.
bool is_right_of(const Box& box, const Vec2d& p, const Vec2d& q) {
  const Vec2d leftmost{q.y > p.y ? box.lower.x : box.upper.x, q.x > p.x ? box.upper.y : box.lower.y};
  return turn(p, q, leftmost) < 0;
}

/// Whether the box is no more than a corner of the ear; so are those of many points at one place.
bool is_corner(const Box& box, const Ear& ear) {
  return box.lower == box.upper && (box.lower == ear.a || box.lower == ear.b || box.lower == ear.c);
}

bool overlap(const Box& box, const Ear& ear) {
  const auto [left, right] = std::minmax({ear.a.x, ear.b.x, ear.c.x});
  const auto [bottom, top] = std::minmax({ear.a.y, ear.b.y, ear.c.y});
  return left <= box.upper.x && right >= box.lower.x && bottom <= box.upper.y && top >= box.lower.y &&
         !is_right_of(box, ear.a, ear.b) && !is_right_of(box, ear.b, ear.c) && !is_right_of(box, ear.c, ear.a);
}

/// Points found by where they are: halved again and again, across the longer side of their box. The halves of node i
/// are nodes 2i and 2i + 1.
class PointTree {
 public:
  PointTree(const std::vector<Vec2d>& points, std::vector<uint32_t> chosen) : ids_(std::move(chosen)) {
    if (!ids_.empty()) build(points, 1, 0, ids_.size());
  }

  /// Whether `is_met` holds for any point in the ear, its rim included but its corners not, and perhaps for some
  /// beside it.
  template <class IsMet>
  [[nodiscard]] bool any_near(const Ear& ear, const IsMet& is_met) const {
    return !ids_.empty() && any_near(ear, is_met, 1, 0, ids_.size());
  }

 private:
  static constexpr size_t kLeafSize = 8;

  void build(const std::vector<Vec2d>& points, size_t node, size_t first, size_t end) {
    if (boxes_.size() <= node) boxes_.resize(node + 1);
    Box& box = boxes_[node];
    for (size_t i = first; i < end; ++i) box.extend(points[ids_[i]]);
    if (end - first <= kLeafSize) return;
    const bool wide = box.upper.x - box.lower.x > box.upper.y - box.lower.y;
    const size_t middle = (first + end) / 2;
    const auto at = [&](size_t i) { return ids_.begin() + std::ptrdiff_t(i); };
    std::nth_element(at(first), at(middle), at(end), [&](uint32_t i, uint32_t k) {
      return wide ? points[i].x < points[k].x : points[i].y < points[k].y;
    });
    build(points, 2 * node, first, middle), build(points, 2 * node + 1, middle, end);
  }

  template <class IsMet>
  bool any_near(const Ear& ear, const IsMet& is_met, size_t node, size_t first, size_t end) const {
    if (!overlap(boxes_[node], ear) || is_corner(boxes_[node], ear)) return false;
    const size_t middle = (first + end) / 2;
    if (end - first > kLeafSize)
      return any_near(ear, is_met, 2 * node, first, middle) || any_near(ear, is_met, 2 * node + 1, middle, end);
    return std::any_of(ids_.begin() + std::ptrdiff_t(first), ids_.begin() + std::ptrdiff_t(end), is_met);
  }

  std::vector<uint32_t> ids_;
  std::vector<Box> boxes_;
};

/// Cuts ears off an outline that runs to the left, until a triangle is left.
class EarClipper {
 public:
  explicit EarClipper(std::vector<Vec2d> points)
      : points_(std::move(points)),
        before_(points_.size()),
        after_(points_.size()),
        blocks_(points_.size()),
        tree_(points_, link_up()) {}

  [[nodiscard]] std::vector<std::array<uint32_t, 3>> clip() {
    // One pass does for every outline that does not touch itself; outlines that do, round bridges to holes, may change
    // what is an ear further off.
    constexpr int kPasses = 4;
    for (int pass = 0; pass < kPasses && left_ > 3; ++pass) clip_once();
    if (left_ > 3) return {};
    triangles_.push_back({before_[start_], start_, after_[start_]});
    return std::move(triangles_);
  }

 private:
  /// Makes the ring of corners; returns those at which it does not turn left. Only they can lie in an ear.
  std::vector<uint32_t> link_up() {
    const auto n = uint32_t(points_.size());
    left_ = n;
    for (uint32_t i = 0; i < n; ++i) before_[i] = i == 0 ? n - 1 : i - 1, after_[i] = i + 1 == n ? 0 : i + 1;
    std::vector<uint32_t> blocking;
    for (uint32_t i = 0; i < n; ++i)
      if ((blocks_[i] = !turns_left(i))) blocking.push_back(i);
    return blocking;
  }

  [[nodiscard]] bool turns_left(uint32_t i) const {
    return turn(points_[before_[i]], points_[i], points_[after_[i]]) > 0;
  }

  /// Whether the outline keeps clear of the triangle that cutting off corner i would take away, its rim included. What
  /// lies at the place of one of the three corners, where outlines touch themselves, does not count.
  [[nodiscard]] bool is_ear(uint32_t i) const {
    const Ear ear{points_[before_[i]], points_[i], points_[after_[i]]};
    return !tree_.any_near(ear, [&](uint32_t k) {
      const Vec2d& p = points_[k];
      return blocks_[k] && turn(ear.a, ear.b, p) >= 0 && turn(ear.b, ear.c, p) >= 0 && turn(ear.c, ear.a, p) >= 0 &&
             p != ear.a && p != ear.b && p != ear.c;
    });
  }

  /// Goes once round the outline, and back to the neighbours of what it cuts off. First in, first out keeps ears round.
  void clip_once() {
    std::vector<uint32_t> queue;
    for (uint32_t k = 0, i = start_; k < left_; ++k, i = after_[i]) queue.push_back(i);
    for (size_t k = 0; k < queue.size() && left_ > 3; ++k) {
      const uint32_t i = queue[k];
      if (after_[before_[i]] != i || blocks_[i] || !is_ear(i)) continue;
      const uint32_t a = before_[i], c = after_[i];
      cut_off(i);
      for (const uint32_t neighbour : {a, c}) {
        blocks_[neighbour] = blocks_[neighbour] && !turns_left(neighbour);
        queue.push_back(neighbour);
      }
    }
  }

  void cut_off(uint32_t i) {
    const uint32_t a = before_[i], c = after_[i];
    triangles_.push_back({a, i, c});
    after_[a] = c, before_[c] = a;
    start_ = c;
    --left_;
  }

  std::vector<Vec2d> points_;
  std::vector<uint32_t> before_, after_;  // the ring of corners that are left
  std::vector<uint8_t> blocks_;           // by corner: whether it is left and does not turn left
  std::vector<std::array<uint32_t, 3>> triangles_;
  uint32_t start_ = 0, left_ = 0;
  PointTree tree_;  // of the corners that block at first
};

}  // namespace

Vec3d newell_normal(std::span<const Vec3f> corners) {
  Vec3d normal{};
  for (size_t i = 1; i + 1 < corners.size(); ++i)
    normal += cross(Vec3d(corners[i]) - Vec3d(corners[0]), Vec3d(corners[i + 1]) - Vec3d(corners[0]));
  return normal;
}

bool is_proper_fan(std::span<const Vec3f> corners) {
  const Projection flat(newell_normal(corners));
  const Vec2d center = flat(corners[0]);
  for (size_t i = 1; i + 1 < corners.size(); ++i)
    if (turn(center, flat(corners[i]), flat(corners[i + 1])) <= 0) return false;
  return true;
}

std::vector<std::array<uint32_t, 3>> triangulate(std::span<const Vec3f> corners) {
  const Projection flat(newell_normal(corners));
  std::vector<Vec2d> points;
  points.reserve(corners.size());
  for (const Vec3f& p : corners) points.push_back(flat(p));
  return EarClipper(std::move(points)).clip();
}

}  // namespace alhazen
