#include "accel/accelerated_scene.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "accel/embree.h"
#include "accel/instance_geometry.h"
#include "accel/moving_shapes.h"
#include "accel/packet.h"
#include "accel/posed.h"
#include "accel/ray_rows.h"
#include "accel/shape_geometry.h"
#include "accel/triangle_geometry.h"
#include "accel/wave_query.h"
#include "core/error.h"
#include "core/lane_memory.h"

namespace alhazen {
namespace {

constexpr RTCBuildQuality embree_quality(BuildQuality quality) {
  return quality == BuildQuality::fast   ? RTC_BUILD_QUALITY_LOW
         : quality == BuildQuality::best ? RTC_BUILD_QUALITY_HIGH
                                         : RTC_BUILD_QUALITY_MEDIUM;
}

/// Of directions in a packet that is traced as one: beyond it, its rays meet too many nodes that only some of them
/// need.
constexpr float kLeastCosine = 0.9f;

/// What a top-level geometry number stands for.
struct TopEntry {
  enum class Kind : uint8_t { none, baked_part, instance, instances, shapes, moving_shapes } kind = Kind::none;
  uint32_t object = kNone, part = 0;  // shapes: their group in place of the part
};

}  // namespace

struct AcceleratedScene::Impl {
  SurfaceFilter filter;
  std::vector<std::unique_ptr<ShapeGroup>> shape_groups;
  std::vector<std::unique_ptr<MovingShapes>> moving_shapes;
  std::vector<std::unique_ptr<InstanceGroup>> instance_groups;
  std::vector<std::unique_ptr<TriangleGroup>> triangle_groups;  // of ours
  std::vector<TopEntry> top;
  std::vector<uint32_t> object_of_top, part_of_top;  // by number in `top`, and one more, so that there is one
  std::vector<RTCScene> mesh_scenes;
  RTCDevice device = nullptr;
  std::array<RTCScene, 2> scenes{};  // what stands still, and what moves from frame to frame; null where there is none
  bool has_instances = false;
  float reach = embree::kReach;  // of rays' coordinates
  bool has_filters = false;      // surfaces that let some light through
  int width = 4;                 // of coherent waves' packets
  int incoherent_width = 4;      // of others'
  std::atomic<uint64_t> bytes{0};

  const Geometry* geometry = nullptr;
  BuildOptions options;
  std::vector<uint32_t> uses;  // by mesh
  struct {
    size_t top, shape_groups, instance_groups, triangle_groups;
    bool has_instances;
    float reach;
  } standing{};                      // how many of the lists' elements, and what else, does not change in update()
  std::vector<uint64_t> identities;  // of objects, in their order
  std::vector<Opacity> opacity;

  ~Impl() {
    for (RTCScene s : scenes)
      if (s) rtcReleaseScene(s);
    for (RTCScene s : mesh_scenes)
      if (s) rtcReleaseScene(s);
    if (device) rtcReleaseDevice(device);
  }

  /// On compact scenes it does so as well as on those with instances.
  [[nodiscard]] bool coherent_occluded_16_hangs() const {
    return embree::kCoherentOccluded16HangsOnInstances && (has_instances || options.compact);
  }

  struct Ids {
    uint32_t object, part, primitive;
  };
  /// `u` holds a shape's face, which takes the place of the part.
  [[nodiscard]] Ids ids(uint32_t instance, uint32_t geometry_id, uint32_t primitive, float u) const {
    if (instance != RTC_INVALID_GEOMETRY_ID) {
      const uint32_t object = instance & kInGroup ? instance & ~kInGroup : top[instance].object;
      return {object, geometry_id, primitive};
    }
    const TopEntry& entry = top[geometry_id];
    if (entry.kind == TopEntry::Kind::shapes) return {shape_groups[entry.part]->objects[primitive], uint32_t(u), 0};
    if (entry.kind == TopEntry::Kind::moving_shapes)
      return {moving_shapes[entry.part]->members[primitive].object, uint32_t(u), 0};
    return {entry.object, entry.part, primitive};
  }
};

/// Embree's callbacks and packet loops; they see Impl, nobody else does.
struct AcceleratedScene::Traversal {
  struct Query : WaveQuery {
    const Impl* impl;
    Query(const Impl& i, Coherence rays, Rgb* visible_by_ray)
        : WaveQuery(rays, visible_by_ray, i.object_of_top.data()), impl(&i) {}
  };

