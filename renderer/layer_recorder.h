// Fills layers while a cell is traced.
#pragma once

#include <array>
#include <chrono>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "renderer/camera_cell.h"
#include "renderer/cryptomatte.h"
#include "renderer/layer.h"
#include "renderer/trace_observer.h"

namespace alhazen {

/// Empty layers for a picture, in the order asked for, each once; `lights` becomes one for each of the scene's.
[[nodiscard]] std::vector<LayerImage> empty_layers(const Scene& scene, std::span<const Layer> layers, int width,
                                                   int height);

/// Fills the layers of one cell.
class LayerRecorder final : public TraceObserver {
 public:
  /// `images` as empty_layers gave them for the same scene and layers.
  LayerRecorder(const Scene& scene, const Camera& camera, std::span<const Layer> layers,
                std::vector<LayerImage>& images, int image_width);

  /// Takes the means over the samples to the images.
  void finish(const Cell& cell, int samples);

  void begin_sample(int sample, const PathWave& camera_rays, const Lanes<float>& times) override;
  void take_wave(size_t first) override;
  void look_at(size_t i) override;
  void hit(const ShadedHit& hit) override;
  void pass_unnoticed() override {}
  void part(const Interface&) override {}
  void add(LightTerm term, const Rgb& light) override;
  void uncover(float) override {}
  void spawn(const Rayf& ray, const Path& path, Bounce bounce, SpawnOutcome outcome) override;
  void ask(const LightQuery& query) override;
  void answer(size_t i, const Rgb& visible, const Rgb& light) override;
  void answered() override;

 private:
  enum class Branch : uint8_t { view, reflected, refracted };
  struct Followed {
    uint32_t pixel = 0;
    Branch branch = Branch::view;
    bool camera = false;  // the camera ray itself
  };
  struct Asked {
    Followed of;
    uint32_t light = 0;
    float unshadowed = 0;  // luminance
  };
  using Clock = std::chrono::steady_clock;

  /// Sums over the samples of one pixel; ids and places of the first one.
  struct Pixel {
    Rgb albedo{}, emission{}, ambient{}, background{}, direct{}, reflected{}, refracted{};
    Vec3f normal{}, geometric_normal{}, position{};
    Vec2f uv{};
    float depth = std::numeric_limits<float>::infinity(), arrived = 0, unshadowed = 0, rays = 0, microseconds = 0;
    SurfaceIds ids{kNone, kNone, kNone};
    std::array<std::vector<Coverage>, 3> mattes{};  // by node, mesh, material
  };

  Pixel& pixel() { return pixels_[looked_at_.pixel]; }
  void add_to_branch(const Followed& of, const Rgb& light, Rgb Pixel::*view);
  void charge(uint32_t pixel, Clock::duration time);
  static void store(const Pixel& p, Layer layer, float scale, LayerImage& image, size_t at);
  void add_coverage(const ShadedHit& hit);
  [[nodiscard]] Rgb albedo(const ShadedHit& hit) const;

  const Scene& scene_;
  const Camera& camera_;
  std::span<const Layer> layers_;
  std::vector<LayerImage>& images_;
  int image_width_;
  int sample_ = 0;
  std::vector<Pixel> pixels_;
  std::vector<Rgb> by_light_;  // pixel x light
  FollowedRays<Followed> followed_;
  Followed looked_at_;
  std::vector<Asked> asked_;
  size_t wave_size_ = 0;
  bool traced_ = false;  // the wave, and nothing of it is shaded yet
  Clock::time_point since_;
};

}  // namespace alhazen
