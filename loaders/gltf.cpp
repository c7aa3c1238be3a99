#include "loaders/gltf.h"

#include "loaders/gltf_accessor.h"
#include "loaders/gltf_choice.h"
#include "loaders/gltf_material.h"
#include "loaders/gltf_mesh.h"
#include "loaders/gltf_scene.h"
#include "loaders/gltf_shapes.h"
#include "loaders/gltf_source.h"
#include "loaders/gltf_texture.h"

namespace alhazen {

LoadedScene load_gltf(const std::filesystem::path& file, const WarningSink& warn, const SceneChoice& choice) {
  GltfSource source = read_gltf_source(file, warn);
  const std::optional<size_t> scene_index = choose_scene(source, choice.scene);
  const std::optional<size_t> variant = choose_variant(source, choice.variant);
  const GltfBuffers buffers(source);
  LoadedScene loaded;
  loaded.extensions = source.extensions;
  Scene& scene = loaded.scene;
  GltfMaterials materials = read_materials(source);
  GltfTextures textures = read_textures(source, buffers, materials);
  loaded.encoded = std::move(textures.images);
  scene.images.resize(loaded.encoded.size());
  scene.textures = std::move(textures.textures);
  scene.materials = std::move(materials.materials);
  if (const auto shapes = source.root().extension("ALHAZEN_shapes")) scene.geometry.shapes = read_shapes(*shapes);
  scene.geometry.meshes = read_meshes(source, buffers, scene.materials, variant);
  read_scene(source, buffers, scene_index, scene);
  return loaded;
}

}  // namespace alhazen