  static Crossing crossing_of(const RTCFilterFunctionNArguments* args, const Impl& impl, unsigned lane) {
    const Impl::Ids ids =
        impl.ids(RTCHitN_instID(args->hit, args->N, lane, 0), RTCHitN_geomID(args->hit, args->N, lane),
                 RTCHitN_primID(args->hit, args->N, lane), RTCHitN_u(args->hit, args->N, lane));
    return {
        ids.object, ids.part, ids.primitive, RTCHitN_u(args->hit, args->N, lane), RTCHitN_v(args->hit, args->N, lane),
        {}};
  }

  /// Triangles with holes: refuse the hits that fall into one.
  static void leave_out_holes(const RTCFilterFunctionNArguments* args) {
    const Impl& impl = *embree::query_of<Query>(args).impl;
    for (unsigned i = 0; i < args->N; ++i)
      if (args->valid[i] && !impl.filter.is_present(impl.filter.data, crossing_of(args, impl, i))) args->valid[i] = 0;
  }

  /// Triangles that let light through: refuse the hit, keep the product, until nothing is left.
  static void attenuate(const RTCFilterFunctionNArguments* args) {
    const Query& query = embree::query_of<Query>(args);
    for (unsigned i = 0; i < args->N; ++i) {
      if (!args->valid[i]) continue;
      Rgb& visible = query.visible[RTCRayN_id(args->ray, args->N, i)];
      visible *= query.impl->filter.transmittance(query.impl->filter.data, crossing_of(args, *query.impl, i));
      if (max_component(visible) > 0) args->valid[i] = 0;
    }
  }

  template <class Packet>
  static void load_rays(const RayWave& wave, size_t first, int width, Packet& ray) {
    const size_t bytes = size_t(width) * sizeof(float);
    std::memcpy(ray.org_x, &wave.origin.x[first], bytes), std::memcpy(ray.org_y, &wave.origin.y[first], bytes);
    std::memcpy(ray.org_z, &wave.origin.z[first], bytes), std::memcpy(ray.dir_x, &wave.direction.x[first], bytes);
    std::memcpy(ray.dir_y, &wave.direction.y[first], bytes), std::memcpy(ray.dir_z, &wave.direction.z[first], bytes);
    std::memcpy(ray.tnear, &wave.t_min[first], bytes), std::memcpy(ray.tfar, &wave.t_max[first], bytes);
    for (int i = 0; i < width; ++i)
      ray.time[i] = 0, ray.mask[i] = embree::kEveryRay, ray.flags[i] = 0, ray.id[i] = unsigned(first) + unsigned(i);
    if (wave.time.size() > 0) std::memcpy(ray.time, &wave.time[first], bytes);
  }

  /// The lanes that hold rays that traversal can take, and -1 for each in `valid`, else 0: those out of reach, and
  /// those that are not numbers, hit nothing.
  template <int width>
  static uint32_t choose_lanes(const Impl& impl, const RayWave& wave, size_t first, int lanes, int* valid) {
    const auto within = [&](const Vec3Lanes& v) {
      const auto below = [&](const Lanes<float>& row) {
        return absolute(FloatLanes<width>(&row[first], std::experimental::element_aligned)) < impl.reach;
      };
      return below(v.x) && below(v.y) && below(v.z);
    };
    const uint32_t bits = lane_bits(within(wave.origin) && within(wave.direction)) & ((1u << lanes) - 1);
    for (int i = 0; i < width; ++i) valid[i] = -int(bits >> i & 1);
    return bits;
  }

