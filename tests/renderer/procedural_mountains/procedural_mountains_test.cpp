// SPDX-License-Identifier: MIT
// The built-in range: its noise, erosion, shape and view, and the file that keeps its heights.
#include "renderer/procedural_mountains/procedural_mountains.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "atmosphere/math/constants.h"
#include "renderer/elevation/mesh.h"
#include "renderer/procedural_mountains/erosion.h"
#include "renderer/procedural_mountains/land.h"
#include "renderer/procedural_mountains/lattice_noise.h"
#include "renderer/terrain/terrain.h"
#include "tests/fixtures/environment_variable.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::renderer {
namespace {

namespace fs = std::filesystem;

constexpr double kSpacing_m = 70.0;

const ElevationGrid& TheRange() {
  static const ElevationGrid range = ProceduralMountains(Place{46.5, 8.0});
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

TEST(ProceduralMountains, IsTheSameToTheLastBitEverywhere) {
  EXPECT_EQ(FingerprintOf(TheRange().height_m), kProceduralMountainsFingerprint);
  // Sanitizers see the other seed being made.
  if (!tests::kSanitized) {
    EXPECT_EQ(FingerprintOf(MadeRangeHeights(0)), kProceduralMountainsFingerprint)
        << "the range has changed: pictures made with it will not match older ones";
  }
  EXPECT_EQ(TheRange().height_m, ProceduralMountains(Place{-33.9, 151.2}).height_m);
}

TEST(ProceduralMountains, AnotherSeedHasOtherMountainsAndTheSameView) {
  const Place centre = Place{46.5, 8.0};
  const ElevationGrid other = ProceduralMountains(centre, 12345);
  int far_apart = 0;
  for (std::size_t i = 0; i < other.height_m.size(); ++i)
    far_apart += std::abs(other.height_m[i] - TheRange().height_m[i]) > 300.0F ? 1 : 0;
  EXPECT_GT(far_apart, static_cast<int>(other.height_m.size()) / 10) << "half of it are mountains";
  EXPECT_GE(Quantile(other.height_m, 0.0), 0.0);
  EXPECT_GT(Quantile(other.height_m, 1.0), 3300.0);
  const CameraPose view = ProceduralMountainsViewAboveGround(centre);
  for (const ElevationGrid& range : {TheRange(), other}) {
    // Bilinear heights differ by up to a metre from those of the triangles, which define the
    // constant.
    EXPECT_NEAR(range.HeightAt(view.place.latitude_rad(), view.place.longitude_rad()).value(),
                kRangeViewGround_m, 2.0);
  }
}

TEST(ProceduralMountains, HasHeightsAndSlopesOfAlps) {
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
  // A height that too many samples share is a terrace.
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
      int not_higher = 0;  // of the sample and its neighbours
      for (int r = -1; r <= 1; ++r) {
        for (int c = -1; c <= 1; ++c)
          not_higher += range.at(row + r, column + c) <= range.at(row, column) ? 1 : 0;
      }
      pits += not_higher == 1 ? 1 : 0;
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

// A summary of what an eye at the built-in view sees.
struct Sight {
  double summit_in_view_deg;  // off the middle of the picture; 999 if hidden
  double farthest_m;
  int ridges;  // steps in depth of more than 2 km along the skyline's columns, most in one column
};

Sight Look(const Place& centre) {
  const ElevationGrid range = ProceduralMountains(centre);
  const CameraPose view = ProceduralMountainsView(centre, range);
  const LocalFrame frame(kWgs84, view.place);
  const Terrain terrain(MeshFromElevation(range, frame));
  const auto direction = [](double azimuth_deg, double elevation_deg) {
    const double a = azimuth_deg * kRadiansPerDegree;
    const double e = elevation_deg * kRadiansPerDegree;
    return glm::dvec3(std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e));
  };
  std::size_t highest = 0;
  for (std::size_t i = 0; i < range.height_m.size(); ++i) {
    if (range.height_m[i] > range.height_m[highest] || std::isnan(range.height_m[highest]))
      highest = i;
  }
  const auto columns = static_cast<std::size_t>(range.columns);
  const glm::dvec3 summit = frame
                                .EnuFromGeodetic(PlaceFromRadians(
                                    range.LatitudeOfRow(static_cast<int>(highest / columns)),
                                    range.LongitudeOfColumn(static_cast<int>(highest % columns)),
                                    static_cast<double>(range.height_m[highest])))
                                .xyz;
  Sight sight{999.0, 0.0, 0};
  const auto hit = terrain.Intersect({0.0, 0.0, 0.0}, summit - glm::dvec3(0.0, 0.0, 5.0));
  if (hit && hit->distance_m > glm::length(summit) - 300.0) {
    sight.summit_in_view_deg = std::remainder(
        std::atan2(summit.x, summit.y) / kRadiansPerDegree - view.heading_rad / kRadiansPerDegree,
        360.0);
  }
  for (double azimuth = -24.0; azimuth <= 24.0; azimuth += 2.0) {
    double last = 0.0;
    int ridges = 0;
    for (double elevation = -15.0; elevation <= 12.0; elevation += 0.05) {
      const auto seen = terrain.Intersect(
          {0.0, 0.0, 0.0}, direction(view.heading_rad / kRadiansPerDegree + azimuth, elevation));
      if (!seen) continue;
      if (seen->distance_m > last + 2000.0) ++ridges;
      last = seen->distance_m;
      sight.farthest_m = std::max(sight.farthest_m, last);
    }
    sight.ridges = std::max(sight.ridges, ridges);
  }
  return sight;
}

// Hard case 17.
TEST(ProceduralMountainsView, ShowsTheHighestPeakEvenNearThePoles) {
  const std::vector<Place> poles{Place{89.9, 120.0}, Place{-90.0, 0.0}};
  const std::vector<Place> all{Place{46.5, 8.0}, poles[0], poles[1]};
  for (const Place& centre : tests::ScaledDown(all, {poles[0]})) {
    const Sight sight = Look(centre);
    EXPECT_LT(std::abs(sight.summit_in_view_deg), 20.0);
    EXPECT_GT(sight.farthest_m, 40e3);
    EXPECT_GE(sight.ridges, 4) << "chain behind chain";
  }
  const CameraPose view = ProceduralMountainsView({46.5, 8.0}, TheRange());
  EXPECT_NEAR(view.place.height_m, 2000.0, 200.0);
  EXPECT_GT(view.heading_rad / kRadiansPerDegree, 135.0)
      << "south-east to south: dawn comes from the left";
  EXPECT_LT(view.heading_rad / kRadiansPerDegree, 180.0);
}

// Returns land of noise whose heights are rounded: it has many basins and samples of equal height.
Land Rough(int size, double height_m, double step_m, std::uint32_t seed) {
  Land land{size, 70.0, {}};
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column < size; ++column) {
      const double height = height_m * LatticeUniform(column, row, seed) +
                            0.1 * height_m * FractalNoise(0.1 * column, 0.1 * row, 3, seed);
      land.height_m.push_back(static_cast<float>(step_m * std::round(height / step_m)));
    }
  }
  return land;
}

