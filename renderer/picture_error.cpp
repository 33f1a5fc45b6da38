// SPDX-License-Identifier: MIT
#include "renderer/picture_error.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "atmosphere/error.h"
#include "lut/report_rays.h"

namespace alpenglow {
namespace {

/// Mean of a channel without its brightest hundredth.
double MeanOf(const Image& image, std::size_t channel) {
  std::vector<float> values;
  for (const auto& pixel : image.rgb) values.push_back(pixel[channel]);
  std::sort(values.begin(), values.end());
  values.resize(values.size() - values.size() / 100);
  double sum = 0.0;
  for (const float value : values) sum += static_cast<double>(value);
  return sum / static_cast<double>(values.size());
}

}  // namespace

std::vector<double> ErrorsOfPicture(const Image& picture, const Image& reference) {
  if (picture.width != reference.width || picture.height != reference.height) {
    throw InputError(fmt::format("pictures of {} x {} and {} x {} cannot be compared",
                                 picture.width, picture.height, reference.width, reference.height));
  }
  std::vector<double> errors;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const double floor = kDarkestPart * MeanOf(reference, channel);
    for (std::size_t i = 0; i < picture.rgb.size(); ++i) {
      const double value = static_cast<double>(picture.rgb[i][channel]);
      const double truth = static_cast<double>(reference.rgb[i][channel]);
      if (!std::isfinite(value) || !std::isfinite(truth))
        throw InputError(fmt::format("pixel {} of a picture is not finite", i));
      const double scale = std::max({std::abs(truth), floor, 1e-30});
      errors.push_back(std::abs(value - truth) / scale);
    }
  }
  return errors;
}

}  // namespace alpenglow
