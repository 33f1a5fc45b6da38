// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_moments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/shared_glsl/instruction_set.h"
#include "renderer/layer.h"
#include "tests/fixtures/directions.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/sphere_clouds.h"
#include "tests/fixtures/thread_counts.h"

namespace alpenglow::renderer {
namespace {

glm::dvec3 SunOfMoments(double elevation_deg) { return tests::DirectionAt(elevation_deg, 20.0); }

std::shared_ptr<const CloudOptics> OpticsOfMoments(const CloudField& field, double albedo = 1.0,
                                                   double g = 0.85) {
  return std::make_shared<const CloudOptics>(
      field, CloudScatterers{CloudPhases(tests::LobeOf(g)), albedo});
}

TEST(CloudMoments, UniformLightFromAllSidesIsAnEquilibrium) {
  const CloudField field = tests::SphereClouds(0.08);
  const CloudMomentSolver solver(field, OpticsOfMoments(field), {.tolerance = 1e-5});
  const SolvedCloudMoments sky = solver.Sky(), ground = solver.Ground();
  double most = 0.0;
  for (std::size_t cell = 0; cell < solver.cells().size(); ++cell) {
    for (std::size_t k = 0; k < kCloudMoments; ++k) {
      const float sum = sky.moments.Of(cell)[k] + ground.moments.Of(cell)[k];
      const double expected = k == 0 ? std::sqrt(4.0 * kPi) : 0.0;
      if (cell < solver.cells().full()) {
        most = std::max(most, std::abs(static_cast<double>(sum) - expected));
      }
    }
  }
  // One track crosses every cell at each height in each direction, so that the residual of the
  // iteration and floats are all that remains.
  EXPECT_LT(most, 0.05 * std::sqrt(4.0 * kPi));
  EXPECT_NEAR(sky.up_at_top + ground.up_at_top, kPi, 1e-3);
  EXPECT_NEAR(sky.down_at_base + ground.down_at_base, kPi, 1e-3);
}

TEST(CloudMoments, LightOfTheSunLeavesConservativeClouds) {
  const CloudField field = tests::SphereClouds(0.05);
  const CloudMomentSolver solver(field, OpticsOfMoments(field), {.tolerance = 1e-4});
  for (const double elevation_deg : {60.0, 35.0, 12.0}) {
    const CloudSunDepths map(field, SunOfMoments(elevation_deg));
    const SolvedCloudMoments sun = solver.Sun(map);
    EXPECT_LT(sun.residual, 1e-4);
    const double sum = (sun.up_at_top + sun.down_at_base) / map.to_sun().z;
    // Floats and the rest of the iteration are all that is lost.
    EXPECT_NEAR(sum + map.MeanTransmittance(), 1.0, 1e-3) << elevation_deg;
  }
}

TEST(CloudMoments, PlaneLayersHaveTheFluxesOfTracedPaths) {
  struct Case {
    double depth, bound;
  };
  // The bound is relative to the flux of the sun. Cells of 80 m are coarse for a layer of depth 32: by
  // radiances 0.741, 0.763 and 0.772 of the light of a sun at 48 degrees leave its top with cells of
  // 80, 40 and 20 m; a smaller tolerance changes 0.003.
  for (const auto [depth, bound] : {Case{0.5, 0.015}, Case{4.0, 0.015}, Case{32.0, 0.06}}) {
    const CloudField layer = tests::PlaneLayer(depth);
    const CloudSunDepths map(layer, SunOfMoments(35.0));
    const CloudMomentSolver solver(layer, OpticsOfMoments(layer));
    const SolvedCloudMoments sun = solver.Sun(map);
    const CloudPathTracer tracer(layer, {CloudPhases(tests::LobeOf(0.85)), 1.0}, {map.to_sun()});
    const CloudFluxes traced = tracer.Fluxes(
        CloudSource::kSun, {.paths = {.paths = tests::ScaledDown<std::size_t>(150000, 20000)}});
    const double error = traced.mean.up_at_top.standard_error;
    EXPECT_NEAR(sun.up_at_top / map.to_sun().z, traced.mean.up_at_top.value, bound + 3.0 * error)
        << depth;
    EXPECT_NEAR(sun.down_at_base / map.to_sun().z, traced.mean.down_at_base.value,
                bound + 3.0 * error)
        << depth;
    EXPECT_LT(error, 0.005);
  }
}

TEST(CloudMoments, SpheresHaveTheFluxesOfTracedPaths) {
  const CloudField field = tests::SphereClouds(0.05);
  for (const double albedo : {1.0, 0.9}) {
    const CloudMomentSolver solver(field, OpticsOfMoments(field, albedo), {.cell_m = 40.0});
    const CloudSunDepths map(field, SunOfMoments(35.0));
    const SolvedCloudMoments sun = solver.Sun(map);
    const CloudPathTracer tracer(field, {CloudPhases(tests::LobeOf(0.85)), albedo}, {map.to_sun()});
    const CloudColumnFluxes traced =
        tracer
            .Fluxes(CloudSource::kSun,
                    {.paths = {.paths = tests::ScaledDown<std::size_t>(150000, 20000)}})
            .mean;
    // The bound is relative to the flux of the sun.
    EXPECT_NEAR(sun.up_at_top / map.to_sun().z, traced.up_at_top.value,
                0.015 + 3.0 * traced.up_at_top.standard_error);
    EXPECT_NEAR(sun.down_at_base / map.to_sun().z, traced.down_at_base.value,
                0.015 + 3.0 * traced.down_at_base.standard_error);
  }
}

TEST(CloudMoments, FluxesThroughClearAirAreThoseOfItsSources) {
  const CloudField field({{16, 16, 8}, glm::dvec3(20.0), {0.0, 0.0, 5000.0}, true},
                         tests::SphereShape(true), tests::EvenMatter(0.05, 20.0));
  const CloudMomentSolver solver(field, OpticsOfMoments(field));
  EXPECT_NEAR(solver.Sky().down_at_base, kPi, 1e-6);
  EXPECT_EQ(solver.Sky().up_at_top, 0.0);
  const CloudSunDepths map(field, SunOfMoments(35.0));
  EXPECT_NEAR(solver.Sun(map).down_at_base, 0.0, 1e-6);
  for (const float moment : solver.Sky().moments.At({0.0, 0.0, 5000.0})) EXPECT_EQ(moment, 0.0F);
}

TEST(CloudMoments, OpenFieldsAreLitFromTheSides) {
  // Under a low sun, light of the sky enters an open field through its sides as through its top.
  const CloudField open = tests::SphereClouds(0.08, false);
  const CloudMomentSolver solver(open, OpticsOfMoments(open), {.tolerance = 1e-5});
  const SolvedCloudMoments sky = solver.Sky(), ground = solver.Ground();
  double mean = 0.0;
  for (std::size_t cell = 0; cell < solver.cells().full(); ++cell) {
    const float sum = sky.moments.Of(cell)[0] + ground.moments.Of(cell)[0];
    EXPECT_NEAR(sum, std::sqrt(4.0 * kPi), 0.05 * std::sqrt(4.0 * kPi));
    mean += static_cast<double>(sum) / static_cast<double>(solver.cells().full());
  }
  EXPECT_NEAR(mean, std::sqrt(4.0 * kPi), 0.005 * std::sqrt(4.0 * kPi));
}

/// Returns the moments of all cells in a row.
std::vector<CloudHarmonics> AllMoments(const SolvedCloudMoments& solved) {
  std::vector<CloudHarmonics> all;
  for (std::size_t cell = 0; cell < solved.moments.cells().size(); ++cell) {
    all.push_back(solved.moments.Of(cell));
  }
  return all;
}

TEST(CloudMoments, AreTheSameForAnyNumberOfThreads) {
  const CloudField field = tests::SphereClouds(0.05);
  const CloudSunDepths map(field, SunOfMoments(35.0));
  tests::EqualForAnyNumberOfThreads([&] {
    const CloudMomentSolver solver(field, OpticsOfMoments(field));
    return AllMoments(solver.Sun(map));
  });
}

TEST(CloudMoments, InstructionSetsAgree) {
  const CloudField field = tests::SphereClouds(0.05);
  const auto with = [&](InstructionSet set) {
    const InstructionSetScope scope(set);
    return AllMoments(CloudMomentSolver(field, OpticsOfMoments(field)).Sky());
  };
  const std::vector<CloudHarmonics> scalar = with(InstructionSet::kScalar);
  for (const InstructionSet set : AvailableInstructionSets()) {
    const std::vector<CloudHarmonics> found = with(set);
    for (std::size_t cell = 0; cell < scalar.size(); ++cell) {
      for (std::size_t k = 0; k < kCloudMoments; ++k) {
        // Exponentials differ by their last bits, which sums of 48 tracks and iterations add up.
        EXPECT_NEAR(found[cell][k], scalar[cell][k], 1e-4) << NameOf(set);
      }
    }
  }
}

TEST(CloudMoments, RefuseOptionsOutOfRange) {
  const CloudField field = tests::SphereClouds(0.05);
  const auto optics = OpticsOfMoments(field);
  EXPECT_THROW(CloudMomentSolver(field, optics, {.cell_m = 1.0}), InputError);
  EXPECT_THROW(CloudMomentSolver(field, optics, {.tolerance = 0.0}), InputError);
  EXPECT_THROW(CloudMomentSolver(field, optics, {.most_sweeps = 0}), InputError);
}

}  // namespace
}  // namespace alpenglow::renderer
