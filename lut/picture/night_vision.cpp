// SPDX-License-Identifier: MIT
#include "lut/picture/night_vision.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/number/constants.h"
#include "atmosphere/text/error.h"
#include "lut/picture/tone_curve.h"

namespace alpenglow::lut {
namespace {

constexpr double kRodEfficiency = kLuminousEfficacy_lm_per_W / kScotopicEfficacy_lm_per_W;

// Linear sRGB of chromaticity (0.25, 0.25) and luminance 1.
constexpr std::array<double, 3> kRodWhite{0.7062, 0.9900, 1.9660};

double Mixed(double m, double photopic, double scotopic) {
  return (m * photopic + (1.0 - m) * scotopic * kRodEfficiency) / (m + (1.0 - m) * kRodEfficiency);
}

double AdaptationOf(double mesopic) {
  return std::clamp(0.7670 + 0.3334 * std::log10(mesopic), 0.0, 1.0);
}

}  // namespace

MesopicLight MesopicLightOf(double photopic_cd_per_m2, double scotopic_cd_per_m2) {
  if (!(photopic_cd_per_m2 > 0.0 || scotopic_cd_per_m2 > 0.0)) return {0.0, 0.0};
  // m - AdaptationOf(Mixed(m)) is not positive at 0 and not negative at 1.
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    const bool above = middle > AdaptationOf(Mixed(middle, photopic_cd_per_m2, scotopic_cd_per_m2));
    (above ? high : low) = middle;
  }
  const double m = AdaptationOf(Mixed(high, photopic_cd_per_m2, scotopic_cd_per_m2));
  const double cones = m * photopic_cd_per_m2;
  const double rods = (1.0 - m) * scotopic_cd_per_m2 * kRodEfficiency;
  return {Mixed(m, photopic_cd_per_m2, scotopic_cd_per_m2), cones / (cones + rods)};
}

namespace {

std::array<float, 3> NightColour(const std::array<float, 3>& rgb, float scotopic) {
  const double photopic = std::max(shared::Luminance<double>(rgb[0], rgb[1], rgb[2]), 0.0);
  const MesopicLight light = MesopicLightOf(photopic, std::max<double>(scotopic, 0.0));
  if (light.cone_share == 1.0) return rgb;
  const double cones =
      photopic > 0.0 ? light.cone_share * light.luminance_cd_per_m2 / photopic : 0.0;
  const double rods = (1.0 - light.cone_share) * light.luminance_cd_per_m2;
  const double gain = std::min(1.0, photopic / light.luminance_cd_per_m2);
  std::array<float, 3> seen;
  for (std::size_t c = 0; c < 3; ++c) {
    seen[c] =
        static_cast<float>(gain * (cones * static_cast<double>(rgb[c]) + rods * kRodWhite[c]));
  }
  return seen;
}

}  // namespace

Image SeenByNight(Image image) {
  const auto layer =
      std::find_if(image.layers.begin(), image.layers.end(),
                   [](const Channel& channel) { return channel.name == kScotopicChannel; });
  if (layer == image.layers.end()) {
    throw InputError(
        fmt::format("the picture has no layer {}, which night vision needs", kScotopicChannel));
  }
  tbb::parallel_for(std::size_t{0}, image.rgb.size(), [&](std::size_t i) {
    image.rgb[i] = NightColour(image.rgb[i], layer->values[i]);
  });
  return image;
}

}  // namespace alpenglow::lut
