// SPDX-License-Identifier: MIT
// The sky and the ground in the light of the moon, against what others measured.
#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "renderer/illumination/aerial_perspective.h"
#include "renderer/illumination/night_light.h"
#include "tests/fixtures/lit_air.h"

namespace alpenglow::renderer {
namespace {

constexpr double kMaunaKea_m = 2800.0;
constexpr double kExtinction = 0.172;

/// The band whose wavelength is nearest.
std::size_t NearestBand(const Medium& medium, double wavelength_nm) {
  std::size_t nearest = 0;
  for (std::size_t band = 1; band < medium.wavelengths_nm.size(); ++band) {
    if (std::abs(medium.wavelengths_nm[band] - wavelength_nm) <
        std::abs(medium.wavelengths_nm[nearest] - wavelength_nm))
      nearest = band;
  }
  return nearest;
}

MoonPosition MoonAtPhase(double degrees) {
  MoonPosition moon{};
  moon.angular_radius_rad = 0.004521;  // at its mean distance
  moon.distance_m = 384.4e6;
  moon.sun_distance_au = 1.0;
  moon.phase_angle_rad = degrees * kRadiansPerDegree;
  return moon;
}

BandLight MoonlightOf(const MoonPosition& moon, const Medium& medium) {
  BandLight light(medium.wavelengths_nm.size());
  for (std::size_t band = 0; band < light.count; ++band) {
    light[band] = static_cast<float>(medium.solar_irradiance[band] *
                                     MoonIrradiance(moon, 1.0, medium.wavelengths_nm[band]));
  }
  return light;
}

/// Krisciunas and Schaefer (1991), equations 3 and 15 to 21: moonlight in the sky [cd/m^2].
double MeasuredMoonlitSky(double phase_deg, double extinction, double moon_zenith_deg,
                          double zenith_deg, double separation_deg) {
  constexpr double kCandelaPerNanolambert = 1e-5 / kPi;
  const auto airmass = [](double z_deg) {
    const double sine = std::sin(z_deg * kRadiansPerDegree);
    return 1.0 / std::sqrt(1.0 - 0.96 * sine * sine);
  };
  const auto dimmed = [&](double z_deg) {
    return std::pow(10.0, -0.4 * extinction * airmass(z_deg));
  };
  const double cosine = std::cos(separation_deg * kRadiansPerDegree);
  const double scattering = std::pow(10.0, 5.36) * (1.06 + cosine * cosine) +
                            std::pow(10.0, 6.15 - separation_deg / 40.0);
  const double moon =
      std::pow(10.0, -0.4 * (3.84 + 0.026 * phase_deg + 4e-9 * std::pow(phase_deg, 4.0)));
  return kCandelaPerNanolambert * scattering * moon * dimmed(moon_zenith_deg) *
         (1.0 - dimmed(zenith_deg));
}

/// The air over Mauna Kea in the years of their measurements, which had 0.172 magnitudes in V: what
/// molecules and ozone leave of that is dust, of volcanoes too, and high.
Medium AirOfMaunaKea() {
  constexpr double kDust = 0.062, kScaleHeight_m = 8000.0;
  Medium medium = MediumPreset("earth");
  const double scale = kDust * std::exp(kMaunaKea_m / kScaleHeight_m) / kScaleHeight_m /
                       medium.mie_extinction_per_m[NearestBand(medium, 550.0)];
  medium.mie_scale_height_m = kScaleHeight_m;
  // Sea and the clouds below the summit, as of the whole planet (Bond albedo, Allen 12.1).
  for (double& albedo : medium.ground_albedo) albedo = 0.3;
  for (double& extinction : medium.mie_extinction_per_m) extinction *= scale;
  for (double& scattering : medium.mie_scattering_per_m) scattering *= scale;
  return medium;
}

/// Of light of the moon from the zenith [magnitudes].
double ExtinctionOf(const tests::LitAir& air) {
  const BandColour colour(air.medium.wavelengths_nm);
  const BandLight left = air.air.TransmittanceToSpace(kMaunaKea_m, 1.0);
  const BandLight moonlight = MoonlightOf(MoonAtPhase(0.0), air.medium);
  return -2.5 *
         std::log10(colour.Xyz(InDouble(moonlight * left))[1] / colour.Xyz(InDouble(moonlight))[1]);
}

TEST(Moonlight, LightsTheSkyAsMeasuredOnMaunaKea) {
  const tests::LitAir air(AirOfMaunaKea());
  const BandColour colour(air.medium.wavelengths_nm);
  const AerialPerspective aerial(air.air, air.multiple_scattering);
  ASSERT_NEAR(ExtinctionOf(air), kExtinction, 0.01);
  for (const double phase_deg : {20.0, 60.0, 90.0}) {
    const BandLight moonlight = MoonlightOf(MoonAtPhase(phase_deg), air.medium);
    for (const double moon_zenith_deg : {20.0, 45.0, 60.0}) {
      for (const double zenith_deg : {10.0, 40.0, 60.0}) {
        for (const double azimuth_deg : {60.0, 120.0, 180.0}) {
          const ViewRay ray = RayFromAngles(kMaunaKea_m, zenith_deg, azimuth_deg, moon_zenith_deg);
          const double separation_deg = std::acos(ray.nu) / kRadiansPerDegree;
          if (separation_deg < 30.0) continue;  // their aureole is one of other dust
          const AirAlongRay seen = aerial.Along(ray, AerialPerspective::Nodes{});
          const double luminance = colour.Xyz(InDouble(moonlight * seen.inscatter))[1];
          const double measured = MeasuredMoonlitSky(phase_deg, kExtinction, moon_zenith_deg,
                                                     zenith_deg, separation_deg);
          EXPECT_NEAR(luminance / measured, 1.0, 0.25)
              << "their own scatter is 8 to 23 %; phase " << phase_deg << ", moon "
              << moon_zenith_deg << ", " << zenith_deg << ", " << azimuth_deg;
        }
      }
    }
  }
}

TEST(Moonlight, AFullMoonOverheadIsAQuarterToAThirdOfALux) {
  const tests::LitAir& earth = tests::Earth();
  const BandColour colour(earth.medium.wavelengths_nm);
  const BandLight moonlight = MoonlightOf(MoonAtPhase(5.0), earth.medium);
  const BandLight on_ground =
      earth.air.TransmittanceToSpace(0.0, 1.0) + earth.multiple_scattering.SkyIrradiance(0.0, 1.0);
  const double lux = colour.Xyz(InDouble(moonlight * on_ground))[1];
  EXPECT_GT(lux, 0.25);
  EXPECT_LT(lux, 0.32);
}

TEST(NightLight, ADarkZenithIsOf21Point6MagnitudesAndTheGroundHasAThousandthOfALux) {
  const tests::LitAir& earth = tests::Earth();
  const BandColour colour(earth.medium.wavelengths_nm);
  const glm::dvec3 up(0.0, 0.0, 1.0);
  const GeodeticPosition paranal = PlaceFromDegrees(-24.63, -70.40, kMaunaKea_m);
  double magnitudes = 0.0, lux = 0.0;
  const std::vector<const char*> nights{"2026-03-20T05:00:00Z", "2026-09-11T05:00:00Z",
                                        "2026-12-09T05:00:00Z"};
  for (const char* night : nights) {
    const NightLight light(NightSky(paranal, ParseInstant(night)), earth.air, colour, up,
                           kMaunaKea_m);
    const BandLight left = earth.air.TransmittanceToSpace(kMaunaKea_m, 1.0);
    BandLight seen = left * light.Above(up);
    for (std::size_t band = 0; band < seen.count; ++band)
      seen[band] += (1.0F - left[band]) * light.scattered()[band];
    const double zenith = colour.Xyz(InDouble(seen))[1];
    magnitudes += -2.5 * std::log10(zenith / 10.8e4) / static_cast<double>(nights.size());
    lux += colour.Xyz(InDouble(light.OnSurface(1.0)))[1] / static_cast<double>(nights.size());
  }
  EXPECT_NEAR(magnitudes, 21.6, 0.15) << "Patat (2003); nights differ by some tenths";
  EXPECT_NEAR(lux, 1e-3, 0.3e-3) << "a clear night without moon";
}

/// What an eye on the ground sees of the night sky, through the air [cd/m^2].
double SkyLuminance(const NightLight& light, const glm::dvec3& direction,
                    const BandColour& colour) {
  const BandLight left = tests::Earth().air.TransmittanceToSpace(0.0, direction.z);
  BandLight seen = left * light.Above(direction);
  for (std::size_t band = 0; band < seen.count; ++band)
    seen[band] += (1.0F - left[band]) * light.scattered()[band];
  return colour.Xyz(InDouble(seen))[1];
}

double Magnitudes(double cd_per_m2) { return -2.5 * std::log10(cd_per_m2 / 10.8e4); }

TEST(NightLight, TheZenithOverTownsIsAsBrightAsTheirClassOfBortleHasIt) {
  const SingleScattering<float>& air = tests::Earth().air;
  const BandColour colour(tests::Earth().medium.wavelengths_nm);
  const glm::dvec3 up(0.0, 0.0, 1.0);
  // The pole of the galaxy stands high, the ecliptic low.
  const NightSky sky(PlaceFromDegrees(46.5, 8.0, 0.0), ParseInstant("2026-04-17T23:30:00Z"));
  for (int bortle = 1; bortle <= 9; ++bortle) {
    const NightLight light(sky, air, colour, up, 0.0,
                           Skyglow(ZenithOfBortleClass(bortle), 0.0, air, colour));
    EXPECT_NEAR(Magnitudes(SkyLuminance(light, up, colour)), ZenithOfBortleClass(bortle), 0.1)
        << bortle;
  }
}

TEST(NightLight, OfTownsRisesToTheHorizonReddensItAndLightsTheGround) {
  const SingleScattering<float>& air = tests::Earth().air;
  const BandColour colour(tests::Earth().medium.wavelengths_nm);
  const glm::dvec3 up(0.0, 0.0, 1.0);
  const NightSky sky(PlaceFromDegrees(46.5, 8.0, 0.0), ParseInstant("2026-04-17T23:30:00Z"));
  const NightLight city(sky, air, colour, up, 0.0, Skyglow(18.0, 0.0, air, colour));
  const auto luminance = [&](double zenith_deg) {
    const double z = zenith_deg * kRadiansPerDegree;
    return SkyLuminance(city, {0.0, std::sin(z), std::cos(z)}, colour);
  };
  EXPECT_NEAR(luminance(60.0) / luminance(0.0), 1.85, 0.15)
      << "twice the air, but for what takes its own light";
  EXPECT_GT(luminance(85.0) / luminance(0.0), 3.5);
  const auto rgb = colour.LinearSrgb(InDouble(city.scattered()));
  EXPECT_GT(rgb[0], 1.5 * rgb[2]);
  // A sky of 18 magnitudes all over would bring pi times its luminance.
  const double lux = colour.Xyz(InDouble(city.OnSurface(1.0)))[1];
  EXPECT_GT(lux, kPi * luminance(0.0));
  EXPECT_LT(lux, 2.5 * kPi * luminance(0.0));
}

TEST(NightLight, RisesToTheHorizonBeforeTheAirTakesIt) {
  const tests::LitAir& earth = tests::Earth();
  const BandColour colour(earth.medium.wavelengths_nm);
  const glm::dvec3 up(0.0, 0.0, 1.0);
  const NightLight light(
      NightSky(PlaceFromDegrees(46.5, 8.0, 0.0), ParseInstant("2026-03-20T00:00:00Z")), earth.air,
      colour, up, 0.0);
  const auto luminance = [&](double elevation_deg) {
    const double e = elevation_deg * kRadiansPerDegree;
    return colour.Xyz(InDouble(light.Above({0.0, std::cos(e), std::sin(e)})))[1];
  };
  EXPECT_GT(luminance(10.0) / luminance(60.0), 1.6);
}

}  // namespace
}  // namespace alpenglow::renderer
