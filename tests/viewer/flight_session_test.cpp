// SPDX-License-Identifier: MIT
// Pictures of a flight, without hands.
#include "viewer/flight_session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "renderer/procedural_mountains/procedural_mountains.h"
#include "renderer/scene/places.h"
#include "renderer/scene/scene_options.h"
#include "tests/viewer/land/headless_land.h"
#include "viewer/gl/picture_tiles.h"
#include "viewer/gl/render_target.h"
#include "viewer/picture_writer.h"

namespace alpenglow::viewer {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class FlightsOverLand : public tests::HeadlessTile {
 protected:
  /// Mountains under a low sun, with shafts.
  [[nodiscard]] Scene SceneAt(const Height& height) const {
    return SceneOverTile(tests::PlaceOfSample(120.0, 200.0, 0.0),
                         CameraFromDegrees(height, 330.0, -8.0, 7.0, 75.0));
  }
  /// @param files  of the land; none: that of the scene.
  [[nodiscard]] static FlightSession SmallFlight(const Scene& scene,
                                                 std::vector<std::filesystem::path> files = {}) {
    FlightSessionSettings settings;
    settings.land = LandSourceOf(scene);
    if (!files.empty()) settings.land.files = std::move(files);
    settings.quality = {Quality::kLow};
    settings.size = kSmall;
    return {scene, ParseInstant("2026-06-21T18:20:00Z"), settings};
  }

  static constexpr ImageSize kSmall{32, 18};
};

double OverTheGround_m(FlightSession& flight) {
  return flight.eye().place.height_m - flight.edits().GroundAt(flight.eye().place);
}

TEST_F(FlightsOverLand, AnEyeThatIsPutOverGroundStandsThereWhenTheGroundIsKnown) {
  constexpr int kFar = 6000;  // samples; 190 km, whose land is not loaded before the eye is there
  tests::WriteTile(folder_ / "far.tif", kFar, 0);
  FlightSession flight =
      SmallFlight(SceneAt({300.0, true}), {folder_ / "land.tif", folder_ / "far.tif"});
  EXPECT_FALSE(flight.standpoint().KnowsGround()) << "nothing has been read yet";
  flight.WaitUntilReady(kSmall);
  EXPECT_TRUE(flight.standpoint().KnowsGround());
  EXPECT_NEAR(OverTheGround_m(flight), 300.0, 1e-6);
  EyePlacement far;
  far.longitude_deg = tests::PlaceOfSample(kFar + 70.0, 0.0, 0.0).longitude_rad / kRadiansPerDegree;
  flight.standpoint().Place(far);
  EXPECT_FALSE(flight.standpoint().KnowsGround()) << "of another place";
  flight.WaitUntilReady(kSmall);
  EXPECT_TRUE(flight.standpoint().KnowsGround());
  EXPECT_NEAR(OverTheGround_m(flight), 300.0, 1e-6);
}

TEST_F(FlightsOverLand, WhereThereIsNoLandTheGroundIsKnownAtOnce) {
  for (const double latitude_deg : {10.0, 46.0}) {
    FlightSession flight = SmallFlight(SceneAt({300.0, true}));
    flight.standpoint().Place({latitude_deg, {}, {}, {}, {}});
    flight.Advance({}, 1.0 / 60.0);
    EXPECT_TRUE(flight.standpoint().KnowsGround()) << latitude_deg;
    EXPECT_EQ(flight.eye().place.height_m, 300.0) << "over the ellipsoid";
  }
}

TEST_F(FlightsOverLand, OfAPlaceWithoutTerrainThereIsANote) {
  FlightSession flight = SmallFlight(SceneAt({300.0, true}));
  static_cast<void>(flight.edits().TakeNotes());
  flight.standpoint().GoTo("LSZS");
  EXPECT_THAT(flight.edits().TakeNotes(), ElementsAre(HasSubstr("no terrain at Samedan")));
  EXPECT_NEAR(flight.eye().place.height_m, 2.0, 1e-9) << "on the plain, not 1707 m over it";
  flight.standpoint().Place({46.65, 8.05, {}, {}, {}});
  EXPECT_THAT(flight.edits().TakeNotes(), IsEmpty()) << "on the tile";
}

/// The frames that a window shows of a flight, one after another.
class ShownFrames {
 public:
  explicit ShownFrames(FlightSession& flight)
      : flight_(flight), screen_(64, 36, {PixelFormat::kRgba8}, RenderTarget::Depth::kNone) {
    flight_.standpoint().AwaitGround();
  }
  /// The next frame, as it was painted: its fourth component is the inverse depth of land.
  [[nodiscard]] Image Next() {
    constexpr double kFrame_s = 0.05;
    flight_.Advance({}, kFrame_s);
    flight_.Paint({screen_.framebuffer(), screen_.width(), screen_.height()}, kFrame_s);
    return flight_.frames().picture().Read();
  }

