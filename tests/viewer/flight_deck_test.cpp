// SPDX-License-Identifier: MIT
// A flight with hands, without a window: what keys and panels come to.
#include "viewer/flight_deck.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "atmosphere/number/constants.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/temporary_folder.h"
#include "tests/viewer/shaders/headless.h"

namespace alpenglow {
namespace {

using ::testing::HasSubstr;

constexpr ImageSize kSize{320, 240};
constexpr int kF1 = 290, kF3 = 292;  // of GLFW

class FlightDeckTest : public tests::Headless {
 protected:
  void SetUp() override {
    tests::Headless::SetUp();
    if (IsSkipped()) return;
    Scene scene = BareScene(3000.0, 30.0, 0.0, 60.0);
    scene.medium = MediumPreset("bruneton2017");
    FlythroughSettings settings;
    settings.quality = {Quality::kLow};
    settings.size = kSize;
    flight_ = std::make_unique<Flythrough>(scene, ParseInstant("2026-06-21T10:00:00Z"), settings);
    deck_ = std::make_unique<FlightDeck>(*flight_, FlightDeck::Settings{});
    screen_ = std::make_unique<RenderTarget>(kSize.width, kSize.height, RenderTarget::Depth::kNone);
    flight_->Settle(kSize);
  }
  void TearDown() override {
    screen_.reset();
    deck_.reset();
    flight_.reset();
  }
  /// A key that goes down and up.
  void Press(int key) {
    WindowEvents events;
    events.keys = {{key, 0, 1, 0, ""}, {key, 0, 0, 0, ""}};
    deck_->Advance(events, kSize, kFrame_s);
  }
  DisplayImage Shown() {
    deck_->Advance({}, kSize, kFrame_s);
    deck_->Paint({screen_->framebuffer(), kSize.width, kSize.height}, kFrame_s);
    return screen_->ReadBytes();
  }
  [[nodiscard]] std::vector<HudMessage> Messages() const { return deck_->Model().messages; }

  static constexpr double kFrame_s = 1.0 / 60.0;
  std::unique_ptr<Flythrough> flight_;
  std::unique_ptr<FlightDeck> deck_;
  std::unique_ptr<RenderTarget> screen_;
};

/// Bytes that differ by more than a step of exposure makes.
int Changed(const DisplayImage& a, const DisplayImage& b) {
  int changed = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) changed += std::abs(a.rgb[i] - b.rgb[i]) > 20;
  return changed;
}

TEST_F(FlightDeckTest, F1ShowsTheKeysAndHidesThemAgain) {
  flight_->SetExposure(14.0);
  const DisplayImage bare = Shown();
  Press(kF1);
  static_cast<void>(Shown());  // windows find their sizes in their first frames
  const DisplayImage help = Shown();
  const auto pixels = kSize.width * kSize.height;
  EXPECT_GT(Changed(bare, help), pixels / 2) << "a panel over half of so small a picture";
  Press(kF1);
  EXPECT_LT(Changed(bare, Shown()), pixels / 20) << "numbers that have gone on";
}

class FlightDeckFiles : public FlightDeckTest {
 protected:
  void SetUp() override {
    FlightDeckTest::SetUp();
    before_ = std::filesystem::current_path();
    std::string pattern =
        (std::filesystem::temp_directory_path() / "alpenglow_test_XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    std::filesystem::current_path(pattern);
  }
  void TearDown() override {
    FlightDeckTest::TearDown();
    const std::filesystem::path folder = std::filesystem::current_path();
    std::filesystem::current_path(before_);
    std::filesystem::remove_all(folder);
  }
  std::filesystem::path before_;
};

TEST_F(FlightDeckFiles, F3WritesAPictureIntoTheCurrentFolder) {
  static_cast<void>(Shown());
  Press(kF3);
  EXPECT_EQ(ReadPng("skyview-0001.png").width, kSize.width);
  ASSERT_FALSE(Messages().empty());
  EXPECT_THAT(Messages().back().text, HasSubstr("skyview-0001.png"));
  EXPECT_FALSE(Messages().back().is_warning);
  Press(kF3);
  EXPECT_TRUE(std::filesystem::exists("skyview-0002.png")) << "no picture is written over";
}

TEST_F(FlightDeckFiles, APictureThatCannotBeWrittenIsAWarning) {
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

TEST_F(FlightDeckTest, APlaceThatIsAskedForMovesTheEye) {
  HudRequest request;
  request.place = HudPlaceRequest{47.25, 9.5, 2500.0};
  deck_->Serve(request);
  EXPECT_NEAR(flight_->eye().place.latitude_rad, 47.25 * kRadiansPerDegree, 1e-12);
  EXPECT_NEAR(flight_->eye().place.longitude_rad, 9.5 * kRadiansPerDegree, 1e-12);
  EXPECT_NEAR(flight_->eye().place.height_m, 2500.0, 1e-6);
  EXPECT_TRUE(Messages().empty());
}

TEST_F(FlightDeckTest, APlaceThatNobodyKnowsIsAWarningAndTheEyeStays) {
  const Eye before = flight_->eye();
  HudRequest request;
  request.named_place = "Nowhere at all";
  deck_->Serve(request);
  EXPECT_EQ(flight_->eye(), before);
  ASSERT_EQ(Messages().size(), 1U);
  EXPECT_TRUE(Messages().back().is_warning);
  EXPECT_THAT(Messages().back().text, HasSubstr("Nowhere at all"));
  EXPECT_FALSE(deck_->quit());
}

TEST_F(FlightDeckTest, MessagesGoAfterAWhile) {
  deck_->Say("hello");
  deck_->Advance({}, kSize, 4.0);
  EXPECT_EQ(Messages().size(), 1U);
  deck_->Advance({}, kSize, 5.0);
  EXPECT_TRUE(Messages().empty());
}

}  // namespace
}  // namespace alpenglow
