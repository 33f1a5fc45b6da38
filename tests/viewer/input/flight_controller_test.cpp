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
std::string Shows(const FlightController& controller) {
  return FormatUtc(controller.clock().now());
}

TEST(FlightController, KeysChangeFlightAndTime) {
  RecordedCommands flight;
  EXPECT_EQ(flight.Press("T"), "time x10");
  EXPECT_EQ(flight.Press("Shift+]"), "");
  EXPECT_EQ(Shows(flight.controller()), "2026-06-21T13:00:00Z");
  EXPECT_EQ(flight.Press("F7"), "sunset");
  EXPECT_EQ(Shows(flight.controller()).substr(0, 13), "2026-06-21T19");
  EXPECT_EQ(flight.Press("F9"), "moonrise");
  EXPECT_EQ(flight.Press("3"), "there is no track to follow");
}

TEST(FlightController, GoesAroundTheModesThatThereAre) {
  FlightController controller = NewFlightController();
  EXPECT_EQ(controller.EnterNext(1), "aircraft");
  EXPECT_EQ(controller.EnterNext(1), "free camera");
  EXPECT_EQ(controller.EnterNext(-1), "aircraft");
  EXPECT_EQ(controller.ToggleHold(Autopilot::Hold::kHeading), "HDG 000");
  EXPECT_EQ(controller.ReleaseAutopilot(), "autopilot off");
  EXPECT_EQ(controller.Enter(FlightMode::kFree), "free camera");
}

TEST(FlightController, PausedTimeAndAircraftStandAndTheFreeCameraFlies) {
  RecordedCommands flight;
  FlightController& controller = flight.controller();
  EXPECT_EQ(flight.Press("P"), "paused");
  const double latitude = controller.pilot().eye().place.latitude_rad;
  controller.Advance({.camera = {.forward = 1.0}}, 1.0);
  EXPECT_GT(controller.pilot().eye().place.latitude_rad, latitude);
  controller.Enter(FlightMode::kAircraft);
  const double stands = controller.pilot().eye().place.latitude_rad;
  controller.Advance({.look_right = 0.1}, 1.0);
  EXPECT_EQ(controller.pilot().eye().place.latitude_rad, stands);
  EXPECT_GT(controller.pilot().eye().heading_rad, 0.05) << "one can look around";
  EXPECT_EQ(Shows(controller), "2026-06-21T12:00:00Z");
}

TEST(FlightController, AFlightAtFourTimesItsSpeedTakesTheClockAlong) {
  FlightController controller = NewFlightController();
  controller.Enter(FlightMode::kAircraft);
  EXPECT_EQ(controller.StepSpeed(1), "speed x2");
  EXPECT_EQ(controller.StepSpeed(1), "speed x4");
  controller.Advance({}, 2.5);
  EXPECT_EQ(Shows(controller), "2026-06-21T12:00:10Z");
}

TEST(FlightController, FliesToPlacesByName) {
  FlightController controller = NewFlightController();
  controller.GoTo(PlaceNamed("Matterhorn"));
  EXPECT_EQ(controller.pilot().eye().place.height_m, 100.0) << "over the ground that is there";
  FlightController at_airport = NewFlightController(Airport);
  at_airport.Enter(FlightMode::kAircraft);
  at_airport.GoTo(PlaceNamed("LSZH"));
  const FlightReadout readout = at_airport.pilot().Readout(Airport);
  EXPECT_EQ(readout.aircraft->contact, GroundContact::kStanding);
  EXPECT_NEAR(readout.aircraft->heading_rad / kRadiansPerDegree, 155.0, 1e-6);
}

