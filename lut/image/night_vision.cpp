// SPDX-License-Identifier: MIT
#include "lut/image/night_vision.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "lut/image/tone_mapping.h"
#include "lut/layer.h"

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

using Plane = std::vector<std::array<float, 3>>;

constexpr std::array<double, 9> kSpreads_px{0.0, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0};

/// Returns the pixel to which light beyond the edge is mirrored, so that no light is lost.
int Mirrored(int i, int count) {
  const int period = 2 * count;
  const int inside = ((i % period) + period) % period;
  return inside < count ? inside : period - 1 - inside;
}

std::vector<float> GaussianTaps(double sigma_px) {
  const int reach = static_cast<int>(std::ceil(4.0 * sigma_px));
  std::vector<float> taps;
  double sum = 0.0;
  for (int i = -reach; i <= reach; ++i) sum += std::exp(-0.5 * i * i / (sigma_px * sigma_px));
  for (int i = -reach; i <= reach; ++i)
    taps.push_back(static_cast<float>(std::exp(-0.5 * i * i / (sigma_px * sigma_px)) / sum));
  return taps;
}

/// Blurs lines of `count` pixels, `step` apart; the lines begin at multiples of `next`.
void BlurLines(Plane& plane, int lines, std::size_t next, int count, std::size_t step,
               const std::vector<float>& taps) {
  const int reach = static_cast<int>(taps.size() / 2);
  tbb::parallel_for(0, lines, [&](int line) {
    const std::size_t first = static_cast<std::size_t>(line) * next;
    Plane wide(static_cast<std::size_t>(count + 2 * reach));
    for (int i = -reach; i < count + reach; ++i)
      wide[static_cast<std::size_t>(i + reach)] =
          plane[first + step * static_cast<std::size_t>(Mirrored(i, count))];
    for (int i = 0; i < count; ++i) {
      std::array<float, 3> sum{};
      for (std::size_t k = 0; k < taps.size(); ++k) {
        for (std::size_t c = 0; c < 3; ++c)
          sum[c] += taps[k] * wide[static_cast<std::size_t>(i) + k][c];
      }
      plane[first + step * static_cast<std::size_t>(i)] = sum;
    }
  });
}

void Blur(Plane& plane, int width, int height, double sigma_px) {
  const std::vector<float> taps = GaussianTaps(sigma_px);
  const auto row = static_cast<std::size_t>(width);
  BlurLines(plane, height, row, width, 1, taps);
  BlurLines(plane, width, 1, height, row, taps);
}

/// Returns the position of a spread among kSpreads_px: the integer part is the index of the next
/// lower one, the fractional part the weight of the next higher one.
double LevelOf(double sigma_px) {
  const auto upper = std::upper_bound(kSpreads_px.begin(), kSpreads_px.end(), sigma_px);
  if (upper == kSpreads_px.end()) return static_cast<double>(kSpreads_px.size() - 1);
  const double high = *upper, low = *(upper - 1);
  const double share = (sigma_px * sigma_px - low * low) / (high * high - low * low);
  return static_cast<double>(upper - kSpreads_px.begin() - 1) + share;
}

}  // namespace

MesopicLight MesopicLightOf(double photopic_cd_per_m2, double scotopic_cd_per_m2) {
  if (!(photopic_cd_per_m2 > 0.0 || scotopic_cd_per_m2 > 0.0)) return {0.0, 0.0};
  // m - AdaptationOf(Mixed(m)) is <= 0 at 0 and >= 0 at 1.
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

HdrImage SeenByNight(HdrImage image) {
  const auto layer =
      std::find_if(image.layers.begin(), image.layers.end(),
                   [](const ImageLayer& channel) { return channel.name == kScotopicChannel; });
  if (layer == image.layers.end()) {
    throw InputError(
        fmt::format("the picture has no layer {}, which night vision needs", kScotopicChannel));
  }
  tbb::parallel_for(std::size_t{0}, image.rgb.size(), [&](std::size_t i) {
    image.rgb[i] = NightColour(image.rgb[i], layer->values[i]);
  });
  return image;
}

double AcuityAt(double luminance_cd_per_m2) {
  const double log_l = std::log10(std::max(luminance_cd_per_m2, 1e-6));
  return 17.25 * std::atan(1.4 * log_l + 0.35) + 25.72;
}

double SpreadAt(double luminance_cd_per_m2) {
  constexpr double kDay_cd_per_m2 = 5.0;
  const auto spread = [](double luminance) {
    return std::sqrt(0.5 * std::log(10.0)) / (kPi * AcuityAt(luminance)) * kRadiansPerDegree;
  };
  const double here = spread(luminance_cd_per_m2), day = spread(kDay_cd_per_m2);
  return std::sqrt(std::max(here * here - day * day, 0.0));
}

HdrImage WithAcuityOfNight(HdrImage image, double pixel_rad) {
  ALPENGLOW_ENSURE(pixel_rad, >, 0.0);
  std::vector<double> levels(image.rgb.size());
  tbb::parallel_for(std::size_t{0}, levels.size(), [&](std::size_t i) {
    const auto& [red, green, blue] = image.rgb[i];
    const double y = shared::Luminance<double>(double{red}, double{green}, double{blue});
    levels[i] = LevelOf(SpreadAt(std::max(y, 0.0)) / pixel_rad);
  });
  const Plane light = image.rgb;
  for (std::size_t level = 0; level < kSpreads_px.size(); ++level) {
    Plane part(light.size());
    bool any = false;
    for (std::size_t i = 0; i < light.size(); ++i) {
      const auto weight =
          static_cast<float>(std::max(0.0, 1.0 - std::abs(levels[i] - static_cast<double>(level))));
      any = any || weight > 0.0F;
      for (std::size_t c = 0; c < 3; ++c) part[i][c] = weight * light[i][c];
    }
    if (level == 0) {
      image.rgb = std::move(part);
      continue;
    }
    if (!any) continue;
    Blur(part, image.width, image.height, kSpreads_px.at(level));
    for (std::size_t i = 0; i < light.size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c) image.rgb[i][c] += part[i][c];
    }
  }
  return image;
}

}  // namespace alpenglow::lut
