// SPDX-License-Identifier: MIT
// Pictures that are made while the flight goes on.
#include "viewer/picture_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <thread>

#include "renderer/scene/scene_options.h"
#include "tests/viewer/land/headless_land.h"

namespace alpenglow::viewer {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Mountains under a low sun, with shafts.
class PictureQueueTest : public tests::HeadlessTile {
 protected:
  [[nodiscard]] Scene Mountains() const {
    return SceneOverTile(tests::PlaceOfSample(120.0, 200.0, 0.0),
                         CameraFromDegrees({3500.0, false}, 330.0, -8.0, 7.0, 75.0));
  }
  [[nodiscard]] static FlightSessionSettings SettingsFor(const Scene& scene) {
    FlightSessionSettings settings;
    settings.land = LandSourceOf(scene);
    settings.quality = {Quality::kLow};
    settings.size = kSize;
    return settings;
  }
  [[nodiscard]] static UtcInstant Evening() { return ParseInstant("2026-06-21T18:20:00Z"); }
  /// Frames of a window, until all that was asked for has ended.
  static std::vector<PictureOutcome> DrawUntilEnd(PictureQueue& queue) {
    while (queue.UnderWay()) {
      queue.NextFrame();
      std::this_thread::yield();
    }
    return queue.TakeOutcomes();
  }
  static constexpr ImageSize kSize{64, 36};
  [[nodiscard]] std::filesystem::path File(const char* name) const { return folder_ / name; }
};

// The flight goes to another place, time, air and exposure as soon as the picture is asked for.
TEST_F(PictureQueueTest, APictureIsThatOfItsMomentWhateverFollows) {
  const Scene scene = Mountains();
  const FlightSessionSettings settings = SettingsFor(scene);
  const RenderTarget screen(kSize.width, kSize.height, RenderTarget::Depth::kNone);
  FlightSession flight(scene, Evening(), settings);
  flight.WaitUntilReady(kSize);
  AirChoice haze;
  haze.aerosol = 2.0;
  flight.edits().Use(haze, flight.eye().place);
  flight.exposure().Set(12.0);
  flight.Paint({screen.framebuffer(), kSize.width, kSize.height}, 0.1);
  const FlightMoment moment = flight.Moment();
  PictureQueue queue(scene, settings);
  queue.Ask({moment, File("moving.exr"), kSize});
  queue.Ask({moment, File("again.exr"), kSize});
  flight.edits().Use(AirChoice{}, flight.eye().place);
  flight.exposure().Set(3.0);
  while (queue.UnderWay()) {
    queue.NextFrame();
    flight.controller().clock().Shift(60.0);
    flight.Advance({}, 1.0);
    flight.Paint({screen.framebuffer(), kSize.width, kSize.height}, 0.1);
  }
  for (const PictureOutcome& outcome : queue.TakeOutcomes()) EXPECT_EQ(outcome.fault, "");
  FlightSession resting(scene, Evening(), settings);
  resting.edits().Use(haze, resting.eye().place);
  resting.exposure().Set(12.0);
  PictureWriter(resting).Write(File("resting.exr"), kSize);
  const Image at_rest = ReadExr(File("resting.exr"));
  const Metadata header_at_rest = ReadExrMetadata(File("resting.exr"));
  for (const char* name : {"moving.exr", "again.exr"}) {
    EXPECT_EQ(ReadExr(File(name)).rgb, at_rest.rgb) << name << ": the same code, to the bit";
    for (const char* key : {"alpenglow.ev100", "alpenglow.time", "alpenglow.camera_height"})
      EXPECT_EQ(ReadExrMetadata(File(name)).at(key), header_at_rest.at(key)) << name;
  }
}

TEST_F(PictureQueueTest, FramesAreDrawnBetweenThePartsOfAPicture) {
  const Scene scene = Mountains();
  const FlightSessionSettings settings = SettingsFor(scene);
  PictureQueue queue(scene, settings);
  FlightSession flight(scene, Evening(), settings);
  queue.Ask({flight.Moment(), File("picture.png"), kSize});
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

TEST_F(PictureQueueTest, AFolderThatIsGoneIsToldAndTheNextPictureIsWritten) {
  const Scene scene = Mountains();
  const FlightSessionSettings settings = SettingsFor(scene);
  PictureQueue queue(scene, settings);
  FlightSession flight(scene, Evening(), settings);
  queue.Ask({flight.Moment(), File("gone") / "picture.png", kSize});
  queue.Ask({flight.Moment(), File("picture.png"), kSize});
  const std::vector<PictureOutcome> outcomes = DrawUntilEnd(queue);
  ASSERT_EQ(outcomes.size(), 2U);
  EXPECT_THAT(outcomes[0].fault, HasSubstr("gone"));
  EXPECT_THAT(outcomes[1].fault, IsEmpty());
  EXPECT_TRUE(std::filesystem::exists(File("picture.png")));
}

TEST_F(PictureQueueTest, AQueueThatGoesHasWrittenWhatWasAskedFor) {
  const Scene scene = Mountains();
  const FlightSessionSettings settings = SettingsFor(scene);
  FlightSession flight(scene, Evening(), settings);
  {
    PictureQueue queue(scene, settings);
    queue.Ask({flight.Moment(), File("picture.png"), kSize});
  }
  EXPECT_EQ(ReadPng(File("picture.png")).width, kSize.width);
}

TEST_F(PictureQueueTest, WithoutAWindowPicturesWithInstrumentsAreNotWritten) {
  const Scene scene = Mountains();
  const FlightSessionSettings settings = SettingsFor(scene);
  FlightSession flight(scene, Evening(), settings);
  PictureQueue queue(scene, settings);
  const auto no_instruments = [](const Image&) {
    ADD_FAILURE() << "drawn into a window that has gone";
    return DisplayImage{};
  };
  queue.Ask({flight.Moment(), File("with.png"), kSize, no_instruments});
  queue.Ask({flight.Moment(), File("without.png"), kSize});
  queue.FinishWithoutWindow();
  EXPECT_FALSE(std::filesystem::exists(File("with.png")));
  EXPECT_TRUE(std::filesystem::exists(File("without.png")));
}

}  // namespace
}  // namespace alpenglow::viewer
