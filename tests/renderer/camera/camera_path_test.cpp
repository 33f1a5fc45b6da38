// SPDX-License-Identifier: MIT
// Paths of a camera through points, and paths along tracks.
#include "renderer/camera/camera_path.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "renderer/camera/track.h"
#include "renderer/series/frame_times.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::renderer {
namespace {

using testing::HasSubstr;

const UtcTime kStart = ParseInstant("2026-06-21T04:00:00Z");

CameraPathPoint PointAt(double time_s, double latitude, double longitude, double height_m,
                        double heading, double pitch = 0.0) {
  CameraPathPoint point;
  point.time_s = time_s;
  point.pose.place = CheckedPlace({latitude, longitude, height_m});
  point.pose.heading_rad = heading * kRadiansPerDegree;
  point.pose.pitch_rad = pitch * kRadiansPerDegree;
  return point;
}

CameraPath Loop() {
  return CameraPath({PointAt(0.0, 46.5, 8.0, 2000.0, 350.0), PointAt(4.0, 46.6, 8.1, 2400.0, 10.0),
                     PointAt(5.0, 46.6, 8.2, 2400.0, 60.0, -20.0),
                     PointAt(11.0, 46.5, 8.3, 1500.0, 200.0, -20.0)});
}

glm::dvec3 Ecef(const Place& place) { return EcefFromGeodetic(kWgs84, place).xyz; }
double Apart(const Place& a, const Place& b) { return glm::length(Ecef(a) - Ecef(b)); }
double DegreesOf(double radians) { return radians / kRadiansPerDegree; }

TEST(CameraPath, PassesItsPointsAndStandsBeforeAndAfter) {
  const CameraPath path = Loop();
  for (const CameraPathPoint& point : path.points()) {
    EXPECT_EQ(path.PoseAt(point.time_s).place.latitude_rad(), point.pose.place.latitude_rad());
    EXPECT_EQ(path.PoseAt(point.time_s).heading_rad, point.pose.heading_rad);
  }
  EXPECT_EQ(path.PoseAt(-3.0).place.height_m, 2000.0);
  EXPECT_EQ(path.PoseAt(99.0).place.height_m, 1500.0);
}

TEST(CameraPath, AntipodalPointsAreRefused) {
  EXPECT_THAT(tests::FaultOf([] {
                CameraPath({PointAt(0.0, 46.5, 8.0, 0.0, 0.0), PointAt(1.0, 20.0, 8.0, 0.0, 0.0),
                            PointAt(2.0, -20.0, -172.0, 0.0, 0.0)});
              }),
              HasSubstr("points 2 and 3 of the camera path are on opposite sides"));
  const CameraPath nearly({PointAt(0.0, 0.0, 0.0, 0.0, 0.0), PointAt(1.0, 0.01, 180.0, 0.0, 0.0)});
  EXPECT_TRUE(std::isfinite(nearly.PoseAt(0.5).place.latitude_rad()));
}

TEST(CameraPath, SpeedHasNoJumps) {
  const CameraPath path = Loop();
  constexpr double kStep_s = 1e-4;
  for (const double t : {4.0, 5.0}) {
    const auto speed = [&](double from) {
      return (Ecef(path.PoseAt(from + kStep_s).place) - Ecef(path.PoseAt(from).place)) / kStep_s;
    };
    const glm::dvec3 before = speed(t - kStep_s), after = speed(t);
    EXPECT_LT(glm::length(after - before), 1e-3 * glm::length(after))
        << "at " << t << " s: bounded acceleration over a tenth of a millisecond";
    const double turn_before = path.PoseAt(t).heading_rad - path.PoseAt(t - kStep_s).heading_rad;
    const double turn_after = path.PoseAt(t + kStep_s).heading_rad - path.PoseAt(t).heading_rad;
    EXPECT_NEAR(std::remainder(turn_after - turn_before, 2.0 * kPi), 0.0, 1e-3 * kStep_s);
  }
}

TEST(CameraPath, HeadingsGoThroughNorthTheShortWay) {
  const CameraPath path = Loop();
  for (int i = 0; i <= 40; ++i) {
    const double heading = path.PoseAt(0.1 * i).heading_rad / kRadiansPerDegree;
    EXPECT_LE(std::abs(std::remainder(heading, 360.0)), 10.0 + 1e-9) << 0.1 * i << " s";
  }
}

TEST(CameraPath, HeightAndPitchStayWithinTheRangeOfTheirNeighbours) {
  const CameraPath path = Loop();
  for (int i = 0; i <= 1100; ++i) {
    const double t = 0.01 * i;
    const CameraPose pose = path.PoseAt(t);
    if (t > 4.0 && t < 5.0) {
      EXPECT_NEAR(pose.place.height_m, 2400.0, 1e-9) << "it stays level";
    }
    if (t > 5.0) {
      EXPECT_NEAR(pose.pitch_rad, -20.0 * kRadiansPerDegree, 1e-12);
    }
    EXPECT_GE(pose.place.height_m, 1500.0 - 1e-9);
    EXPECT_LE(pose.place.height_m, 2400.0 + 1e-9);
    EXPECT_EQ(pose.roll_rad, 0.0) << "a level camera stays level";
  }
}

TEST(CameraPath, AFlightAtOneHeightStaysAtItAcrossAnOcean) {
  const CameraPath path(
      {PointAt(0.0, 50.0, 0.0, 11000.0, 290.0), PointAt(20000.0, 45.0, -70.0, 11000.0, 240.0)});
  for (const double t : {1000.0, 10000.0, 15000.0}) {
    EXPECT_NEAR(path.PoseAt(t).place.height_m, 11000.0, 1e-6);
  }
}

TEST(CameraPath, StaysBetweenItsTwoPointsOnAStraightWay) {
  const double longitudes[] = {-180.0, -179.9, -179.899, -179.9, -180.0, 179.0};
  const double times_s[] = {0.0, 5.0, 3605.0, 3606.0, 3700.0, 4000.0};
  std::vector<CameraPathPoint> points;
  for (std::size_t i = 0; i < 6; ++i)
    points.push_back(PointAt(times_s[i], 0.0, longitudes[i], 1000.0, 90.0));
  const CameraPath path(points);
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double whole = std::remainder(longitudes[i + 1] - longitudes[i], 360.0);
    for (double share = 0.05; share < 1.0; share += 0.05) {
      const double t = times_s[i] + share * (times_s[i + 1] - times_s[i]);
      const double gone = std::remainder(path.PoseAt(t).place.longitude_deg - longitudes[i], 360.0);
      EXPECT_GE(gone / whole, -1e-9) << t;
      EXPECT_LE(gone / whole, 1.0 + 1e-9) << t;
    }
  }
}

