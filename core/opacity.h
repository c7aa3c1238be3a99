// What a ray may find at the surfaces of a material, known before any ray is traced.
#pragma once

#include <cstdint>

namespace alhazen {

enum class Opacity : uint8_t {
  opaque,       // stops every ray: traversal never asks
  transparent,  // stops camera and specular rays, lets some light through: asked by shadow rays
  cutout,       // may have holes: asked by every ray (a cutout may let light through as well)
};

}  // namespace alhazen
