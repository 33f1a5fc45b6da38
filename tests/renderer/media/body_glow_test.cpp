// SPDX-License-Identifier: MIT
#include "renderer/media/body_glow.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "renderer/media/local_volume.h"
#include "tests/fixtures/media.h"

namespace alpenglow::renderer {
namespace {

/// Returns a ball of 20 m that absorbs and glows, over the origin.
LocalVolume GlowingBall(double absorption_per_m, double scattering_per_m) {
  MediumOptics optics{SpectrumOf<double>(1), SpectrumOf<double>(1), SpectrumOf<double>(1),
                      tests::LobeOf(0.5)};
  optics.extinction_per_m[0] = absorption_per_m + scattering_per_m;
  optics.scattering_per_m[0] = scattering_per_m;
  optics.emission_per_m[0] = 3.0;
  VolumePlacement placement;
  placement.shape = VolumePlacement::Shape::kEllipsoid;
  placement.size_m = glm::dvec3(20.0);
  return {placement, std::nullopt, nullptr, optics};
}

TEST(BodyGlow, AThinBallSendsItsWholeEmission) {
  const BodyGlow glow = GlowOf(GlowingBall(1e-9, 0.2));
  const double emission = 3.0 * 4.0 / 3.0 * kPi * 1000.0;
  EXPECT_NEAR(static_cast<double>(glow.intensity[0]) / emission, 1.0, 0.03)
      << "16 points along each side count as in the ball or outside";
  EXPECT_NEAR(glow.lamp.position_m.z, 10.0, 1e-12);
}

TEST(BodyGlow, ABallThatAbsorbsSendsTheLightOfItsChords) {
  // The intensity is the integral of the radiance (1 - e^-t) B over the disk of the ball.
  const double absorption_per_m = 0.05, radius_m = 10.0;
  double expected = 0.0;
  const GaussRule& rule = GaussLegendre(16);
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double r = radius_m * rule.node[i];
    const double chord_m = 2.0 * std::sqrt(radius_m * radius_m - r * r);
    expected += radius_m * rule.weight[i] * 2.0 * kPi * r * 3.0 / absorption_per_m *
                -std::expm1(-absorption_per_m * chord_m);
  }
  const BodyGlow glow = GlowOf(GlowingBall(absorption_per_m, 0.0));
  EXPECT_NEAR(static_cast<double>(glow.intensity[0]) / expected, 1.0, 0.03);
}

}  // namespace
}  // namespace alpenglow::renderer
