// SPDX-License-Identifier: MIT
#include "lut/table_search/sky_spectra.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/ray/ray.h"
#include "atmosphere/ray/single_scattering.h"

namespace alpenglow::lut {
namespace {

constexpr std::size_t kFineCount = 80;
constexpr double kNightSky_per_sr = 1e-9;

Medium MediumOfSky(const SkyConditions& conditions, const std::vector<double>& wavelengths_nm) {
  Medium medium = MediumPreset(conditions.preset, wavelengths_nm);
  for (std::size_t i = 0; i < wavelengths_nm.size(); ++i) {
    const double albedo = medium.mie_scattering_per_m[i] / medium.mie_extinction_per_m[i];
    medium.mie_extinction_per_m[i] =
        conditions.aerosol_optical_depth_550 / medium.mie_scale_height_m *
        std::pow(wavelengths_nm[i] / 550.0, -conditions.angstrom_exponent);
    medium.mie_scattering_per_m[i] = albedo * medium.mie_extinction_per_m[i];
    medium.ozone_absorption_per_m[i] *= conditions.ozone_dobson / 300.0;  // column of the presets
    medium.ground_albedo[i] =
        std::min(1.0, conditions.ground_albedo_scale * medium.ground_albedo[i]);
  }
  Validate(medium);
  return medium;
}

// Draws uniformly in [low, high), with equal results on every platform.
class Drawer {
 public:
  explicit Drawer(std::uint64_t seed) : engine_(seed) {}
  double Uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  double LogUniform(double low, double high) {
    return std::exp(Uniform(std::log(low), std::log(high)));
  }

 private:
  std::mt19937_64 engine_;
};

SkyConditions DrawConditions(const SkyFamily& family, int number, Drawer& draw) {
  SkyConditions conditions;
  conditions.preset = family.preset;
  conditions.aerosol_optical_depth_550 =
      draw.LogUniform(family.optical_depth_low, family.optical_depth_high);
  conditions.angstrom_exponent = draw.Uniform(family.angstrom_low, family.angstrom_high);
  conditions.ozone_dobson = draw.Uniform(family.ozone_low_dobson, family.ozone_high_dobson);
  conditions.ground_albedo_scale = draw.LogUniform(0.4, 6.0);
  if (number % 6 == 0) {
    conditions.aerosol_optical_depth_550 = 0.005;
    conditions.angstrom_exponent = 0.0;
  }
  return conditions;
}

struct ElevationRange {
  double low_deg, high_deg;
};

ElevationRange SpectrumRangeOf(SkyRegime regime) {
  switch (regime) {
    case SkyRegime::kDay:
      return {6.0, 60.0};
    case SkyRegime::kSunset:
      return {-2.0, 6.0};
    case SkyRegime::kTwilight:
      return {-10.0, -2.0};
    case SkyRegime::kDirectSun:
      return {0.0, 60.0};
  }
  throw InternalError("no such regime of daylight");
}

// Half of the views lie within 10 degrees of the horizontal, where paths are long. Three of ten
// observers fly, the others stand.
ViewRay DrawView(double elevation_deg, bool to_land, Drawer& draw) {
  const bool flies = draw.Uniform(0.0, 1.0) < 0.3;
  const double altitude_m = flies ? draw.LogUniform(300.0, 12000.0) : draw.LogUniform(2.0, 100.0);
  const bool low = draw.Uniform(0.0, 1.0) < 0.5;
  const double sky_deg = low ? draw.Uniform(80.0, 90.0) : draw.Uniform(0.0, 80.0);
  const double view_deg = to_land ? draw.Uniform(88.0, 94.0) : sky_deg;
  ViewRay ray = RayFromAngles(altitude_m, view_deg, draw.Uniform(0.0, 180.0), 90.0 - elevation_deg);
  if (to_land) ray.length_m = draw.LogUniform(2000.0, 150000.0);
  return ray;
}

struct Point {
  double altitude_m, mu_s;
};

Point PointAlong(const ViewRay& ray, double distance_m, double planet_radius_m) {
  const double r = planet_radius_m + ray.altitude_m;
  const double end = std::sqrt(r * r + distance_m * (distance_m + 2.0 * r * ray.mu));
  return {std::max(0.0, end - planet_radius_m), (r * ray.mu_s + distance_m * ray.nu) / end};
}

}  // namespace

const char* NameOf(SkyRegime regime) {
  constexpr const char* kNames[] = {"day", "sunset", "twilight", "direct sun"};
  return kNames[static_cast<std::size_t>(regime)];
}

std::vector<double> FineWavelengths() {
  std::vector<double> wavelengths_nm;
  for (std::size_t i = 0; i < kFineCount; ++i) {
    wavelengths_nm.push_back(380.0 + 5.0 * static_cast<double>(i));
  }
  return wavelengths_nm;
}

// A group of as many wavelengths as an integrator supports.
struct SkySimulator::Part {
  Part(const Medium& medium, const MultipleScatteringOptions& options)
      : air(medium), multiple_scattering(medium, options) {}

