// SPDX-License-Identifier: MIT
#include "viewer/passes/auto_quality.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "atmosphere/base/error.h"
#include "atmosphere/base/names.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {
namespace {

constexpr EnumNames kQualities{{std::pair{Quality::kLow, "low"},
                                {Quality::kMedium, "medium"},
                                {Quality::kHigh, "high"},
                                {Quality::kReference, "reference"}}};
constexpr char kAutomatic[] = "auto";

/// A rendering configuration and its approximate relative cost.
struct Step {
  PaintedQuality painted;
  double cost;
};

// Measured with llvmpipe on one thread over the built-in range at 1280x720 in the morning. That
// view is wide and has few shafts and no lamps, so the first savings have little effect in it.
constexpr std::array<Step, 12> kSteps{{{{Quality::kHigh, 1.0}, 1.7},
                                       {{Quality::kMedium, 1.0}, 0.53},
                                       {{Quality::kMedium, 0.8}, 0.46},
                                       {{Quality::kMedium, 0.65}, 0.38},
                                       {{Quality::kMedium, 0.5}, 0.28},
                                       {{Quality::kLow, 0.5}, 0.235},
                                       {{Quality::kLow, 0.5, Saving::kCoarseShafts}, 0.233},
                                       {{Quality::kLow, 0.5, Saving::kFewLamps}, 0.232},
                                       {{Quality::kLow, 0.5, Saving::kNearLand}, 0.23},
                                       {{Quality::kLow, 0.4, Saving::kNearLand}, 0.19},
                                       {{Quality::kLow, 0.33, Saving::kNearLand}, 0.17},
                                       {{Quality::kLow, 0.25, Saving::kNearLand}, 0.15}}};
// The first frames are the slowest, since land arrives and programs are compiled. The start is
// therefore a step that nearly every machine draws in time.
constexpr int kFirstStep = 5;

const Step& StepAt(int index) { return kSteps[static_cast<std::size_t>(index)]; }

constexpr double kTooLong = 1.15;
constexpr double kRoom = 0.85;
constexpr double kDown_s = 0.5;
constexpr double kUp_s = 2.0;
constexpr double kLongestWait_s = 64.0;
constexpr std::size_t kLeastFrames = 3, kMostTimedFrames = 9;

double MedianOf(std::deque<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

std::string NameOf(Quality quality) { return kQualities.Of(quality); }

QualityRule QualityRuleFromText(const std::string& text) {
  if (text == kAutomatic) return {};
  return {kQualities.Named(text, "--quality is \"{}\"; it is one of auto, {}")};
}

std::vector<std::string> QualityRuleTexts() {
  std::vector<std::string> texts = kQualities.All();
  texts.insert(texts.begin(), kAutomatic);
  return texts;
}

PaintedQuality PaintedAlways(Quality quality) {
  return {quality, quality == Quality::kLow ? 0.5 : 1.0};
}

std::string TextOf(const PaintedQuality& painted) {
  std::string text = NameOf(painted.quality);
  if (painted.scale < 1.0) text += fmt::format(", light at {:.2g}x", painted.scale);
  if (painted.saving >= Saving::kCoarseShafts) text += ", coarse shafts";
  if (painted.saving >= Saving::kFewLamps) text += ", few lamps";
  if (painted.saving >= Saving::kNearLand) text += ", detail near by";
  return text;
}

AutoQuality::AutoQuality(double wanted_frame_s) : wanted_s_(wanted_frame_s), step_(kFirstStep) {}

const PaintedQuality& AutoQuality::painted() const { return StepAt(step_).painted; }

void AutoQuality::Record(double frame_s) {
  frames_s_.push_back(frame_s);
  if (frames_s_.size() > kMostTimedFrames) frames_s_.pop_front();
  since_change_s_ += std::max(frame_s, wanted_s_);
  if (frames_s_.size() < kLeastFrames) return;
  const double usual_s = MedianOf(frames_s_);
  const int last = static_cast<int>(kSteps.size()) - 1;
  const auto expected_s = [&](int step) {
    return usual_s * StepAt(step).cost / StepAt(step_).cost;
  };
  int next = step_;
  if (usual_s > kTooLong * wanted_s_ && since_change_s_ >= kDown_s) {
    while (next < last && expected_s(next) > wanted_s_) ++next;
    // If the previous step up was too slow, wait longer before the next attempt.
    if (since_change_s_ < wait_up_s_) wait_up_s_ = std::min(2.0 * wait_up_s_, kLongestWait_s);
  } else if (since_change_s_ >= wait_up_s_) {
    while (next > 0 && expected_s(next - 1) < kRoom * wanted_s_) --next;
  }
  if (since_change_s_ > 2.0 * kLongestWait_s) wait_up_s_ = kUp_s;
  if (next == step_) return;
  step_ = next;
  since_change_s_ = 0.0;
  frames_s_.clear();
}

namespace {

// Returns at least two: with one, passes are omitted and other programs are used.
int Scaled(int pixels, double scale) {
  return std::max(static_cast<int>(std::lround(pixels * scale)), 2);
}

}  // namespace

PaintSizes SizesOf(Quality quality) {
  PaintSizes sizes;
  switch (quality) {
    case Quality::kLow:
      sizes.air = AirQuality::kLow;
      sizes.land_detail = 64.0;
      sizes.shade = kLowShade;
      sizes.lamps = kLowLamps;
      sizes.layer_map = kCoarseLayerMap;
      sizes.clouds = kLowClouds;
      sizes.dropped_octaves = 1;
      break;
    case Quality::kMedium:
      sizes.dropped_octaves = 1;
      break;
    case Quality::kHigh:
    case Quality::kReference:
      sizes.air = AirQuality::kHigh;
      sizes.land_detail = 1024.0;
      sizes.shade = kHighShade;
      sizes.lamps = kHighLamps;
      sizes.layer_map = kFineLayerMap;
      sizes.clouds = kHighClouds;
      sizes.sky_by_pixel = true;
      break;
  }
  return sizes;
}

PaintSizes SizesOf(const PaintedQuality& painted) {
  PaintSizes sizes = SizesOf(painted.quality);
  if (painted.saving >= Saving::kCoarseShafts) sizes.shade.detail = kCoarseShaftDetail;
  if (painted.saving >= Saving::kFewLamps) sizes.most_lamps = 12;
  if (painted.saving >= Saving::kNearLand) sizes.land_growth = 1.0;
  const double usual = PaintedAlways(painted.quality).scale;
  if (painted.scale < usual) {
    const double scale = painted.scale / usual;
    sizes.shade.detail.scale = Scaled(sizes.shade.detail.scale, scale);
    sizes.lamps.step = Scaled(sizes.lamps.step, scale);
  }
  return sizes;
}

}  // namespace alpenglow::viewer
