#include "crosscheck/ball_map.h"

namespace alhazen::crosscheck {

template <class N>
BallMap<N>::BallMap(std::span<const Affine3d> chain) {
  for (const Affine3d& m : chain) {
    if (m == Affine3d{}) continue;
    const Vec3<Rational> x = exact(m.x), y = exact(m.y), z = exact(m.z);
    const Vec3<Rational> cx = cross(y, z), cy = cross(z, x), cz = cross(x, y);
    const Rational det = dot(x, cx);
    const auto entry = [&](const Rational& v) { return Ball<N>(Rational(v / det)); };
    const auto row = [&](const Vec3<Rational>& c) { return Vec3<Ball<N>>{entry(c.x), entry(c.y), entry(c.z)}; };
    steps_.push_back({row(cx), row(cy), row(cz), Vec3<Ball<N>>(m.origin)});
  }
}

template <class N>
BallLine<N> BallMap<N>::operator()(BallLine<N> line) const {
  for (const Step& step : steps_) {
    const auto apply = [&](const Vec3<Ball<N>>& v) {
      return Vec3<Ball<N>>{dot(step.row_x, v), dot(step.row_y, v), dot(step.row_z, v)};
    };
    line = {apply(line.origin - step.center), apply(line.direction)};
  }
  return line;
}

template class BallMap<double>;
template class BallMap<DoubleDouble>;

}  // namespace alhazen::crosscheck
