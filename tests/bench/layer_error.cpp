// SPDX-License-Identifier: MIT
// studies layer_error [G]: errors and times of light in plane-parallel layers (renderer/layers) by
// the number of streams, relative to 48 streams. G is the mean cosine of the cloud (0.85).
//
// Cases are those of renderer/report/layer_cases.h. Times are of the processor: the least of twenty
// runs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <ctime>
#include <string>
#include <vector>

#include "atmosphere/base/parsing.h"
#include "renderer/layers/layer_field.h"
#include "renderer/report/layer_cases.h"
#include "tests/bench/studies.h"

namespace alpenglow::tests {
namespace {

using namespace renderer;

constexpr int kTrueStreams = 48;

LightOfLayers LightBy(const std::vector<LayerCase>& cases, int streams) {
  LightOfLayers light;
  for (const LayerCase& one : cases) {
    const LayerStack stack(one.layers, one.ground_albedo, streams);
    const LightOfLayers more = LightIn(one, LayerField::UnderSun(stack, one.mu_s));
    light.radiances.insert(light.radiances.end(), more.radiances.begin(), more.radiances.end());
    light.fluxes.insert(light.fluxes.end(), more.fluxes.begin(), more.fluxes.end());
  }
  return light;
}

/// Returns the least time of twenty runs [us].
template <typename Action>
double LeastTime_us(int repeats, const Action& action) {
  double least = 1e9;
  for (int run = 0; run < 20; ++run) {
    const std::clock_t begin = std::clock();
    for (int i = 0; i < repeats; ++i) action();
    least = std::min(least, static_cast<double>(std::clock() - begin) * 1e6 / CLOCKS_PER_SEC);
  }
  return least / repeats;
}

std::string TimesOf(const std::vector<LayerOptics>& layers, int streams) {
  const double of_stack = LeastTime_us(5, [&] { return LayerStack(layers, 0.2, streams); });
  const LayerStack stack(layers, 0.2, streams);
  double sum = 0.0;
  const double of_sun =
      LeastTime_us(20, [&] { sum += LayerField::UnderSun(stack, 0.4).Fluxes(0.0).up; });
  return fmt::format("{:.0f} / {:.1f}{}", of_stack, of_sun, sum > 0.0 ? "" : " dark");
}

}  // namespace

void LayerError(int count, char** arguments) {
  const double g = count > 1 ? ParseNumber(arguments[1]).value() : 0.85;
  const std::vector<LayerCase> cases = LayerCasesOf(g);
  const LightOfLayers truth = LightBy(cases, kTrueStreams);
  fmt::print("streams | rms % | p99 % | largest % | flux % | 1 layer, 3 layers: stack / sun us\n");
  for (const int streams : {4, 6, 8, 12, 16, 32}) {
    const LightOfLayers light = LightBy(cases, streams);
    std::vector<double> errors;
    double squares = 0.0, flux = 0.0;
    for (std::size_t i = 0; i < truth.radiances.size(); ++i) {
      errors.push_back(std::abs(light.radiances[i] / truth.radiances[i] - 1.0));
      squares += errors.back() * errors.back();
    }
    for (std::size_t i = 0; i < truth.fluxes.size(); ++i) {
      flux = std::max(flux, std::abs(light.fluxes[i] - truth.fluxes[i]));
    }
    std::sort(errors.begin(), errors.end());
    fmt::print("{} | {:.3f} | {:.2f} | {:.1f} | {:.3f} | {}, {}\n", streams,
               100.0 * std::sqrt(squares / static_cast<double>(errors.size())),
               100.0 * errors[errors.size() * 99 / 100], 100.0 * errors.back(), 100.0 * flux,
               TimesOf({{5.0, 0.9999, MomentsOfLobe(g)}}, streams),
               TimesOf(CloudInAir(5.0, g), streams));
  }
}

}  // namespace alpenglow::tests
