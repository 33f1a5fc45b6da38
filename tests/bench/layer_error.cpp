// SPDX-License-Identifier: MIT
// studies layer_error [G]: errors and times of light in plane-parallel layers (renderer/layers) by
// the number of streams, relative to 48 streams. G is the mean cosine of the cloud (0.85).
//
// A cloud lies between two layers of molecules. Radiances are taken at seven depths in random
// directions beyond 3 degrees from the sun. Times are of the processor: the least of twenty runs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <ctime>
#include <random>
#include <string>
#include <vector>

#include "atmosphere/base/parsing.h"
#include "atmosphere/math/constants.h"
#include "renderer/layers/layer_field.h"
#include "tests/bench/studies.h"

namespace alpenglow::tests {
namespace {

using namespace renderer;

constexpr int kTrueStreams = 48;

std::vector<double> MomentsOfLobe(double g) {
  std::vector<double> chi{1.0};
  while (std::abs(chi.back()) > 1e-9) chi.push_back(chi.back() * g);
  return chi;
}

std::vector<LayerOptics> CloudInAir(double depth, double g) {
  const std::vector<double> molecules{1.0, 0.0, 0.1};
  return {{0.17, 1.0, molecules}, {depth, 0.9999, MomentsOfLobe(g)}, {0.05, 1.0, molecules}};
}

/// Light of all cases, in one order.
struct LightOfLayers {
  std::vector<double> radiances, fluxes;  // relative to the incident flux
};

void AddLight(const LayerStack& stack, double mu_s, std::mt19937& engine, LightOfLayers& light) {
  std::uniform_real_distribution<double> number(0.0, 1.0);
  const LayerField field = LayerField::UnderSun(stack, mu_s);
  const double top = stack.DepthAbove(1), cloud = stack.optics(1).optical_depth;
  const double whole = stack.DepthAbove(stack.size());
  for (const double depth :
       {0.0, top, top + 0.1 * cloud, top + 0.5 * cloud, top + 0.9 * cloud, whole - 0.05, whole}) {
    const LayerFluxes fluxes = field.Fluxes(depth);
    light.fluxes.push_back(fluxes.up / mu_s);
    light.fluxes.push_back(fluxes.down / mu_s);
    for (int i = 0; i < 12; ++i) {
      const LightWay way{2.0 * number(engine) - 1.0, kPi * number(engine)};
      const double sines = std::sqrt((1.0 - way.mu * way.mu) * (1.0 - mu_s * mu_s));
      const double nu = sines * std::cos(way.azimuth) - way.mu * mu_s;
      if (nu > std::cos(3.0 * kRadiansPerDegree) || (depth == 0.0 && way.mu < 0.0)) continue;
      light.radiances.push_back(field.Radiance(depth, way));
    }
  }
}

LightOfLayers LightBy(int streams, double g) {
  LightOfLayers light;
  std::mt19937 engine(3);
  for (const double depth : {0.3, 1.0, 5.0, 20.0, 60.0}) {
    for (const double ground : {0.1, 0.8}) {
      const LayerStack stack(CloudInAir(depth, g), ground, streams);
      for (const double mu_s : {0.15, 0.5, 0.9}) AddLight(stack, mu_s, engine, light);
    }
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
  const LightOfLayers truth = LightBy(kTrueStreams, g);
  fmt::print("streams | rms % | p99 % | largest % | flux % | 1 layer, 3 layers: stack / sun us\n");
  for (const int streams : {4, 6, 8, 12, 16, 32}) {
    const LightOfLayers light = LightBy(streams, g);
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