TEST(CameraPath, InstantsRunEvenlyBetweenPoints) {
  std::vector<CameraPathPoint> points{PointAt(0.0, 0.0, 0.0, 0.0, 0.0),
                                      PointAt(10.0, 0.0, 1.0, 0.0, 0.0)};
  EXPECT_FALSE(CameraPath(points).UtcAt(3.0).has_value());
  points[0].utc = ParseInstant("2026-06-21T23:59:00Z");
  EXPECT_THROW(CameraPath{points}, InputError) << "all points have an instant, or none";
  points[1].utc = ParseInstant("2026-06-22T00:09:00Z");
  EXPECT_EQ(FormatUtc(*CameraPath(points).UtcAt(5.0)), "2026-06-22T00:04:00Z");
}

TEST(PathFrames, AreSpacedByStepOrCount) {
  const CameraPath path = Loop();
  EXPECT_EQ(FramesAlong(path, {}, kStart).size(), 276U) << "11 s at 25 a second, and the last";
  const std::vector<Frame> counted = FramesAlong(path, {.every = {}, .count = 12}, kStart);
  ASSERT_EQ(counted.size(), 12U);
  EXPECT_NEAR(counted[11].path_s, 11.0, 1e-12);
  EXPECT_EQ(FormatUtc(counted[11].instant), "2026-06-21T04:00:11Z");
  EXPECT_EQ(FramesAlong(path, {.every = "2s", .count = {}}, kStart).size(), 6U);
  EXPECT_THROW((void)FramesAlong(path, {.every = "0s", .count = {}}, kStart), InputError);
  EXPECT_THROW((void)FramesAlong(path, {.every = {}, .count = 0}, kStart), InputError);
  const CameraSample still = CameraSampleOf(counted[5], path, 0.0);
  const CameraSample blurred = CameraSampleOf(counted[5], path, 0.5);
  EXPECT_EQ(still.poses.size(), 1U);
  EXPECT_EQ(blurred.middle()->place.height_m, still.middle()->place.height_m)
      << "the shutter is open around the instant of the frame";
  EXPECT_EQ(blurred.poses.front().place.height_m,
            path.PoseAt(counted[5].path_s - 0.25).place.height_m);
}

