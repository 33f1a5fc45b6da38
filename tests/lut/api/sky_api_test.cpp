// SPDX-License-Identifier: MIT
#include <alpenglow/errors.h>
#include <alpenglow/sky.h>
#include <alpenglow/version.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/reference/reference_solution.h"
#include "lut/api/conversions.h"
#include "lut/api/sky_parts.h"
#include "lut/cli/program.h"

namespace alpenglow {
namespace {

using atmosphere::Medium;
using atmosphere::ViewRay;

constexpr LocalPoint kEye{.east_m = 100.0, .north_m = -200.0, .up_m = 1500.0};

const Sky& Earth() {
  static const Sky sky{Atmosphere()};
  return sky;
}

const std::vector<Direction>& Suns() {
  static const std::vector<Direction> suns{DirectionFromAngles(50.0, 120.0),
                                           DirectionFromAngles(1.0, 240.0),
                                           DirectionFromAngles(-4.0, 30.0)};
  return suns;
}

const std::vector<LocalPoint>& Objects() {
  static const std::vector<LocalPoint> objects{{0.0, 300.0, 1400.0},
                                               {-12000.0, 4000.0, 3000.0},
                                               {60000.0, 80000.0, 1800.0},
                                               {0.0, 0.0, 9000.0}};
  return objects;
}

void ExpectEqual(const Spectrum& spectrum, const Spectrum& bands) {
  ASSERT_EQ(spectrum.size(), bands.size());
  for (std::size_t band = 0; band < bands.size(); ++band) EXPECT_EQ(spectrum[band], bands[band]);
}

ViewRay RayTo(const LocalPoint& object, const Direction& to_sun) {
  const double radius_m = Earth().atmosphere().planet_radius_m();
  const glm::dvec3 way{object.east_m - kEye.east_m, object.north_m - kEye.north_m,
                       object.up_m - kEye.up_m};
  const double length_m = glm::length(way);
  return RayFrom(AltitudeOf(kEye, radius_m), way / length_m, UnitVectorOf(to_sun), length_m);
}

TEST(Version, EqualsThatOfThePrograms) {
  EXPECT_NE(lut::ProducerText().find(std::string(Version())), std::string::npos);
}

TEST(LocalRays, AltitudeIsTheDistanceFromTheSphere) {
  constexpr double kRadius_m = 6.371e6;
  const auto [altitude_m, up] = AltitudeOf({3e4, 4e4, 12.0}, kRadius_m);
  const long double exact =
      std::sqrt(static_cast<long double>(25e8) +
                static_cast<long double>((kRadius_m + 12.0) * (kRadius_m + 12.0))) -
      static_cast<long double>(kRadius_m);
  EXPECT_NEAR(altitude_m, static_cast<double>(exact), 1e-9);
  EXPECT_NEAR(up.x, 3e4 / (kRadius_m + altitude_m), 1e-15);
  EXPECT_EQ(AltitudeOf({0.0, 0.0, 0.1}, kRadius_m).altitude_m, 0.1);
}

TEST(LocalRays, FollowFromTheirAngles) {
  const ViewRay expected = atmosphere::RayFromAngles(2.0, 80.0, 90.0, 60.0);
  const ViewRay ray =
      RayFrom(AltitudeOf({.up_m = 2.0}, 6.371e6), UnitVectorOf(DirectionFromAngles(10.0, 210.0)),
              UnitVectorOf(DirectionFromAngles(30.0, 120.0)));
  EXPECT_EQ(ray.altitude_m, expected.altitude_m);
  EXPECT_NEAR(ray.mu, expected.mu, 1e-15);
  EXPECT_NEAR(ray.mu_s, expected.mu_s, 1e-15);
  EXPECT_NEAR(ray.nu, expected.nu, 1e-15);
}

TEST(Sky, RadianceEqualsThatOfTheLayerBelow) {
  const Medium medium = atmosphere::MediumPreset("earth");
  lut::TableFolder solved;
  solved.medium = medium;
  solved.multiple_scattering.emplace(medium, lut::OptionsFor(medium));
  const lut::TableLookup lookup(solved);
  const Direction view = DirectionFromAngles(7.0, 130.0);
  for (const Direction& sun : Suns()) {
    const AltitudeAndZenith eye = AltitudeOf(kEye, medium.planet_radius_m);
    const ViewRay ray = RayFrom(eye, UnitVectorOf(view), UnitVectorOf(sun));
    ExpectEqual(Earth().Radiance(kEye, view, sun), lookup.InscatterOfAllOrders(ray));
    const Spectrum direct = lookup.SunIrradiance(ray.altitude_m, ray.mu_s);
    for (std::size_t band = 0; band < direct.size(); ++band)
      EXPECT_FLOAT_EQ(Earth().SunIrradiance(kEye, sun)[band], direct[band]);
    ExpectEqual(Earth().SkyIrradiance(kEye, sun), lookup.SkyIrradiance(ray.altitude_m, ray.mu_s));
  }
}

TEST(Sky, AerialPerspectiveKeepsItsStatedErrors) {
  const Medium& medium = Earth().atmosphere().medium();
  const atmosphere::SingleScattering<float> air(medium);
  for (const Direction& sun : {Suns()[0], Suns()[1]}) {
    for (const LocalPoint& object : Objects()) {
      const ViewRay ray = RayTo(object, sun);
      const auto samples =
          air.Sample(ray, {.nodes = 12, .split_ozone = false, .dark_samples = true});
      const auto more = SkyParts::LookupOf(Earth()).multiple_scattering().InscatterAlong(
          samples, ray.nu, lut::SegmentEnd::kOpaque);
      const auto once = air.Inscatter(air.Scatter(samples), ray.nu);
      const auto depth = atmosphere::reference::OpticalDepthAlong(medium, ray);
      const auto reference = atmosphere::reference::SingleScatteringAlong(medium, ray);
      const AirBetween found = Earth().Between(kEye, object, sun);
      for (std::size_t band = 0; band < found.transmittance.size(); ++band) {
        EXPECT_EQ(found.inscattered[band], once[band] + more[band]);
        const double transmittance = std::exp(-depth.tau[band]);
        EXPECT_NEAR(static_cast<double>(found.transmittance[band]), transmittance,
                    1e-4 * depth.tau[band] * transmittance + 1e-6);
        EXPECT_NEAR(static_cast<double>(once[band]), reference.inscatter[band],
                    1e-3 * reference.inscatter[band]);
      }
    }
  }
}

TEST(Sky, TellsTheProgressOfItsSolutionAndEndsWhenItIsCancelled) {
  std::vector<double> fractions;
  const auto note = [&](double fraction) {
    fractions.push_back(fraction);
    return true;
  };
  const Sky sky(Atmosphere(), note);
  EXPECT_EQ(sky.Radiance(kEye, {.up = 1.0}, Suns()[0]),
            Earth().Radiance(kEye, {.up = 1.0}, Suns()[0]));
  EXPECT_GT(fractions.size(), 50U);
  EXPECT_EQ(std::ranges::adjacent_find(fractions, std::greater_equal<>()), fractions.end());
  EXPECT_GT(fractions.front(), 0.0);
  EXPECT_EQ(fractions.back(), 1.0);
  int calls = 0;
  const auto cancel = [&](double) { return ++calls > 5; };
  EXPECT_THROW((void)Sky(Atmosphere(), cancel), Cancelled);
  EXPECT_EQ(calls, 1) << "no call follows the one that cancels";
}

TEST(Sky, AirBetweenEqualPointsIsZero) {
  const AirBetween none = Earth().Between(kEye, kEye, Suns()[0]);
  for (std::size_t band = 0; band < none.transmittance.size(); ++band) {
    EXPECT_EQ(none.transmittance[band], 1.0F);
    EXPECT_EQ(none.inscattered[band], 0.0F);
  }
}

TEST(Sky, BelowAltitudeZeroEqualsThatAtAltitudeZero) {
  const Direction view = DirectionFromAngles(30.0, 10.0);
  const Spectrum at_zero = Earth().Radiance({.up_m = 0.0}, view, Suns()[0]);
  const Spectrum below = Earth().Radiance({.up_m = -430.0}, view, Suns()[0]);
  for (std::size_t band = 0; band < below.size(); ++band) {
    EXPECT_NEAR(below[band], at_zero[band], 1e-3F * at_zero[band]);
  }
  const AirBetween air = Earth().Between({.up_m = -430.0}, {0.0, 9000.0, -400.0}, Suns()[0]);
  EXPECT_TRUE(std::isfinite(air.inscattered[0]));
  EXPECT_LT(air.transmittance[0], 1.0F);
  EXPECT_TRUE(std::isfinite(Earth().SkyIrradiance({.up_m = -430.0}, Suns()[0])[0]));
}

// Hard case 2.
TEST(Sky, AirBelowAltitudeZeroIsEqualFromBothEnds) {
  const Direction sun = DirectionFromAngles(40.0, 100.0);
  for (const auto& [a, b] : {std::pair{LocalPoint{.up_m = -400.0}, LocalPoint{0.0, 10e3, -430.0}},
                             {LocalPoint{.up_m = -430.0}, LocalPoint{0.0, 10e3, -400.0}},
                             {LocalPoint{.up_m = 200.0}, LocalPoint{5e3, 8e3, -430.0}},
                             {LocalPoint{}, LocalPoint{0.0, 20e3, -31.4}},
                             {LocalPoint{.up_m = -8e3}, LocalPoint{30e3, 0.0, 9e3}}}) {
    const AirBetween there = Earth().Between(a, b, sun), back = Earth().Between(b, a, sun);
    for (std::size_t band = 0; band < there.transmittance.size(); ++band) {
      EXPECT_NEAR(there.transmittance[band], back.transmittance[band],
                  1e-5F * there.transmittance[band]);
      EXPECT_LT(there.transmittance[band], 0.95F);
      EXPECT_GT(there.inscattered[band], 0.0F);
      EXPECT_GT(back.inscattered[band], 0.0F);
    }
  }
}

TEST(Sky, ImpossiblePointsAndDirectionsAreRefused) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const Direction sun = Suns()[0];
  EXPECT_THROW((void)Earth().Radiance(kEye, {.up = 0.0}, sun), InputError);
  EXPECT_THROW((void)Earth().Radiance(kEye, {.up = kNan}, sun), InputError);
  EXPECT_THROW((void)Earth().Radiance({.up_m = -7e6}, {.up = 1.0}, sun), InputError);
  EXPECT_THROW((void)Earth().Between(kEye, {.up_m = kNan}, sun), InputError);
}

TEST(Atmosphere, ColourFollowsFromTheBands) {
  const Atmosphere& earth = Earth().atmosphere();
  const Spectrum light = Earth().Radiance(kEye, {.up = 1.0}, Suns()[0]);
  std::vector<double> radiance;
  for (std::size_t band = 0; band < light.size(); ++band) {
    radiance.push_back(earth.solar_irradiance_w_per_m2_nm()[band] *
                       static_cast<double>(light[band]));
  }
  const atmosphere::BandColour colour(earth.medium().wavelengths_nm);
  const LinearRgb rgb = earth.ColourOf(light);
  EXPECT_EQ((std::array{rgb.red, rgb.green, rgb.blue}), colour.LinearSrgb(radiance));
  EXPECT_NEAR(Luminance(rgb), colour.Xyz(radiance)[1], 1e-9 * Luminance(rgb));
  EXPECT_THROW((void)earth.ColourOf(Spectrum(3)), InputError);
}

TEST(Atmosphere, SurvivesARoundTripThroughText) {
  for (const std::string& name : Atmosphere::PresetNames()) {
    const Atmosphere preset = Atmosphere::Preset(name);
    EXPECT_EQ(preset.name(), name);
    EXPECT_EQ(Atmosphere::FromToml(preset.ToToml()).hash(), preset.hash()) << name;
  }
  EXPECT_EQ(Atmosphere::Preset("earth", {450.0, 550.0}).wavelengths_nm().size(), 2U);
}

TEST(Atmosphere, WrongInputIsRefused) {
  EXPECT_THROW((void)Atmosphere::Preset("eearth"), InputError);
  EXPECT_THROW((void)Atmosphere::Read("no such file.toml"), InputError);
  EXPECT_THROW((void)Atmosphere::FromToml("[rayleigh]\nscale_hight_m = 8000"), InputError);
  EXPECT_THROW((void)Atmosphere().AtLatitude(90.5), InputError);
  std::vector<double> many;
  for (int i = 0; i <= 40; ++i) many.push_back(400.0 + i);
  EXPECT_THROW((void)Atmosphere::Preset("earth", many), InputError);
}

}  // namespace
}  // namespace alpenglow
