// What a glTF file may say: the type, range and target of everything that is read from it.
#pragma once

#include "loaders/json_ref.h"

namespace alhazen {

/// Throws LoadError at the first value of the core, of a supported KHR extension or of an ALHAZEN extension that has
/// the wrong type, is out of its range or refers to nothing. Properties that are never read may be anything.
void check_gltf(const JsonRef& root);

}  // namespace alhazen
