// SPDX-License-Identifier: MIT
#include "renderer/cloud_phase/phase_colours.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "atmosphere/math/constants.h"
#include "lut/multiple_scattering/spherical_harmonics.h"
#include "renderer/cloud_phase/peak_moments.h"

namespace alpenglow::renderer {
namespace {

constexpr double kDeepestHat = 20.0;
constexpr std::size_t kColourAngles = 768;
// The disk of the sun, and nearly that of the moon.
constexpr double kDiskRadius_rad = 0.2666 * kRadiansPerDegree;

double HatDepthAt(std::size_t hat) {
  return std::expm1(std::log1p(kDeepestHat) * static_cast<double>(hat) / (kPeakHats - 1));
}

// Angles are pi (3 u^2 - 2 u^3) with even u: 0.24 degrees apart at the halo, 0.3 at the bow and less
// in corona and glory.
double ColourAngleAt(std::size_t i) {
  const double u = static_cast<double>(i) / (kColourAngles - 1);
  return kPi * u * u * (3.0 - 2.0 * u);
}

/// Returns the place of an angle among the nodes.
double PlaceOfColourAngle(double cos_scattering) {
  const double share = std::acos(std::clamp(cos_scattering, -1.0, 1.0)) / kPi;
  const double u = 0.5 - std::sin(std::asin(1.0 - 2.0 * share) / 3.0);
  return std::clamp(u, 0.0, 1.0) * (kColourAngles - 1);
}

/// A phase function, exact or smoothed by the light's disk, and its moments.
struct BandPhase {
  const PhaseFunction* phase;
  PeakMoments moments;

  /// Returns the phase function in the light of a disk, by Gauss's rule of the weight sqrt(1 - t^2).
  [[nodiscard]] double ThroughDisk(double angle_rad, const std::vector<double>& series) const {
    constexpr int kChords = 5;
    double mean = 0.0;
    for (int i = 1; i <= kChords; ++i) {
      const double turn = kPi * i / (kChords + 1);
      const double at = std::abs(angle_rad + kDiskRadius_rad * std::cos(turn));
      mean += std::pow(std::sin(turn), 2) *
              RoundPhase(*phase, std::min(at, 2.0 * kPi - at), moments, series);
    }
    return mean * 2.0 / (kChords + 1);
  }

  /// Returns the factor of w_l P_l that is added to p (forward_peak.h).
  [[nodiscard]] double Factor(std::size_t l, int degree, double fraction, double depth) const {
    const double a = static_cast<int>(l) <= degree ? 1.0 : std::min(moments.chi[l] / fraction, 1.0);
    return moments.window[l] * fraction * (AllOrdersOfPeak(a, depth) - a);
  }
};

std::vector<BandPhase> WithMoments(const std::vector<PhaseFunction>& phases) {
  std::vector<std::optional<BandPhase>> made(phases.size());
  tbb::parallel_for(std::size_t{0}, phases.size(), [&](std::size_t i) {
    made[i] = BandPhase{&phases[i], PeakMoments(phases[i])};
  });
  std::vector<BandPhase> with;
  for (std::optional<BandPhase>& each : made) with.push_back(std::move(*each));
  return with;
}

/// Returns the factors of w_l P_l in the differences [degree][hat][band].
std::vector<double> DifferenceFactors(const BandPhase& grey, const std::vector<BandPhase>& bands,
                                      int degree, double fraction) {
  std::vector<double> factors;
  factors.reserve((kPeakSeriesDegree + 1) * kPeakHats * bands.size());
  for (std::size_t l = 0; l <= kPeakSeriesDegree; ++l) {
    for (std::size_t hat = 0; hat < kPeakHats; ++hat) {
      const double depth = HatDepthAt(hat);
      const double without = grey.Factor(l, degree, fraction, depth);
      for (const BandPhase& band : bands)
        factors.push_back(band.Factor(l, degree, fraction, depth) - without);
    }
  }
  return factors;
}

}  // namespace

PeakHats PeakHatsAt(double peak_depth) {
  static const float per_log = (kPeakHats - 1) / std::log1p(static_cast<float>(kDeepestHat));
  const float depth =
      std::clamp(static_cast<float>(peak_depth), 0.0F, static_cast<float>(kDeepestHat));
  const float at = per_log * std::log1p(depth);
  const std::size_t node = std::min(static_cast<std::size_t>(at), kPeakHats - 2);
  return {node, static_cast<double>(std::min(at - static_cast<float>(node), 1.0F))};
}

PhaseColours::PhaseColours(const PhaseFunction& grey, const std::vector<PhaseFunction>& bands,
                           int degree)
    : bands_(bands.size()) {
  const BandPhase without{&grey, PeakMoments(grey)};
  const double fraction = without.moments.PeakFraction(degree);
  const std::vector<BandPhase> with = WithMoments(bands);
  const std::vector<double> factors = DifferenceFactors(without, with, degree, fraction);
  const std::size_t columns = kPeakHats * bands_;
  table_.resize(kColourAngles * columns);
  tbb::parallel_for(std::size_t{0}, kColourAngles, [&](std::size_t angle) {
    const double angle_rad = ColourAngleAt(angle);
    const std::vector<double> series = LegendreSeries(kPeakSeriesDegree, std::cos(angle_rad));
    const double of_grey = without.ThroughDisk(angle_rad, series);
    std::vector<double> sum(columns);
    for (std::size_t band = 0; band < bands_; ++band) {
      const double difference = with[band].ThroughDisk(angle_rad, series) - of_grey;
      for (std::size_t hat = 0; hat < kPeakHats; ++hat) sum[hat * bands_ + band] = difference;
    }
    for (std::size_t l = 0; l < series.size(); ++l) {
      const double* factor = &factors[l * columns];
      for (std::size_t i = 0; i < columns; ++i) sum[i] += factor[i] * series[l];
    }
    for (std::size_t i = 0; i < columns; ++i)
      table_[angle * columns + i] = static_cast<float>(sum[i] / (1.0 - fraction));
  });
}

SpectrumOf<double> PhaseColours::Differences(const OnceScattered& once) const {
  const double place = PlaceOfColourAngle(once.cos_scattering);
  const auto node = std::min(static_cast<std::size_t>(place), kColourAngles - 2);
  const double share = place - static_cast<double>(node);
  const float* low = &table_[node * kPeakHats * bands_];
  const float* high = low + kPeakHats * bands_;
  SpectrumOf<double> differences(bands_);
  for (std::size_t hat = 0; hat < kPeakHats; ++hat) {
    const double light = once.by_depth[hat];
    if (light == 0.0) continue;
    for (std::size_t band = 0; band < bands_; ++band) {
      const std::size_t i = hat * bands_ + band;
      differences[band] +=
          light * std::lerp(static_cast<double>(low[i]), static_cast<double>(high[i]), share);
    }
  }
  return differences;
}

}  // namespace alpenglow::renderer
