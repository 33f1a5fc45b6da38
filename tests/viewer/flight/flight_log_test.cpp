// SPDX-License-Identifier: MIT
#include "viewer/flight/flight_recorder.h"

#include <gtest/gtest.h>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"

namespace alpenglow::viewer {
namespace {

constexpr double kSpeed_deg_per_s = 1e-4;
const UtcInstant kStart = ParseInstant("2026-06-21T04:00:00Z");

/// Northwards, a frame of a sixtieth of a second after the other.
void Fly(FlightLog& log, double begin_s, int frames) {
  for (int frame = 0; frame < frames; ++frame) {
    const double seconds = begin_s + frame / 60.0;
    log.Note(seconds, {PlaceFromDegrees(46.0 + kSpeed_deg_per_s * seconds, 8.0, 3000.0)},
             AddSeconds(kStart, 60.0 * seconds));
  }
}

TEST(FlightLog, HasAllOfTheFlightFromItsFirstFrameToItsLast) {
  FlightLog log;
  Fly(log, 5.0, 101);
  const CameraPath path = log.Path();
  EXPECT_EQ(path.begin_s(), 0.0);
  EXPECT_NEAR(path.end_s(), 100.0 / 60.0, 1e-9)
      << "the last frame too, though 1/60 s after another";
  EXPECT_NEAR(path.PoseAt(1.0).place.latitude_rad,
              (46.0 + kSpeed_deg_per_s * 6.0) * kRadiansPerDegree, 1e-12);
  EXPECT_NEAR(SecondsBetween(kStart, *path.UtcAt(1.0)), 360.0, 1e-3);
}

TEST(FlightLog, ALongFlightTakesNoMorePointsAndIsWholeStill) {
  constexpr std::size_t kMost = 64;
  FlightLog log(kMost);
  Fly(log, 0.0, 6001);
  const CameraPath path = log.Path();
  EXPECT_LE(path.points().size(), kMost + 1) << "and the last one";
  EXPECT_GT(path.points().size(), kMost / 2 - 1);
  EXPECT_NEAR(path.end_s(), 100.0, 1e-9);
  for (const double at_s : {0.0, 13.0, 50.0, 99.0}) {
    EXPECT_NEAR(path.PoseAt(at_s).place.latitude_rad / kRadiansPerDegree,
                46.0 + kSpeed_deg_per_s * at_s, 1e-9)
        << "an even flight is between its points where it was";
  }
}

TEST(FlightLog, WhereTheEyeStoodNothingHasBeenFlown) {
  FlightLog log;
  EXPECT_THROW((void)log.Path(), InputError);
  for (int frame = 0; frame < 100; ++frame)
    log.Note(frame / 60.0, {PlaceFromDegrees(46.0, 8.0, 3000.0)}, AddSeconds(kStart, frame));
  EXPECT_THROW((void)log.Path(), InputError);
  Fly(log, 2.0, 2);
  EXPECT_NO_THROW((void)log.Path());
}

}  // namespace
}  // namespace alpenglow::viewer
