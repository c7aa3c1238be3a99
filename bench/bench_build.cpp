// Making a scene ready for rays: ours beside bare Embree with the same settings, all threads.
#include <memory>

#include "accel/accelerated_scene.h"
#include "bench/baseline.h"
#include "bench/pairs.h"
#include "bench/scenes.h"

namespace alhazen {
namespace {

void register_build(const std::string& scene, const std::string& embree, const std::string& ours, size_t primitives,
                    const std::function<Geometry()>& make) {
  const auto prepare = [=](const auto& build) {
    const auto geometry = std::make_shared<const Geometry>(make());
    return Work{[=] { build(*geometry); }, double(primitives)};
  };
  register_pair({"build/" + scene + "/" + embree, "build/" + scene + "/" + ours, "Mprim/s",
                 [=] { return prepare([](const Geometry& g) { EmbreeBaseline{g}; }); },
                 [=] { return prepare([](const Geometry& g) {
                         AcceleratedScene{g, {}};
                       }); }});
}

Geometry hill_scene(int cells) {
  Geometry geometry;
  geometry.meshes.push_back({"hills", {hills(cells)}});
  geometry.mesh_instances.push_back({0, 0, {}});
  return geometry;
}

[[maybe_unused]] const bool registered = [] {
  register_build("triangles/1000000", "embree", "alhazen", 1'000'000, [] { return hill_scene(707); });
  register_build("sphere/1000000", "embree_builtin", "user_geometry", 1'000'000,
                 [] { return sphere_field(1'000'000); });
  return true;
}();

}  // namespace
}  // namespace alhazen
