// What a URI in a glTF file stands for: inline data, or a file in the scene's folder.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "loaders/gltf_document.h"

namespace alhazen {

/// The bytes behind the URI `uri` of a scene in `folder`; none where there is no such file to be read.
///
/// data: URIs of any media type, base64 or percent-encoded. Other schemes are never followed. File names are
/// percent-decoded once and must stay in the folder: an absolute path, one that leaves it by `..` or by a symbolic
/// link, and anything but a regular file are refused. Throws LoadError at `uri` for what is malformed or leaves the
/// folder, and for more bytes than the budget has.
[[nodiscard]] std::optional<Bytes> resolve_uri(const JsonRef& uri, const std::filesystem::path& folder,
                                               LoadBudget& budget);

[[nodiscard]] std::optional<Bytes> decode_base64(std::string_view text);
/// %41 -> A; what is no escape stays as it is.
[[nodiscard]] std::string decode_percent(std::string_view text);

}  // namespace alhazen
