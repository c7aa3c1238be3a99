#include <cmath>
#include <cstring>

#include "crosscheck/embree_scene.h"
#include "crosscheck/party.h"

namespace alhazen::crosscheck {
namespace {

constexpr double kLargest = 1e18;
constexpr double kUnitLength = 1e-6;  // how far from 1 a direction's squared length may be, to count as unit

RTCGeometry new_points(RTCDevice device, RTCGeometryType type, double radius) {
  RTCGeometry g = embree::new_geometry(device, type);
  auto* v = static_cast<float*>(
      rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), 1));
  v[0] = v[1] = v[2] = 0, v[3] = float(radius);
  return g;
}

RTCGeometry new_triangles(RTCDevice device, const std::vector<Vec3d>& vertices,
                          const std::vector<std::array<uint32_t, 3>>& triangles) {
  RTCGeometry g = embree::new_geometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* v = static_cast<Vec3f*>(
      rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), vertices.size()));
  for (size_t k = 0; k < vertices.size(); ++k) v[k] = Vec3f(vertices[k]);
  void* indices =
      rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), triangles.size());
  std::memcpy(indices, triangles.data(), triangles.size() * sizeof(triangles[0]));
  return g;
}

RTCGeometry new_geometry(RTCDevice device, const Sphere& s) {
  return new_points(device, RTC_GEOMETRY_TYPE_SPHERE_POINT, s.radius);
}

RTCGeometry new_geometry(RTCDevice device, const Disk& disk) {
  if (disk.inner_radius > 0) return nullptr;
  RTCGeometry g = new_points(device, RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT, disk.radius);
  auto* n = static_cast<float*>(
      rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_NORMAL, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 1));
  n[0] = n[2] = 0, n[1] = 1;
  return g;
}

RTCGeometry new_geometry(RTCDevice device, const Cylinder& c) {
  if (!c.caps) return nullptr;
  RTCGeometry g = embree::new_geometry(device, RTC_GEOMETRY_TYPE_CONE_LINEAR_CURVE);
  auto* v = static_cast<float*>(
      rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), 2));
  const auto half = float(c.height / 2);
  const float ends[8] = {0, -half, 0, float(c.radius_bottom), 0, half, 0, float(c.radius_top)};
  std::memcpy(v, ends, sizeof ends);
  *static_cast<uint32_t*>(rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, sizeof(uint32_t), 1)) =
      0;
  return g;
}

/// Two triangles a face, in the order of the faces.
RTCGeometry new_geometry(RTCDevice device, const Box& box) {
  std::vector<Vec3d> vertices;
  for (int k = 0; k < 8; ++k)
    vertices.push_back(box.size * Vec3d{k & 1 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5, k & 4 ? 0.5 : -0.5});
  std::vector<std::array<uint32_t, 3>> triangles;
  for (uint32_t axis = 0; axis < 3; ++axis) {
    const uint32_t u = 1u << (axis + 1) % 3, v = 1u << (axis + 2) % 3;
    for (uint32_t base : {0u, 1u << axis}) {
      triangles.push_back({base, base + u, base + u + v});
      triangles.push_back({base, base + u + v, base + v});
    }
  }
  return new_triangles(device, vertices, triangles);
}

/// Whether every corner of the only loop turns to the same side.
bool is_convex(const Polygon& p) {
  const size_t n = p.vertices.size();
  if (p.edges.empty()) return false;
  double turns = 0;
  for (size_t k = 0; k < n; ++k) {
    const Vec3d a = p.vertices[k], b = p.vertices[(k + 1) % n], c = p.vertices[(k + 2) % n];
    const Vec3d turn = cross(b - a, c - b);
    if (!(dot(turn, p.unit_normal) > 0)) return false;
    turns += std::acos(std::clamp(dot(normalize(b - a), normalize(c - b)), -1.0, 1.0));
  }
  return turns < 6.3;  // once around
}

RTCGeometry new_geometry(RTCDevice device, const Polygon& polygon) {
  if (!is_convex(polygon)) return nullptr;
  std::vector<std::array<uint32_t, 3>> fan;
  for (uint32_t k = 1; k + 1 < polygon.vertices.size(); ++k) fan.push_back({0, k, k + 1});
  return new_triangles(device, polygon.vertices, fan);
}

RTCGeometry new_geometry(RTCDevice device, const Triangle& t) {
  return new_triangles(device, {t.a, t.b, t.c}, {{{0, 1, 2}}});
}

RTCGeometry new_geometry(RTCDevice, const Quadric&) { return nullptr; }
RTCGeometry new_geometry(RTCDevice, const Composite&) { return nullptr; }

class NativeParty final : public Party {
 public:
  NativeParty(const Subject& subject, bool robust)
      : scene_(robust),
        map_(inverse(subject.world_from_object)),
        is_box_(std::holds_alternative<Box>(subject.surface)),
        is_curve_(std::holds_alternative<Cylinder>(subject.surface)) {
    RTCGeometry g = std::visit([&](const auto& s) { return new_geometry(scene_.device(), s); }, subject.surface);
    if (!g) return;
    exists_ = true;
    if (subject.world_from_object == Affine3d{})
      scene_.attach(g);
    else
      scene_.attach_instance(g, Affine3f(subject.world_from_object), robust);
    scene_.commit();
  }

  [[nodiscard]] bool exists() const { return exists_; }

  void answer(std::span<const Rayf> rays, std::vector<Answer>& answers) override {
    answers.assign(rays.size(), {});
    std::vector<Rayf> asked(rays.begin(), rays.end());
    for (size_t k = 0; k < rays.size(); ++k) {
      answers[k].asked = is_for(rays[k]);
      if (!answers[k].asked) asked[k] = Rayf{{0, 0, 0}, {0, 0, 1}};
    }
    scene_.trace(asked, [&](size_t k, const auto& hit, size_t lane, float t) {
      if (!answers[k].asked) return;
      answers[k].hit = true, answers[k].t = t;
      if (is_box_) answers[k].face = int(hit.primID[lane] / 2);
    });
  }

 private:
  /// Within an instance rays must not overflow Embree's numbers. Its cones take |direction| = 1 for granted.
  [[nodiscard]] bool is_for(const Rayf& ray) const {
    const Vec3d o = transform_point(map_, Vec3d(ray.origin)), d = transform_vector(map_, Vec3d(ray.direction));
    if (!(max_component(abs(o)) < kLargest && max_component(abs(d)) < kLargest)) return false;
    return !is_curve_ || std::abs(dot(d, d) - 1) < kUnitLength;
  }

  EmbreeScene scene_;
  Affine3d map_;
  bool is_box_, is_curve_, exists_ = false;
};

}  // namespace

std::unique_ptr<Party> native_party(const Subject& subject, bool robust) {
  auto party = std::make_unique<NativeParty>(subject, robust);
  if (!party->exists()) return nullptr;
  return party;
}

std::string embree_version() {
  const int width = embree::packet_width(shared_device());
  return std::string(RTC_VERSION_STRING) + ", " + std::to_string(width) + " lanes";
}

}  // namespace alhazen::crosscheck
