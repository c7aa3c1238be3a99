// Scenes whose nodes move from 0 to 1 s, and what their pictures must show.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "accel/baking.h"
#include "gltf_builder.h"
#include "loaders/record_motion.h"
#include "renderer/render.h"

namespace alhazen {

/// Nodes under animations, seen from z = 10 by an orthographic camera, `ymag` metres up and down.
struct MovingScene : GltfBuilder {
  std::vector<json> channels, samplers, shapes;
  int camera;

  explicit MovingScene(double ymag) {
    add("cameras",
        {{"type", "orthographic"}, {"orthographic", {{"xmag", ymag}, {"ymag", ymag}, {"znear", 0.1}, {"zfar", 99}}}});
    camera = add("nodes", {{"camera", 0}, {"translation", {0, 0, 10}}});
    add("materials", {{"extensions", {{"KHR_materials_unlit", json::object()}}}});
    root["extensionsUsed"] = {"KHR_materials_unlit", "ALHAZEN_shapes", "ALHAZEN_materials_phong",
                              "KHR_lights_punctual"};
  }

  int shape(json kind, json node = json::object(), int material = 0) {
    shapes.push_back(std::move(kind));
    node["extensions"]["ALHAZEN_shapes"] = {{"shape", shapes.size() - 1}, {"material", material}};
    return add("nodes", std::move(node));
  }
  /// A rectangle in z = 0 about the origin; returns its node.
  int rectangle(float width, float height, json primitive = json::object(), int material = 0) {
    const float x = width / 2, y = height / 2;
    primitive["attributes"]["POSITION"] = vec3({-x, -y, 0, x, -y, 0, x, y, 0, -x, y, 0});
    primitive["indices"] = index({0, 1, 2, 0, 2, 3}), primitive["material"] = material;
    (void)mesh(std::move(primitive));
    return int(root["nodes"].size()) - 1;
  }
  /// Linear between values at even times from 0 to 1 s.
  void animate(int node, const std::string& path, const std::vector<float>& values, size_t components) {
    const size_t keys = values.size() / components;
    std::vector<float> times;
    for (size_t k = 0; k < keys; ++k) times.push_back(float(k) / float(keys - 1));
    const int input = accessor(times, "SCALAR", 5126, keys);
    const int output = path == "weights" ? accessor(values, "SCALAR", 5126, values.size())
                                         : accessor(values, components == 3 ? "VEC3" : "VEC4", 5126, keys);
    samplers.push_back({{"input", input}, {"output", output}});
    channels.push_back({{"sampler", samplers.size() - 1}, {"target", {{"node", node}, {"path", path}}}});
  }
  void move(int node, const std::vector<float>& translations) { animate(node, "translation", translations, 3); }
  /// About z, by less than half a turn from key to key.
  void turn(int node, const std::vector<double>& degrees) {
    std::vector<float> quaternions;
    for (const double d : degrees)
      for (const double q : {0.0, 0.0, std::sin(d * std::numbers::pi / 360), std::cos(d * std::numbers::pi / 360)})
        quaternions.push_back(float(q));
    animate(node, "rotation", quaternions, 4);
  }
  int phong(json factors) {
    return add("materials", {{"extensions", {{"ALHAZEN_materials_phong", std::move(factors)}}}});
  }
  int light(json node) {
    root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 20}}};
    node["extensions"]["KHR_lights_punctual"]["light"] = 0;
    return add("nodes", std::move(node));
  }

  [[nodiscard]] std::string text() const {
    json all = document();
    if (!shapes.empty()) all["extensions"]["ALHAZEN_shapes"]["shapes"] = shapes;
    if (!channels.empty()) all["animations"] = {{{"channels", channels}, {"samplers", samplers}}};
    return all.dump();
  }
};

/// A scene read once, as the program stages it.
struct MovingSubject {
  TemporaryFolder folder;
  GltfFile file;
  LoadedScene loaded;

  explicit MovingSubject(const MovingScene& scene)
      : file(folder.write("scene.gltf", scene.text()), [](const std::string& w) { ADD_FAILURE() << w; }, {},
             {.animation = {}, .time = 0.0}),
        loaded(file.load(0)) {
    bake_single_instances(loaded.scene.geometry, file.moving_meshes());
  }
  Scene& scene() { return loaded.scene; }

  /// f(accelerated scene)
  template <class F>
  auto accelerated(const F& f) {
    std::vector<Opacity> opacity;
    const SurfaceFilter filter = surface_filter(scene(), opacity);
    return f(AcceleratedScene(scene().geometry, filter));
  }
  RenderResult result(const RenderOptions& options) {
    return accelerated([&](const AcceleratedScene& built) {
      RenderControl control;
      return render(scene(), built, scene().cameras[0], options, control);
    });
  }
  ColorImage picture(const RenderOptions& options) { return result(options).color; }

  void open_shutter(double open, double shutter) {
    file.move(scene(), open);
    record_motion(file, scene(), open, shutter);
  }
  ColorImage blurred(double open, double shutter, const RenderOptions& options) {
    open_shutter(open, shutter);
    return picture(options);
  }
};

/// The share of the time that x is covered by what is `width` wide and goes from -10 to 10, a trapezoid, under the
/// pixel's filter.
inline double trapezoid(double pixel_x, double width) {
  double sum = 0, weights = 0;
  for (int i = -199; i < 200; ++i) {
    const double offset = i / 200.0, x = pixel_x + offset, weight = 1 - std::abs(offset);
    const double covered = std::min(x + width / 2, 10.0) - std::max(x - width / 2, -10.0);
    sum += weight * std::max(0.0, covered) / 20, weights += weight;
  }
  return sum / weights;
}

}  // namespace alhazen
