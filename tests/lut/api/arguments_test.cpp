// SPDX-License-Identifier: MIT
// Every function of the public headers refuses arguments out of range, and names them.
#include <alpenglow/errors.h>
#include <alpenglow/panorama.h>
#include <alpenglow/sky.h>
#include <alpenglow/tables.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "lut/api/sky_parts.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/small_light.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Returns a sky of coarse light, which solves in no time: its values do not matter here.
Sky CoarseSky(const Atmosphere& atmosphere) {
  lut::TableFolder tables;
  tables.medium = atmosphere.medium();
  tables.multiple_scattering.emplace(tables.medium, tests::kSmallLight);
  return SkyParts::Made(atmosphere, std::move(tables));
}

const Sky& Earth() {
  static const Sky sky = CoarseSky(Atmosphere());
  return sky;
}

/// Air on other wavelengths, with Rayleigh scattering only.
Atmosphere OnWavelengths(const std::vector<double>& wavelengths_nm) {
  atmosphere::Medium medium = atmosphere::InScalarLight(atmosphere::MediumPreset("earth"));
  const std::size_t bands = wavelengths_nm.size();
  medium.wavelengths_nm = wavelengths_nm;
  medium.solar_irradiance.assign(bands, 1.0);
  medium.ground_albedo.assign(bands, 0.1);
  medium.rayleigh_scattering_per_m.assign(bands, 1e-5);
  medium.mie_scattering_per_m.assign(bands, 0.0);
  medium.mie_extinction_per_m.assign(bands, 0.0);
  medium.ozone_absorption_per_m.assign(bands, 0.0);
  medium.mie_phase = {atmosphere::PhaseFunction{}};
  return Atmosphere(medium);
}

PanoramaOptions Small(int width = 8, int height = 4) {
  PanoramaOptions options;
  options.width = width;
  options.height = height;
  return options;
}

TEST(Arguments, InvalidSunsAreRefusedByNameEverywhere) {
  const auto with = [](double SunInSky::*member, double value) {
    SunInSky sun;
    sun.*member = value;
    return sun;
  };
  const std::pair<SunInSky, const char*> suns[] = {
      {with(&SunInSky::elevation_deg, kNan), "sun.elevation_deg is nan; it must lie in [-90, 90]"},
      {with(&SunInSky::elevation_deg, 95.0), "sun.elevation_deg is 95"},
      {with(&SunInSky::elevation_deg, -90.1), "sun.elevation_deg"},
      {with(&SunInSky::azimuth_deg, kNan), "sun.azimuth_deg"},
      {with(&SunInSky::azimuth_deg, kInfinity), "sun.azimuth_deg"},
      {with(&SunInSky::azimuth_deg, -1e9), "sun.azimuth_deg"},
      {with(&SunInSky::distance_au, 0.0), "sun.distance_au"},
      {with(&SunInSky::distance_au, -1.0), "sun.distance_au"},
      {with(&SunInSky::distance_au, kInfinity), "sun.distance_au"},
      {with(&SunInSky::angular_radius_deg, 0.0), "sun.angular_radius_deg"},
      {with(&SunInSky::angular_radius_deg, -0.2), "sun.angular_radius_deg"},
      {with(&SunInSky::angular_radius_deg, 200.0), "sun.angular_radius_deg"},
      {with(&SunInSky::angular_radius_deg, kNan), "sun.angular_radius_deg"},
      {with(&SunInSky::lower_for_air_deg, kNan), "sun.lower_for_air_deg"}};
  for (const auto& [sun, fault] : suns) {
    PanoramaOptions options = Small();
    options.sun = sun;
    EXPECT_THAT(tests::FaultOf([&] { return RenderPanorama(Earth(), options); }), HasSubstr(fault));
    EXPECT_THAT(tests::FaultOf([&] { return HorizontalIlluminance(Earth(), 2.0, options.sun); }),
                HasSubstr(fault));
    EXPECT_THAT(tests::FaultOf([&] { return options.sun.ToSun(); }), HasSubstr(fault));
    EXPECT_THAT(tests::FaultOf([&] { return options.sun.ToSunForAir(); }), HasSubstr(fault));
  }
}

TEST(Arguments, SunForAirStaysBetweenNadirAndZenith) {
  for (const double sign : {-1.0, 1.0}) {
    for (const double lower_deg : {0.5, 45.0, 90.0}) {
      SunInSky sun;
      sun.elevation_deg = 89.5 * sign;
      sun.lower_for_air_deg = -sign * lower_deg;
      EXPECT_NEAR(sun.ToSunForAir().up, sign, 1e-12) << lower_deg;
      SunInSky at_end = sun;
      at_end.lower_for_air_deg = -0.5 * sign;
      EXPECT_NEAR(HorizontalIlluminance(Earth(), 2.0, sun),
                  HorizontalIlluminance(Earth(), 2.0, at_end), 1e-6)
          << lower_deg;
    }
  }
}

