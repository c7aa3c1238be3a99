#include "inspect/tree_html.h"

#include <algorithm>
#include <cstdint>

#include "inspect/base64.h"
#include "inspect/tree_json.h"
#include "inspect/tree_svg.h"
#include "inspect/tree_text.h"
#include "inspect/xml.h"
#include "loaders/image_file.h"

namespace alhazen {
namespace {

constexpr const char* kStyle = R"(
body { margin: 0; background: #17181c; color: #d8dade; font: 13px/1.45 "DejaVu Sans", Helvetica, Arial, sans-serif; }
main { display: flex; gap: 16px; padding: 16px; align-items: flex-start; }
aside { flex: 0 0 auto; position: sticky; top: 16px; width: var(--picture); }
section { overflow-x: auto; }
.picture { position: relative; line-height: 0; }
.picture img { width: 100%; image-rendering: pixelated; }
.cross { position: absolute; width: 15px; height: 15px; margin: -9px; border: 2px solid #fff; border-radius: 50%;
         outline: 1px solid #000; }
h1 { font-size: 15px; margin: 0 0 8px; }
table { border-collapse: collapse; margin-top: 8px; width: 100%; }
td { padding: 1px 8px 1px 0; vertical-align: top; }
td:first-child { color: #a0a4ac; white-space: nowrap; }
.ray { cursor: pointer; } .ray:hover > rect:first-of-type, .ray.on > rect:first-of-type { fill: #3a3e48; }
)";

constexpr const char* kScript = R"(
const tree = JSON.parse(document.getElementById('tree').textContent), details = document.getElementById('details');
const text = v => Array.isArray(v) ? v.map(text).join(' ') : v === null ? 'none' : typeof v === 'number' ? +v.toPrecision(4) + '' : v;
function rows(ray) {
  const rows = [['kind', ray.kind], ['weight', ray.weight], ['origin', ray.origin], ['direction', ray.direction]];
  if (ray.media.length) rows.push(['starts in', ray.media.join(', ')]);
  const hit = ray.hit, face = ray.interface;
  if (hit) rows.push(['hits', hit.node.name + ' (' + hit.object + '), primitive ' + hit.primitive], ['material', hit.material.name],
                     ['distance', text(hit.distance) + ' m'], ['position', hit.position], ['normal', hit.normal]);
  if (face) rows.push(['n', text(face.ior[0][1]) + ' → ' + text(face.ior[1][1])],
                      ['angle', text(face.incident_degrees) + '° → ' + (face.total_internal_reflection ? 'total internal reflection' : text(face.refracted_degrees) + '°')],
                      ['Fresnel', face.fresnel]);
  rows.push(['ends', ray.end]);
  for (const t of ray.terms) rows.push(['+ ' + t.term, t.contribution]);
  for (const l of ray.lights) {
    rows.push(['+ ' + l.light.name, l.contribution], ['', 'arriving ' + text(l.arriving) + '; diffuse ' + text(l.diffuse) + '; specular ' + text(l.specular)]);
    if (l.occluders.length) rows.push(['', 'visible ' + text(l.visible) + ' past ' + l.occluders.map(o => o.node.name).join(', ')]);
  }
  rows.push(['adds itself', ray.own], ['with branches', ray.branch]);
  return rows;
}
function show(group) {
  document.querySelectorAll('.ray.on').forEach(g => g.classList.remove('on'));
  group.classList.add('on');
  details.replaceChildren(...rows(tree.rays[group.dataset.ray]).map(([name, value]) => {
    const row = document.createElement('tr');
    for (const v of [name, text(value)]) row.appendChild(document.createElement('td')).textContent = v;
    return row;
  }));
}
document.querySelectorAll('.ray').forEach(g => g.addEventListener('mouseenter', () => show(g)));
const first = document.querySelector('.ray');
if (first) show(first);
)";

/// Without "<", which could end or change the script element that it stands in.
std::string in_script(const std::string& json) {
  std::string out;
  for (const char c : json) c == '<' ? out += "\\u003c" : out += c;
  return out;
}

std::string percent(double share) { return short_decimal(100 * share) + "%"; }

}  // namespace

std::string tree_html(const Scene& scene, const RayTree& tree, const PixelPicture& picture) {
  const std::string title = "Pixel " + std::to_string(tree.x) + ", " + std::to_string(tree.y);
  return "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" + title + "</title>\n<style>" +
         kStyle + "</style></head>\n<body style=\"--picture: " + std::to_string(std::max(picture.color.width, 320)) +
         "px\"><main>\n<aside><h1>" + title +
         "</h1>\n<div class=\"picture\"><img alt=\"the picture\" src=\"data:image/png;base64," +
         base64(encoded_png(picture.color)) + "\"><div class=\"cross\" style=\"left: " + percent(picture.u) +
         "; top: " + percent(picture.v) + "\"></div></div>\n<p>" + xml_escaped(explanation(scene, tree)) +
         "</p>\n<table id=\"details\"></table></aside>\n<section>\n" + tree_svg(scene, tree) +
         "</section></main>\n<script type=\"application/json\" id=\"tree\">" + in_script(tree_json(scene, tree, -1)) +
         "</script>\n<script>" + kScript + "</script></body></html>\n";
}

}  // namespace alhazen
