// SPDX-License-Identifier: MIT
// Shafts held against occlusion rays, with the errors of both.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "renderer/aerial_perspective.h"
#include "renderer/occlusion_march.h"
#include "renderer/scene_ground.h"
#include "renderer/shadow_heights.h"

namespace alpenglow {

/// Light scattered once along the ray of a pixel, summed over bands.
struct ShaftPixel {
  double found;     // AerialPerspective with ShadowHeights
  double march;     // 512 occlusion rays
  double fine;      // 4096
  double unbroken;  // without terrain between sun and air
};

inline std::vector<ShaftPixel> MeasureShafts(const SceneGround& ground, const ShaftView& view) {
  const AirIntegrator<float> air(MediumPreset("earth"));
  DiffuseLightOptions coarse;  // not looked at
  coarse.altitudes = 4;
  coarse.sun_angles = 4;
  coarse.degree = 2;
  coarse.max_orders = 1;
  const DiffuseLight diffuse(air.medium(), coarse);
  const AerialPerspective aerial(air, diffuse);
  const ShadowHeights shadow(ground.terrain->mesh(), view.to_sun, view.sun_radius_rad);
  std::vector<ShaftPixel> pixels;
  for (std::size_t i = 0; i < view.directions.size(); ++i) {
    const ViewRay ray = RayOf(view, i, LengthOf(view, i, *ground.terrain));
    const auto light = [&](const ScatteredOnce<float>& once) {
      const Bands<float> bands = air.Inscatter(once, ray.nu);
      double sum = 0.0;
      for (std::size_t band = 0; band < bands.count; ++band)
        sum += static_cast<double>(bands[band]);
      return sum;
    };
    const SunlitPath path =
        shadow.Along(view.eye, view.directions[i], std::min(ray.length_m, 2000e3));
    const auto march = [&](double offset) {
      return light(MarchWithOcclusion(air, view, i, *ground.terrain, 512, offset));
    };
    double fine = 0.0;
    for (int k = 0; k < 8; ++k) fine += march((k + 0.5) / 8.0) / 8.0;
    pixels.push_back({light(air.Scatter(aerial.Sample(ray, &path, {}))), march(0.5), fine,
                      light(air.Scatter(aerial.Sample(ray, nullptr, {})))});
  }
  return pixels;
}

/// Errors of one way against 4096 occlusion rays, relative to the mean of the picture.
struct ShaftError {
  double rms, at_99_percent;
};

inline ShaftError ErrorOf(const std::vector<ShaftPixel>& pixels, double ShaftPixel::*way) {
  std::vector<double> error;
  double square = 0.0;
  double mean = 0.0;
  for (const ShaftPixel& pixel : pixels) {
    error.push_back(std::abs(pixel.*way - pixel.fine));
    square += error.back() * error.back() / static_cast<double>(pixels.size());
    mean += pixel.fine / static_cast<double>(pixels.size());
  }
  std::sort(error.begin(), error.end());
  return {std::sqrt(square) / mean, error[error.size() * 99 / 100] / mean};
}

}  // namespace alpenglow