 private:
  FlightSession& flight_;
  RenderTarget screen_;
};

/// Green over blue of the greenest pixel: sky at noon has little more of one than of the other,
/// even at the horizon (1.1), and ground has twice as much.
double Greenest(const Image& image) {
  double most = 0.0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x)
      most = std::max(most, static_cast<double>(image.at(x, y)[1] / image.at(x, y)[2]));
  }
  return most;
}

TEST_F(FlightsOverLand, AWindowShowsTheSkyThenTheLandAndTheEyeStays) {
  constexpr double kSky = 1.35;
  const Scene scene = SceneAt({300.0, true});
  FlightSessionSettings settings;
  settings.land = LandSourceOf(scene);
  settings.quality = {Quality::kLow};
  settings.size = kSmall;
  FlightSession flight(scene, ParseInstant("2026-06-21T11:30:00Z"), settings);
  ShownFrames window(flight);
  EXPECT_NEAR(OverTheGround_m(flight), 300.0, 1e-6) << "before the first picture";
  const GeodeticPosition start = flight.eye().place;
  EXPECT_LT(Greenest(window.Next()), kSky) << "no plain where land is to come";
  // The threads beside drawing need some frames.
  for (bool has_come = false; !has_come;) {
    const Image shown = window.Next();
    has_come = flight.edits().land().HasCome();
    ASSERT_EQ(flight.eye().place, start);
    if (!has_come) {
      ASSERT_LT(Greenest(shown), kSky);
    }
  }
  EXPECT_GT(Greenest(window.Next()), kSky) << "land";
}

TEST_F(FlightsOverLand, AfterAJumpInTimeTheFirstFrameIsExposedForItsLight) {
  FlightSession flight = SmallFlight(SceneAt({300.0, true}));
  flight.WaitUntilReady(kSmall);
  ShownFrames window(flight);
  for (int frame = 0; frame < 3; ++frame)
    static_cast<void>(window.Next());  // one copy is on its way
  const double day_ev100 = flight.exposure().exposure().ev100.value();
  flight.controller().clock().Set(ParseInstant("2026-06-21T20:10:00Z"));
  std::vector<double> shown;
  for (int frame = 0; frame < 4; ++frame) {
    static_cast<void>(window.Next());
    shown.push_back(flight.exposure().exposure().ev100.value());
  }
  EXPECT_GT(day_ev100 - shown.front(), 4.0) << "dusk";
  flight.WaitUntilReady(kSmall);
  for (int frame = 0; frame < 60; ++frame) static_cast<void>(window.Next());
  for (const double ev100 : shown)
    EXPECT_NEAR(ev100, flight.exposure().exposure().ev100.value(), 0.3)
        << "land and air of small tables";
}

/// Over the built-in range. It is made when it is first settled or painted.
class FlightsOverTheRange : public tests::HeadlessLand {
 protected:
  [[nodiscard]] static Scene RangeScene() {
    Scene scene = SceneFromOptions({});
    scene.medium = MediumPreset("bruneton2017");
    return scene;
  }
  [[nodiscard]] static FlightSession FlightOver(const Scene& scene) {
    FlightSessionSettings settings;
    settings.land = LandSourceOf(scene);
    settings.quality = {Quality::kLow};
    settings.size = {32, 18};
    return {scene, ParseInstant("2026-06-21T11:00:00Z"), settings};
  }
};

TEST_F(FlightsOverTheRange, TheRangeComesToAPlaceOffItAndGoesBack) {
  FlightSession flight = FlightOver(RangeScene());
  flight.standpoint().GoTo("Tromso");
  const GeodeticPosition tromso = PlaceNamed("Tromso").place;
  EXPECT_EQ(flight.edits().scene().terrain.range_seed, RangeSeenFrom(tromso).range_seed);
  EXPECT_TRUE(flight.edits().land().ground().Reaches(tromso));
  EXPECT_FALSE(flight.standpoint().KnowsGround()) << "it is made beside drawing";
  EXPECT_NEAR(flight.eye().place.height_m, kRangeViewGround_m + 600.0, 1e-6)
      << "its ground is known before";
  flight.standpoint().Place({46.58, 8.01, {}, {}, {}});
  EXPECT_EQ(flight.edits().scene().terrain.range_seed, 0U)
      << "on the range that the flight began over";
  EXPECT_EQ(flight.edits().scene().terrain.centre, RangeScene().terrain.centre);
}

