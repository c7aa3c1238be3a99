// ALHAZEN_materials_measured: the files that materials name.
#pragma once

#include <span>
#include <vector>

#include "loaders/gltf_source.h"

namespace alhazen {

/// What the URIs stand for, as `resolve_uri` confines them. Throws LoadError at a URI whose file cannot be read or is
/// no measured BRDF.
[[nodiscard]] std::vector<MeasuredBrdf> read_measured(const GltfSource& source, std::span<const JsonRef> uris);

}  // namespace alhazen
