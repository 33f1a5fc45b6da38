// SPDX-License-Identifier: MIT
// An axis of the sun's zenith cosine that is dense where light changes fastest, at the terminator:
//
//   mu_s = centre + width sinh(low + (high - low) v),   v in [0, 1], up to mu_s = 1
#pragma once

#include <algorithm>
#include <cmath>

namespace alpenglow::lut {

class SunAxis {
 public:
  SunAxis(double centre, double width, double lowest_mu_s)
      : centre_(centre),
        width_(width),
        low_(std::asinh((lowest_mu_s - centre) / width)),
        high_(std::asinh((1.0 - centre) / width)) {}

  /// v in [0, 1] between the ends, beyond them outside of it.
  [[nodiscard]] double Coordinate(double mu_s) const {
    return (std::asinh((mu_s - centre_) / width_) - low_) / (high_ - low_);
  }
  /// Its inverse, clamped to [-1, 1].
  [[nodiscard]] double MuS(double v) const {
    return std::clamp(centre_ + width_ * std::sinh(low_ + (high_ - low_) * v), -1.0, 1.0);
  }

  [[nodiscard]] double centre() const { return centre_; }
  [[nodiscard]] double width() const { return width_; }
  /// asinh((mu_s - centre) / width) at the ends.
  [[nodiscard]] double low() const { return low_; }
  [[nodiscard]] double high() const { return high_; }

 private:
  double centre_, width_, low_, high_;
};

}  // namespace alpenglow::lut