TEST_F(FlightsOverTheRange, AnEyeStandsAtItsHeightBeforeTheRangeIsThere) {
  FlightSession flight = FlightOver(RangeScene());
  flight.standpoint().AwaitGround();
  EXPECT_FALSE(flight.standpoint().KnowsGround()) << "nothing was waited for";
  const double height_m = flight.eye().place.height_m;
  EXPECT_NEAR(height_m, kRangeViewGround_m + RangeScene().camera.height.value_m, 1e-6);
  EXPECT_NEAR(OverTheGround_m(flight), RangeScene().camera.height.value_m, 1e-6);
  flight.WaitUntilReady({32, 18});
  EXPECT_NEAR(flight.eye().place.height_m, height_m, 0.01) << "a centimetre is not seen";
}

// Land that has grown since, or that of another model.
TEST_F(FlightsOverLand, AReplayOfARecordThatIsLowerThanTheLandStaysOverIt) {
  const GeodeticPosition place = tests::PlaceOfSample(120.0, 200.0, 100.0);
  const CameraPath low({{0.0, {place}}, {1.0, {place, 0.5}}});
  {
    FlightSession flight = SmallFlight(SceneAt({3500.0, false}));
    FlightRecorder recorder(folder_ / "shown.csv");
    PictureWriter(flight).WriteReplay(low, {folder_ / "0.png", folder_ / "1.png"}, kSmall,
                                      recorder);
    EXPECT_GT(OverTheGround_m(flight), 0.05) << "10 cm";
    recorder.Finish();
    const double height_m = flight.eye().place.height_m;
    const CameraPath shown_path = ReadFlight(folder_ / "shown.csv");
    for (const CameraPathPoint& point : shown_path.points())
      EXPECT_NEAR(point.pose.place.height_m, height_m, 1e-3) << "as written, in millimetres";
    for (const char* name : {"0.png", "1.png"}) {
      const std::string shown = ReadPngMetadata(folder_ / name).at("alpenglow.camera_height");
      EXPECT_NEAR(std::stod(shown), height_m, 0.1) << name;
    }
  }
  FlightSession window = SmallFlight(SceneAt({3500.0, false}));
  window.Replay(low);
  window.WaitUntilReady(kSmall);
  window.Advance({}, 0.5);
  EXPECT_GT(OverTheGround_m(window), 0.05);
}

class PicturesInParts : public FlightsOverLand {
 protected:
  [[nodiscard]] FlightSession FlightOf(std::optional<int> largest_part) const {
    const Scene scene = SceneAt({3500.0, false});
    FlightSessionSettings settings;
    settings.land = LandSourceOf(scene);
    settings.quality = {Quality::kMedium};
    settings.size = kSize;
    settings.largest_part = largest_part;
    return {scene, ParseInstant("2026-06-21T18:20:00Z"), settings};
  }

  static constexpr ImageSize kSize{560, 300};
  static constexpr int kPart = 480;
};

/// Of the larger of both, in the channel that differs most.
double Difference(const std::array<float, 3>& a, const std::array<float, 3>& b) {
  double most = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto x = static_cast<double>(a[c]), y = static_cast<double>(b[c]);
    most = std::max(most, std::abs(x - y) / std::max(std::max(std::abs(x), std::abs(y)), 1e-6));
  }
  return most;
}

TEST_F(PicturesInParts, ArePicturesInOnePiece) {
  const auto painted = [&](std::optional<int> largest_part) {
    FlightSession flight = FlightOf(largest_part);
    return PictureWriter(flight).Picture(kSize, 4);
  };
  const Image whole = painted(std::nullopt), parts = painted(kPart);
  ASSERT_GE(TiledPicture(kSize.width, kSize.height, kPart).tiles().size(), 6U);
  double worst = 0.0;
  for (int y = 0; y < whole.height; ++y) {
    for (int x = 0; x < whole.width; ++x)
      worst = std::max(worst, Difference(whole.at(x, y), parts.at(x, y)));
  }
  EXPECT_LT(worst, 1e-3) << "rounding of floats in a narrower view; a tile without its rim is off "
                            "by several per cent where shafts end";
}

TEST_F(PicturesInParts, AreExposedAsAWhole) {
  for (const std::optional<int> part : {std::optional<int>(), std::optional(kPart)}) {
    FlightSession flight = FlightOf(part);
    PictureWriter(flight).Write(folder_ / (part ? "parts.png" : "whole.png"), kSize);
  }
  EXPECT_NEAR(std::stod(ReadPngMetadata(folder_ / "parts.png").at("alpenglow.ev100")),
              std::stod(ReadPngMetadata(folder_ / "whole.png").at("alpenglow.ev100")), 1e-3);
}

}  // namespace
}  // namespace alpenglow::viewer
