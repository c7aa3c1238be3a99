#include "loaders/measured_file.h"

#include <algorithm>

#include "core/error.h"
#include "loaders/brdf_csv.h"
#include "loaders/gltf_document.h"
#include "loaders/merl_file.h"
#include "loaders/scattered_brdf.h"

namespace alhazen {
namespace {

constexpr size_t kFirstBytes = 12;

bool is_text(std::span<const uint8_t> file) {
  const auto first = file.first(std::min(kFirstBytes, file.size()));
  return std::find(first.begin(), first.end(), uint8_t{0}) == first.end();
}

MeasuredTable parse_table(std::span<const uint8_t> file, const std::string& place, LoadBudget& budget) {
  if (!is_text(file)) return parse_merl(file, place, budget);
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  return table_through(parse_brdf_csv(text, place, budget));
}

}  // namespace

MeasuredBrdf parse_measured_brdf(std::span<const uint8_t> file, const std::string& place, LoadBudget& budget) {
  if (file.empty()) throw LoadError(place, "", "is empty, expected a MERL file or comma-separated text");
  return make_measured_brdf(parse_table(file, place, budget));
}

MeasuredBrdf load_measured_brdf(const std::filesystem::path& file, LoadBudget& budget) {
  const auto bytes = read_file(file, budget);
  if (!bytes) throw LoadError(file.string(), "", "cannot be read, expected a MERL file or comma-separated text");
  MeasuredBrdf brdf = parse_measured_brdf(*bytes, file.string(), budget);
  brdf.name = file.filename().string();
  return brdf;
}

}  // namespace alhazen
