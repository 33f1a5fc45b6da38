// SPDX-License-Identifier: MIT
#include "renderer/cloud_phase/ice_phase.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

double IceAt(const CloudPhases& phases, double radius_um, double angle_deg) {
  return phases.Value(radius_um, std::cos(angle_deg * kRadiansPerDegree));
}

/// The index of ice (Warren and Brandt 2008, J. Geophys. Res. 113, D14220).
struct IceIndex {
  double wavelength_nm, index;
};
constexpr IceIndex kBlue{400.0, 1.3194}, kGreen{550.0, 1.3110}, kRed{700.0, 1.3069};

double MinimumDeviation_deg(double index, double prism_deg) {
  return 2.0 * std::asin(index * std::sin(0.5 * prism_deg * kRadiansPerDegree)) /
             kRadiansPerDegree -
         prism_deg;
}

/// Returns the angle at which the phase function rises most between two angles.
double EdgeBetween_deg(const CloudPhases& phases, double radius_um, double low, double high) {
  constexpr double kStep = 0.05;
  double best = low, steepest = 0.0;
  for (double angle = low; angle < high; angle += kStep) {
    const double rise =
        IceAt(phases, radius_um, angle + 0.25) - IceAt(phases, radius_um, angle - 0.25);
    if (rise > steepest) {
      steepest = rise;
      best = angle;
    }
  }
  return best;
}

TEST(IcePhase, IsNormalisedWithTheStatedAsymmetry) {
  for (const double wavelength_nm : {400.0, 550.0, 625.0, 700.0}) {
    const CloudPhases phases = IcePhases(wavelength_nm);
    for (const double radius_um : {10.0, 20.0, 40.0, 80.0}) {
      double all = 0.0, cosine = 0.0;
      constexpr int kSteps = 40000;
      for (int i = 0; i < kSteps; ++i) {
        // Angles are dense in the forward peak.
        const double u = (i + 0.5) / kSteps;
        const double theta = kPi * u * u * u;
        const double solid = 2.0 * kPi * std::sin(theta) * kPi * 3.0 * u * u / kSteps;
        const double light = solid * IceAt(phases, radius_um, theta / kRadiansPerDegree);
        all += light;
        cosine += light * std::cos(theta);
      }
      EXPECT_NEAR(all, 1.0, 1e-3) << "the midpoint rule has this error";
      EXPECT_GT(cosine, 0.77) << radius_um;
      EXPECT_LT(cosine, 0.81) << radius_um;
    }
  }
}

TEST(IcePhase, HalosBeginAtTheMinimumDeviation) {
  for (const IceIndex& ice : {kBlue, kGreen, kRed}) {
    const CloudPhases phases = IcePhases(ice.wavelength_nm);
    // Angles of the table are 0.125 degrees apart at the first halo and 0.25 at the second.
    EXPECT_NEAR(EdgeBetween_deg(phases, 80.0, 19.0, 25.0), MinimumDeviation_deg(ice.index, 60.0),
                0.25)
        << ice.wavelength_nm;
    EXPECT_NEAR(EdgeBetween_deg(phases, 80.0, 43.0, 49.0), MinimumDeviation_deg(ice.index, 90.0),
                0.5)
        << ice.wavelength_nm;
  }
}

TEST(IcePhase, InnerEdgesOfHalosAreRed) {
  const CloudPhases blue = IcePhases(kBlue.wavelength_nm), red = IcePhases(kRed.wavelength_nm);
  for (const double radius_um : {40.0, 80.0}) {
    const double blue_deg = EdgeBetween_deg(blue, radius_um, 19.0, 25.0);
    const double red_deg = EdgeBetween_deg(red, radius_um, 19.0, 25.0);
    EXPECT_NEAR(blue_deg - red_deg,
                MinimumDeviation_deg(kBlue.index, 60.0) - MinimumDeviation_deg(kRed.index, 60.0),
                0.3);
    EXPECT_GT(IceAt(red, radius_um, red_deg), 1.1 * IceAt(blue, radius_um, red_deg));
  }
}

TEST(IcePhase, HaloIsSofterForSmallCrystals) {
  const CloudPhases phases = IcePhases(550.0);
  const auto contrast = [&](double radius_um) {
    return IceAt(phases, radius_um, 22.5) / IceAt(phases, radius_um, 18.5);
  };
  EXPECT_GT(contrast(80.0), 1.3);
  EXPECT_LT(contrast(80.0), 2.5) << "halos of cirrus are weak (Forster and Mayer 2022)";
  EXPECT_LT(contrast(10.0), contrast(20.0));
  EXPECT_LT(contrast(20.0), contrast(40.0));
  EXPECT_LT(contrast(40.0), contrast(80.0));
}

TEST(IcePhase, LargeCrystalsHaveTheNarrowerForwardPeak) {
  const CloudPhases phases = IcePhases(550.0);
  // The peak of diffraction at a disc grows with the square of its radius.
  EXPECT_NEAR(IceAt(phases, 40.0, 0.0) / IceAt(phases, 20.0, 0.0), 4.0, 0.2);
}

TEST(IcePhase, RefusesLightThatTheTableLacks) {
  EXPECT_THROW((void)IcePhases(200.0), InputError);
  EXPECT_THROW((void)IcePhases(std::nan("")), InputError);
}

}  // namespace
}  // namespace alpenglow::renderer
