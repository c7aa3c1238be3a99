#include "apps/view_transform.h"

#include <algorithm>
#include <cmath>

#include "materials/texture.h"

namespace alhazen {
namespace {

struct Matrix {
  Rgb r, g, b;  // rows
};

Rgb operator*(const Matrix& m, const Rgb& c) {
  const auto along = [&](const Rgb& row) { return row.r * c.r + row.g * c.g + row.b * c.b; };
  return {along(m.r), along(m.g), along(m.b)};
}

template <class Function>
Rgb by_channel(const Rgb& c, const Function& f) {
  return {f(c.r), f(c.g), f(c.b)};
}

Rgb clamped(const Rgb& c) {
  return by_channel(c, [](float x) { return x > 0 ? std::min(x, 1.0f) : 0.0f; });
}

/// Khronos PBR Neutral Tone Mapper, specification of 2024.
Rgb pbr_neutral(Rgb c) {
  constexpr float kF90 = 0.04f, kStart = 0.8f - kF90, kDesaturation = 0.15f;
  const float darkest = std::min({c.r, c.g, c.b});
  c = c - Rgb{darkest < 2 * kF90 ? darkest - darkest * darkest / (4 * kF90) : kF90};
  const float peak = max_component(c);
  if (peak < kStart) return c;
  constexpr float d = 1 - kStart;
  const float new_peak = 1 - d * d / (peak + d - kStart);
  const float fade = 1 - 1 / (kDesaturation * (peak - new_peak) + 1);
  return lerp(c * (new_peak / peak), Rgb{new_peak}, fade);
}

/// Sobotka's AgX with the polynomial that Wrensch fitted to its curve ("Minimal AgX Implementation", 2023).
Rgb agx(const Rgb& c) {
  constexpr Matrix kInset{{0.842479062253094f, 0.0784335999999992f, 0.0792237451477643f},
                          {0.0423282422610123f, 0.878468636469772f, 0.0791661274605434f},
                          {0.0423756549057051f, 0.0784336f, 0.879142973793104f}};
  constexpr Matrix kOutset{{1.19687900512017f, -0.0980208811401368f, -0.0990297440797205f},
                           {-0.0528968517574562f, 1.15190312990417f, -0.0989611768448433f},
                           {-0.0529716355144438f, -0.0980434501171241f, 1.15107367264116f}};
  constexpr float kDarkest = -12.47393f, kBrightest = 4.026069f;  // stops
  const auto curve = [&](float linear) {
    const float stops = std::clamp(std::log2(std::max(linear, 1e-10f)), kDarkest, kBrightest);
    const float x = (stops - kDarkest) / (kBrightest - kDarkest);
    return -0.00232f + x * (0.1191f + x * (0.4298f + x * (-6.868f + x * (31.96f + x * (-40.14f + x * 15.5f)))));
  };
  const auto decode = [](float x) { return std::pow(std::max(x, 0.0f), 2.2f); };
  return by_channel(kOutset * by_channel(kInset * c, curve), decode);
}

/// The reference rendering transform and sRGB output transform of ACES 1.0, as fitted by Stephen Hill.
Rgb aces(const Rgb& c) {
  constexpr Matrix kIn{{0.59719f, 0.35458f, 0.04823f}, {0.07600f, 0.90834f, 0.01566f}, {0.02840f, 0.13383f, 0.83777f}};
  constexpr Matrix kOut{
      {1.60475f, -0.53108f, -0.07367f}, {-0.10208f, 1.10813f, -0.00605f}, {-0.00327f, -0.07276f, 1.07602f}};
  const auto curve = [](float v) {
    return (v * (v + 0.0245786f) - 0.000090537f) / (v * (0.983729f * v + 0.4329510f) + 0.238081f);
  };
  return kOut * by_channel(kIn * c, curve);
}

}  // namespace

Rgb display_linear(ViewTransform view, const Rgb& scene_linear) noexcept {
  const Rgb c = by_channel(scene_linear, [](float x) { return x > 0 ? std::min(x, 1e6f) : 0.0f; });
  switch (view) {
    case ViewTransform::standard:
      return clamped(c);
    case ViewTransform::pbr_neutral:
      return clamped(pbr_neutral(c));
    case ViewTransform::agx:
      return clamped(agx(c));
    case ViewTransform::aces:
      return clamped(aces(c));
    case ViewTransform::none:
      return by_channel(clamped(c), linear_from_srgb);
  }
  return c;
}

void apply(ViewTransform view, ColorImage& image) {
  for (size_t i = 0; i + 3 < image.pixels.size(); i += 4) {
    float* p = &image.pixels[i];
    if (!(p[3] > 0)) continue;
    const Rgb c = display_linear(view, Rgb{p[0], p[1], p[2]} * (1 / p[3]));
    p[0] = c.r * p[3], p[1] = c.g * p[3], p[2] = c.b * p[3];
  }
}

}  // namespace alhazen