std::vector<std::size_t> NeighboursOf(const Land& land, std::size_t sample) {
  const int row = static_cast<int>(sample) / land.size;
  const int column = static_cast<int>(sample) % land.size;
  std::vector<std::size_t> neighbours;
  for (int r = std::max(row - 1, 0); r <= std::min(row + 1, land.size - 1); ++r) {
    for (int c = std::max(column - 1, 0); c <= std::min(column + 1, land.size - 1); ++c) {
      if (r != row || c != column) neighbours.push_back(land.index(r, c));
    }
  }
  return neighbours;
}

bool IsRim(const Land& land, int row, int column) {
  return row == 0 || column == 0 || row == land.size - 1 || column == land.size - 1;
}

// The priority flood of Barnes, Lehman and Mulla with one ordered set as its queue. Keys have the
// order that the header defines: heights in the steps of a float at 20 km, then samples.
struct SlowFlood {
  std::vector<std::uint32_t> order;

  explicit SlowFlood(Land& land) {
    std::set<std::pair<float, std::size_t>> queue;
    std::vector<bool> reached(land.height_m.size(), false);
    const auto reach = [&](std::size_t sample) {
      reached[sample] = true;
      queue.insert({land.height_m[sample] + 20000.0F, sample});
    };
    for (std::size_t i = 0; i < land.height_m.size(); ++i) {
      const auto size = static_cast<std::size_t>(land.size);
      if (IsRim(land, static_cast<int>(i / size), static_cast<int>(i % size))) reach(i);
    }
    while (!queue.empty()) {
      const std::size_t sample = queue.begin()->second;
      queue.erase(queue.begin());
      order.push_back(static_cast<std::uint32_t>(sample));
      for (const std::size_t next : NeighboursOf(land, sample)) {
        if (reached[next]) continue;
        land.height_m[next] = std::max(land.height_m[next], land.height_m[sample] + 1e-3F);
        reach(next);
      }
    }
  }
};

TEST(Erosion, TheFloodEqualsOneWithASingleQueue) {
  for (const int size : {2, 3, 8, 33, 64}) {
    for (const double step_m : {1e-3, 0.5, 20.0}) {
      Land slow = Rough(size, 90.0, step_m, 3);
      Land fast = slow;
      const SlowFlood flood(slow);
      const Drainage drainage = DrainAndFill(fast, ScatteredSamples(size, 4));
      EXPECT_EQ(drainage.order, flood.order) << size << " samples a side, steps of " << step_m;
      EXPECT_EQ(fast.height_m, slow.height_m) << size << " samples a side, steps of " << step_m;
    }
  }
}

