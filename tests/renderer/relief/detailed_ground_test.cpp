// SPDX-License-Identifier: MIT
#include "renderer/relief/detailed_ground.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "atmosphere/base/error.h"
#include "renderer/procedural_mountains/lattice_noise.h"
#include "renderer/surface/surface.h"
#include "tests/fixtures/sanitized.h"

namespace alpenglow::renderer {
namespace {

using tests::ScaledDown;

constexpr MountainCover kSummerCover{.tree_line_m = 1900.0, .snow_line_m = 2600.0};

/// Mountains from fractal noise, with slopes of about 0.6.
MetricGrid Mountains(int side, double spacing_m) {
  MetricGrid grid{side, side, spacing_m, spacing_m, {}};
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column)
      grid.height_m.push_back(
          static_cast<float>(1900.0 + 2400.0 * FractalNoise(column * spacing_m / 3000.0,
                                                            row * spacing_m / 3000.0, 4, 17U)));
  return grid;
}

const DetailedGround& Ground() {
  static const DetailedGround ground(Mountains(ScaledDown(40, 16), 90.0), SampleMeaning::kCellMeans,
                                     kSummerCover);
  return ground;
}

double Side_m() { return 90.0 * (Ground().model().columns() - 1); }

/// Returns the place of a number in the middle of the ground, spread evenly.
std::array<double, 2> PlaceOf(int i) {
  const double x = 0.7548776662466927 * i, y = 0.5698402909980532 * i;
  return {Side_m() * (0.1 + 0.8 * (x - std::floor(x))),
          -Side_m() * (0.1 + 0.8 * (y - std::floor(y)))};
}

TEST(DetailedGround, MeanOverASampleIsTheModels) {
  double squares = 0.0, total = 0.0, relief = 0.0;
  int cells = 0;
  constexpr int kPerAxis = 9;
  const int side = Ground().model().columns();
  for (int row = 2; row < side - 2; row += 3) {
    for (int column = 2; column < side - 2; column += 3, ++cells) {
      double mean = 0.0;
      for (int k = 0; k < kPerAxis * kPerAxis; ++k) {
        const double x = column - 0.5 + (k % kPerAxis + 0.5) / kPerAxis;
        const double y = row - 0.5 + (k / kPerAxis + 0.5) / kPerAxis;
        const double height = Ground().HeightAt(90.0 * x, -90.0 * y, 2.0).height_m;
        mean += height / (kPerAxis * kPerAxis);
        relief += height * height / (kPerAxis * kPerAxis);
      }
      squares += mean * mean;
      total += mean;
    }
  }
  EXPECT_LT(std::sqrt(squares / cells), 1.0);
  EXPECT_LT(std::abs(total / cells), 0.3);
  EXPECT_GT(std::sqrt(relief / cells), 2.0) << "there is relief";
}

/// Returns mean shares and reflectance at 550 nm of places for a footprint.
std::array<double, 6> MeanCover(double footprint_m) {
  static const MountainSurface surface(std::vector<double>{550.0}, kSummerCover);
  const MountainSurface::Materials& of = surface.materials();
  const std::array<double, 5> albedo{
      static_cast<double>(of.rock[0]), static_cast<double>(of.rock[0]),
      static_cast<double>(of.meadow[0]), static_cast<double>(of.conifers[0]),
      static_cast<double>(of.snow[0])};
  std::array<double, 6> means{};
  const int places = ScaledDown(6000, 600);
  for (int i = 0; i < places; ++i) {
    const auto [x, y] = PlaceOf(i);
    const SurfaceShares<double> shares = Ground().HeightAt(x, y, footprint_m).shares;
    const std::array<double, 5> share{shares.bedrock, shares.scree, shares.meadow, shares.forest,
                                      shares.snow};
    for (std::size_t k = 0; k < 5; ++k) {
      means[k] += share[k] / places;
      means[5] += share[k] * albedo[k] / places;
    }
  }
  return means;
}

TEST(DetailedGround, MeanCoverHardlyDependsOnTheFootprint) {
  const std::array<double, 6> fine = MeanCover(0.1);
  // The means of few places also differ by chance.
  const double share_error = ScaledDown(0.02, 0.05), albedo_error = ScaledDown(0.04, 0.12);
  for (const double footprint_m : {1.0, 5.0, 20.0, 60.0, 100.0}) {
    const std::array<double, 6> wide = MeanCover(footprint_m);
    for (std::size_t k = 0; k < 5; ++k)
      EXPECT_NEAR(wide[k], fine[k], share_error) << footprint_m << " m, surface " << k;
    EXPECT_NEAR(wide[5] / fine[5], 1.0, albedo_error) << footprint_m << " m";
  }
}

TEST(DetailedGround, MeanHeightHardlyDependsOnTheFootprint) {
  const auto mean = [](double footprint_m) {
    double sum = 0.0;
    const int places = ScaledDown(6000, 600);
    for (int i = 0; i < places; ++i) {
      const auto [x, y] = PlaceOf(i);
      sum += Ground().HeightAt(x, y, footprint_m).height_m / places;
    }
    return sum;
  };
  const double fine = mean(0.1);
  for (const double footprint_m : {5.0, 30.0, 100.0})
    EXPECT_NEAR(mean(footprint_m), fine, ScaledDown(0.4, 1.0)) << footprint_m << " m";
}

TEST(DetailedGround, SlopesAreThoseOfTheHeights) {
  constexpr double kStep_m = 1e-5;
  const int places = ScaledDown(1000, 100);
  for (int i = 0; i < places; ++i) {
    const auto [x, y] = PlaceOf(i);
    const auto height = [&, x = x, y = y](double dx) {
      return Ground().model().At(x + dx, y).height_m + Ground().HeightAt(x + dx, y, 1.0).height_m;
    };
    // Third derivatives of the model are neglected.
    EXPECT_NEAR((height(kStep_m) - height(-kStep_m)) / (2.0 * kStep_m),
                Ground().At(x, y, 1.0).slope_east, 0.05);
  }
}

TEST(HeightSpline, GoesThroughThePoints) {
  const MetricGrid grid = Mountains(12, 90.0);
  const HeightSpline spline(grid, SampleMeaning::kPoints);
  for (int row = 0; row < 12; ++row)
    for (int column = 0; column < 12; ++column)
      EXPECT_NEAR(spline.At(90.0 * column, -90.0 * row).height_m,
                  static_cast<double>(grid.height_m[static_cast<std::size_t>(12 * row + column)]),
                  2e-3)
          << "coefficients are floats";
}

TEST(HeightSpline, HasTheSamplesAsMeansOfTheirCells) {
  const MetricGrid grid = Mountains(12, 90.0);
  const HeightSpline spline(grid, SampleMeaning::kCellMeans);
  // The midpoint rule has an error of (90 m / 40)^2 / 24 by curvature, which is up to 0.03 / m.
  constexpr int kPerAxis = 40;
  for (int row = 1; row < 11; ++row) {
    for (int column = 1; column < 11; ++column) {
      double mean = 0.0;
      for (int k = 0; k < kPerAxis * kPerAxis; ++k)
        mean += spline
                    .At(90.0 * (column - 0.5 + (k % kPerAxis + 0.5) / kPerAxis),
                        -90.0 * (row - 0.5 + (k / kPerAxis + 0.5) / kPerAxis))
                    .height_m /
                (kPerAxis * kPerAxis);
      EXPECT_NEAR(mean,
                  static_cast<double>(grid.height_m[static_cast<std::size_t>(12 * row + column)]),
                  0.03);
    }
  }
}

TEST(HeightSpline, DerivativesAreThoseOfTheHeights) {
  const HeightSpline spline(Mountains(12, 90.0), SampleMeaning::kPoints);
  // Third derivatives are up to 5e-4 / m^2 and jump at the samples.
  constexpr double kStep_m = 0.01;
  for (int i = 0; i < 100; ++i) {
    const double x = 8.7 * i + 3.0, y = -9.1 * i - 2.0;
    const ModelAt<double> at = spline.At(x, y), east = spline.At(x + kStep_m, y),
                          west = spline.At(x - kStep_m, y), north = spline.At(x, y + kStep_m),
                          south = spline.At(x, y - kStep_m);
    EXPECT_NEAR((east.height_m - west.height_m) / (2.0 * kStep_m), at.slope_east, 1e-5);
    EXPECT_NEAR((north.height_m - south.height_m) / (2.0 * kStep_m), at.slope_north, 1e-5);
    EXPECT_NEAR((east.slope_east - west.slope_east) / (2.0 * kStep_m), at.bend_east_per_m, 1e-5);
    EXPECT_NEAR((north.slope_east - south.slope_east) / (2.0 * kStep_m), at.bend_across_per_m,
                1e-5);
    EXPECT_NEAR((north.slope_north - south.slope_north) / (2.0 * kStep_m), at.bend_north_per_m,
                1e-5);
  }
}

TEST(HeightSpline, OneRowAndOneSampleAreFlatAcross) {
  const HeightSpline row({3, 1, 90.0, 90.0, {10.0F, 20.0F, 40.0F}}, SampleMeaning::kPoints);
  EXPECT_NEAR(row.At(90.0, 30.0).height_m, 20.0, 1e-5);
  EXPECT_NEAR(row.At(90.0, 30.0).slope_north, 0.0, 1e-9);
  const HeightSpline sample({1, 1, 90.0, 90.0, {7.0F}}, SampleMeaning::kCellMeans);
  EXPECT_NEAR(sample.At(1000.0, -1000.0).height_m, 7.0, 1e-6);
}

TEST(HeightSpline, RefusesVoidsAndGridsWithoutSpacing) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(HeightSpline({2, 1, 90.0, 90.0, {1.0F, none}}, SampleMeaning::kPoints), InputError);
  EXPECT_THROW(HeightSpline({2, 1, 90.0, 0.0, {1.0F, 1.0F}}, SampleMeaning::kPoints), InputError);
  EXPECT_THROW(HeightSpline({2, 2, 90.0, 90.0, {1.0F}}, SampleMeaning::kPoints), InputError);
}

}  // namespace
}  // namespace alpenglow::renderer
