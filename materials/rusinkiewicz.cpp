#include "materials/rusinkiewicz.h"

namespace alhazen {

RusinkiewiczAngles rusinkiewicz(const Vec3f& n, const Vec3f& s, const Vec3f& b) noexcept {
  const Vec3f sum = s + b, difference = s - b;
  const Vec3f h = normalize(sum), n_x_h = cross(n, h);
  // The difference is perpendicular to h, so that its parts along the axes of the half vector's frame, the directions
  // in which theta_h and phi_h grow, are these over sin(theta_h).
  float y = dot(difference, n_x_h), x = -dot(n, difference);
  if (y < 0 || (y == 0 && x < 0)) y = -y, x = -x;
  return {std::atan2(length(n_x_h), dot(n, h)), std::atan2(length(difference), length(sum)), std::atan2(y, x)};
}

DirectionPair directions(const RusinkiewiczAngles& angles) noexcept {
  const float sin_h = std::sin(angles.theta_h), cos_h = std::cos(angles.theta_h);
  const Vec3f h{sin_h, 0, cos_h}, along_theta{cos_h, 0, -sin_h}, along_phi{0, 1, 0};
  const Vec3f across = along_theta * std::cos(angles.phi_d) + along_phi * std::sin(angles.phi_d);
  const Vec3f middle = h * std::cos(angles.theta_d), side = across * std::sin(angles.theta_d);
  return {middle + side, middle - side};
}

}  // namespace alhazen
