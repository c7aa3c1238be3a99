#include "loaders/gltf_file.h"

#include <algorithm>

#include "loaders/gltf_choice.h"
#include "loaders/gltf_environment.h"
#include "loaders/gltf_examine.h"
#include "loaders/gltf_material.h"
#include "loaders/gltf_measured.h"
#include "loaders/gltf_scene.h"
#include "loaders/gltf_shapes.h"
#include "loaders/gltf_texture.h"

namespace alhazen {
namespace {

/// Without a time, only an animation that is asked for is played.
std::string animation_to_play(const TimeChoice& choice) {
  return choice.animation.empty() && !choice.time ? "none" : choice.animation;
}

/// Those that show a mesh which moves have a new place, the others the one that they had, perhaps baked.
void keep_places(const std::vector<char>& moving, const MeshInstances& before, MeshInstances& now) {
  const auto find_still = [&](const MeshInstances& all, size_t i) {
    while (i < all.size() && moving[all.mesh_of(i)]) ++i;
    return i;
  };
  size_t old = find_still(before, 0);
  for (size_t i = find_still(now, 0); i < now.size(); i = find_still(now, i + 1)) {
    const Affine3d place = before.world_from_object(old);
    if (now.world_from_object(i) != place) now.place(i, place);
    old = find_still(before, old + 1);
  }
}

GltfSource source_of(std::vector<uint8_t> bytes, const std::filesystem::path& file, const WarningSink& warn,
                     const std::shared_ptr<LoadBudget>& budget) {
  budget->take_file(file.string(), bytes.size());
  return check_gltf_source(parse_gltf_document(keep(std::move(bytes)), file, *budget), warn, budget);
}

}  // namespace

struct GltfFile::Impl {
  GltfSource source;
  std::optional<size_t> scene_index, variant;
  GltfBuffers buffers;
  std::vector<Channel> channels;
  Forest forest;
  std::vector<uint32_t> shown;
  Movement moves;
  std::vector<Skin> skins;
  DeformationPlan plan;
  std::vector<std::vector<GltfPrimitive>> deformable;  // by mesh
  std::vector<char> moving, deforming;                 // by Geometry's mesh
  std::vector<Affine3d> world_from_node;               // at the time of the pose

  Impl(GltfSource checked, const SceneChoice& choice, const TimeChoice& time)
      : source(std::move(checked)),
        scene_index(choose_scene(source, choice.scene)),
        variant(choose_variant(source, choice.variant)),
        buffers(source),
        channels(read_channels(source, buffers, animation_to_play(time))),
        forest(read_forest(source)),
        shown(scene_nodes(source, forest, scene_index)),
        moves(movement(source, forest, channels)),
        skins(read_skins(source, buffers)),
        plan(plan_deformations(source, shown, moves)) {}

  void pose(double seconds) {
    write_pose(channels, seconds, source.document.json.root);
    world_from_node = world_from_nodes(source, forest);
  }

  void place(Scene& scene, bool counted) {
    read_scene(source, buffers, {scene_index, forest, shown, world_from_node, plan, counted}, scene);
  }

  /// As meshes have to be ready for them: an anisotropy that grows from 0 wants tangents before it does.
  [[nodiscard]] std::vector<Material> at_their_most(std::vector<Material> materials) const {
    for (const Channel& channel : channels)
      if (channel.target[0] == "materials" && channel.target.back() == "anisotropyStrength")
        materials[std::stoul(channel.target[1])].anisotropy.strength = 1;
    return materials;
  }

  void read_all_meshes(Scene& scene) {
    GltfMeshes read = read_meshes(source, buffers, at_their_most(scene.materials), variant, plan.deformable);
    deformable = std::move(read.deformable);
    scene.geometry.meshes = std::move(read.meshes);
    scene.geometry.meshes.resize(plan.mesh_count);
    deforming.assign(plan.mesh_count, 0);
    for (const Deformation& how : plan.all) deforming[how.placed_as] = how.moves;
    moving = deforming;
    for (const uint32_t node : shown)
      if (plan.mesh_of_node[node] != kNone && moves.nodes[node]) moving[plan.mesh_of_node[node]] = 1;
  }

