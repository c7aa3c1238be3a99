// Writes down the rays of one sample of one pixel while its cell is traced.
#pragma once

#include "inspect/ray_tree.h"

namespace alhazen {

class TreeRecorder final : public TraceObserver {
 public:
  /// `pixel`: its index within the cell, see `Path::pixel`.
  TreeRecorder(const Scene& scene, uint32_t pixel, int sample) : scene_(scene), pixel_(pixel), sample_(sample) {}

  /// What was recorded: the rays, and nothing else of the tree.
  [[nodiscard]] std::vector<TreeRay> take() { return std::move(rays_); }

  /// When they are traced, of the shutter; nothing where all stands still.
  [[nodiscard]] std::optional<float> time() const { return time_; }

  void begin_sample(int sample, const PathWave& camera_rays, const Lanes<float>& times) override;
  void take_wave(size_t first) override { followed_.take_wave(first); }
  void look_at(size_t i) override { ray_ = followed_[i]; }
  void hit(const ShadedHit& hit) override;
  void pass_unnoticed() override;
  void part(const Interface& interface) override;
  void add(LightTerm term, const Rgb& light) override;
  void uncover(float share) override;
  void spawn(const Rayf& ray, const Path& path, Bounce bounce, SpawnOutcome outcome) override;
  void ask(const LightQuery& query) override;
  void answer(size_t i, const Rgb& visible, const Rgb& light) override;
  void answered() override { asked_.clear(); }

 private:
  struct AskedLight {
    uint32_t ray, light;  // indices into rays_ and its lights; ray kNone: of another pixel
  };

  const Scene& scene_;
  uint32_t pixel_;
  int sample_;
  uint32_t ray_ = kNone;  // looked at; kNone: of another pixel or sample
  uint32_t order_ = 0;
  std::optional<float> time_;
  std::vector<TreeRay> rays_;
  FollowedRays<uint32_t> followed_;  // indices into rays_
  std::vector<AskedLight> asked_;
};

}  // namespace alhazen
