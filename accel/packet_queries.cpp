// AcceleratedScene's queries: waves laid out as Embree's packets, and its answers as the scene numbers things.
#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cstring>
#include <vector>

#include "accel/built_scene.h"
#include "accel/packet.h"
#include "accel/ray_rows.h"
#include "accel/wave_query.h"
#include "core/lane_memory.h"

namespace alhazen {
namespace {

/// A packet traced as one goes down once for each octant of directions in it: with up to so many, faster than as rays
/// that have nothing to do with one another.
constexpr int kFewOctants = 3;

/// Of directions in a packet that is traced as one, though it be around an axis, where more octants meet.
constexpr float kLeastCosine = 0.9f;

/// Packets that call shapes for fewer lanes than this, on average, are slower than rays one by one. What the first
/// calls of a wave say holds for the rest of it.
constexpr uint64_t kLeastLanesPerCall = 2, kTellingCalls = 32;

struct SceneQuery : WaveQuery {
  const BuiltScene& built;

  SceneQuery(const BuiltScene& scene, Coherence rays, Rgb* visible_by_ray)
      : WaveQuery(rays, visible_by_ray, scene.top.object.data()), built(scene) {}

  /// Whether its packets' rays meet different shapes.
  [[nodiscard]] bool meets_few_lanes() const {
    return shape_calls >= kTellingCalls && shape_lanes < kLeastLanesPerCall * shape_calls;
  }
};

Crossing crossing_of(const RTCFilterFunctionNArguments* args, const BuiltScene& built, unsigned lane) {
  const uint32_t instance = RTCHitN_instID(args->hit, args->N, lane, 0),
                 geometry = RTCHitN_geomID(args->hit, args->N, lane),
                 primitive = RTCHitN_primID(args->hit, args->N, lane);
  const float u = RTCHitN_u(args->hit, args->N, lane), v = RTCHitN_v(args->hit, args->N, lane);
  if (instance == RTC_INVALID_GEOMETRY_ID)
    return {built.top.object[geometry], built.top.part[geometry], primitive, u, v, {}};
  return {instance & kInGroup ? instance & ~kInGroup : built.top.object[instance], geometry, primitive, u, v, {}};
}

template <int width, class RayHit>
void forget_hits(RayHit& packet) {
  const LanesOf<uint32_t, width> none(RTC_INVALID_GEOMETRY_ID);
  none.copy_to(packet.hit.geomID, std::experimental::element_aligned);
  none.copy_to(packet.hit.instID[0], std::experimental::element_aligned);
}

/// The lanes that hold rays that traversal can take, and -1 for each in `valid`, else 0: those out of reach, and
/// those that are not numbers, hit nothing.
template <int width>
uint32_t choose_lanes(const BuiltScene& built, const RayWave& wave, size_t first, int lanes, int* valid) {
  const auto within = [&](const Vec3Lanes& v) {
    const auto below = [&](const Lanes<float>& row) {
      return absolute(FloatLanes<width>(&row[first], std::experimental::element_aligned)) < built.reach;
    };
    return below(v.x) && below(v.y) && below(v.z);
  };
  const uint32_t bits = lane_bits(within(wave.origin) && within(wave.direction)) & ((1u << lanes) - 1);
  for (int i = 0; i < width; ++i) valid[i] = -int(bits >> i & 1);
  return bits;
}

/// The components of a packet's directions.
template <int width>
Vec3<FloatLanes<width>> directions_of(const RayWave& wave, size_t first) {
  const auto load = [&](const Lanes<float>& row) {
    return FloatLanes<width>(&row[first], std::experimental::element_aligned);
  };
  return {load(wave.direction.x), load(wave.direction.y), load(wave.direction.z)};
}

/// In how many octants the directions of a packet's lanes lie.
template <int width>
int count_octants(const Vec3<FloatLanes<width>>& direction, uint32_t lanes) {
  const FloatLanes<width> zero(0);
  const std::array negative{lane_bits(direction.x < zero), lane_bits(direction.y < zero),
                            lane_bits(direction.z < zero)};
  int octants = 0;
  for (; lanes != 0; ++octants) {
    const int lead = std::countr_zero(lanes);
    uint32_t alike = lanes;
    for (const uint32_t bits : negative) alike &= bits >> lead & 1 ? bits : ~bits;
    lanes &= ~alike;
  }
  return octants;
}

/// Whether directions lie in a narrow cone around the first.
template <int width>
bool are_alike(const Vec3<FloatLanes<width>>& direction, uint32_t lanes) {
  using F = FloatLanes<width>;
  const auto lead = size_t(std::countr_zero(lanes));
  const F squared = dot(direction, direction);
  const F along = dot(direction, Vec3<F>{F(direction.x[lead]), F(direction.y[lead]), F(direction.z[lead])});
  const auto apart = along < 0 || along * along < squared * F(kLeastCosine * kLeastCosine * squared[lead]);
  return (lane_bits(apart) & lanes) == 0;
}

/// Whether a packet's rays run side by side, so that they meet mostly the same nodes.
template <int width>
bool run_together(const RayWave& wave, size_t first, uint32_t lanes) {
  const auto direction = directions_of<width>(wave, first);
  return lanes != 0 && (count_octants<width>(direction, lanes) <= kFewOctants || are_alike<width>(direction, lanes));
}

template <int width>
bool are_of_one_octant(const RayWave& wave, size_t first, uint32_t lanes) {
  return count_octants<width>(directions_of<width>(wave, first), lanes) <= 1;
}

/// Which packets may be traced as one.
enum class Joining : uint8_t { none, one_octant, any };

/// Of shadow rays. A coherent query may show a callback the same surface twice, once for each octant of directions in
/// the packet, so that filters would count it twice. On compact scenes it hangs as well as on those with instances.
Joining allowed_occlusion(const BuiltScene& built, int width) {
  const bool may_hang = embree::kCoherentOccluded16HangsOnInstances && (built.has_instances || built.options.compact);
  if (width == 16 && may_hang) return Joining::none;
  return built.has_filters ? Joining::one_octant : Joining::any;
}

/// Shapes are asked for all lanes at once anyway; joined packets, which do not stop at what blocks some of their rays,
/// ask more of them.
Joining best_occlusion(const BuiltScene& built, int width) {
  return built.mostly_shapes ? Joining::none : allowed_occlusion(built, width);
}

/// Traces the wave packet by packet, each by the query that suits it: for rays that run together, as far as that is
/// allowed, or for others; or ray by ray where packets of this wave meet shapes with few of their lanes.
template <int width, class Tracer>
void trace_packets(const BuiltScene& built, const RayWave& wave, Coherence coherence, Joining allowed, Rgb* visible,
                   const Tracer& tracer) {
  SceneQuery apart(built, Coherence::incoherent, visible), together(built, Coherence::coherent, visible);
  const size_t n = wave.size();
  for (size_t first = 0; first < n; first += width) {
    const int rays = int(std::min(size_t(width), n - first));
    alignas(64) int valid[width];
    const uint32_t lanes = choose_lanes<width>(built, wave, first, rays, valid);
    const bool joined = allowed != Joining::none &&
                        (coherence == Coherence::coherent || run_together<width>(wave, first, lanes)) &&
                        (allowed == Joining::any || are_of_one_octant<width>(wave, first, lanes));
    if (joined || !built.mostly_shapes || !apart.meets_few_lanes())
      tracer.template trace<width>(joined ? together : apart, first, rays, valid);
    else
      for (int i = 0; i < rays; ++i) tracer.template trace<1>(apart, first + size_t(i), 1, &valid[i]);
  }
}

/// table[index] in the lanes asked for, anything in the others. Neighbours mostly ask for the same, which is broadcast:
/// a gather takes its time lane by lane.
template <class U>
U look_up(const std::vector<uint32_t>& table, const U& index, uint32_t lanes) {
  if (lanes == 0) return U(0);
  const uint32_t lead = index[size_t(std::countr_zero(lanes))];
  const bool alike = (lane_bits(index != U(lead)) & lanes) == 0;
  return alike ? U(table[lead]) : gather<U>(table.data(), convert<IntOf<U>>(index));
}

struct Intersector {
  const BuiltScene& built;
  const RayWave& wave;
  HitWave& hits;

