#include "crosscheck/native_geometry.h"

#include <cmath>
#include <cstring>

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

}  // namespace

RTCGeometry new_native_geometry(RTCDevice device, const Surface& surface) {
  return std::visit([&](const auto& s) { return new_geometry(device, s); }, surface);
}

bool native_is_for(const Surface& surface, const Affine3d& object_from_world, const Rayf& ray) {
  const Vec3d o = transform_point(object_from_world, Vec3d(ray.origin));
  const Vec3d d = transform_vector(object_from_world, Vec3d(ray.direction));
  if (!(max_component(abs(o)) < kLargest && max_component(abs(d)) < kLargest)) return false;
  return !std::holds_alternative<Cylinder>(surface) || std::abs(dot(d, d) - 1) < kUnitLength;
}

}  // namespace alhazen::crosscheck
