#include "accel/accelerated_scene.h"

#include <algorithm>
#include <cstring>
#include <span>
#include <type_traits>
#include <utility>

#include "accel/built_scene.h"
#include "accel/posed.h"
#include "core/error.h"

namespace alhazen {
namespace {

constexpr RTCBuildQuality embree_quality(BuildQuality quality) {
  return quality == BuildQuality::fast   ? RTC_BUILD_QUALITY_LOW
         : quality == BuildQuality::best ? RTC_BUILD_QUALITY_HIGH
                                         : RTC_BUILD_QUALITY_MEDIUM;
}

/// Embree's report of memory that it takes (or gives back).
bool count_bytes(void* built, ssize_t bytes, bool) {
  static_cast<BuiltScene*>(built)->bytes += uint64_t(bytes);
  return true;
}

RTCScene new_scene(const BuiltScene& built, const BuildOptions& options) {
  RTCScene scene = rtcNewScene(built.device);
  const unsigned robust = options.robust ? RTC_SCENE_FLAG_ROBUST : 0,
                 compact = options.compact ? RTC_SCENE_FLAG_COMPACT : 0;
  rtcSetSceneFlags(scene, RTCSceneFlags(robust | compact));
  rtcSetSceneBuildQuality(scene, embree_quality(options.quality));
  return scene;
}

/// Vertices of the pose `step`, in place where Embree can read them there.
void set_vertices(RTCGeometry g, unsigned step, const std::vector<Vec3f>& positions) {
  // Embree reads 16 bytes at each vertex, so the last of 12 needs readable memory after it.
  if (positions.capacity() > positions.size()) {
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, step, RTC_FORMAT_FLOAT3, positions.data(), 0, sizeof(Vec3f),
                               positions.size());
  } else {
    void* vertices =
        rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, step, RTC_FORMAT_FLOAT3, sizeof(Vec3f), positions.size());
    if (vertices) std::memcpy(vertices, positions.data(), positions.size() * sizeof(Vec3f));
  }
}

RTCGeometry new_embree_triangles(BuiltScene& built, const TriangleMesh& part, uint32_t part_index,
                                 const Track<MeshPose>* track, Opacity opacity) {
  RTCGeometry g = embree::new_geometry(built.device, RTC_GEOMETRY_TYPE_TRIANGLE);
  if (track) {
    rtcSetGeometryTimeStepCount(g, unsigned(track->size()));
    for (unsigned step = 0; step < track->size(); ++step) set_vertices(g, step, (*track)[step][part_index].positions);
  } else {
    set_vertices(g, 0, part.positions);
  }
  rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, part.triangles.data(), 0,
                             3 * sizeof(uint32_t), part.triangles.size());
  if (opacity == Opacity::cutout) rtcSetGeometryIntersectFilterFunction(g, leave_out_holes);
  if (opacity != Opacity::opaque) rtcSetGeometryOccludedFilterFunction(g, attenuate);
  rtcCommitGeometry(g);
  return g;
}

/// A fast build orders each geometry on its own, by the geometry's quality.
void set_quality(const BuiltScene& built, RTCGeometry g) {
  if (built.options.quality != BuildQuality::fast) return;
  rtcSetGeometryBuildQuality(g, embree_quality(BuildQuality::fast));
  rtcCommitGeometry(g);
}

/// Part `part_index` of the mesh as geometry `id` of the scene; `object`: where the part is not instanced.
void attach_part(BuiltScene& built, RTCScene scene, uint32_t id, const Mesh& mesh, const Track<MeshPose>* track,
                 uint32_t part_index, uint32_t object, bool watertight) {
  const TriangleMesh& part = mesh.parts[part_index];
  const Opacity opacity = built.filter.opacity.empty() ? Opacity::opaque : built.filter.opacity[part.material];
  RTCGeometry g;
  if (watertight) {
    built.triangle_groups.push_back(
        std::make_unique<TriangleGroup>(TriangleGroup{part, part_index, object, opacity, built.filter, track}));
    g = new_triangle_geometry(built.device, *built.triangle_groups.back());
  } else {
    g = new_embree_triangles(built, part, part_index, track, opacity);
  }
  set_quality(built, g);
  rtcAttachGeometryByID(scene, g, id);
  rtcReleaseGeometry(g);
}