class CameraPathFiles : public TemporaryFolder {
 protected:
  [[nodiscard]] CameraPath Read(const std::string& text, const CameraPose& otherwise = {}) const {
    WriteText(folder_ / "p.csv", text);
    return ReadCameraPath(folder_ / "p.csv", otherwise);
  }
};

TEST_F(CameraPathFiles, APathThatIsWrittenAndReadBackIsTheSame) {
  std::vector<CameraPathPoint> points = Loop().points();
  for (CameraPathPoint& point : points) {
    point.pose.roll_rad = -0.1234567;
    point.utc = AddSeconds(ParseInstant("2026-06-21T04:00:00Z"), 1.25 * point.time_s);
  }
  const CameraPath path(points);
  const CameraPath again = Read(TextOf(path));
  ASSERT_EQ(again.points().size(), points.size());
  for (const double t : {0.0, 2.7, 5.0, 9.1}) {
    const CameraPose a = path.PoseAt(t), b = again.PoseAt(t);
    EXPECT_LT(Apart(a.place, b.place), 1e-4) << "a tenth of a millimetre";
    EXPECT_NEAR(a.heading_rad, b.heading_rad, 1e-9 * kRadiansPerDegree);
    EXPECT_NEAR(a.roll_rad, b.roll_rad, 1e-9 * kRadiansPerDegree);
    EXPECT_NEAR(a.fov_rad, b.fov_rad, 1e-9 * kRadiansPerDegree);
    EXPECT_NEAR(SecondsBetween(*path.UtcAt(t), *again.UtcAt(t)), 0.0, 1e-5);
  }
}

TEST_F(CameraPathFiles, ColumnsMayHaveAnyOrderAndSomeMayBeMissing) {
  CameraPose otherwise;
  otherwise.pitch_rad = -0.25;
  const CameraPath path = Read(
      "# a flight\nlongitude,t_s,height_m,latitude,heading\n# over the "
      "lake\n\n8,0,500,46,90\n8.1,2,510,46,95 "
      "# "
      "turn\n",
      otherwise);
  ASSERT_EQ(path.points().size(), 2U);
  EXPECT_NEAR(path.points()[1].pose.place.longitude_rad(), 8.1 * kRadiansPerDegree, 1e-12);
  EXPECT_NEAR(path.points()[1].pose.pitch_rad, -0.25, 1e-12);
}

TEST_F(CameraPathFiles, AFaultIsReportedWithItsLine) {
  const std::string start = "t_s,latitude,longitude,height_m", header = start + ",heading\n";
  for (const auto& [text, fault] : std::vector<std::pair<std::string, const char*>>{
           {"t_s,latitude,longitude\n0,1,2\n", "p.csv:1: column height_m is missing"},
           {start + ",yaw\n", "p.csv:1: column \"yaw\" is unknown"},
           {header + "0,46,8,100,0\n0,46,8,100,0\n", "p.csv:3: t_s is 0"},
           {header + "# a\n0,91,8,100,0\n", "p.csv:3: latitude is 91"},
           {header + "0,46,8,100\n", "p.csv:2: has 4 fields"},
           {header + "0,46,8,100,nan\n", "p.csv:2: heading is nan"},
           {header, "no lines"},
           {start + ",fov\n0,46,8,100,200\n", "p.csv:2: fov is 200"},
           {start + ",utc\n0,46,8,100,soon\n", "p.csv:2: "}}) {
    EXPECT_THAT(tests::FaultOf([&, &text = text] { return Read(text); }), HasSubstr(fault)) << text;
  }
}

