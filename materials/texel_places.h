// Where the texels of a look-up lie: wrapping, mip levels, neighbours and their weights.
#pragma once

#include "materials/texture.h"

namespace alhazen {

/// Finds the texels of an image that a use of it mixes; the lookup's key is left to the caller.
template <class F>
void find_texels(const TextureImage& image, const Texture& sampler, const TextureUse& use,
                 const BasicSurfaceInputs<F>& inputs, TextureLookup<F>& lookup) noexcept;

}  // namespace alhazen
