// SPDX-License-Identifier: MIT
#include "renderer/relief/relief.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "atmosphere/base/error.h"
#include "renderer/procedural_mountains/lattice_noise.h"
#include "tests/fixtures/sanitized.h"

namespace alpenglow::renderer {
namespace {

using tests::ScaledDown;

constexpr MountainCover kBareRock{.tree_line_m = -1e5, .snow_line_m = 1e5};
constexpr MountainCover kCover{.tree_line_m = 1900.0, .snow_line_m = 2600.0};

/// A model with the same second derivatives everywhere, at a place.
struct Bowl {
  double height_m = 2000.0, slope_east = 0.7, slope_north = 0.4;
  double bend_east_per_m = 0.0, bend_across_per_m = 0.0, bend_north_per_m = 0.0;

  [[nodiscard]] ModelAt<double> At(double x, double y) const {
    return {height_m + slope_east * x + slope_north * y +
                0.5 * (bend_east_per_m * x * x + bend_north_per_m * y * y) +
                bend_across_per_m * x * y,
            slope_east + bend_east_per_m * x + bend_across_per_m * y,
            slope_north + bend_across_per_m * x + bend_north_per_m * y,
            bend_east_per_m,
            bend_across_per_m,
            bend_north_per_m};
  }
};

Relief<double> On(const Bowl& bowl, double x, double y, const ReliefScale& scale) {
  return ReliefAt(BlockPlaceOf<double>(x, y), bowl.At(x, y), kCover, scale);
}

/// Returns places in a square, spread evenly.
std::vector<std::array<double, 2>> Places(int count, double side_m) {
  std::vector<std::array<double, 2>> places;
  for (int i = 0; i < count; ++i) {
    const double x = 0.7548776662466927 * i, y = 0.5698402909980532 * i;
    places.push_back({side_m * (x - std::floor(x) - 0.5), side_m * (y - std::floor(y) - 0.5)});
  }
  return places;
}

TEST(Relief, ModelsOfHalfAMetreGetNone) {
  for (const auto& [x, y] : Places(300, 5000.0))
    EXPECT_EQ(On({}, x, y, {.spacing_m = 0.5, .footprint_m = 0.1}).height_m, 0.0);
}

TEST(Relief, ModelsOfAKilometreGetABoundedOne) {
  double squares = 0.0;
  const auto places = Places(ScaledDown(4000, 400), 20000.0);
  for (const auto& [x, y] : places) {
    Bowl steep{.height_m = 2000.0 - 0.9 * x, .slope_east = 0.9, .slope_north = 0.0};
    const double height = On(steep, x, y, {.spacing_m = 1000.0, .footprint_m = 1.0}).height_m;
    EXPECT_LT(std::abs(height), 160.0);
    squares += height * height;
  }
  EXPECT_GT(std::sqrt(squares / static_cast<double>(places.size())), 5.0);
}

TEST(Relief, SharesAreFractionsOfOne) {
  for (const auto& [x, y] : Places(1000, 4000.0)) {
    for (const double footprint_m : {0.1, 30.0, 300.0}) {
      const SurfaceShares<double> shares = On({}, x, y, {.footprint_m = footprint_m}).shares;
      for (const double share :
           {shares.bedrock, shares.scree, shares.meadow, shares.forest, shares.snow}) {
        EXPECT_GE(share, 0.0);
        EXPECT_LE(share, 1.0);
      }
      EXPECT_NEAR(shares.bedrock + shares.scree + shares.meadow + shares.forest + shares.snow, 1.0,
                  1e-12);
    }
  }
}

TEST(Relief, GradientIsThatOfTheHeights) {
  const Bowl bowl{2300.0, 0.7, 0.4, 2e-4, -1e-4, 3e-4};
  const ReliefScale scale{.spacing_m = 90.0, .footprint_m = 1.0};
  constexpr double kStep_m = 1e-5;
  for (const auto& [x, y] : Places(ScaledDown(2000, 200), 3000.0)) {
    const auto height = [&](double dx, double dy) {
      return bowl.At(x + dx, y + dy).height_m + On(bowl, x + dx, y + dy, scale).height_m;
    };
    const Relief<double> relief =
        SlopedReliefAt(BlockPlaceOf<double>(x, y), bowl.At(x, y), kCover, scale);
    // Rounding of heights of 2000 m is 2e-13 m, and curvatures are below 10 / m.
    EXPECT_NEAR((height(kStep_m, 0) - height(-kStep_m, 0)) / (2.0 * kStep_m), relief.slope_east,
                2e-4);
    EXPECT_NEAR((height(0, kStep_m) - height(0, -kStep_m)) / (2.0 * kStep_m), relief.slope_north,
                2e-4);
    EXPECT_NEAR(relief.height_m, On(bowl, x, y, scale).height_m, 1e-9);
  }
}

TEST(Relief, FloatAgreesWithDoubleAt50km) {
  double largest = 0.0, largest_share = 0.0;
  for (const auto& [x, y] : Places(ScaledDown(4000, 400), 3000.0)) {
    const BlockPlace<float> place = BlockPlaceOf<float>(50000.0 + x, -50000.0 + y);
    const ModelAt<double> exact = Bowl{.slope_east = 0.6, .slope_north = 0.5}.At(x, y);
    const ModelAt<float> model{static_cast<float>(exact.height_m), 0.6F, 0.5F, 0.0F, 0.0F, 0.0F};
    const BlockPlace<double> wide{place.east_block, place.north_block,
                                  static_cast<double>(place.east_m),
                                  static_cast<double>(place.north_m)};
    const ModelAt<double> wide_model{static_cast<double>(model.height_m),
                                     static_cast<double>(model.slope_east),
                                     static_cast<double>(model.slope_north),
                                     0.0,
                                     0.0,
                                     0.0};
    const ReliefScale scale{.spacing_m = 90.0, .footprint_m = 0.5};
    const Relief<float> fast = ReliefAt(place, model, kCover, scale);
    const Relief<double> slow = ReliefAt(wide, wide_model, kCover, scale);
    largest = std::max(largest, std::abs(static_cast<double>(fast.height_m) - slow.height_m));
    largest_share = std::max(
        largest_share, std::abs(static_cast<double>(fast.shares.bedrock) - slow.shares.bedrock));
  }
  EXPECT_LT(largest, 3e-3) << "m; float resolves 0.06 mm in a block and 0.2 mm at 3 km height";
  EXPECT_LT(largest_share, 0.02) << "borders are 0.15 m of height wide";
}

TEST(Relief, PlaceIsTheSameInAnyBlock) {
  const ReliefScale scale{.spacing_m = 90.0, .footprint_m = 1.0};
  for (const auto& [x, y] : Places(200, 3000.0)) {
    BlockPlace<double> place = BlockPlaceOf<double>(x, y);
    const double height = ReliefAt(place, Bowl().At(x, y), kCover, scale).height_m;
    place.east_block -= 1;
    place.east_m += shared::kBlock_m;
    place.north_block += 2;
    place.north_m -= 2 * shared::kBlock_m;
    EXPECT_NEAR(ReliefAt(place, Bowl().At(x, y), kCover, scale).height_m, height, 1e-8);
  }
}

TEST(Relief, HeightIsContinuousAcrossCellsAndBlocks) {
  const ReliefScale scale{.spacing_m = 90.0, .footprint_m = 1.0};
  constexpr double kStep_m = 1e-7;  // slopes are below 100
  for (int i = -600; i <= 600; ++i) {
    const double border = 2.0 * i, along = 0.37 * i + 0.11;
    EXPECT_NEAR(On({}, border - kStep_m, along, scale).height_m,
                On({}, border + kStep_m, along, scale).height_m, 1e-5);
    EXPECT_NEAR(On({}, along, border - kStep_m, scale).height_m,
                On({}, along, border + kStep_m, scale).height_m, 1e-5);
  }
}

TEST(Relief, RepeatsItselfExactly) {
  for (const auto& [x, y] : Places(100, 9000.0))
    EXPECT_EQ(On({}, x, y, {}).height_m, On({}, x, y, {}).height_m);
}

TEST(Relief, RefusesScalesThatAreNotPositive) {
  EXPECT_THROW(On({}, 0.0, 0.0, {.spacing_m = 0.0}), InternalError);
  EXPECT_THROW(On({}, 0.0, 0.0, {.footprint_m = -1.0}), InternalError);
}

/// Mean squares of the slope of the relief along profiles on a plane, by octave of wavelength:
/// 512-256 m, ..., 16-8 m. A direct Fourier sum.
using Octaves = std::array<double, 6>;

/// Level profiles keep the height of their middle, and so their cover. Rising ones are bare rock.
enum ProfileHeight { kLevel, kRising };

Octaves SlopesByOctave(const Bowl& plane, double along_east, double along_north,
                       ProfileHeight profile_height = kLevel) {
  constexpr int kPoints = 256;
  constexpr double kStep_m = 4.0, kPi = std::numbers::pi;
  Octaves squares{};
  const int profiles = ScaledDown(12, 2);
  for (int profile = 0; profile < profiles; ++profile) {
    const double x = 300.0 * profile * along_north, y = -300.0 * profile * along_east;
    std::vector<double> slope(kPoints);
    const auto height = [&](int i) {
      const double east_m = x + i * kStep_m * along_east, north_m = y + i * kStep_m * along_north;
      const ReliefScale scale{.spacing_m = 200.0, .footprint_m = 2.0};
      const BlockPlace<double> place = BlockPlaceOf<double>(east_m, north_m);
      return profile_height == kLevel
                 ? ReliefAt(place, plane.At(0.0, 0.0), kCover, scale).height_m
                 : ReliefAt(place, plane.At(east_m, north_m), kBareRock, scale).height_m;
    };
    for (int i = 0; i < kPoints; ++i)
      slope[static_cast<std::size_t>(i)] =
          (0.5 - 0.5 * std::cos(2.0 * kPi * i / kPoints)) * (height(i + 1) - height(i)) / kStep_m;
    for (int k = 2; k < kPoints / 2; ++k) {
      double cosine = 0.0, sine = 0.0;
      for (int i = 0; i < kPoints; ++i) {
        cosine += slope[static_cast<std::size_t>(i)] * std::cos(2.0 * kPi * i * k / kPoints);
        sine += slope[static_cast<std::size_t>(i)] * std::sin(2.0 * kPi * i * k / kPoints);
      }
      const auto octave = static_cast<std::size_t>(std::log2(k)) - 1;
      // The window has a mean square of 3/8.
      squares[octave] +=
          2.0 * (cosine * cosine + sine * sine) / (0.375 * kPoints * kPoints * profiles);
    }
  }
  return squares;
}

TEST(Relief, SteepGroundIsRoughInAllOctaves) {
  const Bowl plane{.height_m = 2300.0, .slope_east = 0.0, .slope_north = 0.8};
  const Octaves across = SlopesByOctave(plane, 1.0, 0.0), along = SlopesByOctave(plane, 0.0, 1.0);
  // The octave of 256 to 128 m has a slope of 0.099 in real mountains with a mean slope of 0.47;
  // the ground here is steeper.
  for (std::size_t k = 0; k < across.size(); ++k) {
    const double slope = std::sqrt(0.5 * (across[k] + along[k]));
    EXPECT_GT(slope, 0.09) << k;
    EXPECT_LT(slope, 0.45) << k;
  }
}

TEST(Relief, GentleSoilIsSmoothBelowHillslopes) {
  const Octaves squares =
      SlopesByOctave({.height_m = 1500.0, .slope_east = 0.0, .slope_north = 0.22}, 1.0, 0.0);
  for (const double square : squares) EXPECT_LT(std::sqrt(square), 0.06);
  EXPECT_LT(squares[5], 0.5 * squares[2]) << "creep removes short waves";
}

TEST(Relief, GulliesRunAlongTheFallLine) {
  const Bowl plane{.height_m = 2300.0, .slope_east = 0.0, .slope_north = 0.7};
  const Octaves across = SlopesByOctave(plane, 1.0, 0.0), along = SlopesByOctave(plane, 0.0, 1.0);
  EXPECT_GT(across[2], 2.0 * along[2]);
}

TEST(Relief, CliffsHaveFewerStripesThanSlopes) {
  const auto ratio = [](double slope) {
    const Bowl plane{.height_m = 2300.0, .slope_east = 0.0, .slope_north = slope};
    return SlopesByOctave(plane, 1.0, 0.0, kRising)[4] /
           SlopesByOctave(plane, 0.0, 1.0, kRising)[4];
  };
  // Waves of 32 to 16 m: those of cliffs are mostly crags, whose lattice leans.
  EXPECT_LT(ratio(1.6), 0.5 * ratio(0.9));
  EXPECT_LT(ratio(2.0), 0.5 * ratio(0.9));
}

TEST(ReliefForms, SineOfTurnsIsTheSine) {
  for (int i = -500; i <= 500; ++i)
    EXPECT_NEAR(shared::SineOfTurns(0.001 * i), std::sin(0.002 * std::numbers::pi * i), 4e-6);
}

TEST(ReliefForms, GulliesHaveAMeanOfZero) {
  double profile = 0.0;
  constexpr int kSteps = 1000;
  for (int i = 0; i < kSteps; ++i) {
    const double phase = 2.0 * std::numbers::pi * i / kSteps;
    profile += shared::GullyProfile(shared::GullyRoot(std::cos(phase))) / kSteps;
    // Central difference with an error of 1e-8.
    const auto at = [&](double p) { return shared::GullyProfile(shared::GullyRoot(std::cos(p))); };
    EXPECT_NEAR(shared::GullyProfileSlope(shared::GullyRoot(std::cos(phase)), std::sin(phase)),
                (at(phase + 1e-4) - at(phase - 1e-4)) / 2e-4, 1e-6);
  }
  EXPECT_NEAR(profile, 0.0, 1e-4);
}

TEST(ReliefForms, CragsHaveAMeanOfZero) {
  double sum = 0.0;
  constexpr int kPlaces = 40000;
  for (const auto& [x, y] : Places(kPlaces, 2000.0))
    sum += shared::CragHeight(1.0, 1.5 * std::abs(GradientNoise(x, y, 5U)), 0.0) / kPlaces;
  EXPECT_NEAR(sum, 0.0, 4e-4) << "cells; the error of the mean of 40000 places is 1.3e-4";
}

/// The normal distribution and its density.
double Normal(double t) { return 0.5 * std::erfc(-t / std::sqrt(2.0)); }
double Density(double t) { return std::exp(-0.5 * t * t) / std::sqrt(2.0 * std::numbers::pi); }

TEST(ReliefForms, SharesAreNearlyNormal) {
  for (double t = -6.0; t <= 6.0; t += 0.05) {
    EXPECT_NEAR(shared::ShareAbove(3.0 * t, 3.0), Normal(t), 0.0095);
    EXPECT_NEAR(shared::MeanOfHigher(3.0 * t, 3.0), 3.0 * (t * Normal(t) + Density(t)), 0.06);
  }
  EXPECT_EQ(shared::MeanOfHigher(1e6, 1e-3), 1e6);
  EXPECT_EQ(shared::MeanOfHigher(-1e6, 1e-3), 0.0);
}

TEST(ReliefForms, ModelsHaveWavesOfFourSpacings) {
  EXPECT_EQ(shared::MissingShare(360.0, 90.0), 0.0);
  EXPECT_EQ(shared::MissingShare(180.0, 90.0), 1.0);
  EXPECT_EQ(shared::MissingShare(270.0, 90.0), 0.5);
}

}  // namespace
}  // namespace alpenglow::renderer
