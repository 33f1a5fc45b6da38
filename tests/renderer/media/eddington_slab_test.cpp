// SPDX-License-Identifier: MIT
#include "renderer/media/eddington_slab.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <random>

#include "atmosphere/math/constants.h"
#include "atmosphere/medium/phase.h"
#include "lut/multiple_scattering/spherical_harmonics.h"
#include "renderer/layer.h"
#include "tests/fixtures/media.h"

namespace alpenglow::renderer {
namespace {

/// Returns random numbers that are evenly distributed in [0, 1).
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double operator()() { return static_cast<double>(engine_() >> 11U) * 0x1.0p-53; }

 private:
  std::mt19937_64 engine_;
};

struct Slab {
  double depth, albedo, ground, mu0;
  PhaseFunction phase;
};

glm::dvec3 Turned(const glm::dvec3& axis, double cosine, double angle) {
  const glm::dvec3 side = glm::normalize(
      glm::cross(axis, std::abs(axis.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0)));
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  return cosine * axis + sine * (std::cos(angle) * side + std::sin(angle) * glm::cross(axis, side));
}

/// Diffuse light that leaves upwards at the top and downwards at the bottom, for a beam of
/// irradiance 1 on a horizontal plane. Photons are traced one by one; z is depth, downwards.
struct Fluxes {
  double up = 0.0, down = 0.0;
};
Fluxes TracedFluxes(const Slab& slab, int photons) {
  Random random(17);
  Fluxes fluxes;
  for (int i = 0; i < photons; ++i) {
    double z = 0.0, weight = 1.0;
    glm::dvec3 way(std::sqrt(1.0 - slab.mu0 * slab.mu0), 0.0, slab.mu0);
    bool is_beam = true;
    for (;;) {
      z -= std::log(1.0 - random()) * way.z;
      if (z <= 0.0) {
        fluxes.up += weight;
        break;
      }
      if (z >= slab.depth) {
        if (!is_beam) fluxes.down += weight;
        weight *= slab.ground;
        if (random() >= weight) break;
        weight = 1.0;
        z = slab.depth;
        way = Turned({0.0, 0.0, -1.0}, std::sqrt(random()), 2.0 * kPi * random());
      } else {
        weight *= slab.albedo;
        if (weight < 0.1) {
          if (random() >= weight) break;
          weight = 1.0;
        }
        way = Turned(way, SampleCosine(slab.phase, random()), 2.0 * kPi * random());
      }
      is_beam = false;
    }
  }
  return {fluxes.up / photons, fluxes.down / photons};
}

/// Returns the radiance towards a viewer outside, at the top looking down or at the bottom looking
/// up, per unit irradiance across the beam, without the ground and the beam themselves. Backward
/// paths add the beam at every scattering.
double TracedRadiance(const Slab& slab, const glm::dvec3& look, int paths) {
  Random random(29);
  const glm::dvec3 beam(std::sqrt(1.0 - slab.mu0 * slab.mu0), 0.0, slab.mu0);
  double sum = 0.0;
  for (int i = 0; i < paths; ++i) {
    double z = look.z > 0.0 ? 0.0 : slab.depth, weight = 1.0;
    glm::dvec3 way = look;
    for (int order = 0;; ++order) {
      // The first flight is sampled within the layer, so that every path contributes.
      const double to_edge = way.z > 0.0 ? (slab.depth - z) / way.z : -z / way.z;
      if (order == 0) {
        const double inside = -std::expm1(-to_edge);
        weight *= inside;
        z -= std::log(1.0 - random() * inside) * way.z;
      } else {
        z -= std::log(1.0 - random()) * way.z;
      }
      if (z <= 0.0) break;
      glm::dvec3 next;
      if (z >= slab.depth) {
        weight *= slab.ground;
        z = slab.depth;
        sum += weight / kPi * slab.mu0 * std::exp(-z / slab.mu0);
        next = Turned({0.0, 0.0, -1.0}, std::sqrt(random()), 2.0 * kPi * random());
      } else {
        weight *= slab.albedo;
        sum += weight * Phase(slab.phase, -glm::dot(way, beam)) * std::exp(-z / slab.mu0);
        next = Turned(way, SampleCosine(slab.phase, random()), 2.0 * kPi * random());
      }
      if (weight < 0.05 || order > 200) {
        if (random() >= 0.5) break;
        weight *= 2.0;
      }
      way = next;
    }
  }
  return sum / paths;
}

/// Returns the same radiance from sources along the ray, which is fast.
double FastRadiance(const Slab& slab, const glm::dvec3& look) {
  const auto chi = LegendreCoefficients(slab.phase, 2);
  const EddingtonSlab eddington({slab.albedo, chi[1], chi[2]}, slab.depth, slab.ground, slab.mu0);
  const PhaseFunction blurred = tests::LobeOf(chi[1]);
  const glm::dvec3 beam(std::sqrt(1.0 - slab.mu0 * slab.mu0), 0.0, slab.mu0);
  const double cosine = -glm::dot(look, beam);
  constexpr int kSteps = 1000;
  const double length = slab.depth / std::abs(look.z);
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double t = length * (i + 0.5) / kSteps;
    const double z = look.z > 0.0 ? t * look.z : slab.depth + t * look.z;
    const double left = std::exp(-z / slab.mu0);
    const SlabField field = eddington.At(z);
    // Light towards the viewer travels against `look`.
    const double source =
        slab.albedo * (Phase(slab.phase, cosine) * left +
                       Phase(blurred, cosine) * (eddington.BeamLeft(z / slab.mu0) - left) +
                       field.mean - chi[1] * field.slope * look.z);
    sum += std::exp(-t) * source * length / kSteps;
  }
  return sum;
}

