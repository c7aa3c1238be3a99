#include "apps/brdf_command.h"

#include <cmath>
#include <filesystem>
#include <memory>

#include "apps/brdf_subject.h"
#include "apps/limit_options.h"
#include "apps/print.h"
#include "apps/usage.h"
#include "core/error.h"
#include "loaders/image_file.h"
#include "loaders/part_file.h"
#include "reflectance/brdf_csv.h"
#include "reflectance/brdf_html.h"
#include "reflectance/drawing_picture.h"
#include "reflectance/drawing_svg.h"
#include "reflectance/sheet.h"
#include "reflectance/verdicts.h"

namespace alhazen {
namespace {

constexpr int kLawBroken = 5;       // exit status
constexpr double kMostRows = 2e7;   // of a table: about a gigabyte
constexpr int kPictureScale = 2;    // pixels of a .png for each of an .svg
constexpr size_t kMostAngles = 12;  // that can be told apart in a drawing

struct BrdfArguments {
  SubjectArguments subject;
  BrdfOptions options;
  std::string output;  // empty: text to standard output
  double csv_step = 10;
  bool check = false;
};

enum class Form : uint8_t { text, svg, png, html, csv };

Form form_of(const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  if (file.empty() || extension == ".txt") return Form::text;
  if (extension == ".svg") return Form::svg;
  if (extension == ".png") return Form::png;
  if (extension == ".html") return Form::html;
  if (extension == ".csv") return Form::csv;
  throw WriteError(file, "unknown form '" + extension + "'; known are .txt, .svg, .png, .html and .csv");
}

std::vector<double> parse_angles(const std::string& text) {
  std::vector<double> angles;
  for (const char* at = text.c_str();;) {
    char* end = nullptr;
    const double angle = std::strtod(at, &end);
    if (end == at || !(angle >= 0 && angle < 90) || (*end != ',' && *end != '\0') || angles.size() == kMostAngles)
      throw CLI::ValidationError("--incident", "'" + text + "' is not one to " + std::to_string(kMostAngles) +
                                                   " angles of 0 to less than 90 degrees, like 0,30,60");
    angles.push_back(angle);
    if (*end == '\0') return angles;
    at = end + 1;
  }
}

FitModel parse_fit(const std::string& text) {
  if (text == "ggx") return FitModel::ggx;
  if (text == "phong") return FitModel::phong;
  throw CLI::ValidationError("--fit", "unknown '" + text + "', expected ggx or phong");
}

void write_file(const std::string& file, const std::string& text) {
  PartFile part(file);
  part.write({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
  part.commit();
}

void write_csv(const BrdfArguments& arguments, const BrdfReport& report) {
  const bool isotropic = report.check.isotropic;
  if (const double rows = brdf_csv_rows(arguments.csv_step, isotropic); rows > kMostRows)
    throw UsageError("--csv-step: would make " + std::to_string(uint64_t(rows)) + " rows; a larger step makes fewer");
  PartFile part(arguments.output);
  write_brdf_csv(report.subject.brdf, arguments.csv_step, isotropic, [&](std::string_view text) {
    part.write({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
  });
  part.commit();
}

void write(Form form, const BrdfArguments& arguments, const BrdfReport& report) {
  const std::string& output = arguments.output;
  switch (form) {
    case Form::svg:
      return write_file(output, drawing_svg(brdf_sheet(report)));
    case Form::png:
      return write_image(output, drawing_picture(brdf_sheet(report), kPictureScale), {}, {});
    case Form::html:
      return write_file(output, brdf_html(report));
    case Form::csv:
      return write_csv(arguments, report);
    case Form::text:
      return write_file(output, brdf_text(report));
  }
}

int run_brdf(const BrdfArguments& arguments) {
  const Form form = form_of(arguments.output);
  if (!arguments.output.empty()) (void)PartFile(arguments.output);  // before the work is done
  const BrdfReport report = brdf_report(subject_of(arguments.subject), arguments.options);
  if (arguments.output.empty())
    print(arguments.check ? laws_text(report.subject, report.check) : brdf_text(report));
  else
    write(form, arguments, report);
  if (arguments.check && !arguments.output.empty()) print(laws_text(report.subject, report.check));
  if (arguments.check || !arguments.output.empty()) print(fit_text(report));
  return arguments.check && !report.check.keeps_all() ? kLawBroken : int(ExitStatus::done);
}

void add_drawing_options(CLI::App& command, BrdfArguments& arguments) {
  command
      .add_option_function<std::string>(
          "--incident", [&](const std::string& text) { arguments.options.incident = parse_angles(text); },
          "Angles of the light to the normal")
      ->type_name("DEG[,DEG...]")
      ->default_str("0,30,60,80");
  command.add_option("--azimuth", arguments.options.azimuth, "Of the plane of incidence, from the tangent")
      ->type_name("DEG")
      ->check(within(-360, 360))
      ->capture_default_str();
  add_choice<RadialScale>(
      command, "--scale", arguments.options.scale,
      {{"auto", RadialScale::automatic}, {"linear", RadialScale::linear}, {"log", RadialScale::logarithmic}},
      "Of values in the plane of incidence");
  command.add_option("--csv-step", arguments.csv_step, "Between the rows' angles")
      ->type_name("DEG")
      ->check(within(0.5, 45))
      ->capture_default_str();
}

}  // namespace

Command add_brdf_command(CLI::App& program) {
  CLI::App* command =
      program.add_subcommand("brdf", "Show how a material scatters, and check it against physics")->group("Commands");
  const auto arguments = std::make_shared<BrdfArguments>();
  command
      ->add_option("-o,--output", arguments->output,
                   "A sheet of drawings (.svg, .png), the same with light that can be moved (.html), values (.csv), or "
                   "text (.txt); by default text to standard output")
      ->type_name("FILE");
  command
      ->add_option_function<std::string>(
          "--fit", [arguments](const std::string& text) { arguments->options.fit = parse_fit(text); },
          "Also the parameters of a model, ggx or phong, that come nearest, and how near: its lobes are dashed")
      ->type_name("MODEL");
  command->add_flag("--check", arguments->check,
                    "Say whether energy, reciprocity and positivity are kept; status 5 where they are not");
  command->option_defaults()->group("Picture");
  add_drawing_options(*command, *arguments);
  command->option_defaults()->group("Subject");
  add_subject_options(*command, arguments->subject);
  command->option_defaults()->group("Limits");
  add_limit_options(*command, arguments->subject.limits);
  command->footer(
      "Exit status: 0 done, 5 with --check where a law is broken, 2 wrong usage, 3 bad scene, 4 cannot write.\n"
      "\n"
      "Examples:\n"
      "  alhazen brdf scene.gltf --material copper\n"
      "  alhazen brdf scene.gltf --material copper -o copper.svg --incident 10,45,70\n"
      "  alhazen brdf gold-paint.binary -o gold-paint.html --fit ggx\n"
      "  alhazen brdf --model phong --diffuse 0.5 --specular 0.5 --shininess 50 --check\n"
      "  alhazen brdf --model normalised-phong --shininess 50 -o lobe.html");
  return {command, [arguments] { return run_brdf(*arguments); }};
}

}  // namespace alhazen
