// SPDX-License-Identifier: MIT
// What it does to the light of twilight that rays of the sun are bent (tests/fixtures/bent_twilight.h):
// beside it stands what straight rays bring, from the sun's true place and from where pictures have it
// (RefractionFromHeight at the eye).
#include <fmt/core.h>

#include <array>

#include "atmosphere/sun/refraction.h"
#include "atmosphere/sun/sun.h"
#include "tests/fixtures/bent_twilight.h"

namespace {

using namespace alpenglow;
using tests::BentTwilight;

struct View {
  const char* name;
  double elevation_deg, azimuth_deg;  // from the sun
};

constexpr std::array kViews{View{"zenith", 90.0, 0.0}, View{"45 towards", 45.0, 0.0},
                            View{"45 away", 45.0, 180.0}, View{"5 towards", 5.0, 0.0},
                            View{"20 across", 20.0, 90.0}};

/// By how much the sun would have to be lifted for straight rays to bring as much.
double LiftThatSuits(const BentTwilight& air, const glm::dvec3& view, double truly_rad,
                     std::size_t band, double wanted) {
  double low = -0.5 * kRadiansPerDegree, high = 1.0 * kRadiansPerDegree;
  for (int i = 0; i < 12; ++i) {
    const double middle = 0.5 * (low + high);
    const auto sun = DirectionFromAngles(truly_rad + middle, 0.0).xyz;
    (air.Radiance(view, sun, false)[band] < wanted ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

int main() {
  const BentTwilight air(MediumPreset("earth", {450.0, 550.0, 650.0}));
  for (const double elevation_deg : {1.0, 0.0, -1.0, -2.0, -3.0, -4.0, -5.0, -6.0, -7.0, -8.0}) {
    const double truly_rad = elevation_deg * kRadiansPerDegree;
    const double lift = RefractionFromHeight(air.air(), truly_rad, 0.0);
    fmt::print("sun truly at {} degrees, lifted by {:.1f}' in pictures\n", elevation_deg,
               lift / kRadiansPerDegree * 60.0);
    const auto true_sun = DirectionFromAngles(truly_rad, 0.0).xyz;
    const auto lifted_sun = DirectionFromAngles(truly_rad + lift, 0.0).xyz;
    for (const View& view : kViews) {
      const auto towards = DirectionFromAngles(view.elevation_deg * kRadiansPerDegree,
                                               view.azimuth_deg * kRadiansPerDegree)
                               .xyz;
      const auto bent = air.Radiance(towards, true_sun, true);
      const auto straight = air.Radiance(towards, true_sun, false);
      const auto lifted = air.Radiance(towards, lifted_sun, false);
      fmt::print("  {:<12}", view.name);
      for (std::size_t band = 0; band < bent.size(); ++band) {
        const double suits = LiftThatSuits(air, towards, truly_rad, band, bent[band]);
        fmt::print("  true {:+6.1f} %, lifted {:+6.1f} %, suits {:5.1f}'",
                   100.0 * (straight[band] / bent[band] - 1.0),
                   100.0 * (lifted[band] / bent[band] - 1.0), suits / kRadiansPerDegree * 60.0);
      }
      fmt::print("\n");
    }
  }
}