  template <int width>
  void trace(SceneQuery& query, size_t first, int, const int* valid) const {
    alignas(64) typename embree::Packets<width>::RayHit packet;
    forget_hits<width>(packet);
    embree::load_rays(wave, first, width, packet.ray);
    for (RTCScene scene : built.scenes)
      if (scene) embree::intersect<width>(valid, scene, query, packet);
    constexpr size_t kBytes = size_t(width) * sizeof(float);
    std::memcpy(&hits.t[first], packet.ray.tfar, kBytes);
    std::memcpy(&hits.u[first], packet.hit.u, kBytes), std::memcpy(&hits.v[first], packet.hit.v, kBytes);
    store_ids<width>(packet, first);
  }

 private:
  /// What was hit, as the scene numbers it.
  template <int width>
  [[gnu::flatten]] void store_ids(const typename embree::Packets<width>::RayHit& packet, size_t first) const {
    using F = FloatLanes<width>;
    using U = LanesOf<uint32_t, width>;
    constexpr auto anywhere = std::experimental::element_aligned;
    const U instance(packet.hit.instID[0], anywhere), geometry(packet.hit.geomID, anywhere),
        primitive(packet.hit.primID, anywhere), none(RTC_INVALID_GEOMETRY_ID);
    const auto hit = geometry != none, placed = instance != none;
    const U number = select(hit, select(placed, instance, geometry), U(0));
    const auto grouped = (number & U(kInGroup)) != U(0);
    const U known = select(grouped, U(0), number);
    const auto of_hit = [&](const std::vector<uint32_t>& table) { return look_up(table, known, lane_bits(hit)); };
    const U object = select(grouped, number & U(~kInGroup), of_hit(built.top.object)),
            part = select(placed, geometry, of_hit(built.top.part));
    const auto on_shape = hit && object == none;
    if (!any_of(on_shape)) return store_lanes(select(hit, object, none), part, primitive, first);
    // A shape's face, which takes the place of the part, is in its u.
    const U shape = select(on_shape, of_hit(built.top.first_shape) + primitive, U(0)),
            face = convert<U>(convert<IntOf<U>>(select(convert_mask<F>(on_shape), F(packet.hit.u, anywhere), F(0))));
    store_lanes(
        select(on_shape, look_up(built.top.object_of_shape, shape, lane_bits(on_shape)), select(hit, object, none)),
        select(on_shape, face, part), select(on_shape, U(0), primitive), first);
  }

