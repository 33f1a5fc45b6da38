// SPDX-License-Identifier: MIT
// Aerosol in the presets of the earth makes the sky about the sun bright.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/atmosphere_file.h"
#include "atmosphere/ray/single_scattering.h"
#include "lut/multiple_scattering/azimuth_fan.h"
#include "lut/multiple_scattering/multiple_scattering.h"
#include "tests/fixtures/luminance.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/small_light.h"

namespace alpenglow::lut {
namespace {

/// Returns a direction as high as the sun, some degrees beside it.
ViewRay BesideTheSun(double sun_deg, double from_sun_deg) {
  const double zenith_deg = 90.0 - sun_deg;
  const double azimuth_deg = 2.0 / kRadiansPerDegree *
                             std::asin(std::sin(0.5 * from_sun_deg * kRadiansPerDegree) /
                                       std::sin(zenith_deg * kRadiansPerDegree));
  return RayFromAngles(2.0, zenith_deg, azimuth_deg, zenith_deg);
}

class AureoleAir {
 public:
  /// Light of higher orders is a tenth of the aureole: small options do for its brightness.
  explicit AureoleAir(const Medium& medium,
                      const MultipleScatteringOptions& options = tests::kSmallLight)
      : medium_(medium), air_(medium), multiple_scattering_(medium, options) {}

  /// Returns light of all orders, per unit solar irradiance [1/sr].
  [[nodiscard]] Spectrum Radiance(const ViewRay& ray) const {
    const auto samples = air_.Sample(ray, {.nodes = 12, .dark_samples = true});
    Spectrum light = air_.Inscatter(air_.Scatter(samples), ray.nu);
    const Spectrum more = multiple_scattering_.InscatterAlong(samples, ray.nu);
    for (std::size_t band = 0; band < light.size(); ++band) light[band] += more[band];
    return light;
  }

  /// Returns the luminance [cd/m^2].
  [[nodiscard]] double Luminance(const ViewRay& ray) const {
    const Spectrum light = Radiance(ray);
    std::vector<double> radiance;
    for (std::size_t band = 0; band < light.size(); ++band)
      radiance.push_back(static_cast<double>(light[band]) * medium_.solar_irradiance[band]);
    const std::array<double, 3> rgb = BandColour(medium_.wavelengths_nm).LinearSrgb(radiance);
    return tests::Luminance(
        {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])});
  }

 private:
  Medium medium_;
  SingleScattering<float> air_;
  MultipleScattering multiple_scattering_;
};

// For light scattered once in plane layers, seen as high as the sun, every path through the air has
// the same length, m = 1 / sin(elevation) vertical ones, and
//
//   L = m (tau_R p_R + tau_M albedo p_M) exp(-m tau).
//
// p_M at 1 degree is the published one of OPAC's continental average at 550 nm, 3.7325 / sr, which
// is normalised within 1 %. Higher orders add less than the optical depth of all scattering, 15 %.
TEST(Aureole, OfEarthAtOneDegreeEqualsThatOfContinentalAir) {
  const Medium earth = MediumPreset("earth", {500.0, 550.0, 600.0});
  const double sun_deg = 30.0;
  const double m = 1.0 / std::sin(sun_deg * kRadiansPerDegree);
  const double rayleigh = earth.rayleigh_scattering_per_m[1] * MoleculeColumn_m(earth);
  const double aerosol = earth.mie_extinction_per_m[1] * earth.mie_scale_height_m;
  const double ozone = earth.ozone_absorption_per_m[1] * EquivalentDepth_m(earth.ozone);
  const double albedo = earth.mie_scattering_per_m[1] / earth.mie_extinction_per_m[1];
  const double once = m * (rayleigh * 3.0 / (8.0 * kPi) + aerosol * albedo * 3.7325) *
                      std::exp(-m * (rayleigh + aerosol + ozone));
  const double all = static_cast<double>(AureoleAir(earth).Radiance(BesideTheSun(sun_deg, 1.0))[1]);
  EXPECT_GT(all, once);
  EXPECT_LT(all, 1.15 * once);
}

