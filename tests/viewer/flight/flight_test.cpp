// SPDX-License-Identifier: MIT
#include "viewer/flight/flight.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "viewer/flight_session.h"

namespace alpenglow::viewer {
namespace {

CameraPose EyeAt(double latitude, double longitude, double height_m, double heading_deg = 0.0,
                 double pitch_deg = 0.0) {
  return {PlaceFromDegrees(latitude, longitude, height_m), heading_deg * kRadiansPerDegree,
          pitch_deg * kRadiansPerDegree};
}

TEST(Flight, TheViewLooksWhereHeadingAndPitchSay) {
  const ViewAxes north = AxesOf(EyeAt(46.0, 8.0, 0.0));
  EXPECT_NEAR(glm::length(north.forward - glm::dvec3(0.0, 1.0, 0.0)), 0.0, 1e-15);
  EXPECT_NEAR(glm::length(north.right - glm::dvec3(1.0, 0.0, 0.0)), 0.0, 1e-15);
  const ViewAxes east = AxesOf(EyeAt(46.0, 8.0, 0.0, 90.0, 30.0));
  EXPECT_NEAR(east.forward.x, std::cos(30.0 * kRadiansPerDegree), 1e-15);
  EXPECT_NEAR(east.forward.z, 0.5, 1e-15);
  EXPECT_NEAR(glm::dot(east.forward, east.up), 0.0, 1e-15);
}

TEST(Flight, APlacementChangesWhatItNamesAndRefusesWhatIsOutOfRange) {
  const CameraPose eye = EyeAt(46.0, 8.0, 500.0, 10.0, 5.0);
  const CameraPose north = Placed(eye, {.latitude_deg = 47.0, .heading_deg = 90.0});
  EXPECT_NEAR(north.place.latitude_rad, 47.0 * kRadiansPerDegree, 1e-15);
  EXPECT_NEAR(north.place.longitude_rad, 8.0 * kRadiansPerDegree, 1e-15);
  EXPECT_EQ(north.place.height_m, 500.0);
  EXPECT_NEAR(north.heading_rad, 0.5 * kPi, 1e-15);
  EXPECT_EQ(north.pitch_rad, eye.pitch_rad);
  EXPECT_THROW(static_cast<void>(Placed(eye, {.latitude_deg = 90.1})), InputError);
  EXPECT_THROW(static_cast<void>(Placed(eye, {.height_m = -20000.0})), InputError);
  EXPECT_THROW(static_cast<void>(Placed(eye, {.heading_deg = 361.0})), InputError);
  EXPECT_THROW(static_cast<void>(Placed(eye, {.pitch_deg = 91.0})), InputError);
}

TEST(Flight, SpeedIsAWalkOnTheGroundAndKilometresASecondInOrbit) {
  EXPECT_NEAR(SpeedAt(0.0), 2.0, 1.0);
  EXPECT_GT(SpeedAt(400e3), 10e3);
  EXPECT_LE(SpeedAt(1e9), 200e3);
  for (double h = 1.0; h < 1e6; h *= 2.0) EXPECT_GE(SpeedAt(2.0 * h), SpeedAt(h));
}

TEST(Flight, AnHourForwardIsTheDistanceOfTheSpeed) {
  CameraPose eye = EyeAt(46.0, 8.0, 1000.0, 90.0);
  const Point<Ecef> start = EcefFromGeodetic(kWgs84, eye.place);
  for (int i = 0; i < 100; ++i) eye = Steer(eye, {.forward = 1.0}, kWgs84, 1000.0, 0.1);
  const double flown = glm::length((EcefFromGeodetic(kWgs84, eye.place) - start).xyz);
  EXPECT_NEAR(flown, 10.0 * SpeedAt(1000.0), 0.1) << "ten seconds on a path bent by the earth";
}

TEST(Flight, AcrossTheDateLineAndOverThePoleTheDirectionIsKept) {
  CameraPose eye = EyeAt(0.0, 179.999, 1000.0, 90.0);
  for (int i = 0; i < 100; ++i) eye = Steer(eye, {.forward = 1.0}, kWgs84, 1000.0, 0.1);
  EXPECT_LT(eye.place.longitude_rad, 0.0) << "beyond the date line";
  EXPECT_NEAR(eye.heading_rad, 0.5 * kPi, 1e-6);

  CameraPose north = EyeAt(89.999, 20.0, 1000.0, 0.0);
  for (int i = 0; i < 100; ++i) north = Steer(north, {.forward = 1.0}, kWgs84, 1000.0, 0.1);
  EXPECT_NEAR(std::abs(north.heading_rad), kPi, 1e-3) << "over the pole, southwards";
  EXPECT_NEAR(north.place.longitude_rad, (20.0 - 180.0) * kRadiansPerDegree, 1e-3);
}

TEST(Flight, PitchStopsAtTheVertical) {
  const CameraPose up = Turned(EyeAt(46.0, 8.0, 0.0), 0.0, 10.0);
  EXPECT_EQ(up.pitch_rad, 0.5 * kPi);
  EXPECT_TRUE(std::isfinite(AxesOf(up).right.x));
}

TEST(Flight, ARolledEyeTurnsToWhatItSeesOnItsRight) {
  for (const double roll : {0.0, 0.5, -1.2, kPi}) {
    CameraPose eye = EyeAt(46.0, 8.0, 0.0, 30.0);
    eye.roll_rad = roll;
    const ViewAxes before = AxesOf(eye);
    constexpr double kTurn = 1e-3;
    EXPECT_NEAR(glm::dot(AxesOf(Turned(eye, kTurn, 0.0)).forward, before.right), kTurn, 1e-6)
        << roll << ": of second order in the angle";
    EXPECT_NEAR(glm::dot(AxesOf(Turned(eye, 0.0, kTurn)).forward, before.up), kTurn, 1e-6) << roll;
  }
}

TEST(Flight, AHeldRollTurnsTheHorizonAndATelescopeTurnsSlowly) {
  const CameraPose rolled = Steer(EyeAt(46.0, 8.0, 0.0), {.roll_right = 1.0}, kWgs84, 10.0, 1.0);
  EXPECT_NEAR(rolled.roll_rad, 45.0 * kRadiansPerDegree, 1e-12);
  const CameraPose narrow = Zoomed(EyeAt(46.0, 8.0, 0.0), 0.1);
  const CameraPose turned = Steer(narrow, {.turn_right = 1.0}, kWgs84, 10.0, 1.0);
  EXPECT_NEAR(turned.heading_rad, 4.5 * kRadiansPerDegree, 1e-12) << "in a view of 6 degrees";
}

TEST(Flight, TheFieldOfViewStaysBetweenOneAndAHundredAndTwentyDegrees) {
  EXPECT_NEAR(Zoomed(EyeAt(0.0, 0.0, 0.0), 1e-9).fov_rad, 1.0 * kRadiansPerDegree, 1e-15);
  EXPECT_NEAR(Zoomed(EyeAt(0.0, 0.0, 0.0), 1e9).fov_rad, 120.0 * kRadiansPerDegree, 1e-15);
}

TEST(Flight, TheEyeStaysOverTheGround) {
  EXPECT_EQ(KeptAbove(EyeAt(0.0, 0.0, 100.0), 500.0, 2.0).place.height_m, 502.0);
  EXPECT_EQ(KeptAbove(EyeAt(0.0, 0.0, 900.0), 500.0, 2.0).place.height_m, 900.0);
}

TEST(Flight, ExposureAdaptsHalfWayInAThirdOfASecond) {
  EXPECT_EQ(AdaptedEv100(std::nullopt, 12.0, 0.0), 12.0);
  EXPECT_NEAR(AdaptedEv100(10.0, 12.0, 0.3), 11.0, 1e-12);
  EXPECT_EQ(AdaptedEv100(10.0, 12.0, 0.0), 10.0);
  EXPECT_NEAR(AdaptedEv100(10.0, 12.0, 60.0), 12.0, 1e-12);
}

TEST(Flight, AnEyeAtAPlaceStandsOnTheRunwayAndFliesOverTheCity) {
  const CameraPose zurich =
      viewer::EyeAt(PlaceNamed("LSZH"), {}, [](const GeodeticPosition&) { return 430.0; });
  EXPECT_EQ(zurich.place.height_m, 432.0) << "over the terrain's runway";
  EXPECT_NEAR(zurich.heading_rad / kRadiansPerDegree, 155.0, 1e-9)
      << "runway 16, five degrees of it grid";
  const CameraPose lhasa =
      viewer::EyeAt(PlaceNamed("Lhasa"), {}, [](const GeodeticPosition&) { return 0.0; });
  EXPECT_EQ(lhasa.place.height_m, 600.0) << "over the plain, where there is no terrain";
}

}  // namespace
}  // namespace alpenglow::viewer