TEST(Arguments, InvalidPanoramaOptionsAreRefusedByName) {
  const auto fault = [](const std::function<void(PanoramaOptions&)>& change) {
    PanoramaOptions options = Small();
    change(options);
    return tests::FaultOf([&] { return RenderPanorama(Earth(), options); });
  };
  EXPECT_THAT(fault([](auto& o) { o.width = 0; }), HasSubstr("width is 0"));
  EXPECT_THAT(fault([](auto& o) { o.height = -4; }), HasSubstr("height is -4"));
  EXPECT_THAT(fault([](auto& o) { o.height = 32769; }), HasSubstr("[1, 32768]"));
  EXPECT_THAT(fault([](auto& o) { o.layers = {"stokes_v"}; }), HasSubstr("layer \"stokes_v\""));
  for (const double altitude_m : {kNan, kInfinity, -12001.0, 1e15}) {
    EXPECT_THAT(fault([&](auto& o) { o.altitude_m = altitude_m; }),
                AllOf(HasSubstr("altitude_m is"), HasSubstr("[-12000, 1000000000]")));
    EXPECT_THAT(tests::FaultOf([&] { return HorizontalIlluminance(Earth(), altitude_m, {}); }),
                HasSubstr("altitude_m is"));
  }
  EXPECT_THAT(fault([](auto& o) { o.centre = static_cast<PanoramaCentre>(99); }),
              HasSubstr("centre"));
}

TEST(Arguments, SmallestSunIsDrawnWithAllItsLight) {
  const auto light = [](double elevation_deg, double radius_deg, bool draws) {
    PanoramaOptions options = Small(16, 8);
    options.sun.elevation_deg = elevation_deg;
    options.sun.angular_radius_deg = radius_deg;
    options.draws_sun = draws;
    double sum = 0.0;
    for (const auto& pixel : RenderPanorama(Earth(), options).rgb) sum += double{pixel[1]};
    return sum;
  };
  // Near the zenith a disk spans all azimuths.
  for (const double elevation_deg : {45.0, 89.9999, 90.0}) {
    const auto disk = [&](double radius_deg) {
      return light(elevation_deg, radius_deg, true) - light(elevation_deg, radius_deg, false);
    };
    EXPECT_NEAR(disk(1e-6) / disk(0.2666), 1.0, 0.02)
        << elevation_deg << ": the air varies by less than 2 % over the disk of the sun";
  }
  EXPECT_EQ(light(-90.0, 1e-6, true), light(-90.0, 1e-6, false)) << "the ground is before it";
}

TEST(Arguments, PointsOutOfRangeAreRefusedWithTheirAltitude) {
  const double radius_m = Earth().atmosphere().planet_radius_m();
  const LocalPoint eye{.up_m = 2.0};
  const Direction up{.up = 1.0};
  for (const LocalPoint& point :
       {LocalPoint{.up_m = kNan}, LocalPoint{.east_m = kInfinity}, LocalPoint{.up_m = 1e13},
        LocalPoint{.up_m = -0.6 * radius_m}, LocalPoint{.up_m = -radius_m}}) {
    for (const auto& call :
         {std::function<void()>([&] { (void)Earth().Radiance(point, up, up); }),
          std::function<void()>([&] { (void)Earth().Between(eye, point, up); }),
          std::function<void()>([&] { (void)Earth().Between(point, eye, up); }),
          std::function<void()>([&] { (void)Earth().SunIrradiance(point, up); }),
          std::function<void()>([&] { (void)Earth().SkyIrradiance(point, up); })}) {
      EXPECT_THAT(tests::FaultOf([&] { return call(), 0; }),
                  AllOf(HasSubstr("altitude"), HasSubstr("it must lie in [-")));
    }
  }
  EXPECT_GT(Earth().Radiance({.up_m = -0.4 * radius_m}, up, up)[0], 0.0F) << "as from the ground";
  EXPECT_EQ(Earth().Radiance({.up_m = 1e12}, up, up)[0], 0.0F) << "space";
}

TEST(Arguments, DirectionsOfAnyLengthExceptZeroAreAccepted) {
  const LocalPoint eye{.up_m = 2.0};
  const Direction sun{.north = 1.0, .up = 1.0};
  const float expected = Earth().Radiance(eye, sun, sun)[0];
  for (const double length : {1e-300, 1e-200, 1e200, 1e300}) {
    const Direction view{0.0, length, length};
    EXPECT_NEAR(Earth().Radiance(eye, view, sun)[0], expected, 1e-4F * expected) << length;
  }
  for (const Direction& none :
       {Direction{0.0, 0.0, 0.0}, Direction{kNan, 0.0, 1.0}, Direction{kInfinity, 0.0, 1.0}}) {
    EXPECT_THAT(tests::FaultOf([&] { return Earth().Radiance(eye, none, sun); }),
                HasSubstr("a direction is"));
    EXPECT_THAT(tests::FaultOf([&] { return Earth().SkyIrradiance(eye, none); }),
                HasSubstr("a direction is"));
  }
}

