// SPDX-License-Identifier: MIT
// Measures how the display follows the light of a day. Each minute of the day is rendered as a
// small picture and tone-mapped by each exposure rule. Run by hand; results are in README.md.
//
//   studies day_exposure [DATE [SCENE [HEADING [FROM [TO]]]]]
//
// DATE is a day in UTC (2026-06-15). SCENE is "range" (the built-in range) or "bare" (sky and sea
// from 3000 m). HEADING is that of the view [degrees]. FROM and TO are hours of the day (0, 24).
// Each minute is printed as CSV on standard output, the summary on standard error.
//
// The light of a minute is the mean luminance of its picture without the sun's disk. Its law is the
// display light of a grey picture of this luminance, exposed by the rule: the display light if
// light changed without moving in the picture. A step is the ratio of a minute to the previous one,
// minus 1. A step is too large if it exceeds the step of the law in its minute by more than 3 %, or
// the largest step of the law in all minutes. A minute is contrary if its light falls and its
// display rises, or vice versa, by more than 0.1 % each, and the law does not do so.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/constants.h"
#include "lut/image/look.h"
#include "lut/image/metering.h"
#include "lut/image/tone_mapping.h"
#include "renderer/picture/render.h"
#include "renderer/scene/scene_options.h"
#include "renderer/series/frame_exposure.h"
#include "tests/bench/studies.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/luminance.h"