void set_transform(RTCGeometry g, unsigned step, const Affine3d& m) {
  const float columns[12] = {float(m.x.x), float(m.x.y),      float(m.x.z),      float(m.y.x),
                             float(m.y.y), float(m.y.z),      float(m.z.x),      float(m.z.y),
                             float(m.z.z), float(m.origin.x), float(m.origin.y), float(m.origin.z)};
  rtcSetGeometryTransform(g, step, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
}

/// `track`: of the instance, null where it stands still at `m`.
RTCGeometry new_instance(const BuiltScene& built, RTCScene mesh, const Affine3d& m, const Track<Affine3d>* track) {
  RTCGeometry g = embree::new_geometry(built.device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(g, mesh);
  if (track) rtcSetGeometryTimeStepCount(g, unsigned(track->size()));
  for (unsigned step = 0; step < (track ? track->size() : 1); ++step)
    set_transform(g, step, track ? (*track)[step] : m);
  rtcCommitGeometry(g);
  return g;
}

/// As the next of the top level's geometries, whose meaning the caller notes after it.
void attach(BuiltScene& built, RTCScene scene, RTCGeometry g) {
  set_quality(built, g);
  rtcAttachGeometryByID(scene, g, unsigned(built.top.size()));
  rtcReleaseGeometry(g);
}

bool is_set(std::span<const char> flags, size_t i) { return i < flags.size() && flags[i] != 0; }

RTCScene mesh_scene(BuiltScene& built, uint32_t index) {
  RTCScene& shared = built.mesh_scenes[index];
  if (shared) return shared;
  const Mesh& mesh = built.geometry->meshes[index];
  shared = new_scene(built, built.options);
  for (uint32_t part = 0; part < mesh.parts.size(); ++part)
    if (!mesh.parts[part].triangles.empty())
      attach_part(built, shared, part, mesh, track_of_mesh(*built.geometry, index), part, kNone,
                  built.options.watertight);
  rtcCommitScene(shared);
  return shared;
}

/// The parts of a mesh that is placed once, in world space.
void attach_baked(BuiltScene& built, RTCScene scene, uint32_t object) {
  const uint32_t index = built.geometry->mesh_instances.mesh_of(object);
  const Mesh& mesh = built.geometry->meshes[index];
  for (uint32_t part = 0; part < mesh.parts.size(); ++part) {
    if (mesh.parts[part].triangles.empty()) continue;
    attach_part(built, scene, uint32_t(built.top.size()), mesh, track_of_mesh(*built.geometry, index), part, object,
                built.options.watertight);
    built.top.push_part(object, part);
  }
}

/// The instance, with those after it that go into one group with it: how many these are.
uint32_t attach_instances(BuiltScene& built, RTCScene scene, uint32_t object) {
  const Geometry& geometry = *built.geometry;
  const MeshInstance instance = geometry.mesh_instances[object];
  const Track<Affine3d>* const places = track_of_object(geometry, object);
  const RTCScene mesh = mesh_scene(built, instance.mesh);
  built.has_instances = true;
  // Of a mesh that also deforms, Embree bounds the two motions one by one; their product reaches further.
  const float reach = !places                                  ? reach_around_instance(instance.world_from_object)
                      : track_of_mesh(geometry, instance.mesh) ? 0
                                                               : reach_around_instance(*places);
  const uint32_t alike = group_size(geometry, object), count = alike >= kLeastInstanceGroup ? alike : 1;
  if (count > 1 || reach == 0) {
    built.instance_groups.push_back(
        std::make_unique<InstanceGroup>(InstanceGroup{&geometry.mesh_instances, object, count, mesh, places, {}}));
    attach(built, scene, new_instance_geometry(built.device, *built.instance_groups.back()));
  } else {
    built.reach = std::min(built.reach, reach);
    attach(built, scene, new_instance(built, mesh, instance.world_from_object, places));
  }
  built.top.push_part(object, 0);
  return count;
}

bool is_baked(const BuiltScene& built, uint32_t object) {
  const MeshInstances& placed = built.geometry->mesh_instances;
  return built.uses[placed.mesh_of(object)] == 1 && placed.world_from_object(object) == Affine3d{} &&
         !track_of_object(*built.geometry, object);
}

using OwnedScene = std::unique_ptr<std::remove_pointer_t<RTCScene>, decltype([](RTCScene s) { rtcReleaseScene(s); })>;

void attach_blurred_shapes(BuiltScene& built, RTCScene scene) {
  built.moving_shapes = moving_shapes(*built.geometry, built.filter);
  for (const auto& group : built.moving_shapes) {
    attach(built, scene, new_moving_geometry(built.device, *group));
    std::vector<uint32_t> objects;
    for (const MovingShapes::Member& member : group->members) objects.push_back(member.object);
    built.top.push_shapes(objects);
  }
}

/// A scene of what stands still, or of what moves from frame to frame; null where there is nothing.
RTCScene build(BuiltScene& built, bool moving) {
  const Geometry& geometry = *built.geometry;
  const size_t first = built.top.size();
  OwnedScene owned(new_scene(built, built.options));
  const RTCScene scene = owned.get();
  for (uint32_t object = 0; object < geometry.mesh_instances.size();) {
    if (is_set(built.options.moving.meshes, geometry.mesh_instances.mesh_of(object)) != moving)
      ++object;
    else if (is_baked(built, object))
      attach_baked(built, scene, object++);
    else
      object += attach_instances(built, scene, object);
  }
  const auto wanted = [&](const ShapeInstance& shape) {
    return is_set(built.options.moving.nodes, shape.node) == moving;
  };
  for (auto& group : group_shapes(geometry, built.filter, wanted)) {
    attach(built, scene, new_shape_geometry(built.device, *group));
    built.top.push_shapes(group->objects);
    built.shape_groups.push_back(std::move(group));
  }
  if (moving || built.options.moving.nodes.empty()) attach_blurred_shapes(built, scene);
  if (built.top.size() == first) return nullptr;
  rtcCommitScene(scene);
  return owned.release();
}

/// Of those that move: their scenes stay when their places change.
void build_rigid_meshes(BuiltScene& built) {
  const MovingParts& moving = built.options.moving;
  for (uint32_t object = 0; object < built.geometry->mesh_instances.size(); ++object) {
    const uint32_t mesh = built.geometry->mesh_instances.mesh_of(object);
    if (is_set(moving.meshes, mesh) && !is_set(moving.deforming, mesh)) (void)mesh_scene(built, mesh);
  }
}

void build_moving(BuiltScene& built) {
  built.scenes[1] =
      built.options.moving.meshes.empty() && built.options.moving.nodes.empty() ? nullptr : build(built, true);
  if (const RTCError error = rtcGetDeviceError(built.device); error != RTC_ERROR_NONE)
    throw Error("building the hierarchy: Embree error " + std::to_string(int(error)), ExitStatus::internal);
}

/// Leaves what stands still.
void forget_moving(BuiltScene& built) {
  if (built.scenes[1]) rtcReleaseScene(std::exchange(built.scenes[1], nullptr));
  for (size_t i = 0; i < built.mesh_scenes.size(); ++i)
    if (is_set(built.options.moving.deforming, i) && built.mesh_scenes[i])
      rtcReleaseScene(std::exchange(built.mesh_scenes[i], nullptr));
  built.top.shrink_to(built.standing.top, built.standing.shapes);
  built.shape_groups.resize(built.standing.shape_groups);
  built.instance_groups.resize(built.standing.instance_groups);
  built.triangle_groups.resize(built.standing.triangle_groups);
  built.has_instances = built.standing.has_instances, built.reach = built.standing.reach;
}

/// The lists that stand in place of those that were read.
void find_instances_again(BuiltScene& built) {
  for (auto& group : built.shape_groups) alhazen::find_instances_again(*built.geometry, *group);
}

/// What each object is, wherever it is.
std::vector<uint64_t> identities(const Geometry& geometry) {
  std::vector<uint64_t> all;
  const MeshInstances& meshes = geometry.mesh_instances;
  for (size_t i = 0; i < meshes.size(); ++i) all.push_back(uint64_t{meshes.node_of(i)} << 32 | meshes.mesh_of(i));
  for (const ShapeInstance& placed : geometry.shape_instances) {
    all.push_back(uint64_t{placed.node} << 32 | placed.shape);
    all.push_back(placed.material);
  }
  return all;
}

bool has_mostly_shapes(const Geometry& geometry, const std::vector<uint32_t>& uses) {
  size_t triangles = 0;
  for (size_t i = 0; i < uses.size(); ++i)
    for (const TriangleMesh& part : geometry.meshes[i].parts) triangles += uses[i] * part.triangles.size();
  return geometry.shape_instances.size() > triangles;
}

}  // namespace

AcceleratedScene::AcceleratedScene(const Geometry& geometry, const SurfaceFilter& filter, const BuildOptions& options)
    : built_(std::make_unique<BuiltScene>()) {
  BuiltScene& built = *built_;
  built.filter = filter;
  built.has_filters =
      std::any_of(filter.opacity.begin(), filter.opacity.end(), [](Opacity o) { return o != Opacity::opaque; });
  const std::string config = options.threads > 0 ? "threads=" + std::to_string(options.threads) : "";
  built.device = rtcNewDevice(config.c_str());
  if (!built.device) throw Error("Embree has no device for this CPU", ExitStatus::internal);
  rtcSetDeviceMemoryMonitorFunction(built.device, count_bytes, &built);
  built.width = embree::packet_width(built.device);
  built.geometry = &geometry, built.options = options;
  built.mesh_scenes.assign(geometry.meshes.size(), nullptr);
  built.uses = uses_of_meshes(geometry);
  built.mostly_shapes = has_mostly_shapes(geometry, built.uses);
  built.opacity.assign(filter.opacity.begin(), filter.opacity.end());
  if (!options.moving.nodes.empty()) built.identities = identities(geometry);

  built.scenes[0] = build(built, false);
  build_rigid_meshes(built);
  built.standing = {built.top.size(),
                    built.top.object_of_shape.size(),
                    built.shape_groups.size(),
                    built.instance_groups.size(),
                    built.triangle_groups.size(),
                    built.has_instances,
                    built.reach};
  build_moving(built);
}

bool AcceleratedScene::update(const SurfaceFilter& filter) {
  BuiltScene& built = *built_;
  if (built.options.moving.nodes.empty()) return true;
  if (identities(*built.geometry) != built.identities || !std::ranges::equal(filter.opacity, built.opacity))
    return false;
  built.filter = filter;
  forget_moving(built);
  find_instances_again(built);
  build_moving(built);
  return true;
}

AcceleratedScene::~AcceleratedScene() = default;

uint64_t AcceleratedScene::bytes() const noexcept { return built_->bytes; }

std::string traversal_version() {
  RTCDevice device = rtcNewDevice(nullptr);
  const int width = device ? embree::packet_width(device) : 0;
  if (device) rtcReleaseDevice(device);
  return std::string("Embree ") + RTC_VERSION_STRING + ", " + std::to_string(width) + " lanes";
}

}  // namespace alhazen
