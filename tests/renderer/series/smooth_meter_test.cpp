// SPDX-License-Identifier: MIT
#include "renderer/series/smooth_meter.h"

#include <gtest/gtest.h>

#include <cmath>

namespace alpenglow::renderer {
namespace {

std::vector<Frame> Every(double seconds, int count) {
  std::vector<Frame> frames;
  for (int i = 0; i < count; ++i) {
    const double second = 80000.0 + seconds * i;  // over midnight
    const int days = static_cast<int>(second / 86400.0);
    frames.push_back({i, UtcInstant{61212 + days, second - 86400.0 * days}, seconds * i});
  }
  return frames;
}

TEST(SmoothMeter, NodesLieTwoMinutesApartOrOnEveryFrame) {
  EXPECT_EQ(FramesPerNode(Every(600.0, 20), false), 1);
  EXPECT_EQ(FramesPerNode(Every(60.0, 200), false), 2);
  EXPECT_EQ(FramesPerNode(Every(5.0, 2000), false), 24);
  EXPECT_EQ(FramesPerNode(Every(0.04, 200), true), 13) << "half a second of 25 frames";
}

TEST(SmoothMeter, StillsAndUnevenTimesAreMeteredByThemselves) {
  EXPECT_EQ(FramesPerNode(Every(600.0, 1), false), std::nullopt);
  EXPECT_EQ(FramesPerNode(Every(600.0, 2), false), std::nullopt);
  EXPECT_EQ(FramesPerNode(Every(2400.0, 20), false), std::nullopt) << "pictures of a day, no film";
  std::vector<Frame> uneven = Every(600.0, 5);
  uneven[2].instant.second_of_day += 1.0;
  EXPECT_EQ(FramesPerNode(uneven, false), std::nullopt);
  EXPECT_EQ(FramesPerNode({{0, {}}, {1, {}}, {2, {}}}, false), std::nullopt);
}

TEST(SmoothMeter, LightThatFadesEvenlyIsFollowedWithoutALag) {
  const std::vector<Frame> frames = Every(30.0, 99);
  for (const int per_node : {1, 4, 40, 98, 200}) {
    SmoothMeter meter(frames, per_node,
                      [](const Frame& frame) { return 15.0 - 0.05 * frame.number; });
    for (const Frame& frame : frames) {
      const double truth = per_node == 200 ? 15.0 : 15.0 - 0.05 * frame.number;
      EXPECT_NEAR(meter.At(frame), truth, 1e-4) << "four digits; one node alone is a constant";
    }
  }
}

TEST(SmoothMeter, LightThatFadesFasterAndFasterIsOffByASixthOfTheSecondDifference) {
  const std::vector<Frame> frames = Every(60.0, 61);
  SmoothMeter meter(frames, 4,
                    [](const Frame& frame) { return -0.01 * frame.number * frame.number; });
  for (int i = 8; i < 52; ++i) {
    EXPECT_NEAR(meter.At(frames[static_cast<std::size_t>(i)]),
                -0.01 * i * i - 0.01 * 2.0 * 16.0 / 6.0, 1e-4)
        << "nodes are four frames apart; four digits";
  }
}

TEST(SmoothMeter, AStepOfTheLightIsSpreadOverFrames) {
  const std::vector<Frame> frames = Every(10.0, 200);
  constexpr double kStep = 3.0;
  constexpr int kPerNode = 12;
  SmoothMeter meter(frames, kPerNode,
                    [](const Frame& frame) { return frame.number < 100 ? 9.0 : 9.0 + kStep; });
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const double step = meter.At(frames[i]) - meter.At(frames[i - 1]);
    EXPECT_GE(step, -1e-4);
    EXPECT_LE(step, 0.75 * kStep / kPerNode + 2e-4) << "3 s / (4 n)";
  }
  EXPECT_NEAR(meter.At(frames.back()), 12.0, 1e-4);
}

TEST(SmoothMeter, AFrameAloneHasTheExposureThatItHasAmongOthers) {
  const std::vector<Frame> frames = Every(20.0, 100);
  const auto metered = [](const Frame& frame) { return 8.0 + std::sin(0.3 * frame.number); };
  SmoothMeter all(frames, 6, metered);
  for (auto frame = frames.rbegin(); frame != frames.rend(); ++frame) {
    SmoothMeter alone(frames, 6, metered);
    EXPECT_EQ(alone.At(*frame), all.At(*frame)) << frame->number;
  }
}

TEST(SmoothMeter, ANodeIsMeteredOnce) {
  const std::vector<Frame> frames = Every(20.0, 100);
  int asked = 0;
  SmoothMeter meter(frames, 6, [&](const Frame& frame) {
    EXPECT_EQ(frame.number % 6, 0);
    return static_cast<double>(++asked);
  });
  for (const Frame& frame : frames) (void)meter.At(frame);
  EXPECT_EQ(asked, 17) << "frames 0, 6 ... 96";
}

}  // namespace
}  // namespace alpenglow::renderer