  // Returns the radiance of horizontal ground with the medium's albedo, lit by sun and sky.
  [[nodiscard]] Bands<float> GroundRadiance(const Point& point) const {
    const Bands<float> sun = air.TransmittanceToSpace(point.altitude_m, point.mu_s);
    Bands<float> radiance = multiple_scattering.SkyIrradiance(point.altitude_m, point.mu_s);
    for (std::size_t band = 0; band < air.bands(); ++band) {
      radiance[band] += sun[band] * static_cast<float>(std::max(0.0, point.mu_s));
      radiance[band] *= static_cast<float>(air.medium().ground_albedo[band] / kPi);
    }
    return radiance;
  }

  [[nodiscard]] Bands<float> Radiance(const ViewRay& ray) const {
    const RaySamples<float> samples =
        air.Sample(ray, {.nodes = 12, .split_ozone = false, .dark_samples = true});
    Bands<float> radiance = air.Inscatter(air.Scatter(samples), ray.nu);
    const Bands<float> more = multiple_scattering.InscatterAlong(samples, ray.nu);
    for (std::size_t band = 0; band < air.bands(); ++band) radiance[band] += more[band];
    if (samples.extent.end == RayEnd::kSpace) return radiance;
    const Bands<float> ground =
        GroundRadiance(PointAlong(ray, samples.extent.end_m, air.medium().planet_radius_m));
    const Bands<float> transmittance = air.TransmittanceAlong(ray);
    for (std::size_t band = 0; band < air.bands(); ++band) {
      radiance[band] += transmittance[band] * ground[band];
    }
    return radiance;
  }

  SingleScattering<float> air;
  MultipleScattering multiple_scattering;
};

namespace {

void Append(const Bands<float>& bands, std::vector<double>& values) {
  for (std::size_t band = 0; band < bands.count; ++band) {
    values.push_back(static_cast<double>(bands[band]));
  }
}

}  // namespace

SkySimulator::SkySimulator(const SkyConditions& conditions,
                           const MultipleScatteringOptions& options) {
  const std::vector<double> all = FineWavelengths();
  static_assert(kFineCount % kMaxBands == 0);
  for (auto first = all.begin(); first != all.end(); first += kMaxBands) {
    parts_.push_back(std::make_unique<const Part>(
        MediumOfSky(conditions, std::vector<double>(first, first + kMaxBands)), options));
  }
}

SkySimulator::~SkySimulator() = default;

std::vector<double> SkySimulator::Radiance(const ViewRay& ray) const {
  std::vector<double> values;
  for (const auto& part : parts_) Append(part->Radiance(ray), values);
  return values;
}

std::vector<double> SkySimulator::SkyIrradiance(double altitude_m, double mu_s) const {
  std::vector<double> values;
  for (const auto& part : parts_)
    Append(part->multiple_scattering.SkyIrradiance(altitude_m, mu_s), values);
  return values;
}

std::vector<double> SkySimulator::SunIrradiance(double altitude_m, double mu_s) const {
  std::vector<double> values;
  for (const auto& part : parts_) Append(part->air.TransmittanceToSpace(altitude_m, mu_s), values);
  return values;
}

namespace {

void DrawUnderOneSun(const SkySimulator& simulator, SkyRegime regime, double elevation_deg,
                     int views, Drawer& draw, std::vector<SkySpectrum>& spectra) {
  const auto keep = [&](std::vector<double> spectrum) {
    if (*std::min_element(spectrum.begin(), spectrum.end()) <= 0.0) return;
    if (spectrum[kFineCount / 2] < kNightSky_per_sr) return;
    spectra.push_back({regime, std::move(spectrum)});
  };
  const double mu_s = std::sin(elevation_deg * kRadiansPerDegree);
  if (regime == SkyRegime::kDirectSun) {
    keep(simulator.SunIrradiance(draw.LogUniform(2.0, 12000.0), mu_s));
    return;
  }
  for (int view = 0; view < views; ++view) {
    keep(simulator.Radiance(DrawView(elevation_deg, view % 4 == 3, draw)));
  }
  keep(simulator.SkyIrradiance(2.0, mu_s));
}

}  // namespace

std::vector<SkySpectrum> DrawSkySpectra(const SkyDrawing& drawing) {
  Drawer draw(drawing.seed);
  std::vector<SkySpectrum> spectra;
  for (int number = 0; number < drawing.atmospheres; ++number) {
    const SkySimulator simulator(DrawConditions(drawing.family, number, draw),
                                 drawing.multiple_scattering);
    for (const SkyRegime regime : kSkyRegimes) {
      const ElevationRange range = SpectrumRangeOf(regime);
      // Direct light has only one spectrum per sun, so it gets three times as many suns.
      const int suns = regime == SkyRegime::kDirectSun ? 3 * drawing.suns : drawing.suns;
      for (int sun = 0; sun < suns; ++sun) {
        const double step = (range.high_deg - range.low_deg) / suns;
        const double elevation_deg = range.low_deg + step * (sun + draw.Uniform(0.0, 1.0));
        DrawUnderOneSun(simulator, regime, elevation_deg, drawing.views, draw, spectra);
      }
    }
  }
  return spectra;
}

}  // namespace alpenglow::lut
