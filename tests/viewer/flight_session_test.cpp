// SPDX-License-Identifier: MIT
// Flights without hands, and the pictures that are written of them.
#include "viewer/flight_session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <set>
#include <sstream>
#include <thread>

#include "atmosphere/math/constants.h"
#include "lut/image/exr.h"
#include "lut/image/png.h"
#include "renderer/procedural_mountains/procedural_mountains.h"
#include "renderer/scene/places.h"
#include "renderer/scene/scene_options.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/temporary_folder.h"
#include "tests/viewer/air/shared_air.h"
#include "tests/viewer/land/headless_land.h"
#include "tests/viewer/shaders/headless.h"
#include "viewer/gl/render_target.h"
#include "viewer/picture_name.h"
#include "viewer/picture_queue.h"
#include "viewer/picture_writer.h"
#include "viewer/reports.h"

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
  [[nodiscard]] Scene Mountains() const { return SceneAt({3500.0, false}); }
  [[nodiscard]] static FlightSessionSettings SettingsFor(const Scene& scene,
                                                         const ImageSize& size = kSmall) {
    FlightSessionSettings settings;
    settings.land = LandSourceOf(scene);
    settings.quality = {Quality::kLow};
    settings.size = size;
    settings.first_air = tests::SharedAirOf(scene);
    return settings;
  }
  [[nodiscard]] static UtcTime Evening() { return ParseInstant("2026-06-21T18:20:00Z"); }
  [[nodiscard]] static FlightSession SmallFlight(const Scene& scene) {
    return {scene, Evening(), SettingsFor(scene)};
  }
  [[nodiscard]] std::filesystem::path File(const char* name) const { return folder_ / name; }

  static constexpr ImageSize kSmall{32, 18};
};

double OverTheGround_m(FlightSession& flight) {
  return flight.eye().place.height_m - flight.edits().GroundAt(flight.eye().place);
}

TEST_F(FlightsOverLand, HeightAboveGroundIsKeptUntilTheGroundIsLoaded) {
  constexpr int kFar = 6000;  // samples; 190 km, whose land is not loaded before the eye is there
  tests::WriteQuickTile(folder_ / "far.tif", kFar, 0);
  const Scene scene = SceneAt({300.0, true});
  FlightSessionSettings settings = SettingsFor(scene);
  settings.land.files = {File("land.tif"), File("far.tif")};
  FlightSession flight(scene, Evening(), settings);
  EXPECT_FALSE(flight.standpoint().KnowsGround()) << "nothing has been read yet";
  flight.WaitUntilReady(kSmall);
  EXPECT_TRUE(flight.standpoint().KnowsGround());
  EXPECT_NEAR(OverTheGround_m(flight), 300.0, 1e-6);
  EyePlacement far;
  far.longitude_deg = tests::PlaceOfSample(kFar + 70.0, 0.0, 0.0).longitude_deg;
  flight.standpoint().MoveTo(far);
  EXPECT_FALSE(flight.standpoint().KnowsGround()) << "of another place";
  flight.WaitUntilReady(kSmall);
  EXPECT_TRUE(flight.standpoint().KnowsGround());
  EXPECT_NEAR(OverTheGround_m(flight), 300.0, 1e-6);
}

TEST_F(FlightsOverLand, GroundIsKnownAtOnceWithoutLand) {
  for (const double latitude_deg : {10.0, 46.0}) {
    FlightSession flight = SmallFlight(SceneAt({300.0, true}));
    flight.standpoint().MoveTo({latitude_deg, {}, {}, {}, {}});
    flight.Advance({}, 1.0 / 60.0);
    EXPECT_TRUE(flight.standpoint().KnowsGround()) << latitude_deg;
    EXPECT_EQ(flight.eye().place.height_m, 300.0) << "over the ellipsoid";
  }
}

TEST_F(FlightsOverLand, APlaceWithoutTerrainIsNoted) {
  FlightSession flight = SmallFlight(SceneAt({300.0, true}));
  static_cast<void>(flight.edits().PollNotes());
  flight.standpoint().GoTo("LSZS");
  EXPECT_THAT(flight.edits().PollNotes(), ElementsAre(HasSubstr("no terrain at Samedan")));
  EXPECT_NEAR(flight.eye().place.height_m, 2.0, 1e-9) << "on the plain, not 1707 m over it";
  flight.standpoint().MoveTo({46.65, 8.05, {}, {}, {}});
  EXPECT_THAT(flight.edits().PollNotes(), IsEmpty()) << "on the tile";
}

