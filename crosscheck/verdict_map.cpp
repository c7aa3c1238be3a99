#include "crosscheck/verdict_map.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace alhazen::crosscheck {
namespace {

double into_unit(double x) { return std::isfinite(x) ? std::clamp(x, 0.0, 1.0) : 0.0; }

/// The face that a hit without one lies nearest to.
int nearest_face(const Cylinder& c, const Vec3d& p) {
  int nearest = kWallFace;
  double least = HUGE_VAL;
  for (const int face : {kWallFace, 2, 3}) {
    if (face != kWallFace && !c.caps) continue;
    const Vec3d off = project(c, p, face) - p;
    if (const double d = dot(off, off); d < least) least = d, nearest = face;
  }
  return nearest;
}
template <class S>
int nearest_face(const S&, const Vec3d&) {
  return kWallFace;
}
int nearest_face(const Disk&, const Vec3d&) { return 3; }

template <class S>
bool has_two_sheets() {
  return std::is_same_v<S, Cylinder> || std::is_same_v<S, Quadric> || std::is_same_v<S, Composite>;
}

template <class S>
MapPlace place_on(const S& shape, const Vec3d& p, int given_face) {
  const int face = given_face == kNoFace ? nearest_face(shape, p) : given_face;
  const Vec2f uv = texture_coordinates(shape, project(shape, p, face), face);
  const bool flat = has_two_sheets<S>() && face % kFacesPerLeaf != kWallFace;
  return {flat ? SheetKind::flat_faces : SheetKind::surface, into_unit(double(uv.x)), into_unit(double(uv.y))};
}

MapPlace place_on(const Triangle& t, const Vec3d& p, int) {
  const Vec3d n = cross(t.b - t.a, t.c - t.a);
  const double size = dot(n, n);
  const double u = dot(cross(p - t.a, t.c - t.a), n) / size, v = dot(cross(t.b - t.a, p - t.a), n) / size;
  return {SheetKind::surface, into_unit(u), into_unit(v)};
}

/// Half the width and height of what is seen of it from any side.
std::optional<Vec2d> seen_size(const Surface& surface) {
  if (const auto* sphere = std::get_if<Sphere>(&surface)) return Vec2d{sphere->radius, sphere->radius};
  const auto* c = std::get_if<Cylinder>(&surface);
  if (!c) return std::nullopt;
  const double radius = std::max(c->radius_bottom, c->radius_top);
  return Vec2d{radius, std::hypot(c->height / 2, radius)};
}

/// Where the line passes the centre, seen along the line with the y axis upright.
std::optional<MapPlace> outline_place(const Case& c, const Affine3d& object_from_world) {
  const std::optional<Vec2d> size = seen_size(c.subject->surface);
  if (!size) return std::nullopt;
  const Vec3d o = transform_point(object_from_world, Vec3d(c.ray.origin));
  const Vec3d d = normalize(transform_vector(object_from_world, Vec3d(c.ray.direction)));
  const Vec3d passing = o - d * dot(o, d);
  const Vec3d right = normalize(std::abs(d.y) < 1 ? cross(d, Vec3d{0, 1, 0}) : Vec3d{1, 0, 0}), up = cross(right, d);
  const double x = dot(passing, right) / (size->x * kOutlineMargin), y = dot(passing, up) / (size->y * kOutlineMargin);
  if (!(std::abs(x) < 1 && std::abs(y) < 1)) return std::nullopt;
  return MapPlace{SheetKind::outline, (1 + x) / 2, (1 - y) / 2};
}

/// Where it hits, or is said to.
std::optional<MapPlace> surface_place(const Case& c, const Affine3d& object_from_world) {
  const bool a_hits = c.a.asked && c.a.hit, b_hits = c.b && c.b->hit;
  if (!c.truth.hit && !a_hits && !b_hits) return std::nullopt;
  const float t = c.truth.hit ? c.truth.t : a_hits ? c.a.t : c.b->t;
  const int face = c.truth.hit ? c.truth.face : a_hits ? c.a.face : c.b->face;
  const Vec3d p_world = Vec3d(c.ray.origin) + Vec3d(c.ray.direction) * double(t);
  const Vec3d p = transform_point(object_from_world, p_world);
  if (!is_finite(p)) return std::nullopt;
  return std::visit([&](const auto& s) { return place_on(s, p, face); }, c.subject->surface);
}

}  // namespace

std::vector<MapPlace> map_places(const Case& c) {
  std::vector<MapPlace> places;
  if (!c.subject || c.verdict == Verdict::out_of_domain) return places;
  const Affine3d object_from_world = inverse(c.subject->world_from_object);
  if (const auto place = surface_place(c, object_from_world)) places.push_back(*place);
  if (const auto place = outline_place(c, object_from_world)) places.push_back(*place);
  return places;
}

Mark mark_of(const Case& c) {
  switch (c.verdict) {
    case Verdict::a_right:
      return c.b_fault == Fault::wrong_t || c.b_fault == Fault::wrong_normal ? Mark::native_inexact
                                                                             : Mark::native_wrong;
    case Verdict::b_right:
      return Mark::custom_wrong;
    case Verdict::both_wrong:
      return Mark::both_wrong;
    case Verdict::unexplained:
      return Mark::unexplained;
    case Verdict::tie_edge:
    case Verdict::tie_tangent:
    case Verdict::tie_coplanar:
      return Mark::tie;
    default:
      return Mark::agree;
  }
}

uint32_t VerdictSheet::Cell::rays() const { return std::accumulate(count.begin(), count.end(), 0u); }

void VerdictSheet::add(const MapPlace& place, Mark mark) {
  const auto cell = [&](double x) { return size_t(std::min(int(x * side_), side_ - 1)); };
  ++cells_[cell(place.v) * size_t(side_) + cell(place.u)].count[size_t(mark)];
  ++rays_;
}

}  // namespace alhazen::crosscheck
