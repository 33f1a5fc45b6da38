// SPDX-License-Identifier: MIT
#include "renderer/ground/surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/number/constants.h"
#include "renderer/ground/ground_cover.h"
#include "renderer/ground/reflectance.h"
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

/// A family of noise of ground_cover.glsl.
struct Noise {
  int longest_m, octaves;
  std::uint32_t seed;
  int fall;
};
constexpr Noise kBroad{shared::kBroadWave_m, shared::kBroadOctaves, shared::kBroadSeed,
                       shared::kBroadFall};
constexpr Noise kFine{shared::kFineWave_m, shared::kFineOctaves, shared::kFineSeed,
                      shared::kFineFall};
constexpr Noise kRelief{shared::kReliefWave_m, shared::kReliefOctaves, shared::kReliefSeed,
                        shared::kReliefFall};
constexpr Noise kGrain{shared::kGrainWave_m, shared::kGrainOctaves, shared::kGrainSeed,
                       shared::kGrainFall};

constexpr Noise kWaves{shared::kWaveWave_m, shared::kWaveOctaves, shared::kWaveSeed,
                       shared::kWaveFall};

// Calls visit(seed, amplitude, wavelength) for the octaves that a footprint keeps.
template <typename Visit>
void VisitOctaves(const GroundPoint& point, const Noise& noise, const Visit& visit) {
  double amplitude = 1.0, wavelength = noise.longest_m;
  for (int octave = 0; octave < noise.octaves;
       ++octave, amplitude /= noise.fall, wavelength *= 0.5) {
    const double kept = shared::OctaveShare(wavelength, point.footprint_m);
    if (kept == 0.0) break;
    visit(noise.seed + static_cast<std::uint32_t>(octave), kept * amplitude, wavelength);
  }
}

double DetailNoise(const GroundPoint& point, const Noise& noise) {
  double sum = 0.0;
  VisitOctaves(point, noise, [&](std::uint32_t seed, double amplitude, double wavelength) {
    sum += amplitude * GradientNoise(point.east_m / wavelength, point.north_m / wavelength, seed);
  });
  return sum;
}

}  // namespace

// Linear sRGB of broad classes of ground, chosen within the ranges of visible albedo that Oke
// (1987), Boundary Layer Climates, table 1.1 gives: forest 0.05-0.15, grass 0.1-0.25, rock and soil
// 0.1-0.3, snow 0.7-0.95.
MountainSurface::MountainSurface(std::span<const double> wavelengths_nm, const MountainCover& cover,
                                 double wetness)
    : cover_(cover),
      materials_{AlbedoBands({0.038, 0.054, 0.027}, wavelengths_nm),
                 Wetted(AlbedoBands({0.098, 0.115, 0.055}, wavelengths_nm), wetness),
                 Wetted(AlbedoBands({0.185, 0.170, 0.150}, wavelengths_nm), wetness),
                 AlbedoBands({0.820, 0.840, 0.860}, wavelengths_nm)} {}

Bands<float> MountainSurface::Albedo(const GroundPoint& point, double normal_up,
                                     const std::optional<MappedCover>& mapped) const {
  const double broad = DetailNoise(point, kBroad);
  const double fine = DetailNoise(point, kFine);
  const double grain = DetailNoise(point, kGrain);
  const double altitude = shared::WaveringAltitude(point.altitude_m, broad, fine);
  const double level = shared::WaveringLevel(normal_up, broad, fine);
  const auto rise = [](double value) { return static_cast<float>(value); };
  const float forest =
      mapped ? mapped->wood
             : shared::ForestShare(rise(shared::TreelessRise(altitude, cover_.tree_line_m)),
                                   rise(shared::FlatRise(normal_up)), rise(broad), rise(fine));
  const float rock = shared::RockShare(
      mapped ? mapped->stone : rise(shared::BareRise(altitude, cover_.tree_line_m)),
      mapped ? 1.0F : rise(shared::SoilRise(level)), forest, rise(grain));
  const float lying =
      rise(shared::ColdRise(altitude, cover_.snow_line_m)) * rise(shared::SnowHoldRise(level));
  const float snow = std::max(shared::SnowSeen(lying, forest, rock), mapped ? mapped->snow : 0.0F);
  const auto tone = shared::GroundTone(rise(broad), rise(fine), rise(grain), forest, rock);
  Bands<float> albedo(materials_.rock.count);
  for (std::size_t band = 0; band < albedo.count; ++band) {
    const float green =
        shared::PartlyCovered(materials_.meadow[band], materials_.forest[band], forest);
    albedo[band] =
        shared::CoverAlbedo(green, materials_.rock[band], materials_.snow[band], rock, snow, tone);
  }
  return albedo;
}

glm::dvec3 MountainSurface::DetailedNormal(const GroundPoint& point, const glm::dvec3& normal) {
  glm::dvec3 tilt(0.0);
  VisitOctaves(point, kRelief, [&](std::uint32_t seed, double amplitude, double wavelength) {
    const NoiseSlope noise =
        GradientNoiseSlope(point.east_m / wavelength, point.north_m / wavelength, seed);
    tilt -=
        shared::kReliefHeight_m * amplitude / wavelength * glm::dvec3(noise.by_x, noise.by_y, 0.0);
  });
  return glm::normalize(normal + tilt * std::max(normal.z, 0.0));
}

glm::dvec3 WavySurface::Normal(const glm::dvec3& up) const {
  return glm::normalize(up - glm::dvec3(slope_east, slope_north, 0.0));
}

WavySurface WavesAt(const GroundPoint& point, double slope_variance) {
  const double longest_m = shared::LongestWave(slope_variance);
  const double each = shared::WaveOctaveVariance(slope_variance, longest_m);
  const double shown = shared::WaveShown(std::max(point.cosine, 0.0), slope_variance);
  WavySurface waves{0.0, 0.0, slope_variance};
  VisitOctaves(point, kWaves, [&](std::uint32_t seed, double height, double wavelength) {
    const double kept = shown * height * shared::kWaveWave_m / wavelength *
                        shared::WaveRaised(wavelength, longest_m);
    if (kept == 0.0) return;
    const NoiseSlope noise =
        GradientNoiseSlope(point.east_m / wavelength, point.north_m / wavelength, seed);
    waves.slope_east += kept * shared::WaveSlope(each) * noise.by_x;
    waves.slope_north += kept * shared::WaveSlope(each) * noise.by_y;
    waves.slope_variance -= kept * kept * each;
  });
  return waves;
}

}  // namespace alpenglow