constexpr double kG = 9.80665;

double Sea(const Place&) { return 0.0; }

/// Returns a circle of 3 km around 46 N 8 E, clockwise from its south, with a point every 10
/// degrees.
Track Circle() {
  Track track;
  const LocalFrame frame(kWgs84, Place{46.0, 8.0, 1000.0});
  for (int i = 0; i <= 36; ++i) {
    const double angle = (180.0 + 10.0 * i) * kRadiansPerDegree;
    Place place = frame.GeodeticFromEnu(
        Point<Enu>{{3000.0 * std::sin(angle), 3000.0 * std::cos(angle), 0.0}});
    place.height_m = 1000.0;
    track.points.push_back({place});
  }
  return track;
}

TEST(TrackPath, ACircleIsFlownWithTheBankOfRadiusAndSpeed) {
  const CameraPath path = PathAlong(Circle(), {.speed_m_per_s = 80.0}, Sea);
  const double bank = DegreesOf(std::atan(80.0 * 80.0 / (3000.0 * kG)));
  EXPECT_NEAR(path.end_s(), 2.0 * kPi * 3000.0 / 80.0, 0.5) << "chords of 10 degrees";
  EXPECT_GE(path.points().size(), 201U);
  for (double t = 20.0; t < path.end_s() - 20.0; t += 5.0) {
    const CameraPose pose = path.PoseAt(t);
    EXPECT_NEAR(DegreesOf(pose.roll_rad), bank, 1.5)
        << t << ": a cubic through corners of 10 degrees";
    EXPECT_NEAR(DegreesOf(pose.pitch_rad), 0.0, 0.1);
    EXPECT_NEAR(pose.place.height_m, 1000.0, 0.01);
    const double around = -90.0 + 360.0 * t / path.end_s();
    EXPECT_NEAR(std::remainder(DegreesOf(pose.heading_rad) - around, 360.0), 0.0, 1.0) << t;
  }
  for (const double t : {path.begin_s(), path.end_s()}) {
    EXPECT_NEAR(DegreesOf(path.PoseAt(t).roll_rad), bank, 6.0)
        << "chords are shorter at the ends, and turn half as much";
  }
}

TEST(TrackPath, GoesThroughEveryPointOfTheTrack) {
  const Track track = Circle();
  const CameraPath path = PathAlong(track, {}, Sea);
  for (const TrackPoint& point : track.points) {
    double nearest = 1e9;
    for (double t = path.begin_s(); t <= path.end_s(); t += 0.05)
      nearest = std::min(nearest, Apart(path.PoseAt(t).place, point.place));
    EXPECT_LT(nearest, 2.0) << "of points every second, 60 m apart, and steps of 3 m";
  }
}

TEST(TrackPath, TimesOfTheTrackAreKept) {
  Track track;
  for (int i = 0; i < 5; ++i) {
    track.points.push_back(
        {CheckedPlace({46.0 + 0.01 * i * i, 8.0, 1000.0}), AddSeconds(kStart, 60.0 * i)});
  }
  track.points.push_back(track.points.back());  // a receiver that says the same thing twice
  const CameraPath path = PathAlong(track, {}, Sea);
  EXPECT_EQ(path.end_s(), 240.0);
  EXPECT_NEAR(DegreesOf(path.PoseAt(120.0).place.latitude_rad()), 46.04, 1e-6);
  EXPECT_NEAR(SecondsBetween(kStart, *path.UtcAt(90.0)), 90.0, 1e-6);
}