  /// Whether a packet's rays run side by side, so that they meet mostly the same nodes.
  template <int width>
  static bool run_together(const RayWave& wave, size_t first, uint32_t lanes) {
    using F = FloatLanes<width>;
    if (lanes == 0) return false;
    const auto row = [&](const Lanes<float>& of) { return F(&of[first], std::experimental::element_aligned); };
    const F x = row(wave.direction.x), y = row(wave.direction.y), z = row(wave.direction.z);
    const F squared = x * x + y * y + z * z;
    const auto lead = size_t(std::countr_zero(lanes));
    const F along = x * F(x[lead]) + y * F(y[lead]) + z * F(z[lead]);
    const auto apart = along < 0 || along * along < squared * F(kLeastCosine * kLeastCosine * squared[lead]);
    return (lane_bits(apart) & lanes) == 0;
  }

  template <int width>
  static bool are_of_one_octant(const RayWave& wave, size_t first, uint32_t lanes) {
    const auto alike = [&](const Lanes<float>& row) {
      uint32_t negative = 0;
      for (size_t k = 0; k < width; ++k) negative |= uint32_t(std::signbit(row[first + k])) << k;
      negative &= lanes;
      return negative == 0 || negative == lanes;
    };
    return alike(wave.direction.x) && alike(wave.direction.y) && alike(wave.direction.z);
  }

  /// Which packets may be traced as one.
  enum class Joining : uint8_t { none, one_octant, any };

  /// Calls `trace(query, packet's first ray, rays of it, lanes to trace as `valid`)` for each packet, with the query
  /// that suits it: for rays that run together, as far as that is allowed, or for others.
  template <int width, class Trace>
  static void for_each_packet(const Impl& impl, const RayWave& wave, Coherence coherence, Joining allowed, Rgb* visible,
                              const Trace& trace) {
    Query apart(impl, Coherence::incoherent, visible), together(impl, Coherence::coherent, visible);
    const size_t n = wave.size();
    for (size_t first = 0; first < n; first += width) {
      const int rays = int(std::min(size_t(width), n - first));
      alignas(64) int valid[width];
      const uint32_t lanes = choose_lanes<width>(impl, wave, first, rays, valid);
      const bool joined = width > 1 && allowed != Joining::none &&
                          (coherence == Coherence::coherent || run_together<width>(wave, first, lanes)) &&
                          (allowed == Joining::any || are_of_one_octant<width>(wave, first, lanes));
      trace(joined ? together : apart, first, rays, valid);
    }
  }

  /// What was hit, as the scene numbers it: for all lanes at once, but for shapes one by one.
  template <int width>
  [[gnu::flatten]] static void store_ids(const Impl& impl, const typename embree::Packets<width>::RayHit& packet,
                                         size_t first, HitWave& hits) {
    using U = LanesOf<uint32_t, width>;
    constexpr auto anywhere = std::experimental::element_aligned;
    const U instance(packet.hit.instID[0], anywhere), geometry(packet.hit.geomID, anywhere),
        primitive(packet.hit.primID, anywhere), none(RTC_INVALID_GEOMETRY_ID);
    const auto hit = geometry != none;
    const auto placed = instance != none;
    const U entry = select(hit, select(placed, instance, geometry), U(0));
    const auto grouped = (entry & U(kInGroup)) != U(0);
    const U known = select(grouped, U(0), entry);
    const U object =
        select(grouped, entry & U(~kInGroup), gather<U>(impl.object_of_top.data(), convert<IntOf<U>>(known)));
    select(hit, object, none).copy_to(&hits.object[first], anywhere);
    select(placed, geometry, gather<U>(impl.part_of_top.data(), convert<IntOf<U>>(known)))
        .copy_to(&hits.part[first], anywhere);
    primitive.copy_to(&hits.primitive[first], anywhere);
    for_each_bit(lane_bits(hit && object == none), [&](unsigned i) {
      const Impl::Ids ids =
          impl.ids(packet.hit.instID[0][i], packet.hit.geomID[i], packet.hit.primID[i], packet.hit.u[i]);
      const size_t k = first + i;
      hits.object[k] = ids.object, hits.part[k] = ids.part, hits.primitive[k] = ids.primitive;
    });
  }

