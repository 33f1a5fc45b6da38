// SPDX-License-Identifier: MIT
// The tables of one eye's air, read on the processor, against direct evaluation of every ray.
#include "lut/camera_tables/air_tables.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/medium/atmosphere_file.h"
#include "tests/fixtures/sanitized.h"
#include "tests/lut/camera_tables/air_reference.h"

namespace alpenglow::lut {
namespace {

constexpr int kRays = tests::ScaledDown(200, 60);
/// A few large errors make up most of an rms, so that 60 rays determine it to a third. Only the
/// preset without sanitizers, with 200 rays, asserts the bounds themselves.
constexpr double kSampling = tests::ScaledDown(1.0, 1.5);

const SolvedAir& Hazy() {
  static const SolvedAir hazy = tests::SolvedAsClearAir(MediumPreset("hazy"));
  return hazy;
}

AirTables TablesOf(const SolvedAir& air, const EyeUnderLight& eye, AirQuality quality) {
  return MakeAirTables(air, MakeMediumTables(air), eye, AirTablesSizeOf(quality, eye.altitude_m));
}

/// Root mean square of relative errors; 99 % of rays and bands are below five times as much.
struct Bounds {
  double sky, ways, transmittance;
};

void ExpectErrorsBelow(const SolvedAir& air, const EyeUnderLight& eye, AirQuality quality,
                       const Bounds& bounds) {
  SCOPED_TRACE(fmt::format("{}, {} m, sine of the sun's elevation {}", air.medium().name,
                           eye.altitude_m, eye.mu_s()));
  const MediumTables medium = MakeMediumTables(air);
  const AirTables tables = TablesOf(air, eye, quality);
  const tests::AirReading reading(tables);
  const tests::AirReference reference(air, eye);
  const auto expect = [](const tests::AirErrors& errors, double bound, const char* what) {
    EXPECT_LT(errors.Rms(), kSampling * bound) << what << ": a third more than measured";
    EXPECT_LT(errors.Percentile(99.0), 5.0 * kSampling * bound) << what;
  };
  expect(tests::SkyErrors(reference, reading, tables.map, kRays), bounds.sky, "sky");
  expect(tests::WayErrors(reference, reading, tables.map, kRays), bounds.ways, "ways");
  expect(tests::TransmittanceErrors(reference, reading, tables.map, kRays), bounds.transmittance,
         "transmittance");
}

// --- against direct evaluation ---

// Near a low sun most of the error is that of the glow, which is taken to be that of one column of
// aerosol.
TEST(AirTables, OnTheGroundAgreeWithTheIntegratorFromNoonToDusk) {
  ExpectErrorsBelow(tests::Earth(), tests::EyeUnderSun(2.0, 60.0), AirQuality::kHigh,
                    {7e-5, 2.1e-4, 2e-5});
  ExpectErrorsBelow(tests::Earth(), tests::EyeUnderSun(1500.0, 6.0), AirQuality::kHigh,
                    {1.7e-3, 6.2e-4, 9e-5});
  ExpectErrorsBelow(tests::Earth(), tests::EyeUnderSun(1500.0, 0.2), AirQuality::kHigh,
                    {1.5e-3, 1.5e-3, 9e-5});
  ExpectErrorsBelow(tests::Earth(), tests::EyeUnderSun(1500.0, -4.0), AirQuality::kHigh,
                    {8e-4, 1.3e-3, 9e-5});
  ExpectErrorsBelow(tests::Earth(), tests::EyeUnderSun(2.0, -10.0), AirQuality::kHigh,
                    {4e-4, 2.5e-3, 2e-5});
}

// From 2500 m, where a setting sun is seen on the horizon, low air about it is dark and high air is
// not: tables whose aureole is elsewhere than the one that shaders put on them have a dark spot and
// a bright.
TEST(AirTables, HaveTheAureoleAroundTheApparentSun) {
  const EyeUnderLight eye{
      2500.0,
      {tests::EyeUnderSun(0.0, -1.3).light.seen, tests::EyeUnderSun(0.0, -1.8).light.for_air}};
  const MediumTables medium = MakeMediumTables(tests::Earth());
  const tests::AirReference reference(tests::Earth(), eye);
  // Largest error of the sky within two degrees of the sun and of the horizon.
  const auto worst_of = [&](const AirTables& tables) {
    const tests::AirReading reading(tables, eye);
    double worst = 0.0;
    for (const double angle_deg : {-1.5, -0.7, -0.3, -0.1, 0.1, 0.4, 0.8, 1.5}) {
      for (const double azimuth_deg : {0.0, 0.3, 0.8, 2.0}) {
        const double angle = angle_deg * kRadiansPerDegree,
                     azimuth = azimuth_deg * kRadiansPerDegree;
        const SpectrumOf<double> exact = reference.Sky(tables.map, angle, azimuth);
        const glm::dvec4 read = reading.Sky(angle, azimuth);
        for (std::size_t band = 0; band < exact.size(); ++band)
          worst =
              std::max(worst, std::abs(read[static_cast<glm::length_t>(band)] / exact[band] - 1.0));
      }
    }
    return worst;
  };
  EXPECT_LT(worst_of(TablesOf(tests::Earth(), eye, AirQuality::kHigh)), 0.01)
      << "half as much again as measured, where red dies within a degree";
  const EyeUnderLight elsewhere = tests::EyeUnderSun(2500.0, -1.8);
  EXPECT_GT(worst_of(TablesOf(tests::Earth(), elsewhere, AirQuality::kHigh)), 0.1)
      << "tables of an aureole that is elsewhere have a spot";
}

TEST(AirTables, AtGreatHeightsAgreeWithTheIntegrator) {
  ExpectErrorsBelow(tests::Earth(), tests::EyeUnderSun(9e3, 30.0), AirQuality::kHigh,
                    {1.6e-4, 8e-4, 3e-4});
  ExpectErrorsBelow(tests::Earth(), tests::EyeUnderSun(9e3, -4.0), AirQuality::kHigh,
                    {2.1e-3, 1.6e-3, 3e-4});
  ExpectErrorsBelow(tests::Earth(), tests::EyeUnderSun(30e3, 6.0), AirQuality::kHigh,
                    {4.5e-4, 1.6e-3, 3e-4});
}

TEST(AirTables, AboveTheAirAgreeWithTheIntegrator) {
  ExpectErrorsBelow(tests::Earth(), tests::EyeUnderSun(400e3, 60.0), AirQuality::kHigh,
                    {5.5e-4, 1.7e-3, 6e-4});
  ExpectErrorsBelow(tests::Earth(), tests::EyeUnderSun(400e3, -2.0), AirQuality::kHigh,
                    {1.6e-3, 4.5e-3, 6e-4});
}

TEST(AirTables, OfHazeAgreeWithTheIntegrator) {
  ExpectErrorsBelow(Hazy(), tests::EyeUnderSun(300.0, 30.0), AirQuality::kHigh, {2e-4, 9e-4, 4e-5});
}

TEST(AirTables, OfLowQualityAreAccurateToAPercent) {
  ExpectErrorsBelow(tests::Earth(), tests::EyeUnderSun(1500.0, 20.0), AirQuality::kLow,
                    {1.25e-3, 1.2e-3, 3.6e-4});
  ExpectErrorsBelow(tests::Earth(), tests::EyeUnderSun(9e3, 2.0), AirQuality::kLow,
                    {1.3e-3, 4.5e-3, 1.2e-3});
}

// Dust's phase function rises a hundredfold within ten degrees of the sun. Of the largest error,
// 0.9 %, the glow makes more than half: it is taken to be that of one column of aerosol.
TEST(AirTables, HaveAnAureoleAsSharpAsThePhaseFunction) {
  const SolvedAir dusty =
      tests::SolvedAsClearAir(MediumFromToml("[aerosol]\nmixture = \"desert\"\n", "dusty"));
  const EyeUnderLight eye = tests::EyeUnderSun(300.0, 20.0);
  const MediumTables medium = MakeMediumTables(dusty);
  const AirTables tables = TablesOf(dusty, eye, AirQuality::kLow);
  const tests::AirReading reading(tables);
  const tests::AirReference reference(dusty, eye);
  const double sun = std::asin(eye.mu_s()) + tables.map.horizon_dip;
  for (int i = 1; i <= 60; ++i) {
    const double from_sun = kRadiansPerDegree * (0.27 + 10.0 * Halton(i, 2) * Halton(i, 2));
    const double turn = kPi * Halton(i, 3);
    const double angle = sun + from_sun * std::cos(turn);
    const double azimuth = from_sun * std::sin(turn) / std::cos(angle - tables.map.horizon_dip);
    const SpectrumOf<double> exact = reference.Sky(tables.map, angle, azimuth);
    const glm::dvec4 read = reading.Sky(angle, azimuth);
    for (std::size_t band = 0; band < exact.size(); ++band) {
      EXPECT_NEAR(read[static_cast<glm::length_t>(band)] / exact[band], 1.0, 1.2e-2)
          << from_sun / kRadiansPerDegree << " degrees from the sun";
    }
  }
}

// --- every eye and every sun ---

void ExpectSound(const AirTexels& texels, const char* name) {
  for (const glm::vec4& texel : texels.texel) {
    for (glm::length_t band = 0; band < 4; ++band) {
      ASSERT_TRUE(std::isfinite(texel[band])) << name;
      ASSERT_GE(texel[band], 0.0F) << name;
    }
  }
}

TEST(AirTables, AreFiniteAndNotNegativeForEveryEyeAndSun) {
  constexpr std::array kSuns_deg{90.0, 0.0, -18.0, -90.0, 0.27, -0.27};
  for (const double altitude_m : {-100.0, 0.0, 8999.0, 9001.0, 99e3, 101e3, 400e3, 1e9}) {
    // Every other height has other suns.
    const std::size_t first = altitude_m > 9e3 ? 3 : 0;
    for (const double elevation_deg :
         std::span(kSuns_deg).subspan(first, tests::ScaledDown<std::size_t>(3, 1))) {
      SCOPED_TRACE(fmt::format("{} m, sun at {} degrees", altitude_m, elevation_deg));
      const AirTables tables = TablesOf(
          tests::Earth(), tests::EyeUnderSun(altitude_m, elevation_deg), AirQuality::kFirst);
      ExpectSound(tables.sky, "sky");
      ExpectSound(tables.to_space, "to_space");
      ExpectSound(tables.extinction, "extinction");
      ExpectSound(tables.single, "single");
      ExpectSound(tables.multiple_scattering, "diffuse");
    }
  }
}

TEST(AirTables, OfMarsAreFiniteAndNotNegative) {
  const SolvedAir mars = tests::SolvedAsClearAir(MediumPreset("mars"));
  for (const double altitude_m : {0.0, 30e3, 400e3}) {
    const AirTables tables =
        TablesOf(mars, tests::EyeUnderSun(altitude_m, 0.1), AirQuality::kFirst);
    for (const AirTexels* texels :
         {&tables.sky, &tables.extinction, &tables.single, &tables.multiple_scattering})
      ExpectSound(*texels, "of Mars");
  }
}

TEST(AirTables, BelowSeaLevelEqualThoseAtSeaLevel) {
  const AirTables below =
      TablesOf(tests::Earth(), tests::EyeUnderSun(-100.0, 20.0), AirQuality::kFirst);
  const AirTables at = TablesOf(tests::Earth(), tests::EyeUnderSun(0.0, 20.0), AirQuality::kFirst);
  EXPECT_EQ(below.sky.texel, at.sky.texel);
  EXPECT_EQ(below.single.texel, at.single.texel);
}

TEST(AirTables, DoNotDependOnAzimuthUnderASunInTheZenith) {
  const AirTables tables =
      TablesOf(tests::Earth(), tests::EyeUnderSun(1500.0, 90.0), AirQuality::kFirst);
  for (int y = 0; y < tables.sky.height; ++y) {
    const glm::vec4 towards = tables.sky.At(0, y), away = tables.sky.At(tables.sky.width - 1, y);
    for (glm::length_t band = 0; band < 4; ++band)
      EXPECT_NEAR(away[band], towards[band], 1e-4F * towards[band]) << "row " << y;
  }
}

TEST(AirTables, HaveNoSingleScatteringForASunFarBelowTheHorizon) {
  const AirTables tables =
      TablesOf(tests::Earth(), tests::EyeUnderSun(2.0, -18.0), AirQuality::kFirst);
  for (const glm::vec4& texel : tables.single.texel)
    ASSERT_EQ(texel, glm::vec4(0.0F)) << "up to 9 km all is in the planet's shadow";
}

bool HasSingle(const AirTables& tables) {
  return std::any_of(tables.single.texel.begin(), tables.single.texel.end(),
                     [](const glm::vec4& texel) { return texel != glm::vec4(0.0F); });
}

// The dust of Mars is lit up to 33 km, and its forward peak is seen long after sunset.
TEST(AirTables, OfASetSunHaveAllLightInOneTable) {
  const SolvedAir mars = tests::SolvedAsClearAir(MediumPreset("mars"));
  EXPECT_TRUE(HasSingle(TablesOf(tests::Earth(), tests::EyeUnderSun(2.0, -3.1), AirQuality::kLow)));
  EXPECT_TRUE(HasSingle(TablesOf(mars, tests::EyeUnderSun(2.0, -7.0), AirQuality::kLow)));
  EXPECT_FALSE(
      HasSingle(TablesOf(tests::Earth(), tests::EyeUnderSun(2.0, -3.3), AirQuality::kLow)));
  EXPECT_FALSE(HasSingle(TablesOf(mars, tests::EyeUnderSun(2.0, -8.2), AirQuality::kLow)));
  ExpectErrorsBelow(tests::Earth(), tests::EyeUnderSun(2.0, -3.3), AirQuality::kHigh,
                    {2.2e-4, 1.1e-3, 2e-5});
  ExpectErrorsBelow(mars, tests::EyeUnderSun(2.0, -8.2), AirQuality::kHigh, {5e-2, 6.2e-2, 6e-5});
}

TEST(AirTables, OfThreeWavelengthsLeaveTheFourthBandDark) {
  const SolvedAir air = tests::SolvedAsClearAir(MediumPreset("bruneton2017"));
  const AirTables tables = TablesOf(air, tests::EyeUnderSun(2.0, 30.0), AirQuality::kFirst);
  for (const glm::vec4& texel : tables.sky.texel) ASSERT_EQ(texel.w, 0.0F);
  EXPECT_GT(tables.sky.At(0, 0).x, 0.0F);
}

TEST(AirTables, OfMoreThanFourWavelengthsAreRefused) {
  EXPECT_THROW(RequireFourBands(MediumPreset("earth", WavelengthSet(8))), InputError);
}

// --- the map ---

TEST(AirMap, CoordinatesAreInvertible) {
  for (double v = 0.0; v <= 1.0; v += 0.125) {
    EXPECT_NEAR(shared::AirRow<double>(shared::AirHalfTangent<double>(v, 1.3), 1.3), v, 1e-12);
    const double azimuth = 4.0 * std::atan(shared::AirQuarterTangent<double>(v));
    EXPECT_NEAR(shared::AirColumn<double>(0.5 - 0.5 * std::cos(azimuth)), v, 1e-7);
    for (const double crowding : {-0.9, 0.0, 6.0}) {
      const double share = shared::AirShareFromNode<double>(v, crowding);
      EXPECT_NEAR(shared::AirNodeFromShare<double>(share, crowding), v, 1e-12);
    }
  }
}

TEST(AirMap, RaysEndAtSeaLevelOrAboveAllLand) {
  const double radius = 6371.0;
  for (const double h : {0.1, 5.0, 12.0, 400.0}) {
    const double down = -0.5;
    const double ground = shared::AirEndDown<double>(h, down, radius);
    EXPECT_NEAR(shared::AltitudeAlongRay<double>(h, down, ground, radius), 0.0, 1e-9);
    const double up = h < 9.0 ? 0.1 : shared::HorizonCosine<double>(h, radius) + 1e-4;
    const double end = shared::AirEndUp<double>(h, up, 9.0, radius);
    EXPECT_NEAR(shared::AltitudeAlongRay<double>(h, up, end, radius), 9.0, 1e-6);
    EXPECT_GT(shared::AltitudeAlongRay<double>(h, up, end + 1.0, radius), 9.0) << "for good";
  }
}

TEST(AirTablesSize, NoSideOfATextureIsAPowerOfTwo) {
  for (const AirQuality quality :
       {AirQuality::kFirst, AirQuality::kLow, AirQuality::kMedium, AirQuality::kHigh}) {
    for (const double altitude_m : {100.0, 400e3}) {
      const AirTablesSize size = AirTablesSizeOf(quality, altitude_m);
      for (const int side :
           {size.sky_columns, size.sky_rows + size.sky_ground_rows, size.columns,
            size.rows + size.ground_rows, size.distances, size.extinction_distances,
            size.extinction_rows + size.extinction_ground_rows,
            size.through_rows + size.through_ground_rows}) {
        EXPECT_EQ(side, OffPowersOfTwo(side)) << static_cast<int>(quality) << ' ' << altitude_m;
      }
    }
  }
}

}  // namespace
}  // namespace alpenglow::lut