TEST(FlightController, AMinuteOfFlyingByKeysTakesOffTurnsAndClimbs) {
  RecordedCommands flight(Airport);
  FlightController& controller = flight.controller();
  Hands hands;
  controller.GoTo(PlaceNamed("LSZH"));
  const auto fly = [&](double seconds) {
    for (double t = 0.0; t < seconds; t += 1.0 / 30.0) {
      const Intent intent = hands.Take(controller.pilot().mode(), 1.0 / 30.0);
      for (const Action* action : intent.actions) action->run(flight);
      controller.Advance(intent.pilot, 1.0 / 30.0);
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
  const FlightReadout climbing = controller.pilot().Readout(Airport);
  EXPECT_EQ(climbing.aircraft->contact, GroundContact::kNone);
  EXPECT_GT(climbing.above_ground_m, 50.0);
  EXPECT_FALSE(climbing.aircraft->stalled);
  ASSERT_TRUE(climbing.course);
  EXPECT_NEAR(climbing.course->heading_rad / kRadiansPerDegree, 155.0, 2.0);
  hold("Left", 0.6);
  fly(10.0);
  const FlightReadout turning = controller.pilot().Readout(Airport);
  EXPECT_LT(turning.aircraft->bank_rad, -10.0 * kRadiansPerDegree) << "held after the key is up";
  EXPECT_LT(turning.course->heading_rad, climbing.course->heading_rad - 0.2);
}

TEST(FlightController, ALongFrameIsNotCutShort) {
  FlightController controller = NewFlightController();
  controller.Advance({}, 7.0);
  EXPECT_EQ(Shows(controller), "2026-06-21T12:00:07Z");
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
  FlightController controller = NewFlightController();
  controller.clock().Pause(!controller.clock().paused());
  controller.Replay(AnHour());
  controller.Advance({}, 5.0);
  EXPECT_EQ(Shows(controller), "2025-01-02T08:30:00Z") << "as fast as it went then";
  EXPECT_EQ(controller.pilot().eye().fov_rad, 0.3);
  EXPECT_EQ(controller.pilot().mode(), FlightMode::kTrack);
  controller.SkipTrack(-10.0);
  EXPECT_EQ(Shows(controller), "2025-01-02T08:00:00Z");
  controller.clock().Pause(!controller.clock().paused());
  controller.Advance({}, 5.0);
  EXPECT_EQ(Shows(controller), "2025-01-02T08:00:00Z") << "paused it stands";
  controller.clock().Pause(!controller.clock().paused());
  controller.Advance({}, 11.0);
  EXPECT_EQ(controller.pilot().mode(), FlightMode::kFree);
  EXPECT_NEAR(controller.pilot().eye().place.height_m, 2000.0, 1e-6);
  EXPECT_EQ(Shows(controller), "2025-01-02T09:00:00Z");
  controller.Advance({}, 1.0);
  EXPECT_EQ(Shows(controller), "2025-01-02T09:00:01Z") << "real time again";
}

TEST(FlightController, WhatIsFlownAgainEndsInTheFlightThatGoesOn) {
  FlightController controller = NewFlightController();
  controller.Enter(FlightMode::kAircraft);
  controller.ToggleHold(Autopilot::Hold::kHeading);
  controller.Advance({.stick = {.roll_right = 1.0}}, 3.0);
  const FlightReadout flown = controller.pilot().Readout(FlightControllerSea);
  for (int time = 0; time < 2; ++time) {  // asked for in the middle, it begins again
    controller.FlyAgain(AnHour());
    EXPECT_TRUE(controller.pilot().Replays());
    controller.Advance({}, 5.0);
  }
  EXPECT_TRUE(controller.pilot().Replays());
  controller.Advance({}, 5.0);
  EXPECT_EQ(controller.pilot().mode(), FlightMode::kAircraft);
  const FlightReadout on = controller.pilot().Readout(FlightControllerSea);
  EXPECT_EQ(on.aircraft->bank_rad, flown.aircraft->bank_rad);
  EXPECT_EQ(on.above_ground_m, flown.above_ground_m);
  EXPECT_EQ(on.autopilot, flown.autopilot);
}

TEST(FlightController, ATrackWithInstantsSetsTheClockAndSkippingTakesItAlong) {
  FlightController controller = NewFlightController();
  controller.pilot().SetTrack(std::make_shared<CameraPath>(std::vector<CameraPathPoint>{
      {0.0, {PlaceFromDegrees(46.0, 8.0, 1000.0)}, ParseInstant("2025-01-02T08:00:00Z")},
      {100.0, {PlaceFromDegrees(46.1, 8.0, 2000.0)}, ParseInstant("2025-01-02T08:01:40Z")}}));
  EXPECT_EQ(controller.Enter(FlightMode::kTrack), "track");
  EXPECT_EQ(Shows(controller), "2025-01-02T08:00:00Z");
  controller.Advance({}, 5.0);
  controller.SkipTrack(10.0);
  EXPECT_EQ(Shows(controller), "2025-01-02T08:00:15Z");
}

}  // namespace
}  // namespace alpenglow::viewer
