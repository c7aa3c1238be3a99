#include "procedural/nff_reader.h"

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "core/error.h"

namespace alhazen {
namespace {

constexpr size_t kMostVertices = 1 << 20;

/// The file's words, with the line on which the last one stood. Lines that start with # say nothing.
class NffWords {
 public:
  NffWords(std::istream& in, std::string name) : in_(in), name_(std::move(name)) {}

  [[noreturn]] void fail(const std::string& reason) const {
    throw LoadError(name_, "line " + std::to_string(line_number_), reason);
  }

  /// The next word, from wherever it is.
  std::optional<std::string_view> next() {
    for (;;) {
      if (auto word = next_on_line()) return word;
      if (!std::getline(in_, line_)) return std::nullopt;
      ++line_number_, at_ = line_.starts_with('#') ? line_.size() : 0;
      if (line_.find('\0') != std::string::npos) fail("holds a byte of 0, expected the text of an NFF file");
    }
  }

  /// The next word on this line, if there is one.
  std::optional<std::string_view> next_on_line() {
    constexpr const char* kSpaces = " \t\r\f\v";
    at_ = std::min(line_.find_first_not_of(kSpaces, at_), line_.size());
    if (at_ == line_.size()) return std::nullopt;
    const size_t end = std::min(line_.find_first_of(kSpaces, at_), line_.size());
    const std::string_view word(line_.data() + at_, end - at_);
    at_ = end;
    return word;
  }

  void expect(std::string_view wanted) {
    const auto word = next();
    if (!word || *word != wanted) fail("expected '" + std::string(wanted) + "'" + found(word));
  }

  double number() { return number_in(next()); }

  std::optional<double> number_on_line() {
    const auto word = next_on_line();
    return word ? std::optional(number_in(word)) : std::nullopt;
  }

  double positive(const char* what) {
    const double x = number();
    if (!(x > 0)) fail(std::string(what) + " must be above 0");
    return x;
  }

  Vec3d vector() {
    const double x = number(), y = number(), z = number();
    return {x, y, z};
  }

  Rgb color() {
    const Vec3d c = vector();
    return {float(c.x), float(c.y), float(c.z)};
  }

  /// A whole number in [least, most].
  size_t count(size_t least, size_t most) {
    const double x = number();
    if (x != std::floor(x) || x < double(least) || x > double(most))
      fail("expected a whole number from " + std::to_string(least) + " to " + std::to_string(most));
    return size_t(x);
  }

 private:
  static std::string found(const std::optional<std::string_view>& word) {
    return word ? ", found '" + std::string(*word) + "'" : " before the end of the file";
  }

  double number_in(const std::optional<std::string_view>& word) const {
    double x = 0;
    if (!word) fail("expected a number before the end of the file");
    const char* first = word->data() + (word->starts_with('+') ? 1 : 0);
    const auto [end, error] = std::from_chars(first, word->data() + word->size(), x);
    if (error != std::errc() || end != word->data() + word->size() || !std::isfinite(x))
      fail("expected a finite number" + found(word));
    return x;
  }

  std::istream& in_;
  std::string name_, line_;
  size_t at_ = 0, line_number_ = 0;
};

NffView read_view(NffWords& words) {
  NffView view;
  words.expect("from"), view.from = words.vector();
  words.expect("at"), view.at = words.vector();
  words.expect("up"), view.up = words.vector();
  words.expect("angle"), view.angle = words.positive("the angle");
  words.expect("hither"), (void)words.number();  // does not clip
  words.expect("resolution");
  view.width = int(words.count(1, 65536)), view.height = int(words.count(1, 65536));
  if (view.angle >= 180) words.fail("the angle must be below 180 degrees");
  if (!(length(cross(view.at - view.from, view.up)) > 0)) words.fail("the view has no direction, or up is along it");
  return view;
}

NffLight read_light(NffWords& words) {
  NffLight light{words.vector()};
  if (const auto r = words.number_on_line()) {
    light.has_color = true;
    const double g = words.number(), b = words.number();
    light.color = {float(*r), float(g), float(b)};
  }
  return light;
}

NffMaterial read_material(NffWords& words) {
  NffMaterial m;
  m.color = words.color();
  m.kd = float(words.number()), m.ks = float(words.number()), m.shine = float(words.number());
  m.t = float(words.number()), m.ior = float(words.number());
  if (m.kd < 0 || m.ks < 0 || m.shine < 0 || m.t < 0) words.fail("a material's shares must not be below 0");
  return m;
}

NffCone read_cone(NffWords& words, uint32_t material) {
  NffCone cone;
  cone.base = words.vector(), cone.base_radius = words.number();
  cone.apex = words.vector(), cone.apex_radius = words.number();
  cone.material = material;
  if (cone.base_radius < 0 || cone.apex_radius < 0 || !(cone.base_radius + cone.apex_radius > 0))
    words.fail("a cone's radii must not be below 0, and one above");
  if (cone.base == cone.apex) words.fail("a cone must have a height");
  return cone;
}

NffPolygon read_polygon(NffWords& words, uint32_t material, bool with_normals) {
  NffPolygon polygon;
  polygon.material = material;
  const size_t count = words.count(3, kMostVertices);
  for (size_t i = 0; i < count; ++i) {
    polygon.vertices.push_back(words.vector());
    if (with_normals) polygon.normals.push_back(words.vector());
  }
  return polygon;
}

}  // namespace

NffScene read_nff(std::istream& in, const std::string& name) {
  NffWords words(in, name);
  NffScene scene;
  const auto material = [&] { return scene.materials.empty() ? scene.add({}) : uint32_t(scene.materials.size() - 1); };
  while (const auto entity = words.next()) {
    if (*entity == "v")
      scene.view = read_view(words);
    else if (*entity == "b")
      scene.background = words.color();
    else if (*entity == "l")
      scene.lights.push_back(read_light(words));
    else if (*entity == "f")
      scene.add(read_material(words));
    else if (*entity == "s")
      scene.spheres.push_back({words.vector(), words.positive("a radius"), material()});
    else if (*entity == "c")
      scene.cones.push_back(read_cone(words, material()));
    else if (*entity == "p" || *entity == "pp")
      scene.polygons.push_back(read_polygon(words, material(), *entity == "pp"));
    else
      words.fail("unknown entity '" + std::string(*entity) + "', expected one of v, b, l, f, s, c, p, pp");
  }
  return scene;
}

}  // namespace alhazen
