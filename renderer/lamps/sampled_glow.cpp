// SPDX-License-Identifier: MIT
#include "renderer/lamps/sampled_glow.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/vec3.hpp>

#include "atmosphere/lamp/lamp.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"

namespace alpenglow::renderer {
namespace {

constexpr double kLeastLight_per_m = 1e-30;  // lower bound for logarithms [m^-1]
constexpr std::size_t kSlopeTerms = kGlowTerms - 1;
using SlopeTerms = std::array<glm::vec4, kSlopeTerms>;

double DistanceAt(double texel) {
  return shared::LampAirlightDistance(texel / (kGlowDistances - 1.0),
                                      LampAirlightIrradiance::kNearest_m,
                                      LampAirlightIrradiance::kFarthest_m);
}
double RiseAt(double texel) { return shared::LampRiseFromUnit(texel / (kGlowRises - 1.0)); }

/// A lamp in the x-z plane; x points towards it and z upwards.
struct LampSeen {
  const LampAirlightIrradiance& glow;
  double distance_m, rise;

  [[nodiscard]] SpectrumOf<double> On(const glm::dvec3& normal) const {
    return glow.On(glow.ToLamp(distance_m, rise), normal, {0.0, 0.0, 1.0});
  }
  [[nodiscard]] SpectrumOf<double> OnLevel() const { return On({0.0, 0.0, 1.0}); }
};

/// Returns the weights of a slope for the terms of LampAirlightOnSlope.
std::array<double, kSlopeTerms> TermsOf(const glm::dvec3& normal) {
  std::array<double, kSlopeTerms> of_term{};
  for (std::size_t k = 0; k < kSlopeTerms; ++k) {
    std::array<double, kSlopeTerms> one{};
    one[k] = 1.0;
    of_term[k] =
        shared::LampAirlightOnSlope(normal.x, normal.z, one[0], one[1], one[2], one[3], one[4]) -
        1.0;
  }
  return of_term;
}

/// A slope of the least-squares fit.
struct FitSlope {
  glm::dvec3 normal;
  double weight;
  std::array<double, kSlopeTerms> of_term;
};

/// Returns slopes on one side of the plane; light is symmetric about the plane.
const std::vector<FitSlope>& FittedSlopes() {
  static const auto kSlopes = [] {
    constexpr int kTilts = 5, kTurns = 6;
    constexpr double kSteepest_rad = 60.0 * kRadiansPerDegree, kGentleness = 4.0;
    std::vector<FitSlope> slopes;
    for (int i = 0; i < kTilts; ++i) {
      const double tilt = kSteepest_rad * (i + 0.5) / kTilts, z = std::cos(tilt);
      for (int k = 0; k < kTurns; ++k) {
        const double turn = kPi * (k + 0.5) / kTurns;
        const glm::dvec3 normal(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn),
                                z);
        slopes.push_back({normal, std::sin(tilt) * std::pow(z, kGentleness), TermsOf(normal)});
      }
    }
    return slopes;
  }();
  return kSlopes;
}

/// Returns the matrix of the normal equations of the least-squares fit.
const std::vector<double>& FitMatrix() {
  static const auto kMatrix = [] {
    std::vector<double> matrix(kSlopeTerms * kSlopeTerms);
    for (const FitSlope& slope : FittedSlopes()) {
      for (std::size_t i = 0; i < kSlopeTerms; ++i) {
        for (std::size_t j = 0; j < kSlopeTerms; ++j)
          matrix[i * kSlopeTerms + j] += slope.weight * slope.of_term[i] * slope.of_term[j];
      }
    }
    return matrix;
  }();
  return kMatrix;
}

SlopeTerms FitOf(const LampSeen& view) {
  const SpectrumOf<double> level = view.OnLevel();
  std::array<std::vector<double>, 4> sums;
  sums.fill(std::vector<double>(kSlopeTerms));
  for (const FitSlope& slope : FittedSlopes()) {
    const SpectrumOf<double> light = view.On(slope.normal);
    for (std::size_t band = 0; band < level.size(); ++band) {
      const double over_level = light[band] / std::max(level[band], kLeastLight_per_m) - 1.0;
      for (std::size_t i = 0; i < kSlopeTerms; ++i)
        sums[band][i] += slope.weight * slope.of_term[i] * over_level;
    }
  }
  SlopeTerms terms{};
  for (std::size_t band = 0; band < level.size(); ++band) {
    const std::vector<double> fitted = SolvePositiveDefinite(FitMatrix(), sums[band]);
    for (std::size_t i = 0; i < kSlopeTerms; ++i)
      terms[i][static_cast<glm::length_t>(band)] = static_cast<float>(fitted[i]);
  }
  return terms;
}

/// Returns the logarithm of the light on level ground times the distance.
glm::vec4 LogLevelOf(const LampSeen& view) {
  const SpectrumOf<double> level = view.OnLevel();
  glm::vec4 logs(static_cast<float>(std::log(kLeastLight_per_m)));
  for (std::size_t band = 0; band < level.size(); ++band) {
    logs[static_cast<glm::length_t>(band)] =
        static_cast<float>(std::log(std::max(level[band], kLeastLight_per_m) * view.distance_m));
  }
  return logs;
}

}  // namespace

std::vector<glm::vec4> SampledGlow(const LampAirlightIrradiance& glow) {
  constexpr std::size_t kTerm = std::size_t{kGlowDistances} * kGlowRises;
  std::vector<glm::vec4> texels(kGlowTerms * kTerm);
  tbb::parallel_for(std::size_t{0}, kTerm, [&](std::size_t at) {
    const LampSeen view{glow, DistanceAt(static_cast<double>(at % kGlowDistances)),
                        RiseAt(static_cast<double>(at / kGlowDistances))};
    texels[at] = LogLevelOf(view);
    const SlopeTerms terms = FitOf(view);
    for (std::size_t k = 0; k < kSlopeTerms; ++k) texels[(k + 1) * kTerm + at] = terms[k];
  });
  return texels;
}

}  // namespace alpenglow::renderer