// Hard case 30.
TEST(EddingtonSlab, ConservesLightWithoutAbsorption) {
  for (const double depth : {1e-3, 0.3, 3.0, 40.0, 1000.0}) {
    for (const double mu0 : {0.02, 0.3, 1.0}) {
      const EddingtonSlab slab({1.0, 0.85, 0.75}, depth, 0.0, mu0);
      const double up = slab.At(0.0).UpwardFlux();
      const double down = slab.At(depth).DownwardFlux();
      EXPECT_NEAR((up + down + mu0 * slab.BeamLeft(depth / mu0)) / mu0, 1.0, 2e-3 + 1e-6 * depth)
          << depth << " " << mu0 << ": an albedo of 1 counts as 1 - 1e-6";
      EXPECT_NEAR(slab.At(0.0).DownwardFlux(), 0.0, 1e-9);
    }
  }
}

TEST(EddingtonSlab, TheGroundReflectsTheDownwardLight) {
  const EddingtonSlab slab({0.98, 0.8, 0.64}, 2.0, 0.6, 0.5);
  const SlabField field = slab.At(2.0);
  EXPECT_NEAR(field.UpwardFlux(), 0.6 * (field.DownwardFlux() + 0.5 * slab.BeamLeft(4.0)), 1e-9);
}

double WorstFlux(double mu0) {
  double worst = 0.0;
  for (const double depth : {0.3, 1.0, 4.0, 16.0}) {
    for (const double albedo : {0.9, 1.0}) {
      const Slab slab{depth, albedo, 0.2, mu0, DropletPhase(12.0)};
      const Fluxes traced = TracedFluxes(slab, 10000);
      const auto chi = LegendreCoefficients(slab.phase, 2);
      const EddingtonSlab fast({albedo, chi[1], chi[2]}, depth, 0.2, mu0);
      const double up = fast.At(0.0).UpwardFlux() / mu0;
      // The light of the beam and the peak, minus the beam alone, is diffuse light.
      const double down =
          fast.At(depth).DownwardFlux() / mu0 + fast.BeamLeft(depth / mu0) - std::exp(-depth / mu0);
      worst = std::max({worst, std::abs(up - traced.up), std::abs(down - traced.down)});
    }
  }
  return worst;
}

TEST(EddingtonSlab, FluxesAreThoseOfTracedPhotons) {
  EXPECT_LT(WorstFlux(0.9), 0.06) << "10000 photons have a standard error of 0.005";
  EXPECT_LT(WorstFlux(0.4), 0.06);
  EXPECT_LT(WorstFlux(0.1), 0.16) << "Eddington's approximation is weak where the sun grazes";
}

TEST(EddingtonSlab, LobesBackwardsSendNoNegativeLight) {
  for (const double g : {-0.3, -0.6, -0.7, -0.9, -0.99}) {
    for (const double depth : {0.05, 0.5, 4.0, 20.0}) {
      for (const double mu0 : {0.2, 0.6, 1.0}) {
        const EddingtonSlab fast({1.0, g, g * g}, depth, 0.0, mu0);
        const double up = fast.At(0.0).UpwardFlux(), down = fast.At(depth).DownwardFlux();
        EXPECT_GT(fast.At(0.0).mean, 0.0) << g << " " << depth << " " << mu0;
        EXPECT_GE(up, 0.0) << g << " " << depth << " " << mu0;
        EXPECT_GE(down, -1e-9) << g << " " << depth << " " << mu0;
        EXPECT_NEAR((up + down + mu0 * fast.BeamLeft(depth / mu0)) / mu0, 1.0, 2e-3 + 1e-6 * depth)
            << "an albedo of 1 counts as 1 - 1e-6";
      }
    }
  }
}

TEST(EddingtonSlab, FluxesOfLobesBackwardsAreThoseOfTracedPhotons) {
  for (const double g : {-0.5, -0.8}) {
    for (const double depth : {0.3, 1.0, 4.0}) {
      const Slab slab{depth, 1.0, 0.2, 0.6, tests::LobeOf(g)};
      const Fluxes traced = TracedFluxes(slab, 10000);
      const EddingtonSlab fast({1.0, g, g * g}, depth, 0.2, slab.mu0);
      EXPECT_NEAR(fast.At(0.0).UpwardFlux() / slab.mu0, traced.up, 0.1) << g << " " << depth;
      EXPECT_NEAR(fast.At(depth).DownwardFlux() / slab.mu0, traced.down, 0.1) << g << " " << depth;
    }
  }
}

TEST(EddingtonSlab, RadiancesAreThoseOfTracedPaths) {
  double squares = 0.0, least = 1.0, most = 1.0;
  int count = 0;
  for (const double depth : {0.5, 2.0, 8.0}) {
    for (const double mu0 : {0.15, 0.6}) {
      const Slab slab{depth, 1.0, 0.2, mu0, tests::LobeOf(0.8)};
      for (const double z : {0.9, 0.2, -0.2, -0.9}) {
        for (const double azimuth : {0.3, 1.6, 3.0}) {
          const double sine = std::sqrt(1.0 - z * z);
          const glm::dvec3 look(sine * std::cos(azimuth), sine * std::sin(azimuth), z);
          const double ratio = FastRadiance(slab, look) / TracedRadiance(slab, look, 4000);
          squares += (ratio - 1.0) * (ratio - 1.0);
          least = std::min(least, ratio);
          most = std::max(most, ratio);
          ++count;
        }
      }
    }
  }
  EXPECT_LT(std::sqrt(squares / count), 0.35);
  EXPECT_GT(least, 0.4);
  EXPECT_LT(most, 2.5) << "where the sun grazes and one looks up";
}

}  // namespace
}  // namespace alpenglow::renderer
