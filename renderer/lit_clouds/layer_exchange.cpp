// SPDX-License-Identifier: MIT
#include "renderer/lit_clouds/layer_exchange.h"

namespace alpenglow::renderer {
namespace {

/// u = albedo d + source, below an interface.
struct FromBelow {
  double albedo, source;
};

/// Returns the diffuse light downwards below a layer.
double DownBelow(const CloudLayerFluxes& layer, const FromBelow& below,
                 const InterfaceFluxes& above) {
  return (layer.sky_down * above.down + layer.sun_down + layer.sky_up * below.source) /
         (1.0 - layer.sky_up * below.albedo);
}

FromBelow Raised(const CloudLayerFluxes& layer, const FromBelow& below) {
  const CloudLayerFluxes unlit{.sky_up = layer.sky_up, .sky_down = layer.sky_down};
  const double of_unit = DownBelow(unlit, {below.albedo, 0.0}, {.down = 1.0});
  return {
      layer.sky_up + layer.sky_down * below.albedo * of_unit,
      layer.sun_up + layer.sky_down * (below.albedo * DownBelow(layer, below, {}) + below.source)};
}

}  // namespace

std::vector<InterfaceFluxes> FluxesBetween(std::span<const CloudLayerFluxes> layers,
                                           const OuterFluxes& outer, double ground_albedo) {
  const std::size_t count = layers.size();
  std::vector<InterfaceFluxes> at(count + 1);
  std::vector<FromBelow> below{
      {ground_albedo, ground_albedo * outer.direct_on_ground + outer.from_ground}};
  for (std::size_t i = 0; i < count; ++i) below.push_back(Raised(layers[i], below[i]));
  at[count].down = (outer.sky + outer.reflection * below.back().source) /
                   (1.0 - outer.reflection * below.back().albedo);
  for (std::size_t i = count; i-- > 0;) at[i].down = DownBelow(layers[i], below[i], at[i + 1]);
  for (std::size_t i = 0; i <= count; ++i)
    at[i].up = below[i].albedo * at[i].down + below[i].source;
  return at;
}

}  // namespace alpenglow::renderer
