// SPDX-License-Identifier: MIT
#include "viewer/flight/pilot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/math/constants.h"

namespace alpenglow::viewer {
namespace {

double Sea(const GeodeticPosition&) { return 0.0; }

CameraPose EyeAt(double height_m, double heading_deg = 0.0) {
  return {PlaceFromDegrees(46.0, 8.0, height_m), heading_deg * kRadiansPerDegree};
}
double Apart(const CameraPose& a, const CameraPose& b) {
  return glm::length((EcefFromGeodetic(kWgs84, a.place) - EcefFromGeodetic(kWgs84, b.place)).xyz);
}

/// The same controls for the same time, in frames of different lengths.
CameraPose FlownFor(FlightMode mode, const PilotControls& controls, double seconds,
                    double frame_s) {
  Pilot pilot(EyeAt(1500.0), kWgs84);
  EXPECT_FALSE(pilot.Enter(mode, Sea));
  const int frames = static_cast<int>(std::lround(seconds / frame_s));
  for (int i = 0; i < frames; ++i) pilot.Advance(controls, frame_s, Sea);
  return pilot.eye();
}

TEST(Pilot, AFlightOfTheAircraftIsTheSameAtEveryFrameRate) {
  const PilotControls controls{.stick = {.pitch_up = 0.1, .roll_right = 0.05, .throttle_up = 0.1}};
  const CameraPose smooth = FlownFor(FlightMode::kAircraft, controls, 12.0, 1.0 / 240.0);
  for (const double frame_s : {1.0 / 60.0, 1.0 / 7.0, 0.75, 4.0, 12.0}) {
    const CameraPose flown = FlownFor(FlightMode::kAircraft, controls, 12.0, frame_s);
    EXPECT_LT(Apart(flown, smooth), 1e-3) << frame_s << " s a frame: the last step may be split";
    EXPECT_NEAR(flown.heading_rad, smooth.heading_rad, 1e-5) << frame_s;
  }
}

TEST(Pilot, AFlightOfTheFreeCameraIsWithinAPercentAtEveryFrameRate) {
  const PilotControls controls{.camera = {.forward = 1.0, .up = 0.5, .turn_right = 0.1}};
  const CameraPose smooth = FlownFor(FlightMode::kFree, controls, 4.0, 1.0 / 240.0);
  const double way = Apart(smooth, EyeAt(1500.0));
  for (const double frame_s : {1.0 / 60.0, 1.0 / 8.0, 0.5, 4.0}) {
    EXPECT_LT(Apart(FlownFor(FlightMode::kFree, controls, 4.0, frame_s), smooth), 0.01 * way)
        << frame_s;
  }
}

TEST(Pilot, TheAircraftMovesSmoothlyBetweenItsSteps) {
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

TEST(Pilot, TheFreeCameraIsNeverInTheGround) {
  const GroundHeight ridge = [](const GeodeticPosition& place) {
    return 1000.0 + 900.0 * std::sin(place.latitude_rad * 6e4);
  };
  Pilot pilot(EyeAt(2100.0), kWgs84);
  for (int i = 0; i < 100; ++i) {
    pilot.Advance({.camera = {.forward = 1.0, .up = -1.0}}, 0.1, ridge);
    EXPECT_GE(pilot.eye().place.height_m, ridge(pilot.eye().place) + 1.499);
  }
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

TEST(Pilot, NearTheGroundTheAircraftStandsOnItAndHighUpItIsAJet) {
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

TEST(Pilot, LookingAroundTurnsTheHeadAndNotTheAircraft) {
  Pilot pilot(EyeAt(1500.0), kWgs84);
  ASSERT_FALSE(pilot.Enter(FlightMode::kAircraft, Sea));
  pilot.Advance({.look_right = 0.5}, 1.0, Sea);
  EXPECT_NEAR(pilot.eye().heading_rad, 0.5 * pilot.eye().fov_rad, 1e-3);
  pilot.Advance({}, 10.0, Sea);
  EXPECT_NEAR(pilot.Readout(Sea).aircraft->heading_rad, 0.0, 1e-3);
  pilot.Centre(Sea);
  EXPECT_NEAR(pilot.eye().heading_rad, 0.0, 1e-3);
}

TEST(Pilot, AFlightThatIsFourTimesAsFastGoesFourTimesAsFar) {
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

TEST(Pilot, AThousandFeetHigherItFliesOnEvenFromTheGround) {
  Pilot pilot(EyeAt(2.0), kWgs84);
  ASSERT_FALSE(pilot.Enter(FlightMode::kAircraft, Sea));
  pilot.Lift(304.8, Sea);
  pilot.Advance({}, 10.0, Sea);
  EXPECT_NEAR(pilot.eye().place.height_m, 306.3, 5.0);
  EXPECT_NEAR(pilot.Readout(Sea).speed_m_per_s, CruiseSpeed(kLightAircraft, 306.0), 2.0);
}

std::shared_ptr<const CameraPath> TwoPoints() {
  return std::make_shared<CameraPath>(std::vector<CameraPathPoint>{
      {0.0, {PlaceFromDegrees(46.0, 8.0, 1000.0)}, ParseInstant("2026-06-21T04:00:00Z")},
      {100.0, {PlaceFromDegrees(46.1, 8.0, 2000.0)}, ParseInstant("2026-06-21T04:01:40Z")}});
}

TEST(Pilot, ATrackIsFollowedToItsEndAndKeepsTheFieldOfView) {
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

TEST(Pilot, AReplayIsSeenThroughItsOwnLens) {
  Pilot pilot(EyeAt(1500.0), kWgs84);
  CameraPose narrow{PlaceFromDegrees(46.0, 8.0, 1000.0)};
  narrow.fov_rad = 0.3;
  pilot.SetTrack(std::make_shared<CameraPath>(std::vector<CameraPathPoint>{{0.0, narrow}}),
                 Pilot::Lens::kOfTrack);
  ASSERT_FALSE(pilot.Enter(FlightMode::kTrack, Sea));
  EXPECT_EQ(pilot.eye().fov_rad, 0.3);
}

TEST(Pilot, WhereTerrainIsLoadedOverTheAircraftItFliesOnOverIt) {
  double ground_m = 0.0;
  const GroundHeight ground = [&](const GeodeticPosition&) { return ground_m; };
  Pilot pilot(EyeAt(800.0), kWgs84);
  ASSERT_FALSE(pilot.Enter(FlightMode::kAircraft, ground));
  ground_m = 2000.0;
  pilot.Advance({}, 1.0, ground);
  EXPECT_NEAR(pilot.eye().place.height_m, 2150.0, 5.0);
  EXPECT_EQ(pilot.Readout(ground).aircraft->contact, GroundContact::kNone);
}

TEST(Pilot, PutSomewhereElseItFliesOnThere) {
  Pilot pilot(EyeAt(1500.0), kWgs84);
  ASSERT_FALSE(pilot.Enter(FlightMode::kAircraft, Sea));
  CameraPose there = EyeAt(2500.0, 90.0);
  there.place.longitude_rad = 3.0;
  pilot.PutAt(there, Sea);
  EXPECT_EQ(pilot.mode(), FlightMode::kAircraft);
  EXPECT_LT(Apart(pilot.eye(), there), 1e-6);
  pilot.Advance({}, 1.0, Sea);
  EXPECT_GT(pilot.eye().place.longitude_rad, 3.0);
  there.place.height_m = 400e3;
  pilot.PutAt(there, Sea);
  EXPECT_EQ(pilot.mode(), FlightMode::kFree) << "there is no air";
}

TEST(Pilot, AReplayGoesAsLowAsItWasFlownButNotIntoTheGround) {
  const auto shown_m = [](double flown_m) {
    Pilot pilot(EyeAt(1500.0), kWgs84);
    const CameraPose low{PlaceFromDegrees(46.0, 8.0, flown_m)};
    pilot.SetTrack(std::make_shared<CameraPath>(std::vector<CameraPathPoint>{{0.0, low}}),
                   Pilot::Lens::kOfTrack);
    EXPECT_FALSE(pilot.Enter(FlightMode::kTrack, [](const auto&) { return 100.0; }));
    return pilot.eye().place.height_m;
  };
  EXPECT_EQ(shown_m(100.5), 100.5) << "lower than people stand";
  EXPECT_GT(shown_m(100.0), 100.01) << "the card has places of land in single precision, to 1 cm";
  EXPECT_LT(shown_m(20.0), 100.5) << "up by no more than it needs";
}

}  // namespace
}  // namespace alpenglow::viewer
