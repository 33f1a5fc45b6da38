// SPDX-License-Identifier: MIT
#include "lut/multiple_scattering/moment_grid.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/medium/phase_text.h"

namespace alpenglow::lut {

MomentGrid GridOf(const Medium& medium, const MultipleScatteringOptions& options) {
  const SunAxis& sun = MultipleScattering::SunNodes();
  MomentGrid grid{};
  grid.altitudes = static_cast<std::size_t>(options.altitudes);
  grid.suns = static_cast<std::size_t>(options.sun_angles);
  grid.degree = static_cast<std::size_t>(options.degree);
  grid.polarised = medium.polarised;
  grid.top_km = static_cast<float>(medium.atmosphere_height_m / 1000.0);
  grid.sun_centre = static_cast<float>(sun.centre());
  grid.sun_width = static_cast<float>(sun.width());
  grid.first_asinh = static_cast<float>(sun.low());
  grid.cells_a_unit = static_cast<float>((options.sun_angles - 1) / (sun.high() - sun.low()));
  // In earth's air moments fall by a factor e per 1.25 degrees. On other planets the rate is
  // proportional to radius over scale height. The fall over the sun axis is limited to a factor
  // 1e-6.
  const double fall = 46.0 / 796.0 * medium.planet_radius_m / medium.rayleigh_scale_height_m;
  grid.twilight_start = -0.03F;
  grid.twilight_width = 0.05F;
  grid.twilight_fall = static_cast<float>(std::min(fall, 50.0));
  return grid;
}

DeltaScaledMedium ScatteringMedium(const Medium& medium, const MultipleScatteringOptions& options) {
  if (options.delta_m) return WithoutPeak(medium, options.degree);
  return {medium, {}, MieLegendreCoefficients(medium, options.degree)};
}

float TwilightOf(const MomentGrid& grid, double mu_s) {
  const double x = static_cast<double>(grid.twilight_start) - mu_s;
  const double width = static_cast<double>(grid.twilight_width);
  return static_cast<float>(std::exp(-0.5 * static_cast<double>(grid.twilight_fall) *
                                     (x + std::sqrt(x * x + width * width))));
}

float RayleighChi2(const Medium& medium, std::size_t band) {
  return 0.1F * static_cast<float>(shared::RoundShare(Depolarisation(medium, band)));
}

BlockShape ShapeOfBlock(const Medium& medium, const std::vector<double>& chi, std::size_t degree,
                        std::size_t first_band) {
  const std::size_t bands = medium.wavelengths_nm.size();
  BlockShape shape{};
  for (std::size_t lane = 0; lane < kBlockBands && first_band + lane < bands; ++lane) {
    const std::size_t band = first_band + lane;
    shape.rayleigh_chi2[lane] = RayleighChi2(medium, band);
    for (std::size_t l = 0; l <= degree; ++l)
      shape.mie[l][lane] = static_cast<float>(chi[l * bands + band]);
  }
  return shape;
}

double MuSOfNode(const MomentGrid& grid, std::size_t sun) {
  const double mu_s = MultipleScattering::SunNodes().MuS(static_cast<double>(sun) /
                                                         static_cast<double>(grid.suns - 1));
  return grid.polarised ? std::min(mu_s, kHighestPolarisedSun) : mu_s;
}

double SineOf(double cosine) { return std::sqrt(std::max((1.0 - cosine) * (1.0 + cosine), 0.0)); }

float SunSine(double mu_s) { return static_cast<float>(SineOf(mu_s)); }

CubicTaps SunTaps(const MomentGrid& grid, double mu_s) {
  const int suns = static_cast<int>(grid.suns);
  CubicTaps taps = TapsAt(MultipleScattering::SunCoordinate(mu_s), suns);
  const float here = TwilightOf(grid, mu_s);
  for (std::size_t tap = 0; tap < 4; ++tap) {
    const double v = static_cast<double>(taps.node[tap]) / (suns - 1);
    taps.weight[tap] *= here / TwilightOf(grid, MultipleScattering::SunNodes().MuS(v));
  }
  return taps;
}

std::vector<float> TwilightAtNodes(const MomentGrid& grid) {
  std::vector<float> twilight;
  for (std::size_t sun = 0; sun < grid.suns; ++sun) {
    const double v = static_cast<double>(sun) / static_cast<double>(grid.suns - 1);
    twilight.push_back(TwilightOf(grid, MultipleScattering::SunNodes().MuS(v)));
  }
  return twilight;
}

}  // namespace alpenglow::lut
