// SPDX-License-Identifier: MIT
// This header provides spectra of simulated daylight: skies, distant land, sun and ground, from
// noon to deep twilight. The conversion from bands to colour is trained and tested on them.
//
// Light is given relative to the sun above the air, f = L / E [1/sr] or E' / E [1], because f is
// smooth over wavelengths where the sun's spectrum is not. It contains all orders of scattering
// (SingleScattering and MultipleScattering).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "atmosphere/medium/medium.h"
#include "lut/multiple_scattering/multiple_scattering.h"

namespace alpenglow::lut {

/// Returns 380, 385 ... 775 nm: the reference for colour. Steps of 10 nm are not enough: the
/// corners of the table of ozone lie between them, and a piecewise linear function through 40 bands
/// has an error of CIEDE2000 0.08.
[[nodiscard]] std::vector<double> FineWavelengths();

/// An atmosphere of the family: a preset with other aerosol and ozone.
struct SkyConditions {
  std::string preset = "earth";
  double aerosol_optical_depth_550 = 0.05;
  double angstrom_exponent = 1.3;
  double ozone_dobson = 300.0;
  double ground_albedo_scale = 1.0;  // times the preset's; the product is at most 1
};

/// Ranges from which conditions are drawn. One in six atmospheres has the clear grey aerosol of
/// optical depth 0.005; for the others the optical depth is uniform in its logarithm.
struct SkyFamily {
  std::string preset = "earth";
  double optical_depth_low = 0.05, optical_depth_high = 0.3;
  double angstrom_low = 1.1, angstrom_high = 1.5;
  double ozone_low_dobson = 250.0, ozone_high_dobson = 400.0;
};

enum class SkyRegime { kDay, kSunset, kTwilight, kDirectSun };
inline constexpr SkyRegime kSkyRegimes[] = {SkyRegime::kDay, SkyRegime::kSunset,
                                            SkyRegime::kTwilight, SkyRegime::kDirectSun};
/// Returns "day" (sun 6 to 60 degrees high), "sunset" (-2 to 6), "twilight" (-10 to -2), "direct
/// sun" (0 to 60).
[[nodiscard]] const char* NameOf(SkyRegime regime);

struct SkySpectrum {
  SkyRegime regime = SkyRegime::kDay;
  std::vector<double> relative_to_sun;  // at FineWavelengths()
};

struct SkyDrawing {
  std::uint64_t seed = 1;
  int atmospheres = 36;
  int suns = 4;    // per regime and atmosphere
  int views = 12;  // per sun: a quarter of them end at land 2 to 150 km away
  SkyFamily family;
  /// Options of multiply scattered light; colour needs less accuracy than radiance.
  MultipleScatteringOptions multiple_scattering{.altitudes = 14,
                                                .sun_angles = 28,
                                                .degree = 2,
                                                .zenith_nodes = 6,
                                                .azimuth_nodes = 4,
                                                .ray_nodes = 8,
                                                .tolerance = 1e-3};
};

/// Simulation of one atmosphere at FineWavelengths().
class SkySimulator {
 public:
  SkySimulator(const SkyConditions& conditions, const MultipleScatteringOptions& options);
  ~SkySimulator();
  SkySimulator(const SkySimulator&) = delete;
  SkySimulator& operator=(const SkySimulator&) = delete;

  /// Returns the radiance along the ray, all orders, with the ground at its end if the ray hits it.
  /// A ray of finite length ends at horizontal land of the ground's albedo [1/sr].
  [[nodiscard]] std::vector<double> Radiance(const ViewRay& ray) const;
  /// Returns the irradiance from the sky on a horizontal plane, without the sun [1].
  [[nodiscard]] std::vector<double> SkyIrradiance(double altitude_m, double mu_s) const;
  /// Returns the irradiance from the sun on a plane that faces it [1].
  [[nodiscard]] std::vector<double> SunIrradiance(double altitude_m, double mu_s) const;

 private:
  struct Part;
  std::vector<std::unique_ptr<const Part>> parts_;
};

/// Draws atmospheres, suns and views and simulates them. The result is deterministic. Spectra
/// fainter than the natural night sky (1e-9 of the sun's irradiance) are omitted.
[[nodiscard]] std::vector<SkySpectrum> DrawSkySpectra(const SkyDrawing& drawing);

}  // namespace alpenglow::lut