TEST(Erosion, WaterFlowsDownTheSteepestWay) {
  constexpr int kSize = 40;
  Land land = Rough(kSize, 90.0, 0.5, 5);
  const ScatteredSamples scattered(kSize, 6);
  const Drainage drainage = DrainAndFill(land, scattered);
  std::vector<std::size_t> rank(drainage.order.size());
  for (std::size_t i = 0; i < rank.size(); ++i) rank[drainage.order[i]] = i;
  for (std::size_t sample = 0; sample < rank.size(); ++sample) {
    const int row = static_cast<int>(sample) / kSize, column = static_cast<int>(sample) % kSize;
    if (IsRim(land, row, column)) {
      EXPECT_EQ(drainage.receiver[sample], sample);
      continue;
    }
    float steepest = -1.0F;
    std::size_t receiver = sample;
    for (const std::size_t next : NeighboursOf(land, sample)) {
      const int rows = static_cast<int>(next) / kSize - row;
      const int columns = static_cast<int>(next) % kSize - column;
      const float distance = *scattered.Distances(sample, rows, columns);
      const float slope = (land.height_m[sample] - land.height_m[next]) / distance;
      if (rank[next] > rank[sample] || slope <= steepest) continue;
      steepest = slope;
      receiver = next;
    }
    EXPECT_EQ(drainage.receiver[sample], receiver) << "row " << row << ", column " << column;
  }
}

TEST(Erosion, DistancesOfScatteredSamplesAreSymmetric) {
  constexpr int kSize = 12;
  const ScatteredSamples scattered(kSize, 7);
  const int middle = 5 * kSize + 5;
  for (int sample = middle; sample < middle + 3; ++sample) {
    for (int rows = -1; rows <= 1; ++rows) {
      for (int columns = -1; columns <= 1; ++columns) {
        if (rows == 0 && columns == 0) continue;
        const auto next = static_cast<std::size_t>(sample + rows * kSize + columns);
        const float there = *scattered.Distances(static_cast<std::size_t>(sample), rows, columns);
        EXPECT_EQ(there, *scattered.Distances(next, -rows, -columns));
        // Each of two samples is displaced by up to a third of the spacing along both axes.
        EXPECT_NEAR(there, std::hypot(rows, columns), 2.0 / 3.0 * std::sqrt(2.0));
      }
    }
  }
}

class HeightCacheTest : public TemporaryFolder {
 protected:
  // Requests the heights, and returns whether they had to be made.
  [[nodiscard]] bool HadToMake() {
    bool made = false;
    const std::vector<float> height_m = HeightCache(wanted_, [&] {
      made = true;
      return height_m_;
    });
    EXPECT_EQ(height_m, height_m_);
    return made;
  }
  [[nodiscard]] fs::path OnlyFile() const { return fs::directory_iterator(folder_)->path(); }

  std::vector<float> height_m_{1.0F, -2.5F, 3e3F, 0.0F};
  WantedHeights wanted_{"range", FingerprintOf(height_m_), height_m_.size()};
};

TEST_F(HeightCacheTest, HeightsAreMadeOnceAndThenRead) {
  const EnvironmentVariable cache("ALPENGLOW_CACHE", folder_.c_str());
  EXPECT_TRUE(HadToMake());
  EXPECT_FALSE(HadToMake());
  EXPECT_EQ(fs::file_size(OnlyFile()), 4 * sizeof(float));
}

TEST_F(HeightCacheTest, IsOffIfTheVariableIsEmpty) {
  const EnvironmentVariable cache("ALPENGLOW_CACHE", "");
  EXPECT_TRUE(HadToMake());
  EXPECT_TRUE(HadToMake());
  EXPECT_EQ(CacheFolder(), std::nullopt);
}

TEST_F(HeightCacheTest, DamagedFilesAreMadeAgain) {
  const EnvironmentVariable cache("ALPENGLOW_CACHE", folder_.c_str());
  EXPECT_TRUE(HadToMake());
  for (const char* damage : {"sixteen letters.", "short", ""}) {
    WriteText(OnlyFile(), damage);
    EXPECT_TRUE(HadToMake()) << damage;
    EXPECT_FALSE(HadToMake()) << "and are whole again";
  }
}

TEST_F(HeightCacheTest, FilesOfOldVersionsAreRemoved) {
  const EnvironmentVariable cache("ALPENGLOW_CACHE", folder_.c_str());
  EXPECT_TRUE(HadToMake());
  height_m_[1] = 7.0F;
  EXPECT_EQ(HeightCache(wanted_, [&] { return std::vector<float>{1.0F}; }).size(), 4U);
  wanted_.fingerprint = FingerprintOf(height_m_);
  EXPECT_TRUE(HadToMake());
  EXPECT_EQ(FileCount(), 1U);
}

