// SPDX-License-Identifier: MIT
#include "atmosphere/reference/reference_solution.h"

#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/math/constants.h"
#include "tests/fixtures/stored_cases.h"

namespace alpenglow::atmosphere {
namespace {

// One species, one band, nothing else in the air.
Medium OnlyMolecules(double scattering_per_m, double scale_height_m) {
  Medium medium = MediumPreset("bruneton2017");
  for (std::size_t band = 0; band < medium.wavelengths_nm.size(); ++band) {
    medium.rayleigh_scattering_per_m[band] = scattering_per_m;
    medium.mie_scattering_per_m[band] = medium.mie_extinction_per_m[band] = 0.0;
    medium.ozone_absorption_per_m[band] = 0.0;
  }
  medium.rayleigh_scale_height_m = scale_height_m;
  return medium;
}

TEST(Reference, VerticalColumnIsThatOfThePlaneLayer) {
  const Medium medium = OnlyMolecules(1e-5, 8000.0);
  const auto depth = reference::OpticalDepthAlong(medium, {0.0, 1.0, 1.0, 1.0});
  const double closed = 1e-5 * 8000.0 * (1.0 - std::exp(-medium.atmosphere_height_m / 8000.0));
  EXPECT_NEAR(depth.tau[0] / closed, 1.0, 1e-12) << "a vertical ray knows no curvature";
  EXPECT_FALSE(depth.blocked);
}

TEST(Reference, UniformAirHasTheDepthOfItsChord) {
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

TEST(Reference, StoredOpticalDepthsAgreeToOnePartInAHundredMillion) {
  if (!stored::Available()) GTEST_SKIP() << "no stored cases at " << stored::Folder();
  const auto media = stored::Media();
  const auto results = stored::Results("transmittance_results.csv");
  int compared = 0;
  for (const stored::Row& row : stored::Read("transmittance.csv")) {
    const Medium& medium = media.at(row.at("set"));
    const auto depth = reference::OpticalDepthAlong(medium, stored::RayOf(row));
    EXPECT_TRUE(depth.converged) << row.at("id");
    for (const stored::Row& expected : results.at(row.at("id"))) {
      const double tau = stored::Number(expected, "tau");
      EXPECT_NEAR(depth.tau[stored::Band(medium, expected)], tau, 1e-8 * tau)
          << row.at("id") << " " << row.at("tag") << ": stored to 1e-15";
      ++compared;
    }
  }
  EXPECT_GT(compared, 250);
}

TEST(Reference, StoredSingleScatteringAgreesToOnePartInTenMillion) {
  if (!stored::Available()) GTEST_SKIP() << "no stored cases at " << stored::Folder();
  const auto media = stored::Media();
  const auto results = stored::Results("single_results.csv");
  int compared = 0;
  for (const stored::Row& row : stored::Read("single.csv")) {
    const Medium& medium = media.at(row.at("set"));
    const auto light = reference::SingleScatteringAlong(medium, stored::RayOf(row));
    EXPECT_TRUE(light.converged) << row.at("id");
    for (const stored::Row& expected : results.at(row.at("id"))) {
      const std::size_t band = stored::Band(medium, expected);
      const double total = stored::Number(expected, "total");
      EXPECT_NEAR(light.inscatter[band] + light.ground[band], total, 1e-7 * total)
          << row.at("id") << " " << row.at("tag") << ": stored to 1e-10";
      ++compared;
    }
  }
  EXPECT_GT(compared, 400);
}

}  // namespace
}  // namespace alpenglow::atmosphere
