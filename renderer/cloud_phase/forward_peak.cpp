// SPDX-License-Identifier: MIT
#include "renderer/cloud_phase/forward_peak.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "lut/multiple_scattering/spherical_harmonics.h"

namespace alpenglow::renderer {
namespace {

// Angles are uniform in their root, which makes them dense in the peak; depths in their logarithm.
constexpr std::size_t kAngles = 512, kDepths = ForwardPeak::kDepths;
constexpr double kShallowest = 1e-3;

double PeakDepthAt(std::size_t i) {
  return kShallowest *
         std::pow(ForwardPeak::kDeepest / kShallowest, static_cast<double>(i) / (kDepths - 1));
}

double PeakAngleAt(std::size_t i) {
  return kPi * std::pow(static_cast<double>(i) / (kAngles - 1), 2);
}

/// A place between the nodes of an axis.
struct PeakPlace {
  std::size_t node;
  double share;  // of the next node
};

PeakPlace PlaceOfAngle(double cos_scattering) {
  const double angle = std::acos(std::clamp(cos_scattering, -1.0, 1.0));
  const double at = std::sqrt(angle / kPi) * (kAngles - 1);
  const auto node = std::min(static_cast<std::size_t>(at), kAngles - 2);
  return {node, at - static_cast<double>(node)};
}

PeakPlace PlaceOfDepth(double depth) {
  constexpr double kDeepest = ForwardPeak::kDeepest;
  static const double per_depth = (kDepths - 1) / std::log(kDeepest / kShallowest);
  const auto relative = static_cast<float>(std::clamp(depth, kShallowest, kDeepest) / kShallowest);
  const double at = per_depth * static_cast<double>(std::log(relative));
  const auto node = std::min(static_cast<std::size_t>(at), kDepths - 2);
  return {node, at - static_cast<double>(node)};
}

/// The factors of w_l P_l that are added to p, for all degrees and depths.
struct PeakFactors {
  std::vector<double> effective, broadened;  // [depth][degree]
};

PeakFactors PeakFactorsOf(const PeakMoments& moments, double fraction,
                          const std::vector<double>& peak) {
  const std::vector<double>& chi = moments.chi;
  PeakFactors factors;
  for (std::size_t i = 0; i < kDepths; ++i) {
    const double x = PeakDepthAt(i);
    for (std::size_t l = 0; l < chi.size(); ++l) {
      const double a = peak[l];
      factors.effective.push_back(moments.window[l] * fraction * (AllOrdersOfPeak(a, x) - a));
      factors.broadened.push_back(moments.window[l] * chi[l] * std::expm1(-x * (1.0 - a)));
    }
  }
  return factors;
}

/// Returns the moments of the peak beyond a degree.
std::vector<double> PeakBeyond(const PeakMoments& moments, int degree) {
  const double fraction = moments.PeakFraction(degree);
  std::vector<double> peak;
  for (const double chi : moments.chi)
    peak.push_back(static_cast<int>(peak.size()) <= degree ? 1.0 : chi / fraction);
  return peak;
}

}  // namespace

ForwardPeak::ForwardPeak(const PhaseFunction& phase, int degree)
    : ForwardPeak(PeakMoments(phase), phase, degree) {}

ForwardPeak::ForwardPeak(const PeakMoments& moments, const PhaseFunction& phase, int degree)
    : ForwardPeak(phase, moments, moments.PeakFraction(degree), PeakBeyond(moments, degree)) {}

ForwardPeak ForwardPeak::BesideLobe(const PhaseFunction& phase, double fraction, double g) {
  if (!(fraction > 0.0 && fraction < 1.0)) {
    throw InputError(fmt::format(
        "a forward peak of clouds has {} of the light; it must have more than 0 and less than 1",
        fraction));
  }
  const PeakMoments moments(phase);
  std::vector<double> peak;
  double lobe = 1.0 - fraction;
  for (const double chi : moments.chi) {
    peak.push_back((chi - lobe) / fraction);
    lobe *= g;
  }
  return {phase, moments, fraction, peak};
}

ForwardPeak::ForwardPeak(const PhaseFunction& phase, const PeakMoments& moments, double fraction,
                         const std::vector<double>& peak)
    : fraction_(fraction), effective_(kAngles * kDepths), broadened_(kAngles * kDepths) {
  const std::vector<double>& chi = moments.chi;
  const PeakFactors factors = PeakFactorsOf(moments, fraction, peak);
  tbb::parallel_for(std::size_t{0}, kAngles, [&](std::size_t angle) {
    const std::vector<double> series =
        LegendreSeries(kPeakSeriesDegree, std::cos(PeakAngleAt(angle)));
    const double value = RoundPhase(phase, PeakAngleAt(angle), moments, series);
    for (std::size_t depth = 0; depth < kDepths; ++depth) {
      double effective = value, broadened = value;
      for (std::size_t l = 0; l < chi.size(); ++l) {
        effective += factors.effective[depth * chi.size() + l] * series[l];
        broadened += factors.broadened[depth * chi.size() + l] * series[l];
      }
      effective_[angle * kDepths + depth] = static_cast<float>(effective / (1.0 - fraction_));
      broadened_[angle * kDepths + depth] = static_cast<float>(broadened);
    }
  });
}

double ForwardPeak::At(const std::vector<float>& table, double cos_scattering, double depth) {
  const PeakPlace angle = PlaceOfAngle(cos_scattering), along = PlaceOfDepth(depth);
  const float* low = &table[angle.node * kDepths + along.node];
  const float* high = low + kDepths;
  return std::lerp(
      std::lerp(static_cast<double>(low[0]), static_cast<double>(low[1]), along.share),
      std::lerp(static_cast<double>(high[0]), static_cast<double>(high[1]), along.share),
      angle.share);
}

ForwardPeak::Angle ForwardPeak::AtAngle(double cos_scattering) const {
  const PeakPlace angle = PlaceOfAngle(cos_scattering);
  const float* low = &effective_[angle.node * kDepths];
  const auto share = static_cast<float>(angle.share);
  Angle at;
  for (std::size_t i = 0; i < kDepths; ++i) {
    at.value_[i] = low[i] + share * (low[i + kDepths] - low[i]);
  }
  return at;
}

double ForwardPeak::Angle::Effective(double depth) const {
  const PeakPlace along = PlaceOfDepth(depth);
  return std::lerp(static_cast<double>(value_[along.node]),
                   static_cast<double>(value_[along.node + 1]), along.share);
}

}  // namespace alpenglow::renderer
