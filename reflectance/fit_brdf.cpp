#include "reflectance/fit_brdf.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <regex>
#include <unsupported/Eigen/NonLinearOptimization>
#include <vector>

#include "inspect/tree_words.h"
#include "loaders/in_parallel.h"
#include "materials/measured_table.h"
#include "materials/metallic_roughness.h"
#include "materials/phong.h"

namespace alhazen {
namespace {

using Eigen::VectorXd;

constexpr Vec3f kUp{0, 0, 1};
constexpr int kParameters = 7;  // diffuse and specular colour, and the highlight's shape

// ---- What is compared ----

/// A pair of directions, and the data there in the metric.
struct Datum {
  DirectionPair pair;
  Rgb value;
};

Rgb metric(const Rgb& f_cos) { return {std::log1p(f_cos.r), std::log1p(f_cos.g), std::log1p(f_cos.b)}; }

/// Divides MERL's 90 x 90 x 180 cells by odd numbers, so that the middles are middles of its cells.
std::vector<Datum> data_of(const Brdf& brdf) {
  constexpr MeasuredGrid kPairs{30, 18, 12};
  const float lowest = std::cos(80 * std::numbers::pi_v<float> / 180);
  std::vector<Datum> data;
  for (int h = 0; h < kPairs.theta_h; ++h)
    for (int d = 0; d < kPairs.theta_d; ++d)
      for (int p = 0; p < kPairs.phi_d; ++p) {
        const DirectionPair pair = directions(cell_middle(kPairs, h, d, p));
        if (pair.s.z < lowest || pair.b.z < lowest) continue;
        data.push_back({pair, metric(brdf(pair.s, pair.b) * pair.s.z)});
      }
  return data;
}

// ---- Models ----

double share(double x) { return 1 / (1 + std::exp(-x)); }  // any number to (0, 1)
double unshare(double share) { return std::log(share / (1 - share)); }

template <class Map>
Rgb color(const VectorXd& x, int first, Map map) {
  return {float(map(x[first])), float(map(x[first + 1])), float(map(x[first + 2]))};
}

/// A model with parameters that may be any numbers.
Material material_of(FitModel model, const VectorXd& x) {
  Material m;
  if (model == FitModel::ggx) {
    m.base_color.rgb = color(x, 0, share), m.specular_color = color(x, 3, share);
    m.roughness = float(share(x[6]));
    m.metallic = 0, m.ior = 0;
  } else {
    const auto positive = [](double v) { return std::exp(std::clamp(v, -30.0, 30.0)); };
    m.model = ShadingModel::phong;
    m.phong.diffuse = color(x, 0, positive), m.phong.specular = color(x, 3, positive);
    m.phong.ambient = m.phong.diffuse * std::numbers::pi_v<float>;
    m.phong.shininess = float(positive(x[6]));
  }
  return m;
}

/// Calls `use(f)` where f(s, b) is the material's BRDF x cosine.
template <class Use>
auto with_reflected_light(const Material& material, const Use& use) {
  if (material.model == ShadingModel::phong)
    return use([bsdf = phong_bsdf(material, {}, {})](const Vec3f& s, const Vec3f& b) {
      return reflected_light(bsdf, kUp, s, b);
    });
  return use([bsdf = metallic_roughness_bsdf(material, {}, {}), frames = LayerFrames(kUp)](
                 const Vec3f& s, const Vec3f& b) { return reflected_light(bsdf, frames, s, b); });
}

/// Where to begin: highlights of five widths, weak and strong ones.
std::vector<VectorXd> starts(FitModel model) {
  std::vector<VectorXd> all;
  for (const double roughness : {0.08, 0.15, 0.3, 0.5, 0.75})
    for (const double specular : {0.05, 0.6}) {
      constexpr double kDiffuse = 0.2;
      VectorXd x(kParameters);
      if (model == FitModel::ggx) {
        x.head(3).setConstant(unshare(kDiffuse)), x.segment(3, 3).setConstant(unshare(specular));
        x[6] = unshare(roughness);
      } else {
        // The mirror direction's cosine falls off as a lobe of alpha = roughness² does: exponent 1 / (2 alpha²), its
        // integral 2 pi / exponent.
        const double exponent = std::max(1.0, 0.5 / std::pow(roughness, 4));
        x.head(3).setConstant(std::log(kDiffuse * std::numbers::inv_pi));
        x.segment(3, 3).setConstant(std::log(specular * exponent / (2 * std::numbers::pi)));
        x[6] = std::log(exponent);
      }
      all.push_back(x);
    }
  return all;
}

// ---- Least squares ----

/// As Eigen's solver asks for it.
class Residuals {
 public:
  using Scalar = double;

  Residuals(FitModel model, const std::vector<Datum>& data) : model_(model), data_(data) {}

  [[nodiscard]] int values() const { return int(3 * data_.size()); }

  int operator()(const VectorXd& x, VectorXd& difference) const {
    with_reflected_light(material_of(model_, x), [&](const auto& f_cos) {
      for (size_t i = 0; i < data_.size(); ++i) {
        const Rgb d = metric(f_cos(data_[i].pair.s, data_[i].pair.b)) - data_[i].value;
        difference.segment(Eigen::Index(3 * i), 3) << double(d.r), double(d.g), double(d.b);
      }
    });
    return 0;
  }

