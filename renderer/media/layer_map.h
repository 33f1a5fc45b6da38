// SPDX-License-Identifier: MIT
// The light in a layer (LayerLight) summed along rays, for interpolation on the GPU. Values are per unit
// solar irradiance. Along a ray they are relative to the fraction of light that the layer removes,
//
//   L(d) = (1 - T(d)) [p A + p' B + G + K],    T = exp(-tau(d)), of the layer alone
//
// A is the light of the sun itself, scattered with the layer's phase function p; B is the light in
// its forward peak, scattered with the lobe p'; G is the glow of the sun in the layer; K is the light
// of the sky. Tables are over the sine of the ray's elevation, its azimuth from the sun and
// (1 - T(d)) / (1 - T(end)), where the ray ends at the bare planet or in space. A, B and G are for
// open ground: terrain does not shade them.
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "lut/camera_tables/eye_under_light.h"
#include "lut/multiple_scattering/solved_air.h"
#include "renderer/illumination/lighting.h"
#include "renderer/media/exponential_layer.h"

namespace alpenglow::renderer {

/// Resolution of a map. Its mean difference from MediaLight is 0.1 % by day and 0.5 % with the sun
/// on the horizon, where light in the layer decreases by a factor e every few metres (99 %: 2 % and 5 %;
/// kFineLayerMap: half of all these). The computation time is proportional to elevations times azimuths.
struct LayerMapSize {
  int elevations = 128;  // even: half of them above the horizon
  int azimuths = 16;     // from 0 to pi
  int depths = 12;

  bool operator==(const LayerMapSize&) const = default;
};
inline constexpr LayerMapSize kCoarseLayerMap{48, 12, 8};
inline constexpr LayerMapSize kFineLayerMap{192, 24, 16};

/// Table of the light in a layer. It is immutable and needs no GPU.
struct LayerMap {
  EyeUnderLight eye;
  LayerMapSize size;
  /// A, B, G and K in this order: [((quantity * depths + depth) * azimuths + azimuth) * elevations
  /// + elevation].
  std::vector<glm::vec4> light;
  /// Irradiance of the layer's own light on level ground, and the additional irradiance on a vertical
  /// surface, at altitudes with an optical depth above of (i / last)^4 of the layer's: [row *
  /// kHeights + i]. W/m^2 per W/m^2.
  static constexpr int kHeights = 64;
  std::vector<glm::vec4> on_surface;
  double extinction_per_m, scale_height_m, base_m, top_m, radius_m;
  double depth;       // vertical optical depth of the layer
  double peak_scale;  // factor on optical depths that excludes the forward peak
  PhaseFunction phase;
  double broad_g;
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
