// SPDX-License-Identifier: MIT
#include "atmosphere/medium/phase.h"

#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/base/parsing.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/medium/lorenz_mie.h"

namespace alpenglow::atmosphere {
namespace {

TEST(ScatteringMatrix, RoundMoleculesHaveThePhaseFunctionOfRayleigh) {
  for (const double cosine : {-1.0, -0.3, 0.0, 0.6, 1.0}) {
    EXPECT_NEAR(RayleighMatrix(0.0, cosine).a1, Phase({.kind = PhaseKind::kRayleigh}, cosine),
                1e-16);
  }
}

TEST(ScatteringMatrix, MoleculesScatterAllTheirLightHoweverTheyDepolarise) {
  const GaussRule& rule = GaussLegendre(4);  // exact: a polynomial of degree 2
  for (const double depolarisation : {0.0, 0.03, kLargestDepolarisation}) {
    double sum = 0.0;
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      sum +=
          4.0 * kPi * rule.weight[i] * RayleighMatrix(depolarisation, 2.0 * rule.node[i] - 1.0).a1;
    }
    EXPECT_NEAR(sum, 1.0, 1e-14) << depolarisation;
  }
}

TEST(ScatteringMatrix, DepolarisationIsWhatVibratesInThePlaneOfScatteringAcrossTheBeam) {
  for (const double depolarisation : {0.0, 0.0279, 0.2, kLargestDepolarisation}) {
    const ScatteringMatrix across = RayleighMatrix(depolarisation, 0.0);
    EXPECT_NEAR((across.a1 + across.b1) / (across.a1 - across.b1), depolarisation, 1e-15);
  }
}

TEST(ScatteringMatrix, AirDepolarisesAsItsTableSays) {
  const auto columns = atmosphere::ReadColumns("atmosphere/data/rayleigh_10nm.csv", {0, 3});
  ASSERT_GT(columns[0].size(), 40U);
  for (std::size_t row = 0; row < columns[0].size(); ++row) {
    EXPECT_NEAR(AirDepolarisation(columns[0][row]), columns[1][row], 6e-6)
        << columns[0][row] << " nm: five digits";
  }
}

TEST(ScatteringMatrix, SmallSpheresPolariseAsRoundMolecules) {
  std::vector<double> angles;
  constexpr int kSteps = 180;
  for (int i = 0; i <= kSteps; ++i) angles.push_back(kPi * i / kSteps);
  const SphereScattering small = ScatterBySphere({1.33, 0.0}, 0.01, angles);
  for (const double cosine : {-0.95, -0.4, 0.1, 0.7}) {
    const ScatteringMatrix molecule = RayleighMatrix(0.0, cosine);
    const ScatteringMatrix sphere = SphereMatrix(small.polarised, molecule.a1, cosine);
    // Of the size squared, 1e-4, and lines over a degree, 2e-4 of the value.
    EXPECT_NEAR(sphere.a3, molecule.a3, 3e-4 * molecule.a1);
    EXPECT_NEAR(sphere.a4, molecule.a4, 3e-4 * molecule.a1);
    EXPECT_NEAR(sphere.b1, molecule.b1, 3e-4 * molecule.a1);
    EXPECT_NEAR(sphere.b2, 0.0, 3e-4 * molecule.a1);
    EXPECT_EQ(sphere.a2, sphere.a1);
  }
}

// a1^2 = a3^2 + b1^2 + b2^2 where light keeps one phase.
TEST(ScatteringMatrix, OneSphereLeavesPolarisedLightPolarisedAndManyDoNot) {
  const std::vector<double> angles{0.0, 0.5, 1.5, 2.5, kPi};
  const SizeDistribution sizes{.effective_radius_um = 0.5, .effective_variance = 0.1};
  const SphereRatios one = ScatterBySphere({1.5, 0.01}, 6.0, angles).polarised;
  const SphereRatios many = ScatterBySpheres({1.5, 0.01}, sizes, 550.0, angles).polarised;
  const auto square = [](const SphereRatios& ratios, std::size_t i) {
    return ratios.a3[i] * ratios.a3[i] + ratios.b1[i] * ratios.b1[i] + ratios.b2[i] * ratios.b2[i];
  };
  for (std::size_t i = 0; i < angles.size(); ++i) {
    EXPECT_NEAR(square(one, i), 1.0, 1e-12);
    EXPECT_LT(square(many, i), 1.0 + 1e-12);
  }
  EXPECT_LT(square(many, 3), 0.95) << "sizes that rainbows and glories part";
  EXPECT_NEAR(many.a3.front(), 1.0, 1e-12) << "straight on nothing is turned";
  EXPECT_NEAR(many.a3.back(), -1.0, 1e-12) << "straight back it is a mirror's image";
}

}  // namespace
}  // namespace alpenglow::atmosphere