TEST(TrackPath, TimesOfOnlySomePointsAreNotUsed) {
  Track track;
  track.points.push_back({Place{46.0, 8.0, 1000.0}, ParseInstant("2026-06-21T04:00:00Z")});
  track.points.push_back({Place{46.1, 8.0, 1000.0}});
  const CameraPath path = PathAlong(track, {.speed_m_per_s = 100.0}, Sea);
  EXPECT_NEAR(path.end_s(), 111.0, 1.0) << "a tenth of a degree is 11.1 km";
  EXPECT_FALSE(path.UtcAt(0.0));
}

TEST(TrackPath, ATrackWithoutHeightsFollowsTheGround) {
  const GroundHeight hills = [](const Place& place) {
    return 800.0 + 300.0 * std::sin(place.latitude_rad() * 6.37e6 / 2000.0);
  };
  Track track;
  track.heights = TrackHeights::kOnGround;
  track.points = {{Place{46.0, 8.0, 0.0}}, {Place{46.1, 8.0, 0.0}}};
  const CameraPath path = PathAlong(track, {.over_ground_m = 150.0}, hills);
  for (double t = 0.0; t <= path.end_s(); t += 1.0) {
    const Place place = path.PoseAt(t).place;
    EXPECT_NEAR(place.height_m - hills(place), 150.0, 60.0);
    EXPECT_GT(place.height_m - hills(place), 74.0);
  }
  track.heights = TrackHeights::kOverGround;
  for (TrackPoint& point : track.points) point.place.height_m = 500.0;
  const CameraPath high = PathAlong(track, {}, hills);
  EXPECT_NEAR(high.PoseAt(0.0).place.height_m - hills(track.points[0].place), 500.0, 60.0);
}

/// Returns a track along the equator.
/// @param points  longitude [degrees] and time [s].
Track Eastward(const std::vector<std::pair<double, double>>& points) {
  Track track;
  const UtcTime start = ParseInstant("2026-06-21T10:00:00Z");
  for (const auto& [longitude, time_s] : points)
    track.points.push_back({CheckedPlace({0.0, longitude, 3500.0}), AddSeconds(start, time_s)});
  return track;
}

/// Returns a drive of 20 m/s with a fix every `step_s`, a pause of an hour in which the car is
/// moved by 30 m, and a second drive.
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

TEST(TrackPath, APauseIsSpentBetweenTheAdjacentPoints) {
  for (const double step_s : {1.0, 5.0}) {
    const auto points = DriveWithPause(step_s);
    const CameraPath path = PathAlong(Eastward(points), {}, Sea);
    const std::size_t last = points.size() / 2 - 1;  // before the pause
    for (double t = points[last].second; t <= points[last + 1].second; t += 7.3) {
      const CameraPose pose = path.PoseAt(t);
      EXPECT_GE(DegreesOf(pose.place.longitude_rad()), points[last].first - 1e-9) << t;
      EXPECT_LE(DegreesOf(pose.place.longitude_rad()), points[last + 1].first + 1e-9) << t;
      EXPECT_NEAR(DegreesOf(pose.heading_rad), 90.0, 0.01) << t << ": the heading is kept";
    }
  }
}

TEST(TrackPath, SparseFixesArePassedOnceAndAtTheirTimes) {
  const auto points = DriveWithPause(5.0);
  const CameraPath path = PathAlong(Eastward(points), {}, Sea);
  for (std::size_t i = 1; i < points.size(); ++i) {
    for (double share = 0.0; share <= 1.0; share += 0.125) {
      const double t = points[i - 1].second + share * (points[i].second - points[i - 1].second);
      const double longitude = DegreesOf(path.PoseAt(t).place.longitude_rad());
      EXPECT_GE(longitude, points[i - 1].first - 1e-7) << t;
      EXPECT_LE(longitude, points[i].first + 1e-7) << t;
    }
  }
}

