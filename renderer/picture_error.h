// SPDX-License-Identifier: MIT
// How far a picture is from another, pixel by pixel.
#pragma once

#include <vector>

#include "lut/image.h"

namespace alpenglow {

/// Errors of linear R, G and B of every pixel, relative to the reference; what is darker there than
/// a hundredth (kDarkestPart) of the mean of its channel counts as if it were that bright. The mean
/// leaves out the brightest hundredth of the pixels: a sun's disk or a lamp would else hide the
/// errors of everything else. Throws InputError for pictures of different sizes, and for pixels
/// that are not finite.
[[nodiscard]] std::vector<double> ErrorsOfPicture(const Image& picture, const Image& reference);

}  // namespace alpenglow
