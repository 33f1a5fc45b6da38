// SPDX-License-Identifier: MIT
// What mountain ground looks like from near and far.
#include "renderer/surface/surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "renderer/material/land_cover.h"

namespace alpenglow::renderer {
namespace {

const MountainCover kSummerCover{2100.0, 2900.0};

/// Returns the i-th of places that are spread evenly in a square.
GroundPoint SpreadPlace(int i, double side_m, double altitude_m, double footprint_m) {
  return {7e5 + side_m * std::fmod(0.7548776662 * i, 1.0),
          5e6 + side_m * std::fmod(0.5698402910 * i, 1.0), altitude_m, footprint_m};
}

struct Spread {
  double mean, share;  // rms difference from the mean, over it
};

/// Returns mean and spread of the green albedo over places of one altitude and slope in a square.
Spread AlbedoSpread(double altitude_m, double slope_deg, double footprint_m, double side_m = 8e3) {
  const MountainSurface surface(WavelengthSet(4), kSummerCover);
  const double normal_up = std::cos(slope_deg * kRadiansPerDegree);
  double sum = 0.0, sum2 = 0.0;
  constexpr int kPlaces = 2000;
  for (int i = 0; i < kPlaces; ++i) {
    const auto albedo = static_cast<double>(
        surface.Albedo(SpreadPlace(i, side_m, altitude_m, footprint_m), normal_up)[1]);
    sum += albedo / kPlaces;
    sum2 += albedo * albedo / kPlaces;
  }
  return {sum, std::sqrt(sum2 - sum * sum) / sum};
}

TEST(MountainSurface, OnlyNearGroundHasGrain) {
  for (const double altitude_m : {1000.0, 2650.0}) {
    const double near = AlbedoSpread(altitude_m, 20.0, 0.02, 5.0).share;
    EXPECT_GT(near, 0.1) << altitude_m << ": within five metres";
    EXPECT_LT(AlbedoSpread(altitude_m, 20.0, 8.0, 5.0).share, 0.3 * near) << altitude_m;
  }
}

// The mean of a curve is not the curve of the mean, for example at an irregular tree line.
TEST(MountainSurface, DetailFadesToItsMean) {
  for (const double slope_deg : {2.0, 20.0, 35.0, 50.0}) {
    for (const double altitude_m : {600.0, 1000.0, 1500.0, 1900.0, 2200.0, 2650.0}) {
      const double near = AlbedoSpread(altitude_m, slope_deg, 0.02, 4e4).mean;
      for (const double footprint_m : {2.0, 8.0, 30.0, 100.0}) {
        EXPECT_NEAR(AlbedoSpread(altitude_m, slope_deg, footprint_m, 4e4).mean / near, 1.0, 0.03)
            << slope_deg << " " << altitude_m << " " << footprint_m
            << ": grain of 0.2 rms at 2000 places is even to 0.005";
      }
    }
  }
}

TEST(MountainSurface, AMeadowIsEvenAtItsViewersFeet) {
  const MountainSurface surface(WavelengthSet(4), kSummerCover);
  float darkest = 1.0F, lightest = 0.0F;
  for (int i = 0; i < 500; ++i) {
    const GroundPoint at{7e5 + 0.01 * i, 5e6 - 0.007 * i, 1000.0, 2e-3};
    const float albedo = surface.Albedo(at, 0.99, MappedCover{0.0F, 0.0F, 0.0F})[1];
    darkest = std::min(darkest, albedo);
    lightest = std::max(lightest, albedo);
  }
  EXPECT_LT(lightest, 1.03F * darkest)
      << "over 6 m, half of the shortest wave that tints it; with blades and stones a factor of 2";
}

TEST(LandFootprint, GrowsFromTheWidthOfTheRayWithTheSlant) {
  EXPECT_DOUBLE_EQ(shared::LandFootprint(0.5, 1.0), 0.5);
  for (const double cosine : {0.2, 0.5, 0.9})
    EXPECT_GT(shared::LandFootprint(30.0, cosine), 30.0 / cosine) << cosine;
}

TEST(LandFootprint, GroundSeenFromTheSideHasNoStreaksOfGrain) {
  EXPECT_EQ(shared::OctaveShare(12.0, shared::LandFootprint(0.0, 0.1)), 0.0)
      << "waves of crowns, from a man's height at 20 m";
  EXPECT_EQ(shared::OctaveShare(12.0, shared::LandFootprint(0.0, 0.7)), 1.0) << "from above";
}

TEST(MountainSurface, SlopesUnderTheTreeLineAreEvenWood) {
  for (const double slope_deg : {15.0, 25.0, 35.0}) {
    const Spread seen = AlbedoSpread(1000.0, slope_deg, 20.0);
    EXPECT_LT(seen.mean, 0.07) << slope_deg << ": a wood is 0.05";
    EXPECT_LT(seen.share, 0.25) << slope_deg;
  }
}

TEST(MountainSurface, SteepGroundInAWoodIsNotMuchPaler) {
  EXPECT_LT(AlbedoSpread(1000.0, 45.0, 20.0).mean, 1.6 * AlbedoSpread(1000.0, 30.0, 20.0).mean);
  EXPECT_LT(AlbedoSpread(1000.0, 60.0, 20.0).mean, 2.6 * AlbedoSpread(1000.0, 30.0, 20.0).mean)
      << "rock is 0.17, over three times as light as a wood";
}

// A tone scales all bands equally, so that the ratio of two bands is that of the materials.
double Reddest(double slope_deg) {
  const MountainSurface surface(std::vector<double>{555.0, 645.0}, {2100.0, 2900.0});
  double reddest = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const Spectrum albedo =
        surface.Albedo(SpreadPlace(i, 8e3, 1000.0, 0.5), std::cos(slope_deg * kRadiansPerDegree));
    reddest = std::max(reddest, static_cast<double>(albedo[1] / albedo[0]));
  }
  return reddest;
}

TEST(MountainSurface, SlopesOfUpTo45DegreesHaveNoRock) {
  const MountainSurface surface(std::vector<double>{555.0, 645.0}, {2100.0, 2900.0});
  const Spectrum& meadow = surface.materials().meadow;
  for (const double slope_deg : {20.0, 40.0, 45.0})
    EXPECT_LT(Reddest(slope_deg), static_cast<double>(meadow[1] / meadow[0]))
        << slope_deg << ": a meadow is the reddest of what is green";
}

TEST(MountainSurface, RockGrowsWithTheSlopeAndIsGrey) {
  const MountainSurface surface(std::vector<double>{470.0, 555.0, 645.0}, {});
  const Spectrum& rock = surface.materials().rock;
  EXPECT_NEAR(rock[2] / rock[0], 1.0F, 0.1F) << "brown soil has 2";
  EXPECT_GT(Reddest(50.0), Reddest(45.0) + 0.05);
  EXPECT_GT(Reddest(58.0), Reddest(50.0) + 0.02);
  EXPECT_LT(Reddest(58.0), static_cast<double>(rock[2] / rock[1]));
}

TEST(MountainSurface, SteepGroundIsEvenAmongPlacesOfOneSlope) {
  for (const double slope_deg : {45.0, 48.0, 50.0, 55.0})
    EXPECT_LT(AlbedoSpread(1000.0, slope_deg, 20.0).share, 0.06)
        << slope_deg << ": the tone of patches is 0.04 rms";
}

TEST(MountainSurface, FlatLandHasMeadowsAndGroves) {
  const Spread seen = AlbedoSpread(600.0, 1.0, 10.0);
  EXPECT_GT(seen.mean, 0.075);
  EXPECT_GT(seen.share, 0.08);
}

// Surface reflectances in the blue, green and red (470, 555, 645 nm) as satellites see them: green
// vegetation 0.04, 0.08, 0.04 and soil 0.08, 0.12, 0.17, rounded. Land is a mixture of both.
TEST(MountainSurface, SummerLowlandIsBetweenVegetationAndSoil) {
  const MountainSurface surface(std::vector<double>{470.0, 555.0, 645.0}, {});
  const Spectrum seen = surface.Albedo({0.0, 0.0, 300.0, 1e4}, 1.0);
  EXPECT_NEAR(seen[0], 0.045F, 0.015F);
  EXPECT_NEAR(seen[1], 0.09F, 0.02F);
  EXPECT_NEAR(seen[2], 0.07F, 0.03F);
  EXPECT_GT(seen[1], seen[2]) << "green";
}

TEST(MountainSurface, DryGrassAndBareTreesAreLightestInTheRed) {
  const MountainSurface surface(std::vector<double>{470.0, 555.0, 645.0}, {});
  for (const Spectrum& dry : {surface.materials().dry_meadow, surface.materials().bare_trees}) {
    EXPECT_GT(dry[1], dry[0]);
    EXPECT_GE(dry[2], dry[1]);
  }
}

/// Returns a leafless wood in winter, with snow from 700 m.
MountainSurface WinterWood() {
  MountainCover cover{2100.0, 700.0, -2000.0, -2000.0, -2000.0};
  cover.broadleaf_line_m = 1300.0;
  return {WavelengthSet(4), cover};
}

struct Wood {
  double mean, contrast;  // the largest ratio of places 15 m apart
};

Wood SnowyWood(double altitude_m) {
  const MountainSurface surface = WinterWood();
  constexpr int kPlaces = 1000;
  Wood seen{0.0, 1.0};
  for (int i = 0; i < kPlaces; ++i) {
    GroundPoint at{7e5 + 41.7 * i, 5e6 - 93.1 * i, altitude_m, 8.0};
    const auto here = static_cast<double>(surface.Albedo(at, 0.88)[1]);
    at.east_m += 15.0;
    const auto beside = static_cast<double>(surface.Albedo(at, 0.88)[1]);
    seen.mean += here / kPlaces;
    seen.contrast = std::max({seen.contrast, here / beside, beside / here});
  }
  return seen;
}

TEST(MountainSurface, AWoodInSnowIsDark) {
  EXPECT_NEAR(SnowyWood(1300.0).mean, 0.15, 0.04)
      << "Betts, Ball (1997): 0.13 of conifers, 0.21 of aspen";
}

TEST(MountainSurface, AWoodInSnowHasNoSpeckles) {
  for (const double altitude_m : {500.0, 700.0, 900.0, 1300.0, 1700.0}) {
    EXPECT_LT(SnowyWood(altitude_m).contrast, 1.26)
        << altitude_m << ": a third of a stop, the least step of a camera; camouflage had 2.4";
  }
}

TEST(MountainSurface, SnowFadesIntoAWoodByHeight) {
  double below = SnowyWood(400.0).mean;
  for (double altitude_m = 450.0; altitude_m <= 950.0; altitude_m += 50.0) {
    const double here = SnowyWood(altitude_m).mean;
    EXPECT_GT(here, below - 1e-4) << altitude_m;
    EXPECT_LT(here, 1.4 * below) << altitude_m << ": from 0.06 to 0.17 in ten steps";
    below = here;
  }
}

TEST(VisibleSnow, CoversMeadowsAndTheGapsOfWoods) {
  EXPECT_DOUBLE_EQ(shared::SnowSeen(0.8, 0.0, 0.0, 0.12), 0.8);
  EXPECT_NEAR(shared::SnowSeen(0.8, 1.0, 0.0, 0.12), 0.8 * 0.12, 1e-12);
  EXPECT_NEAR(shared::SnowSeen(1.0, 0.5, 0.0, 0.12), std::sqrt(0.12), 1e-12)
      << "two halves of a wood hide as the whole";
}

/// Returns the mean difference of the relief over a step.
double ReliefOver(const glm::dvec3& step) {
  double sum = 0.0;
  for (int i = 0; i < 500; ++i) {
    GroundPoint at{7e5 + 37.7 * i, 5e6 - 91.3 * i, 1000.0, 0.5};
    at.up_m = 1000.0 + 13.0 * i;
    const glm::dvec3 normal =
        glm::normalize(glm::dvec3(step.y, -step.x, 0.0) +
                       (step.z != 0.0 ? glm::dvec3(0.3, 1.0, 0.0) : glm::dvec3(0.0)));
    GroundPoint beside = at;
    beside.east_m += step.x;
    beside.north_m += step.y;
    beside.up_m += step.z;
    sum += glm::length(MountainSurface::DetailedNormal(at, normal) -
                       MountainSurface::DetailedNormal(beside, normal)) /
           500.0;
  }
  return sum;
}

TEST(MountainSurface, ThePatternIsNotStretchedOnACliff) {
  const double along = ReliefOver({2.0 * std::cos(2.862), 2.0 * std::sin(2.862), 0.0});
  EXPECT_GT(ReliefOver({0.0, 0.0, 2.0}), 0.35 * along)
      << "up the cliff; 0 where the pattern is projected straight down";
}

TEST(MountainSurface, ReliefTiltsOnlyNearGround) {
  double near2 = 0.0;
  constexpr int kPlaces = 2000;
  const glm::dvec3 up(0.0, 0.0, 1.0);
  for (int i = 0; i < kPlaces; ++i) {
    const double east_m = 7e5 + 37.7 * i, north_m = 5e6 - 91.3 * i;
    const glm::dvec3 near = MountainSurface::DetailedNormal({east_m, north_m, 0.0, 0.01}, up);
    near2 += std::pow(std::acos(near.z) / kRadiansPerDegree, 2) / kPlaces;
    EXPECT_EQ(MountainSurface::DetailedNormal({east_m, north_m, 0.0, 110.0}, up).z, 1.0);
  }
  EXPECT_NEAR(std::sqrt(near2), 6.4, 0.3) << "the header's figure, to its rounding";
}

constexpr double kBreeze = 0.003 + 0.00512 * 5.0;  // Cox, Munk: 5 m/s

struct MeanWaves {
  double resolved, left;  // slope variance
};

MeanWaves WavesSeen(double variance, double footprint_m, double cosine) {
  MeanWaves mean{0.0, 0.0};
  constexpr int kPlaces = 4000;
  for (int i = 0; i < kPlaces; ++i) {
    const GroundPoint at{7e5 + 317.3137515 * i, 5e6 - 211.7218281 * i, 0.0, footprint_m, cosine};
    const WavySurface waves = WavesAt(at, variance);
    mean.resolved +=
        (waves.slope_east * waves.slope_east + waves.slope_north * waves.slope_north) / kPlaces;
    mean.left += waves.slope_variance / kPlaces;
  }
  return mean;
}

TEST(GroundMaterial, WaterHasTheWavesOfItsWind) {
  const std::vector<double> wavelengths_nm = WavelengthSet(4);
  GroundCover cover;
  const auto variance = [&] {
    return GroundMaterial(cover, nullptr, wavelengths_nm).water().slope_variance();
  };
  EXPECT_DOUBLE_EQ(variance(), 0.0286) << "0.003 + 0.00512 W at 5 m/s, without a wind";
  cover.wind_m_per_s = 12.0;
  EXPECT_DOUBLE_EQ(variance(), 0.06444);
}

TEST(Waves, SlopesAreThoseOfTheWindAtEveryDistance) {
  for (const double footprint_m : {0.005, 0.1, 1.0, 5.0}) {
    const MeanWaves seen = WavesSeen(kBreeze, footprint_m, 1.0);
    EXPECT_NEAR(seen.resolved + seen.left, kBreeze, 0.05 * kBreeze)
        << footprint_m << ": 4000 places, and a rounded slope of the noise";
    EXPECT_GT(seen.left, 0.2 * kBreeze) << "ripples under 2 cm are never resolved";
  }
}

TEST(Waves, AreResolvedNearAndGlitterFar) {
  EXPECT_GT(WavesSeen(kBreeze, 0.01, 1.0).resolved, 0.5 * kBreeze);
  EXPECT_EQ(WavesSeen(kBreeze, 100.0, 1.0).resolved, 0.0) << "the longest are of 21 m";
  EXPECT_NEAR(WavesSeen(kBreeze, 100.0, 1.0).left, kBreeze, 1e-12);
  EXPECT_EQ(WavesSeen(0.003, 0.01, 1.0).resolved, 0.0) << "a calm sea has none";
}

TEST(Waves, HiddenWavesBelongToTheGlitter) {
  EXPECT_EQ(WavesSeen(kBreeze, 0.01, 0.0).resolved, 0.0);
  EXPECT_EQ(WavesSeen(kBreeze, 0.01, -0.1).resolved, 0.0) << "a normal turned away from the eye";
}

// Lamb (1932), section 267: waves are slowest, 0.232 m/s, at 17 mm; longer ones go as the root of
// their length.
TEST(Waves, TravelAsInDeepWater) {
  EXPECT_NEAR(WaveSpeed(2.0 * kPi / 0.0173), 0.232, 0.002);
  EXPECT_GT(WaveSpeed(2.0 * kPi / 0.01), 0.232);
  EXPECT_NEAR(WaveSpeed(2.0 * kPi / 100.0), 12.49, 0.01) << "sqrt(g 100 m / 2 pi)";
}

TEST(Waves, AnOctaveMovesWithItsDrift) {
  for (const NoiseOctave& octave : OctavesOf(GroundNoise::kWaves)) {
    const GroundPoint now{7e5, 5e6, 0.0, 0.01};
    GroundPoint then = now;
    then.sea_s = 10.0;
    then.east_m += 10.0 * octave.drift_east;
    then.north_m += 10.0 * octave.drift_north;
    const glm::dvec2 a = octave.PlaceOf(now), b = octave.PlaceOf(then);
    EXPECT_NEAR(a.x, b.x, 1e-5) << octave.wavelength_m;
    EXPECT_NEAR(a.y, b.y, 1e-5) << octave.wavelength_m;
  }
}

TEST(Waves, MoveSmoothlyAfterYears) {
  const double now_s = SeaTime(ParseInstant("2093-08-01T12:00:00Z"));
  double moved = 0.0, jumped = 0.0;
  for (int i = 0; i < 300; ++i) {
    GroundPoint at{7e5 + 317.3 * i, 5e6 - 211.7 * i, 0.0, 0.02};
    at.sea_s = now_s;
    const WavySurface here = WavesAt(at, kBreeze);
    at.sea_s = now_s + 1.0;
    moved += std::abs(WavesAt(at, kBreeze).slope_east - here.slope_east) / 300.0;
    at.sea_s = now_s + 1e-4;
    jumped = std::max(jumped, std::abs(WavesAt(at, kBreeze).slope_east - here.slope_east));
  }
  EXPECT_GT(moved, 0.02) << "after a second the sea is another: 0.12 rms";
  EXPECT_LT(jumped, 2e-3) << "0.1 ms is 0.1 mm of ripples of 30 mm";
}

}  // namespace
}  // namespace alpenglow::renderer
