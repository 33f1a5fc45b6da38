// SPDX-License-Identifier: MIT
#include "viewer/input/cockpit.h"

#include <gtest/gtest.h>

#include "atmosphere/math/constants.h"
#include "viewer/input/controls.h"

namespace alpenglow::viewer {
namespace {

double CockpitSea(const GeodeticPosition&) { return 0.0; }

Cockpit NewCockpit() {
  return {{PlaceFromDegrees(47.0, 8.0, 1500.0)}, kWgs84, ParseInstant("2026-06-21T12:00:00Z")};
}
std::string Shows(const Cockpit& cockpit) { return FormatUtc(cockpit.clock().now()); }

TEST(Cockpit, DoesWhatIsOfFlightAndTimeAndLeavesTheRestToOthers) {
  Cockpit cockpit = NewCockpit();
  EXPECT_EQ(cockpit.Do(Action::kFasterTime, CockpitSea), "time x10");
  EXPECT_EQ(cockpit.Do(Action::kLaterHour, CockpitSea), "");
  EXPECT_EQ(Shows(cockpit), "2026-06-21T13:00:00Z");
  EXPECT_EQ(cockpit.Do(Action::kToSunset, CockpitSea), "sunset");
  EXPECT_EQ(Shows(cockpit).substr(0, 13), "2026-06-21T19");
  EXPECT_EQ(cockpit.Do(Action::kToMoonrise, CockpitSea), "no moonrise here within a year");
  EXPECT_EQ(cockpit.Do(Action::kTrackMode, CockpitSea), "there is no track to follow");
  EXPECT_EQ(cockpit.Do(Action::kScreenshot, CockpitSea), std::nullopt);
  EXPECT_EQ(cockpit.Do(Action::kHud, CockpitSea), std::nullopt);
  EXPECT_EQ(cockpit.Do(Action::kForward, CockpitSea), std::nullopt) << "held keys are controls";
}

TEST(Cockpit, GoesAroundTheModesThatThereAre) {
  Cockpit cockpit = NewCockpit();
  EXPECT_EQ(cockpit.Do(Action::kNextMode, CockpitSea), "aircraft");
  EXPECT_EQ(cockpit.Do(Action::kNextMode, CockpitSea), "free camera");
  EXPECT_EQ(cockpit.Do(Action::kPreviousMode, CockpitSea), "aircraft");
  EXPECT_EQ(cockpit.Do(Action::kHoldHeading, CockpitSea), "HDG 000");
  EXPECT_EQ(cockpit.Do(Action::kAutopilotOff, CockpitSea), "autopilot off");
  EXPECT_EQ(cockpit.Do(Action::kFreeMode, CockpitSea), "free camera");
}

TEST(Cockpit, PausedTimeAndAircraftStandAndTheFreeCameraFlies) {
  Cockpit cockpit = NewCockpit();
  EXPECT_EQ(cockpit.Do(Action::kPause, CockpitSea), "paused");
  const double latitude = cockpit.pilot().eye().place.latitude_rad;
  cockpit.Advance({.camera = {.forward = 1.0}}, 1.0, CockpitSea);
  EXPECT_GT(cockpit.pilot().eye().place.latitude_rad, latitude);
  static_cast<void>(cockpit.Do(Action::kAircraftMode, CockpitSea));
  const double stands = cockpit.pilot().eye().place.latitude_rad;
  cockpit.Advance({.look_right = 0.1}, 1.0, CockpitSea);
  EXPECT_EQ(cockpit.pilot().eye().place.latitude_rad, stands);
  EXPECT_GT(cockpit.pilot().eye().heading_rad, 0.05) << "one can look around";
  EXPECT_EQ(Shows(cockpit), "2026-06-21T12:00:00Z");
}

TEST(Cockpit, AFlightAtFourTimesItsSpeedTakesTheClockAlong) {
  Cockpit cockpit = NewCockpit();
  static_cast<void>(cockpit.Do(Action::kAircraftMode, CockpitSea));
  EXPECT_EQ(cockpit.Do(Action::kFasterFlight, CockpitSea), "speed x2");
  EXPECT_EQ(cockpit.Do(Action::kFasterFlight, CockpitSea), "speed x4");
  cockpit.Advance({}, 2.5, CockpitSea);
  EXPECT_EQ(Shows(cockpit), "2026-06-21T12:00:10Z");
}

TEST(Cockpit, FliesToPlacesByName) {
  Cockpit cockpit = NewCockpit();
  cockpit.GoTo(PlaceNamed("Matterhorn"), CockpitSea);
  EXPECT_EQ(cockpit.pilot().eye().place.height_m, 100.0) << "over the ground that is there";
  static_cast<void>(cockpit.Do(Action::kAircraftMode, CockpitSea));
  const GroundHeight airport = [](const GeodeticPosition&) { return 423.0; };
  cockpit.GoTo(PlaceNamed("LSZH"), airport);
  const FlightReadout readout = cockpit.pilot().Readout(airport);
  EXPECT_EQ(readout.aircraft->contact, GroundContact::kStanding);
  EXPECT_NEAR(readout.aircraft->heading_rad / kRadiansPerDegree, 155.0, 1e-6);
}

TEST(Cockpit, AMinuteOfFlyingByKeysTakesOffTurnsAndClimbs) {
  Cockpit cockpit = NewCockpit();
  Controls controls;
  const GroundHeight airport = [](const GeodeticPosition&) { return 423.0; };
  cockpit.GoTo(PlaceNamed("LSZH"), airport);
  const auto fly = [&](double seconds) {
    for (double t = 0.0; t < seconds; t += 1.0 / 30.0) {
      const Intent intent = controls.Take(cockpit.pilot().mode(), 1.0 / 30.0);
      for (const Action action : intent.actions) {
        EXPECT_TRUE(cockpit.Do(action, airport));
      }
      cockpit.Advance(intent.pilot, 1.0 / 30.0, airport);
    }
  };
  const auto hold = [&](const char* key, double seconds) {
    controls.Key(KeyChordFromText(key).key, 1, 0);
    fly(seconds);
    controls.Key(KeyChordFromText(key).key, 0, 0);
  };
  hold("2", 0.1);
  hold("Page Up", 25.0);
  hold("Down", 0.8);
  fly(25.0);
  const FlightReadout climbing = cockpit.pilot().Readout(airport);
  EXPECT_EQ(climbing.aircraft->contact, GroundContact::kNone);
  EXPECT_GT(climbing.above_ground_m, 50.0);
  EXPECT_FALSE(climbing.aircraft->stalled);
  ASSERT_TRUE(climbing.course);
  EXPECT_NEAR(climbing.course->heading_rad / kRadiansPerDegree, 155.0, 2.0);
  hold("Left", 0.6);
  fly(10.0);
  const FlightReadout turning = cockpit.pilot().Readout(airport);
  EXPECT_LT(turning.aircraft->bank_rad, -10.0 * kRadiansPerDegree) << "held after the key is up";
  EXPECT_LT(turning.course->heading_rad, climbing.course->heading_rad - 0.2);
}

TEST(Cockpit, ALongFrameIsNotCutShort) {
  Cockpit cockpit = NewCockpit();
  cockpit.Advance({}, 7.0, CockpitSea);
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

TEST(Cockpit, AReplayHasItsOwnTimeAndViewAndGivesTheControlsBackAtItsEnd) {
  Cockpit cockpit = NewCockpit();
  static_cast<void>(cockpit.Do(Action::kPause, CockpitSea));
  cockpit.Replay(AnHour(), CockpitSea);
  cockpit.Advance({}, 5.0, CockpitSea);
  EXPECT_EQ(Shows(cockpit), "2025-01-02T08:30:00Z") << "as fast as it went then";
  EXPECT_EQ(cockpit.pilot().eye().fov_rad, 0.3);
  EXPECT_EQ(cockpit.pilot().mode(), FlightMode::kTrack);
  static_cast<void>(cockpit.Do(Action::kTrackBack, CockpitSea));
  EXPECT_EQ(Shows(cockpit), "2025-01-02T08:00:00Z");
  static_cast<void>(cockpit.Do(Action::kPause, CockpitSea));
  cockpit.Advance({}, 5.0, CockpitSea);
  EXPECT_EQ(Shows(cockpit), "2025-01-02T08:00:00Z") << "paused it stands";
  static_cast<void>(cockpit.Do(Action::kPause, CockpitSea));
  cockpit.Advance({}, 11.0, CockpitSea);
  EXPECT_EQ(cockpit.pilot().mode(), FlightMode::kFree);
  EXPECT_NEAR(cockpit.pilot().eye().place.height_m, 2000.0, 1e-6);
  EXPECT_EQ(Shows(cockpit), "2025-01-02T09:00:00Z");
  cockpit.Advance({}, 1.0, CockpitSea);
  EXPECT_EQ(Shows(cockpit), "2025-01-02T09:00:01Z") << "real time again";
}

TEST(Cockpit, WhatIsFlownAgainEndsInTheFlightThatGoesOn) {
  Cockpit cockpit = NewCockpit();
  static_cast<void>(cockpit.Do(Action::kAircraftMode, CockpitSea));
  static_cast<void>(cockpit.Do(Action::kHoldHeading, CockpitSea));
  cockpit.Advance({.stick = {.roll_right = 1.0}}, 3.0, CockpitSea);
  const FlightReadout flown = cockpit.pilot().Readout(CockpitSea);
  for (int time = 0; time < 2; ++time) {  // asked for in the middle, it begins again
    cockpit.FlyAgain(AnHour(), CockpitSea);
    EXPECT_TRUE(cockpit.pilot().Replays());
    cockpit.Advance({}, 5.0, CockpitSea);
  }
  EXPECT_TRUE(cockpit.pilot().Replays());
  cockpit.Advance({}, 5.0, CockpitSea);
  EXPECT_EQ(cockpit.pilot().mode(), FlightMode::kAircraft);
  const FlightReadout on = cockpit.pilot().Readout(CockpitSea);
  EXPECT_EQ(on.aircraft->bank_rad, flown.aircraft->bank_rad);
  EXPECT_EQ(on.above_ground_m, flown.above_ground_m);
  EXPECT_EQ(on.autopilot, flown.autopilot);
}

TEST(Cockpit, ATrackWithInstantsSetsTheClockAndSkippingTakesItAlong) {
  Cockpit cockpit = NewCockpit();
  cockpit.pilot().SetTrack(std::make_shared<CameraPath>(std::vector<CameraPathPoint>{
      {0.0, {PlaceFromDegrees(46.0, 8.0, 1000.0)}, ParseInstant("2025-01-02T08:00:00Z")},
      {100.0, {PlaceFromDegrees(46.1, 8.0, 2000.0)}, ParseInstant("2025-01-02T08:01:40Z")}}));
  EXPECT_EQ(cockpit.Do(Action::kTrackMode, CockpitSea), "track");
  EXPECT_EQ(Shows(cockpit), "2025-01-02T08:00:00Z");
  cockpit.Advance({}, 5.0, CockpitSea);
  static_cast<void>(cockpit.Do(Action::kTrackAhead, CockpitSea));
  EXPECT_EQ(Shows(cockpit), "2025-01-02T08:00:15Z");
}

}  // namespace
}  // namespace alpenglow::viewer
