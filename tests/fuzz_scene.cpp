// From the bytes of a file to a scene that rays can be traced in: whatever the bytes are, a scene or a LoadError.
//
// Linked with libFuzzer where ALHAZEN_FUZZ asks for it; else each file that the command line names is tried once.
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "accel/accelerated_scene.h"
#include "core/error.h"
#include "loaders/gltf.h"
#include "loaders/image_decode.h"
#include "renderer/render.h"

namespace alhazen {
namespace {

constexpr LoadLimits kLimits{.memory = 64 << 20, .json = 1 << 20, .image_pixels = 1 << 18, .node_depth = 256};

/// What URIs name is sought in here: an empty folder.
const std::filesystem::path& folder() {
  static const std::filesystem::path path = [] {
    std::string name = (std::filesystem::temp_directory_path() / "alhazen_fuzz_XXXXXX").string();
    if (!::mkdtemp(name.data())) std::abort();
    std::atexit([] { std::filesystem::remove(folder()); });
    return std::filesystem::path(name);
  }();
  return path;
}

void build(LoadedScene& loaded) {
  decode_textures(loaded, {});
  Scene& scene = loaded.scene;
  bake_single_instances(scene.geometry);
  const Camera camera = scene.cameras.empty() ? framing_camera(scene.geometry, 1) : scene.cameras[0];
  std::vector<Opacity> opacity;
  const SurfaceFilter filter = surface_filter(scene, opacity);
  const AcceleratedScene accelerated(scene.geometry, filter, {.threads = 1});
  const RenderOptions picture{.width = 2, .height = 2, .max_depth = 2, .threads = 1};
  RenderControl control;
  (void)render(scene, accelerated, camera, picture, control);
}

void try_bytes(std::vector<uint8_t> bytes) {
  try {
    LoadedScene loaded =
        load_gltf(std::move(bytes), folder() / "scene.gltf", {}, {}, std::make_shared<LoadBudget>(kLimits));
    build(loaded);
  } catch (const Error&) {
  }
}

}  // namespace
}  // namespace alhazen

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  alhazen::try_bytes({data, data + size});
  return 0;
}

#ifdef ALHAZEN_LIBFUZZER
// ---- Mutations that keep the container and the JSON valid: bytes alone seldom get past the parser ----

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t max_size);

namespace alhazen {
namespace {

using nlohmann::json;
using Random = std::minstd_rand;

constexpr uint32_t kGlb = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;

/// A value of the document, each about as likely.
json& pick(json& root, Random& random) {
  json* at = &root;
  while (at->is_structured() && !at->empty() && random() % 8 != 0) {
    auto child = at->begin();
    std::advance(child, ptrdiff_t(random() % at->size()));
    at = &*child;
  }
  return *at;
}

json odd_number(const json& old, Random& random) {
  static const json kOdd[] = {0,          1,    -1,   2,    3,     4,    255, 65535, 65536, 5121, 5125, 5126,
                              4294967295, 1e38, 1e39, 1e-9, 1e300, -0.0, 0.5, 256,   16,    4096, 12,   4000000000};
  const double v = old.is_number() ? old.get<double>() : 0;
  switch (random() % 4) {
    case 0:
      return v + 1;
    case 1:
      return v - 1;
    default:
      return kOdd[random() % std::size(kOdd)];
  }
}

void mutate_text(std::string& text, Random& random) {
  const size_t data = text.find(";base64,");
  const size_t from = data == std::string::npos ? 0 : data + 8;
  for (int k = 0; k < 3 && from < text.size(); ++k)
    text[from + random() % (text.size() - from)] = "ABCDEFghijkl01/+xyzSTUV9="[random() % 25];
}

void mutate(json& root, Random& random) {
  json& value = pick(root, random);
  switch (random() % 6) {
    case 0:
      value = pick(root, random);
      return;
    case 1:
      if (value.is_array() && !value.empty()) value.push_back(json(value[random() % value.size()]));
      return;
    case 2:
      if (value.is_structured() && !value.empty()) {
        auto at = value.begin();
        std::advance(at, ptrdiff_t(random() % value.size()));
        value.erase(at);
      }
      return;
    default:
      if (value.is_string())
        mutate_text(value.get_ref<std::string&>(), random);
      else if (!value.is_structured())
        value = odd_number(value, random);
  }
}

uint32_t word_at(const uint8_t* data) {
  uint32_t word = 0;
  std::memcpy(&word, data, sizeof word);
  return word;
}

void append_chunk(std::string& out, uint32_t kind, std::string bytes, char padding) {
  bytes.resize((bytes.size() + 3) / 4 * 4, padding);
  const uint32_t head[2] = {uint32_t(bytes.size()), kind};
  out.append(reinterpret_cast<const char*>(head), sizeof head).append(bytes);
}

struct Container {
  bool glb = false;
  std::string text, bin;
};

Container opened(const uint8_t* data, size_t size) {
  Container c;
  c.glb = size >= 20 && word_at(data) == kGlb && word_at(data + 12) <= size - 20;
  if (!c.glb) return {false, std::string(data, data + size), ""};
  const size_t json_size = word_at(data + 12), bin = 20 + json_size;
  c.text.assign(data + 20, data + bin);
  if (size >= bin + 8) c.bin.assign(data + bin + 8, data + size);
  return c;
}

std::string closed(const Container& c) {
  if (!c.glb) return c.text;
  std::string chunks;
  append_chunk(chunks, kJsonChunk, c.text, ' ');
  if (!c.bin.empty()) append_chunk(chunks, kBinChunk, c.bin, '\0');
  const uint32_t head[3] = {kGlb, 2, uint32_t(12 + chunks.size())};
  return std::string(reinterpret_cast<const char*>(head), sizeof head) + chunks;
}

}  // namespace
}  // namespace alhazen

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned seed) {
  using namespace alhazen;
  Random random(seed);
  Container container = opened(data, size);
  json root = json::parse(container.text, nullptr, false);
  if (root.is_discarded() || random() % 10 == 0) return LLVMFuzzerMutate(data, size, max_size);
  if (!container.bin.empty() && random() % 3 == 0) {
    const size_t n = container.bin.size();
    LLVMFuzzerMutate(reinterpret_cast<uint8_t*>(container.bin.data()), n, n);
  } else {
    for (unsigned k = 0; k <= random() % 4; ++k) mutate(root, random);
    container.text = root.dump(-1, ' ', false, json::error_handler_t::replace);
  }
  const std::string out = closed(container);
  if (out.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
  std::copy(out.begin(), out.end(), data);
  return out.size();
}

#else

/// Files, and all that lie in folders.
int main(int argc, char** argv) {
  namespace fs = std::filesystem;
  std::vector<fs::path> files;
  for (int i = 1; i < argc; ++i) {
    if (!fs::is_directory(argv[i])) files.emplace_back(argv[i]);
    if (fs::is_directory(argv[i]))
      for (const auto& entry : fs::directory_iterator(argv[i]))
        if (entry.is_regular_file()) files.push_back(entry.path());
  }
  for (const fs::path& file : files) {
    std::printf("%s\n", file.c_str());
    std::fflush(stdout);
    std::ifstream in(file, std::ios::binary);
    const std::vector<char> bytes(std::istreambuf_iterator<char>(in), {});
    LLVMFuzzerTestOneInput(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
  }
  std::printf("%zu files\n", files.size());
  return files.empty() ? 1 : 0;
}

#endif
