// SPDX-License-Identifier: MIT
#include "renderer/series/frame_exposure.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "atmosphere/base/parsing.h"
#include "atmosphere/math/constants.h"
#include "lut/image/exr.h"
#include "lut/image/eye_adaptation.h"
#include "lut/image/glare.h"
#include "lut/image/metering.h"

namespace alpenglow::renderer {
namespace {

constexpr char kWhite_k[] = "alpenglow.white_k";
constexpr char kWhiteRule[] = "alpenglow.white_balance_rule";
constexpr double kPerMired = 1e6;  // mireds are 1e6 / K

double SecondsAfter(const Frame& first, const Frame& frame, bool on_path) {
  if (on_path) return frame.path_s - first.path_s;
  return SecondsBetween(first.instant, frame.instant);
}

/// Returns the weights of the uniform cubic B-spline, `t` in [0, 1] of the way from the second node
/// to the third.
std::array<double, 4> WeightsAt(double t) {
  const double u = 1.0 - t;
  return {u * u * u / 6.0, 2.0 / 3.0 - t * t * (1.0 - 0.5 * t), 2.0 / 3.0 - u * u * (1.0 - 0.5 * u),
          t * t * t / 6.0};
}

}  // namespace

std::optional<int> FramesPerNode(const std::vector<Frame>& frames, bool on_path) {
  constexpr double kDay_s = 120.0, kPath_s = 0.5, kEven_s = 1e-3, kMostNodesApart = 5.0;
  const double apart = on_path ? kPath_s : kDay_s;
  if (frames.size() < 3) return std::nullopt;
  const double length = SecondsAfter(frames.front(), frames.back(), on_path);
  const double step = length / static_cast<double>(frames.size() - 1);
  if (!(step > 0.0 && step <= kMostNodesApart * apart + kEven_s)) return std::nullopt;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double at = SecondsAfter(frames.front(), frames[i], on_path);
    if (std::abs(at - step * static_cast<double>(i)) > kEven_s) return std::nullopt;
  }
  return std::max(static_cast<int>(std::lround(apart / step)), 1);
}

SmoothMeter::SmoothMeter(const std::vector<Frame>& frames, int frames_per_node,
                         std::function<double(const Frame&)> metered)
    : frames_(frames),
      frames_per_node_(frames_per_node),
      last_node_((static_cast<int>(frames.size()) - 1) / frames_per_node),
      metered_(std::move(metered)) {}

double SmoothMeter::Node(int node) {
  if (last_node_ == 0) node = 0;
  if (node < 0) return 2.0 * Node(0) - Node(-node);
  if (node > last_node_) return 2.0 * Node(last_node_) - Node(2 * last_node_ - node);
  const auto known = nodes_.find(node);
  if (known != nodes_.end()) return known->second;
  const auto frame = static_cast<std::size_t>(node) * static_cast<std::size_t>(frames_per_node_);
  return nodes_[node] = metered_(frames_[frame]);
}

double SmoothMeter::At(const Frame& frame) {
  const int index = frame.number - frames_.front().number;
  const int node = index / frames_per_node_;
  const std::array<double, 4> weights =
      WeightsAt(static_cast<double>(index % frames_per_node_) / frames_per_node_);
  double value = 0.0;
  for (int i = 0; i < 4; ++i) {
    const double weight = weights[static_cast<std::size_t>(i)];
    if (weight > 0.0) value += weight * Node(node - 1 + i);
  }
  return std::round(1e4 * value) / 1e4;
}

std::string SmoothMeter::InWords() const {
  return fmt::format(
      "smoothed by a B-spline over frames 0, {}, {} ... of {} until {}, metered small",
      frames_per_node_, 2 * frames_per_node_, frames_.size(), FormatUtc(frames_.back().instant));
}

Metadata HeaderOfDevelopment(const SeriesOutput& output, const Development& development) {
  Metadata metadata = HeaderOfExposure(output.exposure, development.ev100, development.rule);
  metadata.merge(HeaderOfLook(development.look));
  if (!development.white_rule.empty()) {
    metadata[kWhiteRule] = development.white_rule;
    metadata[kWhite_k] = fmt::format("{:.0f}", development.look.white.kelvin.value());
  }
  if (output.glare) metadata["alpenglow.glare"] = "eye, in the developed picture only";
  return metadata;
}

SeriesExposure::SeriesExposure(const SeriesSource& source, const std::vector<Frame>& frames,
                               const SeriesOutput& output)
    : source_(source), frames_(frames), output_(output) {
  const std::optional<int> per_node = FramesPerNode(frames, source.viewpoint.path.has_value());
  if (!source.preview || !per_node) return;
  const ExposureRule::Kind kind = output.exposure.kind;
  if (kind == ExposureRule::Kind::kMetered) {
    smooth_ev100_.emplace(frames, *per_node,
                          [this](const Frame& frame) { return ReadingOf(frame).ev100; });
  } else if (kind == ExposureRule::Kind::kEye) {
    smooth_ev100_.emplace(frames, *per_node, [this, step = *per_node](const Frame& frame) {
      return AdaptedEv100(frame, step);
    });
  }
  if (output.look.white.IsOfPicture()) {
    smooth_mired_.emplace(frames, *per_node, [this](const Frame& frame) {
      return ReadingOf(frame).white_mired.value();
    });
  }
}