TEST(TrackPath, GoesStraightAndEvenlyThroughAGap) {
  Track track = Eastward({{8.0, 0.0}, {8.01, 60.0}, {8.02, 120.0}});
  const UtcTime later = AddSeconds(*track.points[0].utc, 1120.0);
  track.points.push_back({Place{0.1, 8.02, 3500.0}, later, 1});
  track.points.push_back({Place{0.1, 8.01, 3500.0}, AddSeconds(later, 60.0), 1});
  const CameraPath path = PathAlong(track, {}, Sea);
  for (const double t : {130.0, 370.0, 620.0, 870.0, 1110.0}) {
    const Place place = path.PoseAt(t).place;
    EXPECT_NEAR(DegreesOf(place.longitude_rad()), 8.02, 2e-6) << t;
    EXPECT_NEAR(DegreesOf(place.latitude_rad()), 1e-4 * (t - 120.0), 2e-6) << t;
  }
}

/// Adds five minutes on a circle of 120 m, a point each second, 20 s a turn.
void AddCircling(double begin_s, int segment, Track& track) {
  const LocalFrame frame(kWgs84, Place{46.5, 8.0, 0.0});
  for (int i = 0; i < 300; ++i) {
    const double angle = 18.0 * i * kRadiansPerDegree;
    Place place =
        frame.GeodeticFromEnu(Point<Enu>{{120.0 * std::sin(angle), 120.0 * std::cos(angle), 0.0}});
    place.height_m = 2000.0 + 2.0 * i;
    track.points.push_back({place, AddSeconds(kStart, begin_s + i), segment});
  }
}

// Two flights with days between them, in two segments and in one.
TEST(TrackPath, DaysWithoutDataDoNotCoarsenTheFlights) {
  for (const int second : {1, 0}) {
    Track track, alone;
    AddCircling(0.0, 0, track);
    AddCircling(7.0 * 86400.0, second, track);
    AddCircling(0.0, 0, alone);
    const CameraPath path = PathAlong(track, {}, Sea), flight = PathAlong(alone, {}, Sea);
    EXPECT_LT(path.points().size(), 2000U) << "not a point for each second of a week";
    const LocalFrame frame(kWgs84, Place{46.5, 8.0, 0.0});
    for (double t = 0.0; t <= 299.0; t += 0.7) {
      for (const double begin_s : {0.0, 7.0 * 86400.0}) {
        const CameraPose pose = path.PoseAt(begin_s + t), single = flight.PoseAt(t);
        EXPECT_LT(Apart(pose.place, single.place), 0.5) << begin_s + t;
        EXPECT_NEAR(std::remainder(pose.heading_rad - single.heading_rad, 2.0 * kPi), 0.0, 0.02)
            << begin_s + t;
        Place level = pose.place;
        level.height_m = 0.0;
        EXPECT_NEAR(glm::length(frame.EnuFromGeodetic(level).xyz), 120.0, 4.0)
            << "a smoothed curve through points 38 m apart";
      }
    }
  }
}

// Three days with a point every minute are longer than the path has points at one a second.
TEST(TrackPath, LongTracksKeepTheRecordedRateInBoundedMemory) {
  Track track;
  for (int i = 0; i < 4500; ++i) {
    const double east_deg = i % 2 == 0 ? 1e-3 : -1e-3;  // every point is a corner
    track.points.push_back(
        {CheckedPlace({46.0 + 1e-4 * i, 8.0 + east_deg, 1000.0}), AddSeconds(kStart, 60.0 * i)});
  }
  const CameraPath path = PathAlong(track, {}, Sea);
  EXPECT_LE(path.points().size(), 200010U);
  for (std::size_t i = 0; i < track.points.size(); i += 100)
    EXPECT_LT(Apart(path.PoseAt(60.0 * static_cast<double>(i)).place, track.points[i].place), 5.0)
        << i << "; 155 m from point to point, in steps of 1.4 s";
}

TEST(TrackPath, LooksAheadBeforeItMoves) {
  const CameraPath path = PathAlong(Eastward({{8.0, 0.0}, {8.0, 60.0}, {8.02, 120.0}}), {}, Sea);
  EXPECT_NEAR(DegreesOf(path.PoseAt(1.0).heading_rad), 90.0, 0.01);
}

