// Claims about alpha and about pictures that were stopped.
#include <gtest/gtest.h>

#include <cstring>
#include <thread>

#include "accel/accelerated_scene.h"
#include "renderer/render.h"
#include "tests/uniform.h"

namespace alhazen {
namespace {

/// A diffuse and a mirroring sphere behind a pane that covers 30 %, before a coloured background.
Scene spheres_behind_a_pane() {
  Scene scene;
  scene.materials.resize(4);  // the last is the default
  for (Material& m : scene.materials) m.model = ShadingModel::phong;
  scene.materials[1].phong.reflection = Rgb(0.5f);
  scene.materials[2].alpha_mode = AlphaMode::blend;
  scene.materials[2].base_color.a = 0.3f;
  scene.geometry.shapes.push_back(Sphere{0.5f});
  for (int i = 0; i < 2; ++i) {
    Affine3d m;
    m.origin = {i - 0.4, 0, -4};
    scene.geometry.shape_instances.push_back({0, uint32_t(i), uint32_t(i), m});
  }
  TriangleMesh pane;
  pane.positions = {{-2, -0.3f, -2}, {2, -0.3f, -2}, {2, 0.4f, -2}};
  pane.triangles = {{0, 1, 2}};
  pane.material = 2;
  scene.geometry.meshes.push_back({"pane", {pane}});
  scene.geometry.mesh_instances.push_back({0, 2, {}});
  Light light;
  light.p_world = {1, 3, 1}, light.intensity = Rgb(1.0f), light.attenuated = false;
  scene.lights.push_back(light);
  scene.ambient = Rgb(0.1f), scene.background = {0.2f, 0.5f, 0.9f};
  return scene;
}

RenderResult picture(const Scene& scene, const RenderOptions& options, RenderControl& control) {
  std::vector<Opacity> opacity;
  const SurfaceFilter filter = surface_filter(scene, opacity);
  const AcceleratedScene accelerated(scene.geometry, filter);
  return render(scene, accelerated, Camera{}, options, control);
}

TEST(Transparency, OverTheBackgroundATransparentPictureIsTheOpaqueOne) {
  const Scene scene = spheres_behind_a_pane();
  RenderOptions options;
  options.width = 120, options.height = 90, options.samples = 4;
  RenderControl opaque_control, control;
  const std::vector<float> opaque = picture(scene, options, opaque_control).color.pixels;
  options.transparent = true;
  const std::vector<float> p = picture(scene, options, control).color.pixels;
  const float background[] = {scene.background.r, scene.background.g, scene.background.b};
  size_t empty = 0, partial = 0, full = 0;
  for (size_t i = 0; i < p.size(); i += 4) {
    const float alpha = p[i + 3];
    ASSERT_TRUE(alpha >= 0 && alpha <= 1);
    ++(alpha == 0 ? empty : alpha == 1 ? full : partial);
    for (size_t c = 0; c < 3; ++c) ASSERT_NEAR(p[i + c] + (1 - alpha) * background[c], opaque[i + c], 1e-5f);
    ASSERT_EQ(opaque[i + 3], 1.0f);
  }
  EXPECT_TRUE(empty > 0 && partial > 0 && full > 0);
}

TEST(Transparency, LightPassesAPaneByTheAlphaOfItsMaterialAndVertices) {
  Uniform uniform(8);
  for (const bool colored : {false, true}) {
    Scene scene = spheres_behind_a_pane();
    scene.geometry.shape_instances.clear();
    TriangleMesh& pane = scene.geometry.meshes[0].parts[0];
    if (colored) pane.colors = {{1, 1, 1, 0.2f}, {1, 1, 1, 1}, {1, 1, 1, 0.6f}};
    std::vector<Opacity> opacity;
    const SurfaceFilter filter = surface_filter(scene, opacity);
    const AcceleratedScene accelerated(scene.geometry, filter);
    RayWave rays;
    std::vector<float> expected;
    for (int i = 0; i < 500; ++i) {
      const float u = uniform(0.01f, 0.98f), v = uniform(0.01f, 0.99f - u);
      const Vec3f p = pane.positions[0] * (1 - u - v) + pane.positions[1] * u + pane.positions[2] * v;
      const Vec3f away = Vec3f{0, 0, 1} + uniform.direction() * 0.3f;
      rays.push({p + away, away * -2.0f, 0, 1});
      expected.push_back(1 - 0.3f * (colored ? 0.2f * (1 - u - v) + u + 0.6f * v : 1.0f));
    }
    Lanes<Rgb> visible;
    accelerated.transmittance(rays, Coherence::incoherent, visible);
    for (size_t i = 0; i < expected.size(); ++i) ASSERT_NEAR(visible[i].r, expected[i], 1e-5f) << colored << " " << i;
  }
}

TEST(Render, StoppedPixelsAreFinishedOrEmpty) {
  const Scene scene = spheres_behind_a_pane();
  RenderOptions options;
  options.width = 640, options.height = 480, options.samples = 8;
  RenderControl whole_control, control;
  const std::vector<float> whole = picture(scene, options, whole_control).color.pixels;
  std::thread stopper([&] {
    while (control.pixels_done == 0) std::this_thread::yield();
    control.stop = true;
  });
  const RenderResult stopped = picture(scene, options, control);
  stopper.join();
  uint64_t finished = 0;
  for (size_t i = 0; i < whole.size(); i += 4) {
    const float* p = &stopped.color.pixels[i];
    if (p[3] == 0) {
      ASSERT_TRUE(p[0] == 0 && p[1] == 0 && p[2] == 0);
      continue;
    }
    ASSERT_EQ(std::memcmp(p, &whole[i], 4 * sizeof(float)), 0);
    ++finished;
  }
  EXPECT_EQ(finished, control.pixels_done);
  EXPECT_EQ(stopped.complete, finished == uint64_t(options.width) * uint64_t(options.height));
}

}  // namespace
}  // namespace alhazen
