// SPDX-License-Identifier: MIT
#include "renderer/terrain/procedural_mountains.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "atmosphere/math/constants.h"
#include "renderer/terrain/land.h"
#include "renderer/terrain/mesh.h"
#include "renderer/terrain/terrain.h"

namespace alpenglow::renderer {
namespace {

constexpr double kSpacing_m = 70.0;

GeodeticPosition Degrees(double latitude, double longitude) {
  return {latitude * kRadiansPerDegree, longitude * kRadiansPerDegree, 0.0};
}

const ElevationGrid& TheRange() {
  static const ElevationGrid range = ProceduralMountains(Degrees(46.5, 8.0));
  return range;
}

double Quantile(std::vector<float> values, double fraction) {
  const auto nth = values.begin() +
                   static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return static_cast<double>(*nth);
}

struct Gradient {
  double east;
  double north;
};

Gradient GradientAt(const ElevationGrid& range, int row, int column) {
  const auto height = [&](int r, int c) { return static_cast<double>(range.at(r, c)); };
  return {(height(row, column + 1) - height(row, column - 1)) / (2.0 * kSpacing_m),
          (height(row - 1, column) - height(row + 1, column)) / (2.0 * kSpacing_m)};
}

TEST(ProceduralMountains, IsTheSameToTheLastBitEveryTimeAndEverywhere) {
  EXPECT_EQ(FingerprintOf(MadeRangeHeights(0)), kProceduralMountainsFingerprint)
      << "the range has changed: pictures made with it will not match older ones";
  EXPECT_EQ(FingerprintOf(TheRange().height_m), kProceduralMountainsFingerprint);
  EXPECT_EQ(TheRange().height_m, ProceduralMountains(Degrees(-33.9, 151.2)).height_m);
}

TEST(ProceduralMountains, AnotherSeedHasOtherMountainsUnderTheSameView) {
  const GeodeticPosition centre = Degrees(46.5, 8.0);
  const ElevationGrid other = ProceduralMountains(centre, 12345);
  EXPECT_EQ(other.height_m, ProceduralMountains(centre, 12345).height_m);
  int far_apart = 0;
  for (std::size_t i = 0; i < other.height_m.size(); ++i)
    far_apart += std::abs(other.height_m[i] - TheRange().height_m[i]) > 300.0F ? 1 : 0;
  EXPECT_GT(far_apart, static_cast<int>(other.height_m.size()) / 10) << "half of it are mountains";
  EXPECT_GE(Quantile(other.height_m, 0.0), 0.0);
  EXPECT_GT(Quantile(other.height_m, 1.0), 3300.0);
  const BuiltInView view = ProceduralMountainsViewAboveGround(centre);
  for (const ElevationGrid& range : {TheRange(), other}) {
    // Bilinear heights are up to a metre off those of the triangles that the constant is of.
    EXPECT_NEAR(range.HeightAt(view.eye.latitude_rad, view.eye.longitude_rad).value(),
                kRangeViewGround_m, 2.0);
  }
}

TEST(ProceduralMountains, LooksLikeAlps) {
  const ElevationGrid& range = TheRange();
  ASSERT_EQ(range.columns, 1024);
  ASSERT_EQ(range.rows, 1024);
  EXPECT_NEAR(Quantile(range.height_m, 1.0), 4150.0, 150.0) << "the highest peak";
  EXPECT_GE(Quantile(range.height_m, 0.0), 0.0);
  EXPECT_NEAR(Quantile(range.height_m, 0.5), 900.0, 150.0)
      << "as much valley and foreland as slope";
  EXPECT_NEAR(Quantile(range.height_m, 0.99), 2800.0, 300.0) << "summits";
  std::vector<float> slope_deg;
  int diagonal = 0;
  for (int row = 150; row < 874; ++row) {
    for (int column = 150; column < 874; ++column) {
      const Gradient gradient = GradientAt(range, row, column);
      slope_deg.push_back(static_cast<float>(std::atan(std::hypot(gradient.east, gradient.north)) /
                                             kRadiansPerDegree));
      const double aspect = std::atan2(gradient.north, gradient.east) / (45.0 * kRadiansPerDegree);
      diagonal += std::abs(aspect - std::round(aspect)) < 0.125 ? 1 : 0;
    }
  }
  // SRTM of Mount Everest's surroundings (27-28 N, 86-87 E) and of Mount Fuji above 1000 m, at 90
  // m, have slopes of 16-18, 25-26, 32-33, 37-39, 43-49 degrees at these fractions.
  EXPECT_NEAR(Quantile(slope_deg, 0.25), 17.0, 4.0);
  EXPECT_NEAR(Quantile(slope_deg, 0.50), 25.5, 4.0);
  EXPECT_NEAR(Quantile(slope_deg, 0.75), 32.5, 4.0);
  EXPECT_NEAR(Quantile(slope_deg, 0.90), 38.0, 4.0);
  EXPECT_NEAR(Quantile(slope_deg, 0.99), 46.0, 6.0);
  EXPECT_LT(Quantile(slope_deg, 1.0), 75.0);
  EXPECT_NEAR(diagonal / static_cast<double>(slope_deg.size()), 0.25, 0.02)
      << "slopes do not favour the eight directions of the grid";
}

TEST(ProceduralMountains, HasNoTerraces) {
  // A terrace is a height that too many samples share.
  std::vector<int> count(4500, 0);
  const ElevationGrid& range = TheRange();
  for (int row = 200; row < 900; ++row) {
    for (int column = 120; column < 900; ++column) {
      ++count[static_cast<std::size_t>(std::max(0.0F, range.at(row, column)))];
    }
  }
  for (std::size_t height = 700; height < 2500; ++height) {
    int around = 0;
    for (std::size_t other = height - 20; other <= height + 20; ++other) around += count[other];
    EXPECT_LT(count[height], 1.6 * around / 41.0 + 20.0) << height << " m";
  }
}

TEST(ProceduralMountains, EveryPlaceDrains) {
  const ElevationGrid& range = TheRange();
  int pits = 0;
  for (int row = 1; row < range.rows - 1; ++row) {
    for (int column = 1; column < range.columns - 1; ++column) {
      bool lowest = true;
      for (int r = -1; r <= 1; ++r) {
        for (int c = -1; c <= 1; ++c) {
          if ((r != 0 || c != 0) && range.at(row + r, column + c) <= range.at(row, column)) {
            lowest = false;
          }
        }
      }
      pits += lowest ? 1 : 0;
    }
  }
  EXPECT_EQ(pits, 0);
}

TEST(ProceduralMountains, JoinsTheSeaAtItsRim) {
  const ElevationGrid& range = TheRange();
  for (int i = 0; i < 1024; ++i) {
    for (const float height :
         {range.at(0, i), range.at(1023, i), range.at(i, 0), range.at(i, 1023)}) {
      EXPECT_LT(height, 2.0F);
    }
  }
}

// What an eye at the built-in view sees.
struct Sight {
  double summit_in_view_deg;  // off the middle of the picture; 999 if hidden
  double farthest_m;
  int ridges;  // steps in depth of more than 2 km along the skyline's columns, most in one column
};

Sight Look(const GeodeticPosition& centre) {
  const ElevationGrid range = ProceduralMountains(centre);
  const BuiltInView view = ProceduralMountainsView(centre, range);
  const LocalFrame frame(kWgs84, view.eye);
  const Terrain terrain(MeshFromElevation(range, frame));
  const auto direction = [](double azimuth_deg, double elevation_deg) {
    const double a = azimuth_deg * kRadiansPerDegree;
    const double e = elevation_deg * kRadiansPerDegree;
    return glm::dvec3(std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e));
  };
  std::size_t highest = 0;
  for (std::size_t i = 0; i < range.height_m.size(); ++i) {
    if (range.height_m[i] > range.height_m[highest] || std::isnan(range.height_m[highest])) {
      highest = i;
    }
  }
  const auto columns = static_cast<std::size_t>(range.columns);
  const glm::dvec3 summit =
      frame
          .EnuFromGeodetic({range.LatitudeOfRow(static_cast<int>(highest / columns)),
                            range.LongitudeOfColumn(static_cast<int>(highest % columns)),
                            static_cast<double>(range.height_m[highest])})
          .xyz;
  Sight sight{999.0, 0.0, 0};
  const auto hit = terrain.Intersect({0.0, 0.0, 0.0}, summit - glm::dvec3(0.0, 0.0, 5.0));
  if (hit && hit->distance_m > glm::length(summit) - 300.0) {
    sight.summit_in_view_deg = std::remainder(
        std::atan2(summit.x, summit.y) / kRadiansPerDegree - view.heading_deg, 360.0);
  }
  for (double azimuth = -24.0; azimuth <= 24.0; azimuth += 0.5) {
    double last = 0.0;
    int ridges = 0;
    for (double elevation = -15.0; elevation <= 12.0; elevation += 0.05) {
      const auto seen =
          terrain.Intersect({0.0, 0.0, 0.0}, direction(view.heading_deg + azimuth, elevation));
      if (!seen) continue;
      if (seen->distance_m > last + 2000.0) ++ridges;
      last = seen->distance_m;
      sight.farthest_m = std::max(sight.farthest_m, last);
    }
    sight.ridges = std::max(sight.ridges, ridges);
  }
  return sight;
}

TEST(ProceduralMountainsView, ShowsTheHighestPeakAndChainBehindChain) {
  const Sight sight = Look(Degrees(46.5, 8.0));
  EXPECT_LT(std::abs(sight.summit_in_view_deg), 20.0);
  EXPECT_GT(sight.farthest_m, 40e3);
  EXPECT_GE(sight.ridges, 4);
  const BuiltInView view = ProceduralMountainsView(Degrees(46.5, 8.0), TheRange());
  EXPECT_NEAR(view.eye.height_m, 2000.0, 200.0);
  EXPECT_GT(view.heading_deg, 135.0) << "south-east to south: dawn comes from the left";
  EXPECT_LT(view.heading_deg, 180.0);
}

// Hard case 17.
TEST(ProceduralMountainsView, ShowsTheSameBesideAPole) {
  const Sight sight = Look(Degrees(89.9, 120.0));
  EXPECT_LT(std::abs(sight.summit_in_view_deg), 20.0);
  EXPECT_GT(sight.farthest_m, 40e3);
}

// Hard case 17.
TEST(ProceduralMountainsView, ShowsTheSameOverTheSouthPole) {
  const Sight sight = Look(Degrees(-90.0, 0.0));
  EXPECT_LT(std::abs(sight.summit_in_view_deg), 20.0);
  EXPECT_GT(sight.farthest_m, 40e3);
}

}  // namespace
}  // namespace alpenglow::renderer
