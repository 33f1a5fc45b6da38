// SPDX-License-Identifier: MIT
// Exposure as photographers count it: EV at ISO 100, reflected-light meters of K = 12.5 (ISO 2720),
// saturation-based sensitivity (ISO 12232).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "atmosphere/number/constants.h"
#include "atmosphere/text/error.h"
#include "lut/picture/image.h"
#include "lut/picture/light_meter.h"
#include "lut/picture/tone_curve.h"

namespace alpenglow::lut {
namespace {

// Rows of a sky share a bin and leave it together: 0.3 % of light.
constexpr int kBinsPerStop = 256;
constexpr int kLowestStop = -24;  // log2 cd/m^2; less than this is no light to meter
constexpr int kHighestStop = 40;
constexpr std::size_t kBins = (kHighestStop - kLowestStop) * kBinsPerStop;

constexpr double kDarkShare = 0.40, kBrightShare = 0.95;
constexpr double kLastSeen_stops = 6.0, kFade_stops = 4.0;
constexpr double kPaper = 0.90, kGreyCard = 0.18;

using Histogram = std::array<double, kBins>;

/// Pixels of a row of latitudes stand for less of the sphere towards its poles.
double WeightOfRow(int row, int rows, Projection projection) {
  return projection == Projection::kLatitudeLongitude ? std::sin(kPi * (row + 0.5) / rows) : 1.0;
}

/// Calls visit(rgb, luminance, weight) for every pixel that has light and is not the sun's disk.
template <typename Visit>
void VisitLight(const Image& image, double ignore_above_cd_per_m2, Projection projection,
                const Visit& visit) {
  for (int row = 0; row < image.height; ++row) {
    const double weight = WeightOfRow(row, image.height, projection);
    for (int column = 0; column < image.width; ++column) {
      const std::array<float, 3>& pixel = image.at(column, row);
      const double y = shared::Luminance<double>(pixel[0], pixel[1], pixel[2]);
      if (!(y >= std::exp2(kLowestStop) && y <= ignore_above_cd_per_m2)) continue;
      visit(pixel, y, weight);
    }
  }
}

double BinOf(double luminance) {
  return std::clamp((std::log2(luminance) - kLowestStop) * kBinsPerStop, 0.0, kBins - 1.0);
}

Histogram HistogramOf(const Image& image, double ignore_above_cd_per_m2, Projection projection) {
  Histogram histogram = {};
  VisitLight(image, ignore_above_cd_per_m2, projection,
             [&](const std::array<float, 3>&, double y, double weight) {
               histogram[static_cast<std::size_t>(BinOf(y))] += weight;
             });
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

/// log2 of the mean luminance between two shares of the pixels; bins that a share cuts count in part.
double MeanStop(const Histogram& histogram, double pixels, double low_share, double high_share) {
  const double low = low_share * pixels;
  const double high = high_share * pixels;
  double seen = 0.0;
  double weight = 0.0;
  double sum = 0.0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    const double inside = std::min(seen + histogram[bin], high) - std::max(seen, low);
    seen += histogram[bin];
    if (!(inside > 0.0)) continue;
    sum += inside * std::exp2(kLowestStop + (static_cast<double>(bin) + 0.5) / kBinsPerStop);
    weight += inside;
  }
  return std::log2(sum / weight);
}

/// log2 luminance that a share of all pixels lies below; between the ends of a bin it is even.
double StopAtShare(const Histogram& histogram, double share) {
  const double wanted = share * std::accumulate(histogram.begin(), histogram.end(), 0.0);
  const std::size_t bin = BinAtShare(histogram, share);
  const double before =
      std::accumulate(histogram.begin(), histogram.begin() + static_cast<std::ptrdiff_t>(bin), 0.0);
  const double inside = histogram[bin] > 0.0 ? (wanted - before) / histogram[bin] : 0.5;
  return kLowestStop + (static_cast<double>(bin) + inside) / kBinsPerStop;
}

/// Without what stays black however the rest is exposed. Weights fade, so that no series of pictures
/// jumps.
Histogram WithoutBlack(Histogram histogram) {
  const std::size_t bright = BinAtShare(histogram, kBrightShare);
  for (std::size_t bin = 0; bin < bright; ++bin) {
    const double under = static_cast<double>(bright - bin) / kBinsPerStop;
    histogram[bin] *= std::clamp(1.0 - (under - kLastSeen_stops) / kFade_stops, 0.0, 1.0);
  }
  return histogram;
}

/// log2 luminance that is printed as middle grey.
double GreyStop(const Histogram& histogram, double pixels) {
  const double mean = MeanStop(histogram, pixels, kDarkShare, kBrightShare);
  return std::max(mean, StopAtShare(histogram, kBrightShare) - std::log2(kPaper / kGreyCard));
}

}  // namespace

double ExposureScale(double ev100) { return 1.0 / (1.2 * std::exp2(ev100)); }

std::string MeterRule() {
  return fmt::format(
      "mean luminance of shares {} to {} of the solid angle, K {}; the upper not over {} "
      "beside "
      "{}; left out: over {:g} cd/m^2, and what is {} to {} stops under the upper",
      kDarkShare, kBrightShare, kMeterConstant, kPaper, kGreyCard, kSunDiskLuminance_cd_per_m2,
      kLastSeen_stops, kLastSeen_stops + kFade_stops);
}

double MeterEv100(const Image& image, double ignore_above_cd_per_m2, Projection projection) {
  const Histogram histogram = WithoutBlack(HistogramOf(image, ignore_above_cd_per_m2, projection));
  const double pixels = std::accumulate(histogram.begin(), histogram.end(), 0.0);
  if (pixels == 0.0) return kDarkestEv100;
  const double ev100 = GreyStop(histogram, pixels) + std::log2(100.0 / kMeterConstant);
  return std::clamp(ev100, kDarkestEv100, kBrightestEv100);
}

std::array<double, 3> MeteredColour(const Image& image, double ignore_above_cd_per_m2,
                                    Projection projection) {
  const Histogram histogram = WithoutBlack(HistogramOf(image, ignore_above_cd_per_m2, projection));
  const double low = static_cast<double>(BinAtShare(histogram, kDarkShare));
  const double high = static_cast<double>(BinAtShare(histogram, kBrightShare)) + 1.0;
  std::array<double, 3> sum = {};
  double weights = 0.0;
  VisitLight(image, ignore_above_cd_per_m2, projection,
             [&](const std::array<float, 3>& pixel, double y, double weight) {
               // A sixteenth of a stop at either end fades, so that no pixels come or go at once.
               constexpr double kFade_bins = kBinsPerStop / 16.0;
               const double bin = BinOf(y);
               const double counts = weight * std::clamp((bin - low) / kFade_bins + 0.5, 0.0, 1.0) *
                                     std::clamp((high - bin) / kFade_bins + 0.5, 0.0, 1.0);
               for (std::size_t c = 0; c < 3; ++c)
                 sum[c] += counts * static_cast<double>(pixel[c]) / y;
               weights += counts;
             });
  if (!(weights > 0.0)) return {1.0, 1.0, 1.0};
  for (double& channel : sum) channel /= weights;
  return sum;
}

}  // namespace alpenglow::lut
