#include "loaders/record_motion.h"

#include <algorithm>
#include <bit>
#include <map>

#include "accel/shape_bounds.h"
#include "renderer/moving.h"

namespace alhazen {
namespace {

constexpr double kTolerance = 0x1p-11;
constexpr size_t kFirstSteps = 8, kMostSteps = kMostPoses - 1;
constexpr uint64_t kMostBytes = uint64_t{1} << 30;

// ---- How far a pose is from what lies at `f` between two others, in what kTolerance counts ----

struct PlaceRuler {
  Bounds3d box;     // of what is placed, in its own space
  double size = 1;  // metres across in the world
  void look_at(const Track<Affine3d>&) {}

  double operator()(const Affine3d& a, const Affine3d& b, float f, const Affine3d& pose) const {
    const Affine3d m = mix(a, b, f);
    double furthest = 0;
    for (const Vec3d& corner : corners(box))
      furthest = std::max(furthest, length(transform_point(m, corner) - transform_point(pose, corner)));
    return furthest / size;
  }
};

struct MeshRuler {
  double size = 1;
  void look_at(const Track<MeshPose>&) {}

  double operator()(const MeshPose& a, const MeshPose& b, float f, const MeshPose& pose) const {
    double furthest = 0;
    for (size_t part = 0; part < a.size(); ++part)
      for (size_t i = 0; i < a[part].positions.size(); ++i) {
        const Vec3f p = mix(a[part].positions[i], b[part].positions[i], f);
        furthest = std::max(furthest, double(length(p - pose[part].positions[i])));
      }
    return furthest / size;
  }
};

/// Of two values that may both be 0.
double relative(double difference, double size) { return difference == 0 ? 0 : difference / size; }

struct LightRuler {
  double way = 0, brightness = 0;  // the longest from the first pose, the largest
  void look_at(const Track<Light>& poses) {
    for (const Light& light : poses) {
      way = std::max(way, length(light.p_world - poses[0].p_world));
      brightness = std::max(brightness, double(max_component(light.intensity)));
    }
  }

  double operator()(const Light& a, const Light& b, float f, const Light& pose) const {
    const Light light = mix(a, b, f);
    const Rgb color = light.intensity - pose.intensity;
    return std::max(
        {relative(length(light.p_world - pose.p_world), way), length(light.direction_world - pose.direction_world),
         relative(std::max({std::abs(color.r), std::abs(color.g), std::abs(color.b)}), brightness),
         relative(std::abs(double(light.range - pose.range)), double(pose.range)),
         std::abs(double(light.cos_inner - pose.cos_inner)), std::abs(double(light.cos_outer - pose.cos_outer))});
  }
};

struct CameraRuler {
  double way = 0;
  void look_at(const Track<Camera>& poses) {
    for (const Camera& camera : poses)
      way = std::max(way, length(camera.world_from_camera.origin - poses[0].world_from_camera.origin));
  }

