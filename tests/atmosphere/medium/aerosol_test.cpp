// SPDX-License-Identifier: MIT
#include "atmosphere/medium/aerosol_mixture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

#include "atmosphere/base/csv.h"
#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/medium/phase.h"
#include "atmosphere/medium/phase_table.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/lorenz_mie.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/sanitized.h"

namespace alpenglow::atmosphere {
namespace {

TEST(AerosolMixture, EqualsItsTableAtTabulatedWavelengths) {
  const AerosolOptics desert = AerosolMixture("desert", {450.0, 550.0, 650.0});
  EXPECT_NEAR(desert.extinction_per_m[1], 1.4467e-4, 1e-12);
  EXPECT_NEAR(desert.scattering_per_m[1], 1.4467e-4 * 0.8879, 1e-12);
  EXPECT_EQ(desert.extinction_550_per_m, desert.extinction_per_m[1]);
  const AerosolOptics polluted = AerosolMixture("continental_polluted", {550.0});
  EXPECT_NEAR(polluted.extinction_per_m[0], 1.7457e-4, 1e-12);
}

TEST(AerosolMixture, MeanCosinesAreThoseOfOpac) {
  const std::map<std::string, double> published{{"continental_clean", 0.7086},
                                                {"continental_average", 0.7034},
                                                {"continental_polluted", 0.6977},
                                                {"urban", 0.6889},
                                                {"desert", 0.7287},
                                                {"maritime_clean", 0.7720},
                                                {"maritime_polluted", 0.7565},
                                                {"maritime_tropical", 0.7742},
                                                {"arctic", 0.7215},
                                                {"antarctic", 0.7840}};
  ASSERT_EQ(AerosolMixtureNames().size(), published.size());
  for (const std::string& name : AerosolMixtureNames()) {
    EXPECT_NEAR(MeanCosine(AerosolMixture(name, {550.0}).phase.front()), published.at(name), 7e-4)
        << name << ": OPAC integrates with its own, coarser quadrature";
    for (const PhaseFunction& phase : AerosolMixture(name, {450.0, 550.0, 650.0}).phase) {
      if (phase.kind != PhaseKind::kTable) continue;
      EXPECT_NEAR(phase.table->integral(), 1.0, 0.0101) << name;
    }
  }
  // The phase function of polluted air follows from other mixtures; OPAC's table has its mean
  // cosine.
  const std::vector<PhaseFunction> polluted =
      AerosolMixturePhase("continental_polluted", {450.0, 550.0, 650.0});
  const std::array<double, 3> of_polluted{0.7097, 0.6977, 0.6847};
  for (std::size_t i = 0; i < polluted.size(); ++i) {
    EXPECT_EQ(polluted[i].kind, PhaseKind::kTable);
    EXPECT_NEAR(MeanCosine(polluted[i]), of_polluted[i], 7e-4) << "as above";
  }
}

// The narrow peak is the light that insoluble particles throw forward: as bright, relative to the
// scattering of all particles, as they are many. 2 % are left to the others, whose peak is wide.
TEST(AerosolMixture, ContinentalAirHasThePeakOfItsInsolubleParticles) {
  const struct {
    const char* name;
    double insoluble_per_cm3;
  } mixtures[] = {{"continental_clean", 0.15},
                  {"continental_average", 0.4},
                  {"continental_polluted", 0.6},
                  {"urban", 1.5}};
  std::vector<double> peak_of_one;
  for (const auto& mixture : mixtures) {
    const AerosolOptics optics = AerosolMixture(mixture.name, {550.0});
    const auto at = [&](double degrees) {
      return Phase(optics.phase.front(), std::cos(kRadiansPerDegree * degrees));
    };
    peak_of_one.push_back((at(0.0) - at(3.0)) * optics.scattering_per_m[0] /
                          mixture.insoluble_per_cm3);
  }
  for (const double peak : peak_of_one) EXPECT_NEAR(peak / peak_of_one.front(), 1.0, 0.02);
}

TEST(AerosolMixture, ColumnsAreThePublishedOpticalDepths) {
  // Optical depths at 550 nm of the whole atmosphere (Hess et al. 1998, Table 5), of which 0.013
  // lies in the free troposphere (less above the deep layers of deserts and Antarctica) and 0.005
  // in the stratosphere.
  const struct {
    const char* name;
    double whole, above;
  } published[] = {{"continental_clean", 0.064, 0.018},
                   {"continental_average", 0.151, 0.018},
                   {"continental_polluted", 0.327, 0.018},
                   {"urban", 0.643, 0.018},
                   {"desert", 0.286, 0.012},
                   {"maritime_clean", 0.096, 0.018},
                   {"maritime_polluted", 0.117, 0.018},
                   {"maritime_tropical", 0.056, 0.018},
                   {"arctic", 0.063, 0.018},
                   {"antarctic", 0.072, 0.007}};
  for (const auto& mixture : published) {
    const AerosolOptics optics = AerosolMixture(mixture.name, {550.0});
    EXPECT_NEAR(optics.extinction_550_per_m * optics.scale_height_m + mixture.above, mixture.whole,
                0.002)
        << mixture.name;
  }
}

TEST(AerosolMixture, SpectraHaveThePublishedAngstromExponents) {
  for (const auto& [name, exponent] :
       {std::pair{"continental_average", 1.423}, std::pair{"desert", 0.169},
        std::pair{"maritime_clean", 0.084}}) {
    const AerosolOptics optics = AerosolMixture(name, {500.0, 800.0});
    EXPECT_NEAR(std::log(optics.extinction_per_m[0] / optics.extinction_per_m[1]) / std::log(1.6),
                exponent, 0.03)
        << name << ": OPAC fits the exponent to all wavelengths between";
  }
}

TEST(AerosolMixture, SpectraStayPositiveBeyondTheTable) {
  for (const std::string& name : AerosolMixtureNames()) {
    const AerosolOptics optics = AerosolMixture(name, {200.0, 350.0, 900.0, 4000.0});
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_GT(optics.extinction_per_m[i], 0.0) << name;
      EXPECT_LE(optics.scattering_per_m[i], optics.extinction_per_m[i]) << name;
    }
    EXPECT_LT(optics.extinction_per_m[3], optics.extinction_per_m[2]) << name;
  }
}

TEST(AerosolMixture, AnUnknownNameIsRefusedWithAllKnownOnes) {
  EXPECT_THAT(tests::FaultOf([] { return AerosolMixture("sahara", {550.0}); }),
              testing::HasSubstr("continental_clean, continental_average"));
}

TEST(AerosolMixture, CornetteShanksHasTheRequestedMeanCosine) {
  for (const double mean : {0.0, 0.3, 0.7, 0.95}) {
    const PhaseFunction phase{.kind = PhaseKind::kCornetteShanks, .g = CornetteShanksG(mean)};
    EXPECT_NEAR(MeanCosine(phase), mean, 1e-9);
  }
}

std::vector<double> Angles(int steps) {
  std::vector<double> angles;
  for (int i = 0; i <= steps; ++i) angles.push_back(kPi * i / steps);
  return angles;
}

// Integrates over solid angle by the trapezoidal rule.
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

TEST(LorenzMie, SmallSpheresScatterLikeRayleigh) {
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

TEST(LorenzMie, PhaseFunctionHasTheIntegralAndMeanOfTheSeries) {
  const std::vector<double> angles = Angles(20000);
  for (const double x : {0.5, 5.0, 60.0}) {
    const SphereScattering mie = ScatterBySphere({1.33, 0.001}, x, angles);
    EXPECT_NEAR(Integral(angles, mie.per_sr), 1.0, 1e-5) << "trapezoids of 0.01 degrees";
    std::vector<double> weighted = mie.per_sr;
    for (std::size_t i = 0; i < angles.size(); ++i) weighted[i] *= std::cos(angles[i]);
    EXPECT_NEAR(Integral(angles, weighted), mie.mean_cosine, 1e-5);
  }
}

TEST(LorenzMie, LargeSpheresExtinguishTwiceTheirShadow) {
  const SphereScattering mie = ScatterBySphere({1.33, 0.01}, 3000.0, {});
  EXPECT_NEAR(mie.extinction_efficiency, 2.0, 0.02) << "2 + O(x^(-2/3))";
}

TEST(LorenzMie, NarrowSizeDistributionsScatterAsTheirMeanSphere) {
  const SphereScattering many = ScatterBySpheres(
      {1.33, 0.0}, {.effective_radius_um = 1.0, .effective_variance = 2e-4}, 500.0, {});
  const SphereScattering one = ScatterBySphere({1.33, 0.0}, 4.0 * kPi, {});
  EXPECT_NEAR(many.extinction_efficiency / one.extinction_efficiency, 1.0, 0.02)
      << "radii within 1.4 %";
  EXPECT_NEAR(many.mean_cosine, one.mean_cosine, 0.01);
}

TEST(LorenzMie, FogPhaseFunctionFitsDropletsBetterThanOneLobe) {
  // Half the integral of |fit - Mie| is the share of light that goes elsewhere. The narrowest peak,
  // of 20 um, is three degrees wide.
  const std::vector<double> angles = Angles(tests::ScaledDown(720, 360));
  for (const double diameter_um : {1.5, 3.0, 5.0, 10.0, 20.0}) {
    if (tests::kSanitized && diameter_um > 5.0) continue;
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
    EXPECT_LT(distance(DropletPhase(diameter_um)), diameter_um <= 5.0 ? 0.11 : 0.16)
        << diameter_um << " um";
    const PhaseFunction lobe = tests::LobeOf(mie.mean_cosine);
    if (diameter_um >= 3.0) {
      EXPECT_GT(distance(lobe), 0.2) << diameter_um << " um";
    }
  }
}

TEST(LorenzMie, SizesAndIndicesBeyondTheTheoryAreRefused) {
  using Index = std::complex<double>;
  for (const auto& [index, size] : {std::pair{Index(1.5, 0.0), 0.0},
                                    {Index(1.5, 0.0), 2e4},
                                    {Index(0.0, 0.0), 1.0},
                                    {Index(1.5, -0.1), 1.0}})
    EXPECT_THROW(static_cast<void>(ScatterBySphere(index, size, {})), InputError);
}

TEST(ScatteringMatrix, MoleculesScatterAllTheirLight) {
  const GaussRule& rule = GaussLegendre(4);  // exact: a polynomial of degree 2
  for (const double depolarisation : {0.0, 0.0279, 0.2, kLargestDepolarisation}) {
    double sum = 0.0;
    for (std::size_t i = 0; i < rule.node.size(); ++i)
      sum += rule.weight[i] * RayleighMatrix(depolarisation, 2.0 * rule.node[i] - 1.0).a1;
    EXPECT_NEAR(4.0 * kPi * sum, 1.0, 1e-14) << depolarisation;
    const ScatteringMatrix across = RayleighMatrix(depolarisation, 0.0);
    EXPECT_NEAR((across.a1 + across.b1) / (across.a1 - across.b1), depolarisation, 1e-15)
        << "the ratio of what vibrates in the plane of scattering, seen across the beam";
  }
  for (const double cosine : {-1.0, -0.3, 0.0, 0.6, 1.0})
    EXPECT_NEAR(RayleighMatrix(0.0, cosine).a1, Phase({.kind = PhaseKind::kRayleigh}, cosine),
                1e-16);
}

TEST(ScatteringMatrix, AirDepolarisesAsTabulated) {
  const auto columns = atmosphere::ReadColumns("atmosphere/data/rayleigh_10nm.csv", {0, 3});
  ASSERT_GT(columns[0].size(), 40U);
  for (std::size_t row = 0; row < columns[0].size(); ++row) {
    EXPECT_NEAR(AirDepolarisation(columns[0][row]), columns[1][row], 6e-6)
        << columns[0][row] << " nm: five digits";
  }
}

TEST(ScatteringMatrix, SmallSpheresPolariseLikeIsotropicMolecules) {
  const SphereScattering small = ScatterBySphere({1.33, 0.0}, 0.01, Angles(180));
  for (const double cosine : {-0.95, -0.4, 0.1, 0.7}) {
    const ScatteringMatrix molecule = RayleighMatrix(0.0, cosine);
    const ScatteringMatrix sphere = SphereMatrix(small.polarised, molecule.a1, cosine);
    // The size squared is 1e-4, and lines over a degree miss 2e-4 of the value.
    EXPECT_NEAR(sphere.a3, molecule.a3, 3e-4 * molecule.a1);
    EXPECT_NEAR(sphere.a4, molecule.a4, 3e-4 * molecule.a1);
    EXPECT_NEAR(sphere.b1, molecule.b1, 3e-4 * molecule.a1);
    EXPECT_NEAR(sphere.b2, 0.0, 3e-4 * molecule.a1);
    EXPECT_EQ(sphere.a2, sphere.a1);
  }
}

// Light keeps one phase where a1^2 = a3^2 + b1^2 + b2^2.
TEST(ScatteringMatrix, OneSphereKeepsLightPolarisedUnlikeMany) {
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
