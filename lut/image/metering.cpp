// SPDX-License-Identifier: MIT
// This file implements photographic exposure: EV at ISO 100, reflected-light meters of K = 12.5
// (ISO 2720), saturation-based sensitivity (ISO 12232).
#include "lut/image/metering.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "lut/image/image.h"
#include "lut/image/tone_mapping.h"

namespace alpenglow::lut {
namespace {

// Bins are narrow, 0.3 % of light, because the rows of a sky that share a bin leave it together.
constexpr int kBinsPerStop = 256;
constexpr int kLowestStop = -24;  // log2 cd/m^2; pixels with less are not metered
constexpr int kHighestStop = 40;
constexpr std::size_t kBins = (kHighestStop - kLowestStop) * kBinsPerStop;

constexpr double kDarkShare = 0.40, kBrightShare = 0.95;
constexpr double kLastSeen_stops = 6.0, kFade_stops = 4.0;
constexpr double kPaper = 0.90, kGreyCard = 0.18;

/// Weights by bin of log2 luminance. Sums run over the range of bins with light, which is a quarter
/// of all in a frame of a flight.
class Histogram {
 public:
  void Add(std::size_t bin, double weight) {
    weights_[bin] += weight;
    begin_ = std::min(begin_, bin);
    end_ = std::max(end_, bin + 1);
  }
  void Scale(std::size_t bin, double factor) { weights_[bin] *= factor; }
  [[nodiscard]] double operator[](std::size_t bin) const { return weights_[bin]; }
  [[nodiscard]] std::size_t begin() const { return begin_; }
  [[nodiscard]] std::size_t end() const { return end_; }

  [[nodiscard]] double SumBefore(std::size_t bin) const {
    double sum = 0.0;
    for (std::size_t i = begin_; i < bin; ++i) sum += weights_[i];
    return sum;
  }
  [[nodiscard]] double Sum() const { return SumBefore(end_); }

 private:
  std::array<double, kBins> weights_ = {};
  std::size_t begin_ = kBins, end_ = 0;
};

/// Returns the weight of a row: the solid angle of a latitude-longitude pixel decreases towards the
/// poles.
double WeightOfRow(int row, int rows, Projection projection) {
  return projection == Projection::kLatitudeLongitude ? std::sin(kPi * (row + 0.5) / rows) : 1.0;
}

/// Calls visit(rgb, luminance, weight) for every pixel that has light and is not part of the sun's
/// disk.
template <typename Visit>
void VisitLight(const HdrImage& image, double ignore_above_cd_per_m2, Projection projection,
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

Histogram HistogramOf(const HdrImage& image, double ignore_above_cd_per_m2, Projection projection) {
  Histogram histogram;
  VisitLight(image, ignore_above_cd_per_m2, projection,
             [&](const std::array<float, 3>&, double y, double weight) {
               histogram.Add(static_cast<std::size_t>(BinOf(y)), weight);
             });
  return histogram;
}

/// Returns the bin at which the cumulative histogram reaches a fraction of all pixels.
std::size_t BinAtShare(const Histogram& histogram, double share) {
  const double wanted = share * histogram.Sum();
  double seen = 0.0;
  std::size_t bin = histogram.begin();
  while (bin + 1 < histogram.end() && seen + histogram[bin] < wanted) seen += histogram[bin++];
  return bin;
}

/// Returns log2 of the mean luminance between two fractions of the pixels. A bin that a fraction
/// cuts counts in part.
double MeanStop(const Histogram& histogram, double pixels, double low_share, double high_share) {
  const double low = low_share * pixels;
  const double high = high_share * pixels;
  double seen = 0.0;
  double weight = 0.0;
  double sum = 0.0;
  for (std::size_t bin = histogram.begin(); bin < histogram.end(); ++bin) {
    const double inside = std::min(seen + histogram[bin], high) - std::max(seen, low);
    seen += histogram[bin];
    if (!(inside > 0.0)) continue;
    sum += inside * std::exp2(kLowestStop + (static_cast<double>(bin) + 0.5) / kBinsPerStop);
    weight += inside;
  }
  return std::log2(sum / weight);
}

/// Returns log2 of the luminance below which a fraction of all pixels lies. Pixels are assumed
/// uniform within a bin.
double StopAtShare(const Histogram& histogram, double share) {
  const double wanted = share * histogram.Sum();
  const std::size_t bin = BinAtShare(histogram, share);
  const double before = histogram.SumBefore(bin);
  const double inside = histogram[bin] > 0.0 ? (wanted - before) / histogram[bin] : 0.5;
  return kLowestStop + (static_cast<double>(bin) + inside) / kBinsPerStop;
}

/// Returns the histogram without pixels that stay black at the exposure of the rest. Weights fade
/// gradually, so that exposure does not jump between the images of a series.
Histogram WithoutBlack(Histogram histogram) {
  const std::size_t bright = BinAtShare(histogram, kBrightShare);
  for (std::size_t bin = histogram.begin(); bin < bright; ++bin) {
    const double under = static_cast<double>(bright - bin) / kBinsPerStop;
    histogram.Scale(bin, std::clamp(1.0 - (under - kLastSeen_stops) / kFade_stops, 0.0, 1.0));
  }
  return histogram;
}

/// Returns log2 of the luminance that is printed as middle grey.
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

double MeterEv100(const HdrImage& image, double ignore_above_cd_per_m2, Projection projection) {
  const Histogram histogram = WithoutBlack(HistogramOf(image, ignore_above_cd_per_m2, projection));
  const double pixels = histogram.Sum();
  if (pixels == 0.0) return kDarkestEv100;
  const double ev100 = GreyStop(histogram, pixels) + std::log2(100.0 / kMeterConstant);
  return std::clamp(ev100, kDarkestEv100, kBrightestEv100);
}

std::array<double, 3> MeteredColour(const HdrImage& image, double ignore_above_cd_per_m2,
                                    Projection projection) {
  const Histogram histogram = WithoutBlack(HistogramOf(image, ignore_above_cd_per_m2, projection));
  const double low = static_cast<double>(BinAtShare(histogram, kDarkShare));
  const double high = static_cast<double>(BinAtShare(histogram, kBrightShare)) + 1.0;
  std::array<double, 3> sum = {};
  double weights = 0.0;
  VisitLight(image, ignore_above_cd_per_m2, projection,
             [&](const std::array<float, 3>& pixel, double y, double weight) {
               // A sixteenth of a stop at either end fades, so that single pixels do not enter or
               // leave abruptly.
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
