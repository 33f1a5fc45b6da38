// SPDX-License-Identifier: MIT
#include "atmosphere/ray/direct_scattering.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "atmosphere/math/numerics.h"
#include "atmosphere/ray/direct_kernel.h"

namespace alpenglow::atmosphere {
namespace {

// Returns P_degree(x), by the three-term recurrence.
double Legendre(std::size_t degree, double x) {
  double before = 0.0, now = 1.0;
  for (std::size_t n = 0; n < degree; ++n) {
    const auto k = static_cast<double>(n);
    const double next = ((2.0 * k + 1.0) * x * now - k * before) / (k + 1.0);
    before = std::exchange(now, next);
  }
  return now;
}

void SetLane(const GaussRule& gauss, std::size_t node, std::size_t lane, DirectRule& rule) {
  rule.node[lane] = static_cast<float>(gauss.node[node]);
  rule.weight[lane] = static_cast<float>(gauss.weight[node]);
  rule.last_polynomial[lane] =
      static_cast<float>(Legendre(gauss.node.size() - 1, 2.0 * gauss.node[node] - 1.0));
}

DirectRule InBothHalves(std::size_t nodes) {
  DirectRule rule{};
  for (std::size_t i = 0; i < nodes; ++i) {
    for (const std::size_t first : {std::size_t{0}, kDirectLanes / 2})
      SetLane(GaussLegendre(static_cast<int>(nodes)), i, first + i, rule);
  }
  return rule;
}

DirectRules MakeRules() {
  DirectRules rules{};
  for (std::size_t nodes = 1; nodes <= kMostFewNodes; ++nodes)
    rules.few[nodes] = InBothHalves(nodes);
  for (std::size_t i = 0; i < kManyNodes; ++i)
    SetLane(GaussLegendre(kManyNodes), i, PanelNodes{0, kManyNodes, 0}.SampleOf(i), rules.fourteen);
  rules.eight = InBothHalves(kDirectLanes / 2);
  return rules;
}

const DirectRules& Rules() {
  static const DirectRules rules = MakeRules();
  return rules;
}

ScatteredOnce<float> LightOf(std::size_t bands) {
  ScatteredOnce<float> light;
  light.rayleigh.count = light.mie.count = bands;
  return light;
}

// Returns r of the header.
double LastShare(const ScatteredOnce<float>& light, const ScatteredOnce<float>& last) {
  float largest = 0.0F;
  for (std::size_t band = 0; band < light.rayleigh.count; ++band) {
    const float all = light.rayleigh[band] + light.mie[band];
    if (all > 0.0F)
      largest = std::max(largest, (std::abs(last.rayleigh[band]) + std::abs(last.mie[band])) / all);
  }
  return static_cast<double>(largest);
}

double ErrorOf(DirectMode mode, double least_error, double last_share) {
  const bool fast = mode == DirectMode::kFast;
  const double slope = fast ? 1.0 : 2.0, bend = fast ? 25.0 : 100.0;
  return least_error + slope * last_share / (1.0 + bend * last_share);
}

// Returns whether set-up can place nodes on a ray without further checks. A ray with NaN is not
// valid.
bool IsValid(const ViewRay& ray, double planet_radius_m) {
  return std::abs(ray.mu) <= 1.0 && std::abs(ray.mu_s) <= 1.0 && std::abs(ray.nu) <= 1.0 &&
         ray.length_m >= 0.0 && ray.altitude_m >= -0.5 * planet_radius_m && ray.altitude_m <= 1e12;
}

}  // namespace

DirectScattering::DirectScattering(const Medium& medium)
    : reference_(medium), air_(DirectAirOf(medium)) {}

DirectRay DirectScattering::Place(const ViewRay& ray, const DirectSampling& sampling) const {
  const Medium& medium = reference_.medium();
  if (!IsValid(ray, medium.planet_radius_m))
    static_cast<void>(ExtentOf(ray, medium.planet_radius_m, medium.atmosphere_height_m));
  return DirectRayOf(air_, ray, sampling.mode, sampling.dark_samples);
}

ScatteredOnce<float> DirectScattering::Scatter(const ViewRay& ray, DirectMode mode) const {
  ScatteredOnce<float> scattered = LightOf(air_.bands);
  Kernel<DirectKernel>().scatter({air_, Rules(), Place(ray, {.mode = mode})}, scattered, nullptr);
  return scattered;
}

EstimatedLight DirectScattering::Estimate(const ViewRay& ray, DirectMode mode) const {
  EstimatedLight light{LightOf(air_.bands)};
  ScatteredOnce<float> last = LightOf(air_.bands);
  Kernel<DirectKernel>().scatter({air_, Rules(), Place(ray, {.mode = mode})}, light.scattered,
                                 &last);
  light.error = ErrorOf(mode, air_.least_error, LastShare(light.scattered, last));
  return light;
}

EstimatedLight DirectScattering::ScatterWithin(const ViewRay& ray, double max_error) const {
  const Sampling fine = SamplingForError(max_error);
  if (max_error >= air_.least_error) {
    for (const DirectMode mode : {DirectMode::kFast, DirectMode::kNormal}) {
      EstimatedLight light = Estimate(ray, mode);
      if (light.error <= max_error) return light;
    }
  }
  return {reference_.Scatter(reference_.Sample(ray, fine)), max_error};
}

RaySamples<float> DirectScattering::Sample(const ViewRay& ray,
                                           const DirectSampling& sampling) const {
  RaySamples<float> samples;
  const DirectRay placed = Place(ray, sampling);
  samples.extent = placed.extent;
  Kernel<DirectKernel>().sample({air_, Rules(), placed}, samples, nullptr);
  return samples;
}

ScatteredOnce<float> DirectScattering::Scatter(const DirectRay& placed,
                                               const LaneLight* sunlight) const {
  ScatteredOnce<float> scattered = LightOf(air_.bands);
  Kernel<DirectKernel>().scatter({air_, Rules(), placed, sunlight}, scattered, nullptr);
  return scattered;
}

SampledLight DirectScattering::Sample(const DirectRay& placed, const LaneLight* sunlight) const {
  SampledLight light;
  light.once = LightOf(air_.bands);
  light.samples.extent = placed.extent;
  Kernel<DirectKernel>().sample({air_, Rules(), placed, sunlight}, light.samples, &light.once);
  return light;
}

ColumnSet<float> DirectScattering::ColumnsAlong(const DirectRay& placed) const {
  return Kernel<DirectKernel>().along(air_, Rules(), placed);
}

}  // namespace alpenglow::atmosphere
