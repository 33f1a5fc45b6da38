// SPDX-License-Identifier: MIT
#include "renderer/layers/layer_stack.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "atmosphere/base/error.h"

namespace alpenglow::renderer {
namespace {

/// Returns the number of azimuth modes that a layer scatters.
int ModesOf(const ScaledLayer& layer) {
  int degree = 0;
  for (std::size_t l = 0; l < layer.chi.size(); ++l) {
    if (layer.chi[l] != 0.0) degree = static_cast<int>(l);
  }
  return degree + 1;
}

void AddTo(std::vector<double>& sum, const std::vector<double>& more) {
  for (std::size_t i = 0; i < more.size(); ++i) sum[i] += more[i];
}

}  // namespace

LayerStack::LayerStack(std::vector<LayerOptics> layers, double ground_albedo, int streams)
    : streams_(streams),
      layers_(std::move(layers)),
      ground_albedo_(RequireInRange(ground_albedo, 0.0, 1.0, "ground_albedo")),
      above_{0.0},
      scaled_above_{0.0} {
  if (layers_.empty()) throw InputError("there are 0 layers; there must be at least 1");
  for (std::size_t n = 0; n < layers_.size(); ++n) {
    RequireLayerOptics(layers_[n], fmt::format("layers[{}]", n));
    scaled_.push_back(DeltaScaled(layers_[n], streams));
    above_.push_back(above_.back() + layers_[n].optical_depth);
    scaled_above_.push_back(scaled_above_.back() + scaled_[n].depth);
    modes_ = std::max(modes_, ModesOf(scaled_[n]));
  }
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    unit_light_.push_back(std::sqrt(streams_.mu(i) * streams_.weight(i)));
  }
  AddModes();
}

void LayerStack::AddModes() {
  for (int m = 0; m < modes_; ++m) {
    for (const ScaledLayer& layer : scaled_) modes_of_layers_.emplace_back(streams_, layer, m);
  }
  below_.resize(modes_of_layers_.size());
  for (int m = 0; m < modes_; ++m) AddFromBelow(m);
}

void LayerStack::AddFromBelow(int m) {
  const std::size_t streams = streams_.size();
  const DenseMatrix one = DenseMatrix::Identity(streams);
  DenseMatrix rho(streams);
  if (m == 0) {
    for (std::size_t i = 0; i < streams; ++i) {
      for (std::size_t j = 0; j < streams; ++j) {
        rho(i, j) = 2.0 * ground_albedo_ * unit_light_[i] * unit_light_[j];
      }
    }
  }
  for (std::size_t n = size(); n-- > 0;) {
    const LayerMode& layer = mode(m, n);
    Below& below = below_[static_cast<std::size_t>(m) * size() + n];
    below = {rho, InverseOf(one - layer.reflection() * rho)};
    rho = layer.reflection() +
          layer.transmission() * below.rho * below.between * layer.transmission();
  }
}

std::vector<InterfaceLight> LayerStack::Solve(int m, const ModeSources& sources) const {
  const std::vector<double> none(streams_.size(), 0.0);
  const auto or_none = [&](const std::vector<double>& light) {
    return light.empty() ? none : light;
  };
  const auto of_layer = [&](const std::vector<std::vector<double>>& light, std::size_t n) {
    return light.empty() ? none : light[n];
  };
  std::vector<InterfaceLight> light(size() + 1);
  // Light that leaves each interface upwards because of sources below, and light between a layer
  // and what is below it:
  std::vector<std::vector<double>> between(size());
  light[size()].up = or_none(sources.of_ground);
  for (std::size_t n = size(); n-- > 0;) {
    const LayerMode& layer = mode(m, n);
    const Below& below = below_[static_cast<std::size_t>(m) * size() + n];
    std::vector<double> down = layer.reflection() * light[n + 1].up;
    AddTo(down, of_layer(sources.down, n));
    between[n] = below.between * down;
    std::vector<double> up = below.rho * between[n];
    AddTo(up, light[n + 1].up);
    light[n].up = layer.transmission() * up;
    AddTo(light[n].up, of_layer(sources.up, n));
  }
  // Going down, the light from above each interface is known.
  light[0].down = or_none(sources.from_above);
  for (std::size_t n = 0; n < size(); ++n) {
    const Below& below = below_[static_cast<std::size_t>(m) * size() + n];
    light[n + 1].down = below.between * (mode(m, n).transmission() * light[n].down);
    AddTo(light[n + 1].down, between[n]);
    AddTo(light[n + 1].up, below.rho * light[n + 1].down);
  }
  // Above the first layer nothing has been reflected yet.
  const LayerMode& first = mode(m, 0);
  std::vector<double> returned = below_[static_cast<std::size_t>(m) * size()].rho *
                                 (below_[static_cast<std::size_t>(m) * size()].between *
                                  (first.transmission() * light[0].down));
  returned = first.transmission() * returned;
  AddTo(light[0].up, returned);
  AddTo(light[0].up, first.reflection() * light[0].down);
  return light;
}

}  // namespace alpenglow::renderer
