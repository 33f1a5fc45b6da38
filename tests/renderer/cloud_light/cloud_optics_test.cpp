// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_optics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/medium/phase.h"
#include "atmosphere/medium/phase_table.h"
#include "lut/multiple_scattering/spherical_harmonics.h"
#include "renderer/cloud_phase/droplet_phase.h"
#include "renderer/clouds/cloud_generator.h"
#include "renderer/layer.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/sphere_clouds.h"

namespace alpenglow::renderer {
namespace {

glm::dvec3 AnyDirection(int i) {
  const double z = 2.0 * Halton(i, 2) - 1.0, azimuth_rad = 2.0 * kPi * Halton(i, 3);
  const double sine = std::sqrt(1.0 - z * z);
  return {sine * std::cos(azimuth_rad), sine * std::sin(azimuth_rad), z};
}

TEST(CloudOptics, HarmonicsHaveTheAdditionTheorem) {
  for (int i = 1; i <= 50; ++i) {
    const glm::dvec3 a = AnyDirection(i), b = AnyDirection(i + 100);
    const CloudHarmonics of_a = CloudHarmonicsOf(a), of_b = CloudHarmonicsOf(b);
    const std::vector<double> series = LegendreSeries(kCloudDegree, glm::dot(a, b));
    for (std::size_t l = 0, k = 0; l <= kCloudDegree; ++l) {
      double sum = 0.0;
      for (; k < (l + 1) * (l + 1); ++k) {
        sum += static_cast<double>(of_a[k]) * static_cast<double>(of_b[k]);
      }
      EXPECT_NEAR(sum, series[l], 1e-6) << "floats; degree " << l;
    }
  }
}

TEST(CloudOptics, ScaledMediumKeepsWhatIsAbsorbed) {
  for (const double albedo : {1.0, 0.9, 0.3}) {
    const CloudOptics optics(tests::SphereClouds(0.05), {CloudPhases(tests::LobeOf(0.85)), albedo});
    EXPECT_NEAR(optics.peak().fraction(), std::pow(0.85, 4), 1e-6);
    EXPECT_NEAR(optics.extinction_scale() * (1.0 - optics.scaled_albedo()), 1.0 - albedo, 1e-12);
    const CloudHarmonics factors = optics.SourceFactors({0.0, 0.0, 1.0});
    EXPECT_NEAR(factors[0], optics.scaled_albedo() / std::sqrt(4.0 * kPi), 1e-6);
  }
}

TEST(CloudOptics, MeanPhaseIsThatOfTheRadiiOfTheField) {
  CloudOptions options;
  options.period_m = kPeriodStep_m;
  const CloudField field = MakeCloudField(options);
  const CloudPhases phases = DropletPhases(550.0);
  const PhaseFunction mean = MeanCloudPhase(field, phases);
  double sum = 0.0, value = 0.0;
  constexpr int kPoints = 30000;
  const double cosine = std::cos(141.0 * kRadiansPerDegree);  // the fog bow
  const CloudBox bounds = field.Bounds();
  for (int i = 1; i <= kPoints; ++i) {
    const glm::dvec3 share(Halton(i, 5), Halton(i, 7), Halton(i, 11));
    const glm::dvec3 point = bounds.low + share * (bounds.high - bounds.low);
    const double per_m = field.Extinction_per_m(point);
    if (per_m == 0.0) continue;
    sum += per_m;
    value += per_m * phases.Value(field.EffectiveRadius_um(point), cosine);
  }
  // Bins of the radius are 25 % wide, and samples scatter.
  EXPECT_NEAR(Phase(mean, cosine), value / sum, 0.01 * value / sum);
  EXPECT_NEAR(mean.table->integral(), 1.0, 1e-3);
}

TEST(CloudOptics, RefusesAnAlbedoOutOfRange) {
  const CloudField field = tests::SphereClouds(0.05);
  EXPECT_THROW(CloudOptics(field, {CloudPhases(tests::LobeOf(0.85)), 1.1}), InputError);
  EXPECT_THROW(CloudOptics(field, {CloudPhases(tests::LobeOf(0.0)), 1.0}), InputError)
      << "isotropic scattering has no peak";
}

}  // namespace
}  // namespace alpenglow::renderer
