// SPDX-License-Identifier: MIT
// Compares twilight by refracted rays of the sun (tests/fixtures/refracted_twilight.h) with
// twilight by straight rays, from a sun that is lifted by a fraction of its refraction (LiftForAir)
// and from the apparent sun. It then compares sunlight on the ground by RefractedBeam and by the
// straight ray from the apparent sun.
#include <fmt/core.h>

#include <array>
#include <cmath>
#include <vector>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/refraction/refracted_view.h"
#include "atmosphere/refraction/refraction.h"
#include "tests/bench/studies.h"
#include "tests/fixtures/refracted_twilight.h"

namespace {

using namespace alpenglow::atmosphere;
using alpenglow::tests::BandValues;
using alpenglow::tests::RefractedTwilight;

struct View {
  const char* name;
  double elevation_deg, azimuth_deg;  // relative to the sun
};

constexpr std::array kViews{View{"zenith", 90.0, 0.0},     View{"45 towards", 45.0, 0.0},
                            View{"45 away", 45.0, 180.0},  View{"20 across", 20.0, 90.0},
                            View{"10 towards", 10.0, 0.0}, View{"3 towards", 3.0, 0.0},
                            View{"10 away", 10.0, 180.0},  View{"2 away", 2.0, 180.0}};
constexpr std::array kElevations_deg{5.0,  3.0,  2.0,  1.0,  0.0,  -1.0, -2.0,
                                     -3.0, -4.0, -5.0, -6.0, -7.0, -8.0};

glm::dvec3 Towards(double elevation_rad, double azimuth_rad) {
  return EnuFromAngles(elevation_rad, azimuth_rad).xyz;
}

/// A rule that lifts the sun whose straight rays light the air.
struct Rule {
  const char* name;
  double share;  // of the refraction at sea level; negative: the apparent sun
};
constexpr std::array kRules{Rule{"seen", -1.0}, Rule{"true", 0.0}, Rule{"0.15", 0.15},
                            Rule{"LiftForAir", 0.2}, Rule{"0.25", 0.25}};

double LiftBy(const Rule& rule, const BendingAir& air, double truly_rad, double height_m) {
  if (rule.share < 0.0) return RefractionFromHeight(air, truly_rad, height_m);
  return rule.share / kRules[3].share * LiftForAir(air, truly_rad);
}

/// Relative errors in directions with at least a tenth of the zenith's light.
struct Errors {
  double squares = 0.0, worst = 0.0;
  int count = 0;

  void Add(double error) {
    squares += error * error;
    if (std::abs(error) > std::abs(worst)) worst = error;
    ++count;
  }
  [[nodiscard]] double Rms() const { return std::sqrt(squares / count); }
};

void CompareRules(const RefractedTwilight& twilight, double height_m, double elevation_deg) {
  const double truly_rad = elevation_deg * kRadiansPerDegree;
  std::array<Errors, kRules.size()> errors;
  BandValues zenith;
  for (const View& view : kViews) {
    const glm::dvec3 towards =
        Towards(view.elevation_deg * kRadiansPerDegree, view.azimuth_deg * kRadiansPerDegree);
    const BandValues bent = twilight.Radiance(towards, Towards(truly_rad, 0.0), true);
    if (zenith.empty()) zenith = bent;
    for (std::size_t rule = 0; rule < kRules.size(); ++rule) {
      const double lift = LiftBy(kRules[rule], twilight.air(), truly_rad, height_m);
      const BandValues straight = twilight.Radiance(towards, Towards(truly_rad + lift, 0.0), false);
      for (std::size_t band = 0; band < bent.size(); ++band)
        if (bent[band] >= 0.1 * zenith[band]) errors[rule].Add(straight[band] / bent[band] - 1.0);
    }
  }
  fmt::print("eye {:5.0f} m, sun {:+.0f} deg:", height_m, elevation_deg);
  for (std::size_t rule = 0; rule < kRules.size(); ++rule)
    fmt::print("  {} {:.1f} / {:+.1f} %", kRules[rule].name, 100.0 * errors[rule].Rms(),
               100.0 * errors[rule].worst);
  fmt::print("\n");
}

/// Prints errors of sunlight at a place with a given apparent elevation of the sun, relative to the
/// refracted ray: by the straight ray of this elevation, and by RefractedBeam.
void CompareBeam(const Medium& medium, double height_m, double apparent_deg) {
  const double apparent_rad = apparent_deg * kRadiansPerDegree, mu = std::sin(apparent_rad);
  const BandValues bent = RefractedTwilight(medium, height_m).Beam(apparent_rad, height_m);
  static const SingleScattering<float> kAir(medium);
  static const RefractedBeam kBeam(medium);
  const auto straight = kAir.TransmittanceToSpace(height_m, mu);
  const auto beam = kBeam.Left(kAir, height_m, mu);
  const auto error = [&](const auto& light, std::size_t band) {
    return 100.0 * (static_cast<double>(light[band]) / bent[band] - 1.0);
  };
  fmt::print("place at {:4.0f} m, sun seen at {:4.1f} deg, straight ray / BentBeam:", height_m,
             apparent_deg);
  for (std::size_t band = 0; band < bent.size(); ++band)
    fmt::print("  {:+.1f} / {:+.1f} %", error(straight, band), error(beam, band));
  fmt::print("\n");
}

}  // namespace

void alpenglow::tests::RefractedTwilightError(int /*count*/, char** /*arguments*/) {
  const Medium medium = MediumPreset("earth", {450.0, 550.0, 650.0});
  for (const double height_m : {0.0, 3000.0, 11000.0}) {
    const RefractedTwilight twilight(medium, height_m);
    for (const double elevation_deg : kElevations_deg)
      CompareRules(twilight, height_m, elevation_deg);
  }
  for (const double height_m : {0.0, 3000.0, 8000.0})
    for (const double apparent_deg : {0.1, 0.5, 1.0, 2.0, 5.0, 10.0})
      CompareBeam(medium, height_m, apparent_deg);
}
