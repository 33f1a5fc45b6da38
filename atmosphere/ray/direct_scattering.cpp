// SPDX-License-Identifier: MIT
#include "atmosphere/ray/direct_scattering.h"

#include <cmath>

#include "atmosphere/math/numerics.h"
#include "atmosphere/ray/direct_kernel.h"

namespace alpenglow::atmosphere {
namespace {

void SetLane(const GaussRule& gauss, std::size_t node, std::size_t lane, DirectRule& rule) {
  rule.node[lane] = static_cast<float>(gauss.node[node]);
  rule.weight[lane] = static_cast<float>(gauss.weight[node]);
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
  light.rayleigh = light.mie = Spectrum(bands);
  return light;
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
  Kernel<DirectKernel>().scatter({air_, Rules(), Place(ray, {.mode = mode})}, scattered);
  return scattered;
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
  Kernel<DirectKernel>().scatter({air_, Rules(), placed, sunlight}, scattered);
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