TEST(Arguments, AnglesAndSpectraOutOfRangeAreRefused) {
  EXPECT_THAT(tests::FaultOf([] { return DirectionFromAngles(kNan, 0.0); }),
              HasSubstr("elevation_deg"));
  EXPECT_THAT(tests::FaultOf([] { return DirectionFromAngles(91.0, 0.0); }),
              HasSubstr("[-90, 90]"));
  EXPECT_THAT(tests::FaultOf([] { return DirectionFromAngles(0.0, kInfinity); }),
              HasSubstr("azimuth_deg"));
  EXPECT_THAT(tests::FaultOf([] { return Spectrum(50); }), HasSubstr("bands is 50"));
  EXPECT_EQ(Spectrum(Spectrum::kMostBands).size(), Spectrum::kMostBands);
  EXPECT_THAT(tests::FaultOf([] { return Spectrum(4)[4]; }), HasSubstr("band is 4"));
  EXPECT_THAT(tests::FaultOf([] { return Luminance({kNan, 0.0, 0.0}); }), HasSubstr("red"));
  Spectrum light(4);
  light[2] = std::numeric_limits<float>::infinity();
  EXPECT_THAT(tests::FaultOf([&] { return Atmosphere().ColourOf(light); }), HasSubstr("band 2"));
}

TEST(Arguments, WavelengthsWithoutColoursAreRefusedForPictures) {
  for (const std::vector<double>& set : {std::vector<double>{200.0, 210.0},
                                         {550.0},
                                         {300.0, 310.0, 320.0},
                                         {1000.0, 2000.0, 4000.0},
                                         {200.0, 4000.0},
                                         {300.0, 350.0, 900.0, 1200.0},
                                         {500.0, 500.001}}) {
    const Atmosphere air = OnWavelengths(set);
    EXPECT_THAT(tests::FaultOf([&] { return air.ColourOf(Spectrum(set.size())); }),
                AllOf(HasSubstr("spectrum.wavelengths_nm"), HasSubstr("for colours")));
  }
  const Sky ultraviolet = CoarseSky(OnWavelengths({200.0, 210.0}));
  EXPECT_THAT(tests::FaultOf([&] { return RenderPanorama(ultraviolet, Small()); }),
              HasSubstr("for colours"));
  EXPECT_THAT(tests::FaultOf([&] { return HorizontalIlluminance(ultraviolet, 2.0, {}); }),
              HasSubstr("for colours"));
  EXPECT_GT(ultraviolet.Radiance({.up_m = 2.0}, {}, Direction{.up = 1.0})[0], 0.0F)
      << "light of any wavelength is still computed";
  for (const std::vector<double>& set :
       {std::vector<double>{440.0, 550.0, 680.0}, {450.0, 500.0, 590.0, 650.0}, {440.0, 680.0}}) {
    EXPECT_NO_THROW((void)OnWavelengths(set).ColourOf(Spectrum(set.size())));
  }
}

class ApiTableArguments : public TemporaryFolder {};

TEST_F(ApiTableArguments, InvalidEnumeratorsAreRefused) {
  EXPECT_THAT(tests::FaultOf([&] {
                return BakeTables(Atmosphere(), folder_ / "t", static_cast<BakeQuality>(9)), 0;
              }),
              HasSubstr("BakeQuality"));
  EXPECT_THAT(tests::FaultOf([&] {
                return ExportTables(Atmosphere::Preset("bruneton2017"), folder_ / "t",
                                    static_cast<TableUser>(9)),
                       0;
              }),
              HasSubstr("TableUser"));
}

// The product of two unit vectors exceeds 1 by rounding for a sixth of such places.
TEST(Sky, AcceptsASunExactlyInTheZenith) {
  const double radius_m = Earth().atmosphere().planet_radius_m();
  for (int i = 0; i < 200; ++i) {
    LocalPoint point{-3e5 + 3011.0 * i, 2.9e5 - 2903.0 * i, 0.0};
    const double across2 = point.east_m * point.east_m + point.north_m * point.north_m;
    point.up_m = std::sqrt((radius_m + 100.0) * (radius_m + 100.0) - across2) - radius_m;
    for (const double sign : {1.0, -1.0}) {
      const Direction sun{sign * point.east_m, sign * point.north_m,
                          sign * (radius_m + point.up_m)};
      EXPECT_NO_THROW((void)Earth().SunIrradiance(point, sun)) << i;
      EXPECT_NO_THROW((void)Earth().SkyIrradiance(point, sun)) << i;
      EXPECT_NO_THROW((void)Earth().Radiance(point, sun, sun)) << i;
    }
  }
}

}  // namespace
}  // namespace alpenglow
