// SPDX-License-Identifier: MIT
// What people type about pictures: sizes, exposures, names of tone curves.
#pragma once

#include <optional>
#include <string>

#include "lut/picture/image.h"

namespace alpenglow::lut {

struct ImageSize {
  int width = 1280;
  int height = 720;
};

/// "1280x720", each in [1, largest]; throws InputError.
[[nodiscard]] ImageSize ImageSizeFromText(const std::string& text, int largest = 16384);

/// "auto" is nothing, a number in [-30, 30] an exposure value; throws InputError for other texts.
[[nodiscard]] std::optional<double> Ev100FromText(const std::string& text);

/// "agx", "aces", "reinhard", "pbr-neutral" or "linear"; throws InputError for another name.
[[nodiscard]] ToneCurve ToneCurveFromName(const std::string& name);
[[nodiscard]] std::string NameOf(ToneCurve curve);

}  // namespace alpenglow::lut
