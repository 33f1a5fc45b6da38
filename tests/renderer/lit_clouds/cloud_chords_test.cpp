// SPDX-License-Identifier: MIT
#include "renderer/lit_clouds/cloud_chords.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "renderer/surface/scene_geometry.h"

namespace alpenglow::renderer {
namespace {

constexpr double kEarth_m = 6371000.0;
constexpr double kNoEnd = std::numeric_limits<double>::infinity();

TEST(CloudChords, FlatFrameKeepsAltitudesAndArcs) {
  // A point at an arc of 200 km north and at an altitude of 3 km; rounding of 6e6 m.
  const double angle = 200e3 / kEarth_m, from_centre_m = kEarth_m + 3000.0;
  const glm::dvec3 point(0.0, from_centre_m * std::sin(angle),
                         from_centre_m * std::cos(angle) - kEarth_m);
  const glm::dvec3 flat = InFlatFrame(point, kEarth_m);
  EXPECT_NEAR(flat.x, 0.0, 1e-6);
  EXPECT_NEAR(flat.y, 200e3, 1e-6);
  EXPECT_NEAR(flat.z, 3000.0, 1e-6);
}

TEST(CloudChords, FlatFrameIsSeamlessFromTheOriginToTheOtherSide) {
  // The series gives way to the arctangent at an arc of 450 km.
  for (const double arc_m : {0.0, 1.0, 1e3, 449e3, 452e3, 5e6, 15e6}) {
    const double angle = arc_m / kEarth_m, from_centre_m = kEarth_m + 500.0;
    const glm::dvec3 flat = InFlatFrame(
        {from_centre_m * std::sin(angle), 0.0, from_centre_m * std::cos(angle) - kEarth_m},
        kEarth_m);
    EXPECT_NEAR(flat.x, arc_m, 1e-5);
  }
}

// A ray straight down leaves the planet on the other side, where no direction leads away from the
// origin.
TEST(CloudChords, PointsBelowTheOriginHaveAPlace) {
  for (const double height_m : {2000.0, -5.0, -kEarth_m, -2.0 * kEarth_m - 3000.0}) {
    const glm::dvec3 flat = InFlatFrame({0.0, 0.0, height_m}, kEarth_m);
    EXPECT_EQ(flat.x, 0.0) << height_m;
    EXPECT_EQ(flat.y, 0.0) << height_m;
    EXPECT_NEAR(flat.z, std::abs(height_m + kEarth_m) - kEarth_m, 1e-6);
  }
}

TEST(CloudChords, VerticalRayCrossesARangeOnce) {
  const auto chords =
      ChordsWithin({1000.0, 3000.0}, {10.0, 20.0, 5.0}, {0.0, 0.0, 1.0}, kNoEnd, kEarth_m);
  ASSERT_EQ(chords.size(), 1u);
  EXPECT_NEAR(chords[0].begin_m, 995.0, 1e-3);
  EXPECT_NEAR(chords[0].end_m, 2995.0, 1e-3);
  EXPECT_NEAR(chords[0].origin.x, 10.0, 1e-2);
}

// From the ground, a level ray is in a layer of 8 to 9 km from 319 to 339 km on.
TEST(CloudChords, LevelRayReachesAHighLayerBehindTheHorizon) {
  const auto chords =
      ChordsWithin({8000.0, 9000.0}, glm::dvec3(0.0), {1.0, 0.0, 0.0}, kNoEnd, kEarth_m);
  ASSERT_EQ(chords.size(), 2u);
  EXPECT_NEAR(chords.front().begin_m, std::sqrt(2.0 * kEarth_m * 8000.0), 120.0);
  EXPECT_NEAR(chords.back().end_m, std::sqrt(2.0 * kEarth_m * 9000.0), 120.0);
  EXPECT_DOUBLE_EQ(chords.front().end_m, chords.back().begin_m);
}

// From above, a ray that misses the ground crosses the layer on the way down and on the way up.
TEST(CloudChords, RayPastTheLimbCrossesALayerTwice) {
  const glm::dvec3 eye(0.0, 0.0, 12000.0);
  const double dip = std::acos((kEarth_m + 500.0) / (kEarth_m + 12000.0));
  const auto chords =
      ChordsWithin({1000.0, 3000.0}, eye, {std::cos(dip), 0.0, -std::sin(dip)}, kNoEnd, kEarth_m);
  double gap_m = 0.0;
  for (std::size_t i = 1; i < chords.size(); ++i)
    gap_m = std::max(gap_m, chords[i].begin_m - chords[i - 1].end_m);
  EXPECT_NEAR(gap_m, 2.0 * std::sqrt(2.0 * kEarth_m * 500.0), 100.0);
}

// The header bounds the distance of chords from the curve by 5 m.
TEST(CloudChords, ChordsStayWithinFiveMetresOfTheRay) {
  const glm::dvec3 eye(0.0, 0.0, 1500.0);
  const glm::dvec3 direction = glm::normalize(glm::dvec3(0.8, 0.6, 0.001));
  double worst_m = 0.0;
  for (const CloudChord& chord : ChordsWithin({0.0, 4000.0}, eye, direction, 150e3, kEarth_m)) {
    EXPECT_LE(chord.end_m - chord.begin_m, kLongestChord_m * (1.0 + 1e-9));
    const glm::dvec3 on_chord = chord.origin + 0.5 * chord.length_m * chord.direction;
    const double on_ray_m = chord.OnRay(0.5 * chord.length_m);
    worst_m = std::max(worst_m,
                       glm::length(InFlatFrame(eye + on_ray_m * direction, kEarth_m) - on_chord));
  }
  EXPECT_GT(worst_m, 0.5);
  EXPECT_LT(worst_m, 5.1);
}

TEST(CloudChords, RayEndsAtItsLength) {
  const auto chords =
      ChordsWithin({0.0, 3000.0}, {0.0, 0.0, 100.0}, {1.0, 0.0, 0.0}, 40e3, kEarth_m);
  ASSERT_EQ(chords.size(), 3u);
  EXPECT_NEAR(chords.back().end_m, 40e3, 1e-6);
}

}  // namespace
}  // namespace alpenglow::renderer