TEST_F(HeightCacheTest, UnexpectedHeightsAreNeverWritten) {
  const EnvironmentVariable cache("ALPENGLOW_CACHE", folder_.c_str());
  wanted_.fingerprint += 1;  // as on a machine whose arithmetic is another
  EXPECT_TRUE(HadToMake());
  EXPECT_EQ(FileCount(), 0U);
}

TEST_F(HeightCacheTest, NeedsNoWritableFolder) {
  const fs::path file = folder_ / "file";
  WriteText(file, "no folder");
  const EnvironmentVariable cache("ALPENGLOW_CACHE", (file / "cache").c_str());
  EXPECT_TRUE(HadToMake());
}

TEST_F(HeightCacheTest, IsInTheCacheFolderOfTheDesktop) {
  const EnvironmentVariable none("ALPENGLOW_CACHE", nullptr);
  const EnvironmentVariable home("HOME", folder_.c_str());
  {
    const EnvironmentVariable caches("XDG_CACHE_HOME", "/caches");
    EXPECT_EQ(CacheFolder(), fs::path("/caches/alpenglow"));
  }
  const EnvironmentVariable caches("XDG_CACHE_HOME", nullptr);
  EXPECT_EQ(CacheFolder(), folder_ / ".cache" / "alpenglow");
}

TEST_F(HeightCacheTest, MakesNoHomeForUsersWithoutOne) {
  const EnvironmentVariable none("ALPENGLOW_CACHE", nullptr);
  const EnvironmentVariable caches("XDG_CACHE_HOME", nullptr);
  const fs::path nobody = folder_ / "nobody";
  for (const char* const home :
       {nobody.c_str(), "relative", "", static_cast<const char*>(nullptr)}) {
    const EnvironmentVariable of_user("HOME", home);
    EXPECT_TRUE(HadToMake());
    EXPECT_FALSE(fs::exists(nobody));
    EXPECT_EQ(CacheFolder(), std::nullopt);
  }
}

TEST(LatticeNoise, SlopesAreTheDifferencesOfNearbyValues) {
  constexpr double kStep = 1e-5;
  for (int i = 0; i < 500; ++i) {
    const double x = -7.0 + 0.0531 * i;
    const double y = 3.0 - 0.0377 * i;
    const NoiseSlope noise = GradientNoiseSlope(x, y, 5U);
    EXPECT_EQ(noise.value, GradientNoise(x, y, 5U)) << "one formula";
    const double by_x = GradientNoise(x + kStep, y, 5U) - GradientNoise(x - kStep, y, 5U);
    const double by_y = GradientNoise(x, y + kStep, 5U) - GradientNoise(x, y - kStep, 5U);
    EXPECT_NEAR(noise.by_x, by_x / (2.0 * kStep), 1e-7)
        << "step^2 times the third derivative, which jumps across lattice lines";
    EXPECT_NEAR(noise.by_y, by_y / (2.0 * kStep), 1e-7);
  }
}

TEST(LatticeNoise, WithFewerOperationsTheNoiseIsTheSame) {
  for (int i = 0; i < 200; ++i) {
    const auto bits = static_cast<std::uint32_t>(i);
    const std::uint32_t sw = shared::MixedBits(bits), se = shared::MixedBits(sw);
    const std::uint32_t nw = shared::MixedBits(se), ne = shared::MixedBits(nw);
    const double dx = 0.0049 * i, dy = 1.0 - 0.0037 * i;
    EXPECT_NEAR(shared::NoiseOfHashes(sw, se, nw, ne, dx, dy),
                shared::NoiseInCell(sw, se, nw, ne, dx, dy), 1e-14)
        << "another order of the same sums";
    EXPECT_NEAR(shared::SlopeOfHashesEast(sw, se, nw, ne, dx, dy),
                shared::NoiseSlopeEast(sw, se, nw, ne, dx, dy), 1e-14);
    EXPECT_NEAR(shared::SlopeOfHashesNorth(sw, se, nw, ne, dx, dy),
                shared::NoiseSlopeNorth(sw, se, nw, ne, dx, dy), 1e-14);
  }
}

TEST(LatticeNoise, IsZeroAtTheLatticePointsAndStaysWithinOne) {
  for (int i = -5; i < 5; ++i) EXPECT_EQ(GradientNoise(i, 3 * i, 9U), 0.0);
  for (int i = 0; i < 2000; ++i) {
    const double noise = GradientNoise(0.137 * i - 90.0, 0.071 * i, 9U);
    EXPECT_LT(noise, 1.0);
    EXPECT_GT(noise, -1.0);
  }
}

}  // namespace
}  // namespace alpenglow::renderer
