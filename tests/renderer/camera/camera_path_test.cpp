// SPDX-License-Identifier: MIT
#include "renderer/camera/camera_path.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "renderer/series/frame_times.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::renderer {
namespace {

using testing::HasSubstr;

CameraPathPoint PointAt(double time_s, double latitude, double longitude, double height_m,
                        double heading, double pitch = 0.0) {
  CameraPathPoint point;
  point.time_s = time_s;
  point.pose.place = PlaceFromDegrees(latitude, longitude, height_m);
  point.pose.heading_rad = heading * kRadiansPerDegree;
  point.pose.pitch_rad = pitch * kRadiansPerDegree;
  return point;
}

CameraPath Loop() {
  return CameraPath({PointAt(0.0, 46.5, 8.0, 2000.0, 350.0), PointAt(4.0, 46.6, 8.1, 2400.0, 10.0),
                     PointAt(5.0, 46.6, 8.2, 2400.0, 60.0, -20.0),
                     PointAt(11.0, 46.5, 8.3, 1500.0, 200.0, -20.0)});
}

glm::dvec3 Ecef(const CameraPose& pose) { return EcefFromGeodetic(kWgs84, pose.place).xyz; }

TEST(CameraPath, GoesThroughItsPointsAndStandsBeforeAndAfter) {
  const CameraPath path = Loop();
  for (const CameraPathPoint& point : path.points()) {
    EXPECT_EQ(path.PoseAt(point.time_s).place.latitude_rad, point.pose.place.latitude_rad);
    EXPECT_EQ(path.PoseAt(point.time_s).heading_rad, point.pose.heading_rad);
  }
  EXPECT_EQ(path.PoseAt(-3.0).place.height_m, 2000.0);
  EXPECT_EQ(path.PoseAt(99.0).place.height_m, 1500.0);
}

TEST(CameraPath, SpeedHasNoJumps) {
  const CameraPath path = Loop();
  constexpr double kStep_s = 1e-4;
  for (const double t : {4.0, 5.0}) {
    const auto speed = [&](double from) {
      return (Ecef(path.PoseAt(from + kStep_s)) - Ecef(path.PoseAt(from))) / kStep_s;
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

TEST(CameraPath, HeightAndPitchNeverLeaveTheRangeOfTheirNeighbours) {
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

TEST(CameraPath, OnAStraightWayItStaysBetweenItsTwoPoints) {
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
      const double gone = std::remainder(
          path.PoseAt(t).place.longitude_rad / kRadiansPerDegree - longitudes[i], 360.0);
      EXPECT_GE(gone / whole, -1e-9) << t;
      EXPECT_LE(gone / whole, 1.0 + 1e-9) << t;
    }
  }
}

TEST(CameraPath, TheDateLineIsNoSeam) {
  const CameraPath path(
      {PointAt(0.0, 10.0, 179.9, 100.0, 90.0), PointAt(1.0, 10.0, -179.9, 100.0, 90.0)});
  const double longitude = path.PoseAt(0.5).place.longitude_rad / kRadiansPerDegree;
  EXPECT_NEAR(std::abs(longitude), 180.0, 1e-9);
  EXPECT_NEAR(path.PoseAt(0.5).place.latitude_rad / kRadiansPerDegree, 10.0, 1e-4);
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

TEST(PathFrames, AreSpacedAsAskedFor) {
  const CameraPath path = Loop();
  const UtcInstant start = ParseInstant("2026-06-21T04:00:00Z");
  EXPECT_EQ(FramesAlong(path, {}, start).size(), 276U) << "11 s at 25 a second, and the last";
  const std::vector<Frame> counted = FramesAlong(path, {.every = {}, .count = 12}, start);
  ASSERT_EQ(counted.size(), 12U);
  EXPECT_NEAR(counted[11].path_s, 11.0, 1e-12);
  EXPECT_EQ(FormatUtc(counted[11].instant), "2026-06-21T04:00:11Z");
  EXPECT_EQ(FramesAlong(path, {.every = "2s", .count = {}}, start).size(), 6U);
  EXPECT_THROW((void)FramesAlong(path, {.every = "0s", .count = {}}, start), InputError);
  EXPECT_THROW((void)FramesAlong(path, {.every = {}, .count = 0}, start), InputError);
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
  [[nodiscard]] std::string FaultOf(const std::string& text) const {
    return tests::FaultOf([&] { return Read(text); });
  }
};

TEST_F(CameraPathFiles, WrittenAndReadBackItIsTheSamePath) {
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
    EXPECT_LT(glm::length(Ecef(a) - Ecef(b)), 1e-4) << "a tenth of a millimetre";
    EXPECT_NEAR(a.heading_rad, b.heading_rad, 1e-9 * kRadiansPerDegree);
    EXPECT_NEAR(a.roll_rad, b.roll_rad, 1e-9 * kRadiansPerDegree);
    EXPECT_NEAR(a.fov_rad, b.fov_rad, 1e-9 * kRadiansPerDegree);
    EXPECT_NEAR(SecondsBetween(*path.UtcAt(t), *again.UtcAt(t)), 0.0, 1e-5);
  }
}

TEST_F(CameraPathFiles, ColumnsComeInAnyOrderAndSomeMayBeLeftOut) {
  CameraPose otherwise;
  otherwise.pitch_rad = -0.25;
  const CameraPath path = Read(
      "# a flight\nlongitude,t_s,height_m,latitude,heading\n# over the "
      "lake\n\n8,0,500,46,90\n8.1,2,510,46,95 "
      "# "
      "turn\n",
      otherwise);
  ASSERT_EQ(path.points().size(), 2U);
  EXPECT_NEAR(path.points()[1].pose.place.longitude_rad, 8.1 * kRadiansPerDegree, 1e-12);
  EXPECT_NEAR(path.points()[1].pose.pitch_rad, -0.25, 1e-12);
}

TEST_F(CameraPathFiles, AFaultIsNamedWithItsLine) {
  const std::string header = "t_s,latitude,longitude,height_m,heading\n";
  EXPECT_THAT(FaultOf("t_s,latitude,longitude\n0,1,2\n"),
              HasSubstr("p.csv:1: column height_m is missing"));
  EXPECT_THAT(FaultOf("t_s,latitude,longitude,height_m,yaw\n"),
              HasSubstr("p.csv:1: column \"yaw\" is unknown"));
  EXPECT_THAT(FaultOf(header + "0,46,8,100,0\n0,46,8,100,0\n"), HasSubstr("p.csv:3: t_s is 0"));
  EXPECT_THAT(FaultOf(header + "# a\n0,91,8,100,0\n"), HasSubstr("p.csv:3: latitude is 91"));
  EXPECT_THAT(FaultOf(header + "0,46,8,100\n"), HasSubstr("p.csv:2: has 4 fields"));
  EXPECT_THAT(FaultOf(header + "0,46,8,100,nan\n"), HasSubstr("p.csv:2: heading is nan"));
  EXPECT_THAT(FaultOf(header), HasSubstr("no lines"));
  EXPECT_THAT(FaultOf("t_s,latitude,longitude,height_m,fov\n0,46,8,100,200\n"),
              HasSubstr("p.csv:2: fov is 200"));
  EXPECT_THAT(FaultOf("t_s,latitude,longitude,height_m,utc\n0,46,8,100,soon\n"),
              HasSubstr("p.csv:2: "));
}

}  // namespace
}  // namespace alpenglow::renderer