TEST(TrackPath, LooksUpTheSlopeAndLevelWhenItStands) {
  Track track;
  const Place low{46.0, 8.0, 1000.0};
  const Place high{46.0, 8.01, 1077.5};  // 774.6 m to the east
  track.points = {
      {low, kStart}, {high, AddSeconds(kStart, 60.0)}, {high, AddSeconds(kStart, 120.0)}};
  const CameraPath path = PathAlong(track, {}, Sea);
  EXPECT_NEAR(DegreesOf(path.PoseAt(30.0).heading_rad), 90.0, 0.5);
  EXPECT_GT(DegreesOf(path.PoseAt(30.0).pitch_rad), 4.0);
  EXPECT_LT(DegreesOf(path.PoseAt(30.0).pitch_rad), 9.0)
      << "5.7 on average, steepest in the middle";
  EXPECT_NEAR(path.PoseAt(110.0).pitch_rad, 0.0, 1e-3);
}

TEST(TrackPath, JitterOfTheReceiverHardlyTurnsTheCamera) {
  Track track;
  for (int i = 0; i < 120; ++i) {
    const double jitter = (i % 2 == 0 ? 1.0 : -1.0) * 2e-5;  // 1.5 m to the sides
    track.points.push_back(
        {CheckedPlace({46.0 + 3e-4 * i, 8.0 + jitter, 1000.0}), AddSeconds(kStart, i)});
  }
  const CameraPath path = PathAlong(track, {}, Sea);
  for (double t = 5.0; t < 110.0; t += 0.5) {
    EXPECT_NEAR(DegreesOf(path.PoseAt(t).heading_rad), 0.0, 1.5) << "3 m in a chord of 130 m";
    EXPECT_NEAR(DegreesOf(path.PoseAt(t).roll_rad), 0.0, 8.0);
  }
}

TEST(TrackPath, SpeedIsSteadyWhenFixesRunAheadAndLagBehind) {
  Track track;
  for (int i = 0; i < 120; ++i) {
    const double ahead = i % 2 == 0 ? 1.0 : -1.0;  // 10 m of the 60 m in a second
    track.points.push_back(
        {CheckedPlace({46.0 + (60.0 * i + 10.0 * ahead) / 111150.0, 8.0, 1000.0}),
         AddSeconds(kStart, i)});
  }
  const CameraPath path = PathAlong(track, {}, Sea);
  for (double t = 8.0; t < 110.0; t += 0.5) {
    const double speed = Apart(path.PoseAt(t + 0.5).place, path.PoseAt(t - 0.5).place);
    EXPECT_NEAR(speed, 60.0, 60.0 * 0.1)
        << t << ": from 40 to 80 m/s in the track; a parabola through nine of its points leaves a "
        << "weight of 0.11 of what changes its sign from each to the next";
  }
}

TEST(TrackPath, SmoothingKeepsAnEvenAcceleration) {
  Track track;
  const auto way_m = [](double t) { return 20.0 * t + 0.5 * t * t; };
  for (int i = 0; i <= 100; ++i) {
    track.points.push_back(
        {CheckedPlace({0.0, way_m(i) / 111319.49079, 1000.0 + 0.0 * i}), AddSeconds(kStart, i)});
  }
  const CameraPath path = PathAlong(track, {}, Sea);
  for (double t = 0.0; t <= 100.0; t += 10.0) {
    EXPECT_NEAR(DegreesOf(path.PoseAt(t).place.longitude_rad()) * 111319.49079, way_m(t), 0.05)
        << t << ": the way between points is taken as straight, and as even";
  }
}

