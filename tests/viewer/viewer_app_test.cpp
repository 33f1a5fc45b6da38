// SPDX-License-Identifier: MIT
// A flight with hands, without a window: what keys and panels come to.
#include "viewer/viewer_app.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "atmosphere/math/constants.h"
#include "lut/image/png.h"
#include "lut/image/white_balance.h"
#include "renderer/scene/scene_options.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/temporary_folder.h"
#include "tests/viewer/air/shared_air.h"
#include "tests/viewer/land/headless_land.h"
#include "viewer/picture_writer.h"

namespace alpenglow::viewer {
namespace {

using ::testing::HasSubstr;

constexpr ImageSize kSize{320, 240};
// GLFW gives these numbers to the keys.
constexpr int kF1 = 290, kF2 = 291, kF3 = 292, kL = 76, kR = 82, kW = 87, kRightArrow = 262,
              kEscape = 256, kEnterKey = 257;

/// Makes a flight over the bare planet.
struct BareFlight {
  static FlightSession Made() {
    Scene scene = BareScene(3000.0, 30.0, 0.0, 60.0);
    scene.medium = MediumPreset("bruneton2017");
    FlightSessionSettings settings;
    settings.quality = {Quality::kLow};
    settings.size = kSize;
    settings.first_air = tests::SharedAirOf(scene);
    return {scene, ParseInstant("2026-06-21T10:00:00Z"), settings};
  }

  FlightSession flight = Made();
  FlightMoment begin = flight.Moment();
};

/// Each test begins with the flight as it was made.
class ViewerAppTest : public tests::HeadlessSharing<BareFlight> {
 protected:
  void SetUp() override {
    HeadlessSharing::SetUp();
    if (IsSkipped()) return;
    flight_ = &shared().flight;
    flight_->controller().Enter(FlightMode::kFree);
    flight_->controller().pilot().SetTrack(nullptr);
    flight_->controller().clock().SetRate(1.0);
    flight_->TakeUp(shared().begin);
    app_ = std::make_unique<ViewerApp>(*flight_, recorder_, ViewerApp::Settings{});
    screen_ = std::make_unique<RenderTarget>(kSize.width, kSize.height, RenderTarget::Depth::kNone);
    flight_->WaitUntilReady(kSize);
  }
  void TearDown() override {
    screen_.reset();
    app_.reset();
  }
  /// A key that goes down and up.
  void Press(int key, int modifiers = 0) {
    WindowEvents events;
    events.keys = {{key, 0, 1, modifiers, ""}, {key, 0, 0, modifiers, ""}};
    app_->Advance({events, kSize, kFrame_s});
  }
  /// Keys that go down or up, and a frame.
  void Hold(std::initializer_list<int> keys, bool down) {
    WindowEvents events;
    for (const int key : keys) events.keys.push_back({key, 0, down ? 1 : 0, 0, ""});
    app_->Advance({events, kSize, kFrame_s});
  }
  struct Moment {
    CameraPose eye;
    UtcTime now;
  };
  std::vector<Moment> Fly(int frames) {
    std::vector<Moment> moments;
    for (int i = 0; i < frames; ++i) {
      app_->Advance({{}, kSize, kFrame_s});
      moments.push_back({flight_->eye(), flight_->now()});
    }
    return moments;
  }
  DisplayImage Shown() {
    app_->Advance({{}, kSize, kFrame_s});
    app_->Paint({screen_->framebuffer(), kSize.width, kSize.height}, kFrame_s);
    return screen_->ReadBytes();
  }
  /// Flies on until the pictures that were asked for are written, or not; counts frames.
  int FlyUntilPicturesEnd() {
    int frames = 0;
    for (; app_->Model().progress; ++frames) static_cast<void>(Shown());
    static_cast<void>(Fly(1));
    return frames;
  }
  /// The commands that keys and panels give.
  [[nodiscard]] FlightCommands& Commands() { return *app_; }
  [[nodiscard]] std::vector<HudMessage> Messages() const { return app_->Model().messages; }

