// SPDX-License-Identifier: MIT
#include "renderer/ground/surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/number/constants.h"
#include "renderer/terrain/lattice_noise.h"

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

// Sum of octaves of noise from `longest_m` down, half as high with each; octaves shorter than two
// footprints fade out, so that distant ground does not glitter. Calls visit(octave, amplitude,
// wavelength).
template <typename Visit>
void VisitOctaves(const GroundPoint& point, double longest_m, int octaves, const Visit& visit) {
  double amplitude = 1.0, wavelength = longest_m;
  for (int octave = 0; octave < octaves; ++octave, amplitude *= 0.5, wavelength *= 0.5) {
    const double kept = std::clamp(wavelength / (2.0 * point.footprint_m) - 1.0, 0.0, 1.0);
    if (kept == 0.0) break;
    visit(octave, kept * amplitude, wavelength);
  }
}

double DetailNoise(const GroundPoint& point, double longest_m, int octaves, std::uint32_t seed) {
  double sum = 0.0;
  VisitOctaves(point, longest_m, octaves, [&](int octave, double amplitude, double wavelength) {
    sum += amplitude * GradientNoise(point.east_m / wavelength, point.north_m / wavelength,
                                     seed + static_cast<std::uint32_t>(octave));
  });
  return sum;
}

}  // namespace

// Linear sRGB of broad classes of ground, chosen within the ranges of visible albedo that Oke
// (1987), Boundary Layer Climates, table 1.1 gives: forest 0.05-0.15, grass 0.1-0.25, rock and soil
// 0.1-0.3, snow 0.7-0.95.
MountainSurface::MountainSurface(std::span<const double> wavelengths_nm, const MountainCover& cover)
    : cover_(cover),
      materials_{AlbedoBands({0.038, 0.054, 0.027}, wavelengths_nm),
                 AlbedoBands({0.098, 0.115, 0.055}, wavelengths_nm),
                 AlbedoBands({0.185, 0.170, 0.150}, wavelengths_nm),
                 AlbedoBands({0.820, 0.840, 0.860}, wavelengths_nm)} {}

Bands<float> MountainSurface::Albedo(const GroundPoint& point, double normal_up) const {
  const double broad = DetailNoise(point, 900.0, 5, 11U);
  const double fine = DetailNoise(point, 70.0, 4, 29U);
  const double altitude = point.altitude_m + 260.0 * broad + 60.0 * fine;
  const double level = normal_up + 0.05 * broad + 0.05 * fine;
  const float bare = SmoothStep(cover_.tree_line_m - 50.0, cover_.tree_line_m + 450.0, altitude);
  const float steep = 1.0F - SmoothStep(0.66, 0.78, level);
  const float wooded =
      1.0F - SmoothStep(cover_.tree_line_m - 250.0, cover_.tree_line_m - 50.0, altitude);
  const float sloping = 1.0F - SmoothStep(0.95, 0.985, level);
  const Bands<float> green =
      Mix(materials_.meadow, materials_.forest, wooded * (0.35F + 0.65F * sloping));
  const Bands<float> ground = Mix(green, materials_.rock, std::max(bare, steep));
  // Gentle ground keeps snow 200 m below the line; faces over about 45 degrees shed it.
  const float cold = SmoothStep(cover_.snow_line_m - 200.0, cover_.snow_line_m + 350.0, altitude);
  const float holds = SmoothStep(0.60, 0.76, level);
  Bands<float> albedo = Mix(ground, materials_.snow, cold * holds);
  const float bare_share = 1.0F - cold * holds;  // fresh snow is even, ground is not
  const auto tone = static_cast<float>(std::clamp(0.3 * fine + 0.15 * broad, -0.5, 0.5));
  for (std::size_t band = 0; band < albedo.count; ++band) {
    albedo[band] = std::min(albedo[band] * (1.0F + bare_share * tone), 1.0F);
  }
  return albedo;
}

glm::dvec3 MountainSurface::DetailedNormal(const GroundPoint& point, const glm::dvec3& normal) {
  constexpr double kLongest_m = 220.0;
  constexpr double kHeight_m = 14.0;  // of the longest octave
  glm::dvec3 tilt(0.0);
  VisitOctaves(point, kLongest_m, 5, [&](int octave, double amplitude, double wavelength) {
    const NoiseSlope noise =
        GradientNoiseSlope(point.east_m / wavelength, point.north_m / wavelength,
                           47U + static_cast<std::uint32_t>(octave));
    tilt -= kHeight_m * amplitude / wavelength * glm::dvec3(noise.by_x, noise.by_y, 0.0);
  });
  return glm::normalize(normal + tilt * std::max(normal.z, 0.0));
}

MountainCover CoverInSeason(double latitude_rad, int modified_julian_day) {
  const double latitude = std::abs(latitude_rad) / kRadiansPerDegree;
  const double beyond = std::max(latitude - 30.0, 0.0);
  const double tree_line = std::max(4000.0 - 115.0 * beyond, 0.0);
  // Coldest ground in mid February (north) or mid August (south); day 59000 is 2020-05-31.
  const double year = (modified_julian_day - 59000 + 105.0) / 365.2425;
  const double winter = std::cos(2.0 * kPi * year) * (latitude_rad < 0.0 ? -1.0 : 1.0);
  const double seasonal = 1300.0 * std::clamp(latitude / 35.0, 0.0, 1.0) * winter;
  return {tree_line, tree_line + 800.0 + 4.0 * beyond - seasonal};
}

}  // namespace alpenglow
