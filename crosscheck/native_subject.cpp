#include "crosscheck/native_subject.h"

#include <cmath>

#include "accel/instance_geometry.h"

namespace alhazen::crosscheck {
namespace {

class Rounding {
 public:
  void operator()(double& x) {
    const auto rounded = double(float(x));
    changed_ = changed_ || rounded != x;
    lost_ = lost_ || !std::isfinite(rounded) || (rounded == 0) != (x == 0);
    x = rounded;
  }
  void operator()(Vec3d& v) { (*this)(v.x), (*this)(v.y), (*this)(v.z); }
  void operator()(Affine3d& m) {
    (*this)(m.x), (*this)(m.y), (*this)(m.z), (*this)(m.origin);
    lost_ = lost_ || !is_invertible(m) || reach_around_instance(m) == 0;
  }

  void operator()(Sphere& s) { (*this)(s.radius); }
  void operator()(Cylinder& c) { (*this)(c.height), (*this)(c.radius_bottom), (*this)(c.radius_top); }
  void operator()(Disk& d) { (*this)(d.radius), (*this)(d.inner_radius); }
  void operator()(Box& b) { (*this)(b.size); }
  void operator()(Triangle& t) { (*this)(t.a), (*this)(t.b), (*this)(t.c); }
  void operator()(Polygon& p) {  // its plane is what it is
    for (Vec3d v : p.vertices) (*this)(v);
    lost_ = lost_ || changed_;
  }
  void operator()(Quadric&) { lost_ = true; }
  void operator()(Composite&) { lost_ = true; }

  [[nodiscard]] bool changed() const { return changed_; }
  [[nodiscard]] bool lost() const { return lost_; }

 private:
  bool changed_ = false, lost_ = false;
};

}  // namespace

std::optional<NativeSubject> native_subject(const Subject& subject) {
  NativeSubject native{subject};
  Rounding round;
  std::visit(round, native.subject.surface);
  round(native.subject.world_from_object);
  if (round.lost()) return std::nullopt;
  native.rounded = round.changed();
  return native;
}

}  // namespace alhazen::crosscheck