/// The frames that a window shows of a flight, one after another.
class ShownFrames {
 public:
  explicit ShownFrames(FlightSession& flight)
      : flight_(flight), screen_(64, 36, {PixelFormat::kRgba8}, RenderTarget::Depth::kNone) {
    flight_.standpoint().AwaitGround();
  }
  /// The next frame, as it was painted: its fourth component is the inverse depth of land.
  [[nodiscard]] HdrImage Next() {
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
double Greenest(const HdrImage& image) {
  double most = 0.0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x)
      most = std::max(most, static_cast<double>(image.at(x, y)[1] / image.at(x, y)[2]));
  }
  return most;
}

TEST_F(FlightsOverLand, ShowSkyFirstThenLandWithoutMovingTheEye) {
  constexpr double kSky = 1.35;
  const Scene scene = SceneAt({300.0, true});
  FlightSession flight(scene, ParseInstant("2026-06-21T11:30:00Z"), SettingsFor(scene));
  ShownFrames window(flight);
  EXPECT_NEAR(OverTheGround_m(flight), 300.0, 1e-6) << "before the first picture";
  const Place start = flight.eye().place;
  EXPECT_LT(Greenest(window.Next()), kSky) << "no plain where land is to come";
  // The threads beside drawing need some frames.
  for (bool has_come = false; !has_come;) {
    const HdrImage shown = window.Next();
    has_come = flight.edits().land().HasCome();
    ASSERT_EQ(flight.eye().place, start);
    if (!has_come) {
      ASSERT_LT(Greenest(shown), kSky);
    }
  }
  EXPECT_GT(Greenest(window.Next()), kSky) << "land";
}