  static constexpr double kFrame_s = 1.0 / 60.0;
  FlightSession* flight_ = nullptr;
  FlightRecorder recorder_;
  std::unique_ptr<ViewerApp> app_;
  std::unique_ptr<RenderTarget> screen_;
};

/// Bytes that differ by more than a step of exposure makes.
int Changed(const DisplayImage& a, const DisplayImage& b) {
  int changed = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) changed += std::abs(a.rgb[i] - b.rgb[i]) > 20;
  return changed;
}

TEST_F(ViewerAppTest, F1ShowsTheKeysAndHidesThemAgain) {
  flight_->exposure().Set(14.0);
  const DisplayImage bare = Shown();
  Press(kF1);
  static_cast<void>(Shown());  // windows find their sizes in their first frames
  const DisplayImage help = Shown();
  const auto pixels = kSize.width * kSize.height;
  EXPECT_GT(Changed(bare, help), pixels / 2) << "a panel over half of so small a picture";
  Press(kF1);
  EXPECT_LT(Changed(bare, Shown()), pixels / 20) << "numbers that have gone on";
}

class ViewerAppFiles : public ViewerAppTest {
 protected:
  void SetUp() override {
    ViewerAppTest::SetUp();
    before_ = std::filesystem::current_path();
    std::string pattern =
        (std::filesystem::temp_directory_path() / "alpenglow_test_XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    std::filesystem::current_path(pattern);
  }
  void TearDown() override {
    ViewerAppTest::TearDown();
    const std::filesystem::path folder = std::filesystem::current_path();
    std::filesystem::current_path(before_);
    std::filesystem::remove_all(folder);
  }
  std::filesystem::path before_;
};

TEST_F(ViewerAppFiles, F3WritesAPictureIntoTheCurrentFolder) {
  static_cast<void>(Shown());
  Press(kF3);
  Press(kF3);
  ASSERT_TRUE(app_->Model().progress);
  EXPECT_EQ(app_->Model().progress->text, "Picture skyview-0001.png (1 more to come):");
  EXPECT_GE(FlyUntilPicturesEnd(), 4) << "a frame for each ray of a pixel at least";
  EXPECT_EQ(ReadPng("skyview-0001.png").width, kSize.width);
  ASSERT_FALSE(Messages().empty());
  EXPECT_EQ(Messages().front().text, "skyview-0001.png is written");
  EXPECT_EQ(Messages().back().text, "skyview-0002.png is written") << "none is written over";
  EXPECT_FALSE(Messages().back().is_warning);
  EXPECT_TRUE(std::filesystem::exists("skyview-0002.png"));
}

TEST_F(ViewerAppFiles, LeavingWaitsForTheUnfinishedPicture) {
  static_cast<void>(Shown());
  Press(kF3);
  app_->Leave();
  EXPECT_FALSE(app_->quit());
  EXPECT_THAT(Messages().back().text, HasSubstr("leaving when the pictures are written"));
  static_cast<void>(FlyUntilPicturesEnd());
  EXPECT_TRUE(app_->quit());
  EXPECT_TRUE(std::filesystem::exists("skyview-0001.png"));
}

TEST_F(ViewerAppFiles, LeavingTwiceAbandonsThePicture) {
  static_cast<void>(Shown());
  Press(kF3);
  app_->Leave();
  app_->Leave();
  static_cast<void>(FlyUntilPicturesEnd());
  EXPECT_TRUE(app_->quit());
  EXPECT_TRUE(std::filesystem::is_empty(".")) << "nor is there a part of it";
}

TEST_F(ViewerAppFiles, DestructorWritesRequestedPictures) {
  static_cast<void>(Shown());
  Press(kF3);
  Commands().Request({".png", ImageSize{320, 240}, true});
  app_.reset();
  EXPECT_TRUE(std::filesystem::exists("skyview-0001.png"));
  EXPECT_TRUE(std::filesystem::exists("skyview-0002.png")) << "with its instruments";
}

TEST_F(ViewerAppFiles, ThePanelWritesPicturesWithInstrumentsAndWithout) {
  static_cast<void>(Shown());
  app_->Advance({{}, kSize, kFrame_s});
  Commands().Request({".png", ImageSize{480, 360}, true});
  Commands().Request({".png", ImageSize{480, 360}, false});
  static_cast<void>(FlyUntilPicturesEnd());
  const DisplayImage with = ReadPng("skyview-0001.png"), without = ReadPng("skyview-0002.png");
  ASSERT_EQ(with.width, 480);
  EXPECT_GT(Changed(with, without), 2000) << "instruments";
  EXPECT_LT(Changed(with, without), 480 * 360) << "over the same picture";
  Commands().Request({".exr", ImageSize{480, 360}, true});
  EXPECT_TRUE(Messages().back().is_warning) << "instruments are no light";
  EXPECT_FALSE(app_->Model().progress);
  EXPECT_FALSE(std::filesystem::exists("skyview-0003.exr"));
}

TEST_F(ViewerAppFiles, AnUnwritablePictureIsAWarning) {
  static_cast<void>(Shown());
  const std::filesystem::path gone = std::filesystem::current_path() / "gone";
  std::filesystem::create_directory(gone);
  std::filesystem::current_path(gone);
  std::filesystem::remove(gone);
  Press(kF3);
  std::filesystem::current_path(gone.parent_path());
  ASSERT_FALSE(Messages().empty());
  EXPECT_TRUE(Messages().back().is_warning) << "and the flight goes on";
}

double Apart_m(const CameraPose& a, const CameraPose& b) {
  return glm::length((EcefFromGeodetic(kWgs84, a.place) - EcefFromGeodetic(kWgs84, b.place)).xyz);
}

TEST_F(ViewerAppTest, CtrlRReplaysTheFlightAndThenContinues) {
  flight_->controller().clock().SetRate(60.0);
  Hold({kW, kRightArrow}, true);
  const std::vector<Moment> flown = Fly(120);
  Press(kR, kControlKey);
  ASSERT_FALSE(Messages().empty());
  EXPECT_THAT(Messages().back().text, HasSubstr("2 s"));
  EXPECT_EQ(app_->Model().flight.mode, "replay");
  EXPECT_LT(Apart_m(flight_->eye(), flown[0].eye), 1.0) << "from where it began";
  const std::vector<Moment> again = Fly(100);
  for (std::size_t i = 0; i < again.size(); ++i) {
    EXPECT_LT(Apart_m(again[i].eye, flown[i + 1].eye), 0.5)
        << "of 15 m a frame: 0.34 m as it sets off, 1 mm once it flies evenly, between points that "
           "are three frames apart";
    EXPECT_NEAR(SecondsBetween(again[i].now, flown[i + 1].now), 0.0, 1e-3);
    EXPECT_NEAR(again[i].eye.heading_rad, flown[i + 1].eye.heading_rad, 1e-3);
  }
  const std::vector<Moment> on = Fly(40);
  EXPECT_EQ(app_->Model().flight.mode, "free camera");
  EXPECT_THAT(Messages().back().text, HasSubstr("ends"));
  EXPECT_GT(Apart_m(on.back().eye, flown.back().eye), 100.0) << "the key is still held";
  EXPECT_LT(Apart_m(on.back().eye, flown.back().eye), 20 * 20.0) << "but was not while it replayed";
}

TEST_F(ViewerAppTest, TakingOverAReplayContinuesFromThere) {
  Hold({kW}, true);
  static_cast<void>(Fly(120));
  Hold({kW}, false);
  const CameraPose end = flight_->eye();
  Press(kR, kControlKey);
  static_cast<void>(Fly(30));
  const CameraPose middle = flight_->eye();
  Press('1');
  static_cast<void>(Fly(120));
  EXPECT_LT(Apart_m(flight_->eye(), middle), 20.0) << "a frame of the replay";
  EXPECT_GT(Apart_m(flight_->eye(), end), 500.0);
}

TEST_F(ViewerAppTest, WithoutAFlightThereIsNothingToReplay) {
  static_cast<void>(Fly(10));
  const CameraPose before = flight_->eye();
  Press(kR, kControlKey);
  ASSERT_EQ(Messages().size(), 1U);
  EXPECT_TRUE(Messages().back().is_warning);
  EXPECT_THAT(Messages().back().text, HasSubstr("nothing has been flown"));
  EXPECT_EQ(flight_->eye(), before);
  EXPECT_EQ(app_->Model().flight.mode, "free camera");
}

TEST_F(ViewerAppFiles, ShiftF2WritesTheFlightSoFar) {
  Press(kF2, kShiftKey);
  EXPECT_FALSE(std::filesystem::exists("flight-0001.csv")) << "nothing has been flown yet";
  ASSERT_FALSE(Messages().empty());
  EXPECT_TRUE(Messages().back().is_warning);
  Hold({kW}, true);
  const std::vector<Moment> flown = Fly(61);
  Press(kF2, kShiftKey);
  EXPECT_THAT(Messages().back().text, HasSubstr("flight-0001.csv"));
  const CameraPath path = ReadFlight("flight-0001.csv");
  EXPECT_LT(Apart_m(path.points().back().pose, flown.back().eye), 1e-3)
      << "all but the frame in which the key was pressed";
  EXPECT_NEAR(SecondsBetween(*path.points().back().utc, flown.back().now), 0.0, 1e-3);
  Press(kF2, kShiftKey);
  EXPECT_GT(ReadFlight("flight-0002.csv").end_s(), path.end_s());
}

TEST_F(ViewerAppFiles, ThePanelStartsAndStopsRecording) {
  Hold({kW}, true);
  static_cast<void>(Fly(30));
  EXPECT_FALSE(app_->Model().recording);
  Commands().Record(true);
  EXPECT_TRUE(app_->Model().recording);
  const std::vector<Moment> flown = Fly(61);
  EXPECT_EQ(ReadFlight("flight-0001.csv.part").points().size(), 21U)
      << "every third frame is on the disk before the next one";
  Commands().Record(false);
  EXPECT_FALSE(app_->Model().recording);
  const CameraPath path = ReadFlight("flight-0001.csv");
  EXPECT_EQ(path.begin_s(), 0.0) << "of the record, not of the flight";
  EXPECT_LT(Apart_m(path.points().front().pose, flown.front().eye), 1e-3);
  Commands().Record(true);
  static_cast<void>(Fly(1));
  EXPECT_TRUE(std::filesystem::exists("flight-0002.csv.part")) << "no flight is written over";
  Commands().Record(false);
}

TEST_F(ViewerAppFiles, DestructorFinishesTheRecord) {
  {
    FlightRecorder recorder;
    ViewerApp app(*flight_, recorder, {});
    static_cast<FlightCommands&>(app).Record(true);
    app.Advance({{}, kSize, kFrame_s});
  }
  EXPECT_EQ(ReadFlight("flight-0001.csv").points().size(), 1U);
}

/// 300 m over mountains about 1500 m high.
using ViewerAppOverLand = tests::HeadlessTile;

TEST_F(ViewerAppOverLand, RecordsNothingBeforeTheGroundIsKnown) {
  const Scene scene = SceneOverTile(tests::PlaceOfSample(120.0, 200.0, 0.0),
                                    CameraFromDegrees({300.0, true}, 0.0, 0.0, 0.0, 60.0));
  FlightSessionSettings settings;
  settings.land = LandSourceOf(scene);
  settings.quality = {Quality::kLow};
  settings.size = kSize;
  settings.first_air = tests::SharedAirOf(scene);
  FlightSession flight(scene, ParseInstant("2026-06-21T10:00:00Z"), settings);
  FlightRecorder recorder(folder_ / "f.csv");
  ViewerApp app(flight, recorder, {});
  const RenderTarget screen(kSize.width, kSize.height, RenderTarget::Depth::kNone);
  const auto fly = [&](const WindowEvents& events) {
    app.Advance({events, kSize, 1.0 / 60.0});
    app.Paint({screen.framebuffer(), kSize.width, kSize.height}, 1.0 / 60.0);
  };
  int frames = 0;
  for (; !flight.standpoint().KnowsGround(); ++frames) fly({});
  EXPECT_GT(frames, 1) << "land is read beside drawing";
  for (int i = 0; i < 12; ++i) fly({});
  WindowEvents again;
  again.keys = {{kR, 0, 1, kControlKey, ""}, {kR, 0, 0, kControlKey, ""}};
  fly(again);
  EXPECT_THAT(app.Model().messages.back().text, HasSubstr("nothing has been flown"))
      << "the eye has stood, though the ground came up to it";
  EXPECT_TRUE(recorder.Finish());
  const CameraPath path = ReadFlight(folder_ / "f.csv");
  EXPECT_GE(path.points().size(), 4U);
  for (const CameraPathPoint& point : path.points())
    EXPECT_NEAR(point.pose.place.height_m, flight.edits().GroundAt(point.pose.place) + 300.0, 0.01)
        << "places and heights are written in millimetres, on slopes of 60 degrees at most";
}

TEST_F(ViewerAppTest, ARequestedPlaceMovesTheEye) {
  Commands().MoveTo({47.25, 9.5, 2500.0, {}, {}});
  EXPECT_NEAR(flight_->eye().place.latitude_rad(), 47.25 * kRadiansPerDegree, 1e-12);
  EXPECT_NEAR(flight_->eye().place.longitude_rad(), 9.5 * kRadiansPerDegree, 1e-12);
  EXPECT_NEAR(flight_->eye().place.height_m, 2500.0, 1e-6);
  EXPECT_TRUE(Messages().empty());
}

TEST_F(ViewerAppTest, AnUnknownPlaceIsAWarningAndTheEyeStays) {
  const CameraPose before = flight_->eye();
  Commands().GoTo("Nowhere at all");
  EXPECT_EQ(flight_->eye(), before);
  ASSERT_EQ(Messages().size(), 1U);
  EXPECT_TRUE(Messages().back().is_warning);
  EXPECT_THAT(Messages().back().text, HasSubstr("Nowhere at all"));
  EXPECT_FALSE(app_->quit());
}

TEST_F(ViewerAppTest, CtrlLSwitchesTheLandingLightAsThePanelDoes) {
  Press(kL, kControlKey);
  ASSERT_FALSE(Messages().empty());
  EXPECT_EQ(Messages().back().text, "landing light on");
  Commands().ToggleLandingLight();
  Press(kL, kControlKey);
  EXPECT_EQ(Messages().back().text, "landing light on") << "the panel had put it out";
  Press(kL, kControlKey);
  EXPECT_EQ(Messages().back().text, "landing light off");
}

TEST_F(ViewerAppTest, TheLandingLightOfTheKeyShinesOnTheGround) {
  flight_->controller().clock().Set(ParseInstant("2026-06-21T23:00:00Z"));
  CameraPose low = flight_->eye();
  low.place.height_m = 30.0;
  low.pitch_rad = -0.3;
  flight_->controller().pilot().PutAt(low, flight_->controller().ground());
  const auto mean_cd_per_m2 = [&] {
    const HdrImage image = PictureWriter(*flight_).Picture({32, 24}, 1);
    double sum = 0.0;
    for (const auto& rgb : image.rgb) sum += static_cast<double>(rgb[1]);
    return sum / static_cast<double>(image.rgb.size());
  };
  static_cast<void>(Shown());
  const double dark = mean_cd_per_m2();
  Press(kL, kControlKey);
  static_cast<void>(Shown());
  EXPECT_GT(mean_cd_per_m2(), 2.0 * dark);
}

TEST_F(ViewerAppTest, EventButtonsJumpToTheNamedEvent) {
  const std::pair<SkyEvent, const char*> cases[] = {{SkyEvent::kSunset, "2026-06-21T19:3"},
                                                    {SkyEvent::kDusk, "2026-06-21T20:0"},
                                                    {SkyEvent::kDawn, "2026-06-22T02:5"},
                                                    {SkyEvent::kSunrise, "2026-06-22T03:2"},
                                                    {SkyEvent::kNoon, "2026-06-22T11:3"}};
  for (const auto& [event, time] : cases) {
    EXPECT_EQ(flight_->controller().JumpTo(event), NameOf(event));
    EXPECT_THAT(FormatUtc(flight_->now()), ::testing::StartsWith(time)) << NameOf(event);
  }
}

TEST_F(ViewerAppTest, InvalidTypedTimesAreWarnings) {
  Commands().SetTime("2026-06-22T04:00:00Z");
  EXPECT_EQ(FormatUtc(flight_->now()), "2026-06-22T04:00:00Z");
  Commands().SetTime("sunsat");
  EXPECT_EQ(FormatUtc(flight_->now()), "2026-06-22T04:00:00Z");
  EXPECT_TRUE(Messages().back().is_warning);
}

TEST_F(ViewerAppTest, KeysEnterTheAvailableModes) {
  Press('2');
  EXPECT_EQ(flight_->controller().pilot().mode(), FlightMode::kAircraft);
  Press('3');
  EXPECT_EQ(flight_->controller().pilot().mode(), FlightMode::kAircraft) << "there is no track";
  Press('1');
  EXPECT_EQ(flight_->controller().pilot().mode(), FlightMode::kFree);
}

TEST_F(ViewerAppTest, ThrottleAndHeldSpeedOfTheAircraftAreShown) {
  EXPECT_FALSE(app_->Model().flight.throttle) << "the free camera has none";
  Press('2');
  PilotedAircraft* aircraft = flight_->controller().pilot().aircraft();
  ASSERT_NE(aircraft, nullptr);
  aircraft->SetThrottle(0.25);
  EXPECT_EQ(app_->Model().flight.throttle, 0.25);
  aircraft->autopilot().Set({.speed_m_per_s = 55.0});
  EXPECT_EQ(app_->Model().autopilot.speed_m_per_s, 55.0);
  aircraft->SetThrottle(0.25);
  EXPECT_EQ(app_->Model().autopilot.speed_m_per_s, std::nullopt) << "a hand has the throttle";
}

TEST_F(ViewerAppTest, AnotherLookAndWhiteBalanceChangeThePicture) {
  ExposureControl& exposure = flight_->exposure();
  exposure.Set(14.0);
  const DisplayImage photo = Shown();
  Look look = exposure.look();
  look.agx = AgxLook::kNone;
  exposure.Use(look);
  const DisplayImage none = Shown();
  EXPECT_GT(Changed(photo, none), 10000);
  look.white = WhiteBalanceFromText("3000");
  exposure.Use(look);
  EXPECT_GT(Changed(none, Shown()), 10000) << "bluer";
  EXPECT_EQ(exposure.white_k(), 3000.0);
  look.white = WhiteBalanceFromText("daylight");
  exposure.Use(look);
  EXPECT_LT(Changed(none, Shown()), 4000) << "daylight, as camera is by day; instruments changed";
}

TEST_F(ViewerAppTest, EscThenEnterLeaves) {
  Press(kEscape);
  EXPECT_FALSE(app_->quit());
  static_cast<void>(Fly(2));
  Press(kEnterKey);
  EXPECT_TRUE(app_->quit());
}

TEST_F(ViewerAppTest, EscTwiceStays) {
  Press(kEscape);
  static_cast<void>(Fly(2));
  Press(kEscape);
  Press(kEnterKey);
  static_cast<void>(Fly(2));
  EXPECT_FALSE(app_->quit());
}

TEST_F(ViewerAppTest, MessagesDisappearAfterSomeSeconds) {
  app_->Report("hello");
  app_->Advance({{}, kSize, 4.0});
  EXPECT_EQ(Messages().size(), 1U);
  app_->Advance({{}, kSize, 5.0});
  EXPECT_TRUE(Messages().empty());
}

}  // namespace
}  // namespace alpenglow::viewer