TEST(TrackPath, WingsRollIntoATurnAndOutOfItWithoutAJump) {
  Track track;  // north for 3 km, a quarter of a circle of 1 km, east for 3 km
  const LocalFrame frame(kWgs84, Place{46.0, 8.0, 1000.0});
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
TEST(CameraPath, GoesTheShortWayAcrossTheDateLine) {
  const CameraPath near(
      {PointAt(0.0, 10.0, 179.9, 100.0, 90.0), PointAt(1.0, 10.0, -179.9, 100.0, 90.0)});
  EXPECT_NEAR(std::abs(DegreesOf(near.PoseAt(0.5).place.longitude_rad())), 180.0, 1e-9);
  EXPECT_NEAR(DegreesOf(near.PoseAt(0.5).place.latitude_rad()), 10.0, 1e-4);
  Track track;
  track.points = {{Place{10.0, 179.9, 1000.0}}, {Place{10.0, -179.9, 1000.0}}};
  const CameraPath path = PathAlong(track, {.speed_m_per_s = 100.0}, Sea);
  EXPECT_NEAR(path.end_s(), 219.0, 2.0) << "0.2 degrees at 10 degrees north are 21.9 km";
  EXPECT_NEAR(DegreesOf(path.PoseAt(0.5 * path.end_s()).heading_rad), 90.0, 0.1);
}

// Hard case 27.
TEST(CameraPath, ACameraThatLooksAheadLooksAheadOverAPole) {
  for (const double hemisphere : {1.0, -1.0}) {
    const double towards = hemisphere > 0.0 ? 0.0 : 180.0;
    const double latitude = hemisphere * 89.9;
    const CameraPath path({PointAt(0.0, latitude, 20.0, 100.0, towards),
                           PointAt(100.0, latitude, -160.0, 100.0, 180.0 - towards)});
    for (int i = 1; i < 200; ++i) {
      const double time_s = 0.5 * i;
      const CameraPose pose = path.PoseAt(time_s);
      const glm::dvec3 ahead = Ecef(path.PoseAt(std::min(time_s + 1.0, 100.0)).place) -
                               Ecef(path.PoseAt(time_s - 0.5).place);
      const LocalFrame here(kWgs84, pose.place);
      const glm::dvec3 looks = here.EcefFromEnu(Vector<Enu>{{std::sin(pose.heading_rad),
                                                             std::cos(pose.heading_rad), 0.0}})
                                   .xyz;
      EXPECT_GT(glm::dot(glm::normalize(ahead), looks), 0.999) << time_s << " s, " << hemisphere;
    }
  }
}

// Hard case 27.
TEST(CameraPath, BetweenPointsTheHeadingFollowsTheGreatCircle) {
  // At 60 degrees north a great circle between meridians 30 degrees apart has a heading of 76.9
  // degrees at its beginning and 103.1 at its end.
  const double turn =
      DegreesOf(std::atan(std::sin(60.0 * kRadiansPerDegree) * std::tan(15.0 * kRadiansPerDegree)));
  const CameraPath path(
      {PointAt(0.0, 60.0, 170.0, 0.0, 90.0 - turn), PointAt(1.0, 60.0, -160.0, 0.0, 90.0 + turn)});
  EXPECT_NEAR(DegreesOf(path.PoseAt(0.5).heading_rad), 90.0, 1e-9);
  const CameraPose quarter = path.PoseAt(0.25);
  const CameraPose later = path.PoseAt(0.2501);
  const glm::dvec3 step = LocalFrame(kWgs84, quarter.place).EnuFromGeodetic(later.place).xyz;
  EXPECT_NEAR(DegreesOf(quarter.heading_rad), DegreesOf(std::atan2(step.x, step.y)), 0.1)
      << "the ellipsoid's geodesic is not quite the normal's great circle";
}

TEST(TrackPath, ATrackThatGoesNowhereIsRefused) {
  const auto fault = [](const Track& track) {
    return tests::FaultOf([&] { return PathAlong(track, {}, Sea).end_s(); });
  };
  Track track;
  EXPECT_THAT(fault(track), HasSubstr("fewer than two points"));
  track.points.assign(10, {Place{46.0, 8.0, 0.0}});
  track.file = "still.gpx";
  EXPECT_THAT(fault(track), HasSubstr("still.gpx: the track has fewer than two points apart"));
  EXPECT_THAT(
      tests::FaultOf([] { return PathAlong(Circle(), {.speed_m_per_s = 0.0}, Sea).end_s(); }),
      HasSubstr("speed of the track"));
}

}  // namespace
}  // namespace alpenglow::renderer
