#include "inspect/tree_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "inspect/labels.h"
#include "inspect/tree_words.h"
#include "materials/texture.h"

namespace alhazen {
namespace {

std::string percent(float share) {
  char text[16];
  std::snprintf(text, sizeof text, "%.0f %%", 100 * double(share));
  return text;
}

std::string point(const Vec3d& p) { return short_number(p.x) + " " + short_number(p.y) + " " + short_number(p.z); }

/// Lines of a tree, each after the bars of the branches that go on below.
class TreeText {
 public:
  TreeText(const Scene& scene, const RayTree& tree, bool color)
      : scene_(scene), tree_(tree), color_(color), children_(children(tree)), branch_(branch_light(tree)) {}

  std::string text() {
    heading();
    if (!tree_.rays.empty()) ray(0, "", "");
    return std::move(text_);
  }

 private:
  [[nodiscard]] std::string swatch(const Rgb& c) const {
    if (!color_) return "";
    const auto byte = [](float v) {
      return std::to_string(std::lround(255 * srgb_from_linear(std::clamp(v, 0.0f, 1.0f))));
    };
    return "\x1b[48;2;" + byte(c.r) + ";" + byte(c.g) + ";" + byte(c.b) + "m  \x1b[0m ";
  }
  [[nodiscard]] std::string strong(const std::string& words) const {
    return color_ ? "\x1b[1m" + words + "\x1b[0m" : words;
  }

  void heading() {
    text_ = "pixel " + std::to_string(tree_.x) + "," + std::to_string(tree_.y) + " of " + std::to_string(tree_.width) +
            "x" + std::to_string(tree_.height) + ": " + swatch(tree_.pixel) + short_color(tree_.pixel);
    if (tree_.samples > 1)
      text_ += "; sample " + std::to_string(tree_.sample) + " of " + std::to_string(tree_.samples) + ": " +
               swatch(tree_.radiance) + short_color(tree_.radiance);
    if (tree_.time) text_ += ", " + percent(*tree_.time) + " into the shutter's time";
    text_ += "; " + std::to_string(tree_.rays.size()) + (tree_.rays.size() == 1 ? " ray\n" : " rays\n");
  }

  void ray(uint32_t index, const std::string& first, const std::string& rest) {
    const TreeRay& r = tree_.rays[index];
    text_ += first + strong(kind_text(r)) + ", weight " + short_color(r.weight) + ": " + swatch(branch_[index]) +
             short_color(branch_[index]) + " by " + target_text(scene_, r) + "\n";
    const std::string bar = rest + (children_[index].empty() ? "    " : "│   ");
    const auto line = [&](const std::string& words) { text_ += bar + words + "\n"; };
    if (r.hit) surface(r, line);
    for (const TermAddend& term : r.terms)
      line("+ " + swatch(term.addend.light) + short_color(term.addend.light) + " " + term_text(term.term));
    for (const TreeLight& light : r.lights) lit(light, line);
    for (size_t k = 0; k < children_[index].size(); ++k) {
      const bool last = k + 1 == children_[index].size();
      ray(children_[index][k], rest + (last ? "└─ " : "├─ "), rest + (last ? "   " : "│  "));
    }
  }

  template <class Line>
  void surface(const TreeRay& r, const Line& line) {
    const TreeHit& hit = *r.hit;
    line(node_label(scene_, hit.ids.node) + " (" + object_label(scene_.geometry, hit.object) + "), primitive " +
         std::to_string(hit.ids.primitive) + ", material " + material_label(scene_, hit.material) + "; " +
         short_number(double(hit.distance)) + " m to " + point(hit.p_world) + ", normal " + point(Vec3d(hit.ns_world)));
    if (hit.arriving != r.weight) line("the medium leaves weight " + short_color(hit.arriving));
    if (hit.alpha < 1) line("covers " + short_number(double(hit.alpha)));
    if (r.end == RayEnd::unnoticed) line("unnoticed: within a body of higher priority");
    if (r.interface) boundary(r, line);
  }

  template <class Line>
  void boundary(const TreeRay& r, const Line& line) {
    const Interface& i = *r.interface;
    std::string words = short_number(double(incident_degrees(r))) + "° to the normal";
    if (i.ior_before != i.ior_after) {
      words = "n " + short_color(i.ior_before) + " → " + short_color(i.ior_after) + ", " +
              short_number(double(incident_degrees(r))) + "°";
      if (!i.total) words += " → " + short_number(double(refracted_degrees(r))) + "°";
    }
    if (i.fresnel_counts) words += ", Fresnel " + short_color(i.fresnel);
    line(words + (i.total ? ", total internal reflection" : ""));
  }

  template <class Line>
  void lit(const TreeLight& light, const Line& line) {
    std::string words = "+ " + swatch(light.addend.light) + short_color(light.addend.light) + " " +
                        light_label(scene_, light.light) + ": arriving " + short_color(light.arriving) + ", diffuse " +
                        short_color(light.diffuse) + ", specular " + short_color(light.specular);
    if (light.visible != Rgb(1.0f)) {
      words += ", visible " + short_color(light.visible) + " past";
      for (const Occluder& occluder : light.occluders)
        words += (&occluder == light.occluders.data() ? " " : ", ") + node_label(scene_, occluder.node);
    }
    line(words);
  }

