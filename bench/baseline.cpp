#include "bench/baseline.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace alhazen {
namespace {

[[noreturn]] void stop(const char* why) {
  std::fprintf(stderr, "baseline: %s\n", why);
  std::abort();
}

void attach(RTCScene scene, RTCGeometry geometry) {
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
}

void attach_triangles(RTCDevice device, RTCScene scene, const TriangleMesh& mesh) {
  RTCGeometry g = embree::new_geometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  void* vertices =
      rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), mesh.positions.size());
  std::memcpy(vertices, mesh.positions.data(), mesh.positions.size() * sizeof(Vec3f));
  rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0,
                             3 * sizeof(uint32_t), mesh.triangles.size());
  attach(scene, g);
}

void attach_spheres(RTCDevice device, RTCScene scene, const Geometry& geometry) {
  RTCGeometry g = embree::new_geometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  const size_t n = geometry.shape_instances.size();
  auto* point = static_cast<float*>(
      rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), n));
  for (const ShapeInstance& placed : geometry.shape_instances) {
    const auto* sphere = std::get_if<Sphere>(&geometry.shapes[placed.shape]);
    const Affine3d& m = placed.world_from_object;
    if (!sphere || !(Affine3d{m.x, m.y, m.z, {}} == Affine3d{})) stop("only spheres that are moved alone");
    *point++ = float(m.origin.x), *point++ = float(m.origin.y), *point++ = float(m.origin.z);
    *point++ = sphere->radius;
  }
  attach(scene, g);
}

template <int width>
size_t count_hits(RTCScene scene, const RayWave& wave, Coherence coherence) {
  embree::Query query(coherence);
  size_t count = 0;
  for (size_t first = 0; first < wave.size(); first += width) {
    alignas(64) typename embree::Packets<width>::RayHit packet;
    alignas(64) int valid[width];
    for (int i = 0; i < width; ++i) {
      valid[i] = first + size_t(i) < wave.size() ? -1 : 0;
      packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
    embree::load_rays(wave, first, width, packet.ray);
    embree::intersect<width>(valid, scene, query, packet);
    for (int i = 0; i < width; ++i) count += packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
  }
  return count;
}

template <int width>
size_t count_blocked(RTCScene scene, const RayWave& wave, Coherence coherence) {
  embree::Query query(coherence);
  size_t count = 0;
  for (size_t first = 0; first < wave.size(); first += width) {
    alignas(64) typename embree::Packets<width>::Ray packet;
    alignas(64) int valid[width];
    for (int i = 0; i < width; ++i) valid[i] = first + size_t(i) < wave.size() ? -1 : 0;
    embree::load_rays(wave, first, width, packet);
    embree::occluded<width>(valid, scene, query, packet);
    for (int i = 0; i < width; ++i) count += valid[i] && packet.tfar[i] < 0;
  }
  return count;
}

}  // namespace

EmbreeBaseline::EmbreeBaseline(const Geometry& geometry, bool robust)
    : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)), width_(embree::packet_width(device_)) {
  rtcSetSceneFlags(scene_, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
  rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_MEDIUM);  // as ours
  for (const MeshInstance instance : geometry.mesh_instances) {
    if (!(instance.world_from_object == Affine3d{})) stop("only meshes placed by the identity");
    for (const TriangleMesh& part : geometry.meshes[instance.mesh].parts) attach_triangles(device_, scene_, part);
  }
  if (!geometry.shape_instances.empty()) attach_spheres(device_, scene_, geometry);
  rtcCommitScene(scene_);
  if (rtcGetDeviceError(device_) != RTC_ERROR_NONE) stop("Embree reports an error");
}

EmbreeBaseline::~EmbreeBaseline() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

size_t EmbreeBaseline::intersect(const RayWave& rays_world, Coherence coherence, Call call) const {
  const int width = call == Call::single ? 1 : width_;
  return width == 16  ? count_hits<16>(scene_, rays_world, coherence)
         : width == 8 ? count_hits<8>(scene_, rays_world, coherence)
         : width == 4 ? count_hits<4>(scene_, rays_world, coherence)
                      : count_hits<1>(scene_, rays_world, coherence);
}

size_t EmbreeBaseline::occluded(const RayWave& rays_world, Coherence coherence, Call call) const {
  const int width = call == Call::single ? 1 : width_;
  return width == 16  ? count_blocked<16>(scene_, rays_world, coherence)
         : width == 8 ? count_blocked<8>(scene_, rays_world, coherence)
         : width == 4 ? count_blocked<4>(scene_, rays_world, coherence)
                      : count_blocked<1>(scene_, rays_world, coherence);
}

}  // namespace alhazen
