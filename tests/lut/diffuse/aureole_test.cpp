// SPDX-License-Identifier: MIT
// The bright sky about the sun that the presets of the earth owe to their aerosol.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/number/constants.h"
#include "atmosphere/ray/single_scattering.h"
#include "lut/diffuse/multiple_scattering.h"
#include "tests/fixtures/luminance.h"
#include "tests/fixtures/small_light.h"

namespace alpenglow {
namespace {

/// A direction as high as the sun, some degrees beside it.
ViewRay BesideTheSun(double sun_deg, double from_sun_deg) {
  const double zenith_deg = 90.0 - sun_deg;
  const double azimuth_deg = 2.0 / kRadiansPerDegree *
                             std::asin(std::sin(0.5 * from_sun_deg * kRadiansPerDegree) /
                                       std::sin(zenith_deg * kRadiansPerDegree));
  return RayFromAngles(2.0, zenith_deg, azimuth_deg, zenith_deg);
}

/// Air whose light of higher orders, a tenth of the aureole, is solved roughly.
class LitAir {
 public:
  explicit LitAir(const Medium& medium)
      : medium_(medium), air_(medium), diffuse_(medium, tests::kSmallLight) {}

  /// Of all orders, per unit solar irradiance [1/sr].
  [[nodiscard]] Bands<float> Radiance(const ViewRay& ray) const {
    const auto samples = air_.Sample(ray, {.nodes = 12, .dark_samples = true});
    Bands<float> light = air_.Inscatter(air_.Scatter(samples), ray.nu);
    const Bands<float> more = diffuse_.InscatterAlong(samples, ray.nu);
    for (std::size_t band = 0; band < light.count; ++band) light[band] += more[band];
    return light;
  }

  /// [cd/m^2]
  [[nodiscard]] double Luminance(const ViewRay& ray) const {
    const Bands<float> light = Radiance(ray);
    std::vector<double> radiance;
    for (std::size_t band = 0; band < light.count; ++band)
      radiance.push_back(static_cast<double>(light[band]) * medium_.solar_irradiance[band]);
    const std::array<double, 3> rgb = BandColour(medium_.wavelengths_nm).LinearSrgb(radiance);
    return tests::Luminance(
        {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])});
  }

 private:
  Medium medium_;
  AirIntegrator<float> air_;
  DiffuseLight diffuse_;
};

// Scattered once in plane layers, seen as high as the sun: every path through the air has the same
// length, m = 1 / sin(elevation) vertical ones, and
//
//   L = m (tau_R p_R + tau_M albedo p_M) exp(-m tau).
//
// p_M at 1 degree is the published one of OPAC's continental average at 550 nm, 3.7325 / sr, which
// is normalised within 1 %. Higher orders add less than the optical depth of all scattering, 15 %.
TEST(Aureole, OfEarthAtOneDegreeIsThatOfContinentalAir) {
  const Medium earth = MediumPreset("earth", {500.0, 550.0, 600.0});
  const double sun_deg = 30.0;
  const double m = 1.0 / std::sin(sun_deg * kRadiansPerDegree);
  const double rayleigh = earth.rayleigh_scattering_per_m[1] * MoleculeColumn_m(earth);
  const double aerosol = earth.mie_extinction_per_m[1] * earth.mie_scale_height_m;
  const double ozone = earth.ozone_absorption_per_m[1] * EquivalentDepth_m(earth.ozone);
  const double albedo = earth.mie_scattering_per_m[1] / earth.mie_extinction_per_m[1];
  const double once = m * (rayleigh * 3.0 / (8.0 * kPi) + aerosol * albedo * 3.7325) *
                      std::exp(-m * (rayleigh + aerosol + ozone));
  const double all = static_cast<double>(LitAir(earth).Radiance(BesideTheSun(sun_deg, 1.0))[1]);
  EXPECT_GT(all, once);
  EXPECT_LT(all, 1.15 * once);
}

// Light scattered once by a sun at 20 degrees of 133 klx, by the formula above with m = 2.92 and
// optical depths of 0.1 (molecules), 0.05 (aerosol) and 0.03 (ozone): 42,700 cd/m^2. Higher orders
// add less than 10 %. A lobe of the same mean cosine, 1.25 / sr at 1 degree, has 17,000.
TEST(Aureole, OfEarthIsMoreThanTwiceThatOfOneLobe) {
  const ViewRay ray = BesideTheSun(20.0, 1.0);
  const double earth = LitAir(MediumPreset("earth")).Luminance(ray);
  EXPECT_GT(earth, 42700.0);
  EXPECT_LT(earth, 1.1 * 42700.0);
  const Medium lobe = MediumFromToml("[mie]\nphase = \"cornette-shanks\"\n", "one lobe");
  EXPECT_NEAR(earth / LitAir(lobe).Luminance(ray), 2.5, 0.1);
}

// The glow of haze is wide; in clear air there is little but the narrow peak about the sun, which
// stands out against a bluer and darker sky.
TEST(Aureole, IsTheSmallerTheCleanerTheAir) {
  double wider = 1e9;
  for (const char* preset : {"hazy", "earth", "clear-mountain"}) {
    const LitAir air(MediumPreset(preset));
    const auto at = [&](double degrees) { return air.Luminance(BesideTheSun(30.0, degrees)); };
    const double wide = at(10.0) / at(60.0);
    EXPECT_LT(wide, 0.8 * wider) << preset;
    EXPECT_GT(at(0.5) / at(3.0), 1.5) << preset << ": OPAC's phase functions fall by 2.5 to 3";
    wider = wide;
  }
}

}  // namespace
}  // namespace alpenglow
