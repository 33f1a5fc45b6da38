// SPDX-License-Identifier: MIT
// Exposure as photographers count it: EV at ISO 100, reflected-light meters of K = 12.5 (ISO 2720),
// saturation-based sensitivity (ISO 12232).
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "atmosphere/number/constants.h"
#include "atmosphere/text/error.h"
#include "lut/picture/image.h"
#include "lut/picture/tone_curve.h"

namespace alpenglow {
namespace {

constexpr int kBinsPerStop = 16;
constexpr int kLowestStop = -24;  // log2 cd/m^2; less than this is no light to meter
constexpr int kHighestStop = 40;
constexpr std::size_t kBins = (kHighestStop - kLowestStop) * kBinsPerStop;

using Histogram = std::array<double, kBins>;

/// Pixels of a row of latitudes stand for less of the sphere towards its poles.
double WeightOfRow(int row, int rows, Projection projection) {
  return projection == Projection::kLatitudeLongitude ? std::sin(kPi * (row + 0.5) / rows) : 1.0;
}

Histogram HistogramOf(const Image& image, double ignore_above_cd_per_m2, Projection projection) {
  Histogram histogram = {};
  for (int row = 0; row < image.height; ++row) {
    const double weight = WeightOfRow(row, image.height, projection);
    for (int column = 0; column < image.width; ++column) {
      const std::array<float, 3>& pixel = image.at(column, row);
      const double y = shared::Luminance<double>(pixel[0], pixel[1], pixel[2]);
      if (!(y >= std::exp2(kLowestStop) && y <= ignore_above_cd_per_m2)) continue;
      const double bin = (std::log2(y) - kLowestStop) * kBinsPerStop;
      histogram[static_cast<std::size_t>(std::clamp(bin, 0.0, kBins - 1.0))] += weight;
    }
  }
  return histogram;
}

/// The bin that a share of all pixels lies below.
std::size_t BinAtShare(const Histogram& histogram, double share) {
  const double wanted = share * std::accumulate(histogram.begin(), histogram.end(), 0.0);
  double seen = 0.0;
  std::size_t bin = 0;
  while (bin + 1 < kBins && seen + histogram[bin] < wanted) seen += histogram[bin++];
  return bin;
}

/// Without what stays black however the rest is exposed: a lit picture shows 10 stops below its
/// bright parts as the last code over black. From there down to 14 stops, where nothing counts, the
/// weight fades, so that no series of pictures jumps. Only space from high up is so dark by day.
Histogram WithoutBlack(Histogram histogram, double bright_share) {
  constexpr double kLastSeen_stops = 10.0, kNothing_stops = 14.0;
  const std::size_t bright = BinAtShare(histogram, bright_share);
  for (std::size_t bin = 0; bin < bright; ++bin) {
    const double under = static_cast<double>(bright - bin) / kBinsPerStop;
    histogram[bin] *=
        std::clamp((kNothing_stops - under) / (kNothing_stops - kLastSeen_stops), 0.0, 1.0);
  }
  return histogram;
}

/// Mean of log2 luminance between two shares of the pixels; bins that a share cuts count in part.
double MeanStop(const Histogram& histogram, double pixels, double low_share, double high_share) {
  const double low = low_share * pixels;
  const double high = high_share * pixels;
  double seen = 0.0;
  double weight = 0.0;
  double sum = 0.0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    const double inside =
        std::max(0.0, std::min(seen + histogram[bin], high) - std::max(seen, low));
    sum += inside * (kLowestStop + (static_cast<double>(bin) + 0.5) / kBinsPerStop);
    weight += inside;
    seen += histogram[bin];
  }
  return sum / weight;
}

}  // namespace

double ExposureScale(double ev100) { return 1.0 / (1.2 * std::exp2(ev100)); }

double MeterEv100(const Image& image, double ignore_above_cd_per_m2, Projection projection) {
  constexpr double kDarkShare = 0.40, kBrightShare = 0.95;
  const Histogram histogram =
      WithoutBlack(HistogramOf(image, ignore_above_cd_per_m2, projection), kBrightShare);
  const double pixels = std::accumulate(histogram.begin(), histogram.end(), 0.0);
  if (pixels == 0.0) return kDarkestEv100;
  const double stop = MeanStop(histogram, pixels, kDarkShare, kBrightShare);
  const double ev100 = stop + std::log2(100.0 / kMeterConstant);
  return std::clamp(ev100, kDarkestEv100, kBrightestEv100);
}

}  // namespace alpenglow
