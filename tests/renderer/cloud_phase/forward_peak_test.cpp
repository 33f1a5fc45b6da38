// SPDX-License-Identifier: MIT
#include "renderer/cloud_phase/forward_peak.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <functional>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "renderer/cloud_phase/ice_phase.h"
#include "renderer/layer.h"
#include "tests/fixtures/media.h"

namespace alpenglow::renderer {
namespace {

/// Returns the Legendre coefficient of a function of the cosine by quadrature over angles that are
/// dense near 0.
double Coefficient(const std::function<double(double)>& function, unsigned degree) {
  constexpr int kPanels = 400;
  const GaussRule& rule = GaussLegendre(8);
  double sum = 0.0;
  for (int i = 0; i < kPanels; ++i) {
    for (std::size_t k = 0; k < rule.node.size(); ++k) {
      const double u = (i + rule.node[k]) / kPanels;
      const double angle = kPi * u * u;
      sum += rule.weight[k] / kPanels * 2.0 * kPi * u * std::sin(angle) *
             function(std::cos(angle)) * std::legendre(degree, std::cos(angle));
    }
  }
  return 2.0 * kPi * sum;
}

constexpr double kG = 0.8;
constexpr int kDegree = 3;

double PeakMoment(unsigned degree) {
  return degree <= kDegree ? 1.0 : std::pow(kG, degree) / std::pow(kG, kDegree + 1);
}

TEST(ForwardPeak, FractionIsTheFirstMomentLeftOut) {
  EXPECT_NEAR(ForwardPeak(tests::LobeOf(kG), 3).fraction(), std::pow(kG, 4), 1e-6);
  EXPECT_NEAR(ForwardPeak(tests::LobeOf(kG), 1).fraction(), kG * kG, 1e-6);
}

TEST(ForwardPeak, EffectivePhaseSumsTheOrdersOfThePeak) {
  const ForwardPeak peak(tests::LobeOf(kG), kDegree);
  const double f = peak.fraction();
  for (const double x : {0.01, 0.5, 2.0, 8.0}) {
    for (const unsigned degree : {0U, 1U, 3U, 4U, 7U, 12U}) {
      // Poisson's law of n scatterings by the peak, one of which is counted by the gather.
      const double a = PeakMoment(degree);
      double orders = 0.0, term = std::exp(-x);
      for (int n = 1; n < 60; ++n) {
        orders += term * std::pow(a, n);
        term *= x / (n + 1.0);
      }
      const double rest = degree <= kDegree ? std::pow(kG, degree) - f : 0.0;
      const double expected = (rest + f * orders) / (1.0 - f);
      const double found = Coefficient([&](double nu) { return peak.Effective(nu, x); }, degree);
      // The table is linear between 512 angles and 64 depths.
      EXPECT_NEAR(found, expected, 0.003 * (1.0 + expected)) << x << " " << degree;
    }
  }
}

TEST(ForwardPeak, BroadenedPhaseKeepsTheLight) {
  const ForwardPeak peak(tests::LobeOf(kG), kDegree);
  for (const double x : {0.01, 0.5, 2.0, 8.0}) {
    for (const unsigned degree : {0U, 1U, 4U, 7U, 12U}) {
      const double expected = std::pow(kG, degree) * std::exp(-x * (1.0 - PeakMoment(degree)));
      const double found = Coefficient([&](double nu) { return peak.Broadened(nu, x); }, degree);
      EXPECT_NEAR(found, expected, 0.002) << x << " " << degree;
    }
  }
}

// The moments of the peak are (g^l - (1 - f) g'^l) / f; the two of lowest degree are 1.
TEST(ForwardPeak, BroadenedPhaseBesideALobeKeepsTheLight) {
  constexpr double kFraction = kG * kG, kRest = kG / (1.0 + kG);
  const ForwardPeak peak = ForwardPeak::BesideLobe(tests::LobeOf(kG), kFraction, kRest);
  EXPECT_EQ(peak.fraction(), kFraction);
  for (const double x : {0.01, 0.5, 2.0, 8.0}) {
    for (const unsigned degree : {0U, 1U, 2U, 4U, 7U, 12U}) {
      const double moment = std::pow(kG, degree);
      const double a = (moment - (1.0 - kFraction) * std::pow(kRest, degree)) / kFraction;
      const double found = Coefficient([&](double nu) { return peak.Broadened(nu, x); }, degree);
      EXPECT_NEAR(found, moment * std::exp(-x * (1.0 - a)), 0.002) << x << " " << degree;
    }
  }
}

TEST(ForwardPeak, ThinWaysSeeThePhaseFunctionItself) {
  const PhaseFunction phase = tests::LobeOf(kG);
  const ForwardPeak peak(phase, kDegree);
  // Depths are at least 1e-3, where a few thousandths of the light ahead arrive at other angles.
  for (const double angle_deg : {0.0, 5.0, 20.0, 90.0, 180.0}) {
    const double nu = std::cos(angle_deg * kRadiansPerDegree);
    EXPECT_NEAR(peak.Broadened(nu, 0.0), Phase(phase, nu), 5e-3 * Phase(phase, nu));
    EXPECT_NEAR(peak.Effective(nu, 0.0) * (1.0 - peak.fraction()), Phase(phase, nu),
                5e-3 * Phase(phase, nu));
  }
}

// The diffraction of crystals is so narrow that a series of any degree rings without a window: at 5
// degrees by fifty times the phase function.
TEST(ForwardPeak, PeakOfIceHasNoRings) {
  const CloudPhases phases = IcePhases(550.0);
  const PhaseFunction& phase = phases.Drawn(40.0, 0.5);
  const ForwardPeak peak(phase, kDegree);
  for (const double x : {0.01, 1.0, 5.0}) {
    double last = peak.Effective(1.0, x);
    for (double angle_deg = 0.25; angle_deg < 15.0; angle_deg += 0.25) {
      const double here = peak.Effective(std::cos(angle_deg * kRadiansPerDegree), x);
      EXPECT_GT(here, 0.0) << x << " " << angle_deg;
      EXPECT_LT(here, last) << x << " " << angle_deg;
      last = here;
    }
  }
  // A ring of 1 % of the phase function would show; the window and the table stay below it.
  for (const double angle_deg : {20.0, 22.0, 24.0, 46.0, 90.0, 150.0}) {
    const double nu = std::cos(angle_deg * kRadiansPerDegree);
    EXPECT_NEAR(peak.Effective(nu, 1e-3) * (1.0 - peak.fraction()), Phase(phase, nu),
                0.01 * Phase(phase, nu))
        << angle_deg;
  }
}

TEST(ForwardPeak, RefusesPhaseFunctionsWithoutAPeak) {
  EXPECT_THROW(ForwardPeak(tests::LobeOf(0.0), 3), InputError);
  EXPECT_THROW(ForwardPeak(tests::LobeOf(-0.5), 2), InputError);
  EXPECT_THROW(ForwardPeak(tests::LobeOf(0.8), 17), InputError);
  EXPECT_THROW(ForwardPeak(tests::LobeOf(0.8), -1), InputError);
  for (const double fraction : {0.0, 1.0, -0.2}) {
    EXPECT_THROW(static_cast<void>(ForwardPeak::BesideLobe(tests::LobeOf(0.8), fraction, 0.4)),
                 InputError);
  }
}

}  // namespace
}  // namespace alpenglow::renderer
