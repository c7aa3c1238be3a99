// EXT_lights_image_based: a scene's light from all around.
#pragma once

#include <optional>

#include "loaders/gltf_accessor.h"
#include "loaders/gltf_source.h"
#include "renderer/environment.h"

namespace alhazen {

/// The environment of a scene, if it has one: JPEG and PNG images are sRGB-encoded, those of four channels RGBD (colour
/// divided by alpha once it is linear), others as they are. Without images that can be decoded there is no light, and a
/// warning. Throws LoadError for faces that are not square and of one size.
[[nodiscard]] std::optional<Environment> read_environment(GltfSource& source, const GltfBuffers& buffers,
                                                          std::optional<size_t> scene);

}  // namespace alhazen
