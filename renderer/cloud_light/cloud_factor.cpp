// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_factor.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"

namespace alpenglow::renderer {
namespace {

using FactorRandom = CloudPathTracer::PathRandom;

constexpr double kInfinite_m = std::numeric_limits<double>::infinity();
constexpr double kLeastCosine = 0.03;
constexpr double kLeastDepth = 0.1;  // of rays that count
constexpr double kLeastOfMean = 0.1;
// Means of fitted factors, before WithFlux(), over fields of cumulus and stratocumulus with suns from 12 to
// 66 degrees, by node (cloud_light_study prints factors).
constexpr std::array<double, kCloudFactorNodes> kUsualFactor{1.20, 1.33, 1.15, 0.97, 0.92, 0.93};
// By which factors, relative to the usual ones, are expected to differ from what fits all nodes alike, and from their
// neighbours. Nodes with little light follow others.
constexpr double kNodeScatter = 0.2, kNeighbourScatter = 0.1;
constexpr double kLeastVariance = 1e-4;  // of a ray, relative to its radiance

/// A ray with its light by both methods.
struct FactorRay {
  CloudRayParts parts;
  double traced = 0.0;
};

/// Returns a ray from a random point of the top or base, with a random direction into the field.
CloudRay RandomRay(const CloudField& field, FactorRandom& random) {
  const bool is_upward = random.Next() < 0.5;
  const CloudBox bounds = field.Bounds();
  const bool is_periodic = field.lattice().is_periodic;
  const glm::dvec3 low = is_periodic ? field.lattice().origin_m : bounds.low;
  const glm::dvec3 size = is_periodic ? field.lattice().size_m() : bounds.high - bounds.low;
  const double x_m = low.x + size.x * random.Next(), y_m = low.y + size.y * random.Next();
  const double cosine = kLeastCosine + (1.0 - kLeastCosine) * random.Next();
  const double sine = std::sqrt(1.0 - cosine * cosine), azimuth_rad = 2.0 * kPi * random.Next();
  return {
      {x_m, y_m, is_upward ? bounds.low.z : bounds.high.z},
      {sine * std::cos(azimuth_rad), sine * std::sin(azimuth_rad), is_upward ? cosine : -cosine}};
}

std::vector<FactorRay> TracedRays(const CloudField& field, const CloudGather& gather,
                                  const CloudPathTracer& tracer,
                                  const CloudFactorOptions& options) {
  std::vector<std::optional<FactorRay>> rays(options.rays);
  tbb::parallel_for(std::size_t{0}, rays.size(), [&](std::size_t i) {
    FactorRandom random(options.seed, i / atmosphere::reference::kPathsPerBatch,
                        i % atmosphere::reference::kPathsPerBatch);
    const std::optional<CloudRay> begun =
        tracer.AfterCollisions(RandomRay(field, random), options.collisions, random);
    if (!begun) return;
    const CloudRay& ray = *begun;
    FactorRay made{gather.Along(ray, kInfinite_m)};
    if (made.parts.transmittance > std::exp(-kLeastDepth)) return;
    for (int path = 0; path < options.paths_per_ray; ++path) {
      made.traced += tracer.OnePath(ray, random).sun / options.paths_per_ray;
    }
    rays[i] = made;
  });
  std::vector<FactorRay> kept;
  for (const std::optional<FactorRay>& ray : rays) {
    if (ray) kept.push_back(*ray);
  }
  return kept;
}

/// Sums of least squares for factors relative to the usual ones.
struct FactorEquations {
  std::vector<double> matrix = std::vector<double>(kCloudFactorNodes * kCloudFactorNodes, 0.0);
  std::vector<double> right_side = std::vector<double>(kCloudFactorNodes, 0.0);
  double squares = 0.0;
  std::size_t rays = 0;

