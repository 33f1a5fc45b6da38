// SPDX-License-Identifier: MIT
// Instruments in pictures: where they stand, and that they lie over what they speak of.
#include "viewer/hud/instruments.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <glm/geometric.hpp>

#include "atmosphere/math/constants.h"
#include "tests/viewer/hud/hud_picture.h"
#include "viewer/hud/scales.h"

namespace alpenglow::viewer {
namespace {

constexpr int kPanelWidth = 1280, kPanelHeight = 720;

using Instruments = tests::HudPicture;

/// A value of the model and the part of the picture, in shares, that alone may tell of it.
struct Told {
  const char* name;
  std::function<void(HudModel&)> change;
  double left, top, right, bottom;
};

TEST_F(Instruments, EachTellsOfItsValueAndOfNoOther) {
  const std::vector<Told> cases{
      {"heading", [](HudModel& m) { m.flight.heading_rad += 0.1; }, 0.3, 0.0, 0.7, 0.1},
      {"sun", [](HudModel& m) { m.sky.sun_azimuth_rad = 0.9; }, 0.35, 0.0, 1.0, 0.12},
      {"air speed", [](HudModel& m) { *m.flight.air_speed_m_per_s += 5.0; }, 0.1, 0.3, 0.25, 0.7},
      {"height held", [](HudModel& m) { m.autopilot.height_m = 3300.0; }, 0.0, 0.0, 0.9, 0.7},
      {"climb", [](HudModel& m) { m.flight.climb_m_per_s = 4.0; }, 0.75, 0.6, 0.9, 0.8},
      {"path",
       [](HudModel& m) {
         m.flight.path = Course{0.85, -0.02};
       },
       0.45, 0.4, 0.65, 0.6},
      {"throttle", [](HudModel& m) { m.flight.throttle = 0.9; }, 0.0, 0.0, 0.2, 0.2},
      {"local time", [](HudModel& m) { m.time.local = "19:00:00"; }, 0.8, 0.0, 1.0, 0.2},
      {"latitude", [](HudModel& m) { m.latitude_rad = 0.3; }, 0.0, 0.8, 0.2, 1.0},
      {"exposure", [](HudModel& m) { m.exposure.ev100 = 12.0; }, 0.8, 0.75, 1.0, 1.0},
      {"message",
       [](HudModel& m) {
         m.messages = {{"the terrain is made up", false}};
       },
       0.3, 0.75, 0.7, 0.9},
      {"stall", [](HudModel& m) { m.flight.stall = true; }, 0.4, 0.3, 0.6, 0.45},
      {"progress",
       [](HudModel& m) {
         m.progress = HudProgress{"loading", 0.5};
       },
       0.3, 0.75, 0.7, 0.9}};
  Hud hud;
  const Image before = Drawn(hud, tests::Flying(), kPanelWidth, kPanelHeight);
  for (const Told& told : cases) {
    SCOPED_TRACE(told.name);
    HudModel model = tests::Flying();
    told.change(model);
    const Box box = Difference(before, Drawn(hud, model, kPanelWidth, kPanelHeight));
    EXPECT_FALSE(box.empty());
    EXPECT_GE(box.left, told.left * kPanelWidth);
    EXPECT_GE(box.top, told.top * kPanelHeight);
    EXPECT_LE(box.right, told.right * kPanelWidth);
    EXPECT_LE(box.bottom, told.bottom * kPanelHeight);
  }
}

// Written apart from cameras: rotations about the axes of the aircraft, one after the other.
glm::dvec3 ThroughPixel(const HudFlight& flight, double x, double y) {
  const double focal = 0.5 * kPanelWidth / std::tan(0.5 * flight.fov_rad);
  const glm::dvec3 seen{x - 0.5 * kPanelWidth, 0.5 * kPanelHeight - y, focal};  // right, up, ahead
  const double cr = std::cos(flight.roll_rad), sr = std::sin(flight.roll_rad);
  const glm::dvec3 level{seen.x * cr + seen.y * sr, seen.y * cr - seen.x * sr, seen.z};
  const double cp = std::cos(flight.pitch_rad), sp = std::sin(flight.pitch_rad);
  const glm::dvec3 flat{level.x, level.y * cp + level.z * sp, level.z * cp - level.y * sp};
  const double ch = std::cos(flight.heading_rad), sh = std::sin(flight.heading_rad);
  return glm::normalize(glm::dvec3(flat.x * ch + flat.z * sh, flat.z * ch - flat.x * sh, flat.y));
}

bool IsGreen(const std::array<float, 3>& pixel) {
  return pixel[1] > 0.75F && pixel[0] < 0.6F && pixel[2] < 0.7F;
}

/// Elevation [rad] of the middle of the green line that a column crosses near `near_y`.
std::optional<double> ElevationOfLine(const Image& image, const HudFlight& flight, int x,
                                      int near_y) {
  constexpr int kReach = 12;
  double sum = 0.0;
  int count = 0;
  for (int y = std::max(near_y - kReach, 0); y <= std::min(near_y + kReach, kPanelHeight - 1);
       ++y) {
    if (!IsGreen(image.at(x, y))) continue;
    sum += y + 0.5;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return std::asin(ThroughPixel(flight, x + 0.5, sum / count).z);
}

TEST_F(Instruments, TheHorizonOfTheLadderLiesOnTheHorizon) {
  struct Attitude {
    double pitch_deg, roll_deg, fov_deg;
  };
  Hud hud;
  for (const Attitude& attitude :
       {Attitude{0.0, 0.0, 60.0}, Attitude{5.0, 0.0, 60.0}, Attitude{-4.0, 20.0, 60.0},
        Attitude{2.0, -35.0, 90.0}, Attitude{1.0, 10.0, 20.0}, Attitude{-8.0, 5.0, 110.0}}) {
    HudModel model = tests::Flying();
    model.flight.pitch_rad = attitude.pitch_deg * kRadiansPerDegree;
    model.flight.roll_rad = attitude.roll_deg * kRadiansPerDegree;
    model.flight.fov_rad = attitude.fov_deg * kRadiansPerDegree;
    SCOPED_TRACE(fmt::format("pitch {} roll {} view {}", attitude.pitch_deg, attitude.roll_deg,
                             attitude.fov_deg));
    const Image image = Drawn(hud, model, kPanelWidth, kPanelHeight);
    const double pixel_rad = 2.0 * std::tan(0.5 * model.flight.fov_rad) / kPanelWidth;
    int found = 0;
    for (const double aside : {-0.15, -0.11, 0.11, 0.15}) {
      // The reference solution finds where the column meets the horizontal plane.
      const int x = static_cast<int>((0.5 + aside) * kPanelWidth);
      int y = 0;
      while (y < kPanelHeight && ThroughPixel(model.flight, x + 0.5, y + 0.5).z > 0.0) ++y;
      const auto elevation = ElevationOfLine(image, model.flight, x, y);
      ASSERT_TRUE(elevation.has_value()) << "column " << x << ", row " << y;
      EXPECT_NEAR(*elevation, 0.0, 1.0 * pixel_rad)
          << "a line two pixels wide, its middle counted in whole ones";
      ++found;
    }
    EXPECT_EQ(found, 4);
  }
}

TEST_F(Instruments, TwiceTheScaleIsTheSameOnTwiceTheDots) {
  Hud once({.scale = 1.0}), twice({.scale = 2.0});
  HudModel model = tests::Flying(), changed = model;
  changed.time.local = "07:03:51";
  const Box small = Difference(Drawn(once, model, kPanelWidth, kPanelHeight),
                               Drawn(once, changed, kPanelWidth, kPanelHeight));
  const Box large = Difference(Drawn(twice, model, 2 * kPanelWidth, 2 * kPanelHeight),
                               Drawn(twice, changed, 2 * kPanelWidth, 2 * kPanelHeight));
  constexpr double kSlack = 8.0;  // pixels: letters are hinted at their size
  EXPECT_NEAR(large.left, 2.0 * small.left, kSlack);
  EXPECT_NEAR(large.right, 2.0 * small.right, kSlack);
  EXPECT_NEAR(large.top, 2.0 * small.top, kSlack);
  EXPECT_NEAR(large.bottom, 2.0 * small.bottom, kSlack);
}

TEST_F(Instruments, TheSmallestPictureHasNumbersInsteadOfTapes) {
  Hud hud;
  const Image full = Drawn(hud, tests::Flying(), 320, 240);
  HudModel faster = tests::Flying();
  *faster.flight.air_speed_m_per_s = 99.0;
  const Box box = Difference(full, Drawn(hud, faster, 320, 240));
  EXPECT_FALSE(box.empty());
  EXPECT_LE(box.bottom - box.top, 20) << "one line of text";
  EXPECT_LE(box.right, 100);
}

TEST_F(Instruments, ALongMessageIsWrappedIntoTheSmallestPicture) {
  Hud hud;
  HudModel model = tests::Flying();
  const Image before = Drawn(hud, model, 320, 240);
  model.messages = {
      {"N46E008.hgt has 1201 rows of 3601 samples; the missing ones are taken from "
       "the neighbours of the file",
       true}};
  const Box box = Difference(before, Drawn(hud, model, 320, 240));
  EXPECT_GT(box.left, 0);
  EXPECT_LT(box.right, 320);
  EXPECT_GT(box.bottom - box.top, 40) << "three lines";
}

TEST_F(Instruments, EveryAttitudeAndViewIsDrawn) {
  Hud hud;
  for (const double pitch_deg : {-90.0, -89.9, -45.0, 89.0, 90.0}) {
    for (const double roll_deg : {-180.0, 0.0, 97.0}) {
      for (const double fov_deg : {1.0, 60.0, 120.0}) {
        HudModel model = tests::Flying();
        model.flight.pitch_rad = pitch_deg * kRadiansPerDegree;
        model.flight.roll_rad = roll_deg * kRadiansPerDegree;
        model.flight.fov_rad = fov_deg * kRadiansPerDegree;
        model.flight.path = Course{2.0, 0.1};
        const Image image = Drawn(hud, model, 160, 120);
        EXPECT_FALSE(FaultyValue(image)) << pitch_deg << " " << roll_deg << " " << fov_deg;
      }
    }
  }
}

TEST(PitchLadder, RungsStandApart) {
  EXPECT_EQ(RungStep_deg(21.3), 5.0) << "60 degrees on 1280 pixels";
  EXPECT_EQ(RungStep_deg(128.0), 1.0);
  EXPECT_EQ(RungStep_deg(4.0), 30.0);
}

TEST(Tapes, MarksAreRoundNumbers) {
  EXPECT_EQ(MarkStep(0.0, 10.0), 10.0);
  EXPECT_EQ(MarkStep(3200.0, 10.0), 100.0);
  EXPECT_EQ(MarkStep(-90000.0, 10.0), 5000.0);
  EXPECT_EQ(MarkStep(245.0, 5.0), 10.0);
}

}  // namespace
}  // namespace alpenglow::viewer
