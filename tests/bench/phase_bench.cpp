// SPDX-License-Identifier: MIT
// Measures the time of a phase function per angle, and of the aerosol's phase functions in four
// bands per ray. Run by hand.
#include <benchmark/benchmark.h>

#include "atmosphere/medium/phase_table.h"
#include "atmosphere/ray/single_scattering.h"

namespace alpenglow::atmosphere {
namespace {

constexpr int kAngles = 1000;

double CosineNumber(int i) { return 1.0 - 2.0 * ((i * 37) % kAngles) / kAngles; }

Medium Dusty() { return MediumFromToml("[aerosol]\nmixture = \"desert\"\n", "dusty"); }

void Evaluate(benchmark::State& state, const PhaseFunction& phase) {
  int i = 0;
  for (auto unused : state) benchmark::DoNotOptimize(Phase(phase, CosineNumber(++i)));
}
BENCHMARK_CAPTURE(Evaluate, CornetteShanks,
                  PhaseFunction{.kind = PhaseKind::kCornetteShanks, .g = 0.8});
BENCHMARK_CAPTURE(Evaluate, Fog, FogPhase(12.0));
BENCHMARK_CAPTURE(Evaluate, Table, Dusty().mie_phase.front());

void Draw(benchmark::State& state, const PhaseFunction& phase) {
  int i = 0;
  for (auto unused : state) {
    benchmark::DoNotOptimize(SampleCosine(phase, (++i * 37 % kAngles + 0.5) / kAngles));
  }
}
BENCHMARK_CAPTURE(Draw, CornetteShanks,
                  PhaseFunction{.kind = PhaseKind::kCornetteShanks, .g = 0.8});
BENCHMARK_CAPTURE(Draw, Fog, FogPhase(12.0));
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
}  // namespace alpenglow::atmosphere
