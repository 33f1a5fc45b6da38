// SPDX-License-Identifier: MIT
#include "renderer/cloud_phase/peak_moments.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "lut/multiple_scattering/spherical_harmonics.h"

namespace alpenglow::renderer {
namespace {

constexpr double kWindowDegree = 400.0;
constexpr double kEnded = 1e-5;
// Within the first angle the phase function has the window too, so that the peak and its removal are
// equally round; from the second one on it is exact, with halos.
constexpr double kRoundWithin_deg = 1.0, kExactFrom_deg = 2.0;

}  // namespace

PeakMoments::PeakMoments(const PhaseFunction& phase)
    : chi(LegendreCoefficients(phase, kPeakSeriesDegree)), window(chi.size(), 1.0) {
  // Tables are linear between angles, so that their series never end.
  if (phase.kind != PhaseKind::kTable && std::abs(chi.back()) < kEnded) return;
  for (std::size_t l = 0; l < window.size(); ++l) {
    window[l] = std::exp(-std::pow(static_cast<double>(l) / kWindowDegree, 2));
  }
}

double PeakMoments::PeakFraction(int degree) const {
  if (degree < 0 || degree > 16) {
    throw InputError(
        fmt::format("moments of light in clouds of degree {}; it must be 0 to 16", degree));
  }
  const double fraction = chi[static_cast<std::size_t>(degree) + 1];
  if (!(fraction > 0.0 && fraction < 1.0)) {
    throw InputError(
        fmt::format("a phase function of clouds has no forward peak beyond degree {}", degree));
  }
  return fraction;
}

double RoundPhase(const PhaseFunction& phase, double angle_rad, const PeakMoments& moments,
                  const std::vector<double>& series) {
  const double exact = Phase(phase, std::cos(angle_rad));
  const double share =
      (angle_rad / kRadiansPerDegree - kRoundWithin_deg) / (kExactFrom_deg - kRoundWithin_deg);
  if (share >= 1.0) return exact;
  double round = 0.0;
  for (std::size_t l = 0; l < series.size(); ++l) {
    round += moments.window[l] * moments.chi[l] * series[l];
  }
  return std::lerp(round, exact, std::max(share, 0.0));
}

double AllOrdersOfPeak(double a, double depth) {
  if (depth <= 0.0) return a;
  return -std::exp(-depth * (1.0 - a)) * std::expm1(-depth * a) / depth;
}

}  // namespace alpenglow::renderer