PictureView SeriesExposure::ViewOf(const Frame& frame, const HdrImage& image) const {
  const Projection projection = source_.ProjectionOf(frame);
  const double across =
      projection == Projection::kCamera ? 2.0 * std::tan(0.5 * source_.FovOf(frame)) : 2.0 * kPi;
  return {projection, across / image.width};
}

const SeriesExposure::Reading& SeriesExposure::ReadingOf(const Frame& frame) {
  const auto known = readings_.find(frame.number);
  if (known != readings_.end()) return known->second;
  const HdrImage preview = source_.preview(frame);
  const Look look = Settled(output_.look, preview, ViewOf(frame, preview));
  Reading reading{Metered(frame, preview, look), std::nullopt};
  if (look.white.kelvin) reading.white_mired = kPerMired / *look.white.kelvin;
  return readings_[frame.number] = reading;
}

double SeriesExposure::AdaptedEv100(const Frame& frame, int frames_per_node) {
  constexpr double kForgotten_s =
      60.0 * (kBrightestEv100 - kDarkestEv100) / EyeAdaptation::kRegenerated_ev_per_min;
  int first = frame.number - frames_.front().number;
  const auto at = [&](int index) -> const Frame& {
    return frames_[static_cast<std::size_t>(index)];
  };
  while (first >= frames_per_node &&
         SecondsBetween(at(first).instant, frame.instant) < kForgotten_s)
    first -= frames_per_node;
  EyeAdaptation eye;
  double adapted = ReadingOf(at(first)).ev100;
  for (int i = first; i <= frame.number - frames_.front().number; i += frames_per_node) {
    const double passed =
        SecondsBetween(at(std::max(i - frames_per_node, first)).instant, at(i).instant);
    adapted = eye.Follow(ReadingOf(at(i)).ev100, passed);
  }
  return adapted;
}

Look SeriesExposure::LookOf(const Frame& frame, const HdrImage& image, bool rendered) {
  if (!smooth_mired_) return Settled(output_.look, image, ViewOf(frame, image));
  Look look = output_.look;
  if (!rendered) look.white.kelvin = KeptWhite(frame);
  if (!look.white.kelvin) look.white.kelvin = std::round(kPerMired / smooth_mired_->At(frame));
  return look;
}

std::optional<double> SeriesExposure::KeptWhite(const Frame& frame) const {
  const Metadata kept = ReadExrMetadata(output_.name.Picture(frame.number));
  const auto rule = kept.find(kWhiteRule), kelvin = kept.find(kWhite_k);
  if (rule == kept.end() || rule->second != smooth_mired_->InWords() || kelvin == kept.end())
    return std::nullopt;
  return ParseNumber(kelvin->second);
}

double SeriesExposure::Metered(const Frame& frame, const HdrImage& image, const Look& look) const {
  const PictureView view = ViewOf(frame, image);
  return MeterEv100(lut::Seen(image, look, view), kSunDiskLuminance_cd_per_m2, view.projection);
}

Development SeriesExposure::DevelopmentOf(const Frame& frame, const HdrImage& image,
                                          bool rendered) {
  const Look look = LookOf(frame, image, rendered);
  const ExposureRule& rule = output_.exposure;
  std::string words = RuleInWords(rule);
  const std::string white = smooth_mired_ ? smooth_mired_->InWords() : "";
  switch (rule.kind) {
    case ExposureRule::Kind::kFixed:
      return {look, rule.ev100, words, white};
    case ExposureRule::Kind::kIncident:
      return {look, IncidentEv100(source_.illuminance(frame)), words, white};
    case ExposureRule::Kind::kMetered:
    case ExposureRule::Kind::kEye:
      break;
  }
  if (!smooth_ev100_) return {look, Ev100By(rule, Metered(frame, image, look), look), words, white};
  words += "; " + smooth_ev100_->InWords();
  if (!rendered) {
    if (const std::optional<double> known = KeptEv100(frame, look, words))
      return {look, *known, words, white};
  }
  return {look, Ev100By(rule, smooth_ev100_->At(frame), look), words, white};
}

std::optional<double> SeriesExposure::KeptEv100(const Frame& frame, const Look& look,
                                                const std::string& words) const {
  const Metadata kept = ReadExrMetadata(output_.name.Picture(frame.number));
  Metadata wanted = HeaderOfExposure(output_.exposure, 0.0, words);
  wanted.erase(kEv100Key);
  wanted.merge(HeaderOfLook(look));
  if (!std::includes(kept.begin(), kept.end(), wanted.begin(), wanted.end())) return std::nullopt;
  return ParseNumber(kept.at(kEv100Key));
}

HdrImage SeriesExposure::Seen(const Frame& frame, const HdrImage& image, const Look& look) const {
  const PictureView view = ViewOf(frame, image);
  if (!output_.glare) return lut::Seen(image, look, view);
  return lut::Seen(WithGlareOfEye(image, view.pixel_rad), look, view);
}

}  // namespace alpenglow::renderer
