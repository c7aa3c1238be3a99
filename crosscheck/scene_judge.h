// The judge of whole scenes: what a ray hits first of all surfaces, exactly.
#pragma once

#include "crosscheck/judge.h"
#include "crosscheck/native_scene.h"
#include "crosscheck/scene_boxes.h"

namespace alhazen::crosscheck {

/// A surface that the ray meets about where it is first stopped.
struct SurfaceAt {
  SurfaceId id;
  float t;
};

struct SceneTruth {
  Judgement nearest;
  std::vector<SurfaceAt> surfaces;  // the nearest one first, then those up to `kTiedFloats` behind it
  bool complete = true;             // false: the ray may meet something that the native scene cannot answer for

  [[nodiscard]] SurfaceId first() const { return surfaces.empty() ? SurfaceId{} : surfaces.front().id; }
};

inline constexpr double kTiedFloats = 16;

/// Whether `id` is what the ray hits, or lies no more than so many floats behind it: rounded, either may come first.
[[nodiscard]] bool is_first(const SceneTruth& truth, const SurfaceId& id, double floats);

class SceneJudge {
 public:
  /// Of the scene as it is given, or in floats as the native scene holds it. Both must outlive it.
  explicit SceneJudge(const SceneBoxes& boxes, const NativeScene* native = nullptr);

  /// Every surface whose box the ray passes is judged by itself.
  [[nodiscard]] SceneTruth closest(const Rayf& ray_world) const;

 private:
  struct Object {
    Affine3d world_from_object;
    std::unique_ptr<Judge> judge;  // of a shape
  };
  [[nodiscard]] Object object_of(uint32_t number) const;
  [[nodiscard]] Judgement judge(const SurfaceId& id, const Triangle* triangle, const Rayf& ray) const;

  const SceneBoxes* boxes_;
  const NativeScene* native_;
  std::vector<Object> objects_;
};

}  // namespace alhazen::crosscheck
