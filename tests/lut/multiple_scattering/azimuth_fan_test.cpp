// SPDX-License-Identifier: MIT
#include "lut/multiple_scattering/azimuth_fan.h"

#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/colour/spectrum.h"

namespace alpenglow::lut {
namespace {

constexpr MultipleScatteringOptions kSmall{.altitudes = 10,
                                           .sun_angles = 24,
                                           .degree = 4,
                                           .zenith_nodes = 6,
                                           .azimuth_nodes = 4,
                                           .ray_nodes = 6};

double NuOf(double mu, double mu_s, double azimuth_rad) {
  return mu * mu_s + std::sqrt((1.0 - mu * mu) * (1.0 - mu_s * mu_s)) * std::cos(azimuth_rad);
}

void ExpectMultipleScatteringOfEveryAzimuth(const Medium& medium) {
  const MultipleScattering light(medium, kSmall);
  const SingleScattering<float> air(medium);
  const AzimuthFan fan(light);
  for (const double altitude_m : {0.0, 10e3, 400e3}) {
    for (const double mu : {1.0, 0.3, -0.35, -1.0}) {
      for (const double mu_s : {1.0, 0.9, 0.1, -0.1, -0.6, -1.0}) {
        const ViewRay under_zenith_sun{altitude_m, mu, 1.0, mu};
        const RaySamples<float> samples = air.Sample(under_zenith_sun, {.nodes = 12});
        std::vector<float> nus;
        for (int k = 0; k < 5; ++k) nus.push_back(static_cast<float>(NuOf(mu, mu_s, 0.7 * k)));
        const std::vector<float> seen =
            fan.InscatterAlong(samples, {altitude_m, mu, mu_s, 0.0}, nus);
        float brightest = 1e-12F;
        for (const float value : seen) brightest = std::max(brightest, value);
        for (std::size_t k = 0; k < nus.size(); ++k) {
          // The same samples under this sun.
          RaySamples<float> lit = samples;
          for (std::size_t s = 0; s < lit.count; ++s) {
            const double r = medium.planet_radius_m / 1000.0;
            const double d = samples.extent.begin_m / 1000.0 + double{samples.distance[s]};
            lit.mu_s[s] = static_cast<float>(
                std::clamp(((r + altitude_m / 1000.0) * mu_s + d * double{nus[k]}) /
                               (r + double{samples.altitude[s]}),
                           -1.0, 1.0));
          }
          const Bands<float> expected = light.InscatterByMoments(lit, double{nus[k]});
          for (std::size_t band = 0; band < expected.count; ++band) {
            EXPECT_NEAR(seen[k * light.bands() + band], expected[band], 1.2e-4F * brightest)
                << altitude_m << " " << mu << " " << mu_s << " " << k;
          }
        }
      }
    }
  }
}

class AzimuthFanOf : public testing::TestWithParam<int> {};

TEST_P(AzimuthFanOf, BandsIsTheMultipleScatteringOfEveryAzimuth) {
  ExpectMultipleScatteringOfEveryAzimuth(
      InScalarLight(MediumPreset("earth", WavelengthSet(GetParam()))));
}

TEST_P(AzimuthFanOf, BandsIsThePolarisedLightOfEveryAzimuth) {
  ExpectMultipleScatteringOfEveryAzimuth(MediumPreset("earth", WavelengthSet(GetParam())));
}

INSTANTIATE_TEST_SUITE_P(AnyNumber, AzimuthFanOf, testing::Values(3, 4, 6));

}  // namespace
}  // namespace alpenglow::lut
