// SPDX-License-Identifier: MIT
// Measures the green tint of the sky opposite a low sun, and its dependence on bands, ozone,
// aerosol and ground.
//
//   studies sky_tint
//
// The program computes colours of the clear sky from the ground, with all orders of scattering, in
// the vertical plane of the sun on the opposite side. Each line has one kind of air and a number of
// wavelengths. Columns are views by elevation with Duv, the signed distance from the black-body
// locus in the CIE 1960 (u, v) diagram, positive towards green (Ohno 2014, Leukos 10, 47-55). A
// phase of daylight at an equal position of the locus has +0.003 (CIE 15:2018).
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/medium.h"
#include "atmosphere/ray/ray.h"
#include "atmosphere/ray/single_scattering.h"
#include "lut/multiple_scattering/multiple_scattering.h"
#include "tests/bench/studies.h"
#include "tests/fixtures/sky_spectra.h"

namespace alpenglow::lut {
namespace {

constexpr std::array kElevations_deg{2.0, 5.0, 10.0, 20.0, 45.0, 90.0};

struct Chromaticity {
  double u, v;  // CIE 1960
};

Chromaticity ChromaticityOf(const std::array<double, 3>& xyz) {
  const double sum = xyz[0] + 15.0 * xyz[1] + 3.0 * xyz[2];
  return {4.0 * xyz[0] / sum, 6.0 * xyz[1] / sum};
}

/// Returns the chromaticity of a spectrum [W m^-2 sr^-1 nm^-1] on fine wavelengths, with the colour
/// matching functions.
Chromaticity OfSpectrum(const std::vector<double>& wavelengths_nm,
                        const std::vector<double>& radiance) {
  std::array<double, 3> xyz{};
  for (std::size_t i = 0; i < radiance.size(); ++i) {
    const std::array<double, 3> matching = ColourMatching(wavelengths_nm[i]);
    for (std::size_t c = 0; c < 3; ++c) xyz[c] += matching[c] * radiance[i];
  }
  return ChromaticityOf(xyz);
}

/// Returns the distance from the locus of black bodies of 1,500 to 1e6 K, positive above it.
double Duv(const Chromaticity& colour) {
  const std::vector<double> wavelengths_nm = FineWavelengths();
  double least = std::numeric_limits<double>::infinity();
  double sign = 1.0;
  for (double mired = 1.0; mired < 667.0; mired += 1.0) {
    std::vector<double> glow;
    for (const double nm : wavelengths_nm) glow.push_back(BlackBodyRadiance(nm, 1e6 / mired));
    const Chromaticity body = OfSpectrum(wavelengths_nm, glow);
    const double away = std::hypot(colour.u - body.u, colour.v - body.v);
    if (away >= least) continue;
    least = away;
    sign = colour.v >= body.v ? 1.0 : -1.0;
  }
  return sign * least;
}

/// Differences from the preset.
struct Change {
  std::string name;
  double ozone = 1.0;           // relative to the preset
  double aerosol_depth = -1.0;  // at 550 nm; negative: as in the preset
  double angstrom = 1.3;
  double ground_albedo = 1.0;  // relative to the preset
};

Medium Changed(const Change& change, const std::vector<double>& wavelengths_nm) {
  Medium medium = MediumPreset("earth", wavelengths_nm);
  for (std::size_t i = 0; i < wavelengths_nm.size(); ++i) {
    medium.ozone_absorption_per_m[i] *= change.ozone;
    medium.ground_albedo[i] *= change.ground_albedo;
    if (change.aerosol_depth < 0.0) continue;
    const double albedo = medium.mie_scattering_per_m[i] / medium.mie_extinction_per_m[i];
    medium.mie_extinction_per_m[i] = change.aerosol_depth / medium.mie_scale_height_m *
                                     std::pow(wavelengths_nm[i] / 550.0, -change.angstrom);
    medium.mie_scattering_per_m[i] = albedo * medium.mie_extinction_per_m[i];
  }
  return medium;
}

/// Returns the sky at all elevations, one vector of bands each. Uses as many solvers as the bands
/// need.
std::vector<std::vector<double>> SkiesOf(const Change& change, double sun_deg,
                                         const std::vector<double>& wavelengths_nm) {
  std::vector<std::vector<double>> skies(kElevations_deg.size());
  for (std::size_t first = 0; first < wavelengths_nm.size(); first += kMaxBands) {
    const std::size_t last = std::min(first + kMaxBands, wavelengths_nm.size());
    const std::vector<double> some(wavelengths_nm.begin() + static_cast<std::ptrdiff_t>(first),
                                   wavelengths_nm.begin() + static_cast<std::ptrdiff_t>(last));
    const Medium medium = Changed(change, some);
    const SingleScattering<float> air(medium);
    const MultipleScattering multiple_scattering(medium);
    for (std::size_t view = 0; view < skies.size(); ++view) {
      const ViewRay ray = RayFromAngles(2.0, 90.0 - kElevations_deg[view], 180.0, 90.0 - sun_deg);
      const RaySamples<float> samples =
          air.Sample(ray, {.nodes = 24, .split_ozone = true, .dark_samples = true});
      const Spectrum once = air.Inscatter(air.Scatter(samples), ray.nu);
      const Spectrum more = multiple_scattering.InscatterAlong(samples, ray.nu);
      for (std::size_t band = 0; band < some.size(); ++band) {
        skies[view].push_back(static_cast<double>(once[band] + more[band]) *
                              medium.solar_irradiance[band]);
      }
    }
  }
  return skies;
}

void Print(const Change& change, double sun_deg, const std::vector<double>& wavelengths_nm) {
  const bool is_fine = wavelengths_nm.size() > 40;
  fmt::print("{:>4} deg  {:<34}{:>3} ", sun_deg, change.name, wavelengths_nm.size());
  for (const std::vector<double>& sky : SkiesOf(change, sun_deg, wavelengths_nm)) {
    const Chromaticity colour = is_fine ? OfSpectrum(wavelengths_nm, sky)
                                        : ChromaticityOf(BandColour(wavelengths_nm).Xyz(sky));
    fmt::print("  {:+.4f}", Duv(colour));
  }
  fmt::print("\n");
}

void Run() {
  fmt::print(
      "sun       air                           bands     at 2      5     10     20     45     "
      "90\n");
  for (const double sun_deg : {2.0, 5.0, 10.0, 20.0}) {
    const Change preset{.name = "preset earth"};
    for (const int bands : {3, 4, 6, 40}) Print(preset, sun_deg, WavelengthSet(bands));
    Print(preset, sun_deg, FineWavelengths());
  }
  for (const Change& change :
       {Change{.name = "no ozone", .ozone = 0.0}, Change{.name = "ozone 450 DU", .ozone = 1.5},
        Change{.name = "no aerosol", .aerosol_depth = 1e-6},
        Change{.name = "aerosol 0.05, Angstrom 1.3", .aerosol_depth = 0.05},
        Change{.name = "aerosol 0.1, Angstrom 1.3", .aerosol_depth = 0.1},
        Change{.name = "aerosol 0.2, Angstrom 1.3", .aerosol_depth = 0.2},
        Change{.name = "aerosol 0.1, grey", .aerosol_depth = 0.1, .angstrom = 0.0},
        Change{.name = "black ground", .ground_albedo = 0.0}})
    for (const double sun_deg : {5.0, 10.0}) Print(change, sun_deg, FineWavelengths());
}

}  // namespace
}  // namespace alpenglow::lut

void alpenglow::tests::SkyTint(int /*count*/, char** /*arguments*/) { lut::Run(); }
