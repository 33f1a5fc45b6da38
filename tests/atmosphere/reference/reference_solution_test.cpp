// SPDX-License-Identifier: MIT
#include "atmosphere/reference/reference_solution.h"

#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/math/constants.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/stored_cases.h"

namespace alpenglow::atmosphere {
namespace {

Medium OnlyMolecules(double scattering_per_m, double scale_height_m) {
  Medium medium = tests::MoleculesOf(MediumPreset("bruneton2017"));
  medium.rayleigh_scattering_per_m.assign(3, scattering_per_m);
  medium.rayleigh_scale_height_m = scale_height_m;
  return medium;
}

TEST(Reference, VerticalColumnEqualsThatOfAPlaneLayer) {
  const Medium medium = OnlyMolecules(1e-5, 8000.0);
  const auto depth = reference::OpticalDepthAlong(medium, {0.0, 1.0, 1.0, 1.0});
  const double closed = 1e-5 * 8000.0 * (1.0 - std::exp(-medium.atmosphere_height_m / 8000.0));
  EXPECT_NEAR(depth.tau[0] / closed, 1.0, 1e-12) << "a vertical ray knows no curvature";
  EXPECT_FALSE(depth.blocked);
}

TEST(Reference, UniformAirHasTheOpticalDepthOfItsChord) {
  const Medium medium = OnlyMolecules(1e-6, 199000.0);
  const ViewRay ray{0.0, 0.0, 1.0, 0.0, 1000.0};
  const auto depth = reference::OpticalDepthAlong(medium, ray);
  // Along 1 km of a horizontal ray the altitude rises by 8 cm: 4e-7 of the scale height.
  EXPECT_NEAR(depth.tau[0] / (1e-6 * 1000.0), 1.0, 3e-7);
}

// Hard case 28.
TEST(Reference, EmptyAirIsBlackAndTransparent) {
  const Medium medium = OnlyMolecules(0.0, 8000.0);
  const auto light = reference::SingleScatteringAlong(medium, {2.0, 0.3, 0.5, 0.4});
  EXPECT_EQ(light.inscatter[0], 0.0);
  EXPECT_EQ(light.transmittance[0], 1.0);
}

TEST(Reference, ThinUniformAirScattersLengthTimesCoefficientTimesPhase) {
  const Medium medium = OnlyMolecules(1e-12, 8000.0);
  const auto light = reference::SingleScatteringAlong(medium, {0.0, 1.0, 1.0, 1.0});
  const double column = 8000.0 * (1.0 - std::exp(-medium.atmosphere_height_m / 8000.0));
  EXPECT_NEAR(light.inscatter[0] / (1e-12 * column * 3.0 / (8.0 * kPi)), 1.0, 1e-7)
      << "attenuation is 1e-8, quadrature 1e-8";
}

TEST(Reference, StoredOpticalDepthsAgreeTo1e8) {
  const int compared =
      stored::Compare("transmittance", stored::All, [](const stored::Row& row, const Medium& air) {
        const auto depth = reference::OpticalDepthAlong(air, stored::RayOf(row));
        EXPECT_TRUE(depth.converged) << row.at("id");
        return [depth, &row](const stored::Row& expected, std::size_t band) {
          const double tau = stored::Number(expected, "tau");
          EXPECT_NEAR(depth.tau[band], tau, 1e-8 * tau)
              << row.at("id") << " " << row.at("tag") << ": stored to 1e-15";
        };
      });
  EXPECT_GT(compared, 250);
}

TEST(Reference, StoredSingleScatteringAgreesTo1e7) {
  int number = 0;
  const auto is_kept = [&](const stored::Row&) { return ++number % tests::ScaledDown(1, 5) == 0; };
  const int compared =
      stored::Compare("single", is_kept, [](const stored::Row& row, const Medium& air) {
        const auto light = reference::SingleScatteringAlong(air, stored::RayOf(row));
        EXPECT_TRUE(light.converged) << row.at("id");
        return [light, &row](const stored::Row& expected, std::size_t band) {
          const double total = stored::Number(expected, "total");
          EXPECT_NEAR(light.inscatter[band] + light.ground[band], total, 1e-7 * total)
              << row.at("id") << " " << row.at("tag") << ": stored to 1e-10";
        };
      });
  EXPECT_GT(compared, tests::ScaledDown(400, 80));
}

}  // namespace
}  // namespace alpenglow::atmosphere
