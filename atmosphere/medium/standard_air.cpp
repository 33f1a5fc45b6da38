// SPDX-License-Identifier: MIT
#include "atmosphere/medium/standard_air.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "atmosphere/math/constants.h"

namespace alpenglow::atmosphere {
namespace {

constexpr double kHydrostatic_K_per_m = kStandardGravity_m_per_s2 / kGasOfAir_J_per_kg_K;
constexpr double kHeatRatio = 1.4;
constexpr double kRadius_m = 6356766.0;

struct Layer {
  double base_m, lapse_K_per_m;
  double temperature_k = 288.15, pressure_pa = kStandardPressure_pa;  // at the base
};

double TemperatureIn(const Layer& layer, double above_base_m) {
  return layer.temperature_k + layer.lapse_K_per_m * above_base_m;
}

double PressureIn(const Layer& layer, double above_base_m) {
  if (layer.lapse_K_per_m == 0.0) {
    return layer.pressure_pa * std::exp(-kHydrostatic_K_per_m * above_base_m / layer.temperature_k);
  }
  return layer.pressure_pa * std::pow(layer.temperature_k / TemperatureIn(layer, above_base_m),
                                      kHydrostatic_K_per_m / layer.lapse_K_per_m);
}

using Layers = std::array<Layer, 8>;

/// The last layer has no lapse rate, so that the density decreases without end.
Layers LayersFromTheGround() {
  Layers layers{{{0.0, -0.0065},
                 {11000.0, 0.0},
                 {20000.0, 0.001},
                 {32000.0, 0.0028},
                 {47000.0, 0.0},
                 {51000.0, -0.0028},
                 {71000.0, -0.002},
                 {84852.0, 0.0}}};
  for (std::size_t i = 1; i < layers.size(); ++i) {
    const double thickness_m = layers[i].base_m - layers[i - 1].base_m;
    layers[i].temperature_k = TemperatureIn(layers[i - 1], thickness_m);
    layers[i].pressure_pa = PressureIn(layers[i - 1], thickness_m);
  }
  return layers;
}

}  // namespace

StandardAir StandardAirAt(double height_m) {
  static const Layers layers = LayersFromTheGround();
  const double geopotential_m = kRadius_m * height_m / (kRadius_m + height_m);
  const auto above =
      std::upper_bound(layers.begin() + 1, layers.end(), geopotential_m,
                       [](double height, const Layer& layer) { return height < layer.base_m; });
  const Layer& layer = *(above - 1);
  const double temperature_k = TemperatureIn(layer, geopotential_m - layer.base_m);
  const double gas = kGasOfAir_J_per_kg_K * temperature_k;
  const double pressure_pa = PressureIn(layer, geopotential_m - layer.base_m);
  return {pressure_pa / gas, std::sqrt(kHeatRatio * gas), temperature_k, pressure_pa};
}

}  // namespace alpenglow::atmosphere