// Light scattered once by a sun at 20 degrees of 133 klx follows from the formula above with m =
// 2.92 and optical depths of 0.1 (molecules), 0.05 (aerosol) and 0.03 (ozone): 42,700 cd/m^2.
// Higher orders add less than 10 %. A lobe of the same mean cosine, 1.25 / sr at 1 degree, has
// 17,000.
TEST(Aureole, OfEarthIsMoreThanTwiceThatOfOneLobe) {
  const ViewRay ray = BesideTheSun(20.0, 1.0);
  const double earth = AureoleAir(MediumPreset("earth")).Luminance(ray);
  EXPECT_GT(earth, 42700.0);
  EXPECT_LT(earth, 1.1 * 42700.0);
  const Medium lobe = MediumFromToml("[mie]\nphase = \"cornette-shanks\"\n", "one lobe");
  EXPECT_NEAR(earth / AureoleAir(lobe).Luminance(ray), 2.5, 0.1);
}

// The glow of haze is wide; in clear air there is little but the narrow peak about the sun, which
// stands out against a bluer and darker sky.
TEST(Aureole, IsSmallerInCleanerAir) {
  double wider = 1e9;
  for (const char* preset : {"hazy", "earth", "clear-mountain"}) {
    const AureoleAir air(MediumPreset(preset));
    const auto at = [&](double degrees) { return air.Luminance(BesideTheSun(30.0, degrees)); };
    const double wide = at(10.0) / at(60.0);
    EXPECT_LT(wide, 0.8 * wider) << preset;
    EXPECT_GT(at(0.5) / at(3.0), 1.5) << preset << ": OPAC's phase functions fall by 2.5 to 3";
    wider = wide;
  }
}

/// A view from 2 m, degrees, and the radiance of paths in the bands, to 0.1 to 0.3 percent
/// (skylut eval --method path-trace --max-error 0.3%).
struct TracedAureole {
  double zenith_deg, azimuth_deg, sun_zenith_deg;
  std::array<double, 4> radiance;
};

double RmsErrorOfAureole(const Medium& four_bands, const std::vector<TracedAureole>& views) {
  // Under the sanitizers, one band has to do.
  constexpr std::size_t kFirst = tests::ScaledDown(0, 1), kLast = tests::ScaledDown(4, 2);
  const Medium medium = tests::WithBands(four_bands, kFirst, kLast);
  const AureoleAir air(medium, OptionsFor(medium));
  double squares = 0.0;
  for (const TracedAureole& view : views) {
    const Spectrum light =
        air.Radiance(RayFromAngles(2.0, view.zenith_deg, view.azimuth_deg, view.sun_zenith_deg));
    for (std::size_t band = 0; band < light.size(); ++band)
      squares += std::pow(static_cast<double>(light[band]) / view.radiance[kFirst + band] - 1.0, 2);
  }
  return std::sqrt(squares / static_cast<double>((kLast - kFirst) * views.size()));
}

// The views are 1 to 10 degrees beside suns at 50, 15, 5 and 2 degrees, and towards one that has
// set.
TEST(Aureole, OfEarthAgreesWithPathsByDayAndAtSunset) {
  EXPECT_LT(RmsErrorOfAureole(MediumPreset("earth"),
                              {
                                  {39.1366, 0.7922, 40, {0.23436, 0.20513, 0.18637, 0.1699}},
                                  {76.7343, 1.0273, 75, {0.24413, 0.27017, 0.25462, 0.25916}},
                                  {70.3093, 1.8143, 75, {0.1368, 0.13104, 0.11614, 0.10913}},
                                  {84.1342, 0.5026, 85, {0.13785, 0.30986, 0.34412, 0.47514}},
                                  {86.7327, 1.0015, 85, {0.10009, 0.24986, 0.28796, 0.41327}},
                                  {84.486, 2.9681, 85, {0.081745, 0.16487, 0.17609, 0.23281}},
                                  {80.3045, 1.7329, 85, {0.063761, 0.1006, 0.099146, 0.12004}},
                                  {87.1341, 0.5006, 88, {0.024887, 0.12382, 0.17813, 0.35305}},
                                  {87.0011, 1.7343, 88, {0.019218, 0.080248, 0.11098, 0.21307}},
                                  {87.4819, 2.9572, 88, {0.016223, 0.066356, 0.091736, 0.17515}},
                                  {83.3031, 1.7199, 88, {0.020546, 0.046554, 0.052612, 0.082978}},
                                  {83.0421, 8.7138, 88, {0.019166, 0.038772, 0.04207, 0.063392}},
                                  {85, 3, 92, {0.0022893, 0.0034416, 0.0030129, 0.0048028}},
                                  {70, 20, 92, {0.0022427, 0.0018296, 0.0012538, 0.0016073}},
                                  {88, 10, 95, {0.0001225, 0.0002656, 0.00025928, 0.00059428}},
                              }),
            5e-3)
      << "0.7 % without GlowAboutTheSun";
}

