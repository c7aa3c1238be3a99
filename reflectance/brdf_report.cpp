#include "reflectance/brdf_report.h"

#include <cstdio>

#include "inspect/tree_words.h"
#include "reflectance/directions.h"
#include "reflectance/verdicts.h"

namespace alhazen {
namespace {

std::string table_row(const std::string& angle, const std::string& a, const std::string& b, const std::string& c) {
  char text[160];
  std::snprintf(text, sizeof text, "%8s  %-20s  %-20s  %s\n", angle.c_str(), a.c_str(), b.c_str(), c.c_str());
  return text;
}

/// Three decimals, which the cubature holds.
std::string albedo_text(const Rgb& c) {
  char text[64];
  if (c.r == c.g && c.g == c.b)
    std::snprintf(text, sizeof text, "%.3f", double(c.r));
  else
    std::snprintf(text, sizeof text, "%.3f %.3f %.3f", double(c.r), double(c.g), double(c.b));
  return text;
}

}  // namespace

BrdfReport brdf_report(const Subject& subject, const BrdfOptions& options) {
  BrdfReport report{subject, options, {}, check_brdf(subject, options.azimuth), {}, {}};
  const auto slices_of = [&](const Brdf& brdf) {
    std::vector<LobeSlice> slices;
    for (const double incident : options.incident) slices.push_back(lobe_slice(brdf, incident, options.azimuth));
    return slices;
  };
  report.slices = slices_of(subject.brdf);
  if (!options.fit) return report;
  report.fit = fit_brdf(subject.brdf, *options.fit);
  report.fitted = slices_of(fitted_brdf(*report.fit));
  return report;
}

std::string settings_text(const Subject& subject) {
  std::string text;
  for (const auto& [name, value] : subject.settings) text += (text.empty() ? "" : ", ") + name + " " + value;
  return text;
}

std::string fit_text(const BrdfReport& report) {
  if (!report.fit) return {};
  const std::string& name = report.subject.name;
  return "fitted " + fit_summary(*report.fit) + "\nas a glTF material:\n" +
         fitted_material_json(*report.fit, (name.empty() ? report.subject.model : name) + ", fitted") + "\n";
}

std::string brdf_text(const BrdfReport& report) {
  const Subject& subject = report.subject;
  std::string text = (subject.name.empty() ? "" : subject.name + ": ") + subject.model + "\n";
  if (!subject.settings.empty()) text += settings_text(subject) + "\n";
  text += "\n" + table_row("angle", "beam reflected", "in a white furnace", "peak, 1/sr");
  for (const LobeSlice& slice : report.slices) {
    const Vec3f d = direction_at(slice.incident, report.options.azimuth);
    text += table_row(short_number(slice.incident), albedo_text(beam_albedo(subject.brdf, d).value),
                      albedo_text(furnace_albedo(subject.brdf, d).value), plain_number(double(peak(slice))));
  }
  text += "\n" + laws_text(subject, report.check);
  for (const std::string& note : subject.notes) text += "note: " + note + "\n";
  if (report.fit) text += "\n" + fit_text(report);
  return text;
}

}  // namespace alhazen