  double operator()(const Camera& a, const Camera& b, float f, const Camera& pose) const {
    const Camera camera = mix(a, b, f);
    const Affine3d &m = camera.world_from_camera, &n = pose.world_from_camera;
    return std::max({length(m.x - n.x), length(m.y - n.y), length(m.z - n.z),
                     relative(length(m.origin - n.origin), way), std::abs(camera.yfov - pose.yfov),
                     relative(std::abs(camera.ymag - pose.ymag), pose.ymag)});
  }
};

// ---- Recording ----

/// Something's poses at even times, until fewer of them are found to be enough.
template <class T, class Ruler>
struct Recording {
  uint32_t index;  // in the scene
  Ruler apart;
  Track<T> poses{};
  bool settled = false;
};

struct ObjectRecording : Recording<Affine3d, PlaceRuler> {
  uint32_t node;
  size_t ordinal, count;  // among the node's
};
using MeshRecording = Recording<MeshPose, MeshRuler>;
using LightRecording = Recording<Light, LightRuler>;
using CameraRecording = Recording<Camera, CameraRuler>;

/// Whether what lies between every `stride`-th pose is linear.
template <class T, class Ruler>
bool suffices(const Track<T>& poses, size_t stride, const Ruler& apart) {
  for (size_t first = 0; first + stride < poses.size(); first += stride)
    for (size_t k = 1; k < stride; ++k)
      if (!(apart(poses[first], poses[first + stride], float(k) / float(stride), poses[first + k]) <= kTolerance))
        return false;
  return true;
}

/// Leaves out what poses are not needed, all where nothing moves; false where each is.
template <class T, class Ruler>
bool thin_out(Track<T>& poses, Ruler& apart) {
  apart.look_at(poses);
  const auto as_first = [&](const T& pose) { return apart(poses[0], poses[0], 0, pose) == 0; };
  if (std::all_of(poses.begin(), poses.end(), as_first)) return poses.clear(), true;
  size_t stride = poses.size() - 1;
  while (stride > 1 && !suffices(poses, stride, apart)) stride /= 2;
  if (stride == 1) return false;
  Track<T> kept;
  for (size_t k = 0; k < poses.size(); k += stride) kept.push_back(std::move(poses[k]));
  poses = std::move(kept);
  return true;
}

/// Makes room for one pose between each two.
template <class T>
void spread(Track<T>& poses) {
  Track<T> wider(2 * poses.size() - 1);
  for (size_t k = 0; k < poses.size(); ++k) wider[2 * k] = std::move(poses[k]);
  poses = std::move(wider);
}

Bounds3d box_of(const Mesh& mesh) {
  Bounds3d box;
  for (const TriangleMesh& part : mesh.parts)
    for (const Vec3f& p : part.positions) extend(box, Vec3d(p));
  return box;
}

double size_of(const Bounds3d& box) { return is_empty(box) ? 1 : length(box.upper - box.lower); }

/// A copy with the room behind it that Embree reads.
template <class T>
std::vector<T> with_room(const std::vector<T>& values) {
  std::vector<T> copy;
  copy.reserve(values.size() + 2);
  copy.insert(copy.end(), values.begin(), values.end());
  return copy;
}

MeshPose pose_of(const Mesh& mesh) {
  MeshPose pose;
  for (const TriangleMesh& part : mesh.parts)
    pose.push_back({with_room(part.positions), part.normals, part.tangents, part.polygon_normals});
  return pose;
}

bool alike(const MeshPose& a, const MeshPose& b) {
  const auto same = [](const PartPose& p, const PartPose& q) {
    return p.positions.size() == q.positions.size() && p.normals.size() == q.normals.size() &&
           p.tangents.size() == q.tangents.size() && p.polygon_normals.size() == q.polygon_normals.size();
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
}

struct NodeInstances {
  size_t first, count;
};

/// Instances come in the order of their nodes.
template <class Instances>
NodeInstances of_node(const Instances& all, uint32_t node) {
  const auto first_from = [&](uint32_t least) {
    size_t first = 0, end = all.size();
    while (first < end) {
      const size_t middle = first + (end - first) / 2;
      if (all[middle].node < least)
        first = middle + 1;
      else
        end = middle;
    }
    return first;
  };
  const size_t first = first_from(node);
  return {first, first_from(node + 1) - first};
}

class Recorder {
 public:
  Recorder(GltfFile& file, Scene& scene, double open, double shutter)
      : file_(file),
        scene_(scene),
        open_(open),
        shutter_(shutter),
        light_count_(scene.lights.size()),
        mesh_objects_(uint32_t(scene.geometry.mesh_instances.size())) {
    const Geometry& geometry = scene.geometry;
    for (uint32_t i = 0; i < geometry.meshes.size(); ++i)
      if (file.deforming_meshes()[i]) meshes_.push_back({i, {size_of(box_of(geometry.meshes[i]))}});
    list_objects(geometry.mesh_instances, 0, [&](const MeshInstance& placed) { return box_of_mesh(placed.mesh); });
    list_objects(geometry.shape_instances, geometry.mesh_instances.size(),
                 [&](const ShapeInstance& placed) { return object_bounds(geometry.shapes[placed.shape]); });
    for (uint32_t i = 0; i < scene.lights.size(); ++i) lights_.push_back({i, {}});
    for (uint32_t i = 0; i < scene.cameras.size(); ++i) cameras_.push_back({i, {}});
  }

  /// Leaves the scene at the opening, with its motion.
  void run() {
    const size_t most = most_steps();
    size_t steps = std::min(kFirstSteps, most);
    for_each_unsettled([&](auto& recording) { recording.poses.resize(steps + 1); });
    for (size_t k = 0; k <= steps; ++k) record(k, steps);
    while (!settle() && steps < most) {
      steps *= 2;
      for_each_unsettled([](auto& recording) { spread(recording.poses); });
      for (size_t k = 1; k < steps; k += 2) record(k, steps);
    }
    file_.move(scene_, open_);
    give();
  }

 private:
  template <class Visit>
  void for_each_unsettled(const Visit& visit) {
    const auto visit_all = [&](auto& recordings) {
      for (auto& recording : recordings)
        if (!recording.settled) visit(recording);
    };
    visit_all(objects_), visit_all(meshes_), visit_all(lights_), visit_all(cameras_);
  }

  const Bounds3d& box_of_mesh(uint32_t mesh) {
    const auto [at, added] = boxes_.try_emplace(mesh);
    if (added) at->second = box_of(scene_.geometry.meshes[mesh]);
    return at->second;
  }

  template <class Instances, class Box>
  void list_objects(const Instances& placed, size_t first_object, const Box& box) {
    for (size_t i = 0; i < placed.size(); ++i) {
      const auto& instance = placed[i];
      if (!file_.moving_nodes()[instance.node]) continue;
      const auto [first, count] = of_node(placed, instance.node);
      const Bounds3d object = box(instance);
      const PlaceRuler ruler{object, size_of(transform_bounds(instance.world_from_object, object))};
      objects_.push_back({{uint32_t(first_object + i), ruler}, instance.node, i - first, count});
    }
  }

  /// A power of two.
  [[nodiscard]] size_t most_steps() const {
    uint64_t bytes = 1 + objects_.size() * sizeof(Affine3d);  // of a pose of everything
    for (const MeshRecording& recording : meshes_)
      for (const TriangleMesh& part : scene_.geometry.meshes[recording.index].parts)
        bytes += part.positions.size() * (2 * sizeof(Vec3f) + sizeof(Vec4f));
    return std::bit_floor(std::clamp<uint64_t>(kMostBytes / bytes, 1, kMostSteps));
  }

  void record(size_t k, size_t steps) {
    file_.move(scene_, open_ + shutter_ * double(k) / double(steps));
    for_each_unsettled([&](auto& recording) {
      if (auto pose = pose_now(recording))
        recording.poses[k] = std::move(*pose);
      else
        recording.poses.clear(), recording.settled = true;
    });
  }

  // What it is at the time of the scene; none where it is not shown, or is of other vertices.
  [[nodiscard]] std::optional<Affine3d> pose_now(const ObjectRecording& recording) const {
    const auto place = [&](const auto& placed) -> std::optional<Affine3d> {
      const auto [first, count] = of_node(placed, recording.node);
      if (count != recording.count) return std::nullopt;
      return placed[first + recording.ordinal].world_from_object;
    };
    const Geometry& geometry = scene_.geometry;
    return recording.index < mesh_objects_ ? place(geometry.mesh_instances) : place(geometry.shape_instances);
  }
  [[nodiscard]] std::optional<MeshPose> pose_now(const MeshRecording& recording) const {
    MeshPose pose = pose_of(scene_.geometry.meshes[recording.index]);
    if (!recording.poses[0].empty() && !alike(pose, recording.poses[0])) return std::nullopt;
    return pose;
  }
  [[nodiscard]] std::optional<Light> pose_now(const LightRecording& recording) const {
    if (scene_.lights.size() != light_count_) return std::nullopt;
    return scene_.lights[recording.index];
  }
  [[nodiscard]] std::optional<Camera> pose_now(const CameraRecording& recording) const {
    return scene_.cameras[recording.index];
  }

  /// Whether nothing needs more poses.
  bool settle() {
    bool all = true;
    for_each_unsettled([&](auto& recording) {
      recording.settled = thin_out(recording.poses, recording.apart);
      all &= recording.settled;
    });
    return all;
  }

  void give() {
    Motion& motion = scene_.geometry.motion;
    const size_t objects = scene_.geometry.mesh_instances.size() + scene_.geometry.shape_instances.size();
    give_tracks(objects_, objects, motion.places);
    give_tracks(meshes_, scene_.geometry.meshes.size(), motion.meshes);
    for (LightRecording& recording : lights_) scene_.lights[recording.index].track = std::move(recording.poses);
    for (CameraRecording& recording : cameras_) scene_.cameras[recording.index].track = std::move(recording.poses);
  }

  template <class Recordings, class T>
  static void give_tracks(Recordings& recordings, size_t count, std::vector<Track<T>>& tracks) {
    for (auto& recording : recordings) {
      if (recording.poses.empty()) continue;
      tracks.resize(count);
      tracks[recording.index] = std::move(recording.poses);
    }
  }

  GltfFile& file_;
  Scene& scene_;
  double open_, shutter_;
  size_t light_count_;
  uint32_t mesh_objects_;
  std::map<uint32_t, Bounds3d> boxes_;
  std::vector<ObjectRecording> objects_;
  std::vector<MeshRecording> meshes_;
  std::vector<LightRecording> lights_;
  std::vector<CameraRecording> cameras_;
};

}  // namespace

void record_motion(GltfFile& file, Scene& scene, double open, double shutter) {
  Recorder(file, scene, open, shutter).run();
}

}  // namespace alhazen