TEST_F(FlightsOverLand, FirstFrameAfterATimeJumpHasTheNewExposure) {
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
class FlightsOverTheRange : public FlightsOverLand {
 protected:
  [[nodiscard]] static Scene RangeScene() {
    Scene scene = SceneFromOptions({});
    scene.medium = MediumPreset("bruneton2017");
    return scene;
  }
};

TEST_F(FlightsOverTheRange, RangeMovesToAPlaceFarOffAndBack) {
  FlightSession flight = SmallFlight(RangeScene());
  flight.standpoint().GoTo("Tromso");
  const Place tromso = PlaceNamed("Tromso").place;
  EXPECT_EQ(flight.edits().scene().terrain.range_seed, RangeSeenFrom(tromso).range_seed);
  EXPECT_TRUE(flight.edits().land().ground().Reaches(tromso));
  EXPECT_FALSE(flight.standpoint().KnowsGround()) << "it is made beside drawing";
  EXPECT_NEAR(flight.eye().place.height_m, kRangeViewGround_m + 600.0, 1e-6)
      << "its ground is known before";
  flight.standpoint().MoveTo({46.58, 8.01, {}, {}, {}});
  EXPECT_EQ(flight.edits().scene().terrain.range_seed, 0U)
      << "on the range that the flight began over";
  EXPECT_EQ(flight.edits().scene().terrain.centre, RangeScene().terrain.centre);
}

TEST_F(FlightsOverTheRange, EyeHasItsHeightBeforeTheRangeIsLoaded) {
  FlightSession flight = SmallFlight(RangeScene());
  flight.standpoint().AwaitGround();
  EXPECT_FALSE(flight.standpoint().KnowsGround()) << "nothing was waited for";
  const double height_m = flight.eye().place.height_m;
  EXPECT_NEAR(height_m, kRangeViewGround_m + RangeScene().camera.height.value_m, 1e-6);
  EXPECT_NEAR(OverTheGround_m(flight), RangeScene().camera.height.value_m, 1e-6);
  flight.WaitUntilReady(kSmall);
  EXPECT_NEAR(flight.eye().place.height_m, height_m, 0.01) << "a centimetre is not seen";
}

// Land that has grown since, or that of another model.
TEST_F(FlightsOverLand, ReplayBelowTheLandStaysAboveIt) {
  const Place place = tests::PlaceOfSample(120.0, 200.0, 100.0);
  const CameraPath low({{0.0, {place}}, {1.0, {place, 0.5}}});
  {
    FlightSession flight = SmallFlight(Mountains());
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
  FlightSession window = SmallFlight(Mountains());
  window.Replay(low);
  window.WaitUntilReady(kSmall);
  window.Advance({}, 0.5);
  EXPECT_GT(OverTheGround_m(window), 0.05);
}

/// Returns the difference in the channel that differs most, relative to the larger of both values.
double Difference(const std::array<float, 3>& a, const std::array<float, 3>& b) {
  double most = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto x = static_cast<double>(a[c]), y = static_cast<double>(b[c]);
    most = std::max(most, std::abs(x - y) / std::max(std::max(std::abs(x), std::abs(y)), 1e-6));
  }
  return most;
}

TEST_F(FlightsOverLand, TiledPicturesEqualWholePicturesInExposureAndPixels) {
  constexpr ImageSize kSize{560, 300};
  constexpr int kPart = 480;
  ASSERT_GE(TiledPicture(kSize.width, kSize.height, kPart).tiles().size(), 6U);
  const Scene scene = Mountains();
  FlightSessionSettings settings = SettingsFor(scene, kSize);
  settings.quality = {Quality::kMedium};
  for (const std::optional<int> part : {std::optional<int>(), std::optional(kPart)}) {
    settings.largest_part = part;
    FlightSession flight(scene, Evening(), settings);
    PictureWriter(flight).Write(File(part ? "parts.exr" : "whole.exr"), kSize);
  }
  const HdrImage whole = ReadExr(File("whole.exr")), parts = ReadExr(File("parts.exr"));
  double worst = 0.0;
  for (int y = 0; y < whole.height; ++y) {
    for (int x = 0; x < whole.width; ++x)
      worst = std::max(worst, Difference(whole.at(x, y), parts.at(x, y)));
  }
  EXPECT_LT(worst, 1e-3) << "rounding of floats in a narrower view; a tile without its rim is off "
                            "by several per cent where shafts end";
  EXPECT_NEAR(std::stod(ReadExrMetadata(File("parts.exr")).at("alpenglow.ev100")),
              std::stod(ReadExrMetadata(File("whole.exr")).at("alpenglow.ev100")), 1e-3);
}

// --- pictures that are made while the flight goes on ---

class PictureQueueTest : public FlightsOverLand {
 protected:
  /// Air of three bands over the bare planet, for tests of the queue alone.
  [[nodiscard]] static Scene BarePlanetScene() {
    Scene scene = BareScene(3500.0, 330.0, -8.0, 75.0);
    scene.medium = MediumPreset("bruneton2017");
    return scene;
  }
  /// Frames of a window, until all that was asked for has ended.
  static std::vector<PictureOutcome> DrawUntilEnd(PictureQueue& queue) {
    while (queue.UnderWay()) {
      queue.NextFrame();
      std::this_thread::yield();
    }
    return queue.PollOutcomes();
  }
};

// The flight goes to another place, time, air and exposure as soon as the picture is asked for.
TEST_F(PictureQueueTest, PictureShowsTheMomentOfItsRequest) {
  const Scene scene = Mountains();
  const FlightSessionSettings settings = SettingsFor(scene);
  const RenderTarget screen(kSmall.width, kSmall.height, RenderTarget::Depth::kNone);
  FlightSession flight(scene, Evening(), settings);
  flight.WaitUntilReady(kSmall);
  AirChoice haze;
  haze.aerosol = 2.0;
  flight.edits().Use(haze, flight.eye().place);
  flight.exposure().Set(12.0);
  flight.Paint({screen.framebuffer(), kSmall.width, kSmall.height}, 0.1);
  const FlightMoment moment = flight.Moment();
  PictureQueue queue(scene, settings);
  queue.Request({moment, File("moving.exr"), kSmall});
  queue.Request({moment, File("again.exr"), kSmall});
  flight.edits().Use(AirChoice{}, flight.eye().place);
  flight.exposure().Set(3.0);
  for (int frame = 0; queue.UnderWay(); ++frame) {
    queue.NextFrame();
    std::this_thread::yield();
    if (frame >= 4) continue;  // each frame has another sun, whose light takes threads of its own
    flight.controller().clock().Shift(60.0);
    flight.Advance({}, 1.0);
    flight.Paint({screen.framebuffer(), kSmall.width, kSmall.height}, 0.1);
  }
  for (const PictureOutcome& outcome : queue.PollOutcomes()) EXPECT_EQ(outcome.fault, "");
  FlightSession resting(scene, Evening(), settings);
  resting.edits().Use(haze, resting.eye().place);
  resting.exposure().Set(12.0);
  PictureWriter(resting).Write(File("resting.exr"), kSmall);
  const HdrImage at_rest = ReadExr(File("resting.exr"));
  const Metadata header_at_rest = ReadExrMetadata(File("resting.exr"));
  for (const char* name : {"moving.exr", "again.exr"}) {
    EXPECT_EQ(ReadExr(File(name)).rgb, at_rest.rgb) << name << ": the same code, to the bit";
    for (const char* key : {"alpenglow.ev100", "alpenglow.time", "alpenglow.camera_height"})
      EXPECT_EQ(ReadExrMetadata(File(name)).at(key), header_at_rest.at(key)) << name;
  }
}

TEST_F(PictureQueueTest, FramesAreDrawnBetweenTilesOfAPicture) {
  const Scene scene = Mountains();
  const FlightSessionSettings settings = SettingsFor(scene);
  PictureQueue queue(scene, settings);
  FlightSession flight(scene, Evening(), settings);
  queue.Request({flight.Moment(), File("picture.png"), kSmall});
  std::set<double> shares;
  int frames = 0;
  const auto next_share = [&] {
    for (auto picture = queue.UnderWay(); picture; picture = queue.UnderWay()) {
      if (shares.insert(picture->share).second) return true;
      std::this_thread::yield();
    }
    return false;
  };
  for (bool goes_on = next_share(); goes_on; ++frames) {
    queue.NextFrame();
    goes_on = next_share();
  }
  EXPECT_GE(frames, 6) << "the flight, the scene, and four rays a pixel";
  EXPECT_EQ(shares.size(), static_cast<std::size_t>(frames)) << "one part for each frame";
  EXPECT_TRUE(std::filesystem::exists(File("picture.png")));
}

TEST_F(PictureQueueTest, AMissingFolderIsReportedAndTheNextPictureWritten) {
  const Scene scene = BarePlanetScene();
  const FlightSessionSettings settings = SettingsFor(scene);
  PictureQueue queue(scene, settings);
  FlightSession flight(scene, Evening(), settings);
  queue.Request({flight.Moment(), File("gone") / "picture.png", kSmall});
  queue.Request({flight.Moment(), File("picture.png"), kSmall});
  const std::vector<PictureOutcome> outcomes = DrawUntilEnd(queue);
  ASSERT_EQ(outcomes.size(), 2U);
  EXPECT_THAT(outcomes[0].fault, HasSubstr("gone"));
  EXPECT_THAT(outcomes[1].fault, IsEmpty());
  EXPECT_TRUE(std::filesystem::exists(File("picture.png")));
}

TEST_F(PictureQueueTest, DestructorWritesAllRequestedPictures) {
  const Scene scene = BarePlanetScene();
  const FlightSessionSettings settings = SettingsFor(scene);
  FlightSession flight(scene, Evening(), settings);
  {
    PictureQueue queue(scene, settings);
    queue.Request({flight.Moment(), File("picture.png"), kSmall});
  }
  EXPECT_EQ(ReadPng(File("picture.png")).width, kSmall.width);
}

TEST_F(PictureQueueTest, PicturesWithInstrumentsNeedAWindow) {
  const Scene scene = BarePlanetScene();
  const FlightSessionSettings settings = SettingsFor(scene);
  FlightSession flight(scene, Evening(), settings);
  PictureQueue queue(scene, settings);
  const auto no_instruments = [](const HdrImage&) {
    ADD_FAILURE() << "drawn into a window that has gone";
    return DisplayImage{};
  };
  queue.Request({flight.Moment(), File("with.png"), kSmall, no_instruments});
  queue.Request({flight.Moment(), File("without.png"), kSmall});
  queue.FinishWithoutWindow();
  EXPECT_FALSE(std::filesystem::exists(File("with.png")));
  EXPECT_TRUE(std::filesystem::exists(File("without.png")));
}

// --- names of files with numbers ---

class NumberedNames : public TemporaryFolder {};

TEST_F(NumberedNames, NumberIsFreeIfNeitherFileExists) {
  EXPECT_EQ(NextScreenshot(folder_), folder_ / "skyview-0001");
  WriteText(folder_ / "skyview-0001.exr", "");
  EXPECT_EQ(NextScreenshot(folder_), folder_ / "skyview-0002");
  WriteText(folder_ / "skyview-0002.png", "");
  WriteText(folder_ / "skyview-0004.png", "");
  EXPECT_EQ(NextScreenshot(folder_), folder_ / "skyview-0003");
}

TEST_F(NumberedNames, RecordingFlightKeepsItsNumber) {
  EXPECT_EQ(NextFlight(folder_), folder_ / "flight-0001.csv");
  WriteText(folder_ / "flight-0001.csv.part", "");
  EXPECT_EQ(NextFlight(folder_), folder_ / "flight-0002.csv");
  WriteText(folder_ / "flight-0002.csv", "");
  EXPECT_EQ(NextFlight(folder_), folder_ / "flight-0003.csv");
}

// --- times of frames ---

TEST(FrameTimes, BenchmarkFlightIsSteadyAndTimeRunsSixtyfold) {
  const CameraPose start{Place{46.0, 8.0, 3000.0}, 0.7};
  const UtcTime begin = ParseInstant("2026-06-21T18:00:00Z");
  const auto at = [&](double seconds) { return BenchmarkFlight(start, begin, seconds); };
  EXPECT_NEAR(at(0.0).eye.place.latitude_rad(), start.place.latitude_rad(), 1e-12);
  for (const double seconds : {0.0, 3.0, 40.0, 600.0}) {
    const ReplayFrame a = at(seconds), b = at(seconds + 0.1);
    const glm::dvec3 step =
        (EcefFromGeodetic(kWgs84, b.eye.place) - EcefFromGeodetic(kWgs84, a.eye.place)).xyz;
    EXPECT_NEAR(glm::length(step), 25.0, 0.1) << "250 m/s";
    EXPECT_EQ(b.eye.place.height_m, 3000.0);
    const Vector<Enu> ahead =
        LocalFrame(kWgs84, a.eye.place).EnuFromEcef(Vector<Ecef>{glm::normalize(step)});
    EXPECT_NEAR(std::remainder(std::atan2(ahead.xyz.x, ahead.xyz.y) - a.eye.heading_rad, 2.0 * kPi),
                0.0, 0.01)
        << "it looks where it flies";
    EXPECT_NEAR(SecondsBetween(*a.now, *b.now), 6.0, 1e-4);
  }
}

class Benchmarks : public tests::Headless {};

TEST_F(Benchmarks, EveryPassHasALineAndTheFrameHasTheLast) {
  for (const PassClock clock : {PassClock::kFinishes, PassClock::kQueries}) {
    Benchmark benchmark(0.1, clock);
    while (benchmark.NextFrame()) {
      benchmark.timer().Begin("sky");
      benchmark.timer().Begin("land");
    }
    std::istringstream text(benchmark.Text());
    std::vector<std::string> names;
    std::string name;
    for (double median = 0.0, p95 = 0.0, p99 = 0.0; text >> name >> median >> p95 >> p99;) {
      names.push_back(name);
      EXPECT_LE(median, p95);
      EXPECT_LE(p95, p99);
    }
    EXPECT_TRUE(text.eof());
    EXPECT_THAT(names, ElementsAre("sky", "sky.cpu", "land", "land.cpu", "frame", "frame.cpu"));
    EXPECT_GE(benchmark.elapsed_s(), 0.1);
    EXPECT_THAT(benchmark.WorstText(), ::testing::HasSubstr("times the median"));
  }
}

}  // namespace
}  // namespace alpenglow::viewer
