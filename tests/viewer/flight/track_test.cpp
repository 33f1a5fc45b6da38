// SPDX-License-Identifier: MIT
#include "viewer/flight/track.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/number/constants.h"
#include "tests/fixtures/fault_of.h"

namespace alpenglow {
namespace {

using ::testing::HasSubstr;

constexpr double kG = 9.80665;

double Sea(const GeodeticPosition&) { return 0.0; }
double Degrees(double radians) { return radians / kRadiansPerDegree; }
double Apart(const GeodeticPosition& a, const GeodeticPosition& b) {
  return glm::length((EcefFromGeodetic(kWgs84, a) - EcefFromGeodetic(kWgs84, b)).xyz);
}

/// A circle of 3 km around 46 N 8 E, clockwise from its south, a point every 10 degrees.
Track Circle() {
  Track track;
  const LocalFrame frame(kWgs84, PlaceFromDegrees(46.0, 8.0, 1000.0));
  for (int i = 0; i <= 36; ++i) {
    const double angle = (180.0 + 10.0 * i) * kRadiansPerDegree;
    GeodeticPosition place = frame.GeodeticFromEnu(
        Point<Enu>{{3000.0 * std::sin(angle), 3000.0 * std::cos(angle), 0.0}});
    place.height_m = 1000.0;
    track.points.push_back({place});
  }
  return track;
}

TEST(TrackPath, ACircleIsFlownWithTheBankOfItsRadiusAndTheSpeed) {
  const CameraPath path = PathAlong(Circle(), {.speed_m_per_s = 80.0}, Sea);
  EXPECT_NEAR(path.end_s(), 2.0 * kPi * 3000.0 / 80.0, 0.5) << "chords of 10 degrees";
  const double bank = Degrees(std::atan(80.0 * 80.0 / (3000.0 * kG)));
  for (double t = 20.0; t < path.end_s() - 20.0; t += 5.0) {
    const CameraPose pose = path.PoseAt(t);
    EXPECT_NEAR(Degrees(pose.roll_rad), bank, 1.5)
        << t << ": a cubic through corners of 10 degrees";
    EXPECT_NEAR(Degrees(pose.pitch_rad), 0.0, 0.1);
    EXPECT_NEAR(pose.place.height_m, 1000.0, 0.01);
    const double around = -90.0 + 360.0 * t / path.end_s();
    EXPECT_NEAR(std::remainder(Degrees(pose.heading_rad) - around, 360.0), 0.0, 1.0) << t;
  }
}

TEST(TrackPath, GoesThroughEveryPointOfTheTrack) {
  const Track track = Circle();
  const CameraPath path = PathAlong(track, {}, Sea);
  for (const TrackPoint& point : track.points) {
    double nearest = 1e9;
    for (double t = path.begin_s(); t <= path.end_s(); t += 0.05) {
      nearest = std::min(nearest, Apart(path.PoseAt(t).place, point.place));
    }
    EXPECT_LT(nearest, 2.0) << "of points every second, 60 m apart, and steps of 3 m";
  }
}

TEST(TrackPath, TimesOfTheTrackAreKept) {
  Track track;
  const UtcInstant start = ParseInstant("2026-06-21T04:00:00Z");
  for (int i = 0; i < 5; ++i) {
    track.points.push_back(
        {PlaceFromDegrees(46.0 + 0.01 * i * i, 8.0, 1000.0), AddSeconds(start, 60.0 * i)});
  }
  track.points.push_back(track.points.back());  // a receiver that says the same thing twice
  const CameraPath path = PathAlong(track, {}, Sea);
  EXPECT_EQ(path.end_s(), 240.0);
  EXPECT_NEAR(Degrees(path.PoseAt(120.0).place.latitude_rad), 46.04, 1e-6);
  EXPECT_NEAR(SecondsBetween(start, *path.UtcAt(90.0)), 90.0, 1e-6);
}

TEST(TrackPath, TimesThatOnlySomePointsHaveAreNotUsed) {
  Track track;
  track.points.push_back(
      {PlaceFromDegrees(46.0, 8.0, 1000.0), ParseInstant("2026-06-21T04:00:00Z")});
  track.points.push_back({PlaceFromDegrees(46.1, 8.0, 1000.0)});
  const CameraPath path = PathAlong(track, {.speed_m_per_s = 100.0}, Sea);
  EXPECT_NEAR(path.end_s(), 111.0, 1.0) << "a tenth of a degree is 11.1 km";
  EXPECT_FALSE(path.UtcAt(0.0));
}

TEST(TrackPath, ATrackWithoutHeightsFollowsTheGround) {
  const GroundHeight hills = [](const GeodeticPosition& place) {
    return 800.0 + 300.0 * std::sin(place.latitude_rad * 6.37e6 / 2000.0);
  };
  Track track;
  track.heights = TrackHeights::kOnGround;
  track.points = {{PlaceFromDegrees(46.0, 8.0, 0.0)}, {PlaceFromDegrees(46.1, 8.0, 0.0)}};
  const CameraPath path = PathAlong(track, {.over_ground_m = 150.0}, hills);
  for (double t = 0.0; t <= path.end_s(); t += 1.0) {
    const GeodeticPosition place = path.PoseAt(t).place;
    EXPECT_NEAR(place.height_m - hills(place), 150.0, 60.0);
    EXPECT_GT(place.height_m - hills(place), 74.0);
  }
  track.heights = TrackHeights::kOverGround;
  for (TrackPoint& point : track.points) point.place.height_m = 500.0;
  const CameraPath high = PathAlong(track, {}, hills);
  EXPECT_NEAR(high.PoseAt(0.0).place.height_m - hills(track.points[0].place), 500.0, 60.0);
}

TEST(TrackPath, LooksUpTheSlopeAndOnWhenItStands) {
  Track track;
  const UtcInstant start = ParseInstant("2026-06-21T04:00:00Z");
  const GeodeticPosition low = PlaceFromDegrees(46.0, 8.0, 1000.0);
  const GeodeticPosition high = PlaceFromDegrees(46.0, 8.01, 1077.5);  // 774.6 m to the east
  track.points = {{low, start}, {high, AddSeconds(start, 60.0)}, {high, AddSeconds(start, 120.0)}};
  const CameraPath path = PathAlong(track, {}, Sea);
  EXPECT_NEAR(Degrees(path.PoseAt(30.0).heading_rad), 90.0, 0.5);
  EXPECT_GT(Degrees(path.PoseAt(30.0).pitch_rad), 4.0);
  EXPECT_LT(Degrees(path.PoseAt(30.0).pitch_rad), 9.0) << "5.7 on average, steepest in the middle";
  EXPECT_NEAR(path.PoseAt(110.0).pitch_rad, 0.0, 1e-3);
}

TEST(TrackPath, AJitterOfTheReceiverTurnsTheHeadLittle) {
  Track track;
  const UtcInstant start = ParseInstant("2026-06-21T04:00:00Z");
  for (int i = 0; i < 120; ++i) {
    const double jitter = (i % 2 == 0 ? 1.0 : -1.0) * 2e-5;  // 1.5 m to the sides
    track.points.push_back(
        {PlaceFromDegrees(46.0 + 3e-4 * i, 8.0 + jitter, 1000.0), AddSeconds(start, i)});
  }
  const CameraPath path = PathAlong(track, {}, Sea);
  for (double t = 5.0; t < 110.0; t += 0.5) {
    EXPECT_NEAR(Degrees(path.PoseAt(t).heading_rad), 0.0, 1.5) << "3 m in a chord of 130 m";
    EXPECT_NEAR(Degrees(path.PoseAt(t).roll_rad), 0.0, 8.0);
  }
}

// Hard case 27.
TEST(TrackPath, OverTheDateLineItGoesTheShortWay) {
  Track track;
  track.points = {{PlaceFromDegrees(10.0, 179.9, 1000.0)},
                  {PlaceFromDegrees(10.0, -179.9, 1000.0)}};
  const CameraPath path = PathAlong(track, {.speed_m_per_s = 100.0}, Sea);
  EXPECT_NEAR(path.end_s(), 219.0, 2.0) << "0.2 degrees at 10 degrees north are 21.9 km";
  EXPECT_NEAR(Degrees(path.PoseAt(0.5 * path.end_s()).heading_rad), 90.0, 0.1);
}

TEST(TrackPath, ATrackIsRefusedThatGoesNowhere) {
  const auto fault = [](const Track& track) {
    return tests::FaultOf([&] { return PathAlong(track, {}, Sea).end_s(); });
  };
  Track track;
  EXPECT_THAT(fault(track), HasSubstr("fewer than two points"));
  track.points.assign(10, {PlaceFromDegrees(46.0, 8.0, 0.0)});
  EXPECT_THAT(fault(track), HasSubstr("fewer than two points"));
  EXPECT_THAT(
      tests::FaultOf([] { return PathAlong(Circle(), {.speed_m_per_s = 0.0}, Sea).end_s(); }),
      HasSubstr("speed of the track"));
}

TEST(TrackPath, IsAPathThatReplaysAndSeriesRead) {
  const CameraPath path = PathAlong(Circle(), {}, Sea);
  EXPECT_THAT(TextOf(path), HasSubstr("t_s,latitude,longitude,height_m,heading,pitch,roll,fov"));
  EXPECT_GE(path.points().size(), 201U);
}

}  // namespace
}  // namespace alpenglow
