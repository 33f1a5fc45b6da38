// SPDX-License-Identifier: MIT
// Spectra of simulated daylight: skies, distant land, sun and ground, from noon to deep twilight.
// What the way from bands to colour is trained and tested on.
//
// Light is given relative to the sun above the air, f = L / E [1/sr]
// or E' / E [1], because f is smooth over wavelengths where the sun
// is not. All orders of scattering (AirIntegrator and DiffuseLight).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "atmosphere/air/medium.h"
#include "lut/diffuse/multiple_scattering.h"

namespace alpenglow::lut {

/// 380, 385 ... 775 nm: the reference for colour. Every 10 nm is not enough: the table of ozone has
/// its corners between, and a broken line through 40 bands misses by a CIEDE2000 of 0.08.
[[nodiscard]] std::vector<double> FineWavelengths();

/// An atmosphere of the family: a preset with other aerosol and ozone.
struct SkyConditions {
  std::string preset = "earth";
  double aerosol_optical_depth_550 = 0.05;
  double angstrom_exponent = 1.3;
  double ozone_dobson = 300.0;
  double ground_albedo_scale = 1.0;  // times the preset's, at most 1
};

/// Ranges that conditions are drawn from. One in six atmospheres has the clear grey aerosol of
/// optical depth 0.005; the others have one uniform in its logarithm.
struct SkyFamily {
  std::string preset = "earth";
  double optical_depth_low = 0.05, optical_depth_high = 0.3;
  double angstrom_low = 1.1, angstrom_high = 1.5;
  double ozone_low_dobson = 250.0, ozone_high_dobson = 400.0;
};

enum class SkyRegime { kDay, kSunset, kTwilight, kDirectSun };
inline constexpr SkyRegime kSkyRegimes[] = {SkyRegime::kDay, SkyRegime::kSunset,
                                            SkyRegime::kTwilight, SkyRegime::kDirectSun};
/// "day" (sun 6 to 60 degrees high), "sunset" (-2 to
/// 6), "twilight" (-10 to -2), "direct sun" (0 to 60).
[[nodiscard]] const char* NameOf(SkyRegime regime);

struct SkySpectrum {
  SkyRegime regime = SkyRegime::kDay;
  std::vector<double> relative_to_sun;  // at FineWavelengths()
};

struct SkyDrawing {
  std::uint64_t seed = 1;
  int atmospheres = 36;
  int suns = 4;    // of each regime and atmosphere
  int views = 12;  // of each sun: a quarter of them end at land 2 to 150 km away
  SkyFamily family;
  /// Colour needs less than radiance.
  DiffuseLightOptions diffuse{.altitudes = 14,
                              .sun_angles = 28,
                              .degree = 2,
                              .zenith_nodes = 6,
                              .azimuth_nodes = 4,
                              .ray_nodes = 8,
                              .tolerance = 1e-3};
};

/// One atmosphere at FineWavelengths().
class SkySimulator {
 public:
  SkySimulator(const SkyConditions& conditions, const DiffuseLightOptions& options);
  ~SkySimulator();
  SkySimulator(const SkySimulator&) = delete;
  SkySimulator& operator=(const SkySimulator&) = delete;

  /// Along the ray, all orders, with the ground at its end if it meets it; a ray of finite length
  /// ends at horizontal land of the ground's albedo [1/sr].
  [[nodiscard]] std::vector<double> Radiance(const ViewRay& ray) const;
  /// From the sky on a horizontal plane, without the sun [1].
  [[nodiscard]] std::vector<double> SkyIrradiance(double altitude_m, double mu_s) const;
  /// From the sun on a plane that faces it [1].
  [[nodiscard]] std::vector<double> SunIrradiance(double altitude_m, double mu_s) const;

 private:
  struct Part;
  std::vector<std::unique_ptr<const Part>> parts_;
};

/// Draws atmospheres, suns and views and simulates them. Deterministic. Spectra fainter than the
/// natural night sky (1e-9 of the sun's irradiance) are left out.
[[nodiscard]] std::vector<SkySpectrum> DrawSkySpectra(const SkyDrawing& drawing);

}  // namespace alpenglow::lut
