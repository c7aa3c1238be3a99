#include "loaders/gltf_document.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string_view>

#include "core/error.h"
#include "loaders/in_parallel.h"

namespace alhazen {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kMaxDepth = 64;
constexpr uint64_t kValueBytes = 128;  // what a value of JSON takes, and its copy for tinygltf
constexpr size_t kGlbHeader = 12, kChunkHeader = 8;
constexpr uint32_t kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;

struct Chunk {
  uint32_t type;
  std::span<const uint8_t> bytes;
};

/// The chunks of a GLB; what follows its declared length is ignored.
std::vector<Chunk> glb_chunks(const std::string& name, std::span<const uint8_t> file) {
  const auto fail = [&](const std::string& reason) { throw LoadError(name, "", reason); };
  const auto word = [&](size_t at) {
    uint32_t w;
    std::memcpy(&w, file.data() + at, sizeof w);
    return w;
  };
  if (file.size() < kGlbHeader + kChunkHeader)
    fail("expected a GLB header, found only " + std::to_string(file.size()) + " bytes");
  if (word(4) != 2) fail("expected GLB version 2, found " + std::to_string(word(4)));
  const size_t end = word(8);
  if (end > file.size())
    fail("expected a GLB of " + std::to_string(end) + " bytes, found " + std::to_string(file.size()));
  std::vector<Chunk> chunks;
  for (size_t at = kGlbHeader; at + kChunkHeader <= end;) {
    const size_t length = word(at), begin = at + kChunkHeader;
    if (length > end - begin)
      fail("GLB chunk " + std::to_string(chunks.size()) + " of " + std::to_string(length) + " bytes exceeds the file");
    chunks.push_back({word(at + 4), file.subspan(begin, length)});
    at = begin + (length + 3) / 4 * 4;
  }
  if (chunks.empty() || chunks[0].type != kJsonChunk) fail("expected JSON as the GLB's first chunk");
  return chunks;
}

struct JsonSize {
  int depth = 0;        // of brackets; counted no further than kMaxDepth + 1
  uint64_t values = 0;  // at most
};

JsonSize size_of(std::string_view text) {
  int depth = 0;
  bool quoted = false;
  JsonSize size;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c == '\\') ++i;
      if (c == '"') quoted = false;
    } else if (c == '"') {
      quoted = true;
    } else if (c == '[' || c == '{') {
      ++size.values;
      size.depth = std::max(size.depth, ++depth);
      if (depth > kMaxDepth) break;
    } else if (c == ']' || c == '}') {
      --depth;
    } else if (c == ',') {
      ++size.values;
    }
  }
  return size;
}

/// 3.0 is the integer 3, as JSON Schema has it.
void make_integral(json& value) {
  constexpr double kExact = 9007199254740992.0;  // 2^53
  if (value.is_number_float()) {
    const double d = value.get<double>();
    if (d >= 0 && d < kExact && d == std::floor(d)) value = uint64_t(d);
  } else if (value.is_structured()) {
    for (json& element : value) make_integral(element);
  }
}

json parse_json(const std::string& name, std::string_view text, LoadBudget& budget) {
  while (!text.empty() && text.back() == '\0') text.remove_suffix(1);  // padding of some GLB writers
  if (text.size() > budget.limits().json)
    throw LoadError(name, "",
                    "its JSON takes " + memory_text(text.size()) + ", expected at most " +
                        memory_text(budget.limits().json) + "; --max-json raises the limit");
  const JsonSize size = size_of(text);
  if (size.depth > kMaxDepth)
    throw LoadError(name, "", "its JSON is nested more than " + std::to_string(kMaxDepth) + " deep");
  budget.take(name, text.size() + kValueBytes * size.values);
  try {
    json root = json::parse(text);
    make_integral(root);
    return root;
  } catch (const json::exception& error) {
    const std::string what = error.what();
    const size_t cut = what.find("] ");  // the library's own numbering of its errors
    throw LoadError(name, "", "not valid JSON: " + (cut == std::string::npos ? what : what.substr(cut + 2)));
  }
}

struct OpenFile {
  int descriptor;
  explicit OpenFile(const fs::path& path) : descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}
  ~OpenFile() {
    if (descriptor >= 0) ::close(descriptor);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
};

/// False where the file ends before.
bool read_at(int file, size_t offset, std::span<uint8_t> into) {
  while (!into.empty()) {
    const ssize_t read = ::pread(file, into.data(), into.size(), off_t(offset));
    if (read < 0 && errno == EINTR) continue;
    if (read <= 0) return false;
    offset += size_t(read), into = into.subspan(size_t(read));
  }
  return true;
}

/// `read_file` for files that may be large: memory is not set to 0 first, and processors share the copying.
std::optional<KeptBytes> read_in_parallel(const fs::path& path, LoadBudget& budget) {
  constexpr size_t kPiece = size_t{1} << 22;
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return std::nullopt;
  const size_t size = fs::file_size(path, error);
  const OpenFile file(path);
  if (error || file.descriptor < 0) return std::nullopt;
  budget.take_file(path.string(), size);
  const std::shared_ptr<uint8_t[]> bytes(new uint8_t[size]);
  std::atomic<bool> complete{true};
  for_each_in_parallel((size + kPiece - 1) / kPiece, [&](size_t piece) {
    const size_t first = piece * kPiece;
    if (!read_at(file.descriptor, first, {bytes.get() + first, std::min(kPiece, size - first)})) complete = false;
  });
  if (!complete) return std::nullopt;
  return KeptBytes{bytes, {bytes.get(), size}};
}

}  // namespace

std::optional<Bytes> read_file(const fs::path& path, LoadBudget& budget) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return std::nullopt;
  const auto size = fs::file_size(path, error);
  std::ifstream in(path, std::ios::binary);
  if (!in || error) return std::nullopt;
  budget.take_file(path.string(), size);
  Bytes bytes(size);
  if (size && !in.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(size))) return std::nullopt;
  return bytes;
}

KeptBytes keep(Bytes bytes) {
  const auto keeper = std::make_shared<const Bytes>(std::move(bytes));
  return {keeper, *keeper};
}

GltfDocument parse_gltf_document(KeptBytes file, const fs::path& path, LoadBudget& budget) {
  const auto text_of = [](std::span<const uint8_t> s) {
    return std::string_view(reinterpret_cast<const char*>(s.data()), s.size());
  };
  const std::string name = path.string();
  GltfDocument document;
  document.json.file = name;
  document.folder = fs::absolute(path).parent_path();
  if (!text_of(file.bytes).starts_with("glTF")) {
    document.json.root = parse_json(name, text_of(file.bytes), budget);
    return document;
  }
  document.file = std::move(file);
  const std::vector<Chunk> chunks = glb_chunks(name, document.file.bytes);
  document.json.root = parse_json(name, text_of(chunks[0].bytes), budget);
  if (chunks.size() > 1 && chunks[1].type == kBinChunk) document.bin = chunks[1].bytes;
  return document;
}

GltfDocument read_gltf_document(const fs::path& path, LoadBudget& budget) {
  auto bytes = read_in_parallel(path, budget);
  if (!bytes) throw LoadError(path.string(), "", "cannot be read, expected a .gltf or .glb file");
  return parse_gltf_document(std::move(*bytes), path, budget);
}

}  // namespace alhazen