  template <int width>
  static void intersect_packets(const Impl& impl, const RayWave& wave, Coherence coherence, HitWave& hits) {
    for_each_packet<width>(
        impl, wave, coherence, Joining::any, nullptr, [&](Query& query, size_t first, int, int* valid) {
          alignas(64) typename embree::Packets<width>::RayHit packet;
          for (int i = 0; i < width; ++i) packet.hit.geomID[i] = packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
          load_rays(wave, first, width, packet.ray);
          for (RTCScene scene : impl.scenes)
            if (scene) embree::intersect<width>(valid, scene, query, packet);
          constexpr size_t kBytes = size_t(width) * sizeof(float);
          std::memcpy(&hits.t[first], packet.ray.tfar, kBytes);
          std::memcpy(&hits.u[first], packet.hit.u, kBytes), std::memcpy(&hits.v[first], packet.hit.v, kBytes);
          store_ids<width>(impl, packet, first, hits);
        });
  }

  /// Coherent occlusion may show a callback the same surface twice, once for each octant of directions in the packet,
  /// so that filters would count it twice.
  static Joining occlusion_joining(const Impl& impl, int width) {
    if (width == 16 && impl.coherent_occluded_16_hangs()) return Joining::none;
    return impl.has_filters ? Joining::one_octant : Joining::any;
  }

  template <int width>
  static void occlude_packets(const Impl& impl, const RayWave& wave, Coherence coherence, Lanes<Rgb>& visible) {
    for_each_packet<width>(
        impl, wave, coherence, occlusion_joining(impl, width), visible.data(),
        [&](Query& query, size_t first, int rays, int* valid) {
          alignas(64) typename embree::Packets<width>::Ray packet;
          load_rays(wave, first, width, packet);
          for (RTCScene scene : impl.scenes)  // what is blocked in the first is not looked at in the second
            if (scene) embree::occluded<width>(valid, scene, query, packet);
          for (int i = 0; i < rays; ++i)
            if (packet.tfar[i] < 0) visible[first + size_t(i)] = Rgb(0.0f);
        });
  }

