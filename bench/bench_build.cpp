// Making a scene ready for rays: ours beside bare Embree with the same settings, all threads.
#include <memory>

#include "accel/accelerated_scene.h"
#include "bench/baseline.h"
#include "bench/contest.h"
#include "bench/scenes.h"

namespace alhazen {
namespace {

void register_build(const std::string& scene, size_t primitives, const std::function<Geometry()>& make) {
  const auto prepare = [=](const auto& build) {
    const auto geometry = std::make_shared<const Geometry>(make());
    return Work{[=] { build(*geometry); }, double(primitives)};
  };
  register_contest({"build/" + scene,
                    "Mprim/s",
                    Clock::wall,
                    [=] { return prepare([](const Geometry& g) {
                            AcceleratedScene{g, {}};
                          }); },
                    {{"embree", [=] { return prepare([](const Geometry& g) { EmbreeBaseline{g}; }); }}}});
}

[[maybe_unused]] const bool registered = [] {
  register_build("triangles/1000000", 1'000'000, [] { return geometry_of(hills(707)); });
  register_build("sphere/1000000", 1'000'000, [] { return sphere_field(1'000'000); });
  return true;
}();

}  // namespace
}  // namespace alhazen
