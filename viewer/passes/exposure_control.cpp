// SPDX-License-Identifier: MIT
#include "viewer/passes/exposure_control.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lut/image/white_balance.h"

namespace alpenglow::viewer {

double AdaptedEv100(std::optional<double> before, double metered, double seconds) {
  constexpr double kHalfTime_s = 0.3;
  if (!before) return metered;
  return metered + (*before - metered) * std::exp2(-seconds / kHalfTime_s);
}

WhiteBalance AdaptedWhite(const WhiteBalance& before, const WhiteBalance& metered, double seconds) {
  if (before.kind != metered.kind || !before.kelvin || !metered.kelvin) return metered;
  return {metered.kind, 1.0 / AdaptedEv100(1.0 / *before.kelvin, 1.0 / *metered.kelvin, seconds)};
}

ExposureControl::ExposureControl(const ExposureRule& rule, const Look& look)
    : rule_(rule), look_(look) {
  if (rule.kind != ExposureRule::Kind::kFixed) return;
  Set(rule.ev100);
  rule_ = {};  // applies once the exposure is unlocked
}

void ExposureControl::Use(const Look& look) {
  if (look.white != look_.white) white_.reset();
  look_ = look;
}

void ExposureControl::Forget() {
  if (!exposure_.locked) exposure_.ev100 = std::nullopt;
  white_ = std::nullopt;
}

double ExposureControl::AdaptedTo(double metered_ev100, const UtcTime& now, double seconds) {
  if (rule_.kind != ExposureRule::Kind::kEye) return metered_ev100;
  const UtcTime before = adapted_at_.value_or(now);
  adapted_at_ = now;
  return adaptation_.Follow(metered_ev100,
                            std::max(seconds, std::abs(SecondsBetween(before, now))));
}

void ExposureControl::Follow(const MeterReading& metered, const UtcTime& now, double seconds) {
  if (!exposure_.locked) {
    const double wanted = Ev100By(rule_, AdaptedTo(metered.ev100, now, seconds), look_);
    exposure_.ev100 = AdaptedEv100(exposure_.ev100, wanted - exposure_.compensation_ev, seconds);
  }
  white_ = white_ ? AdaptedWhite(*white_, metered.white, seconds) : metered.white;
}

Look ExposureControl::ShownLook() const {
  Look shown = look_;
  if (white_) shown.white = *white_;
  return shown;
}

std::optional<double> ExposureControl::white_k() const {
  if (!white_) return std::nullopt;
  return white_->IsDaylight() ? std::optional(kDaylight_k) : white_->kelvin;
}

Development ExposureControl::DevelopmentOf(const HdrImage& picture, Projection projection) const {
  if (white_ && exposure_.ev100) return {ShownLook(), *exposure_.ev100};
  const MeterReading reading = ReadingOf(picture, look_, projection);
  Look look = look_;
  look.white = reading.white;
  const double metered = Ev100By(rule_, reading.ev100, look_);
  return {look, exposure_.ev100.value_or(metered - exposure_.compensation_ev)};
}

Metadata ExposureControl::Header(const Development& development) const {
  const ExposureRule rule =
      exposure_.locked ? ExposureRule{ExposureRule::Kind::kFixed, development.ev100} : rule_;
  Metadata header = HeaderOfExposure(rule, development.ev100, RuleInWords(rule));
  header["alpenglow.exposure_compensation_ev"] =
      fmt::format("{}", exposure_.locked ? 0.0 : exposure_.compensation_ev);
  header.merge(HeaderOfLook(development.look));
  return header;
}

}  // namespace alpenglow::viewer