  /// The calls without their preparations.
  template <int width>
  static double seconds_of(const Impl& impl, const BareCall& call, const RayWave& wave) {
    struct alignas(64) Packet {
      typename embree::Packets<width>::RayHit rays;
      int valid[width];
      bool joined;
    };
    Lanes<Rgb> visible;
    visible.resize(wave.size());
    for (size_t i = 0; i < wave.size(); ++i) visible[i] = Rgb(1.0f);
    static thread_local std::vector<Packet> packets;
    packets.resize((wave.size() + width - 1) / width);
    const Joining joining = call.shadow ? occlusion_joining(impl, width) : Joining::any;
    for (size_t k = 0; k < packets.size(); ++k) {
      Packet& packet = packets[k];
      const size_t first = k * width;
      const int rays = int(std::min(size_t(width), wave.size() - first));
      const uint32_t lanes = choose_lanes<width>(impl, wave, first, rays, packet.valid);
      packet.joined = call.coherence == Coherence::coherent &&
                      (joining == Joining::any || are_of_one_octant<width>(wave, first, lanes));
      for (int i = 0; i < width; ++i)
        packet.rays.hit.geomID[i] = packet.rays.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
      load_rays(wave, first, width, packet.rays.ray);
    }
    Query apart(impl, Coherence::incoherent, visible.data()), together(impl, Coherence::coherent, visible.data());
    const auto intersect = [&](Packet& packet) {
      for (RTCScene scene : impl.scenes)
        if (scene) embree::intersect<width>(packet.valid, scene, packet.joined ? together : apart, packet.rays);
    };
    const auto occlude = [&](Packet& packet) {
      for (RTCScene scene : impl.scenes)
        if (scene) embree::occluded<width>(packet.valid, scene, packet.joined ? together : apart, packet.rays.ray);
    };
    const auto start = std::chrono::steady_clock::now();
    if (call.shadow)
      for (Packet& packet : packets) occlude(packet);
    else
      for (Packet& packet : packets) intersect(packet);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  /// Embree's report of memory that it takes (or gives back).
  static bool count_bytes(void* impl, ssize_t bytes, bool) {
    static_cast<Impl*>(impl)->bytes += uint64_t(bytes);
    return true;
  }

  static RTCScene new_scene(const Impl& impl, const BuildOptions& options) {
    RTCScene scene = rtcNewScene(impl.device);
    const unsigned robust = options.robust ? RTC_SCENE_FLAG_ROBUST : 0,
                   compact = options.compact ? RTC_SCENE_FLAG_COMPACT : 0;
    rtcSetSceneFlags(scene, RTCSceneFlags(robust | compact));
    rtcSetSceneBuildQuality(scene, embree_quality(options.quality));
    return scene;
  }

  /// Vertices of the pose `step`, in place where Embree can read them there.
  static void set_vertices(RTCGeometry g, unsigned step, const std::vector<Vec3f>& positions) {
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

  static RTCGeometry new_embree_triangles(Impl& impl, const TriangleMesh& part, uint32_t part_index,
                                          const Track<MeshPose>* track, Opacity opacity) {
    RTCGeometry g = embree::new_geometry(impl.device, RTC_GEOMETRY_TYPE_TRIANGLE);
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
  static void set_quality(const Impl& impl, RTCGeometry g) {
    if (impl.options.quality != BuildQuality::fast) return;
    rtcSetGeometryBuildQuality(g, embree_quality(BuildQuality::fast));
    rtcCommitGeometry(g);
  }

  /// Part `part_index` of the mesh as geometry `id` of the scene; `object`: where the part is not instanced.
  static void attach_part(Impl& impl, RTCScene scene, uint32_t id, const Mesh& mesh, const Track<MeshPose>* track,
                          uint32_t part_index, uint32_t object, bool watertight) {
    const TriangleMesh& part = mesh.parts[part_index];
    const Opacity opacity = impl.filter.opacity.empty() ? Opacity::opaque : impl.filter.opacity[part.material];
    RTCGeometry g;
    if (watertight) {
      impl.triangle_groups.push_back(
          std::make_unique<TriangleGroup>(TriangleGroup{part, part_index, object, opacity, impl.filter, track}));
      g = new_triangle_geometry(impl.device, *impl.triangle_groups.back());
    } else {
      g = new_embree_triangles(impl, part, part_index, track, opacity);
    }
    set_quality(impl, g);
    rtcAttachGeometryByID(scene, g, id);
    rtcReleaseGeometry(g);
  }

  static void set_transform(RTCGeometry g, unsigned step, const Affine3d& m) {
    const float columns[12] = {float(m.x.x), float(m.x.y),      float(m.x.z),      float(m.y.x),
                               float(m.y.y), float(m.y.z),      float(m.z.x),      float(m.z.y),
                               float(m.z.z), float(m.origin.x), float(m.origin.y), float(m.origin.z)};
    rtcSetGeometryTransform(g, step, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
  }

  /// `track`: of the instance, null where it stands still at `m`.
  static RTCGeometry new_instance(const Impl& impl, RTCScene mesh, const Affine3d& m, const Track<Affine3d>* track) {
    RTCGeometry g = embree::new_geometry(impl.device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(g, mesh);
    if (track) rtcSetGeometryTimeStepCount(g, unsigned(track->size()));
    for (unsigned step = 0; step < (track ? track->size() : 1); ++step)
      set_transform(g, step, track ? (*track)[step] : m);
    rtcCommitGeometry(g);
    return g;
  }

  /// As the next of the top level's geometries.
  static void attach(Impl& impl, RTCScene scene, RTCGeometry g, const TopEntry& entry) {
    set_quality(impl, g);
    rtcAttachGeometryByID(scene, g, unsigned(impl.top.size()));
    rtcReleaseGeometry(g);
    impl.top.push_back(entry);
  }

  static bool is_set(std::span<const char> flags, size_t i) { return i < flags.size() && flags[i] != 0; }

  static RTCScene mesh_scene(Impl& impl, uint32_t index) {
    RTCScene& shared = impl.mesh_scenes[index];
    if (shared) return shared;
    const Mesh& mesh = impl.geometry->meshes[index];
    shared = new_scene(impl, impl.options);
    for (uint32_t part = 0; part < mesh.parts.size(); ++part)
      if (!mesh.parts[part].triangles.empty())
        attach_part(impl, shared, part, mesh, track_of_mesh(*impl.geometry, index), part, kNone,
                    impl.options.watertight);
    rtcCommitScene(shared);
    return shared;
  }

  /// The parts of a mesh that is placed once, in world space.
  static void attach_baked(Impl& impl, RTCScene scene, uint32_t object) {
    const uint32_t index = impl.geometry->mesh_instances.mesh_of(object);
    const Mesh& mesh = impl.geometry->meshes[index];
    for (uint32_t part = 0; part < mesh.parts.size(); ++part) {
      if (mesh.parts[part].triangles.empty()) continue;
      attach_part(impl, scene, uint32_t(impl.top.size()), mesh, track_of_mesh(*impl.geometry, index), part, object,
                  impl.options.watertight);
      impl.top.push_back({TopEntry::Kind::baked_part, object, part});
    }
  }

  /// The instance, with those after it that go into one group with it: how many these are.
  static uint32_t attach_instances(Impl& impl, RTCScene scene, uint32_t object) {
    const Geometry& geometry = *impl.geometry;
    const MeshInstance instance = geometry.mesh_instances[object];
    const Track<Affine3d>* const places = track_of_object(geometry, object);
    const RTCScene mesh = mesh_scene(impl, instance.mesh);
    impl.has_instances = true;
    // Of a mesh that also deforms, Embree bounds the two motions one by one; their product reaches further.
    const float reach = !places                                  ? reach_around_instance(instance.world_from_object)
                        : track_of_mesh(geometry, instance.mesh) ? 0
                                                                 : reach_around_instance(*places);
    const uint32_t alike = group_size(geometry, object), count = alike >= kLeastInstanceGroup ? alike : 1;
    if (count > 1 || reach == 0) {
      impl.instance_groups.push_back(
          std::make_unique<InstanceGroup>(InstanceGroup{&geometry.mesh_instances, object, count, mesh, places, {}}));
      attach(impl, scene, new_instance_geometry(impl.device, *impl.instance_groups.back()),
             {TopEntry::Kind::instances, object, 0});
    } else {
      impl.reach = std::min(impl.reach, reach);
      attach(impl, scene, new_instance(impl, mesh, instance.world_from_object, places),
             {TopEntry::Kind::instance, object, 0});
    }
    return count;
  }

  static bool is_baked(const Impl& impl, uint32_t object) {
    const MeshInstances& placed = impl.geometry->mesh_instances;
    return impl.uses[placed.mesh_of(object)] == 1 && placed.world_from_object(object) == Affine3d{} &&
           !track_of_object(*impl.geometry, object);
  }

  using OwnedScene = std::unique_ptr<std::remove_pointer_t<RTCScene>, decltype([](RTCScene s) { rtcReleaseScene(s); })>;

  /// A scene of what stands still, or of what moves from frame to frame; null where there is nothing.
  static RTCScene build(Impl& impl, bool moving) {
    const Geometry& geometry = *impl.geometry;
    const size_t first = impl.top.size();
    OwnedScene owned(new_scene(impl, impl.options));
    const RTCScene scene = owned.get();
    for (uint32_t object = 0; object < geometry.mesh_instances.size();) {
      if (is_set(impl.options.moving.meshes, geometry.mesh_instances.mesh_of(object)) != moving)
        ++object;
      else if (is_baked(impl, object))
        attach_baked(impl, scene, object++);
      else
        object += attach_instances(impl, scene, object);
    }
    const auto wanted = [&](const ShapeInstance& shape) {
      return is_set(impl.options.moving.nodes, shape.node) == moving;
    };
    for (auto& group : group_shapes(geometry, impl.filter, wanted)) {
      attach(impl, scene, new_shape_geometry(impl.device, *group),
             {TopEntry::Kind::shapes, kNone, uint32_t(impl.shape_groups.size())});
      impl.shape_groups.push_back(std::move(group));
    }
    if (moving || impl.options.moving.nodes.empty()) attach_blurred_shapes(impl, scene);
    if (impl.top.size() == first) return nullptr;
    rtcCommitScene(scene);
    return owned.release();
  }

  static void attach_blurred_shapes(Impl& impl, RTCScene scene) {
    impl.moving_shapes = moving_shapes(*impl.geometry, impl.filter);
    for (uint32_t k = 0; k < impl.moving_shapes.size(); ++k)
      attach(impl, scene, new_moving_geometry(impl.device, *impl.moving_shapes[k]),
             {TopEntry::Kind::moving_shapes, kNone, k});
  }

  /// Of those that move: their scenes stay when their places change.
  static void build_rigid_meshes(Impl& impl) {
    const MovingParts& moving = impl.options.moving;
    for (uint32_t object = 0; object < impl.geometry->mesh_instances.size(); ++object) {
      const uint32_t mesh = impl.geometry->mesh_instances.mesh_of(object);
      if (is_set(moving.meshes, mesh) && !is_set(moving.deforming, mesh)) (void)mesh_scene(impl, mesh);
    }
  }

  static void build_moving(Impl& impl) {
    impl.scenes[1] =
        impl.options.moving.meshes.empty() && impl.options.moving.nodes.empty() ? nullptr : build(impl, true);
    impl.object_of_top.assign(impl.top.size() + 1, kNone), impl.part_of_top.assign(impl.top.size() + 1, 0);
    for (size_t i = 0; i < impl.top.size(); ++i)
      impl.object_of_top[i] = impl.top[i].object, impl.part_of_top[i] = impl.top[i].part;
    if (const RTCError error = rtcGetDeviceError(impl.device); error != RTC_ERROR_NONE)
      throw Error("building the hierarchy: Embree error " + std::to_string(int(error)), ExitStatus::internal);
  }

  /// Leaves what stands still.
  static void forget_moving(Impl& impl) {
    if (impl.scenes[1]) rtcReleaseScene(std::exchange(impl.scenes[1], nullptr));
    for (size_t i = 0; i < impl.mesh_scenes.size(); ++i)
      if (is_set(impl.options.moving.deforming, i) && impl.mesh_scenes[i])
        rtcReleaseScene(std::exchange(impl.mesh_scenes[i], nullptr));
    impl.top.resize(impl.standing.top), impl.shape_groups.resize(impl.standing.shape_groups);
    impl.instance_groups.resize(impl.standing.instance_groups);
    impl.triangle_groups.resize(impl.standing.triangle_groups);
    impl.has_instances = impl.standing.has_instances, impl.reach = impl.standing.reach;
  }

  /// The lists that stand in place of those that were read.
  static void find_instances_again(Impl& impl) {
    for (auto& group : impl.shape_groups) alhazen::find_instances_again(*impl.geometry, *group);
  }
};

namespace {

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

/// Whether rays that run apart are faster one by one: where most primitives are shapes, and many. A packet would then
/// call each shape for a lane or two. Triangles are faster in packets all the same.
bool prefers_single_rays(const Geometry& geometry) {
  constexpr size_t kManyShapes = 3000;
  size_t triangles = 0;
  const std::vector<uint32_t> uses = uses_of_meshes(geometry);
  for (size_t i = 0; i < uses.size(); ++i)
    for (const TriangleMesh& part : geometry.meshes[i].parts) triangles += uses[i] * part.triangles.size();
  return geometry.shape_instances.size() > std::max(triangles, kManyShapes);
}

}  // namespace

AcceleratedScene::AcceleratedScene(const Geometry& geometry, const SurfaceFilter& filter, const BuildOptions& options)
    : impl_(std::make_unique<Impl>()) {
  Impl& impl = *impl_;
  impl.filter = filter;
  impl.has_filters =
      std::any_of(filter.opacity.begin(), filter.opacity.end(), [](Opacity o) { return o != Opacity::opaque; });
  const std::string config = options.threads > 0 ? "threads=" + std::to_string(options.threads) : "";
  impl.device = rtcNewDevice(config.c_str());
  if (!impl.device) throw Error("Embree has no device for this CPU", ExitStatus::internal);
  rtcSetDeviceMemoryMonitorFunction(impl.device, Traversal::count_bytes, &impl);
  impl.width = embree::packet_width(impl.device);
  impl.incoherent_width = prefers_single_rays(geometry) ? 1 : impl.width;
  impl.geometry = &geometry, impl.options = options;
  impl.mesh_scenes.assign(geometry.meshes.size(), nullptr);
  impl.uses = uses_of_meshes(geometry);
  impl.opacity.assign(filter.opacity.begin(), filter.opacity.end());
  if (!options.moving.nodes.empty()) impl.identities = identities(geometry);

  impl.scenes[0] = Traversal::build(impl, false);
  Traversal::build_rigid_meshes(impl);
  impl.standing = {impl.top.size(),
                   impl.shape_groups.size(),
                   impl.instance_groups.size(),
                   impl.triangle_groups.size(),
                   impl.has_instances,
                   impl.reach};
  Traversal::build_moving(impl);
}

bool AcceleratedScene::update(const SurfaceFilter& filter) {
  Impl& impl = *impl_;
  if (impl.options.moving.nodes.empty()) return true;
  if (identities(*impl.geometry) != impl.identities || !std::ranges::equal(filter.opacity, impl.opacity)) return false;
  impl.filter = filter;
  Traversal::forget_moving(impl);
  Traversal::find_instances_again(impl);
  Traversal::build_moving(impl);
  return true;
}

AcceleratedScene::~AcceleratedScene() = default;

void AcceleratedScene::intersect(const RayWave& rays_world, Coherence coherence, HitWave& hits) const noexcept {
  hits.resize(rays_world.size());
  with_width(coherence == Coherence::coherent ? impl_->width : impl_->incoherent_width,
             [&](auto width) { Traversal::intersect_packets<width>(*impl_, rays_world, coherence, hits); });
}

void AcceleratedScene::transmittance(const RayWave& rays_world, Coherence coherence,
                                     Lanes<Rgb>& visible) const noexcept {
  visible.resize(rays_world.size());
  for (size_t i = 0; i < rays_world.size(); ++i) visible[i] = Rgb(1.0f);
  with_width(coherence == Coherence::coherent ? impl_->width : impl_->incoherent_width,
             [&](auto width) { Traversal::occlude_packets<width>(*impl_, rays_world, coherence, visible); });
}

int AcceleratedScene::packet_width() const noexcept { return impl_->width; }

uint64_t AcceleratedScene::bytes() const noexcept { return impl_->bytes; }

bool AcceleratedScene::allows(const BareCall& call) const noexcept {
  if (call.width > impl_->width) return false;
  return !call.shadow || call.coherence == Coherence::incoherent ||
         Traversal::occlusion_joining(*impl_, call.width) != Traversal::Joining::none;
}

double AcceleratedScene::seconds_of(const BareCall& call, const RayWave& rays_world) const {
  return with_width(unsigned(call.width),
                    [&](auto width) { return Traversal::seconds_of<width>(*impl_, call, rays_world); });
}

std::string traversal_version() {
  RTCDevice device = rtcNewDevice(nullptr);
  const int width = device ? embree::packet_width(device) : 0;
  if (device) rtcReleaseDevice(device);
  return std::string("Embree ") + RTC_VERSION_STRING + ", " + std::to_string(width) + " lanes";
}

}  // namespace alhazen
