// Claims about hits shaded side by side: pictures have the bits that they have when every hit is shaded alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "accel/accelerated_scene.h"
#include "materials/mipmap.h"
#include "renderer/hits_by_group.h"
#include "renderer/render.h"
#include "renderer/trace_observer.h"
#include "tests/uniform.h"

namespace alhazen {
namespace {

/// Who looks on while hits are shaded one by one.
class Onlooker : public TraceObserver {
 public:
  void begin_sample(int, const PathWave&, const Lanes<float>&) override {}
  void take_wave(size_t) override {}
  void look_at(size_t) override {}
  void hit(const ShadedHit&) override {}
  void pass_unnoticed() override {}
  void part(const Interface&) override {}
  void add(LightTerm, const Rgb&) override {}
  void uncover(float) override {}
  void spawn(const Rayf&, const Path&, Bounce, SpawnOutcome) override {}
  void ask(const LightQuery&) override {}
  void answer(size_t, const Rgb&, const Rgb&) override {}
  void answered() override {}
};

/// Opaque, in part and absent texels.
TextureImage random_image(Uniform& uniform) {
  const int size = 1 << uniform.bits() % 5;
  std::vector<uint8_t> samples(size_t(size) * size_t(size) * 4);
  for (size_t i = 0; i < samples.size(); ++i) samples[i] = uint8_t(uniform.bits());
  for (size_t i = 3; i < samples.size(); i += 4) samples[i] = uniform.bits() % 3 ? samples[i] : uint8_t(255 * (i & 4));
  return {.width = size, .height = size, .channels = 4, .samples = samples};
}

Material random_material(Uniform& uniform) {
  const auto maybe = [&](int in = 2) { return uniform.bits() % unsigned(in) == 0; };
  const auto color = [&] { return Rgb{uniform(0, 1), uniform(0, 1), uniform(0, 1)}; };
  const auto use = [&] {
    TextureUse some;
    if (maybe()) some = {.texture = uniform.bits() % 3, .xx = uniform(-2, 2), .yx = uniform(-1, 1)};
    return some;
  };
  Material m;
  m.model = std::array{ShadingModel::unlit, ShadingModel::phong, ShadingModel::metallic_roughness,
                       ShadingModel::metallic_roughness}[uniform.bits() % 4];
  m.alpha_mode = AlphaMode(uniform.bits() % 3);
  m.base_color = {color(), maybe() ? uniform(0, 1) : 1};
  m.base_color_texture = use(), m.emissive_texture = use(), m.occlusion_texture = use();
  m.metallic_roughness_texture = use(), m.normal_texture = use();
  m.metallic = uniform(0, 1), m.roughness = maybe() ? uniform(0, 1) : 0;
  if (maybe()) m.emissive = color();
  m.phong.diffuse = color(), m.phong.diffuse_texture = use(), m.phong.ambient = color();
  if (maybe()) m.phong.specular = color();
  if (maybe()) m.phong.reflection = color();
  if (maybe(3)) m.phong.transmission = color();
  m.phong.fresnel = maybe(), m.phong.ior = uniform(1, 2);
  if (maybe(4)) m.transmission = uniform(0, 1);
  if (maybe(8)) m.volume.thickness = 1, m.volume.attenuation_distance = 0.5f, m.volume.attenuation_color = color();
  if (maybe(8)) m.clearcoat.factor = 1;
  return m;
}

/// Triangles and balls strewn before the camera.
Scene random_scene(Uniform& uniform) {
  const auto vector = [&](float size) {
    return Vec3d{uniform(-size, size), uniform(-size, size), uniform(-size, size)};
  };
  Scene scene;
  for (int i = 0; i < 6; ++i) scene.materials.push_back(random_material(uniform));
  for (uint32_t i = 0; i < 3; ++i) {
    scene.images.push_back(random_image(uniform));
    if (uniform.bits() % 2) add_smaller_levels(scene.images.back(), ColorSpace::srgb);
    scene.textures.push_back({.image = i, .mipmaps = Mipmaps(uniform.bits() % 3)});
  }
  scene.geometry.shapes.push_back(Sphere{0.6});
  for (uint32_t node = 0; node < 6; ++node) {
    TriangleMesh part;
    part.material = node, part.uvs.resize(1);
    for (uint32_t k = 0; k < 24; ++k) {
      part.positions.push_back(Vec3f(vector(2) + Vec3d{0, 0, -5}));
      part.normals.push_back(uniform.direction());
      const Vec3f t = uniform.direction();
      part.tangents.push_back({t.x, t.y, t.z, 1});
      part.uvs[0].push_back({uniform(-2, 2), uniform(-2, 2)});
      if (k % 3 == 2) part.triangles.push_back({k - 2, k - 1, k});
    }
    if (uniform.bits() % 2) part.normals.clear(), part.tangents.clear();
    scene.geometry.meshes.push_back({"", {part}});
    scene.geometry.mesh_instances.push_back({node, node, {}});
    Affine3d m;
    m.origin = vector(2) + Vec3d{0, 0, -5};
    scene.geometry.shape_instances.push_back({0, node, node, m});
  }
  for (int i = 0; i < 2; ++i) {
    Light light;
    light.p_world = vector(4), light.intensity = Rgb(9.0f);
    if (i == 1) light.kind = Light::Kind::directional, light.intensity = Rgb(1.0f);
    scene.lights.push_back(light);
  }
  scene.ambient = Rgb(0.1f), scene.background = {0.2f, 0.5f, 0.9f};
  if (uniform.bits() % 2) add_studio_lights(scene, Camera{});
  return scene;
}

TEST(BlockShading, PicturesHaveTheBitsOfHitsShadedAlone) {
  Uniform uniform(31);
  RenderOptions options;
  options.width = options.height = 96;
  for (int i = 0; i < 40; ++i) {
    SCOPED_TRACE(i);
    const Scene scene = random_scene(uniform);
    options.max_depth = int(uniform.bits() % 5), options.transparent = uniform.bits() % 2;
    std::vector<Opacity> opacity;
    const SurfaceFilter filter = surface_filter(scene, opacity);
    const AcceleratedScene accelerated(scene.geometry, filter);
    RenderControl control;
    const ColorImage side_by_side = render(scene, accelerated, Camera{}, options, control).color;
    int x = 0, y = 0;
    while (y < options.height) {
      Onlooker onlooker;
      const CellPicture alone = render_cell(scene, accelerated, Camera{}, options, control, x, y, onlooker);
      for (int row = 0; row < alone.color.height; ++row)
        ASSERT_EQ(0, std::memcmp(alone.color.at(0, row), side_by_side.at(alone.x0, alone.y0 + row),
                                 size_t(alone.color.width) * 4 * sizeof(float)))
            << "row " << alone.y0 + row << " from " << alone.x0;
      x = alone.x0 + alone.color.width;
      if (x >= options.width) x = 0, y = alone.y0 + alone.color.height;
    }
  }
}

/// Runs of neighbours on one part or on nothing, from one hit to more than lanes hold.
TEST(HitsByGroup, KeepTheirOrderInEachGroup) {
  Uniform uniform(32);
  const Scene scene = random_scene(uniform);
  const ShadingGroups groups(scene);
  const size_t objects = scene.geometry.mesh_instances.size() + scene.geometry.shape_instances.size();
  HitsByGroup sorted;
  for (int i = 0; i < 300; ++i) {
    HitWave hits;
    hits.resize(uniform.bits() % 400);
    for (size_t k = 0; k < hits.object.size();) {
      const uint32_t object = uniform.bits() % 4 ? uint32_t(uniform.bits() % objects) : kNone;
      const size_t end = std::min(hits.object.size(), k + 1 + uniform.bits() % (i % 2 ? 3 : 70));
      for (; k < end; ++k) hits.object[k] = object, hits.part[k] = object == kNone ? uniform.bits() : 0;
    }
    sort_by_group(hits, scene.geometry, groups, sorted);
    ASSERT_EQ(sorted.sorted.size(), hits.object.size());
    size_t place = 0;
    for (size_t group = 0; group <= groups.size(); ++group) {
      const size_t first = place;
      for (; place < sorted.ends[group]; ++place) {
        const uint32_t k = sorted.sorted[place];
        EXPECT_TRUE(place == first || sorted.sorted[place - 1] < k);
        EXPECT_EQ(group, hits.object[k] == kNone ? groups.size() : groups.of(scene.geometry, hits.object[k], 0));
      }
    }
    EXPECT_EQ(place, hits.object.size());
  }
}

}  // namespace
}  // namespace alhazen
