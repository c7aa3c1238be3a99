#include "renderer/layer_recorder.h"

#include <algorithm>
#include <utility>

#include "materials/metallic_roughness.h"
#include "materials/phong.h"

namespace alhazen {
namespace {

constexpr std::array kNames{"albedo", "normal",    "geometric_normal", "depth",       "position",       "uv",
                            "node",   "primitive", "material",         "emission",    "ambient",        "background",
                            "direct", "lights",    "reflected",        "refracted",   "shadow",         "samples",
                            "rays",   "cost",      "crypto_node",      "crypto_mesh", "crypto_material"};
static_assert(kNames.size() == kLayers);

bool holds_ids(Layer layer) { return layer == Layer::node || layer == Layer::primitive || layer == Layer::material; }

std::vector<std::string> channels_of(Layer layer) {
  switch (layer) {
    case Layer::normal:
    case Layer::geometric_normal:
    case Layer::position:
      return {"X", "Y", "Z"};
    case Layer::uv:
      return {"U", "V"};
    case Layer::depth:
      return {"Z"};
    case Layer::node:
    case Layer::primitive:
    case Layer::material:
    case Layer::shadow:
    case Layer::samples:
    case Layer::rays:
    case Layer::cost:
      return {"Y"};
    default:
      return {"R", "G", "B"};
  }
}

LayerImage empty_layer(Layer layer, const std::string& name, size_t pixels) {
  LayerImage image{name, channels_of(layer), {}, {}, false, {}};
  if (holds_ids(layer))
    image.ids.assign(pixels, kNone);
  else
    image.floats.assign(pixels * image.channels.size(), 0.0f);
  return image;
}

/// Layers are parted by dots: a name must not hold any, nor be that of another light.
std::string light_layer_name(const Scene& scene, size_t light) {
  std::string name = scene.lights[light].name;
  for (char& c : name)
    if (c == '.' || static_cast<unsigned char>(c) < 32) c = '_';
  size_t same = 0;
  for (const Light& other : scene.lights) same += other.name == scene.lights[light].name;
  if (name.empty() || same > 1) name += (name.empty() ? "light" : "_") + std::to_string(light);
  return "direct." + name;
}

std::string name_or_index(const std::string& name, const char* kind, uint32_t index) {
  return name.empty() ? std::string(kind) + " " + std::to_string(index) : name;
}

std::string node_name(const Scene& scene, uint32_t node) {
  return name_or_index(node < scene.node_names.size() ? scene.node_names[node] : "", "node", node);
}

/// Shapes have no names.
std::string mesh_name(const Scene& scene, uint32_t object) {
  if (is_shape(scene.geometry, object)) return "shape " + std::to_string(shape_instance(scene.geometry, object).shape);
  const uint32_t mesh = scene.geometry.mesh_instances.mesh_of(object);
  return name_or_index(scene.geometry.meshes[mesh].name, "mesh", mesh);
}

std::string material_name(const Scene& scene, uint32_t material) {
  if (material + 1 == scene.materials.size()) return "default";
  return name_or_index(scene.materials[material].name, "material", material);
}

constexpr std::array kCryptoNames{"CryptoNode", "CryptoMesh", "CryptoMaterial"};
constexpr size_t kCryptoImages = 3;  // of two ranks each

bool is_crypto(Layer layer) { return layer >= Layer::crypto_node; }
size_t crypto_index(Layer layer) { return size_t(layer) - size_t(Layer::crypto_node); }

/// What may be seen of a kind.
std::vector<std::string> crypto_names(const Scene& scene, Layer layer) {
  std::vector<std::string> names;
  if (layer == Layer::crypto_material)
    for (uint32_t i = 0; i < scene.materials.size(); ++i) names.push_back(material_name(scene, i));
  const size_t objects = scene.geometry.mesh_instances.size() + scene.geometry.shape_instances.size();
  for (uint32_t i = 0; i < objects && layer != Layer::crypto_material; ++i)
    names.push_back(layer == Layer::crypto_node ? node_name(scene, node_of(scene.geometry, i)) : mesh_name(scene, i));
  return names;
}

void add_crypto_images(const Scene& scene, Layer layer, size_t pixels, std::vector<LayerImage>& images) {
  const std::string name = kCryptoNames[crypto_index(layer)];
  for (size_t k = 0; k < kCryptoImages; ++k) {
    images.push_back(
        {name + "0" + std::to_string(k), {"R", "G", "B", "A"}, std::vector<float>(4 * pixels, 0.0f), {}, true, {}});
    images.back().attributes = cryptomatte_metadata(name, crypto_names(scene, layer));
  }
}

/// The two largest ranks of the first image, and so on.
void put(const std::vector<Coverage>& ranked, size_t image, float* out) {
  for (size_t r = 0; r < 2; ++r)
    if (const size_t at = 2 * image + r; at < ranked.size())
      out[2 * r] = ranked[at].id, out[2 * r + 1] = ranked[at].coverage;
}

float luminance(const Rgb& c) { return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b; }

void put(float* out, float v) { out[0] = v; }
void put(float* out, const Vec2f& v) { out[0] = v.x, out[1] = v.y; }
void put(float* out, const Rgb& c) { out[0] = c.r, out[1] = c.g, out[2] = c.b; }
void put(float* out, const Vec3f& v) { out[0] = v.x, out[1] = v.y, out[2] = v.z; }

}  // namespace

const char* layer_name(Layer layer) { return kNames[size_t(layer)]; }

std::vector<LayerImage> empty_layers(const Scene& scene, std::span<const Layer> layers, int width, int height) {
  const size_t pixels = size_t(width) * size_t(height);
  std::vector<LayerImage> images;
  for (const Layer layer : layers) {
    if (is_crypto(layer))
      add_crypto_images(scene, layer, pixels, images);
    else if (layer != Layer::lights)
      images.push_back(empty_layer(layer, layer_name(layer), pixels));
    else
      for (size_t i = 0; i < scene.lights.size(); ++i)
        images.push_back(empty_layer(layer, light_layer_name(scene, i), pixels));
  }
  return images;
}

LayerRecorder::LayerRecorder(const Scene& scene, const Camera& camera, std::span<const Layer> layers,
                             std::vector<LayerImage>& images, int image_width)
    : scene_(scene),
      camera_(camera),
      layers_(layers),
      images_(images),
      image_width_(image_width),
      pixels_(size_t(kCellSize * kCellSize)),
      by_light_(pixels_.size() * scene.lights.size()) {}

void LayerRecorder::begin_sample(int sample, const PathWave& camera_rays, const Lanes<float>& /*times*/) {
  sample_ = sample;
  followed_.begin(camera_rays.size(), {});
  for (size_t i = 0; i < camera_rays.size(); ++i)
    followed_.pending(i) = {camera_rays.paths.pixel[i], Branch::view, true};
}

void LayerRecorder::take_wave(size_t first) {
  followed_.take_wave(first);
  traced_ = true;
  wave_size_ = followed_.wave_size();
  since_ = Clock::now();
}

void LayerRecorder::charge(uint32_t pixel, Clock::duration time) {
  pixels_[pixel].microseconds += std::chrono::duration<float, std::micro>(time).count();
}

void LayerRecorder::look_at(size_t i) {
  const auto now = Clock::now();
  if (std::exchange(traced_, false))
    for (size_t k = 0; k < wave_size_; ++k) charge(followed_[k].pixel, (now - since_) / int64_t(wave_size_));
  else
    charge(looked_at_.pixel, now - since_);
  since_ = now;
  looked_at_ = followed_[i];
  ++pixel().rays;
}

Rgb LayerRecorder::albedo(const ShadedHit& hit) const {
  const Material& material = scene_.materials[hit.surface.material];
  const SurfaceInputs inputs = hit.surface.inputs();
  const TextureTable table = texture_table(scene_);
  switch (material.model) {
    case ShadingModel::unlit:
      return emission(material, table, inputs);
    case ShadingModel::phong:
      return phong_bsdf(material, table, inputs).diffuse;
    case ShadingModel::measured:
      return measured_albedo(measured_bsdf(scene_, material), 1).total();
    case ShadingModel::metallic_roughness:
      break;
  }
  return metallic_roughness_bsdf(material, table, inputs).base_color;
}

/// As much as the view sees of the surface, through what lies before it.
void LayerRecorder::add_coverage(const ShadedHit& hit) {
  const float seen = max_component(hit.arriving) * hit.alpha;
  const auto add = [&](Layer layer, const auto& name) {
    if (std::ranges::find(layers_, layer) != layers_.end())
      cover(pixel().mattes[crypto_index(layer)], name_id(name()), seen);
  };
  add(Layer::crypto_node, [&] { return node_name(scene_, node_of(scene_.geometry, hit.ids.object)); });
  add(Layer::crypto_mesh, [&] { return mesh_name(scene_, hit.ids.object); });
  add(Layer::crypto_material, [&] { return material_name(scene_, hit.surface.material); });
}

void LayerRecorder::hit(const ShadedHit& hit) {
  if (looked_at_.branch == Branch::view) add_coverage(hit);
  if (!looked_at_.camera) return;
  Pixel& p = pixel();
  const SurfacePoint& s = hit.surface;
  p.albedo += albedo(hit), p.normal += hit.n, p.geometric_normal += s.ng_world;
  if (sample_ > 0) return;
  const Affine3d& m = camera_.world_from_camera;
  p.depth = float(-dot(s.p_world - m.origin, m.z)), p.position = Vec3f(s.p_world);
  p.ids = surface_ids(scene_, hit.ids);
  if (s.uv_count > 0) p.uv = s.uvs[0];
}

void LayerRecorder::add_to_branch(const Followed& of, const Rgb& light, Rgb Pixel::*view) {
  Pixel& p = pixels_[of.pixel];
  switch (of.branch) {
    case Branch::view:
      p.*view += light;
      break;
    case Branch::reflected:
      p.reflected += light;
      break;
    case Branch::refracted:
      p.refracted += light;
  }
}

void LayerRecorder::add(LightTerm term, const Rgb& light) {
  constexpr std::array kSums{&Pixel::background, &Pixel::background, &Pixel::emission, &Pixel::ambient};
  add_to_branch(looked_at_, light, kSums[size_t(term)]);
}

void LayerRecorder::spawn(const Rayf&, const Path&, Bounce bounce, SpawnOutcome outcome) {
  if (outcome != SpawnOutcome::traced) return;
  Followed next{looked_at_.pixel, looked_at_.branch, false};
  if (next.branch == Branch::view && bounce == Bounce::mirror) next.branch = Branch::reflected;
  if (next.branch == Branch::view && bounce == Bounce::refracted) next.branch = Branch::refracted;
  followed_.spawn(bounce, next);
}

void LayerRecorder::ask(const LightQuery& query) {
  const Rgb all = query.weight * query.arriving * (query.diffuse + query.specular);
  asked_.push_back({looked_at_, query.light, luminance(all)});
  ++pixel().rays;
}

void LayerRecorder::answer(size_t i, const Rgb&, const Rgb& light) {
  const Asked& asked = asked_[i];
  add_to_branch(asked.of, light, &Pixel::direct);
  if (asked.of.branch != Branch::view) return;
  by_light_[asked.of.pixel * scene_.lights.size() + asked.light] += light;
  pixels_[asked.of.pixel].arrived += luminance(light), pixels_[asked.of.pixel].unshadowed += asked.unshadowed;
}

/// The time since the last ray was looked at: its own shading is forgotten against that of all shadow rays.
void LayerRecorder::answered() {
  const auto now = Clock::now();
  for (const Asked& asked : asked_) charge(asked.of.pixel, (now - since_) / int64_t(asked_.size()));
  since_ = now;
  asked_.clear();
}

void LayerRecorder::store(const Pixel& p, Layer layer, float scale, LayerImage& image, size_t at) {
  float* out = image.floats.empty() ? nullptr : &image.floats[at * image.channels.size()];
  switch (layer) {
    case Layer::albedo:
      return put(out, p.albedo * scale);
    case Layer::normal:
      return put(out, p.normal * scale);
    case Layer::geometric_normal:
      return put(out, p.geometric_normal * scale);
    case Layer::depth:
      return put(out, p.depth);
    case Layer::position:
      return put(out, p.position);
    case Layer::uv:
      return put(out, p.uv);
    case Layer::node:
      return void(image.ids[at] = p.ids.node);
    case Layer::primitive:
      return void(image.ids[at] = p.ids.primitive);
    case Layer::material:
      return void(image.ids[at] = p.ids.material);
    case Layer::emission:
      return put(out, p.emission * scale);
    case Layer::ambient:
      return put(out, p.ambient * scale);
    case Layer::background:
      return put(out, p.background * scale);
    case Layer::direct:
      return put(out, p.direct * scale);
    case Layer::lights:
    case Layer::crypto_node:
    case Layer::crypto_mesh:
    case Layer::crypto_material:
      return;  // several images, see finish
    case Layer::reflected:
      return put(out, p.reflected * scale);
    case Layer::refracted:
      return put(out, p.refracted * scale);
    case Layer::shadow:
      return put(out, p.unshadowed > 0 ? p.arrived / p.unshadowed : 1.0f);
    case Layer::samples:
      return put(out, 1 / scale);
    case Layer::rays:
      return put(out, p.rays * scale);
    case Layer::cost:
      return put(out, p.microseconds * scale);
  }
}

void LayerRecorder::finish(const Cell& cell, int samples) {
  const float scale = 1.0f / float(samples);
  for (int y = cell.y0; y < cell.y1; ++y)
    for (int x = cell.x0; x < cell.x1; ++x) {
      const auto in_cell = size_t((y - cell.y0) * kCellSize + (x - cell.x0));
      const size_t at = size_t(y) * size_t(image_width_) + size_t(x);
      const Pixel& p = pixels_[in_cell];
      auto image = images_.begin();
      for (const Layer layer : layers_) {
        if (layer == Layer::lights) {
          for (size_t k = 0; k < scene_.lights.size(); ++k)
            put(&(image++)->floats[3 * at], by_light_[in_cell * scene_.lights.size() + k] * scale);
          continue;
        }
        if (is_crypto(layer)) {
          std::vector<Coverage> ranked = p.mattes[crypto_index(layer)];
          for (Coverage& matte : ranked) matte.coverage *= scale;
          rank(ranked);
          for (size_t k = 0; k < kCryptoImages; ++k) put(ranked, k, &(image++)->floats[4 * at]);
          continue;
        }
        store(p, layer, scale, *image++, at);
      }
    }
}

}  // namespace alhazen
