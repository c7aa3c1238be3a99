#include "reflectance/brdf_html.h"

#include "inspect/tree_words.h"
#include "inspect/xml.h"
#include "reflectance/drawing_svg.h"
#include "reflectance/sheet.h"

namespace alhazen {
namespace {

constexpr int kStep = 5, kLast = 85, kFirstShown = 45;  // degrees

constexpr const char* kStyle = R"(
body { margin: 0 auto; max-width: 1000px; background: #fff; color: #22262c;
       font: 14px/1.45 "DejaVu Sans", Helvetica, Arial, sans-serif; }
form { position: sticky; top: 0; padding: 12px 40px; background: #f4f5f7; display: flex; gap: 14px; align-items: center; }
input { flex: 1; } output { min-width: 3em; }
svg { width: 100%; height: auto; display: block; }
.angle { display: none; } .angle.on { display: inline; }
)";

constexpr const char* kScript = R"(
const slider = document.querySelector('input'), output = document.querySelector('output');
function show() {
  output.value = slider.value + '°';
  document.querySelectorAll('.angle').forEach(g => g.classList.toggle('on', g.dataset.degrees === slider.value));
}
slider.addEventListener('input', show);
show();
)";

}  // namespace

std::string brdf_html(const BrdfReport& report) {
  std::vector<double> angles;
  for (int degrees = 0; degrees <= kLast; degrees += kStep) angles.push_back(degrees);
  const LiveSheet sheet = live_sheet(report, angles);
  std::string groups;
  for (size_t i = 0; i < angles.size(); ++i)
    groups += std::string("<g class=\"angle") + (angles[i] == kFirstShown ? " on" : "") + "\" data-degrees=\"" +
              short_number(angles[i]) + "\">\n" + marks_svg(sheet.by_angle[i]) + "</g>\n";
  const Subject& subject = report.subject;
  const std::string title = xml_escaped(subject.name.empty() ? subject.model : subject.name);
  return "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" + title + "</title>\n<style>" +
         kStyle +
         "</style></head>\n<body>\n<form><label for=\"light\">Light from</label><input id=\"light\" type=\"range\" "
         "min=\"0\" max=\"" +
         std::to_string(kLast) + "\" step=\"" + std::to_string(kStep) + "\" value=\"" + std::to_string(kFirstShown) +
         "\"><output>" + std::to_string(kFirstShown) + "°</output></form>\n" + drawing_svg(sheet.fixed, groups) +
         "<script>" + kScript + "</script></body></html>\n";
}

}  // namespace alhazen
