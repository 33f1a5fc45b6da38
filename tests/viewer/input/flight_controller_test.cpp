// SPDX-License-Identifier: MIT
#include "viewer/input/flight_controller.h"

#include <gtest/gtest.h>

#include "atmosphere/math/constants.h"
#include "tests/viewer/input/hands.h"
#include "tests/viewer/input/recorded_commands.h"

namespace alpenglow::viewer {
namespace {

using tests::Hands;
using tests::RecordedCommands;

double FlightControllerSea(const GeodeticPosition&) { return 0.0; }
double Airport(const GeodeticPosition&) { return 423.0; }

FlightController NewFlightController(const GroundHeight& ground = FlightControllerSea) {
  return {
      {PlaceFromDegrees(47.0, 8.0, 1500.0)}, kWgs84, ParseInstant("2026-06-21T12:00:00Z"), ground};
}
std::string Shows(const FlightController& cockpit) { return FormatUtc(cockpit.clock().now()); }

TEST(FlightController, KeysChangeFlightAndTime) {
  RecordedCommands flight;
  EXPECT_EQ(flight.Press("T"), "time x10");
  EXPECT_EQ(flight.Press("Shift+]"), "");
  EXPECT_EQ(Shows(flight.cockpit()), "2026-06-21T13:00:00Z");
  EXPECT_EQ(flight.Press("F7"), "sunset");
  EXPECT_EQ(Shows(flight.cockpit()).substr(0, 13), "2026-06-21T19");
  EXPECT_EQ(flight.Press("F9"), "moonrise");
  EXPECT_EQ(flight.Press("3"), "there is no track to follow");
}

TEST(FlightController, GoesAroundTheModesThatThereAre) {
  FlightController cockpit = NewFlightController();
  EXPECT_EQ(cockpit.EnterNext(1), "aircraft");
  EXPECT_EQ(cockpit.EnterNext(1), "free camera");
  EXPECT_EQ(cockpit.EnterNext(-1), "aircraft");
  EXPECT_EQ(cockpit.ToggleHold(Autopilot::Hold::kHeading), "HDG 000");
  EXPECT_EQ(cockpit.ReleaseAutopilot(), "autopilot off");
  EXPECT_EQ(cockpit.Enter(FlightMode::kFree), "free camera");
}

TEST(FlightController, PausedTimeAndAircraftStandAndTheFreeCameraFlies) {
  RecordedCommands flight;
  FlightController& cockpit = flight.cockpit();
  EXPECT_EQ(flight.Press("P"), "paused");
  const double latitude = cockpit.pilot().eye().place.latitude_rad;
  cockpit.Advance({.camera = {.forward = 1.0}}, 1.0);
  EXPECT_GT(cockpit.pilot().eye().place.latitude_rad, latitude);
  cockpit.Enter(FlightMode::kAircraft);
  const double stands = cockpit.pilot().eye().place.latitude_rad;
  cockpit.Advance({.look_right = 0.1}, 1.0);
  EXPECT_EQ(cockpit.pilot().eye().place.latitude_rad, stands);
  EXPECT_GT(cockpit.pilot().eye().heading_rad, 0.05) << "one can look around";
  EXPECT_EQ(Shows(cockpit), "2026-06-21T12:00:00Z");
}

TEST(FlightController, AFlightAtFourTimesItsSpeedTakesTheClockAlong) {
  FlightController cockpit = NewFlightController();
  cockpit.Enter(FlightMode::kAircraft);
  EXPECT_EQ(cockpit.StepSpeed(1), "speed x2");
  EXPECT_EQ(cockpit.StepSpeed(1), "speed x4");
  cockpit.Advance({}, 2.5);
  EXPECT_EQ(Shows(cockpit), "2026-06-21T12:00:10Z");
}

TEST(FlightController, FliesToPlacesByName) {
  FlightController cockpit = NewFlightController();
  cockpit.GoTo(PlaceNamed("Matterhorn"));
  EXPECT_EQ(cockpit.pilot().eye().place.height_m, 100.0) << "over the ground that is there";
  FlightController at_airport = NewFlightController(Airport);
  at_airport.Enter(FlightMode::kAircraft);
  at_airport.GoTo(PlaceNamed("LSZH"));
  const FlightReadout readout = at_airport.pilot().Readout(Airport);
  EXPECT_EQ(readout.aircraft->contact, GroundContact::kStanding);
  EXPECT_NEAR(readout.aircraft->heading_rad / kRadiansPerDegree, 155.0, 1e-6);
}

TEST(FlightController, AMinuteOfFlyingByKeysTakesOffTurnsAndClimbs) {
  RecordedCommands flight(Airport);
  FlightController& cockpit = flight.cockpit();
  Hands hands;
  cockpit.GoTo(PlaceNamed("LSZH"));
  const auto fly = [&](double seconds) {
    for (double t = 0.0; t < seconds; t += 1.0 / 30.0) {
      const Intent intent = hands.Take(cockpit.pilot().mode(), 1.0 / 30.0);
      for (const Action* action : intent.actions) action->run(flight);
      cockpit.Advance(intent.pilot, 1.0 / 30.0);
    }
  };
  const auto hold = [&](const char* key, double seconds) {
    hands.Key(KeyChordFromText(key).key, 1, 0);
    fly(seconds);
    hands.Key(KeyChordFromText(key).key, 0, 0);
  };
  hold("2", 0.1);
  hold("Page Up", 25.0);
  hold("Down", 0.8);
  fly(25.0);
  const FlightReadout climbing = cockpit.pilot().Readout(Airport);
  EXPECT_EQ(climbing.aircraft->contact, GroundContact::kNone);
  EXPECT_GT(climbing.above_ground_m, 50.0);
  EXPECT_FALSE(climbing.aircraft->stalled);
  ASSERT_TRUE(climbing.course);
  EXPECT_NEAR(climbing.course->heading_rad / kRadiansPerDegree, 155.0, 2.0);
  hold("Left", 0.6);
  fly(10.0);
  const FlightReadout turning = cockpit.pilot().Readout(Airport);
  EXPECT_LT(turning.aircraft->bank_rad, -10.0 * kRadiansPerDegree) << "held after the key is up";
  EXPECT_LT(turning.course->heading_rad, climbing.course->heading_rad - 0.2);
}

TEST(FlightController, ALongFrameIsNotCutShort) {
  FlightController cockpit = NewFlightController();
  cockpit.Advance({}, 7.0);
  EXPECT_EQ(Shows(cockpit), "2026-06-21T12:00:07Z");
}

/// 10 s of the pilot that were an hour of the scene, with a narrow view.
std::shared_ptr<const CameraPath> AnHour() {
  CameraPose begin{PlaceFromDegrees(46.0, 8.0, 1000.0)}, end{PlaceFromDegrees(46.1, 8.0, 2000.0)};
  begin.fov_rad = end.fov_rad = 0.3;
  return std::make_shared<CameraPath>(
      std::vector<CameraPathPoint>{{0.0, begin, ParseInstant("2025-01-02T08:00:00Z")},
                                   {10.0, end, ParseInstant("2025-01-02T09:00:00Z")}});
}

TEST(FlightController, AReplayHasItsOwnTimeAndViewAndGivesTheControlsBackAtItsEnd) {
  FlightController cockpit = NewFlightController();
  cockpit.clock().Pause(!cockpit.clock().paused());
  cockpit.Replay(AnHour());
  cockpit.Advance({}, 5.0);
  EXPECT_EQ(Shows(cockpit), "2025-01-02T08:30:00Z") << "as fast as it went then";
  EXPECT_EQ(cockpit.pilot().eye().fov_rad, 0.3);
  EXPECT_EQ(cockpit.pilot().mode(), FlightMode::kTrack);
  cockpit.SkipTrack(-10.0);
  EXPECT_EQ(Shows(cockpit), "2025-01-02T08:00:00Z");
  cockpit.clock().Pause(!cockpit.clock().paused());
  cockpit.Advance({}, 5.0);
  EXPECT_EQ(Shows(cockpit), "2025-01-02T08:00:00Z") << "paused it stands";
  cockpit.clock().Pause(!cockpit.clock().paused());
  cockpit.Advance({}, 11.0);
  EXPECT_EQ(cockpit.pilot().mode(), FlightMode::kFree);
  EXPECT_NEAR(cockpit.pilot().eye().place.height_m, 2000.0, 1e-6);
  EXPECT_EQ(Shows(cockpit), "2025-01-02T09:00:00Z");
  cockpit.Advance({}, 1.0);
  EXPECT_EQ(Shows(cockpit), "2025-01-02T09:00:01Z") << "real time again";
}

TEST(FlightController, WhatIsFlownAgainEndsInTheFlightThatGoesOn) {
  FlightController cockpit = NewFlightController();
  cockpit.Enter(FlightMode::kAircraft);
  cockpit.ToggleHold(Autopilot::Hold::kHeading);
  cockpit.Advance({.stick = {.roll_right = 1.0}}, 3.0);
  const FlightReadout flown = cockpit.pilot().Readout(FlightControllerSea);
  for (int time = 0; time < 2; ++time) {  // asked for in the middle, it begins again
    cockpit.FlyAgain(AnHour());
    EXPECT_TRUE(cockpit.pilot().Replays());
    cockpit.Advance({}, 5.0);
  }
  EXPECT_TRUE(cockpit.pilot().Replays());
  cockpit.Advance({}, 5.0);
  EXPECT_EQ(cockpit.pilot().mode(), FlightMode::kAircraft);
  const FlightReadout on = cockpit.pilot().Readout(FlightControllerSea);
  EXPECT_EQ(on.aircraft->bank_rad, flown.aircraft->bank_rad);
  EXPECT_EQ(on.above_ground_m, flown.above_ground_m);
  EXPECT_EQ(on.autopilot, flown.autopilot);
}

TEST(FlightController, ATrackWithInstantsSetsTheClockAndSkippingTakesItAlong) {
  FlightController cockpit = NewFlightController();
  cockpit.pilot().SetTrack(std::make_shared<CameraPath>(std::vector<CameraPathPoint>{
      {0.0, {PlaceFromDegrees(46.0, 8.0, 1000.0)}, ParseInstant("2025-01-02T08:00:00Z")},
      {100.0, {PlaceFromDegrees(46.1, 8.0, 2000.0)}, ParseInstant("2025-01-02T08:01:40Z")}}));
  EXPECT_EQ(cockpit.Enter(FlightMode::kTrack), "track");
  EXPECT_EQ(Shows(cockpit), "2025-01-02T08:00:00Z");
  cockpit.Advance({}, 5.0);
  cockpit.SkipTrack(10.0);
  EXPECT_EQ(Shows(cockpit), "2025-01-02T08:00:15Z");
}

}  // namespace
}  // namespace alpenglow::viewer