  /// Of the meshes that nodes show deformed, those that are wanted.
  template <class Wanted>
  void deform(Scene& scene, const Wanted& wanted) {
    const std::vector<Material> materials = at_their_most(scene.materials);
    const std::vector<uint32_t> uses = uses_of_meshes(scene.geometry);
    for (const Deformation& how : plan.all) {
      if (uses[how.placed_as] == 0 || !wanted(how)) continue;
      scene.geometry.meshes[how.placed_as] =
          deformed(source, deformable[how.mesh], how, skins, world_from_node, materials);
    }
  }
};

GltfFile::GltfFile(const std::filesystem::path& file, const WarningSink& warn, const SceneChoice& choice,
                   const TimeChoice& time, const std::shared_ptr<LoadBudget>& budget)
    : impl_(std::make_unique<Impl>(read_gltf_source(file, warn, budget), choice, time)) {}

GltfFile::GltfFile(std::vector<uint8_t> bytes, const std::filesystem::path& file, const WarningSink& warn,
                   const SceneChoice& choice, const TimeChoice& time, const std::shared_ptr<LoadBudget>& budget)
    : impl_(std::make_unique<Impl>(source_of(std::move(bytes), file, warn, budget), choice, time)) {}

GltfFile::~GltfFile() = default;

LoadedScene GltfFile::load(double seconds) {
  Impl& impl = *impl_;
  impl.pose(seconds);
  LoadedScene loaded;
  loaded.extensions = impl.source.extensions;
  loaded.budget = impl.source.budget;
  Scene& scene = loaded.scene;
  GltfMaterials materials = read_materials(impl.source);
  GltfTextures textures = read_textures(impl.source, impl.buffers, materials);
  loaded.encoded = std::move(textures.images);
  scene.images.resize(loaded.encoded.size());
  scene.textures = std::move(textures.textures);
  scene.measured = read_measured(impl.source, materials.measured);
  scene.materials = std::move(materials.materials);
  if (const auto shapes = impl.source.root().extension("ALHAZEN_shapes"))
    scene.geometry.shapes = read_shapes(*shapes, *impl.source.budget);
  impl.read_all_meshes(scene);
  check_deformations(impl.source, impl.deformable, impl.skins, impl.plan);
  for (const tinygltf::Node& node : impl.source.model.nodes) scene.node_names.push_back(node.name);
  impl.place(scene, false);
  scene.environment = read_environment(impl.source, impl.buffers, impl.scene_index);
  impl.deform(scene, [](const Deformation&) { return true; });
  return loaded;
}

void GltfFile::move(Scene& scene, double seconds) {
  Impl& impl = *impl_;
  impl.pose(seconds);
  if (impl.moves.materials) scene.materials = read_materials(impl.source).materials;
  Scene now;
  now.materials.resize(scene.materials.size());
  impl.place(now, true);
  keep_places(impl.moving, scene.geometry.mesh_instances, now.geometry.mesh_instances);
  scene.geometry.mesh_instances = std::move(now.geometry.mesh_instances);
  scene.geometry.shape_instances = std::move(now.geometry.shape_instances);
  scene.geometry.motion = {};
  scene.lights = std::move(now.lights), scene.cameras = std::move(now.cameras);
  scene.camera_index = std::move(now.camera_index);
  scene.ambient = now.ambient, scene.has_ambient = now.has_ambient;
  scene.background = now.background, scene.has_background = now.has_background;
  impl.deform(scene, [&](const Deformation& how) { return impl.moving[how.placed_as] != 0; });
}

void GltfFile::examine() { examine_gltf(impl_->source, impl_->buffers); }

std::span<const char> GltfFile::moving_meshes() const { return impl_->moving; }

std::span<const char> GltfFile::deforming_meshes() const { return impl_->deforming; }

std::span<const char> GltfFile::moving_nodes() const { return impl_->moves.nodes; }

bool GltfFile::is_animated() const { return !impl_->channels.empty(); }

bool GltfFile::has_images() const { return !impl_->source.root().elements("images").empty(); }

std::pair<double, double> GltfFile::time_span() const {
  const TimeSpan span = alhazen::time_span(impl_->channels);
  return {span.first, span.last};
}

std::vector<std::string> GltfFile::animation_names() const {
  std::vector<std::string> names;
  for (const JsonRef& r : impl_->source.root().elements("animations")) names.push_back(r.get("name", std::string{}));
  return names;
}

size_t GltfFile::skin_count() const { return impl_->skins.size(); }

LoadedScene load_gltf(const std::filesystem::path& file, const WarningSink& warn, const SceneChoice& choice,
                      const std::shared_ptr<LoadBudget>& budget) {
  return GltfFile(file, warn, choice, {}, budget).load(0);
}

LoadedScene load_gltf(std::vector<uint8_t> bytes, const std::filesystem::path& file, const WarningSink& warn,
                      const SceneChoice& choice, const std::shared_ptr<LoadBudget>& budget) {
  return GltfFile(std::move(bytes), file, warn, choice, {}, budget).load(0);
}

}  // namespace alhazen
