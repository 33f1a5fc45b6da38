// SPDX-License-Identifier: MIT
#include "renderer/surface.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "atmosphere/constants.h"
#include "atmosphere/spectrum.h"

namespace alpenglow {
namespace {

Bands<float> AlbedoBands(const std::array<double, 3>& rgb, std::span<const double> wavelengths_nm) {
  const std::vector<double> albedo = AlbedoFromLinearSrgb(rgb, wavelengths_nm);
  Bands<float> bands(albedo.size());
  for (std::size_t band = 0; band < albedo.size(); ++band)
    bands[band] = static_cast<float>(albedo[band]);
  return bands;
}

float SmoothStep(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return static_cast<float>(t * t * (3.0 - 2.0 * t));
}

Bands<float> Mix(const Bands<float>& a, const Bands<float>& b, float share_of_b) {
  Bands<float> mixed(a.count);
  for (std::size_t band = 0; band < a.count; ++band) {
    mixed[band] = a[band] + share_of_b * (b[band] - a[band]);
  }
  return mixed;
}

}  // namespace

// Linear sRGB of broad classes of ground, chosen within the ranges of visible albedo that Oke
// (1987), Boundary Layer Climates, table 1.1 gives: forest 0.05-0.15, grass 0.1-0.25, rock and soil
// 0.1-0.3, snow 0.7-0.95.
MountainSurface::MountainSurface(std::span<const double> wavelengths_nm, const MountainCover& cover)
    : cover_(cover),
      forest_(AlbedoBands({0.035, 0.060, 0.022}, wavelengths_nm)),
      meadow_(AlbedoBands({0.095, 0.120, 0.045}, wavelengths_nm)),
      rock_(AlbedoBands({0.185, 0.170, 0.150}, wavelengths_nm)),
      snow_(AlbedoBands({0.820, 0.840, 0.860}, wavelengths_nm)) {}

Bands<float> MountainSurface::Albedo(double altitude_m, double normal_up) const {
  const float bare = SmoothStep(cover_.tree_line_m - 100.0, cover_.tree_line_m + 500.0, altitude_m);
  const float steep = 1.0F - SmoothStep(0.62, 0.82, normal_up);
  const float wooded =
      1.0F - SmoothStep(cover_.tree_line_m - 400.0, cover_.tree_line_m, altitude_m);
  const float sloping = 1.0F - SmoothStep(0.94, 0.99, normal_up);
  const Bands<float> green = Mix(meadow_, forest_, wooded * (0.35F + 0.65F * sloping));
  const Bands<float> ground = Mix(green, rock_, std::max(bare, steep));
  // Gentle ground keeps snow 300 m below the line; faces over about 45 degrees shed it.
  const float cold = SmoothStep(cover_.snow_line_m - 300.0, cover_.snow_line_m + 500.0, altitude_m);
  const float holds = SmoothStep(0.55, 0.80, normal_up);
  return Mix(ground, snow_, cold * holds);
}

MountainCover CoverAtLatitude(double latitude_rad) {
  const double latitude = std::abs(latitude_rad) / kRadiansPerDegree;
  const double beyond = std::max(latitude - 30.0, 0.0);
  const double tree_line = std::max(4000.0 - 115.0 * beyond, 0.0);
  return {tree_line, tree_line + 800.0 + 4.0 * beyond};
}

}  // namespace alpenglow
