// What is built of a scene: Embree's scenes, and what their numbers stand for.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <vector>

#include "accel/accelerated_scene.h"
#include "accel/embree.h"
#include "accel/instance_geometry.h"
#include "accel/moving_shapes.h"
#include "accel/shape_geometry.h"
#include "accel/triangle_geometry.h"

namespace alhazen {

/// What the numbers of top-level geometries stand for, as rows that queries gather from.
struct TopGeometries {
  std::vector<uint32_t> object;       // Geometry's number; kNone: shapes, each with a number of its own
  std::vector<uint32_t> part;         // of the object's mesh
  std::vector<uint32_t> first_shape;  // into `object_of_shape`
  std::vector<uint32_t> object_of_shape;

  [[nodiscard]] size_t size() const { return object.size(); }
  void push_part(uint32_t of_object, uint32_t part_of_mesh) {
    object.push_back(of_object), part.push_back(part_of_mesh), first_shape.push_back(0);
  }
  /// A geometry whose primitives are these shapes.
  void push_shapes(const std::vector<uint32_t>& objects) {
    object.push_back(kNone), part.push_back(0), first_shape.push_back(uint32_t(object_of_shape.size()));
    object_of_shape.insert(object_of_shape.end(), objects.begin(), objects.end());
  }
  void shrink_to(size_t geometries, size_t shapes) {
    object.resize(geometries), part.resize(geometries), first_shape.resize(geometries);
    object_of_shape.resize(shapes);
  }
};

struct BuiltScene {
  SurfaceFilter filter;
  std::vector<std::unique_ptr<ShapeGroup>> shape_groups;
  std::vector<std::unique_ptr<MovingShapes>> moving_shapes;
  std::vector<std::unique_ptr<InstanceGroup>> instance_groups;
  std::vector<std::unique_ptr<TriangleGroup>> triangle_groups;  // of ours
  TopGeometries top;
  std::vector<RTCScene> mesh_scenes;
  RTCDevice device = nullptr;
  std::array<RTCScene, 2> scenes{};  // what stands still, and what moves from frame to frame; null where there is none
  bool has_instances = false;
  float reach = embree::kReach;  // of rays' coordinates
  bool has_filters = false;      // surfaces that let some light through
  bool mostly_shapes = false;    // more of them than triangles
  int width = 4;                 // of packets
  std::atomic<uint64_t> bytes{0};

  const Geometry* geometry = nullptr;
  BuildOptions options;
  std::vector<uint32_t> uses;  // by mesh
  struct {
    size_t top, shapes, shape_groups, instance_groups, triangle_groups;
    bool has_instances;
    float reach;
  } standing{};                      // how many of the lists' elements, and what else, does not change in update()
  std::vector<uint64_t> identities;  // of objects, in their order
  std::vector<Opacity> opacity;

  ~BuiltScene() {
    for (RTCScene s : scenes)
      if (s) rtcReleaseScene(s);
    for (RTCScene s : mesh_scenes)
      if (s) rtcReleaseScene(s);
    if (device) rtcReleaseDevice(device);
  }
};

/// Embree's filters: of triangles with holes, and of those that let light through.
void leave_out_holes(const RTCFilterFunctionNArguments* args);
void attenuate(const RTCFilterFunctionNArguments* args);

}  // namespace alhazen
