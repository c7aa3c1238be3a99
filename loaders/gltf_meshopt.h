// EXT_meshopt_compression and KHR_meshopt_compression: buffer views out of meshoptimizer's streams.
#pragma once

#include <optional>
#include <span>

#include "loaders/gltf_document.h"

namespace alhazen {

/// The extension of a buffer view, whichever of the two it has; none where the view's bytes are not compressed.
[[nodiscard]] std::optional<JsonRef> meshopt_extension(const JsonRef& buffer_view);

/// How many bytes `stream`, which the extension object `r` points to, decodes to. Throws LoadError at `r` where that is
/// more than so short a stream can hold.
[[nodiscard]] uint64_t meshopt_size(const JsonRef& r, std::span<const uint8_t> stream);

/// Decodes the stream and undoes its filter. Throws LoadError at `r` for one that is too short or malformed.
[[nodiscard]] Bytes decode_meshopt(const JsonRef& r, std::span<const uint8_t> stream);

}  // namespace alhazen
