// SPDX-License-Identifier: MIT
#include "lut/image/eye_adaptation.h"

#include <algorithm>
#include <cmath>

namespace alpenglow::lut {

double EyeAdaptation::Follow(double metered_ev100, double seconds) {
  const double regenerated = kRegenerated_ev_per_min * std::abs(seconds) / 60.0;
  const double before = pigment_ev100_.value_or(metered_ev100);
  pigment_ev100_ = std::max(metered_ev100, before - regenerated);
  return std::max(metered_ev100, *pigment_ev100_ - kAtOnce_ev);
}

}  // namespace alpenglow::lut
