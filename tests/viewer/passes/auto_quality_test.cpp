// SPDX-License-Identifier: MIT
#include "viewer/passes/auto_quality.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "tests/fixtures/fault_of.h"

namespace alpenglow::viewer {
namespace {

/// A machine on which a frame takes so long at full resolution and high quality; low costs 0.4 of
/// that, medium 0.6, and pixels weigh as their number.
double FrameOf(const PaintedQuality& painted, double full_s) {
  const std::map<Quality, double> cost{
      {Quality::kLow, 0.4}, {Quality::kMedium, 0.6}, {Quality::kHigh, 1.0}};
  return full_s * cost.at(painted.quality) * (0.15 + 0.85 * painted.scale * painted.scale);
}

struct Outcome {
  PaintedQuality last;
  double frame_s;
  double longest_s;
  int changes;  // in the second half of the run
};
Outcome RunFor(double full_s, int frames) {
  AutoQuality quality(1.0 / 30.0);
  Outcome run{};
  for (int frame = 0; frame < frames; ++frame) {
    const PaintedQuality before = quality.painted();
    run.frame_s = FrameOf(before, full_s);
    run.longest_s = std::max(run.longest_s, run.frame_s);
    quality.Note(run.frame_s);
    if (frame > frames / 2 && !(quality.painted() == before)) ++run.changes;
  }
  run.last = quality.painted();
  return run;
}

TEST(AutoQuality, AFastMachineDrawsAtHighQuality) {
  EXPECT_EQ(RunFor(0.005, 2000).last, (PaintedQuality{Quality::kHigh, 1.0}));
}

TEST(AutoQuality, AFastMachineWaitsTwoSecondsForHighQuality) {
  EXPECT_EQ(RunFor(0.005, 70).last, (PaintedQuality{Quality::kHigh, 1.0}));  // 70 frames: 2.3 s
}

// A flight's worst frame may take three times its median: half of that is left to land that
// arrives.
TEST(AutoQuality, TheFirstFramesOfASlowMachineAreLittleLongerThanItsUsualOnes) {
  for (const double full_s : {0.05, 0.1, 0.2, 0.3, 2.0}) {
    const Outcome run = RunFor(full_s, 600);
    EXPECT_LT(run.longest_s, 2.0 * run.frame_s) << full_s;
  }
}

TEST(AutoQuality, FramesTakeAsLongAsWantedWhereAnyQualityDoes) {
  for (const double full_s : {0.02, 0.04, 0.06, 0.1, 0.2, 0.3}) {
    const Outcome run = RunFor(full_s, 6000);
    EXPECT_LT(run.frame_s, 1.16 / 30.0) << full_s;
    EXPECT_LE(run.changes, 4) << "it settles: a step up that fails is tried ever more rarely";
  }
}

TEST(AutoQuality, ASlowMachineGetsTheCheapestPicture) {
  EXPECT_EQ(RunFor(2.0, 200).last, (PaintedQuality{Quality::kLow, 0.25, Saving::kNearLand}));
}

TEST(AutoQuality, UnderHalfTheResolutionAllElseIsLeftOutFirst) {
  for (const double full_s : {0.08, 0.1, 0.12, 0.15, 0.2, 0.3, 0.4, 2.0}) {
    AutoQuality quality(1.0 / 30.0);
    for (int frame = 0; frame < 400; ++frame) {
      quality.Note(FrameOf(quality.painted(), full_s));
      const PaintedQuality& painted = quality.painted();
      EXPECT_TRUE(painted.scale >= 0.5 || painted.saving == Saving::kNearLand) << full_s;
      EXPECT_TRUE(painted.scale <= 0.5 || painted.saving == Saving::kNone) << full_s;
    }
  }
}

TEST(AutoQuality, RaysOfShaftsAndLampsAreAsFarApartOnTheScreen) {
  const PaintSizes half = SizesOf(PaintedQuality{Quality::kLow, 0.5, Saving::kNearLand});
  const PaintSizes quarter = SizesOf(PaintedQuality{Quality::kLow, 0.25, Saving::kNearLand});
  EXPECT_EQ(2 * quarter.lamps.step, half.lamps.step);
  EXPECT_EQ(2 * quarter.shade.detail.scale, half.shade.detail.scale);
}

TEST(AutoQuality, ThreeHugeFramesAreAnsweredAtOnce) {
  AutoQuality quality(1.0 / 30.0);
  for (int frame = 0; frame < 3; ++frame) quality.Note(0.6);
  EXPECT_EQ(quality.painted(), (PaintedQuality{Quality::kLow, 0.25, Saving::kNearLand}));
}

TEST(AutoQuality, AFrameInWhichADriverFinishesAProgramChangesNothing) {
  AutoQuality quality(1.0 / 30.0);
  const PaintedQuality first = quality.painted();
  quality.Note(0.7);
  for (int frame = 0; frame < 20; ++frame) {
    quality.Note(frame % 5 == 4 ? 0.3 : 0.03);
    EXPECT_EQ(quality.painted(), first) << frame;
  }
}

TEST(QualityRule, IsReadFromItsName) {
  EXPECT_EQ(QualityRuleFromText("auto").fixed, std::nullopt);
  EXPECT_EQ(QualityRuleFromText("reference").fixed, Quality::kReference);
  EXPECT_NE(tests::FaultOf([] { return QualityRuleFromText("best"); }).find("--quality"),
            std::string::npos);
  EXPECT_EQ(TextOf(PaintedQuality{Quality::kLow, 0.7}), "low, light at 0.7x");
  EXPECT_EQ(TextOf(PaintedQuality{Quality::kLow, 0.5, Saving::kFewLamps}),
            "low, light at 0.5x, coarse shafts, few lamps");
}

}  // namespace
}  // namespace alpenglow::viewer
