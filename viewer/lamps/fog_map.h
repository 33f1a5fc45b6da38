// SPDX-License-Identifier: MIT
// Light of sun and sky in a scene's fog around one eye, ready for interpolation by a graphics card:
// FogLight (renderer/media/fog_light.h) summed along rays. Per unit solar irradiance.
//
// Along a ray light is kept over the share of light that the fog takes away,
//
//   L(d) = (1 - T(d)) [p A + p' B + G + K],    T = exp(-tau(d)), of the fog alone
//
// A of the sun itself with the fog's phase function p, B of what its forward peak takes along with
// the lobe p', G of the sun's glow in the fog, K of the sky. Tables are over the sine of the ray's
// elevation, its azimuth from the sun and (1 - T(d)) / (1 - T(end)), where the ray ends at the bare
// planet or in space. A, B and G are those of open ground: terrain does not shade them.
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "renderer/light/sunlit_air.h"
#include "renderer/media/local_media.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// How fine a map is. Off from MediaLight by 0.1 % in the mean by day and 0.5 % with the sun on the
/// horizon, where light in fog falls by e every few metres (99 %: 2 % and 5 %; fine: half of all).
/// The time to make one grows with elevations times azimuths.
struct FogMapSize {
  int elevations = 128;  // even: half of them over the horizon
  int azimuths = 16;     // from 0 to pi
  int depths = 12;

  bool operator==(const FogMapSize&) const = default;
};
inline constexpr FogMapSize kCoarseFog{48, 12, 8};
inline constexpr FogMapSize kFineFog{192, 24, 16};

/// Sun and eye, east, north and up at the eye, on the sphere of the air's medium.
struct FogView {
  double altitude_m = 0.0;
  glm::dvec3 to_sun{0.0, 0.0, 1.0};  // unit, to where it is seen
  glm::dvec3 to_sun_for_air{0.0, 0.0,
                            1.0};  // unit, to where it lights the sky from (SunForAir of sun.h)
  double sun_radius_rad = 0.0046;
};

/// Immutable once made; no graphics card needed.
struct FogMap {
  FogView view;
  FogMapSize size;
  /// A, B, G and K, one after another: [((quantity * depths + depth) * azimuths + azimuth) *
  /// elevations + elevation].
  std::vector<glm::vec4> light;
  /// What the fog's own light brings to level ground and what a surface that stands upright gets
  /// more, at altitudes whose optical depth above is (i / last)^4 of the layer's: [row * kHeights +
  /// i]. W/m^2 per W/m^2.
  static constexpr int kHeights = 64;
  std::vector<glm::vec4> on_surface;
  double extinction_per_m, scale_height_m, base_m, top_m, radius_m;
  double depth;       // of the layer, vertical
  double peak_scale;  // of optical depths, without what the forward peak takes along
  PhaseFunction phase;
  double broad_g;
};

/// @param fog  of LocalMedia; bottom_m: altitude of the ground under it.
/// @param air  of at most four bands.
/// Errors of rays against MediaLight: tests/viewer/lamps/fog_map_test.cpp.
[[nodiscard]] FogMap MakeFogMap(const LocalMedium& fog, double bottom_m, const SunlitAir& air,
                                const FogView& view, const FogMapSize& size = {});

}  // namespace alpenglow::viewer
