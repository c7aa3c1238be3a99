// A glTF file's container and JSON, before anything in it is believed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "loaders/json_ref.h"
#include "loaders/load_limits.h"

namespace alhazen {

using Bytes = std::vector<uint8_t>;

/// Bytes and who keeps them.
struct KeptBytes {
  std::shared_ptr<const void> keeper;
  std::span<const uint8_t> bytes;
};

struct GltfDocument {
  JsonDocument json;             // integral numbers are integers, however they were written
  std::filesystem::path folder;  // where its URIs begin
  KeptBytes file;                // of a GLB, whose chunk is seen by `bin`; else empty
  std::optional<std::span<const uint8_t>> bin;
};

/// Reads .gltf or .glb, told apart by the first bytes. Throws LoadError where the file is no regular file, its GLB
/// header or chunks are wrong, or its JSON is invalid, deeper than 64 levels or longer than the limit.
[[nodiscard]] GltfDocument read_gltf_document(const std::filesystem::path& path, LoadBudget& budget);

/// The same of bytes that are in memory already, as if they were the file's at `path`.
[[nodiscard]] GltfDocument parse_gltf_document(KeptBytes file, const std::filesystem::path& path, LoadBudget& budget);

/// For those above.
[[nodiscard]] KeptBytes keep(Bytes bytes);

/// All bytes of a regular file; none where it cannot be read. Throws LoadError where it is larger than what is left.
[[nodiscard]] std::optional<Bytes> read_file(const std::filesystem::path& path, LoadBudget& budget);

}  // namespace alhazen
