// SPDX-License-Identifier: MIT
// The light in a layer (LayerLight) summed along rays, for interpolation on the GPU. Values are per unit
// solar irradiance. Along a ray they are relative to the fraction of light that the layer removes,
//
//   L(d) = (1 - T'(d)) [sum of u_k(nu) B_k] + (1 - T(d)) [G + K]
//   T = exp(-tau(d)), of the layer alone,   T' = exp(-s tau(d)), without its forward peak
//
// The sum is sunlight scattered once (layer_beam.h). Its phase function p_eff depends on the optical
// depth x of the peak, and is interpolated between four depths x_k: u_k = (1 - f) p_eff(nu, x_k), and B_k is
// the light times Lagrange's polynomial k of e^(-x / X), which suits functions that are sums of
// e^(-x a) with a in [0, 1]. G is the glow of the sun in the layer; K is the light of the sky.
//
// Tables are over the sine of the ray's elevation, its azimuth from the sun and
// (1 - T(d)) / (1 - T(end)), or the same of T', where the ray ends at the bare planet or in space. B_k
// and G are for open ground: terrain does not shade them.
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "lut/camera_tables/eye_under_light.h"
#include "lut/multiple_scattering/solved_air.h"
#include "renderer/illumination/lighting.h"
#include "renderer/media/exponential_layer.h"

namespace alpenglow::renderer {

/// Resolution of a map. Its mean difference from MediaLight is 0.2 % by day and 0.5 % with the sun
/// on the horizon, where light in the layer decreases by a factor e every few metres (99 %: 2 % and 5 %;
/// kFineLayerMap: half of all these). The computation time is proportional to elevations times azimuths.
struct LayerMapSize {
  int elevations = 64;  // even: half of them above the horizon
  int azimuths = 32;    // from 0 to pi
  int depths = 12;

  bool operator==(const LayerMapSize&) const = default;
};
inline constexpr LayerMapSize kCoarseLayerMap{24, 24, 8};
inline constexpr LayerMapSize kFineLayerMap{96, 48, 16};

/// Table of the light in a layer. It is immutable and needs no GPU.
struct LayerMap {
  EyeUnderLight eye;
  LayerMapSize size;
  /// B_0 to B_3, G and K in this order: [((quantity * depths + depth) * azimuths + azimuth) * elevations
  /// + elevation].
  static constexpr int kQuantities = 6;
  std::vector<glm::vec4> light;
  /// Irradiance of the layer's own light on level ground, and the additional irradiance on a vertical
  /// surface, at altitudes with an optical depth above of (i / last)^4 of the layer's: [row *
  /// kHeights + i]. W/m^2 per W/m^2.
  static constexpr int kHeights = 64;
  std::vector<glm::vec4> on_surface;
  /// u_k [1/sr] of the scattering angles pi (i / last)^2.
  static constexpr int kAngles = 512;
  std::vector<glm::vec4> phase;
  double extinction_per_m, scale_height_m, base_m, top_m, radius_m;
  double depth;       // vertical optical depth of the layer
  double peak_scale;  // s, the factor on optical depths that excludes the forward peak
};

/// @param air  medium of at most four bands.
/// tests/viewer/media/layer_map_test.cpp bounds the errors of rays against MediaLight.
[[nodiscard]] LayerMap MakeLayerMap(const ExponentialLayer& layer, const SolvedAir& air,
                                    const EyeUnderLight& eye, const LayerMapSize& size = {});

/// Returns whether the map of one eye and light is valid for others, to a few per cent: the eye is
/// within a tenth of the layer's scale height, at most 100 m, and the sun within a tenth of a degree.
/// Quantities that vary faster, transmittance and the phase function towards the sun, are not in
/// the map.
[[nodiscard]] bool Serves(const EyeUnderLight& made, const EyeUnderLight& wanted,
                          double scale_height_m);

}  // namespace alpenglow::renderer
