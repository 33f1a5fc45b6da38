// SPDX-License-Identifier: MIT
// Light that the air brings from distant lamps to level ground, against a plain sum over the sky.
#include "renderer/lamps/lamp_over_planet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/medium/phase.h"
#include "renderer/lamps/lamp_tree.h"
#include "tests/fixtures/lamp_site.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/sanitized.h"

namespace alpenglow::renderer {
namespace {

/// One layer of air of the reference solution.
struct Haze {
  double per_m, scale_height_m, base_m, g;  // g 0: molecules
};
using HazyAir = std::vector<Haze>;

const HazyAir kClean{{1.2e-5, 8000.0, 0.0, 0.0}, {2e-5, 1200.0, 0.0, 0.7}};
const HazyAir kHazy{{1.2e-5, 8000.0, 0.0, 0.0}, {8e-5, 1500.0, 0.0, 0.75}};
const HazyAir kFoggy{{1.2e-5, 8000.0, 0.0, 0.0}, {2e-5, 1200.0, 0.0, 0.7}, {5e-4, 100.0, 0.0, 0.8}};

std::vector<LampLayer> LayersFor(const HazyAir& air) {
  std::vector<LampLayer> layers;
  for (const Haze& haze : air) {
    LampLayer layer;
    layer.scale_height_m = haze.scale_height_m;
    layer.base_m = haze.base_m;
    layer.scattering_per_m = layer.extinction_per_m = SpectrumOf<double>(1);
    layer.scattering_per_m[0] = layer.extinction_per_m[0] = haze.per_m;
    if (haze.g == 0.0) layer.phase = {.kind = PhaseKind::kRayleigh};
    if (haze.g != 0.0) layer.phase = tests::LobeOf(haze.g);
    layers.push_back(layer);
  }
  return layers;
}

/// A lamp over a sphere of sea, and a point of level ground: an isotropic lamp of intensity 1.
struct FarLamp {
  const HazyAir& air;
  double lamp_m, distance_m, point_m;

  static constexpr double kRadius_m = tests::kLampPlanet_m;

  /// Returns positions from the centre of the planet; the point is above the north pole.
  [[nodiscard]] glm::dvec3 Point() const { return {0.0, 0.0, kRadius_m + point_m}; }
  [[nodiscard]] glm::dvec3 LampPlace() const {
    const double to_lamp = kRadius_m + lamp_m, to_point = kRadius_m + point_m;
    const double cosine = (to_lamp * to_lamp + to_point * to_point - distance_m * distance_m) /
                          (2.0 * to_lamp * to_point);
    return to_lamp * glm::dvec3(std::sqrt(1.0 - cosine * cosine), 0.0, cosine);
  }

  [[nodiscard]] double Density(const Haze& haze, const glm::dvec3& at) const {
    return haze.per_m * std::exp((haze.base_m - glm::length(at) + kRadius_m) / haze.scale_height_m);
  }
  /// Returns the optical depth of a straight line by Simpson's rule.
  [[nodiscard]] double Depth(const glm::dvec3& from, const glm::dvec3& to, int steps) const {
    double sum = 0.0;
    for (int i = 0; i <= 2 * steps; ++i) {
      const double weight = i == 0 || i == 2 * steps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
      const glm::dvec3 at = from + i / (2.0 * steps) * (to - from);
      for (const Haze& haze : air) sum += weight * Density(haze, at);
    }
    return sum * glm::length(to - from) / (6.0 * steps);
  }
  /// Returns whether the sea hides two points from each other: each sees to its horizon.
  [[nodiscard]] static bool Sees(const glm::dvec3& a, const glm::dvec3& b) {
    const double apart = std::acos(glm::dot(a, b) / (glm::length(a) * glm::length(b)));
    return apart < std::acos(std::min(kRadius_m / glm::length(a), 1.0)) +
                       std::acos(std::min(kRadius_m / glm::length(b), 1.0));
  }

  [[nodiscard]] double ScatteredAt(const glm::dvec3& at, const glm::dvec3& direction) const {
    const glm::dvec3 lamp = LampPlace();
    if (!Sees(lamp, at)) return 0.0;
    const double far = glm::length(at - lamp);
    const double cosine = -glm::dot(at - lamp, direction) / far;
    double source = 0.0;
    for (const Haze& haze : air) {
      const double lobe = 1.0 + haze.g * haze.g - 2.0 * haze.g * cosine;
      const double phase = haze.g == 0.0 ? 0.75 * (1.0 + cosine * cosine)
                                         : (1.0 - haze.g * haze.g) / (lobe * std::sqrt(lobe));
      source += Density(haze, at) * phase / (4.0 * kPi);
    }
    return source * std::exp(-Depth(lamp, at, 40) - Depth(Point(), at, 12)) / (far * far);
  }

