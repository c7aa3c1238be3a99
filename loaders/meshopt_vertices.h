// Version 1 of meshoptimizer's vertex codec, which KHR_meshopt_compression brought and libraries before 0.23 lack.
#pragma once

#include <optional>
#include <span>

#include "loaders/gltf_document.h"

namespace alhazen {

/// Whether the stream says that it is of version 1.
[[nodiscard]] bool is_version_1(std::span<const uint8_t> stream);

/// `count` elements of `stride` bytes, a multiple of 4 up to 256; none for a stream that is malformed. The caller has
/// bounded count x stride.
///
/// source: KHR_meshopt_compression, appendix A, mode 0.
[[nodiscard]] std::optional<Bytes> decode_vertices_1(std::span<const uint8_t> stream, size_t count, size_t stride);

}  // namespace alhazen
