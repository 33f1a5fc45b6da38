// SPDX-License-Identifier: MIT
// Whether a picture is the golden one; see tests/golden/README.md.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "renderer/picture_change.h"

namespace alpenglow {

struct PictureTolerance {
  double rms = 2e-3;
  double at_99_percent = 1e-2;
};

/// What is wrong with a picture, in words; empty when nothing is.
inline std::string FaultOfPicture(const Image& golden, const Image& picture,
                                  const PictureTolerance& tolerance = {}) {
  if (golden.width != picture.width || golden.height != picture.height) {
    return fmt::format("is {} x {}; the golden picture is {} x {}", picture.width, picture.height,
                       golden.width, golden.height);
  }
  for (const auto& pixel : picture.rgb) {
    if (!std::all_of(pixel.begin(), pixel.end(), [](float value) { return std::isfinite(value); }))
      return "has a pixel that is not finite";
  }
  const PictureChange change = ChangeOf(golden, picture);
  if (change.rms <= tolerance.rms && change.at_99_percent <= tolerance.at_99_percent) return "";
  return fmt::format(
      "differs from the golden picture by {:.2e} rms (at most {:.0e}) and {:.2e} at "
      "99 % (at most {:.0e})",
      change.rms, tolerance.rms, change.at_99_percent, tolerance.at_99_percent);
}

}  // namespace alpenglow
