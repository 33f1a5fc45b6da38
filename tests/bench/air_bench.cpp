// SPDX-License-Identifier: MIT
// Measures the time of computations in the air that a renderer needs, per ray and per table, and of
// phase functions. Results are in README.md.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "atmosphere/medium/atmosphere_file.h"
#include "atmosphere/medium/phase_table.h"
#include "atmosphere/ray/direct_scattering.h"
#include "atmosphere/ray/single_scattering.h"
#include "atmosphere/reference/reference_solution.h"
#include "atmosphere/shared_glsl/instruction_set.h"
#include "lut/multiple_scattering/multiple_scattering.h"

namespace alpenglow::lut {
namespace {

ViewRay RayNumber(int i) { return RayFromAngles(1000.0, 20 + i % 69, i % 180, 60 + i % 29); }

/// Returns rays of a sky, with zenith angles of the sun from `sun_zenith_deg` on.
std::vector<ViewRay> Rays(int sun_zenith_deg) {
  std::vector<ViewRay> rays;
  for (int i = 0; i < 512; ++i) {
    rays.push_back(RayFromAngles(1000.0, 20 + i % 69, i % 180, sun_zenith_deg + i % 6));
  }
  return rays;
}

/// Returns instruction set number state.range(0), or the best available one.
InstructionSet SetOf(benchmark::State& state) {
  const auto& sets = AvailableInstructionSets();
  const auto index = std::min(static_cast<std::size_t>(state.range(0)), sets.size() - 1);
  state.SetLabel(std::string(NameOf(sets[index])));
  return sets[index];
}

void TransmittanceToSpace(benchmark::State& state) {
  const SingleScattering<float> air(MediumPreset("earth"));
  int i = 0;
  for (auto unused : state)
    benchmark::DoNotOptimize(air.TransmittanceToSpace(1000.0, 0.01 * (++i % 100)));
}
BENCHMARK(TransmittanceToSpace);

// Three columns (molecules, aerosol, ozone) per point and direction; range 1: 0 upwards, 1 any
// angle.
void ColumnsToSpace(benchmark::State& state) {
  const InstructionSetScope scope(SetOf(state));
  const SingleScattering<float> air(MediumPreset("earth"));
  constexpr std::size_t kPoints = 1024;
  std::vector<float> altitude_m(kPoints), mu(kPoints);
  for (std::size_t i = 0; i < kPoints; ++i) {
    altitude_m[i] = 100e3F * static_cast<float>(i) / kPoints;
    const float lowest = state.range(1) == 0 ? 0.0F : -0.01F;
    mu[i] = lowest + static_cast<float>(i * 37 % kPoints) / kPoints;
    if (altitude_m[i] < 1e3F) mu[i] = std::abs(mu[i]);
  }
  for (auto unused : state) benchmark::DoNotOptimize(air.ColumnsToSpace(altitude_m, mu));
  state.counters["ns_per_column"] = benchmark::Counter(
      3e-9 * kPoints, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(ColumnsToSpace)->ArgsProduct({{0, 1, 2, 3}, {0, 1}})->ArgNames({"set", "any_angle"});

void SingleScatteringOfOneRay(benchmark::State& state) {
  const InstructionSetScope scope(SetOf(state));
  const SingleScattering<float> air(MediumPreset("earth"));
  const Sampling sampling{.nodes = static_cast<int>(state.range(1))};
  const std::vector<ViewRay> rays = Rays(static_cast<int>(state.range(2)));
  std::size_t i = 0;
  for (auto unused : state)
    benchmark::DoNotOptimize(air.Scatter(air.Sample(rays[++i % rays.size()], sampling)));
}
BENCHMARK(SingleScatteringOfOneRay)
    ->ArgsProduct({{0, 1, 2, 3}, {8, 12}, {60, 91}})
    ->ArgNames({"set", "nodes", "sun_zenith"});

// Direct integration along the rays of SingleScatteringOfOneRay; range 1: 0 fast, 1 normal.
void DirectScatteringOfOneRay(benchmark::State& state) {
  const InstructionSetScope scope(SetOf(state));
  const DirectScattering direct(MediumPreset("earth"));
  const DirectMode mode = state.range(1) == 0 ? DirectMode::kFast : DirectMode::kNormal;
  const std::vector<ViewRay> rays = Rays(static_cast<int>(state.range(2)));
  std::size_t i = 0;
  for (auto unused : state) benchmark::DoNotOptimize(direct.Scatter(rays[++i % rays.size()], mode));
}
BENCHMARK(DirectScatteringOfOneRay)
    ->ArgsProduct({{0, 1, 2, 3}, {0, 1}, {60, 91}})
    ->ArgNames({"set", "normal", "sun_zenith"});

// A segment of 20 km of air in front of a mountain; argument: 0 SingleScattering with 8 nodes, 1
// fast, 2 normal.
void AirInFrontOfAMountain(benchmark::State& state) {
  const DirectScattering direct(MediumPreset("earth"));
  const SingleScattering<float>& air = direct.reference();
  const DirectMode mode = state.range(0) == 1 ? DirectMode::kFast : DirectMode::kNormal;
  std::vector<ViewRay> rays = Rays(60);
  for (ViewRay& ray : rays) {
    ray.mu *= 0.1;
    ray.length_m = 20e3;
  }
  std::size_t i = 0;
  for (auto unused : state) {
    const ViewRay& ray = rays[++i % rays.size()];
    benchmark::DoNotOptimize(state.range(0) == 0 ? air.Scatter(air.Sample(ray, {.nodes = 8}))
                                                 : direct.Scatter(ray, mode));
  }
}
BENCHMARK(AirInFrontOfAMountain)->DenseRange(0, 2)->ArgName("method");

void PreparationOfDirectScattering(benchmark::State& state) {
  const Medium medium = MediumPreset("earth");
  for (auto unused : state) benchmark::DoNotOptimize(DirectAirOf(medium));
}
BENCHMARK(PreparationOfDirectScattering)->Unit(benchmark::kMicrosecond);

void SingleScatteringByTheReference(benchmark::State& state) {
  const Medium medium = MediumPreset("earth");
  int i = 0;
  for (auto unused : state)
    benchmark::DoNotOptimize(reference::SingleScatteringAlong(medium, RayNumber(++i)));
}
BENCHMARK(SingleScatteringByTheReference)->Unit(benchmark::kMicrosecond);

// Argument: 1 polarised light, 0 scalar light.
void MultipleScatteringOfOneRay(benchmark::State& state) {
  const Medium earth = MediumPreset("earth");
  const Medium medium = state.range(0) == 1 ? earth : InScalarLight(earth);
  const SingleScattering<float> air(medium);
  const MultipleScattering light(medium);
  int i = 0;
  for (auto unused : state) {
    const ViewRay ray = RayNumber(++i);
    benchmark::DoNotOptimize(
        light.InscatterAlong(air.Sample(ray, {.nodes = 12, .dark_samples = true}), ray.nu));
  }
}
BENCHMARK(MultipleScatteringOfOneRay)->Arg(0)->Arg(1)->ArgName("polarised");

SampledLight ByReference(const SingleScattering<float>& air, const ViewRay& ray) {
  SampledLight light{air.Sample(ray, {.nodes = 12, .dark_samples = true}), {}};
  light.once = air.Scatter(light.samples);
  return light;
}

// All orders of scattering from a direction of the sky; argument: 0 SingleScattering with 12 nodes,
// 1 fast, 2 normal.
void AllOrdersOfOneRay(benchmark::State& state) {
  const Medium medium = MediumPreset("earth");
  const DirectScattering direct(medium);
  const SingleScattering<float>& air = direct.reference();
  const MultipleScattering light(medium);
  const DirectMode mode = state.range(0) == 1 ? DirectMode::kFast : DirectMode::kNormal;
  int i = 0;
  for (auto unused : state) {
    const ViewRay ray = RayNumber(++i);
    const SampledLight sampled =
        state.range(0) == 0
            ? ByReference(air, ray)
            : direct.Sample(direct.Place(ray, {.mode = mode, .dark_samples = true}), nullptr);
    benchmark::DoNotOptimize(air.Inscatter(sampled.once, ray.nu));
    benchmark::DoNotOptimize(light.InscatterAlong(sampled.samples, ray.nu));
  }
}
BENCHMARK(AllOrdersOfOneRay)->DenseRange(0, 2)->ArgName("method");

void BuildOfMultipleScattering(benchmark::State& state) {
  const Medium medium = MediumPreset("earth");
  for (auto unused : state) benchmark::DoNotOptimize(MultipleScattering(medium));
}
BENCHMARK(BuildOfMultipleScattering)->Unit(benchmark::kMillisecond)->UseRealTime();

constexpr int kAngles = 1000;

double CosineNumber(int i) { return 1.0 - 2.0 * ((i * 37) % kAngles) / kAngles; }

Medium Dusty() { return MediumFromToml("[aerosol]\nmixture = \"desert\"\n", "dusty"); }

void Evaluate(benchmark::State& state, const PhaseFunction& phase) {
  int i = 0;
  for (auto unused : state) benchmark::DoNotOptimize(Phase(phase, CosineNumber(++i)));
}
BENCHMARK_CAPTURE(Evaluate, CornetteShanks,
                  PhaseFunction{.kind = PhaseKind::kCornetteShanks, .g = 0.8});
BENCHMARK_CAPTURE(Evaluate, Fog, DropletPhase(12.0));
BENCHMARK_CAPTURE(Evaluate, Table, Dusty().mie_phase.front());

void Draw(benchmark::State& state, const PhaseFunction& phase) {
  int i = 0;
  for (auto unused : state) {
    benchmark::DoNotOptimize(SampleCosine(phase, (++i * 37 % kAngles + 0.5) / kAngles));
  }
}
BENCHMARK_CAPTURE(Draw, CornetteShanks,
                  PhaseFunction{.kind = PhaseKind::kCornetteShanks, .g = 0.8});
BENCHMARK_CAPTURE(Draw, Fog, DropletPhase(12.0));
BENCHMARK_CAPTURE(Draw, Table, Dusty().mie_phase.front());

// Applies phase functions to the scattered light of four bands.
void ApplyInFourBands(benchmark::State& state, const Medium& medium) {
  const SingleScattering<float> air(medium);
  const ScatteredOnce<float> scattered = air.Scatter(air.Sample({2.0, 0.5, 0.7, 0.9}, {}));
  int i = 0;
  for (auto unused : state) benchmark::DoNotOptimize(air.Inscatter(scattered, CosineNumber(++i)));
}
BENCHMARK_CAPTURE(ApplyInFourBands, OneCornetteShanks,
                  MediumFromToml("[mie]\ng = 0.64\n", "one lobe"));
BENCHMARK_CAPTURE(ApplyInFourBands, FourTables, MediumPreset("earth"));

void MakeATable(benchmark::State& state) {
  const PhaseFunction phase = Dusty().mie_phase.front();
  for (auto unused : state) {
    benchmark::DoNotOptimize(PhaseTable(phase.table->angle_deg(), phase.table->per_sr()));
  }
}
BENCHMARK(MakeATable)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace alpenglow::lut
