// SPDX-License-Identifier: MIT
#include "atmosphere/medium/aerosol_mixture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/phase_table.h"

namespace alpenglow::atmosphere {
namespace {

TEST(AerosolMixture, AtTheirOwnWavelengthTheyAreTheirTable) {
  const AerosolOptics desert = AerosolMixture("desert", {450.0, 550.0, 650.0});
  EXPECT_NEAR(desert.extinction_per_m[1], 1.4467e-4, 1e-12);
  EXPECT_NEAR(desert.scattering_per_m[1], 1.4467e-4 * 0.8879, 1e-12);
  EXPECT_EQ(desert.extinction_550_per_m, desert.extinction_per_m[1]);
  const AerosolOptics polluted = AerosolMixture("continental_polluted", {550.0});
  EXPECT_NEAR(polluted.extinction_per_m[0], 1.7457e-4, 1e-12);
}

TEST(AerosolMixture, MeanCosinesAreThoseThatOpacGives) {
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
    const AerosolOptics optics = AerosolMixture(name, {550.0});
    EXPECT_NEAR(MeanCosine(optics.phase.front()), published.at(name), 7e-4)
        << name << ": OPAC integrates with its own, coarser quadrature";
  }
}

// This phase function follows from other mixtures; OPAC's table has its mean cosine.
TEST(AerosolMixture, PollutedAirHasItsMeanCosineAtAllWavelengths) {
  const std::vector<PhaseFunction> phase =
      AerosolMixturePhase("continental_polluted", {450.0, 550.0, 650.0});
  const std::array<double, 3> published{0.7097, 0.6977, 0.6847};
  for (std::size_t i = 0; i < phase.size(); ++i) {
    EXPECT_EQ(phase[i].kind, PhaseKind::kTable);
    EXPECT_NEAR(MeanCosine(phase[i]), published[i], 7e-4)
        << "OPAC integrates with its own, coarser quadrature";
  }
}

// The narrow peak is the light that insoluble particles throw forward: as bright, relative to the
// scattering of all particles, as they are many. 2 % are left to the others, whose peak is wide.
TEST(AerosolMixture, ThePeakOfContinentalAirIsThatOfItsInsolubleParticles) {
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

TEST(AerosolMixture, TabulatedPhaseFunctionsAreNormalisedToOnePercent) {
  for (const std::string& name : AerosolMixtureNames()) {
    for (const PhaseFunction& phase : AerosolMixture(name, {450.0, 550.0, 650.0}).phase) {
      if (phase.kind != PhaseKind::kTable) continue;
      EXPECT_NEAR(phase.table->integral(), 1.0, 0.0101) << name;
    }
  }
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

TEST(AerosolMixture, BeyondTheTableSpectraGoOnAndStayPositive) {
  for (const std::string& name : AerosolMixtureNames()) {
    const AerosolOptics optics = AerosolMixture(name, {200.0, 350.0, 900.0, 4000.0});
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_GT(optics.extinction_per_m[i], 0.0) << name;
      EXPECT_LE(optics.scattering_per_m[i], optics.extinction_per_m[i]) << name;
    }
    EXPECT_LT(optics.extinction_per_m[3], optics.extinction_per_m[2]) << name;
  }
}

TEST(AerosolMixture, AnUnknownNameIsRefusedWithAllThatAreKnown) {
  try {
    static_cast<void>(AerosolMixture("sahara", {550.0}));
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("continental_clean, continental_average"));
  }
}

TEST(AerosolMixture, CornetteShanksOfAMeanCosineHasIt) {
  for (const double mean : {0.0, 0.3, 0.7, 0.95}) {
    const PhaseFunction phase{.kind = PhaseKind::kCornetteShanks, .g = CornetteShanksG(mean)};
    EXPECT_NEAR(MeanCosine(phase), mean, 1e-9);
  }
}

}  // namespace
}  // namespace alpenglow::atmosphere
