// SPDX-License-Identifier: MIT
// The exposure of a series follows the light without steps of its own, also from noon to noon.
#include "renderer/series/frame_exposure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/constants.h"
#include "lut/image/look.h"
#include "renderer/picture/render.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/sanitized.h"

namespace alpenglow::renderer {
namespace {

std::vector<Frame> Every(double seconds, int count) {
  std::vector<Frame> frames;
  for (int i = 0; i < count; ++i) {
    const double second = 80000.0 + seconds * i;  // over midnight
    const int days = static_cast<int>(second / 86400.0);
    frames.push_back({i, UtcTime{61212 + days, second - 86400.0 * days}, seconds * i});
  }
  return frames;
}

TEST(SmoothMeter, NodesLieTwoMinutesApartOrOnEveryFrame) {
  EXPECT_EQ(FramesPerNode(Every(600.0, 20), false), 1);
  EXPECT_EQ(FramesPerNode(Every(60.0, 200), false), 2);
  EXPECT_EQ(FramesPerNode(Every(5.0, 2000), false), 24);
  EXPECT_EQ(FramesPerNode(Every(0.04, 200), true), 13) << "half a second of 25 frames";
}

TEST(SmoothMeter, StillsAndUnevenTimesAreMeteredAlone) {
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

TEST(SmoothMeter, CurvedFadesAreOffByASixthOfTheSecondDifference) {
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

TEST(SmoothMeter, AFrameAloneHasTheExposureOfTheSeries) {
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

constexpr double kThreePercent_ev = 0.0426;  // log2(1.03)

constexpr Place kPlaceOfSeries{46.5, 8.0, 0.0};

std::vector<Frame> Minutes() {
  std::vector<Frame> frames;
  for (int i = 0; i <= 1440; ++i)
    frames.push_back({i, AddSeconds(UtcTime{61212, 41400.0}, 60.0 * i)});
  return frames;
}

/// Returns the luminance of a simple sky [cd/m^2]: 5000 by day, 1e-3 in a moonlit night (darker
/// ones are beyond the camera's limit, and fade), with the slope of twilight in between (a factor
/// of 1.4 in a minute, where the sun is 6 degrees low).
double Luminance(const Frame& frame) {
  const double elevation = TrueSunAt(kPlaceOfSeries, frame.instant).elevation_deg;
  return std::pow(10.0, -3.0 + 6.7 / (1.0 + std::exp(-(elevation + 6.0) / 2.2)));
}

double MeteredEv100(const Frame& frame) { return std::log2(8.0 * Luminance(frame)); }

/// Returns the exposure of the meter of a small picture, rounded to a bin of its histogram.
double RoughlyMeteredEv100(const Frame& frame) {
  constexpr double kBin_ev = 0.04;
  return kBin_ev * std::round(MeteredEv100(frame) / kBin_ev);
}

/// Returns the largest change [EV] of the displayed light from one minute to the next.
template <typename Ev100>
double LargestStep(const Ev100& ev100) {
  double largest = 0.0, before = 0.0;
  for (const Frame& frame : Minutes()) {
    const double shown = MeteredEv100(frame) - ev100(frame);
    if (frame.number > 0) largest = std::max(largest, std::abs(shown - before));
    before = shown;
  }
  return largest;
}

TEST(SteadySeries, MeteredMinutesDifferByLessThanThreePercent) {
  const std::vector<Frame> frames = Minutes();
  SmoothMeter meter(frames, *FramesPerNode(frames, false), RoughlyMeteredEv100);
  EXPECT_LT(LargestStep([&](const Frame& frame) { return meter.At(frame); }), kThreePercent_ev);
}

TEST(SteadySeries, IncidentLightExposesWithoutSteps) {
  // A sky with the luminance L everywhere lights the ground with pi L.
  EXPECT_LT(LargestStep([](const Frame& frame) { return IncidentEv100(kPi * Luminance(frame)); }),
            kThreePercent_ev);
}

TEST(SteadySeries, ShortAndLongDusksFallWithoutSteps) {
  const std::vector<double> latitudes{0.0, 46.5, 65.0};
  for (const double latitude : tests::ScaledDown(latitudes, {65.0})) {
    Scene scene = BareScene(2.0, 0.0, 45.0, 60.0);
    scene.place = CheckedPlace({latitude, 8.0, 0.0});
    const SceneRenderer renderer(scene);
    const UtcTime sunset =  // of the day after a new moon
        *FindSunEvent(SunEvent::kSunset, scene.place, ParseInstant("2026-03-20T12:00:00Z"));
    double before = 0.0;
    for (int minute = 0; minute <= 150; ++minute) {
      const double lux = renderer.Illuminance(AddSeconds(sunset, 60.0 * minute));
      const double shown = std::log2(lux) - IncidentEv100(lux);
      if (minute > 0) {
        EXPECT_NEAR(shown, before, kThreePercent_ev) << latitude << ", " << minute << ", " << lux;
      }
      before = shown;
    }
  }
}

void ExpectNoOtherStepThanByItsLaw(const ExposureRule& rule) {
  const std::vector<Frame> frames = Minutes();
  SmoothMeter meter(frames, *FramesPerNode(frames, false), RoughlyMeteredEv100);
  double before = 0.0, wanted_before = 0.0;
  for (const Frame& frame : frames) {
    const double light = MeteredEv100(frame);
    const double shown = light - Ev100By(rule, meter.At(frame), {});
    const double wanted = light - Ev100By(rule, light, {});
    if (frame.number > 0) {
      EXPECT_NEAR(shown - before, wanted - wanted_before, kThreePercent_ev)
          << FormatUtc(frame.instant);
    }
    before = shown;
    wanted_before = wanted;
  }
}

TEST(SteadySeries, EyeAndCameraMakeNoStepsBeyondTheirLaw) {
  ExpectNoOtherStepThanByItsLaw({ExposureRule::Kind::kEye});
  ExpectNoOtherStepThanByItsLaw({ExposureRule::Kind::kMetered});
}

}  // namespace
}  // namespace alpenglow::renderer