TEST(Aureole, OfHazeAgreesWithPathsByDayAndAtSunset) {
  EXPECT_LT(RmsErrorOfAureole(MediumPreset("hazy"),
                              {
                                  {39.1366, 0.7922, 40, {0.5135, 0.48285, 0.44965, 0.42094}},
                                  {76.7343, 1.0273, 75, {0.34715, 0.45762, 0.46092, 0.50604}},
                                  {70.3093, 1.8143, 75, {0.22689, 0.26358, 0.25115, 0.25601}},
                                  {84.1342, 0.5026, 85, {0.061808, 0.18916, 0.24386, 0.40654}},
                                  {86.7327, 1.0015, 85, {0.033529, 0.10838, 0.14732, 0.26412}},
                                  {84.486, 2.9681, 85, {0.041077, 0.11222, 0.13965, 0.22382}},
                                  {80.3045, 1.7329, 85, {0.04763, 0.10084, 0.11326, 0.16098}},
                                  {87.1341, 0.5006, 88, {0.0059739, 0.018609, 0.030907, 0.082991}},
                                  {87.0011, 1.7343, 88, {0.0058566, 0.015542, 0.023932, 0.059883}},
                                  {87.4819, 2.9572, 88, {0.0053658, 0.012093, 0.017892, 0.044178}},
                                  {83.3031, 1.7199, 88, {0.0096278, 0.02359, 0.029929, 0.056774}},
                                  {83.0421, 8.7138, 88, {0.0093236, 0.020798, 0.025441, 0.046381}},
                                  {85, 3, 92, {0.0010089, 0.0012287, 0.0010547, 0.0017808}},
                                  {70, 20, 92, {0.0017343, 0.001467, 0.0010046, 0.0012839}},
                                  {88, 10, 95, {5.6624e-05, 5.3481e-05, 3.7743e-05, 7.3143e-05}},
                              }),
            1.1e-2)
      << "as with the one lobe that it had";
}

constexpr MultipleScatteringOptions kSmall{.altitudes = 10,
                                           .sun_angles = 24,
                                           .degree = 4,
                                           .zenith_nodes = 6,
                                           .azimuth_nodes = 4,
                                           .ray_nodes = 6};

double NuOf(double mu, double mu_s, double azimuth_rad) {
  return mu * mu_s + std::sqrt((1.0 - mu * mu) * (1.0 - mu_s * mu_s)) * std::cos(azimuth_rad);
}

void ExpectMultipleScatteringOfEveryAzimuth(const Medium& medium,
                                            const MultipleScatteringOptions& options = kSmall) {
  const MultipleScattering light(medium, options);
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
          // These are the samples of the ray under this sun.
          RaySamples<float> lit = samples;
          for (std::size_t s = 0; s < lit.count; ++s) {
            const double r = medium.planet_radius_m / 1000.0;
            const double d = samples.extent.begin_m / 1000.0 + double{samples.distance[s]};
            lit.mu_s[s] = static_cast<float>(
                std::clamp(((r + altitude_m / 1000.0) * mu_s + d * double{nus[k]}) /
                               (r + double{samples.altitude[s]}),
                           -1.0, 1.0));
          }
          const Spectrum expected = light.InscatterByMoments(lit, double{nus[k]});
          for (std::size_t band = 0; band < expected.size(); ++band) {
            EXPECT_NEAR(seen[k * light.bands() + band], expected[band], 1.2e-4F * brightest)
                << altitude_m << " " << mu << " " << mu_s << " " << k;
          }
        }
      }
    }
  }
}

class AzimuthFanOfBands : public testing::TestWithParam<int> {};

TEST_P(AzimuthFanOfBands, EqualsTheLightOfEveryAzimuth) {
  ExpectMultipleScatteringOfEveryAzimuth(
      InScalarLight(MediumPreset("earth", WavelengthSet(GetParam()))));
  ExpectMultipleScatteringOfEveryAzimuth(MediumPreset("earth", WavelengthSet(GetParam())));
}

TEST(AzimuthFan, WithASeparatePeakEqualsTheLightOfEveryAzimuth) {
  MultipleScatteringOptions options = kSmall;
  options.delta_m = true;
  ExpectMultipleScatteringOfEveryAzimuth(MediumPreset("mars", {550.0, 650.0}), options);
}

INSTANTIATE_TEST_SUITE_P(AnyNumber, AzimuthFanOfBands, testing::Values(3, 4, 6));

}  // namespace
}  // namespace alpenglow::lut
