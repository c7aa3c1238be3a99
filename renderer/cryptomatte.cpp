#include "renderer/cryptomatte.h"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <set>

namespace alhazen {
namespace {

std::string hex(uint32_t v) {
  char text[9];
  std::snprintf(text, sizeof text, "%08x", v);
  return text;
}

uint32_t scrambled(uint32_t k) { return std::rotl(k * 0xcc9e2d51u, 15) * 0x1b873593u; }

std::string json_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < 32) {
      char escaped[8];
      std::snprintf(escaped, sizeof escaped, "\\u%04x", unsigned(c));
      out += escaped;
    } else {
      if (c == '"' || c == '\\') out += '\\';
      out += c;
    }
  }
  return out + "\"";
}

}  // namespace

uint32_t name_hash(std::string_view name) noexcept {
  uint32_t h = 0;
  const auto byte = [&](size_t i) { return uint32_t(static_cast<unsigned char>(name[i])); };
  size_t i = 0;
  for (; i + 4 <= name.size(); i += 4) {
    h ^= scrambled(byte(i) | byte(i + 1) << 8 | byte(i + 2) << 16 | byte(i + 3) << 24);
    h = std::rotl(h, 13) * 5 + 0xe6546b64u;
  }
  uint32_t tail = 0;
  for (size_t k = name.size(); k > i; --k) tail = tail << 8 | byte(k - 1);
  h ^= scrambled(tail);
  h ^= uint32_t(name.size());
  h = (h ^ h >> 16) * 0x85ebca6bu;
  h = (h ^ h >> 13) * 0xc2b2ae35u;
  return h ^ h >> 16;
}

float name_id(std::string_view name) noexcept {
  uint32_t bits = name_hash(name);
  const uint32_t exponent = bits >> 23 & 255;
  if (exponent == 0 || exponent == 255) bits ^= 1u << 23;
  return std::bit_cast<float>(bits);
}

void cover(std::vector<Coverage>& pixel, float id, float coverage) {
  const auto at = std::ranges::find(pixel, id, &Coverage::id);
  if (at != pixel.end())
    at->coverage += coverage;
  else
    pixel.push_back({id, coverage});
}

void rank(std::vector<Coverage>& pixel) {
  std::ranges::stable_sort(pixel, std::ranges::greater{}, &Coverage::coverage);
}

std::vector<std::pair<std::string, std::string>> cryptomatte_metadata(const std::string& layer,
                                                                      const std::vector<std::string>& names) {
  std::string manifest;
  for (const std::string& name : std::set(names.begin(), names.end()))
    manifest +=
        (manifest.empty() ? "{" : ",") + json_string(name) + ":\"" + hex(std::bit_cast<uint32_t>(name_id(name))) + "\"";
  const std::string key = "cryptomatte/" + hex(name_hash(layer)).substr(0, 7) + "/";
  return {{key + "name", layer},
          {key + "hash", "MurmurHash3_32"},
          {key + "conversion", "uint32_to_float32"},
          {key + "manifest", manifest.empty() ? "{}" : manifest + "}"}};
}

}  // namespace alhazen
