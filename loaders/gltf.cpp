#include "loaders/gltf.h"

#include "loaders/gltf_accessor.h"
#include "loaders/gltf_material.h"
#include "loaders/gltf_mesh.h"
#include "loaders/gltf_scene.h"
#include "loaders/gltf_shapes.h"
#include "loaders/gltf_source.h"

namespace alhazen {

LoadedScene load_gltf(const std::filesystem::path& file, const WarningSink& warn) {
  GltfSource source = read_gltf_source(file, warn);
  const GltfBuffers buffers(source);
  LoadedScene loaded;
  loaded.extensions = source.extensions;
  Scene& scene = loaded.scene;
  loaded.encoded = read_images(source, buffers);
  scene.images.resize(loaded.encoded.size());
  scene.textures = read_textures(source);
  scene.materials = read_materials(source);
  if (const auto shapes = source.root().extension("ALHAZEN_shapes")) scene.geometry.shapes = read_shapes(*shapes);
  scene.geometry.meshes = read_meshes(source, buffers, scene.materials);
  read_scene(source, scene);
  return loaded;
}

}  // namespace alhazen
