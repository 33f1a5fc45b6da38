// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_light_fluxes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "atmosphere/base/error.h"
#include "renderer/clouds/cloud_generator.h"
#include "renderer/layer.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/sphere_clouds.h"
#include "tests/fixtures/thread_counts.h"

namespace alpenglow::renderer {
namespace {

const glm::dvec3 kSunOfFluxes{0.48, 0.64, 0.6};

TEST(CloudLightFluxes, MeansAreThoseOfThePathTracer) {
  CloudOptions options;
  options.seed = 5;
  options.period_m = 2.0 * kPeriodStep_m;
  const CloudField field = MakeCloudField(options);
  const CloudScatterers scatterers{CloudPhases(tests::LobeOf(0.85)), 1.0};
  const CloudLight light(field, scatterers, {kSunOfFluxes});
  const CloudLightFluxes mean =
      GatheredFluxes(light, {.rays_per_column = tests::ScaledDown(40000, 3000)}).front();
  const CloudPathTracer tracer(field, scatterers, {kSunOfFluxes});
  const CloudColumnFluxes traced =
      tracer
          .Fluxes(CloudSource::kSun,
                  {.paths = {.paths = tests::ScaledDown<std::size_t>(200000, 10000)}})
          .mean;
  EXPECT_NEAR(mean.up_at_top, traced.up_at_top.value, 0.03 + 3.0 * traced.up_at_top.standard_error);
  EXPECT_NEAR(mean.down_at_base, traced.down_at_base.value,
              0.03 + 3.0 * traced.down_at_base.standard_error);
  EXPECT_NEAR(mean.direct_at_base, traced.direct_at_base.value,
              0.01 + 3.0 * traced.direct_at_base.standard_error);
  EXPECT_LT(traced.up_at_top.standard_error, 0.01);
  RecordProperty("up", std::to_string(mean.up_at_top / traced.up_at_top.value - 1.0));
  RecordProperty("down", std::to_string(mean.down_at_base / traced.down_at_base.value - 1.0));
}

TEST(CloudLightFluxes, ColumnsHaveTheMeanOfTheField) {
  const CloudField field = tests::SphereClouds(0.05);
  const CloudLight light(field, {CloudPhases(tests::LobeOf(0.85)), 1.0}, {kSunOfFluxes},
                         {.factor = {.rays = 0}});
  const CloudLightFluxes whole = GatheredFluxes(light, {.rays_per_column = 20000}).front();
  CloudLightFluxes mean, least{1.0, 1.0, 1.0};
  const std::vector<CloudLightFluxes> columns =
      GatheredFluxes(light, {.columns = {8, 4}, .rays_per_column = 1000});
  ASSERT_EQ(columns.size(), 32U);
  for (const CloudLightFluxes& column : columns) {
    mean.up_at_top += column.up_at_top / 32.0;
    mean.direct_at_base += column.direct_at_base / 32.0;
    mean.down_at_base += column.down_at_base / 32.0;
    least.direct_at_base = std::min(least.direct_at_base, column.direct_at_base);
  }
  // Both have some 20000 rays, whose fluxes scatter by a few times their mean.
  EXPECT_NEAR(mean.up_at_top, whole.up_at_top, 0.05 * whole.up_at_top);
  EXPECT_NEAR(mean.down_at_base, whole.down_at_base, 0.05 * whole.down_at_base);
  EXPECT_NEAR(mean.direct_at_base, whole.direct_at_base, 0.02 * whole.direct_at_base);
  EXPECT_LT(least.direct_at_base, 0.5 * mean.direct_at_base) << "columns differ";
}

TEST(CloudLightFluxes, AreTheSameForAnyNumberOfThreads) {
  const CloudField field = tests::SphereClouds(0.05);
  const CloudLight light(field, {CloudPhases(tests::LobeOf(0.85)), 1.0}, {kSunOfFluxes},
                         {.factor = {.rays = 0}});
  tests::EqualForAnyNumberOfThreads([&] {
    std::vector<double> up;
    for (const CloudLightFluxes& column :
         GatheredFluxes(light, {.columns = {4, 4}, .rays_per_column = 30})) {
      up.push_back(column.up_at_top + 3.0 * column.down_at_base);
    }
    return up;
  });
}

TEST(CloudLightFluxes, RefuseOptionsOutOfRange) {
  const CloudField field = tests::SphereClouds(0.05);
  const CloudLight light(field, {CloudPhases(tests::LobeOf(0.85)), 1.0}, {kSunOfFluxes},
                         {.factor = {.rays = 0}});
  EXPECT_THROW((void)GatheredFluxes(light, {.columns = {0, 1}}), InputError);
  EXPECT_THROW((void)GatheredFluxes(light, {.rays_per_column = 0}), InputError);
}

}  // namespace
}  // namespace alpenglow::renderer
