// SPDX-License-Identifier: MIT
#include "lut/picture/highlights.h"

#include <oneapi/tbb/parallel_for.h>

#include <cmath>

#include "lut/picture/tone_curve.h"

namespace alpenglow::lut {

Image WithHighlightsRolledOff(Image image, double ev100) {
  const auto grey = static_cast<float>(kMeterConstant / 100.0 * std::exp2(ev100));
  tbb::parallel_for(std::size_t{0}, image.rgb.size(), [&](std::size_t i) {
    std::array<float, 3>& rgb = image.rgb[i];
    const float y = shared::Luminance(rgb[0], rgb[1], rgb[2]);
    if (!(y > grey)) return;
    const float stops = std::log2(y / grey);
    const float gain = std::exp2(std::log1p(stops) - stops);
    for (float& channel : rgb) channel *= gain;
  });
  return image;
}

}  // namespace alpenglow::lut
