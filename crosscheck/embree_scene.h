// A bare Embree scene and its packets: what the parties that are not an AcceleratedScene are made of.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "accel/embree.h"
#include "core/transform.h"

namespace alhazen::crosscheck {

/// The device of all these scenes: making one takes as long as hundreds of rays.
[[nodiscard]] inline RTCDevice shared_device() {
  static const std::unique_ptr<RTCDeviceTy, decltype(&rtcReleaseDevice)> device(rtcNewDevice(nullptr),
                                                                                rtcReleaseDevice);
  return device.get();
}

/// The ray that a user geometry is asked about.
[[nodiscard]] inline Rayf ray_of(const RTCIntersectFunctionNArguments* args, unsigned lane) {
  RTCRayN* ray = RTCRayHitN_RayN(args->rayhit, args->N);
  const unsigned n = args->N;
  return {{RTCRayN_org_x(ray, n, lane), RTCRayN_org_y(ray, n, lane), RTCRayN_org_z(ray, n, lane)},
          {RTCRayN_dir_x(ray, n, lane), RTCRayN_dir_y(ray, n, lane), RTCRayN_dir_z(ray, n, lane)},
          RTCRayN_tnear(ray, n, lane),
          RTCRayN_tfar(ray, n, lane)};
}

/// Owns a scene.
class EmbreeScene {
 public:
  explicit EmbreeScene(bool robust) : scene_(new_scene(robust)) {}
  ~EmbreeScene() {
    for (RTCScene s : inner_) rtcReleaseScene(s);
    rtcReleaseScene(scene_);
  }
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  [[nodiscard]] static RTCDevice device() { return shared_device(); }

  /// Commits, attaches and releases the geometry.
  void attach(RTCGeometry g) { attach_to(scene_, g); }
  /// The same through an instance.
  void attach_instance(RTCGeometry g, const Affine3f& m, bool robust) { attach_instance(new_inner(g, robust), m); }

  /// A scene of one geometry, to be placed any number of times. It lives as long as this.
  [[nodiscard]] RTCScene new_inner(RTCGeometry g, bool robust) {
    inner_.push_back(new_scene(robust));
    attach_to(inner_.back(), g);
    rtcCommitScene(inner_.back());
    return inner_.back();
  }
  void attach_instance(RTCScene inner, const Affine3f& m) {
    RTCGeometry instance = embree::new_geometry(device(), RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, inner);
    const float columns[12] = {m.x.x, m.x.y, m.x.z, m.y.x,      m.y.y,      m.y.z,
                               m.z.x, m.z.y, m.z.z, m.origin.x, m.origin.y, m.origin.z};
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
    attach_to(scene_, instance);
  }
  void commit() { rtcCommitScene(scene_); }

  /// Calls found(ray, hit packet, lane, t) for each ray that hits something.
  template <class Found>
  void trace(std::span<const Rayf> rays, const Found& found) const {
    constexpr size_t kWidth = 8;
    embree::Query query(Coherence::incoherent);
    for (size_t first = 0; first < rays.size(); first += kWidth) {
      alignas(64) embree::Packets<kWidth>::RayHit packet;
      alignas(64) int valid[kWidth];
      for (size_t i = 0; i < kWidth; ++i) {
        valid[i] = first + i < rays.size() ? -1 : 0;
        load(rays[std::min(first + i, rays.size() - 1)], i, packet);
        packet.ray.id[i] = unsigned(first + i);
      }
      embree::intersect<kWidth>(valid, scene_, query, packet);
      for (size_t i = 0; i < kWidth && first + i < rays.size(); ++i)
        if (packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID) found(first + i, packet.hit, i, packet.ray.tfar[i]);
    }
  }

 private:
  [[nodiscard]] static RTCScene new_scene(bool robust) {
    RTCScene scene = rtcNewScene(device());
    rtcSetSceneFlags(scene, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    return scene;
  }
  static void attach_to(RTCScene scene, RTCGeometry g) {
    rtcCommitGeometry(g);
    rtcAttachGeometry(scene, g);
    rtcReleaseGeometry(g);
  }
  template <class Packet>
  static void load(const Rayf& ray, size_t i, Packet& p) {
    p.ray.org_x[i] = ray.origin.x, p.ray.org_y[i] = ray.origin.y, p.ray.org_z[i] = ray.origin.z;
    p.ray.dir_x[i] = ray.direction.x, p.ray.dir_y[i] = ray.direction.y, p.ray.dir_z[i] = ray.direction.z;
    p.ray.tnear[i] = ray.t_min, p.ray.tfar[i] = ray.t_max;
    p.ray.time[i] = 0, p.ray.mask[i] = embree::kEveryRay, p.ray.flags[i] = 0;
    p.hit.geomID[i] = p.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }

  RTCScene scene_;
  std::vector<RTCScene> inner_;
};

}  // namespace alhazen::crosscheck
