#include "reflectance/drawing_svg.h"

#include <array>
#include <cstdio>

#include "inspect/base64.h"
#include "inspect/xml.h"
#include "loaders/image_file.h"

namespace alhazen {
namespace {

std::string num(double v) { return short_decimal(v); }

std::string attribute(const char* name, const std::string& value) {
  return std::string(" ") + name + "=\"" + value + "\"";
}

std::string paint(const char* name, const Ink& ink) {
  if (!(ink.opacity > 0)) return attribute(name, "none");
  std::array<char, 8> hex;
  std::snprintf(hex.data(), hex.size(), "#%02x%02x%02x", ink.r, ink.g, ink.b);
  const std::string opacity =
      ink.opacity < 1 ? attribute((std::string(name) + "-opacity").c_str(), num(ink.opacity)) : "";
  return attribute(name, hex.data()) + opacity;
}

std::string svg(const Outline& path) {
  std::string d;
  for (const Vec2d& p : path.points) d += (d.empty() ? "M" : "L") + num(p.x) + " " + num(p.y);
  std::string stroke = paint("stroke", path.line);
  if (path.line.opacity > 0)
    stroke += attribute("stroke-width", num(path.width)) + " stroke-linejoin=\"round\"" +
              (path.dash > 0 ? attribute("stroke-dasharray", num(path.dash)) : "");
  return "<path" + attribute("d", d) + paint("fill", path.fill) + stroke + "/>\n";
}

std::string svg(const Words& words) {
  constexpr std::array kAnchors{"start", "middle", "end"};
  return "<text" + attribute("x", num(words.at.x)) + attribute("y", num(words.at.y)) +
         attribute("font-size", num(words.size)) + attribute("text-anchor", kAnchors[size_t(words.anchor)]) +
         paint("fill", words.ink) + ">" + xml_escaped(words.text) + "</text>\n";
}

std::string svg(const Inset& inset) {
  return "<image" + attribute("x", num(inset.at.x)) + attribute("y", num(inset.at.y)) +
         attribute("width", num(inset.side)) + attribute("height", num(inset.side)) +
         attribute("href", "data:image/png;base64," + base64(encoded_png(inset.image))) + "/>\n";
}

}  // namespace

std::string marks_svg(const std::vector<Mark>& marks) {
  std::string text;
  for (const Mark& mark : marks) text += std::visit([](const auto& m) { return svg(m); }, mark);
  return text;
}

std::string drawing_svg(const Drawing& drawing, const std::string& more) {
  const std::string width = num(drawing.width), height = num(drawing.height);
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + width + "\" height=\"" + height + "\" viewBox=\"0 0 " +
         width + " " + height +
         "\" font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\">\n"
         "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n" +
         marks_svg(drawing.marks) + more + "</svg>\n";
}

}  // namespace alhazen
