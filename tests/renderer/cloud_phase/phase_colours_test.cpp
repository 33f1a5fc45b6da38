// SPDX-License-Identifier: MIT
#include "renderer/cloud_phase/phase_colours.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "lut/multiple_scattering/spherical_harmonics.h"
#include "renderer/cloud_phase/droplet_phase.h"
#include "renderer/cloud_phase/ice_phase.h"
#include "renderer/layer.h"
#include "tests/fixtures/media.h"

namespace alpenglow::renderer {
namespace {

constexpr int kPeakDegree = 3;
constexpr double kBlue_nm = 450.0, kRed_nm = 650.0;

/// The phase functions of droplets or crystals of one size, and their colours.
struct Particles {
  PhaseFunction grey;
  std::vector<PhaseFunction> bands;
  PhaseColours colours;

  Particles(const PhaseFunction& of_grey, std::vector<PhaseFunction> of_bands)
      : grey(of_grey), bands(std::move(of_bands)), colours(grey, bands, kPeakDegree) {}

  template <typename Phases>
  static Particles Of(const Phases& phases, double radius_um) {
    const auto at = [&](double wavelength_nm) {
      return phases(wavelength_nm).Drawn(radius_um, 0.5);
    };
    return {at(550.0), {at(kBlue_nm), at(kRed_nm)}};
  }
  static Particles Droplets() { return Of(DropletPhases, 10.0); }
  static Particles Crystals() { return Of(IcePhases, 40.0); }

  /// Returns the fraction f of the forward peak.
  [[nodiscard]] double Fraction() const {
    return LegendreCoefficients(grey, kPeakDegree + 1).back();
  }
};

/// Returns unit light with an optical depth of the forward peak on its way.
OnceScattered UnitLight(double cos_scattering, double peak_depth) {
  OnceScattered once{cos_scattering};
  once.Add(1.0, peak_depth);
  return once;
}

/// Returns a moment of the difference of a band, by quadrature over even steps of the angle.
double Moment(const PhaseColours& colours, std::size_t band, unsigned degree, double peak_depth) {
  constexpr int kSteps = 36000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    // Angles are dense in the forward peak.
    const double u = (i + 0.5) / kSteps, angle = kPi * u * u;
    const double nu = std::cos(angle);
    sum += colours.Differences(UnitLight(nu, peak_depth))[band] * std::legendre(degree, nu) *
           std::sin(angle) * 2.0 * kPi * u / kSteps;
  }
  return 2.0 * kPi * sum;
}

TEST(PhaseColours, ThinWaysHaveTheColoursOfThePhaseFunctions) {
  for (const Particles& particles : {Particles::Droplets(), Particles::Crystals()}) {
    for (const double angle_deg : {5.0, 21.5, 23.0, 60.0, 120.0, 138.0, 144.0, 170.0, 177.0}) {
      const double nu = std::cos(angle_deg * kRadiansPerDegree);
      const auto differences = particles.colours.Differences(UnitLight(nu, 0.0));
      for (std::size_t band = 0; band < differences.size(); ++band) {
        const double grey = Phase(particles.grey, nu);
        // The disk of the light and the distance of the angles, 0.3 degrees, smooth the edge of the halo
        // and the rings of the glory.
        EXPECT_NEAR(differences[band] * (1.0 - particles.Fraction()),
                    Phase(particles.bands[band], nu) - grey, 0.03 * grey)
            << angle_deg;
      }
    }
  }
}

TEST(PhaseColours, AllBandsHaveTheSameLight) {
  for (const Particles& particles : {Particles::Droplets(), Particles::Crystals()}) {
    for (const double depth : {0.0, 0.4, 2.0, 9.0, 30.0}) {
      for (const std::size_t band : {0U, 1U})
        EXPECT_NEAR(Moment(particles.colours, band, 0, depth), 0.0, 0.003) << depth;
    }
  }
}

// Poisson's law of n scatterings by the peak, as for forward_peak.h.
TEST(PhaseColours, DifferencesSumTheOrdersOfThePeak) {
  constexpr double kGrey = 0.8, kBand = 0.75;
  const Particles particles(tests::LobeOf(kGrey), {tests::LobeOf(kBand)});
  const double f = std::pow(kGrey, kPeakDegree + 1);
  const auto expected = [&](double g, unsigned degree, double x) {
    const double chi = std::pow(g, degree);
    const double a = degree <= kPeakDegree ? 1.0 : chi / f;
    double orders = 0.0, term = std::exp(-x);
    for (int n = 1; n < 60; ++n) {
      orders += term * std::pow(a, n);
      term *= x / (n + 1.0);
    }
    return ((degree <= kPeakDegree ? chi - f : 0.0) + f * orders) / (1.0 - f);
  };
  // Depths of nodes, between which the light of some depths is shared.
  for (const int node : {0, 1, 2, 4}) {
    const double x = std::expm1(std::log(21.0) * node / 7.0);
    for (const unsigned degree : {1U, 2U, 4U, 7U, 12U}) {
      EXPECT_NEAR(Moment(particles.colours, 0, degree, x),
                  expected(kBand, degree, x) - expected(kGrey, degree, x), 0.004)
          << x << " " << degree;
    }
  }
}

TEST(PhaseColours, LightIsSharedBetweenNeighbouringDepths) {
  const Particles particles = Particles::Droplets();
  const double nu = std::cos(143.0 * kRadiansPerDegree);
  const auto blue = [&](double depth) {
    return particles.colours.Differences(UnitLight(nu, depth))[0];
  };
  OnceScattered both{nu};
  both.Add(0.3, 0.5);
  both.Add(0.7, 3.0);
  EXPECT_NEAR(particles.colours.Differences(both)[0], 0.3 * blue(0.5) + 0.7 * blue(3.0), 1e-9);
  EXPECT_GT(blue(0.0), 2.0 * blue(3.0)) << "the peak blurs colours on a deep way";
  EXPECT_EQ(blue(20.0), blue(500.0));
}

TEST(PhaseColours, OneWavelengthHasNoColour) {
  const PhaseFunction phase = DropletPhases(550.0).Drawn(10.0, 0.5);
  const PhaseColours colours(phase, {phase}, 11);
  for (const double nu : {1.0, 0.9, 0.0, -0.8, -1.0})
    EXPECT_EQ(colours.Differences(UnitLight(nu, 0.7))[0], 0.0);
}

TEST(PhaseColours, RefusesAGreyPhaseFunctionWithoutAPeak) {
  const PhaseFunction lobe = tests::LobeOf(0.8);
  EXPECT_THROW(PhaseColours(tests::LobeOf(0.0), {lobe}, kPeakDegree), InputError);
  EXPECT_THROW(PhaseColours(lobe, {lobe}, 17), InputError);
  EXPECT_THROW(PhaseColours(lobe, {lobe}, -1), InputError);
}

}  // namespace
}  // namespace alpenglow::renderer
