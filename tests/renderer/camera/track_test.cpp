// SPDX-License-Identifier: MIT
#include "renderer/camera/track.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "atmosphere/math/constants.h"
#include "tests/fixtures/fault_of.h"

namespace alpenglow::renderer {
namespace {

using ::testing::HasSubstr;

constexpr double kG = 9.80665;

double Sea(const GeodeticPosition&) { return 0.0; }
double DegreesOf(double radians) { return radians / kRadiansPerDegree; }
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
  const double bank = DegreesOf(std::atan(80.0 * 80.0 / (3000.0 * kG)));
  for (double t = 20.0; t < path.end_s() - 20.0; t += 5.0) {
    const CameraPose pose = path.PoseAt(t);
    EXPECT_NEAR(DegreesOf(pose.roll_rad), bank, 1.5)
        << t << ": a cubic through corners of 10 degrees";
    EXPECT_NEAR(DegreesOf(pose.pitch_rad), 0.0, 0.1);
    EXPECT_NEAR(pose.place.height_m, 1000.0, 0.01);
    const double around = -90.0 + 360.0 * t / path.end_s();
    EXPECT_NEAR(std::remainder(DegreesOf(pose.heading_rad) - around, 360.0), 0.0, 1.0) << t;
  }
}

TEST(TrackPath, ATrackThatEndsInATurnBanksToItsEnd) {
  const CameraPath path = PathAlong(Circle(), {.speed_m_per_s = 80.0}, Sea);
  const double bank = DegreesOf(std::atan(80.0 * 80.0 / (3000.0 * kG)));
  for (const double t : {path.begin_s(), path.end_s()}) {
    EXPECT_NEAR(DegreesOf(path.PoseAt(t).roll_rad), bank, 6.0)
        << "chords are shorter there, and turn half as much";
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
  EXPECT_NEAR(DegreesOf(path.PoseAt(120.0).place.latitude_rad), 46.04, 1e-6);
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

/// Along a parallel: degrees of longitude, and seconds of each point.
Track Eastward(const std::vector<std::pair<double, double>>& points) {
  Track track;
  const UtcInstant start = ParseInstant("2026-06-21T10:00:00Z");
  for (const auto& [longitude, time_s] : points)
    track.points.push_back({PlaceFromDegrees(0.0, longitude, 3500.0), AddSeconds(start, time_s)});
  return track;
}

/// A drive of 20 m/s with a fix every `step_s`, a pause of an hour in which the car is moved by 30
/// m, and a drive on.
std::vector<std::pair<double, double>> DriveWithPause(double step_s) {
  constexpr double kDegreesPerMetre = 1.0 / 111319.49;
  std::vector<std::pair<double, double>> points;
  for (double t = 0.0; t <= 120.0; t += step_s)
    points.emplace_back(8.0 + 20.0 * t * kDegreesPerMetre, t);
  const auto [longitude, time_s] = points.back();
  for (double t = 0.0; t <= 120.0; t += step_s)
    points.emplace_back(longitude + (30.0 + 20.0 * t) * kDegreesPerMetre, time_s + 3600.0 + t);
  return points;
}

TEST(TrackPath, APauseIsSpentBetweenThePointsAroundIt) {
  for (const double step_s : {1.0, 5.0}) {
    const auto points = DriveWithPause(step_s);
    const CameraPath path = PathAlong(Eastward(points), {}, Sea);
    const std::size_t last = points.size() / 2 - 1;  // before the pause
    for (double t = points[last].second; t <= points[last + 1].second; t += 7.3) {
      const CameraPose pose = path.PoseAt(t);
      EXPECT_GE(DegreesOf(pose.place.longitude_rad), points[last].first - 1e-9) << t;
      EXPECT_LE(DegreesOf(pose.place.longitude_rad), points[last + 1].first + 1e-9) << t;
      EXPECT_NEAR(DegreesOf(pose.heading_rad), 90.0, 0.01) << t << ": the heading is kept";
    }
  }
}

TEST(TrackPath, ASeldomFixIsPassedAtItsTimeAndNeverTwice) {
  const auto points = DriveWithPause(5.0);
  const CameraPath path = PathAlong(Eastward(points), {}, Sea);
  for (std::size_t i = 1; i < points.size(); ++i) {
    for (double share = 0.0; share <= 1.0; share += 0.125) {
      const double t = points[i - 1].second + share * (points[i].second - points[i - 1].second);
      const double longitude = DegreesOf(path.PoseAt(t).place.longitude_rad);
      EXPECT_GE(longitude, points[i - 1].first - 1e-7) << t;
      EXPECT_LE(longitude, points[i].first + 1e-7) << t;
    }
  }
}

TEST(TrackPath, GoesStraightAndEvenlyThroughAGap) {
  Track track = Eastward({{8.0, 0.0}, {8.01, 60.0}, {8.02, 120.0}});
  const UtcInstant later = AddSeconds(*track.points[0].utc, 1120.0);
  track.points.push_back({PlaceFromDegrees(0.1, 8.02, 3500.0), later, 1});
  track.points.push_back({PlaceFromDegrees(0.1, 8.01, 3500.0), AddSeconds(later, 60.0), 1});
  const CameraPath path = PathAlong(track, {}, Sea);
  for (const double t : {130.0, 370.0, 620.0, 870.0, 1110.0}) {
    const GeodeticPosition place = path.PoseAt(t).place;
    EXPECT_NEAR(DegreesOf(place.longitude_rad), 8.02, 2e-6) << t;
    EXPECT_NEAR(DegreesOf(place.latitude_rad), 1e-4 * (t - 120.0), 2e-6) << t;
  }
}

TEST(TrackPath, LooksWhereItWillGoBeforeItGoes) {
  const CameraPath path = PathAlong(Eastward({{8.0, 0.0}, {8.0, 60.0}, {8.02, 120.0}}), {}, Sea);
  EXPECT_NEAR(DegreesOf(path.PoseAt(1.0).heading_rad), 90.0, 0.01);
}

TEST(TrackPath, LooksUpTheSlopeAndOnWhenItStands) {
  Track track;
  const UtcInstant start = ParseInstant("2026-06-21T04:00:00Z");
  const GeodeticPosition low = PlaceFromDegrees(46.0, 8.0, 1000.0);
  const GeodeticPosition high = PlaceFromDegrees(46.0, 8.01, 1077.5);  // 774.6 m to the east
  track.points = {{low, start}, {high, AddSeconds(start, 60.0)}, {high, AddSeconds(start, 120.0)}};
  const CameraPath path = PathAlong(track, {}, Sea);
  EXPECT_NEAR(DegreesOf(path.PoseAt(30.0).heading_rad), 90.0, 0.5);
  EXPECT_GT(DegreesOf(path.PoseAt(30.0).pitch_rad), 4.0);
  EXPECT_LT(DegreesOf(path.PoseAt(30.0).pitch_rad), 9.0)
      << "5.7 on average, steepest in the middle";
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
    EXPECT_NEAR(DegreesOf(path.PoseAt(t).heading_rad), 0.0, 1.5) << "3 m in a chord of 130 m";
    EXPECT_NEAR(DegreesOf(path.PoseAt(t).roll_rad), 0.0, 8.0);
  }
}

TEST(TrackPath, AReceiverThatRunsAheadAndLagsBehindDoesNotShakeTheSpeed) {
  Track track;
  const UtcInstant start = ParseInstant("2026-06-21T04:00:00Z");
  for (int i = 0; i < 120; ++i) {
    const double ahead = i % 2 == 0 ? 1.0 : -1.0;  // 10 m of the 60 m in a second
    track.points.push_back(
        {PlaceFromDegrees(46.0 + (60.0 * i + 10.0 * ahead) / 111150.0, 8.0, 1000.0),
         AddSeconds(start, i)});
  }
  const CameraPath path = PathAlong(track, {}, Sea);
  for (double t = 8.0; t < 110.0; t += 0.5) {
    const double speed = Apart(path.PoseAt(t + 0.5).place, path.PoseAt(t - 0.5).place);
    EXPECT_NEAR(speed, 60.0, 60.0 * 0.1)
        << t << ": from 40 to 80 m/s in the track; a parabola through nine of its points leaves a "
        << "weight of 0.11 of what changes its sign from each to the next";
  }
}

TEST(TrackPath, AnEvenAccelerationPassesTheSmoothingUnchanged) {
  Track track;
  const UtcInstant start = ParseInstant("2026-06-21T04:00:00Z");
  const auto way_m = [](double t) { return 20.0 * t + 0.5 * t * t; };
  for (int i = 0; i <= 100; ++i) {
    track.points.push_back(
        {PlaceFromDegrees(0.0, way_m(i) / 111319.49079, 1000.0 + 0.0 * i), AddSeconds(start, i)});
  }
  const CameraPath path = PathAlong(track, {}, Sea);
  for (double t = 0.0; t <= 100.0; t += 10.0) {
    EXPECT_NEAR(DegreesOf(path.PoseAt(t).place.longitude_rad) * 111319.49079, way_m(t), 0.05)
        << t << ": the way between points is taken as straight, and as even";
  }
}

TEST(TrackPath, WingsRollIntoATurnAndOutOfItWithoutAJump) {
  Track track;  // north for 3 km, a quarter of a circle of 1 km, east for 3 km
  const LocalFrame frame(kWgs84, PlaceFromDegrees(46.0, 8.0, 1000.0));
  const auto add = [&](double east_m, double north_m) {
    track.points.push_back({frame.GeodeticFromEnu(Point<Enu>{{east_m, north_m, 0.0}})});
    track.points.back().place.height_m = 1000.0;
  };
  for (int i = 0; i < 30; ++i) add(0.0, 100.0 * i);
  for (int i = 0; i <= 15; ++i) {
    const double angle = 6.0 * i * kRadiansPerDegree;
    add(1000.0 * (1.0 - std::cos(angle)), 3000.0 + 1000.0 * std::sin(angle));
  }
  for (int i = 1; i <= 30; ++i) add(1000.0 + 100.0 * i, 4000.0);
  const CameraPath path = PathAlong(track, {.speed_m_per_s = 60.0}, Sea);
  const double turn_s = 50.0, full = DegreesOf(std::atan(60.0 * 60.0 / (1000.0 * kG)));
  for (double t = 0.0; t < path.end_s(); t += 0.25) {
    const double rate = DegreesOf(path.PoseAt(t + 0.5).roll_rad - path.PoseAt(t).roll_rad) / 0.5;
    EXPECT_LT(std::abs(rate), 6.0) << t << ": a window of Hann spreads 20 degrees to 5 a second";
  }
  EXPECT_NEAR(DegreesOf(path.PoseAt(turn_s + 13.0).roll_rad), full, 1.0) << "in the turn's middle";
  EXPECT_NEAR(DegreesOf(path.PoseAt(turn_s - 8.0).roll_rad), 0.0, 0.5);
}

// Hard case 27.
TEST(TrackPath, OverTheDateLineItGoesTheShortWay) {
  Track track;
  track.points = {{PlaceFromDegrees(10.0, 179.9, 1000.0)},
                  {PlaceFromDegrees(10.0, -179.9, 1000.0)}};
  const CameraPath path = PathAlong(track, {.speed_m_per_s = 100.0}, Sea);
  EXPECT_NEAR(path.end_s(), 219.0, 2.0) << "0.2 degrees at 10 degrees north are 21.9 km";
  EXPECT_NEAR(DegreesOf(path.PoseAt(0.5 * path.end_s()).heading_rad), 90.0, 0.1);
}

TEST(TrackPath, ATrackIsRefusedThatGoesNowhere) {
  const auto fault = [](const Track& track) {
    return tests::FaultOf([&] { return PathAlong(track, {}, Sea).end_s(); });
  };
  Track track;
  EXPECT_THAT(fault(track), HasSubstr("fewer than two points"));
  track.points.assign(10, {PlaceFromDegrees(46.0, 8.0, 0.0)});
  track.file = "still.gpx";
  EXPECT_THAT(fault(track), HasSubstr("still.gpx: the track has fewer than two points apart"));
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
}  // namespace alpenglow::renderer
