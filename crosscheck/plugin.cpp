#include "crosscheck/plugin.h"

#include <dlfcn.h>

#include <sstream>
#include <stdexcept>

#include "core/error.h"

namespace alhazen::crosscheck {
namespace {

/// As many finite numbers as a surface takes, no more.
std::vector<double> numbers(std::istringstream& in, const std::string& text, size_t count) {
  std::vector<double> list;
  for (double x; in >> x;) list.push_back(x);
  if (!in.eof() || list.size() != count)
    throw std::invalid_argument("'" + text + "': expected " + std::to_string(count) + " numbers after the name");
  return list;
}

void expect(bool good, const std::string& text, const char* what) {
  if (!good) throw std::invalid_argument("'" + text + "': expected " + what);
}

/// The C interface as an object.
class PluginIntersector final : public Intersector {
 public:
  explicit PluginIntersector(const alhazen_intersector& c) : c_(c) {}

  [[nodiscard]] std::string name() const override { return c_.name; }
  [[nodiscard]] std::string surface() const override { return c_.surface; }
  void bounds(float lower[3], float upper[3]) const override { c_.bounds(lower, upper); }
  [[nodiscard]] bool intersect(const alhazen_ray& ray, alhazen_hit& hit) const override {
    return c_.intersect(&ray, &hit) != 0;
  }
  void intersect_packet(const alhazen_ray* rays, int count, alhazen_hit* hits, int* found) const override {
    if (c_.intersect_packet)
      c_.intersect_packet(rays, count, hits, found);
    else
      Intersector::intersect_packet(rays, count, hits, found);
  }

 private:
  const alhazen_intersector& c_;
};

}  // namespace

Surface parse_surface(const std::string& text) {
  std::istringstream in(text);
  std::string kind;
  in >> kind;
  if (kind == "sphere") {
    const auto n = numbers(in, text, 1);
    expect(n[0] > 0, text, "a radius > 0");
    return Sphere{n[0]};
  }
  if (kind == "cylinder" || kind == "tube") {
    const auto n = numbers(in, text, 3);
    expect(n[0] > 0 && n[1] >= 0 && n[2] >= 0 && n[1] + n[2] > 0, text, "a height > 0 and radii >= 0, not both 0");
    return Cylinder{n[0], n[1], n[2], kind == "cylinder"};
  }
  if (kind == "disk") {
    const auto n = numbers(in, text, 2);
    expect(n[0] > n[1] && n[1] >= 0, text, "a radius > an inner radius >= 0");
    return Disk{n[0], n[1]};
  }
  if (kind == "box") {
    const auto n = numbers(in, text, 3);
    expect(n[0] > 0 && n[1] > 0 && n[2] > 0, text, "sizes > 0");
    return Box{{n[0], n[1], n[2]}};
  }
  if (kind == "triangle") {
    const auto n = numbers(in, text, 9);
    const Triangle t{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, {n[6], n[7], n[8]}};
    expect(cross(t.b - t.a, t.c - t.a) != Vec3d{}, text, "a triangle that has an area");
    return t;
  }
  throw std::invalid_argument("unknown surface '" + text +
                              "', expected one of sphere, cylinder, tube, disk, box, triangle");
}

void Plugin::Close::operator()(void* library) const { dlclose(library); }

Plugin::Plugin(const std::string& file) {
  // A bare name would be looked for in the system's folders.
  const std::string path = file.find('/') == std::string::npos ? "./" + file : file;
  library_.reset(dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL));
  if (!library_) throw LoadError(file, "", std::string("cannot be loaded: ") + dlerror());
  using Get = const alhazen_intersector* (*)();
  const auto get = reinterpret_cast<Get>(dlsym(library_.get(), "alhazen_get_intersector"));
  if (!get) throw LoadError(file, "", "exports no alhazen_get_intersector, see crosscheck/intersector_plugin.h");
  const alhazen_intersector* c = get();
  if (!c || c->version != ALHAZEN_INTERSECTOR_VERSION)
    throw LoadError(file, "", "is not of version " + std::to_string(ALHAZEN_INTERSECTOR_VERSION));
  if (!c->name || !c->surface || !c->bounds || !c->intersect)
    throw LoadError(file, "", "lacks a name, a surface, `bounds` or `intersect`");
  try {
    (void)parse_surface(c->surface);
  } catch (const std::invalid_argument& error) {
    throw LoadError(file, "", error.what());
  }
  intersector_ = std::make_unique<const PluginIntersector>(*c);
}

Family family_of(const Intersector& intersector) {
  return {intersector.name(), [surface = parse_surface(intersector.surface())](uint64_t, bool, Random&) {
            return Subject{surface, {}};
          }};
}

}  // namespace alhazen::crosscheck
