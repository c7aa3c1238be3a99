#include "accel/instance_clusters.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "accel/traversal_bounds.h"
#include "core/fork_join.h"

namespace alhazen {
namespace {

constexpr uint32_t kMost = InstanceCluster::kMost;

struct Item {
  Vec3f center;
  uint32_t object;
};

Vec3f center_of(const Bounds3f& box) { return box.lower + (box.upper - box.lower) * 0.5f; }

/// Orders the items so that each kMost of them, from the first on, are near each other: halved again and again at a
/// multiple of kMost, across where their centres spread most.
void order_by_place(std::span<Item> items) {
  constexpr size_t kWorthATask = 4096;
  if (items.size() <= kMost) return;
  Bounds3f spread;
  for (const Item& item : items) extend(spread, item.center);
  const Vec3f extent = spread.upper - spread.lower;
  float Vec3f::*const axis = extent.x >= extent.y && extent.x >= extent.z ? &Vec3f::x
                             : extent.y >= extent.z                       ? &Vec3f::y
                                                                          : &Vec3f::z;
  const size_t half = (items.size() / 2 + kMost - 1) / kMost * kMost;
  std::nth_element(items.begin(), items.begin() + ptrdiff_t(half), items.end(), [axis](const Item& a, const Item& b) {
    return a.center.*axis != b.center.*axis ? a.center.*axis < b.center.*axis : a.object < b.object;
  });
  const auto below = items.first(half), above = items.subspan(half);
  if (items.size() < kWorthATask) return order_by_place(below), order_by_place(above);
  const ForkJoin order;
  tbb::parallel_invoke(order.task([below] { order_by_place(below); }), order.task([above] { order_by_place(above); }));
}

/// Of a lattice of 256 points from `lower` on, the last of which is not below `upper`.
float lattice_step(float lower, float upper) {
  float step = (upper - lower) / 255;
  while (lower + step * 255 < upper) step = std::nextafter(step * (1 + 0x1p-8f), HUGE_VALF);
  return step;
}

uint8_t last_not_above(float x, float lower, float step) {
  int k = step > 0 ? int(std::min((x - lower) / step, 255.0f)) : 0;
  while (k > 0 && lower + step * float(k) > x) --k;
  return uint8_t(k);
}

uint8_t first_not_below(float x, float lower, float step) {
  int k = last_not_above(x, lower, step);
  while (k < 255 && lower + step * float(k) < x) ++k;
  return uint8_t(k);
}

InstanceCluster cluster_of(std::span<const Item> items, const MeshInstances& placed, const Bounds3d& object_box) {
  InstanceCluster cluster;
  std::array<Bounds3f, kMost> boxes;
  for (const Item& item : items) {
    Bounds3f& box = boxes[cluster.count];
    box = instance_box(placed.world_from_object(item.object), object_box);
    extend(cluster.box, box);
    cluster.objects[cluster.count++] = item.object;
  }
  constexpr float Vec3f::*kAxes[] = {&Vec3f::x, &Vec3f::y, &Vec3f::z};
  for (size_t a = 0; a < 3; ++a) {
    const auto axis = kAxes[a];
    const float lower = cluster.box.lower.*axis, step = lattice_step(lower, cluster.box.upper.*axis);
    cluster.step.*axis = step;
    for (uint32_t k = 0; k < cluster.count; ++k) {
      cluster.lower[a][k] = last_not_above(boxes[k].lower.*axis, lower, step);
      cluster.upper[a][k] = first_not_below(boxes[k].upper.*axis, lower, step);
    }
  }
  return cluster;
}

}  // namespace

Bounds3f instance_box(const Affine3d& m, const Bounds3d& object_box) {
  constexpr float kLargestCoordinate = 1.844e18f;  // beyond it, Embree drops primitives without a word
  const Bounds3d world = transform_bounds(m, object_box);
  const Vec3d reach = max(abs(object_box.lower), abs(object_box.upper));
  const Vec3d margin = (abs(m.x) * reach.x + abs(m.y) * reach.y + abs(m.z) * reach.z + abs(m.origin)) * 0x1p-20;
  const Bounds3f box = traversal_bounds({world.lower - margin, world.upper + margin});
  return max_component(max(abs(box.lower), abs(box.upper))) < kLargestCoordinate ? box : Bounds3f{};
}

std::vector<InstanceCluster> cluster_instances(const MeshInstances& placed, uint32_t first_object, uint32_t count,
                                               const Bounds3d& object_box) {
  const ForkJoin order;
  std::vector<Item> items(count);
  tbb::parallel_for(uint32_t{0}, count, order.task([&](uint32_t k) {
    const Bounds3f box = instance_box(placed.world_from_object(first_object + k), object_box);
    items[k] = {center_of(box), is_empty(box) ? kNone : first_object + k};
  }));
  std::erase_if(items, [](const Item& item) { return item.object == kNone; });
  order_by_place(items);
  std::vector<InstanceCluster> clusters((items.size() + kMost - 1) / kMost);
  tbb::parallel_for(size_t{0}, clusters.size(), order.task([&](size_t k) {
    const size_t first = k * kMost;
    clusters[k] =
        cluster_of(std::span(items).subspan(first, std::min<size_t>(kMost, items.size() - first)), placed, object_box);
  }));
  return clusters;
}

}  // namespace alhazen
