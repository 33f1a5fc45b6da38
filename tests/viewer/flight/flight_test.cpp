// SPDX-License-Identifier: MIT
// Free flight, the pilot, the clock, and records of flights.
#include "viewer/flight/flight.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <glm/geometric.hpp>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "tests/fixtures/temporary_folder.h"
#include "viewer/flight/flight_controller.h"
#include "viewer/flight/flight_recorder.h"
#include "viewer/flight/pilot.h"
#include "viewer/flight_session.h"

namespace alpenglow::viewer {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

CameraPose EyeAt(double latitude, double longitude, double height_m, double heading_deg = 0.0,
                 double pitch_deg = 0.0) {
  return {CheckedPlace({latitude, longitude, height_m}), heading_deg * kRadiansPerDegree,
          pitch_deg * kRadiansPerDegree};
}

TEST(Flight, ViewDirectionFollowsFromHeadingAndPitch) {
  const ViewAxes north = AxesOf(EyeAt(46.0, 8.0, 0.0));
  EXPECT_NEAR(glm::length(north.forward - glm::dvec3(0.0, 1.0, 0.0)), 0.0, 1e-15);
  EXPECT_NEAR(glm::length(north.right - glm::dvec3(1.0, 0.0, 0.0)), 0.0, 1e-15);
  const ViewAxes east = AxesOf(EyeAt(46.0, 8.0, 0.0, 90.0, 30.0));
  EXPECT_NEAR(east.forward.x, std::cos(30.0 * kRadiansPerDegree), 1e-15);
  EXPECT_NEAR(east.forward.z, 0.5, 1e-15);
  EXPECT_NEAR(glm::dot(east.forward, east.up), 0.0, 1e-15);
}

TEST(Flight, PlacementChangesOnlyItsFieldsAndRefusesValuesOutOfRange) {
  const CameraPose eye = EyeAt(46.0, 8.0, 500.0, 10.0, 5.0);
  const CameraPose north = Placed(eye, {.latitude_deg = 47.0, .heading_deg = 90.0});
  EXPECT_NEAR(north.place.latitude_rad(), 47.0 * kRadiansPerDegree, 1e-15);
  EXPECT_NEAR(north.place.longitude_rad(), 8.0 * kRadiansPerDegree, 1e-15);
  EXPECT_EQ(north.place.height_m, 500.0);
  EXPECT_NEAR(north.heading_rad, 0.5 * kPi, 1e-15);
  EXPECT_EQ(north.pitch_rad, eye.pitch_rad);
  EXPECT_THROW(static_cast<void>(Placed(eye, {.latitude_deg = 90.1})), InputError);
  EXPECT_THROW(static_cast<void>(Placed(eye, {.height_m = -20000.0})), InputError);
  EXPECT_THROW(static_cast<void>(Placed(eye, {.heading_deg = 361.0})), InputError);
  EXPECT_THROW(static_cast<void>(Placed(eye, {.pitch_deg = 91.0})), InputError);
}

TEST(Flight, SpeedOfTheFreeCameraGrowsWithHeight) {
  EXPECT_NEAR(SpeedAt(0.0), 2.0, 1.0);
  EXPECT_GT(SpeedAt(400e3), 10e3);
  EXPECT_LE(SpeedAt(1e9), 200e3);
  for (double h = 1.0; h < 1e6; h *= 2.0) EXPECT_GE(SpeedAt(2.0 * h), SpeedAt(h));
}

TEST(Flight, AnHourForwardCoversSpeedTimesTime) {
  CameraPose eye = EyeAt(46.0, 8.0, 1000.0, 90.0);
  const Point<Ecef> start = EcefFromGeodetic(kWgs84, eye.place);
  for (int i = 0; i < 100; ++i) eye = Steer(eye, {.forward = 1.0}, kWgs84, 1000.0, 0.1);
  const double flown = glm::length((EcefFromGeodetic(kWgs84, eye.place) - start).xyz);
  EXPECT_NEAR(flown, 10.0 * SpeedAt(1000.0), 0.1) << "ten seconds on a path bent by the earth";
}

TEST(Flight, DirectionIsKeptAcrossTheDateLineAndOverThePole) {
  CameraPose eye = EyeAt(0.0, 179.999, 1000.0, 90.0);
  for (int i = 0; i < 100; ++i) eye = Steer(eye, {.forward = 1.0}, kWgs84, 1000.0, 0.1);
  EXPECT_LT(eye.place.longitude_rad(), 0.0) << "beyond the date line";
  EXPECT_NEAR(eye.heading_rad, 0.5 * kPi, 1e-6);

  CameraPose north = EyeAt(89.999, 20.0, 1000.0, 0.0);
  for (int i = 0; i < 100; ++i) north = Steer(north, {.forward = 1.0}, kWgs84, 1000.0, 0.1);
  EXPECT_NEAR(std::abs(north.heading_rad), kPi, 1e-3) << "over the pole, southwards";
  EXPECT_NEAR(north.place.longitude_rad(), (20.0 - 180.0) * kRadiansPerDegree, 1e-3);
}

TEST(Flight, PitchStopsAtTheVertical) {
  const CameraPose up = Turned(EyeAt(46.0, 8.0, 0.0), 0.0, 10.0);
  EXPECT_EQ(up.pitch_rad, 0.5 * kPi);
  EXPECT_TRUE(std::isfinite(AxesOf(up).right.x));
}

TEST(Flight, RolledViewTurnsTowardsItsOwnRight) {
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

TEST(Flight, RollTurnsTheHorizonAndNarrowViewsTurnSlowly) {
  const CameraPose rolled = Steer(EyeAt(46.0, 8.0, 0.0), {.roll_right = 1.0}, kWgs84, 10.0, 1.0);
  EXPECT_NEAR(rolled.roll_rad, 45.0 * kRadiansPerDegree, 1e-12);
  const CameraPose narrow = Zoomed(EyeAt(46.0, 8.0, 0.0), 0.1);
  const CameraPose turned = Steer(narrow, {.turn_right = 1.0}, kWgs84, 10.0, 1.0);
  EXPECT_NEAR(turned.heading_rad, 4.5 * kRadiansPerDegree, 1e-12) << "in a view of 6 degrees";
}

TEST(Flight, FieldOfViewStaysBetween1And120Degrees) {
  EXPECT_NEAR(Zoomed(EyeAt(0.0, 0.0, 0.0), 1e-9).fov_rad, 1.0 * kRadiansPerDegree, 1e-15);
  EXPECT_NEAR(Zoomed(EyeAt(0.0, 0.0, 0.0), 1e9).fov_rad, 120.0 * kRadiansPerDegree, 1e-15);
}

TEST(Flight, EyeStaysAboveTheGround) {
  EXPECT_EQ(KeptAbove(EyeAt(0.0, 0.0, 100.0), 500.0, 2.0).place.height_m, 502.0);
  EXPECT_EQ(KeptAbove(EyeAt(0.0, 0.0, 900.0), 500.0, 2.0).place.height_m, 900.0);
}

TEST(Flight, ExposureAdaptsByHalfInAThirdOfASecond) {
  EXPECT_EQ(AdaptedEv100(std::nullopt, 12.0, 0.0), 12.0);
  EXPECT_NEAR(AdaptedEv100(10.0, 12.0, 0.3), 11.0, 1e-12);
  EXPECT_EQ(AdaptedEv100(10.0, 12.0, 0.0), 10.0);
  EXPECT_NEAR(AdaptedEv100(10.0, 12.0, 60.0), 12.0, 1e-12);
}

TEST(Flight, AtAnAirportTheEyeStandsOnGroundAndAboveACityItFlies) {
  const CameraPose zurich =
      viewer::EyeAt(PlaceNamed("LSZH"), {}, [](const Place&) { return 430.0; });
  EXPECT_EQ(zurich.place.height_m, 432.0) << "over the terrain's runway";
  EXPECT_NEAR(zurich.heading_rad / kRadiansPerDegree, 155.0, 1e-9)
      << "runway 16, five degrees of it grid";
  const CameraPose lhasa = viewer::EyeAt(PlaceNamed("Lhasa"), {}, [](const Place&) { return 0.0; });
  EXPECT_EQ(lhasa.place.height_m, 600.0) << "over the plain, where there is no terrain";
}

// --- the pilot ---

double Sea(const Place&) { return 0.0; }

CameraPose EyeAt(double height_m, double heading_deg = 0.0) {
  return {CheckedPlace({46.0, 8.0, height_m}), heading_deg * kRadiansPerDegree};
}
double Apart(const CameraPose& a, const CameraPose& b) {
  return glm::length((EcefFromGeodetic(kWgs84, a.place) - EcefFromGeodetic(kWgs84, b.place)).xyz);
}

/// Returns the pose after `seconds` with these controls, for frames of a given length.
CameraPose FlownFor(FlightMode mode, const PilotControls& controls, double seconds,
                    double frame_s) {
  Pilot pilot(EyeAt(1500.0), kWgs84);
  EXPECT_FALSE(pilot.Enter(mode, Sea));
  const int frames = static_cast<int>(std::lround(seconds / frame_s));
  for (int i = 0; i < frames; ++i) pilot.Advance(controls, frame_s, Sea);
  return pilot.eye();
}

TEST(Pilot, FlightOfTheAircraftDoesNotDependOnTheFrameRate) {
  const PilotControls controls{.stick = {.pitch_up = 0.1, .roll_right = 0.05, .throttle_up = 0.1}};
  const CameraPose smooth = FlownFor(FlightMode::kAircraft, controls, 12.0, 1.0 / 240.0);
  for (const double frame_s : {1.0 / 60.0, 1.0 / 7.0, 0.75, 4.0, 12.0}) {
    const CameraPose flown = FlownFor(FlightMode::kAircraft, controls, 12.0, frame_s);
    EXPECT_LT(Apart(flown, smooth), 1e-3) << frame_s << " s a frame: the last step may be split";
    EXPECT_NEAR(flown.heading_rad, smooth.heading_rad, 1e-5) << frame_s;
  }
}

TEST(Pilot, FreeCameraDependsOnTheFrameRateByLessThanAPercent) {
  const PilotControls controls{.camera = {.forward = 1.0, .up = 0.5, .turn_right = 0.1}};
  const CameraPose smooth = FlownFor(FlightMode::kFree, controls, 4.0, 1.0 / 240.0);
  const double way = Apart(smooth, EyeAt(1500.0));
  for (const double frame_s : {1.0 / 60.0, 1.0 / 8.0, 0.5, 4.0}) {
    EXPECT_LT(Apart(FlownFor(FlightMode::kFree, controls, 4.0, frame_s), smooth), 0.01 * way)
        << frame_s;
  }
}

TEST(Pilot, AircraftMovesSmoothlyBetweenSimulationSteps) {
  Pilot pilot(EyeAt(1500.0), kWgs84);
  ASSERT_FALSE(pilot.Enter(FlightMode::kAircraft, Sea));
  constexpr double kFrame_s = 1.0 / 500.0;
  CameraPose before = pilot.eye();
  for (int i = 0; i < 200; ++i) {
    pilot.Advance({}, kFrame_s, Sea);
    EXPECT_NEAR(Apart(pilot.eye(), before) / kFrame_s, CruiseSpeed(kLightAircraft, 1500.0), 0.1);
    before = pilot.eye();
  }
}

TEST(Pilot, FreeCameraNeverEntersTheGround) {
  const GroundHeight ridge = [](const Place& place) {
    return 1000.0 + 900.0 * std::sin(place.latitude_rad() * 6e4);
  };
  Pilot pilot(EyeAt(2100.0), kWgs84);
  for (int i = 0; i < 100; ++i) {
    pilot.Advance({.camera = {.forward = 1.0, .up = -1.0}}, 0.1, ridge);
    EXPECT_GE(pilot.eye().place.height_m, ridge(pilot.eye().place) + 1.499);
  }
}

TEST(Pilot, FreeCameraPlacedLowStaysLowUntilItClimbs) {
  constexpr double kLow_m = 0.4;
  Pilot pilot(EyeAt(kLow_m), kWgs84);
  pilot.KeepAbove(Sea);
  EXPECT_EQ(pilot.eye().place.height_m, kLow_m) << "as in a picture of the renderer";
  pilot.Advance({.camera = {.forward = 1.0, .up = -1.0}}, 0.5, Sea);
  EXPECT_NEAR(pilot.eye().place.height_m, kLow_m, 1e-6) << "it came no lower";
  pilot.Advance({.camera = {.up = 1.0}}, 2.0, Sea);
  pilot.Advance({.camera = {.up = -1.0}}, 9.0, Sea);
  EXPECT_NEAR(pilot.eye().place.height_m, kStandingEye_m, 1e-6);
  pilot.PutAt(EyeAt(-5.0), Sea);
  EXPECT_EQ(pilot.eye().place.height_m, kStandingEye_m) << "from under the ground";
}

TEST(Pilot, ChangingTheModeKeepsPlaceAndHeading) {
  Pilot pilot(EyeAt(1500.0, 77.0), kWgs84);
  ASSERT_FALSE(pilot.Enter(FlightMode::kAircraft, Sea));
  EXPECT_LT(Apart(pilot.eye(), EyeAt(1500.0)), 1e-6);
  EXPECT_NEAR(pilot.eye().heading_rad, 77.0 * kRadiansPerDegree, 1e-9);
  pilot.Advance({.stick = {.roll_right = 1.0}}, 1.0, Sea);
  const CameraPose flying = pilot.eye();
  EXPECT_GT(std::abs(flying.roll_rad), 0.2);
  ASSERT_FALSE(pilot.Enter(FlightMode::kFree, Sea));
  EXPECT_LT(Apart(pilot.eye(), flying), 1e-6);
  EXPECT_EQ(pilot.eye().roll_rad, 0.0);
}

TEST(Pilot, AircraftStartsOnTheGroundOrAsAJetHighUp) {
  Pilot low(EyeAt(3.0), kWgs84);
  ASSERT_FALSE(low.Enter(FlightMode::kAircraft, Sea));
  EXPECT_EQ(low.Readout(Sea).aircraft->contact, GroundContact::kStanding);
  EXPECT_EQ(low.Readout(Sea).aircraft_name, "light aircraft");
  Pilot high(EyeAt(10e3), kWgs84);
  ASSERT_FALSE(high.Enter(FlightMode::kAircraft, Sea));
  EXPECT_EQ(high.Readout(Sea).aircraft_name, "small jet");
  Pilot space(EyeAt(400e3), kWgs84);
  EXPECT_EQ(space.Enter(FlightMode::kAircraft, Sea), "there is no air to fly in over 18 km");
  EXPECT_EQ(space.mode(), FlightMode::kFree);
  EXPECT_EQ(space.Enter(FlightMode::kTrack, Sea), "there is no track to follow");
}

TEST(Pilot, LookingAroundDoesNotTurnTheAircraft) {
  Pilot pilot(EyeAt(1500.0), kWgs84);
  ASSERT_FALSE(pilot.Enter(FlightMode::kAircraft, Sea));
  pilot.Advance({.look_right = 0.5}, 1.0, Sea);
  EXPECT_NEAR(pilot.eye().heading_rad, 0.5 * pilot.eye().fov_rad, 1e-3);
  pilot.Advance({}, 10.0, Sea);
  EXPECT_NEAR(pilot.Readout(Sea).aircraft->heading_rad, 0.0, 1e-3);
  pilot.Centre(Sea);
  EXPECT_NEAR(pilot.eye().heading_rad, 0.0, 1e-3);
}

TEST(Pilot, FourfoldFlightSpeedCoversFourTimesTheDistance) {
  Pilot once(EyeAt(1500.0), kWgs84), four(EyeAt(1500.0), kWgs84);
  ASSERT_FALSE(once.Enter(FlightMode::kAircraft, Sea));
  ASSERT_FALSE(four.Enter(FlightMode::kAircraft, Sea));
  four.StepSpeed(2);
  EXPECT_EQ(four.time_factor(), 4.0);
  once.Advance({}, 20.0, Sea);
  four.Advance({}, 5.0, Sea);
  EXPECT_LT(Apart(once.eye(), four.eye()), 1e-3);
  four.StepSpeed(100);
  EXPECT_EQ(four.time_factor(), 32.0);
  four.StepSpeed(-100);
  EXPECT_EQ(four.time_factor(), 1.0);
}

TEST(Pilot, JumpOfAThousandFeetKeepsFlyingEvenFromTheGround) {
  Pilot pilot(EyeAt(2.0), kWgs84);
  ASSERT_FALSE(pilot.Enter(FlightMode::kAircraft, Sea));
  pilot.Lift(304.8, Sea);
  pilot.Advance({}, 10.0, Sea);
  EXPECT_NEAR(pilot.eye().place.height_m, 306.3, 5.0);
  EXPECT_NEAR(pilot.Readout(Sea).speed_m_per_s, CruiseSpeed(kLightAircraft, 306.0), 2.0);
}

std::shared_ptr<const CameraPath> TwoPoints() {
  return std::make_shared<CameraPath>(std::vector<CameraPathPoint>{
      {0.0, {Place{46.0, 8.0, 1000.0}}, ParseInstant("2026-06-21T04:00:00Z")},
      {100.0, {Place{46.1, 8.0, 2000.0}}, ParseInstant("2026-06-21T04:01:40Z")}});
}

TEST(Pilot, FollowsATrackToItsEndAndKeepsTheFieldOfView) {
  Pilot pilot(EyeAt(1500.0), kWgs84);
  pilot.SetTrack(TwoPoints());
  ASSERT_FALSE(pilot.Enter(FlightMode::kTrack, Sea));
  pilot.Zoom(0.5);
  const double fov_rad = pilot.eye().fov_rad;
  pilot.Advance({}, 50.0, Sea);
  EXPECT_NEAR(pilot.eye().place.height_m, 1500.0, 1e-6);
  EXPECT_EQ(pilot.eye().fov_rad, fov_rad);
  EXPECT_EQ(FormatUtc(*pilot.TrackUtc()), "2026-06-21T04:00:50Z");
  pilot.Advance({}, 500.0, Sea);
  EXPECT_NEAR(pilot.eye().place.height_m, 2000.0, 1e-6);
  EXPECT_EQ(FormatUtc(*pilot.TrackUtc()), "2026-06-21T04:01:40Z") << "its end";
  pilot.SkipTrack(-1000.0);
  EXPECT_EQ(FormatUtc(*pilot.TrackUtc()), "2026-06-21T04:00:00Z") << "its beginning";
  pilot.SetTrack(nullptr);
  EXPECT_EQ(pilot.mode(), FlightMode::kFree);
}

TEST(Pilot, ReplayHasTheRecordedFieldOfView) {
  Pilot pilot(EyeAt(1500.0), kWgs84);
  CameraPose narrow{Place{46.0, 8.0, 1000.0}};
  narrow.fov_rad = 0.3;
  pilot.SetTrack(std::make_shared<CameraPath>(std::vector<CameraPathPoint>{{0.0, narrow}}),
                 Pilot::Lens::kOfTrack);
  ASSERT_FALSE(pilot.Enter(FlightMode::kTrack, Sea));
  EXPECT_EQ(pilot.eye().fov_rad, 0.3);
}

TEST(Pilot, AircraftIsLiftedWhenTerrainIsLoadedAboveIt) {
  double ground_m = 0.0;
  const GroundHeight ground = [&](const Place&) { return ground_m; };
  Pilot pilot(EyeAt(800.0), kWgs84);
  ASSERT_FALSE(pilot.Enter(FlightMode::kAircraft, ground));
  ground_m = 2000.0;
  pilot.Advance({}, 1.0, ground);
  EXPECT_NEAR(pilot.eye().place.height_m, 2150.0, 5.0);
  EXPECT_EQ(pilot.Readout(ground).aircraft->contact, GroundContact::kNone);
}

TEST(Pilot, AircraftFliesOnAfterBeingPlacedElsewhere) {
  Pilot pilot(EyeAt(1500.0), kWgs84);
  ASSERT_FALSE(pilot.Enter(FlightMode::kAircraft, Sea));
  CameraPose there = EyeAt(2500.0, 90.0);
  there.place.longitude_deg = 172.0;
  pilot.PutAt(there, Sea);
  EXPECT_EQ(pilot.mode(), FlightMode::kAircraft);
  EXPECT_LT(Apart(pilot.eye(), there), 1e-6);
  pilot.Advance({}, 1.0, Sea);
  EXPECT_GT(pilot.eye().place.longitude_rad(), 3.0);
  there.place.height_m = 400e3;
  pilot.PutAt(there, Sea);
  EXPECT_EQ(pilot.mode(), FlightMode::kFree) << "there is no air";
}

TEST(Pilot, ReplayFliesAsLowAsRecordedButNotIntoTheGround) {
  const auto shown_m = [](double flown_m) {
    Pilot pilot(EyeAt(1500.0), kWgs84);
    const CameraPose low{CheckedPlace({46.0, 8.0, flown_m})};
    pilot.SetTrack(std::make_shared<CameraPath>(std::vector<CameraPathPoint>{{0.0, low}}),
                   Pilot::Lens::kOfTrack);
    EXPECT_FALSE(pilot.Enter(FlightMode::kTrack, [](const auto&) { return 100.0; }));
    return pilot.eye().place.height_m;
  };
  EXPECT_EQ(shown_m(100.5), 100.5) << "lower than people stand";
  EXPECT_GT(shown_m(100.0), 100.01) << "the card has places of land in single precision, to 1 cm";
  EXPECT_LT(shown_m(20.0), 100.5) << "up by no more than it needs";
}

// --- the clock ---

const Place kZurich{47.4582, 8.5555, 432.0};

SceneClock ClockAt(const char* utc) { return SceneClock(ParseInstant(utc)); }
std::string Shows(const SceneClock& clock) { return FormatUtc(clock.now()); }

TEST(Clock, RatesStepThroughRealTimeAndPause) {
  EXPECT_EQ(SteppedTimeRate(1.0, 1), 10.0);
  EXPECT_EQ(SteppedTimeRate(1.0, -1), 0.0);
  EXPECT_EQ(SteppedTimeRate(0.0, -1), -1.0);
  EXPECT_EQ(SteppedTimeRate(3600.0, 1), 3600.0);
  EXPECT_EQ(SteppedTimeRate(-3600.0, -1), -3600.0);
}

TEST(Clock, AdvanceDoesNotDependOnTheFrameRate) {
  SceneClock slow = ClockAt("2026-06-21T04:00:00Z");
  SceneClock fast = slow;
  slow.SetRate(60.0);
  fast.SetRate(60.0);
  slow.Advance(1.0);
  for (int i = 0; i < 60; ++i) fast.Advance(1.0 / 60.0);
  EXPECT_EQ(Shows(slow), "2026-06-21T04:01:00Z");
  EXPECT_NEAR(SecondsBetween(slow.now(), fast.now()), 0.0, 1e-9) << "rounding of 60 sums";
}

TEST(Clock, TimeCanBeSetWhilePaused) {
  SceneClock clock = ClockAt("2026-06-21T04:00:00Z");
  clock.SetRate(600.0);
  clock.Pause(true);
  clock.Advance(100.0);
  EXPECT_EQ(Shows(clock), "2026-06-21T04:00:00Z");
  EXPECT_EQ(clock.rate(), 600.0) << "kept for when it runs again";
  clock.Shift(-60.0);
  EXPECT_EQ(Shows(clock), "2026-06-21T03:59:00Z");
  clock.Pause(false);
  clock.Advance(1.0);
  EXPECT_EQ(Shows(clock), "2026-06-21T04:09:00Z");
}

TEST(Clock, RunsBackwardsAsFastAsForwards) {
  SceneClock clock = ClockAt("2026-01-01T00:00:10Z");
  clock.SetRate(-3600.0);
  clock.Advance(1.0);
  EXPECT_EQ(Shows(clock), "2025-12-31T23:00:10Z");
  EXPECT_THROW(clock.SetRate(3601.0), InputError);
  EXPECT_THROW(clock.SetRate(std::nan("")), InputError);
}

// Hard case 25.
TEST(Clock, IgnoresLeapSecondsAsClocksDo) {
  SceneClock clock = ClockAt("2016-12-31T23:59:50Z");
  for (int i = 0; i < 20; ++i) clock.Advance(1.0);
  EXPECT_EQ(Shows(clock), "2017-01-01T00:00:10Z");
  clock.SetRate(-60.0);
  clock.Advance(1.0);
  EXPECT_EQ(Shows(clock), "2016-12-31T23:59:10Z");
}

TEST(Clock, StopsAtTheFirstAndLastKnownYear) {
  SceneClock clock = ClockAt("2100-12-31T23:00:00Z");
  clock.Shift(1e7);
  EXPECT_EQ(Shows(clock), "2100-12-31T23:59:59Z");
  clock.Shift(-1e11);
  EXPECT_EQ(Shows(clock), "1900-01-01T00:00:00Z");
}

TEST(Clock, JumpsToTheNextSunriseAndNotToTheSameAgain) {
  SceneClock clock = ClockAt("2026-06-21T12:00:00Z");
  for (int day = 22; day < 25; ++day) {
    ASSERT_TRUE(clock.JumpToNext(SkyEvent::kSunrise, kZurich));
    const UtcTime expected = *FindSunEvent(
        SunEvent::kSunrise, kZurich, ParseInstant("2026-06-" + std::to_string(day) + "T12:00:00Z"));
    EXPECT_NEAR(SecondsBetween(expected, clock.now()), 0.0, 0.2)
        << "both searches are within 0.1 s";
  }
}

TEST(Clock, EventsOfADayFollowInOrder) {
  SceneClock clock = ClockAt("2026-03-20T00:00:00Z");
  UtcTime before = clock.now();
  for (const SkyEvent event :
       {SkyEvent::kDawn, SkyEvent::kSunrise, SkyEvent::kNoon, SkyEvent::kSunset, SkyEvent::kDusk}) {
    ASSERT_TRUE(clock.JumpToNext(event, kZurich)) << NameOf(event);
    const double passed_s = SecondsBetween(before, clock.now());
    EXPECT_GT(passed_s, 1000.0) << NameOf(event) << " is twilights and half days later";
    EXPECT_LT(passed_s, 7.0 * 3600.0) << NameOf(event);
    before = clock.now();
  }
}

TEST(Clock, FindsTheNextSunriseAfterAPolarNight) {
  SceneClock clock = ClockAt("2026-12-01T12:00:00Z");
  const Place tromso{69.6492, 18.9553, 0.0};
  ASSERT_TRUE(clock.JumpToNext(SkyEvent::kSunrise, tromso));
  // The sun comes back to a sea horizon at 69.65 degrees north in the middle of January.
  EXPECT_EQ(Shows(clock).substr(0, 8), "2027-01-");
}

TEST(Clock, SearchForAnEventSkipsNoDay) {
  struct Case {
    double latitude, height_m;
    const char* start;
  };
  for (const auto& [latitude, height_m, start] :
       {Case{89.9, 0.0, "2026-09-10T12:00:00Z"}, Case{78.0, 12000.0, "2026-08-15T12:00:00Z"},
        Case{78.0, 0.0, "2026-02-05T12:00:00Z"}, Case{66.0, 0.0, "2026-06-10T12:00:00Z"},
        Case{-67.0, 3000.0, "2026-12-25T12:00:00Z"}, Case{0.0, 0.0, "2026-12-25T12:00:00Z"}}) {
    const Place place = CheckedPlace({latitude, 15.0, height_m});
    SceneClock clock = ClockAt(start);
    // The reference solution searches every day.
    std::optional<UtcTime> expected;
    for (int day = 0; !expected && day < 60; ++day) {
      expected = FindSunEvent(SunEvent::kSunset, place, AddSeconds(clock.now(), day * 86400.0));
      if (expected && SecondsBetween(clock.now(), *expected) < 1.0) expected.reset();
    }
    ASSERT_TRUE(expected) << latitude << " " << start;
    ASSERT_TRUE(clock.JumpToNext(SkyEvent::kSunset, place)) << latitude << " " << start;
    EXPECT_NEAR(SecondsBetween(*expected, clock.now()), 0.0, 0.2) << latitude << " " << start;
  }
}

TEST(Clock, EventsOfTheMoonAgreeWithTheEphemeris) {
  SceneClock clock = ClockAt("2026-06-21T12:00:00Z");
  for (const auto& [event, next] : {std::pair{SkyEvent::kMoonset, &NextMoonset},
                                    std::pair{SkyEvent::kMoonrise, &NextMoonrise}}) {
    const UtcTime expected = next(kZurich, clock.now()).value();
    ASSERT_TRUE(clock.JumpToNext(event, kZurich));
    EXPECT_EQ(SecondsBetween(expected, clock.now()), 0.0) << NameOf(event);
  }
}

TEST(Clock, TypedTimesAreUtcWithZAndLocalWithoutIt) {
  SceneClock clock = ClockAt("2026-06-21T23:30:00Z");
  clock.Type("2026-01-02T03:04:05Z", kZurich, "Europe/Zurich");
  EXPECT_EQ(Shows(clock), "2026-01-02T03:04:05Z");
  clock.Type("2026-07-02T03:04:05", kZurich, "Europe/Zurich");
  EXPECT_EQ(Shows(clock), "2026-07-02T01:04:05Z") << "summer time";
  clock.Type("18:30", kZurich, "Europe/Zurich");
  EXPECT_EQ(Shows(clock), "2026-07-02T16:30:00Z") << "of the same day";
  clock.Type("06:07:08", kZurich, "Asia/Tokyo");
  EXPECT_EQ(Shows(clock), "2026-07-02T21:07:08Z") << "at 16:30 UTC Tokyo already has the 3rd";
  clock.Type("sunset-20m", kZurich, "Europe/Zurich");
  const UtcTime sunset = *FindSunEvent(SunEvent::kSunset, kZurich, clock.now());
  EXPECT_NEAR(SecondsBetween(clock.now(), sunset), 1200.0, 0.2);
  EXPECT_THROW(clock.Type("25:00", kZurich, "Europe/Zurich"), InputError);
  EXPECT_THROW(clock.Type("sunsat", kZurich, "Europe/Zurich"), InputError);
  EXPECT_THROW(clock.Type("", kZurich, "Europe/Zurich"), InputError);
}

// --- flights that are read ---

constexpr double kSpeed_deg_per_s = 1e-4;
const UtcTime kStart = ParseInstant("2026-06-21T04:00:00Z");

/// Northwards, a frame of a sixtieth of a second after the other.
void Fly(FlightLog& log, double begin_s, int frames) {
  for (int frame = 0; frame < frames; ++frame) {
    const double seconds = begin_s + frame / 60.0;
    log.Record(seconds, {CheckedPlace({46.0 + kSpeed_deg_per_s * seconds, 8.0, 3000.0})},
               AddSeconds(kStart, 60.0 * seconds));
  }
}

TEST(FlightLog, CoversTheFlightFromFirstToLastFrame) {
  FlightLog log;
  Fly(log, 5.0, 101);
  const CameraPath path = log.Path();
  EXPECT_EQ(path.begin_s(), 0.0);
  EXPECT_NEAR(path.end_s(), 100.0 / 60.0, 1e-9)
      << "the last frame too, though 1/60 s after another";
  EXPECT_NEAR(path.PoseAt(1.0).place.latitude_rad(),
              (46.0 + kSpeed_deg_per_s * 6.0) * kRadiansPerDegree, 1e-12);
  EXPECT_NEAR(SecondsBetween(kStart, *path.UtcAt(1.0)), 360.0, 1e-3);
}

TEST(FlightLog, LongFlightIsCompleteWithABoundedNumberOfPoints) {
  constexpr std::size_t kMost = 64;
  FlightLog log(kMost);
  Fly(log, 0.0, 6001);
  const CameraPath path = log.Path();
  EXPECT_LE(path.points().size(), kMost + 1) << "and the last one";
  EXPECT_GT(path.points().size(), kMost / 2 - 1);
  EXPECT_NEAR(path.end_s(), 100.0, 1e-9);
  for (const double at_s : {0.0, 13.0, 50.0, 99.0}) {
    EXPECT_NEAR(path.PoseAt(at_s).place.latitude_deg, 46.0 + kSpeed_deg_per_s * at_s, 1e-9)
        << "an even flight is between its points where it was";
  }
}

TEST(FlightLog, RecordsNothingWhileTheEyeStands) {
  FlightLog log;
  EXPECT_THROW((void)log.Path(), InputError);
  for (int frame = 0; frame < 100; ++frame)
    log.Record(frame / 60.0, {Place{46.0, 8.0, 3000.0}}, AddSeconds(kStart, frame));
  EXPECT_THROW((void)log.Path(), InputError);
  Fly(log, 2.0, 2);
  EXPECT_NO_THROW((void)log.Path());
}

// --- flights that are recorded ---

class FlightRecords : public TemporaryFolder {
 protected:
  [[nodiscard]] fs::path File() const { return folder_ / "f.csv"; }
  [[nodiscard]] fs::path Part() const { return folder_ / "f.csv.part"; }

  /// Northwards, 3000 m high, a frame of a sixtieth of a second after the other.
  static void Fly(FlightRecorder& recorder, int frames) {
    const UtcTime start = ParseInstant("2026-06-21T04:00:00Z");
    for (int frame = 0; frame < frames; ++frame) {
      const double seconds = frame / 60.0;
      const CameraPose eye{CheckedPlace({46.0 + 1e-4 * seconds, 8.0, 3000.0})};
      recorder.Record(seconds, eye, AddSeconds(start, 60.0 * seconds));
    }
  }
};

TEST_F(FlightRecords, AreWrittenToDiskDuringTheFlight) {
  FlightRecorder recorder(File());
  Fly(recorder, 61);
  const CameraPath flown = ReadFlight(Part());
  EXPECT_NEAR(flown.end_s(), 1.0, 0.05) << "a line is never later than the frame";
  EXPECT_FALSE(fs::exists(File())) << "not under its name before it is whole";
  recorder.Finish();
  EXPECT_FALSE(fs::exists(Part()));
  const CameraPath whole = ReadFlight(File());
  EXPECT_EQ(whole.points().size(), flown.points().size());
  EXPECT_NEAR(SecondsBetween(*whole.UtcAt(0.0), *whole.UtcAt(1.0)), 60.0, 0.1)
      << "a minute of the scene in a second of the pilot";
}

TEST_F(FlightRecords, DestructorOfTheRecorderFinishesTheFile) {
  {
    FlightRecorder recorder(File());
    Fly(recorder, 10);
  }
  EXPECT_EQ(ReadFlight(File()).points().size(), 4U) << "every third sixtieth of a second";
}

TEST_F(FlightRecords, RecorderWithoutAFileWritesNothing) {
  FlightRecorder recorder;
  Fly(recorder, 10);
  recorder.Finish();
  EXPECT_EQ(FileCount(), 0U);
}

TEST_F(FlightRecords, LinesBeforeATruncatedLineAreReplayed) {
  {
    FlightRecorder recorder(File());
    Fly(recorder, 31);
  }
  const std::string text = ContentOf(File());
  WriteText(Part(), text.substr(0, text.size() - 20));
  const CameraPath cut = ReadFlight(Part());
  EXPECT_EQ(cut.points().size() + 1, ReadFlight(File()).points().size());
  // After a loss of power the file can have grown while its bytes are still zero.
  WriteText(Part(), text + std::string(4000, '\0'));
  EXPECT_EQ(ReadFlight(Part()).points().size(), ReadFlight(File()).points().size());
  // Under its own name a half line is a fault.
  WriteText(File(), text.substr(0, text.size() - 20));
  EXPECT_THROW((void)ReadFlight(File()), InputError);
}

TEST_F(FlightRecords, AMissingFileIsReadFromItsUnfinishedPart) {
  WriteText(Part(), "t_s,latitude,longitude,height_m,heading\n0,46.5,8,3000,350\n");
  try {
    (void)ReadFlight(File());
    ADD_FAILURE() << "there is no such file";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("f.csv.part"));
  }
}

TEST_F(FlightRecords, AFullDiskIsReportedAtTheEndOfTheFlight) {
  const pid_t child = fork();
  if (child == 0) {
    const rlimit limit{1000, 1000};  // bytes of a file
    setrlimit(RLIMIT_FSIZE, &limit);
    std::signal(SIGXFSZ, SIG_IGN);
    FlightRecorder recorder(File());
    Fly(recorder, 600);
    try {
      recorder.Finish();
    } catch (const OutputError&) {
      _exit(4);
    }
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 4);
  EXPECT_GT(ReadFlight(Part()).points().size(), 4U) << "what fitted";
  EXPECT_FALSE(fs::exists(File()));
}

}  // namespace
}  // namespace alpenglow::viewer
