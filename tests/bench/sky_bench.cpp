// SPDX-License-Identifier: MIT
// Measures the time to build a sky view, and of look-ups along rows. Run by hand.
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "atmosphere/math/constants.h"
#include "lut/sky/panorama.h"
#include "lut/sky/sky_view.h"
#include "tests/fixtures/lit_air.h"

namespace alpenglow::lut {
namespace {

using tests::Earth;

SkyView View(double altitude_m, double elevation_deg) {
  return SkyView(Earth().air, Earth().multiple_scattering, altitude_m,
                 std::sin(elevation_deg * kRadiansPerDegree));
}

void BuildOfSkyView(benchmark::State& state) {
  static_cast<void>(Earth());  // is solved before measuring
  for (auto unused : state) {
    benchmark::DoNotOptimize(
        View(static_cast<double>(state.range(0)), static_cast<double>(state.range(1))));
  }
}
BENCHMARK(BuildOfSkyView)
    ->ArgsProduct({{2, 10000, 400000}, {60, 10, 1, -4, -10}})
    ->ArgNames({"altitude", "sun"})
    ->Unit(benchmark::kMillisecond);

// Look-ups of four bands per second, on one core, along the rows of a panorama.
void LookUpsAlongRows(benchmark::State& state) {
  const SkyView view = View(2.0, 10.0);
  std::vector<double> from_sun;
  for (int x = 0; x < 2048; ++x) from_sun.push_back(2.0 * kPi * (x + 0.5) / 2048);
  const SkyAzimuths azimuths(view, from_sun);
  std::vector<float> row(azimuths.count() * view.stride());
  int y = 0;
  for (auto unused : state) {
    view.FillRow(kPi * ((y++ % 1024) + 0.5) / 1024, azimuths, row);
    benchmark::DoNotOptimize(row.data());
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) * 2048);
}
BENCHMARK(LookUpsAlongRows);

void LookUpsOneByOne(benchmark::State& state) {
  const SkyView view = View(2.0, 10.0);
  int i = 0;
  for (auto unused : state) {
    ++i;
    benchmark::DoNotOptimize(view.Radiance(0.003 * (i % 1000), 0.001 * i));
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()));
}
BENCHMARK(LookUpsOneByOne);

void Panorama(benchmark::State& state) {
  static_cast<void>(Earth());
  PanoramaSettings settings;
  settings.sun.elevation_rad = 10.0 * kRadiansPerDegree;
  for (auto unused : state)
    benchmark::DoNotOptimize(RenderPanorama(Earth().air, Earth().multiple_scattering, settings));
}
BENCHMARK(Panorama)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

}  // namespace
}  // namespace alpenglow::lut
