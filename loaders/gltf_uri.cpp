#include "loaders/gltf_uri.h"

#include <algorithm>
#include <array>
#include <charconv>

namespace alhazen {
namespace {

namespace fs = std::filesystem;

constexpr int8_t kInvalid = -1;

/// The value of each base64 digit, of the URL-safe alphabet too.
constexpr std::array<int8_t, 256> kBase64 = [] {
  std::array<int8_t, 256> table{};
  table.fill(kInvalid);
  int8_t next = 0;
  for (char c = 'A'; c <= 'Z'; ++c) table[uint8_t(c)] = next++;
  for (char c = 'a'; c <= 'z'; ++c) table[uint8_t(c)] = next++;
  for (char c = '0'; c <= '9'; ++c) table[uint8_t(c)] = next++;
  table['+'] = table['-'] = 62;
  table['/'] = table['_'] = 63;
  return table;
}();

Bytes data_of(const JsonRef& uri, std::string_view text) {
  const size_t comma = text.find(',');
  if (comma == std::string_view::npos) uri.fail("expected a comma in the data URI");
  const std::string_view data = text.substr(comma + 1);
  if (!text.substr(0, comma).ends_with(";base64")) {
    const std::string raw = decode_percent(data);
    return {raw.begin(), raw.end()};
  }
  auto bytes = decode_base64(data);
  if (!bytes) uri.fail("expected base64 in the data URI");
  return std::move(*bytes);
}

/// RFC 3986: letters, digits, + - . before the first colon. A scheme makes it no file of ours.
bool has_scheme(std::string_view text) {
  const size_t colon = text.find(':');
  if (colon == std::string_view::npos || colon == 0) return false;
  return std::all_of(text.begin(), text.begin() + ptrdiff_t(colon),
                     [](unsigned char c) { return std::isalnum(c) != 0 || c == '+' || c == '-' || c == '.'; });
}

bool lies_in(const fs::path& folder, const fs::path& target) {
  return std::mismatch(folder.begin(), folder.end(), target.begin(), target.end()).first == folder.end();
}

}  // namespace

std::optional<Bytes> decode_base64(std::string_view text) {
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  Bytes out;
  out.reserve(text.size() / 4 * 3 + 2);
  uint32_t word = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '\n' || c == '\r') continue;
    const int8_t digit = kBase64[uint8_t(c)];
    if (digit == kInvalid) return std::nullopt;
    word = word << 6 | uint32_t(digit);
    if ((bits += 6) >= 8) out.push_back(uint8_t(word >> (bits -= 8)));
  }
  return out;
}

std::string decode_percent(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (size_t i = 0; i < text.size(); ++i) {
    uint8_t byte = 0;
    const char* digits = text.data() + i + 1;
    if (text[i] == '%' && i + 2 < text.size() && std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2) {
      out += char(byte);
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out;
}

std::optional<Bytes> resolve_uri(const JsonRef& uri, const fs::path& folder, LoadBudget& budget) {
  const auto& text = uri.value().get_ref<const std::string&>();
  if (text.starts_with("data:")) {
    budget.take(uri, text.size());
    return data_of(uri, text);
  }
  if (has_scheme(text)) return std::nullopt;
  const std::string name = decode_percent(text);
  if (name.empty() || name.find('\0') != std::string::npos) uri.expected("the name of a file");
  if (name.front() == '/') uri.expected("a path relative to the scene's folder");
  std::error_code error;
  const fs::path root = fs::canonical(folder, error);
  const fs::path target = error ? fs::path{} : fs::weakly_canonical(root / name, error);
  if (error) return std::nullopt;
  if (!lies_in(root, target)) uri.fail("`" + name.substr(0, 80) + "` lies outside the scene's folder");
  return read_file(target, budget);
}

}  // namespace alhazen
