// SPDX-License-Identifier: MIT
// From noon to noon, minute by minute: the exposure of a series makes no step of its own.
#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/constants.h"
#include "lut/image/look.h"
#include "renderer/picture/render.h"
#include "renderer/series/smooth_meter.h"
#include "tests/fixtures/bare_scene.h"

namespace alpenglow::renderer {
namespace {

constexpr double kThreePercent_ev = 0.0426;  // log2(1.03)

const GeodeticPosition& Place() {
  static const GeodeticPosition place = PlaceFromDegrees(46.5, 8.0, 0.0);
  return place;
}

std::vector<Frame> Minutes() {
  std::vector<Frame> frames;
  for (int i = 0; i <= 1440; ++i)
    frames.push_back({i, AddSeconds(UtcInstant{61212, 41400.0}, 60.0 * i)});
  return frames;
}

/// Of a sky [cd/m^2], made up: 5000 by day, 1e-3 in a moonlit night (darker ones are beyond the
/// camera's limit, and fade), as steep in between as twilight is (a
/// factor of 1.4 in a minute, where the sun is 6 degrees low).
double Luminance(const Frame& frame) {
  const double elevation = SunAt(Place(), frame.instant).elevation_rad / kRadiansPerDegree;
  return std::pow(10.0, -3.0 + 6.7 / (1.0 + std::exp(-(elevation + 6.0) / 2.2)));
}

double MeteredEv100(const Frame& frame) { return std::log2(8.0 * Luminance(frame)); }

/// As the meter of a small picture has it: with half a bin of its histogram, this way and that.
double RoughlyMeteredEv100(const Frame& frame) {
  constexpr double kBin_ev = 0.04;
  return kBin_ev * std::round(MeteredEv100(frame) / kBin_ev);
}

/// The largest change [EV] of what is shown from one minute to the next.
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

TEST(SteadySeries, MeteredMinutesDifferByLessThanThreePercentFromNoonToNoon) {
  const std::vector<Frame> frames = Minutes();
  SmoothMeter meter(frames, *FramesPerNode(frames, false), RoughlyMeteredEv100);
  EXPECT_LT(LargestStep([&](const Frame& frame) { return meter.At(frame); }), kThreePercent_ev);
}

TEST(SteadySeries, TheLightOfTheGroundExposesWithoutSteps) {
  // A sky of even luminance L lights the ground with pi L.
  EXPECT_LT(LargestStep([](const Frame& frame) { return IncidentEv100(kPi * Luminance(frame)); }),
            kThreePercent_ev);
}

TEST(SteadySeries, DuskFallsIntoADarkNightWithoutStepsWhereItIsShortAndWhereItIsLong) {
  for (const double latitude : {0.0, 46.5, 65.0}) {
    Scene scene = BareScene(2.0, 0.0, 45.0, 60.0);
    scene.place = PlaceFromDegrees(latitude, 8.0, 0.0);
    const SceneRenderer renderer(scene);
    const UtcInstant sunset =  // of the day after a new moon
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

TEST(SteadySeries, TheEyeLetsDuskBeDarkByItsLawAndMakesNoOtherStep) {
  ExpectNoOtherStepThanByItsLaw({ExposureRule::Kind::kEye});
}

TEST(SteadySeries, TheCameraPrintsNightDarkerByItsLawAndMakesNoOtherStep) {
  ExpectNoOtherStepThanByItsLaw({ExposureRule::Kind::kMetered});
}

}  // namespace
}  // namespace alpenglow::renderer