namespace alpenglow::renderer {
namespace {

constexpr double kTooLarge = 0.03, kSame = 1e-3;

struct Minute {
  Frame frame;
  HdrImage picture;
  double lux = 0.0;    // on level ground
  double light = 0.0;  // [cd/m^2]
  double sun_deg = 0.0, moon_deg = 0.0;
};

struct Rule {
  std::string name;
  ExposureRule rule;
  bool is_smooth;  // over two minutes, as in a series
};

double MeanLuminance(const HdrImage& picture) {
  double sum = 0.0, pixels = 0.0;
  for (const std::array<float, 3>& rgb : picture.rgb) {
    const double luminance = tests::Luminance(rgb);
    if (luminance > kSunDiskLuminance_cd_per_m2) continue;
    sum += luminance;
    pixels += 1.0;
  }
  return sum / pixels;
}

/// Returns the mean display light [0, 1] before rounding to codes.
double MeanDisplayLight(const HdrImage& picture, double ev100, const Look& look) {
  const HdrImage shown = look.rolls_off ? WithHighlightsRolledOff(picture, ev100) : picture;
  double sum = 0.0;
  for (const std::array<float, 3>& rgb : shown.rgb) {
    const Rgb<float> light =
        DisplayLight(look.curve, rgb, static_cast<float>(ExposureScale(ev100)), look.agx);
    sum += tests::Luminance({light[0], light[1], light[2]});
  }
  return sum / static_cast<double>(shown.rgb.size());
}

Scene SceneNamed(const std::string& name, double heading) {
  Scene scene = BareScene(3000.0, heading, 0.0, 60.0);
  if (name == "bare") return scene;
  scene = SceneFromOptions({});
  scene.camera.heading_rad = heading * kRadiansPerDegree;
  return scene;
}

std::vector<Minute> DayOf(const UtcTime& begin, const SceneRenderer& renderer, const Place& place,
                          const std::array<int, 2>& hours) {
  RenderSettings settings;
  settings.width = 48;
  settings.height = 27;
  std::vector<Minute> day;
  for (int minute = 60 * hours[0]; minute < 60 * hours[1]; ++minute) {
    const UtcTime now = AddSeconds(begin, 60.0 * minute);
    Minute made{{static_cast<int>(day.size()), now}, renderer.Render(now, settings)};
    made.lux = renderer.Illuminance(now);
    made.light = MeanLuminance(made.picture);
    made.sun_deg = renderer.ApparentSun(now).elevation_deg;
    made.moon_deg = TrueMoonAt(place, now).elevation_deg;
    day.push_back(std::move(made));
  }
  return day;
}

std::vector<double> ExposuresOf(const std::vector<Minute>& day, const Rule& rule,
                                const Look& look) {
  std::vector<Frame> frames;
  for (const Minute& minute : day) frames.push_back(minute.frame);
  const auto metered = [&](const Frame& frame) {
    return MeterEv100(day[static_cast<std::size_t>(frame.number)].picture,
                      kSunDiskLuminance_cd_per_m2);
  };
  std::optional<SmoothMeter> smooth;
  if (const std::optional<int> per_node = FramesPerNode(frames, false); rule.is_smooth && per_node)
    smooth.emplace(frames, *per_node, metered);
  std::vector<double> exposures;
  for (const Minute& minute : day) {
    const bool is_incident = rule.rule.kind == ExposureRule::Kind::kIncident;
    exposures.push_back(
        is_incident
            ? IncidentEv100(minute.lux)
            : Ev100By(rule.rule, smooth ? smooth->At(minute.frame) : metered(minute.frame), look));
  }
  return exposures;
}

/// Returns the display light of a grey picture of equal mean luminance.
double LawOf(const Minute& minute, const Rule& rule, const Look& look) {
  const auto light = static_cast<float>(minute.light);
  HdrImage grey(1, 1);
  grey.rgb[0] = {light, light, light};
  const double ev100 =
      rule.rule.kind == ExposureRule::Kind::kIncident
          ? IncidentEv100(minute.lux)
          : Ev100By(rule.rule, std::log2(100.0 * minute.light / kMeterConstant), look);
  return MeanDisplayLight(grey, ev100, look);
}

struct Summary {
  int too_large = 0, beyond_all = 0, contrary = 0;
  double largest_law = 0.0, largest_step = 0.0;
  double largest = 0.0, most_contrary = 0.0;
  std::string largest_at = "-", contrary_at = "-";
};

/// Light, display and law of a minute, relative to the previous minute, minus 1.
struct Step {
  double light = 0.0, shown = 0.0, law = 0.0;
};

std::vector<Step> StepsOf(const std::vector<Minute>& day, const Rule& rule) {
  const Look look = LookUnder(rule.rule, {});
  const std::vector<double> exposures = ExposuresOf(day, rule, look);
  std::vector<Step> steps(1);
  double shown_before = 0.0, law_before = 0.0;
  for (std::size_t i = 0; i < day.size(); ++i) {
    const Minute& minute = day[i];
    const double shown = MeanDisplayLight(minute.picture, exposures[i], look);
    const double law = LawOf(minute, rule, look);
    if (i > 0)
      steps.push_back({minute.light / day[i - 1].light - 1.0, shown / shown_before - 1.0,
                       law / law_before - 1.0});
    shown_before = shown, law_before = law;
    fmt::print("{},{},{:.2f},{:.2f},{:.4g},{:.4g},{:.3f},{:.5f},{:.5f},{:.5f},{:.5f}\n", rule.name,
               FormatUtc(minute.frame.instant), minute.sun_deg, minute.moon_deg, minute.lux,
               minute.light, exposures[i], shown, steps[i].light, steps[i].shown, steps[i].law);
  }
  return steps;
}

bool IsContrary(const Step& step) {
  return std::abs(step.light) > kSame && std::abs(step.shown) > kSame &&
         step.light * step.shown < 0.0 && step.law * step.shown < 0.0;
}

Summary SummaryOf(const std::vector<Minute>& day, const std::vector<Step>& steps) {
  Summary summary;
  for (const Step& step : steps)
    summary.largest_law = std::max(summary.largest_law, std::abs(step.law));
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const Step& step = steps[i];
    const std::string at = FormatUtc(day[i].frame.instant);
    const double beyond = std::abs(step.shown) - std::abs(step.law);
    summary.largest_step = std::max(summary.largest_step, std::abs(step.shown));
    if (beyond > kTooLarge) ++summary.too_large;
    if (std::abs(step.shown) > summary.largest_law + kTooLarge) ++summary.beyond_all;
    if (beyond > summary.largest) summary.largest = beyond, summary.largest_at = at;
    if (!IsContrary(step)) continue;
    ++summary.contrary;
    if (std::abs(step.shown) > summary.most_contrary)
      summary.most_contrary = std::abs(step.shown), summary.contrary_at = at;
  }
  return summary;
}

void PrintRule(const std::vector<Minute>& day, const Rule& rule) {
  const Summary summary = SummaryOf(day, StepsOf(day, rule));
  fmt::print(
      stderr,
      "{:<12} largest step {:.1f} %, of the law {:.1f} %, {} over 3 % beyond that; {} over 3 "
      "% beyond the law of their minute, the largest {:.1f} % at {}; {} contrary, the "
      "largest {:.1f} % at {}\n",
      rule.name, 100.0 * summary.largest_step, 100.0 * summary.largest_law, summary.beyond_all,
      summary.too_large, 100.0 * summary.largest, summary.largest_at, summary.contrary,
      100.0 * summary.most_contrary, summary.contrary_at);
}

void Run(const std::string& date, const std::string& name, double heading,
         const std::array<int, 2>& hours) {
  const Scene scene = SceneNamed(name, heading);
  const SceneRenderer renderer(scene);
  const std::vector<Minute> day =
      DayOf(ParseInstant(date + "T00:00:00Z"), renderer, scene.place, hours);
  fmt::print(
      "rule,utc,sun_deg,moon_deg,lux,light_cd_per_m2,ev100,display,light_step,display_step,law_"
      "step\n");
  for (const Rule& rule : {Rule{"eye", {ExposureRule::Kind::kEye}, false},
                           Rule{"eye-series", {ExposureRule::Kind::kEye}, true},
                           Rule{"auto", {ExposureRule::Kind::kMetered}, false},
                           Rule{"auto-series", {ExposureRule::Kind::kMetered}, true},
                           Rule{"incident", {ExposureRule::Kind::kIncident}, false}})
    PrintRule(day, rule);
}

}  // namespace
}  // namespace alpenglow::renderer

void alpenglow::tests::DayExposure(int argc, char** argv) {
  const auto argument = [&](int index, const char* otherwise) {
    return std::string(argc > index ? argv[index] : otherwise);
  };
  const auto number = [&](int index, const char* otherwise) {
    return std::atoi(argument(index, otherwise).c_str());
  };
  renderer::Run(argument(1, "2026-06-15"), argument(2, "bare"), number(3, "0"),
                {number(4, "0"), number(5, "24")});
}