  void Add(const FactorRay& ray, double weight) {
    const double traced = ray.traced - ray.parts.first;
    squares += weight * traced * traced;
    ++rays;
    for (std::size_t i = 0; i < kCloudFactorNodes; ++i) {
      const double light = kUsualFactor[i] * ray.parts.higher[i];
      right_side[i] += weight * light * traced;
      for (std::size_t j = 0; j < kCloudFactorNodes; ++j) {
        matrix[i * kCloudFactorNodes + j] += weight * light * kUsualFactor[j] * ray.parts.higher[j];
      }
    }
  }
  /// Adds what is expected of the factors. Errors of rays are as large as they are by the one factor that
  /// fits all nodes best.
  void AddExpected() {
    const double of_light = std::accumulate(matrix.begin(), matrix.end(), 0.0);
    const double products = std::accumulate(right_side.begin(), right_side.end(), 0.0);
    const double common = of_light > 0.0 ? products / of_light : 1.0;
    // Nodes without light need a little.
    const double variance =
        std::max((squares - common * products) / static_cast<double>(rays), kLeastVariance);
    const double ridge = variance / (kNodeScatter * kNodeScatter);
    const double smooth = variance / (kNeighbourScatter * kNeighbourScatter);
    for (std::size_t i = 0; i < kCloudFactorNodes; ++i) {
      matrix[i * (kCloudFactorNodes + 1)] += ridge;
      right_side[i] += ridge * common;
      if (i == 0) continue;
      matrix[i * (kCloudFactorNodes + 1)] += smooth;
      matrix[(i - 1) * (kCloudFactorNodes + 1)] += smooth;
      matrix[i * kCloudFactorNodes + i - 1] -= smooth;
      matrix[(i - 1) * kCloudFactorNodes + i] -= smooth;
    }
  }
};

}  // namespace

CloudFactor FitCloudFactor(const CloudField& field, const CloudGather& gather,
                           const CloudPathTracer& tracer, const CloudFactorOptions& options) {
  RequireInRange(static_cast<double>(options.rays), 0.0, 1e7, "rays for the factor of clouds");
  RequireInRange(options.paths_per_ray, 1.0, 1000.0, "paths per ray for the factor of clouds");
  const std::vector<FactorRay> rays = TracedRays(field, gather, tracer, options);
  double mean = 0.0;
  for (const FactorRay& ray : rays) mean += ray.traced / static_cast<double>(rays.size());
  if (!(mean > 0.0)) return {};
  FactorEquations equations;
  for (const FactorRay& ray : rays) {
    const double scale = std::max(CloudFactor{}.Sun(ray.parts), kLeastOfMean * mean);
    // Rays from inside scatter more, and few of them are bright: their errors count by the variance.
    equations.Add(ray, 1.0 / (scale * (options.collisions > 0 ? scale : mean)));
  }
  equations.AddExpected();
  const std::vector<double> solved = SolvePositiveDefinite(equations.matrix, equations.right_side);
  CloudFactor factor;
  for (std::size_t i = 0; i < kCloudFactorNodes; ++i) {
    factor.node[i] = std::clamp(kUsualFactor[i] * solved[i], kLeastCloudFactor, kMostCloudFactor);
  }
  return factor;
}

CloudFactor WithFlux(const CloudFactor& factor, const CloudGather& gather,
                     const CloudPlaneRays& rays, double flux) {
  constexpr int kRaysOfFlux = 8192;                       // through each plane
  std::vector<std::array<double, 2>> light(kRaysOfFlux);  // of the first order, and of all
  tbb::parallel_for(0, kRaysOfFlux, [&](int i) {
    std::array<double, 2>& sum = light[static_cast<std::size_t>(i)];
    for (const CloudPlaneRay& ray : {rays.FromTop(i + 1), rays.FromBase(i + 1)}) {
      if (ray.weight <= 0.0) continue;
      const CloudRayParts parts = gather.Along(ray.ray, kInfinite_m);
      sum[0] += ray.weight / kRaysOfFlux * parts.first;
      sum[1] += ray.weight / kRaysOfFlux * factor.Sun(parts);
    }
  });
  double first = 0.0, all = 0.0;
  for (const std::array<double, 2>& each : light) {
    first += each[0];
    all += each[1];
  }
  if (!(all > first)) return factor;
  CloudFactor scaled;
  for (std::size_t i = 0; i < kCloudFactorNodes; ++i) {
    scaled.node[i] = std::clamp((flux - first) / (all - first) * factor.node[i], kLeastCloudFactor,
                                kMostCloudFactor);
  }
  return scaled;
}

}  // namespace alpenglow::renderer
