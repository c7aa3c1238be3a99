#include "loaders/gltf_measured.h"

#include "loaders/gltf_uri.h"
#include "loaders/measured_file.h"

namespace alhazen {
namespace {

constexpr size_t kLongestName = 80;

MeasuredBrdf read_one(const GltfSource& source, const JsonRef& uri) {
  const std::string name = uri.as<std::string>().substr(0, kLongestName);
  const auto bytes = resolve_uri(uri, source.document.folder, *source.budget);
  if (!bytes) uri.fail("cannot read `" + name + "`, expected a file in the scene's folder");
  MeasuredBrdf brdf = parse_measured_brdf(*bytes, uri.place() + ": " + name, *source.budget);
  brdf.name = name;
  return brdf;
}

}  // namespace

std::vector<MeasuredBrdf> read_measured(const GltfSource& source, std::span<const JsonRef> uris) {
  std::vector<MeasuredBrdf> all;
  for (const JsonRef& uri : uris) all.push_back(read_one(source, uri));
  return all;
}

}  // namespace alhazen
