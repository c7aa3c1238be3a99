// Claims about the forms that a tree of rays is written in.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "inspect/trace_pixel.h"
#include "inspect/tree_glb.h"
#include "inspect/tree_html.h"
#include "inspect/tree_json.h"
#include "inspect/tree_svg.h"
#include "inspect/tree_text.h"
#include "loaders/gltf.h"
#include "loaders/image_decode.h"
#include "renderer/render.h"

namespace alhazen {
namespace {

struct Showcase {
  Scene scene;
  std::vector<Opacity> opacity;
  std::unique_ptr<AcceleratedScene> accelerated;
  RenderOptions options{.width = 640, .height = 360};

  Showcase() {
    LoadedScene loaded = load_gltf(ALHAZEN_SHOWCASE, [](const std::string&) {});
    decode_textures(loaded, [](const std::string&) {});
    scene = std::move(loaded.scene);
    bake_single_instances(scene.geometry);
    accelerated = std::make_unique<AcceleratedScene>(scene.geometry, surface_filter(scene, opacity));
  }
  Showcase(const Showcase&) = delete;

  [[nodiscard]] RayTree tree(int x, int y) const {
    return trace_pixel(scene, *accelerated, scene.cameras[0], options, x, y, 0);
  }
};

size_t count(const std::string& text, const std::string& word) {
  size_t n = 0;
  for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + word.size())) ++n;
  return n;
}

Rgb color(const nlohmann::json& list) { return {list[0].get<float>(), list[1].get<float>(), list[2].get<float>()}; }

TEST(TreeJson, ItsNumbersAddUpToThePixelBitForBit) {
  const Showcase showcase;
  constexpr int kPixels[][2] = {{260, 175}, {400, 150}, {220, 300}, {220, 10}, {450, 300}, {300, 250}};
  for (const auto& [x, y] : kPixels) {
    const auto json = nlohmann::json::parse(tree_json(showcase.scene, showcase.tree(x, y), 1));
    std::vector<std::pair<uint32_t, Rgb>> addends;
    for (const auto& ray : json["rays"])
      for (const char* list : {"terms", "lights"})
        for (const auto& term : ray[list])
          addends.emplace_back(term["order"].get<uint32_t>(), color(term["contribution"]));
    std::ranges::sort(addends, {}, [](const auto& a) { return a.first; });
    Rgb sum;
    for (const auto& [order, light] : addends) sum += light;
    EXPECT_EQ(sum, color(json["value"])) << x << " " << y;
  }
}

TEST(TreeText, EveryRayHasItsLine) {
  const Showcase showcase;
  const RayTree tree = showcase.tree(260, 175);
  const std::string text = tree_text(showcase.scene, tree, false);
  EXPECT_EQ(count(text, ", weight "), tree.rays.size());
  EXPECT_EQ(count(text, "\x1b"), 0u);
  EXPECT_GT(count(tree_text(showcase.scene, tree, true), "\x1b"), 0u);
}

TEST(TreeText, ExplanationsNameWhatIsSeenThroughWhat) {
  const Showcase showcase;
  const std::string glass = explanation(showcase.scene, showcase.tree(260, 175));
  EXPECT_EQ(glass.rfind("Pixel 260,175 sees glass (sphere, material glass).", 0), 0u) << glass;
  EXPECT_NE(glass.find("refracted into glass, then refracted out of glass"), std::string::npos) << glass;
  EXPECT_EQ(explanation(showcase.scene, showcase.tree(220, 10)), "Pixel 220,10 sees the background.\n");
  const std::string mirror = explanation(showcase.scene, showcase.tree(400, 150));
  EXPECT_NE(mirror.find("mirrored by mirror"), std::string::npos) << mirror;
}

TEST(TreeSvg, DrawsNoMoreThanCanBeReadAndCountsTheOthers) {
  Showcase showcase;
  showcase.options.max_depth = 20, showcase.options.min_weight = 0;
  const RayTree tree = showcase.tree(260, 175);
  ASSERT_GT(tree.rays.size(), 40u);
  const std::string svg = tree_svg(showcase.scene, tree);
  EXPECT_EQ(count(svg, "class=\"ray\""), 31u);
  EXPECT_EQ(count(svg, "<g "), count(svg, "</g>"));
  size_t folded = 0;
  for (size_t at = svg.find(">+ "); at != std::string::npos; at = svg.find(">+ ", at + 1))
    folded += std::stoul(svg.substr(at + 3));
  EXPECT_EQ(folded + 31, tree.rays.size());
}

TEST(TreeSvg, NamesCannotBreakIt) {
  Showcase showcase;
  showcase.scene.node_names[1] = "<script>&\"</title>\x01";
  for (const std::string& form :
       {tree_svg(showcase.scene, showcase.tree(260, 175)),
        tree_html(showcase.scene, showcase.tree(260, 175), {{1, 1, {"R", "G", "B", "A"}, {0, 0, 0, 1}}, 0, 0})}) {
    EXPECT_EQ(form.find("<script>&"), std::string::npos);
    EXPECT_EQ(count(form, "</title>"), count(form, "<title>"));
  }
}

TEST(TreeGlb, LoadsAsASceneWithACylinderForEachRay) {
  const Showcase showcase;
  const RayTree tree = showcase.tree(260, 175);
  size_t segments = 0;
  for (const TreeRay& ray : tree.rays)
    segments += ray.end != RayEnd::depth_limit && ray.end != RayEnd::weight_limit ? 1 + ray.lights.size() : 0;
  const auto bytes = tree_glb(showcase.scene, tree);
  const LoadedScene loaded = load_gltf(bytes, "tree.glb", [](const std::string&) {});
  const Geometry& geometry = loaded.scene.geometry;
  EXPECT_EQ(geometry.shape_instances.size(), segments);
  // The first node is the camera ray's: from the camera to what it hits.
  const Affine3d& m = geometry.shape_instances[0].world_from_object;
  EXPECT_LT(length(m.origin - m.y * 0.5 - Vec3d(tree.rays[0].ray.origin)), 1e-5);
  EXPECT_LT(length(m.origin + m.y * 0.5 - tree.rays[0].hit->p_world), 1e-5);
  EXPECT_EQ(loaded.scene.node_names[geometry.shape_instances[0].node], "camera: camera → glass");
}

}  // namespace
}  // namespace alhazen