  /// By central differences as wide as models in floats want them.
  int df(const VectorXd& x, Eigen::MatrixXd& jacobian) const {
    constexpr double kStep = 5e-3;
    VectorXd after(values()), before(values());
    for (int k = 0; k < kParameters; ++k) {
      VectorXd moved = x;
      moved[k] = x[k] + kStep;
      (*this)(moved, after);
      moved[k] = x[k] - kStep;
      (*this)(moved, before);
      jacobian.col(k) = (after - before) / (2 * kStep);
    }
    return 0;
  }

 private:
  FitModel model_;
  const std::vector<Datum>& data_;
};

struct Minimum {
  VectorXd x;
  double norm;  // of the residuals
};

Minimum minimum_from(const Residuals& residuals, VectorXd x) {
  Residuals of = residuals;
  Eigen::LevenbergMarquardt<Residuals> solver(of);
  solver.parameters.maxfev = 200;
  solver.minimize(x);
  return {x, std::isfinite(solver.fnorm) ? solver.fnorm : std::numeric_limits<double>::infinity()};
}

FitResidual residual_of(const std::vector<Datum>& data, double norm) {
  double squared = 0;
  for (const Datum& d : data)
    squared += double(d.value.r) * d.value.r + double(d.value.g) * d.value.g + double(d.value.b) * d.value.b;
  return {norm / std::sqrt(3.0 * double(data.size())), squared > 0 ? norm / std::sqrt(squared) : 0, int(data.size())};
}

// ---- As glTF ----

using Json = nlohmann::ordered_json;

double rounded(float value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", double(value));
  return std::strtod(text, nullptr);
}

Json json_of(const Rgb& c) { return {rounded(c.r), rounded(c.g), rounded(c.b)}; }

/// Numbers in a row instead of one a line.
std::string with_short_arrays(std::string text) {
  for (const auto& [line_break, instead] :
       {std::pair{R"(\[\n\s*)", "["}, {R"(,\n\s*(?=[-\d]))", ", "}, {R"(\n\s*\])", "]"}})
    text = std::regex_replace(text, std::regex(line_break), instead);
  return text;
}

Json ggx_json(const Material& m) {
  Json base = json_of(m.base_color.rgb);
  base.push_back(1);
  return {{"pbrMetallicRoughness",
           {{"baseColorFactor", base}, {"metallicFactor", 0}, {"roughnessFactor", rounded(m.roughness)}}},
          {"extensions",
           {{"KHR_materials_ior", {{"ior", 0}}},
            {"KHR_materials_specular", {{"specularColorFactor", json_of(m.specular_color)}}}}}};
}

Json phong_json(const PhongParameters& p) {
  return {{"extensions",
           {{"ALHAZEN_materials_phong",
             {{"ambientFactor", json_of(p.ambient)},
              {"diffuseFactor", json_of(p.diffuse)},
              {"specularFactor", json_of(p.specular)},
              {"shininess", rounded(p.shininess)},
              {"reflectionFactor", json_of(p.reflection)}}}}}};
}

}  // namespace

BrdfFit fit_brdf(const Brdf& brdf, FitModel model) {
  const std::vector<Datum> data = data_of(brdf);
  const std::vector<VectorXd> from = starts(model);
  std::vector<Minimum> minima(from.size());
  for_each_in_parallel(from.size(), [&](size_t i) { minima[i] = minimum_from({model, data}, from[i]); });
  const Minimum& best = *std::min_element(minima.begin(), minima.end(),
                                          [](const Minimum& a, const Minimum& b) { return a.norm < b.norm; });
  return {model, material_of(model, best.x), residual_of(data, best.norm)};
}

Brdf fitted_brdf(const BrdfFit& fit) {
  return with_reflected_light(fit.material, [](const auto& f_cos) -> Brdf {
    return [f_cos](const Vec3f& s, const Vec3f& b) { return s.z > 0 && b.z > 0 ? f_cos(s, b) * (1 / s.z) : Rgb{}; };
  });
}

std::string fit_summary(const BrdfFit& fit) {
  const PhongParameters& p = fit.material.phong;
  const std::string parameters = fit.model == FitModel::ggx
                                     ? "GGX: base color " + short_color(fit.material.base_color.rgb) + ", F0 " +
                                           short_color(fit.material.specular_color) + ", roughness " +
                                           short_number(double(fit.material.roughness))
                                     : "Phong: diffuse " + short_color(p.diffuse) + ", specular " +
                                           short_color(p.specular) + ", shininess " + short_number(double(p.shininess));
  return parameters + "; off by " + short_number(100 * fit.residual.relative) +
         " %, the root mean square of log(1 + f cos) over " + std::to_string(fit.residual.pairs) +
         " pairs of directions (" + short_number(fit.residual.rms) + ")";
}

std::string fitted_material_json(const BrdfFit& fit, const std::string& name) {
  Json material{{"name", name}};
  material.update(fit.model == FitModel::ggx ? ggx_json(fit.material) : phong_json(fit.material.phong));
  return with_short_arrays(material.dump(2, ' ', false, Json::error_handler_t::replace));
}

}  // namespace alhazen
