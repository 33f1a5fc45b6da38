// SPDX-License-Identifier: MIT
#include "renderer/media/eddington_slab.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <random>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/medium/phase.h"
#include "lut/multiple_scattering/spherical_harmonics.h"
#include "renderer/layer.h"
#include "tests/fixtures/media.h"

namespace alpenglow::renderer {
namespace {

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

glm::dvec3 BeamOf(const Slab& slab) {
  return {std::sqrt(1.0 - slab.mu0 * slab.mu0), 0.0, slab.mu0};
}

/// Light that leaves a slab. The fluxes at the top and the bottom are for a beam of irradiance 1 on
/// a horizontal plane and do not include the beam. The radiances, one for each look, are for a beam
/// of irradiance 1 across it and do not include what the ground sends to the viewer directly.
struct TracedLight {
  double up = 0.0, down = 0.0;
  std::vector<double> radiance;
};

/// Traces photons one by one; z is depth, downwards. Every scattering adds the light that it sends
/// towards viewers outside, at the top looking down or at the bottom looking up.
TracedLight Traced(const Slab& slab, int photons, const std::vector<glm::dvec3>& looks = {}) {
  std::mt19937_64 engine(17);
  const auto random = [&] { return static_cast<double>(engine() >> 11U) * 0x1.0p-53; };
  TracedLight light{.radiance = std::vector<double>(looks.size(), 0.0)};
  for (int i = 0; i < photons; ++i) {
    double z = 0.0, weight = 1.0 / photons;
    const auto survives = [&](double chance) {
      weight /= chance;
      return random() < chance;
    };
    glm::dvec3 way = BeamOf(slab);
    for (bool is_beam = true;; is_beam = false) {
      z -= std::log(1.0 - random()) * way.z;
      if (z <= 0.0) {
        light.up += weight;
        break;
      }
      if (z >= slab.depth) {
        if (!is_beam) light.down += weight;
        weight *= slab.ground;
        if (!survives(slab.ground)) break;
        z = slab.depth;
        way = Turned({0.0, 0.0, -1.0}, std::sqrt(random()), 2.0 * kPi * random());
        continue;
      }
      weight *= slab.albedo;
      for (std::size_t k = 0; k < looks.size(); ++k) {
        const double steep = std::abs(looks[k].z);
        const double left = std::exp(-(looks[k].z > 0.0 ? z : slab.depth - z) / steep);
        light.radiance[k] +=
            slab.mu0 * weight * Phase(slab.phase, -glm::dot(way, looks[k])) * left / steep;
      }
      if (weight * photons < 0.1 && !survives(weight * photons)) break;
      way = Turned(way, SampleCosine(slab.phase, random()), 2.0 * kPi * random());
    }
  }
  return light;
}

/// Returns the same radiance from sources along the ray, which is fast.
double FastRadiance(const Slab& slab, const glm::dvec3& look) {
  const auto chi = LegendreCoefficients(slab.phase, 2);
  const EddingtonSlab eddington({slab.albedo, chi[1], chi[2]}, slab.depth, slab.ground, slab.mu0);
  const PhaseFunction blurred = tests::LobeOf(chi[1]);
  const double cosine = -glm::dot(look, BeamOf(slab));
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
      const TracedLight traced = Traced(slab, 10000);
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
      const TracedLight traced = Traced(slab, 10000);
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
      std::vector<glm::dvec3> looks;
      for (const double z : {0.9, 0.2, -0.2, -0.9}) {
        for (const double azimuth : {0.3, 1.6, 3.0}) {
          const double sine = std::sqrt(1.0 - z * z);
          looks.emplace_back(sine * std::cos(azimuth), sine * std::sin(azimuth), z);
        }
      }
      const TracedLight traced = Traced(slab, 10000, looks);
      for (std::size_t k = 0; k < looks.size(); ++k) {
        const double ratio = FastRadiance(slab, looks[k]) / traced.radiance[k];
        squares += (ratio - 1.0) * (ratio - 1.0);
        least = std::min(least, ratio);
        most = std::max(most, ratio);
        ++count;
      }
    }
  }
  EXPECT_LT(std::sqrt(squares / count), 0.35);
  EXPECT_GT(least, 0.4);
  EXPECT_LT(most, 2.5) << "where the sun grazes and one looks up";
}

}  // namespace
}  // namespace alpenglow::renderer