  template <class U>
  void store_lanes(const U& object, const U& part, const U& primitive, size_t first) const {
    constexpr auto anywhere = std::experimental::element_aligned;
    object.copy_to(&hits.object[first], anywhere), part.copy_to(&hits.part[first], anywhere);
    primitive.copy_to(&hits.primitive[first], anywhere);
  }
};

struct Occluder {
  const BuiltScene& built;
  const RayWave& wave;
  Lanes<Rgb>& visible;

  template <int width>
  void trace(SceneQuery& query, size_t first, int rays, const int* valid) const {
    alignas(64) typename embree::Packets<width>::Ray packet;
    embree::load_rays(wave, first, width, packet);
    for (RTCScene scene : built.scenes)  // what is blocked in the first is not looked at in the second
      if (scene) embree::occluded<width>(valid, scene, query, packet);
    const FloatLanes<width> t_max(packet.tfar, std::experimental::element_aligned);
    const uint32_t blocked = lane_bits(t_max < 0) & ((1u << rays) - 1);
    for_each_bit(blocked, [&](unsigned i) { visible[first + i] = Rgb(0.0f); });
  }
};

/// The calls without their preparations.
template <int width>
double seconds_by(const BuiltScene& built, const BareCall& call, const RayWave& wave) {
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
  const Joining joining = call.shadow ? allowed_occlusion(built, width) : Joining::any;
  for (size_t k = 0; k < packets.size(); ++k) {
    Packet& packet = packets[k];
    const size_t first = k * width;
    const int rays = int(std::min(size_t(width), wave.size() - first));
    const uint32_t lanes = choose_lanes<width>(built, wave, first, rays, packet.valid);
    packet.joined = call.coherence == Coherence::coherent &&
                    (joining == Joining::any || are_of_one_octant<width>(wave, first, lanes));
    forget_hits<width>(packet.rays);
    embree::load_rays(wave, first, width, packet.rays.ray);
  }
  SceneQuery apart(built, Coherence::incoherent, visible.data()), together(built, Coherence::coherent, visible.data());
  const auto intersect = [&](Packet& packet) {
    for (RTCScene scene : built.scenes)
      if (scene) embree::intersect<width>(packet.valid, scene, packet.joined ? together : apart, packet.rays);
  };
  const auto occlude = [&](Packet& packet) {
    for (RTCScene scene : built.scenes)
      if (scene) embree::occluded<width>(packet.valid, scene, packet.joined ? together : apart, packet.rays.ray);
  };
  const auto start = std::chrono::steady_clock::now();
  if (call.shadow)
    for (Packet& packet : packets) occlude(packet);
  else
    for (Packet& packet : packets) intersect(packet);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

/// Triangles with holes: refuse the hits that fall into one.
void leave_out_holes(const RTCFilterFunctionNArguments* args) {
  const BuiltScene& built = embree::query_of<SceneQuery>(args).built;
  for (unsigned i = 0; i < args->N; ++i)
    if (args->valid[i] && !built.filter.is_present(built.filter.data, crossing_of(args, built, i))) args->valid[i] = 0;
}

/// Triangles that let light through: refuse the hit, keep the product, until nothing is left.
void attenuate(const RTCFilterFunctionNArguments* args) {
  const SceneQuery& query = embree::query_of<SceneQuery>(args);
  const SurfaceFilter& filter = query.built.filter;
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    Rgb& visible = query.visible[RTCRayN_id(args->ray, args->N, i)];
    visible *= filter.transmittance(filter.data, crossing_of(args, query.built, i));
    if (max_component(visible) > 0) args->valid[i] = 0;
  }
}

void AcceleratedScene::intersect(const RayWave& rays_world, Coherence coherence, HitWave& hits) const noexcept {
  hits.resize(rays_world.size());
  if (built_->top.size() == 0) return (void)std::fill_n(hits.object.data(), hits.object.size(), kNone);
  with_width(unsigned(built_->width), [&](auto width) {
    trace_packets<width>(*built_, rays_world, coherence, Joining::any, nullptr, Intersector{*built_, rays_world, hits});
  });
}

void AcceleratedScene::transmittance(const RayWave& rays_world, Coherence coherence,
                                     Lanes<Rgb>& visible) const noexcept {
  visible.resize(rays_world.size());
  for (size_t i = 0; i < rays_world.size(); ++i) visible[i] = Rgb(1.0f);
  with_width(unsigned(built_->width), [&](auto width) {
    trace_packets<width>(*built_, rays_world, coherence, best_occlusion(*built_, width), visible.data(),
                         Occluder{*built_, rays_world, visible});
  });
}

int AcceleratedScene::packet_width() const noexcept { return built_->width; }

bool AcceleratedScene::allows(const BareCall& call) const noexcept {
  if (call.width > built_->width) return false;
  return !call.shadow || call.coherence == Coherence::incoherent ||
         allowed_occlusion(*built_, call.width) != Joining::none;
}

double AcceleratedScene::seconds_of(const BareCall& call, const RayWave& rays_world) const {
  return with_width(unsigned(call.width), [&](auto width) { return seconds_by<width>(*built_, call, rays_world); });
}

}  // namespace alhazen
