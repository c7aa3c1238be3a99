#include "loaders/gltf_environment.h"

#include <algorithm>
#include <array>
#include <limits>
#include <type_traits>

#include "loaders/gltf_texture.h"
#include "core/transform.h"
#include "loaders/image_decode.h"
#include "renderer/cube_environment.h"

namespace alhazen {
namespace {

constexpr size_t kFaces = 6;

/// From 0 to 1; of floating-point images as they are.
float sample_at(const TextureImage& image, size_t i) {
  return std::visit(
      [&](const auto& samples) {
        using T = typename std::decay_t<decltype(samples)>::value_type;
        if constexpr (std::is_floating_point_v<T>)
          return std::max(0.0f, float(samples[i]));
        else
          return float(samples[i]) / float(std::numeric_limits<T>::max());
      },
      image.samples);
}

/// Linear radiance.
ColorImage light_of(const TextureImage& image) {
  const bool linear = std::holds_alternative<std::vector<float>>(image.samples);
  const auto n = size_t(image.channels);
  const size_t pixels = size_t(image.width) * size_t(image.height);
  ColorImage light{image.width, image.height, {"R", "G", "B"}, std::vector<float>(pixels * 3)};
  for (size_t i = 0; i < pixels; ++i) {
    const float divisor = n == 4 && !linear ? std::max(sample_at(image, 4 * i + 3), 1 / 255.0f) : 1;
    for (size_t k = 0; k < 3; ++k) {
      const float value = sample_at(image, i * n + (n < 3 ? 0 : k));
      light.pixels[3 * i + k] = (linear ? value : linear_from_srgb(value)) / divisor;
    }
  }
  return light;
}

/// All faces of all levels, in their order; none where one cannot be decoded.
std::vector<TextureImage> decode_faces(GltfSource& source, const GltfBuffers& buffers, const JsonRef& levels) {
  std::vector<EncodedImage> encoded;
  for (const JsonRef& level : levels.elements())
    for (const JsonRef& face : level.elements()) {
      const JsonRef image = source.at("images", face.as<size_t>());
      encoded.push_back({image.place(), read_image(source, buffers, image)});
    }
  std::vector<TextureImage> images = decode_images(std::move(encoded), nullptr, *source.budget);
  for (size_t i = 0; i < images.size(); ++i)
    if (images[i].width == 0) {
      source.warn(levels[i / kFaces][i % kFaces].pointer(), "its image cannot be decoded: no light comes from images");
      return {};
    }
  return images;
}

std::vector<CubeImage> read_levels(GltfSource& source, const GltfBuffers& buffers, const JsonRef& levels) {
  const std::vector<TextureImage> images = decode_faces(source, buffers, levels);
  std::vector<CubeImage> cubes(images.size() / kFaces);
  for (size_t i = 0; i < images.size(); ++i) {
    const TextureImage &image = images[i], &first = images[i - i % kFaces];
    if (image.width != first.width || image.height != first.width)
      levels[i / kFaces][i % kFaces].fail("expected an image of " + std::to_string(first.width) + " x " +
                                          std::to_string(first.width) + " pixels, found " +
                                          std::to_string(image.width) + " x " + std::to_string(image.height));
    if (i % kFaces == 0) source.budget->take(levels, cube_environment_bytes(uint64_t(first.width)));
    cubes[i / kFaces].faces[i % kFaces] = light_of(image);
  }
  return cubes;
}

std::array<Rgb, 9> read_irradiance(const JsonRef& r) {
  std::array<Rgb, 9> irradiance;
  for (size_t k = 0; k < irradiance.size(); ++k) {
    const auto c = r[k].as<std::array<float, 3>>();
    irradiance[k] = {c[0], c[1], c[2]};
  }
  return irradiance;
}

/// Transposed: a rotation's inverse.
Affine3f inverse_rotation(const JsonRef& light) {
  const auto q = light.get("rotation", std::array{0.0, 0.0, 0.0, 1.0});
  if (q == std::array<double, 4>{}) light["rotation"].expected("a unit quaternion");
  const Affine3d m = rotate_scale(q, {1, 1, 1});
  return Affine3f(Affine3d{{m.x.x, m.y.x, m.z.x}, {m.x.y, m.y.y, m.z.y}, {m.x.z, m.y.z, m.z.z}, {}});
}

}  // namespace

std::optional<Environment> read_environment(GltfSource& source, const GltfBuffers& buffers,
                                            std::optional<size_t> scene) {
  const char* const kName = "EXT_lights_image_based";
  if (!scene) return std::nullopt;
  const auto chosen = source.at("scenes", *scene).extension(kName);
  if (!chosen) return std::nullopt;
  const JsonRef light = (*source.root().extension(kName))["lights"][(*chosen)["light"].as<size_t>()];
  const std::vector<CubeImage> levels = read_levels(source, buffers, light["specularImages"]);
  if (levels.empty()) return std::nullopt;
  Environment environment = make_environment(levels, read_irradiance(light["irradianceCoefficients"]));
  environment.environment_from_world = inverse_rotation(light);
  environment.strength = light.get("intensity", 1.0f);
  return environment;
}

}  // namespace alhazen