  /// Returns the irradiance of level ground [m^-2]: a sum over elevations, azimuths and lengths,
  /// which are logarithmic.
  [[nodiscard]] double OnLevelGround() const {
    const int elevations = tests::ScaledDown(30, 24), azimuths = tests::ScaledDown(16, 12),
              lengths = tests::ScaledDown(160, 100);
    constexpr double kNearest_m = 2.0, kFarthest_m = 1.5e6, kTop_m = 1.2e5;
    const double ratio = std::log(kFarthest_m / kNearest_m) / lengths;
    double sum = 0.0;
    for (int i = 0; i < elevations; ++i) {
      // The square of the sine is uniform: sin e cos e de.
      const double sine = std::sqrt((i + 0.5) / elevations);
      const double across = std::sqrt(1.0 - sine * sine);
      for (int k = 0; k < azimuths; ++k) {
        const double azimuth = kPi * (k + 0.5) / azimuths;
        const glm::dvec3 direction(across * std::cos(azimuth), across * std::sin(azimuth), sine);
        for (int j = 0; j < lengths; ++j) {
          const double t = kNearest_m * std::exp(ratio * (j + 0.5));
          const glm::dvec3 at = Point() + t * direction;
          if (glm::length(at) > kRadius_m + kTop_m) break;
          sum += ratio * t * ScatteredAt(at, direction);
        }
      }
    }
    return sum * kPi / (elevations * azimuths);
  }

  /// Returns the same by the table.
  [[nodiscard]] double ByTable(const LampAirlightIrradiance& glow) const {
    return glow.On(LampPlace() - Point(), {0.0, 0.0, 1.0}, {0.0, 0.0, 1.0})[0];
  }
};

/// Returns the largest error of the table, relative to the sum over the sky.
double WorstOf(const HazyAir& air, double lamp_m,
               const std::vector<std::array<double, 2>>& distances_and_points_m) {
  const LampAirlightIrradiance glow(LayersFor(air), tests::kLampPlanet_m, lamp_m, 0.0);
  double worst = 0.0;
  for (const auto& [distance_m, point_m] : distances_and_points_m) {
    const FarLamp far{air, lamp_m, distance_m, point_m};
    const double truth = far.OnLevelGround();
    EXPECT_GT(truth, 0.0);
    worst = std::max(worst, std::abs(far.ByTable(glow) / truth - 1.0));
  }
  return worst;
}

TEST(LampOverPlanet, LightsTheGroundLikeASumOverTheSky) {
  EXPECT_LT(WorstOf(kClean, 20.0, {{20e3, 0.0}, {100e3, 0.0}, {200e3, 1500.0}}), 0.2)
      << "straight lines between the logarithms of three distances a decade";
  EXPECT_LT(WorstOf(kClean, 3000.0, {{30e3, 0.0}, {140e3, 0.0}}), 0.2);
  EXPECT_LT(WorstOf(kHazy, 500.0, {{65e3, 0.0}, {100e3, 1500.0}}), 0.2);
}

TEST(LampOverPlanet, LightsTheGroundOverThinFog) {
  EXPECT_LT(WorstOf(kFoggy, 20.0, {{20e3, 0.0}, {100e3, 0.0}}), 0.3)
      << "light travels above the fog, and the fog of the point's own altitude scatters it";
}

TEST(LampOverPlanet, FadesWithoutAStepAlsoBeyondTheTable) {
  for (const double lamp_m : {20.0, 10e3}) {
    const LampAirlightIrradiance glow(LayersFor(kClean), tests::kLampPlanet_m, lamp_m, 0.0);
    const auto light_at = [&](double distance_m) {
      return FarLamp{kClean, lamp_m, distance_m, 0.0}.ByTable(glow);
    };
    for (double far_m = 12e3; far_m < 1.2 * LampAirlightIrradiance::kFarthest_m; far_m *= 1.01) {
      const double here = light_at(far_m), next = light_at(1.01 * far_m);
      EXPECT_LT(next, here) << far_m;
      EXPECT_GT(next, 0.8 * here) << far_m << ": the planet's shadow rises fastest far away";
    }
  }
}

}  // namespace
}  // namespace alpenglow::renderer
