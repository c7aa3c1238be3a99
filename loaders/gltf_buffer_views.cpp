#include "loaders/gltf_buffer_views.h"

#include "loaders/gltf_meshopt.h"
#include "loaders/gltf_uri.h"
#include "loaders/in_parallel.h"

namespace alhazen {
namespace {

std::string bytes_text(uint64_t n) { return std::to_string(n) + (n == 1 ? " byte" : " bytes"); }

/// What says where a view's bytes are: its extension where they are compressed, else itself.
JsonRef stored(const JsonRef& view) { return meshopt_extension(view).value_or(view); }

Bytes read_external(const JsonRef& buffer, const GltfSource& source) {
  const auto uri = buffer.find("uri");
  if (!uri) buffer.fail("`uri` is missing, and the file has no GLB chunk for this buffer");
  auto bytes = resolve_uri(*uri, source.document.folder, *source.budget);
  if (!bytes) uri->fail("cannot read `" + uri->as<std::string>().substr(0, 80) + "`");
  return std::move(*bytes);
}

std::span<const uint8_t> cut_to_length(const JsonRef& buffer, std::span<const uint8_t> all) {
  const auto length = buffer["byteLength"].as<uint64_t>();
  if (all.size() < length)
    buffer["byteLength"].fail("expected " + bytes_text(length) + ", the buffer has " + bytes_text(all.size()));
  return all.first(length);
}

}  // namespace

GltfBufferViews::GltfBufferViews(const GltfSource& source) {
  read_buffers(source);
  const auto views = source.root().elements("bufferViews");
  for (const JsonRef& view : views) views_.push_back(cut(stored(view)));
  decode(views, *source.budget);
}

void GltfBufferViews::read_buffers(const GltfSource& source) {
  const auto buffers = source.root().elements("buffers");
  std::vector<char> needed(buffers.size(), 0);
  for (const JsonRef& view : source.root().elements("bufferViews")) needed[stored(view)["buffer"].as<size_t>()] = 1;
  owned_.resize(buffers.size());
  buffers_.resize(buffers.size());
  for (size_t i = 0; i < buffers.size(); ++i) {
    if (!needed[i]) continue;
    const bool in_glb = i == 0 && !buffers[i].has("uri") && source.document.bin;
    if (!in_glb) owned_[i] = read_external(buffers[i], source);
    buffers_[i] = cut_to_length(buffers[i], in_glb ? *source.document.bin : std::span<const uint8_t>(owned_[i]));
  }
}

std::span<const uint8_t> GltfBufferViews::cut(const JsonRef& view) const {
  const std::span<const uint8_t> buffer = buffers_[view["buffer"].as<size_t>()];
  const auto offset = view.get("byteOffset", uint64_t{0}), length = view["byteLength"].as<uint64_t>();
  if (offset > buffer.size() || length > buffer.size() - offset)
    view.fail(bytes_text(length) + " from byte " + std::to_string(offset) + " on exceed the buffer's " +
              bytes_text(buffer.size()));
  return buffer.subspan(offset, length);
}

void GltfBufferViews::decode(const std::vector<JsonRef>& views, LoadBudget& budget) {
  std::vector<size_t> compressed;
  for (size_t i = 0; i < views.size(); ++i) {
    const auto r = meshopt_extension(views[i]);
    if (!r) continue;
    compressed.push_back(i);
    budget.take(*r, meshopt_size(*r, views_[i]));
  }
  decoded_.resize(compressed.size());
  for_each_in_parallel(compressed.size(), [&](size_t k) {
    const size_t i = compressed[k];
    decoded_[k] = decode_meshopt(*meshopt_extension(views[i]), views_[i]);
    views_[i] = decoded_[k];
  });
}

}  // namespace alhazen
