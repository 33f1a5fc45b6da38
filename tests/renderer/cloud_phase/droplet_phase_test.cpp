// SPDX-License-Identifier: MIT
#include "renderer/cloud_phase/droplet_phase.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "renderer/cloud_light/cloud_path_tracer.h"
#include "renderer/layer.h"
#include "tests/fixtures/lorenz_mie.h"
#include "tests/fixtures/sphere_clouds.h"

namespace alpenglow::renderer {
namespace {

double At(const CloudPhases& phases, double radius_um, double angle_deg) {
  return phases.Value(radius_um, std::cos(angle_deg * kRadiansPerDegree));
}

/// Returns the angle of the largest value between two angles.
double PeakBetween_deg(const CloudPhases& phases, double radius_um, double low, double high) {
  double best = low;
  for (double angle = low; angle <= high; angle += 0.25) {
    if (At(phases, radius_um, angle) > At(phases, radius_um, best)) best = angle;
  }
  return best;
}

/// Expects the phase function of size parameter 50 to be that of water with a refractive index.
void ExpectLorenzMie(double wavelength_nm, double index) {
  constexpr double kSize = 50.0;
  const double radius_um = kSize * wavelength_nm / (2000.0 * kPi);
  const CloudPhases phases = DropletPhases(wavelength_nm);
  std::vector<double> angles_rad;
  for (double angle = 0.25; angle < 180.0; angle += 0.5) {
    angles_rad.push_back(angle * kRadiansPerDegree);
  }
  const SphereScattering exact =
      ScatterBySpheres({index, 0.0}, {radius_um, 1.0 / 9.0}, wavelength_nm, angles_rad);
  double moved = 0.0;
  for (std::size_t i = 0; i < angles_rad.size(); ++i) {
    const double value = phases.Value(radius_um, std::cos(angles_rad[i]));
    moved +=
        kPi * std::sin(angles_rad[i]) * 0.5 * kRadiansPerDegree * std::abs(value - exact.per_sr[i]);
  }
  // Half the absolute difference is the light that goes elsewhere. The 400 spheres of the exact
  // curve and four digits of the table leave a thousandth of it.
  EXPECT_LT(moved, 0.005) << wavelength_nm;
}

// Indices of Hale and Querry (1973). Those of 475 and 625 nm are not in the table.
TEST(DropletPhase, IsThatOfLorenzMieTheory) {
  ExpectLorenzMie(400.0, 1.339);
  ExpectLorenzMie(475.0, 1.336);
  ExpectLorenzMie(550.0, 1.333);
  ExpectLorenzMie(625.0, 1.332);
  ExpectLorenzMie(700.0, 1.331);
}

TEST(DropletPhase, HasTheFogBowAndTheGlory) {
  const CloudPhases phases = DropletPhases(550.0);
  for (const double radius_um : {6.0, 10.0, 15.0}) {
    // The bow of large drops is at 138 degrees; that of droplets is up to ten degrees beyond it.
    const double bow_deg = PeakBetween_deg(phases, radius_um, 125.0, 155.0);
    EXPECT_GT(bow_deg, 137.0);
    EXPECT_LT(bow_deg, 149.0);
    EXPECT_GT(At(phases, radius_um, bow_deg), 2.0 * At(phases, radius_um, 120.0));
    // The first ring of the glory: its radius falls as 1 / x.
    const double ring_deg = PeakBetween_deg(phases, radius_um, 170.0, 179.5);
    EXPECT_GT(At(phases, radius_um, ring_deg), 1.5 * At(phases, radius_um, 165.0)) << radius_um;
  }
  const double small_deg = PeakBetween_deg(phases, 5.0, 125.0, 155.0);
  const double large_deg = PeakBetween_deg(phases, 20.0, 125.0, 155.0);
  EXPECT_GT(small_deg, large_deg + 1.0) << "small droplets have the wider bow";
}

TEST(DropletPhase, OuterEdgeOfTheFogBowIsRed) {
  const CloudPhases blue = DropletPhases(450.0), red = DropletPhases(650.0);
  const auto red_over_blue = [&](double radius_um, double angle_deg) {
    return At(red, radius_um, angle_deg) / At(blue, radius_um, angle_deg);
  };
  // The bow is larger than 8 degrees, and its colours overlap.
  for (const double radius_um : {8.0, 10.0, 15.0}) {
    const double bow_deg = PeakBetween_deg(DropletPhases(550.0), radius_um, 125.0, 155.0);
    EXPECT_GT(red_over_blue(radius_um, bow_deg - 4.0), 1.02) << radius_um;
    EXPECT_NEAR(red_over_blue(radius_um, bow_deg), 1.0, 0.12) << "nearly white " << radius_um;
  }
}

TEST(DropletPhase, RefusesInfraredLight) {
  EXPECT_THROW((void)DropletPhases(1600.0), InputError);
  EXPECT_THROW((void)DropletPhases(std::nan("")), InputError);
}

TEST(DropletPhase, PathsOfDropletsKeepTheEquilibrium) {
  const CloudField field = tests::SphereClouds(0.05);
  const CloudPathTracer tracer(field, {DropletPhases(550.0)}, {.ground_albedo = 0.4});
  const CloudRadiance light =
      tracer.Radiance({{330.0, -300.0, 900.0}, glm::normalize(glm::dvec3(0.0, 0.88, 0.475))});
  EXPECT_THROW((void)tracer.Radiance({{0.0, 0.0, 0.0}, {0.0, 0.9, 0.9}}), InputError);
  EXPECT_NEAR(light.sky.value + 0.6 * light.ground.value, 1.0,
              4.0 * (light.sky.standard_error + light.ground.standard_error));
  EXPECT_GT(light.sun.value, 0.0);
}

}  // namespace
}  // namespace alpenglow::renderer
