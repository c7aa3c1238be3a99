// Claims about layers: they are of the picture's own rays, add up to it, and arrive in files.
#include <gtest/gtest.h>

#include <OpenImageIO/imageio.h>
#include <unistd.h>

#include <cstring>

#include "inspect/layer_picture.h"
#include "inspect/tree_words.h"
#include "loaders/layer_file.h"
#include "tests/loaded_subject.h"

namespace alhazen {
namespace {

std::vector<Layer> all_layers() {
  std::vector<Layer> layers;
  for (size_t i = 0; i < kLayers; ++i) layers.push_back(Layer(i));
  return layers;
}

RenderOptions with_layers(std::vector<Layer> layers, int samples) {
  RenderOptions options{.width = 90, .height = 60, .samples = samples};
  options.layers = std::move(layers);
  return options;
}

/// f(scene, options, result) for every small scene.
template <class F>
void for_results(const RenderOptions& options, const F& f) {
  for (const std::filesystem::path& file : small_scenes()) {
    SCOPED_TRACE(file.filename().string());
    const Subject subject(file, 1.5);
    f(subject, subject.result(options));
  }
}

const LayerImage& named(const RenderResult& result, const std::string& name) {
  return *std::ranges::find(result.layers, name, &LayerImage::name);
}

TEST(RenderLayers, LightAddsUpToThePicture) {
  const RenderOptions options = with_layers(
      {Layer::emission, Layer::ambient, Layer::background, Layer::direct, Layer::reflected, Layer::refracted}, 2);
  for_results(options, [&](const Subject&, const RenderResult& result) {
    for (size_t i = 0; i < size_t(options.width) * size_t(options.height); ++i)
      for (size_t c = 0; c < 3; ++c) {
        float sum = 0;
        for (const LayerImage& layer : result.layers) sum += layer.floats[3 * i + c];
        const float pixel = result.color.pixels[4 * i + c];
        ASSERT_NEAR(sum, pixel, 1e-5f * (1 + pixel)) << "pixel " << i;
      }
  });
}

TEST(RenderLayers, LightsAddUpToTheDirectLight) {
  const RenderOptions options = with_layers({Layer::direct, Layer::lights}, 1);
  for_results(options, [&](const Subject& subject, const RenderResult& result) {
    ASSERT_EQ(result.layers.size(), 1 + subject.scene.lights.size());
    for (size_t i = 0; i < result.layers[0].floats.size(); ++i) {
      float sum = 0;
      for (size_t k = 1; k < result.layers.size(); ++k) sum += result.layers[k].floats[i];
      ASSERT_NEAR(sum, result.layers[0].floats[i], 1e-5f * (1 + sum));
    }
  });
}

TEST(RenderLayers, LeaveThePictureAsItIs) {
  for_results(with_layers(all_layers(), 2), [&](const Subject& subject, const RenderResult& result) {
    const std::vector<float> plain = subject.picture(with_layers({}, 2)).pixels;
    EXPECT_EQ(std::memcmp(plain.data(), result.color.pixels.data(), plain.size() * sizeof(float)), 0);
  });
}

TEST(RenderLayers, IdsAreTheSignature) {
  const RenderOptions options = with_layers({Layer::node, Layer::primitive, Layer::material}, 1);
  for_results(options, [&](const Subject& subject, const RenderResult& result) {
    RenderOptions signature = with_layers({}, 1);
    signature.integrator = Integrator::signature;
    const IdImage ids = subject.result(signature).ids;
    for (size_t i = 0; i < ids.pixels.size(); ++i) ASSERT_EQ(result.layers[i % 3].ids[i / 3], ids.pixels[i]);
  });
}

TEST(RenderLayers, PlacesAndNormalsBelongToTheSurfacesSeen) {
  const RenderOptions options = with_layers(all_layers(), 1);
  for_results(options, [&](const Subject& subject, const RenderResult& result) {
    const Affine3d& m = subject.camera.world_from_camera;
    for (size_t i = 0; i < result.color.pixels.size() / 4; ++i) {
      const float depth = named(result, "depth").floats[i];
      ASSERT_EQ(std::isinf(depth), named(result, "node").ids[i] == kNone);
      ASSERT_EQ(named(result, "samples").floats[i], 1.0f);
      ASSERT_GE(named(result, "rays").floats[i], 1.0f);
      ASSERT_GT(named(result, "cost").floats[i], 0.0f);
      const float shadow = named(result, "shadow").floats[i];
      ASSERT_TRUE(shadow >= 0 && shadow <= 1.00001f) << shadow;
      if (std::isinf(depth)) continue;
      const auto vector = [&](const char* name) {
        const float* v = &named(result, name).floats[3 * i];
        return Vec3f{v[0], v[1], v[2]};
      };
      ASSERT_NEAR(-dot(Vec3d(vector("position")) - m.origin, m.z), double(depth), 1e-4 * (1 + double(depth)));
      ASSERT_NEAR(length(vector("normal")), 1, 1e-4);
      ASSERT_NEAR(length(vector("geometric_normal")), 1, 1e-4);
    }
  });
}

TEST(RenderLayers, FilesHoldThemToTheBit) {
  const Subject subject(ALHAZEN_SHOWCASE, 1.5);
  const RenderOptions options = with_layers(all_layers(), 2);
  const RenderResult result = subject.result(options);
  const size_t pixels = size_t(options.width) * size_t(options.height);
  for (const bool multipart : {false, true}) {
    const auto file = std::filesystem::temp_directory_path() / ("alhazen-layers-" + std::to_string(getpid()) + ".exr");
    write_layers(file, result.color, result.layers, multipart, {}, {});
    const auto in = OIIO::ImageInput::open(file.string());
    ASSERT_TRUE(in);
    for (size_t k = 0; k < result.layers.size(); ++k) {
      const LayerImage& layer = result.layers[k];
      const OIIO::ImageSpec spec = in->spec(multipart ? int(k) + 1 : 0);
      if (multipart) {
        EXPECT_EQ(spec.get_string_attribute("oiio:subimagename"), layer.name);
      }
      for (size_t c = 0; c < layer.channels.size(); ++c) {
        const int channel = spec.channelindex(layer.name + "." + layer.channels[c]);
        ASSERT_GE(channel, 0) << layer.name;
        const bool ids = layer.floats.empty();
        EXPECT_EQ(spec.channelformat(channel), ids ? OIIO::TypeDesc::UINT32 : OIIO::TypeDesc::FLOAT) << layer.name;
        std::vector<uint32_t> bits(pixels);
        ASSERT_TRUE(in->read_image(multipart ? int(k) + 1 : 0, 0, channel, channel + 1, spec.channelformat(channel),
                                   bits.data()));
        for (size_t i = 0; i < pixels; ++i) {
          uint32_t expected;
          const size_t at = i * layer.channels.size() + c;
          std::memcpy(&expected, ids ? static_cast<const void*>(&layer.ids[at]) : &layer.floats[at], 4);
          ASSERT_EQ(bits[i], expected) << layer.name << " " << i;
        }
      }
    }
    std::filesystem::remove(file);
  }
}

TEST(LayerPicture, HeatGrowsBrighterInEvenSteps) {
  // CIE lightness rises from that of dark blue to that of yellow by nearly the same step each time.
  const auto lightness = [](float t) { return 116 * std::cbrt(luminance(heat_color(t))) - 16; };
  const float step = (lightness(1) - lightness(0)) / 10;
  for (int i = 0; i < 10; ++i)
    EXPECT_NEAR(lightness(float(i + 1) / 10) - lightness(float(i) / 10), step, 0.25f * step) << i;
}

TEST(LayerPicture, EveryLayerHasOne) {
  const Subject subject(ALHAZEN_SHOWCASE, 1.5);
  const RenderResult result = subject.result(with_layers(all_layers(), 1));
  for (const LayerImage& layer : result.layers) {
    const ColorImage picture = layer_picture(layer, 90, 60);
    EXPECT_GE(picture.width, 90);
    for (const float v : picture.pixels) ASSERT_TRUE(std::isfinite(v)) << layer.name;
  }
}

}  // namespace
}  // namespace alhazen
