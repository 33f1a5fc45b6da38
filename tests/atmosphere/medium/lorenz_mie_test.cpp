// SPDX-License-Identifier: MIT
#include "atmosphere/medium/lorenz_mie.h"

#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/phase.h"

namespace alpenglow::atmosphere {
namespace {

std::vector<double> Angles(int steps) {
  std::vector<double> angles;
  for (int i = 0; i <= steps; ++i) angles.push_back(kPi * i / steps);
  return angles;
}

// Trapezoidal rule over solid angle.
double Integral(const std::vector<double>& angles, const std::vector<double>& values) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < angles.size(); ++i) {
    sum += 0.5 * (angles[i + 1] - angles[i]) * 2.0 * kPi *
           (values[i] * std::sin(angles[i]) + values[i + 1] * std::sin(angles[i + 1]));
  }
  return sum;
}

TEST(LorenzMie, EfficienciesAreThePublishedOnes) {
  // Wiscombe (1979), "Mie scattering calculations: advances in technique and fast, vector-speed
  // computer codes", NCAR/TN-140+STR.
  const struct {
    std::complex<double> index;
    double size, extinction, scattering, mean_cosine;
  } published[] = {{{1.5, 0.0}, 10.0, 2.881999, 2.881999, 0.742913},
                   {{1.5, 0.0}, 100.0, 2.094388, 2.094388, 0.818246},
                   {{1.5, 0.1}, 10.0, 2.459791, 1.235144, 0.922350},
                   {{1.5, 1.0}, 100.0, 2.097502, 1.283697, 0.850252}};
  for (const auto& sphere : published) {
    const SphereScattering mie = ScatterBySphere(sphere.index, sphere.size, {});
    EXPECT_NEAR(mie.extinction_efficiency, sphere.extinction, 2e-6) << sphere.size;
    EXPECT_NEAR(mie.scattering_efficiency, sphere.scattering, 2e-6) << sphere.size;
    EXPECT_NEAR(mie.mean_cosine, sphere.mean_cosine, 2e-6) << sphere.size;
  }
}

TEST(LorenzMie, SmallSpheresScatterAsRayleighSaid) {
  const double x = 0.01;
  const std::complex<double> m(1.33, 0.0);
  const SphereScattering mie = ScatterBySphere(m, x, {0.5, 2.0});
  const std::complex<double> polarisability = (m * m - 1.0) / (m * m + 2.0);
  EXPECT_NEAR(mie.scattering_efficiency / (8.0 / 3.0 * std::pow(x, 4) * std::norm(polarisability)),
              1.0, 1e-3)
      << "the next term is of second order in the size";
  EXPECT_NEAR(mie.per_sr[0], Phase({.kind = PhaseKind::kRayleigh}, std::cos(0.5)), 1e-4);
  EXPECT_NEAR(mie.per_sr[1], Phase({.kind = PhaseKind::kRayleigh}, std::cos(2.0)), 1e-4);
}

TEST(LorenzMie, PhaseFunctionIsNormalisedAndHasTheMeanCosineOfTheSeries) {
  const std::vector<double> angles = Angles(20000);
  for (const double x : {0.5, 5.0, 60.0}) {
    const SphereScattering mie = ScatterBySphere({1.33, 0.001}, x, angles);
    EXPECT_NEAR(Integral(angles, mie.per_sr), 1.0, 1e-5) << "trapezoids of 0.01 degrees";
    std::vector<double> weighted = mie.per_sr;
    for (std::size_t i = 0; i < angles.size(); ++i) weighted[i] *= std::cos(angles[i]);
    EXPECT_NEAR(Integral(angles, weighted), mie.mean_cosine, 1e-5);
  }
}

TEST(LorenzMie, LargeSpheresTakeTwiceTheirShadow) {
  const SphereScattering mie = ScatterBySphere({1.33, 0.01}, 3000.0, {});
  EXPECT_NEAR(mie.extinction_efficiency, 2.0, 0.02) << "2 + O(x^(-2/3))";
}

TEST(LorenzMie, ManySizesScatterAsTheirMeanSphereWhenTheyHardlyDiffer) {
  const SphereScattering many = ScatterBySpheres(
      {1.33, 0.0}, {.effective_radius_um = 1.0, .effective_variance = 2e-4}, 500.0, {});
  const SphereScattering one = ScatterBySphere({1.33, 0.0}, 4.0 * kPi, {});
  EXPECT_NEAR(many.extinction_efficiency / one.extinction_efficiency, 1.0, 0.02)
      << "radii within 1.4 %";
  EXPECT_NEAR(many.mean_cosine, one.mean_cosine, 0.01);
}

TEST(LorenzMie, FogFitsItsDropletsAndTheLobesThatItReplacesDoNot) {
  // Half the integral of |fit - Mie|: the share of light that goes elsewhere.
  const std::vector<double> angles = Angles(1800);
  for (const double diameter_um : {1.5, 3.0, 5.0, 10.0, 20.0}) {
    const SphereScattering mie = ScatterBySpheres(
        {1.333, 0.0}, {.effective_radius_um = 0.5 * diameter_um, .effective_variance = 0.05}, 550.0,
        angles);
    const auto distance = [&](const PhaseFunction& phase) {
      std::vector<double> difference;
      for (std::size_t i = 0; i < angles.size(); ++i) {
        difference.push_back(0.5 * std::abs(Phase(phase, std::cos(angles[i])) - mie.per_sr[i]));
      }
      return Integral(angles, difference);
    };
    EXPECT_LT(distance(FogPhase(diameter_um)), diameter_um <= 5.0 ? 0.11 : 0.16)
        << diameter_um << " um";
    const PhaseFunction lobe{.kind = PhaseKind::kHenyeyGreenstein, .g = mie.mean_cosine};
    if (diameter_um >= 3.0) {
      EXPECT_GT(distance(lobe), 0.2) << diameter_um << " um";
    }
  }
}

TEST(LorenzMie, SizesAndIndicesBeyondTheTheoryAreRefused) {
  EXPECT_THROW(static_cast<void>(ScatterBySphere({1.5, 0.0}, 0.0, {})), InputError);
  EXPECT_THROW(static_cast<void>(ScatterBySphere({1.5, 0.0}, 2e4, {})), InputError);
  EXPECT_THROW(static_cast<void>(ScatterBySphere({0.0, 0.0}, 1.0, {})), InputError);
  EXPECT_THROW(static_cast<void>(ScatterBySphere({1.5, -0.1}, 1.0, {})), InputError);
}

}  // namespace
}  // namespace alpenglow::atmosphere
