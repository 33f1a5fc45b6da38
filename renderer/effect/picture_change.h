// SPDX-License-Identifier: MIT
// How much one picture differs from another of the same scene, as a number that a budget can hold.
//
//   d = |b - a| / max((|a| + |b|) / 2, floor)          of a pixel; |.| over linear R, G and B
//
// with floor a sixteenth of the luminance that the exposure meter makes middle grey: what is darker
// shows less than half a code value of an 8-bit picture for 1 % of it. d is 0 for equal pixels, the
// relative error where it is small, and 2 where light is in one picture and not in the other.
//
// What it does not see: where in the picture a change is, and that it may be what one looks at;
// that the two may be exposed differently; that a slow gradient shows an edge which rough ground
// hides; that the eye forgives errors of hue less than errors of lightness.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "lut/picture/image.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

struct PictureChange {
  double rms = 0.0;            // root mean square of d
  double at_99_percent = 0.0;  // 99th percentile of d
};

/// In [0, 2].
[[nodiscard]] double PixelChange(const std::array<float, 3>& a, const std::array<float, 3>& b,
                                 double floor_cd_per_m2);

/// The floor of a picture [cd/m^2]; the sun's disk is not metered.
[[nodiscard]] double ChangeFloor(const Image& reference);

/// Of all pixels. Throws InternalError for pictures of different sizes.
[[nodiscard]] PictureChange ChangeOf(const Image& reference, const Image& other);

/// What a sample of pixels says of the whole picture.
struct ChangeEstimate {
  PictureChange seen;     // of the sample
  PictureChange at_most;  // three standard errors more

  [[nodiscard]] static ChangeEstimate Of(std::vector<double> changes);
};

}  // namespace alpenglow::renderer