  const Scene& scene_;
  const RayTree& tree_;
  bool color_;
  std::vector<std::vector<uint32_t>> children_;
  std::vector<Rgb> branch_;
  std::string text_;
};

// ---- in sentences

/// From the camera to where most of the light comes from: the branch that outweighs what a ray adds by itself and all
/// its sisters.
std::vector<uint32_t> dominant_branch(const RayTree& tree) {
  const auto lists = children(tree);
  const std::vector<Rgb> branch = branch_light(tree);
  std::vector<uint32_t> way{0};
  while (true) {
    uint32_t best = kNone;
    float most = luminance(own_light(tree.rays[way.back()]));
    for (const uint32_t child : lists[way.back()])
      if (luminance(branch[child]) > most) best = child, most = luminance(branch[child]);
    if (best == kNone) return way;
    way.push_back(best);
  }
}

std::string name_of_hit(const Scene& scene, const TreeRay& ray) {
  if (!ray.hit) return "the " + target_text(scene, ray);
  return node_label(scene, ray.hit->ids.node) + " (" + object_label(scene.geometry, ray.hit->object) + ", material " +
         material_label(scene, ray.hit->material) + ")";
}

/// "refracted into glass", "mirrored by silver"
std::string step_text(const Scene& scene, const TreeRay& from, const TreeRay& ray) {
  const std::string name = from.hit ? node_label(scene, from.hit->ids.node) : "";
  if (ray.total) return "totally reflected within " + name;
  switch (ray.kind) {
    case RayKind::mirror:
      return "mirrored by " + name;
    case RayKind::refracted:
      return (from.hit && from.hit->enters ? "refracted into " : "refracted out of ") + name;
    default:
      return "straight through " + name;
  }
}

/// The largest thing that a ray adds by itself.
std::string main_term(const Scene& scene, const TreeRay& ray) {
  std::string best = "no light at all";
  float most = 0;
  for (const TermAddend& term : ray.terms)
    if (luminance(term.addend.light) > most) most = luminance(term.addend.light), best = term_text(term.term);
  for (const TreeLight& light : ray.lights) {
    if (!(luminance(light.addend.light) > most)) continue;
    most = luminance(light.addend.light);
    const bool diffuse = luminance(light.diffuse * light.arriving) >= luminance(light.specular * light.arriving);
    best = std::string(diffuse ? "the diffuse" : "the specular") + " light of " + light_label(scene, light.light);
  }
  return best;
}

std::string shadow_sentence(const Scene& scene, const TreeRay& ray) {
  for (const TreeLight& light : ray.lights)
    if (luminance(light.visible) < 0.5f && !light.occluders.empty())
      return " There " + node_label(scene, light.occluders[0].node) + " shades it from " +
             light_label(scene, light.light) + " (" + percent(luminance(light.visible)) + " arrives).";
  return "";
}

std::string limits_sentence(const RayTree& tree) {
  size_t deep = 0;
  for (const TreeRay& ray : tree.rays) deep += ray.end == RayEnd::depth_limit;
  if (deep == 0) return "";
  return " " + std::to_string(deep) + (deep == 1 ? " branch is" : " branches are") +
         " cut off by the depth limit, so the true value may be brighter.";
}

}  // namespace

std::string tree_text(const Scene& scene, const RayTree& tree, bool color) {
  return TreeText(scene, tree, color).text();
}

std::string explanation(const Scene& scene, const RayTree& tree) {
  if (tree.rays.empty()) return "";
  const std::vector<uint32_t> way = dominant_branch(tree);
  const TreeRay& last = tree.rays[way.back()];
  const std::string pixel = "Pixel " + std::to_string(tree.x) + "," + std::to_string(tree.y);
  std::string text = pixel + " sees " + name_of_hit(scene, tree.rays[0]) + ".";
  if (!(luminance(tree.radiance) > 0)) return text + " No light comes from there." + limits_sentence(tree) + "\n";

  const float share = luminance(own_light(last)) / luminance(tree.radiance);
  if (way.size() == 1) {
    text += last.hit ? " Most of its light (" + percent(share) + ") is shaded there, most of it " +
                           main_term(scene, last) + "."
                     : "";
  } else {
    text += " Most of its light (" + percent(share) + ") is ";
    for (size_t i = 1; i < way.size(); ++i)
      text += (i > 1 ? ", then " : "") + step_text(scene, tree.rays[way[i - 1]], tree.rays[way[i]]);
    text += ", and comes from " + name_of_hit(scene, last);
    text += last.hit ? ", most of it " + main_term(scene, last) + "." : ".";
  }
  return text + shadow_sentence(scene, last) + limits_sentence(tree) + "\n";
}

}  // namespace alhazen
