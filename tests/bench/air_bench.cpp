// SPDX-License-Identifier: MIT
// Time of what a renderer asks of the air, per ray and per table. Run by hand; results are in
// README.md.
#include <benchmark/benchmark.h>

#include "atmosphere/judge.h"
#include "atmosphere/single_scattering.h"
#include "lut/multiple_scattering.h"

namespace alpenglow {
namespace {

ViewRay RayNumber(int i) { return RayFromAngles(1000.0, 20 + i % 69, i % 180, 60 + i % 29); }

void TransmittanceToSpace(benchmark::State& state) {
  const AirIntegrator<float> air(MediumPreset("earth"));
  int i = 0;
  for (auto unused : state)
    benchmark::DoNotOptimize(air.TransmittanceToSpace(1000.0, 0.01 * (++i % 100)));
}
BENCHMARK(TransmittanceToSpace);

void SingleScatteringOfOneRay(benchmark::State& state) {
  const AirIntegrator<float> air(MediumPreset("earth"));
  const Sampling sampling{.nodes = static_cast<int>(state.range(0)),
                          .split_ozone = state.range(1) != 0};
  int i = 0;
  for (auto unused : state)
    benchmark::DoNotOptimize(air.Scatter(air.Sample(RayNumber(++i), sampling)));
}
BENCHMARK(SingleScatteringOfOneRay)
    ->Args({8, 0})
    ->Args({12, 0})
    ->Args({16, 1})
    ->ArgNames({"nodes", "split"});

void SingleScatteringByTheJudge(benchmark::State& state) {
  const Medium medium = MediumPreset("earth");
  int i = 0;
  for (auto unused : state)
    benchmark::DoNotOptimize(judge::SingleScatteringAlong(medium, RayNumber(++i)));
}
BENCHMARK(SingleScatteringByTheJudge)->Unit(benchmark::kMicrosecond);

void DiffuseLightOfOneRay(benchmark::State& state) {
  const Medium medium = MediumPreset("earth");
  const AirIntegrator<float> air(medium);
  const DiffuseLight light(medium);
  int i = 0;
  for (auto unused : state) {
    const ViewRay ray = RayNumber(++i);
    benchmark::DoNotOptimize(
        light.InscatterAlong(air.Sample(ray, {.nodes = 12, .dark_samples = true}), ray.nu));
  }
}
BENCHMARK(DiffuseLightOfOneRay);

void BuildOfDiffuseLight(benchmark::State& state) {
  const Medium medium = MediumPreset("earth");
  for (auto unused : state) benchmark::DoNotOptimize(DiffuseLight(medium));
}
BENCHMARK(BuildOfDiffuseLight)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace alpenglow
