// SPDX-License-Identifier: MIT
// Provides tables of the sky's light: LevelSky, the irradiance on level ground, and GlossMirror,
// the sky as mirrored by waves and by glossy land between mountains.
//
// GlossMirror tabulates what GroundLight::Mirrored sums ray by ray. The sky and the slopes below
// the horizon are summed apart:
//
//   sum of w_k ((1 - g_k) S_k + g_k G)  =  A(h) + B(h) G
//
// w_k is the weight of a mirrored ray, S_k the sky in its direction, and g_k the part of its
// directions that lies below a horizon whose elevation has the sine h. G is the radiance of the
// slopes there, which varies little from ray to ray. The arguments of A are the elevation of the
// mirrored direction, its azimuth from that of the sun, the horizon, and the altitude, which is
// interpolated between two. The rays of waves are those of a level surface. The weights of land add
// up to 1.
//
// Rows are equidistant in the square root of the sine of the elevation, and therefore dense for
// grazing views along the water. Columns are equidistant in the sine of half the azimuth from that
// of the sun, and therefore dense in its glare. Values are relative to LevelSky at altitude
// 0 under the same sun. At places with another elevation of the sun the sky has the same
// distribution, scaled with the irradiance on level ground there.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "lut/multiple_scattering/multiple_scattering.h"
#include "renderer/illumination/occluded_sky.h"
#include "renderer/layer.h"
#include "renderer/material/reflectance.h"

namespace alpenglow::renderer {

/// One value per band; unused components are 0.
using BandTexel = std::array<float, 4>;

/// Irradiance of the sky on level ground at altitude 0, per unit solar irradiance, at equal steps
/// of the sun's elevation. Below the lowest elevation it has the value of the lowest.
struct LevelSky {
  static constexpr std::size_t kNodes = 1024;
  static constexpr double kLowest_rad = -0.35, kRange_rad = 1.93;

  /// Returns the table. The relative error between nodes is below 2e-3.
  [[nodiscard]] static std::vector<BandTexel> Of(const MultipleScattering& multiple_scattering);
  /// Returns the exact value.
  [[nodiscard]] static Spectrum Under(const MultipleScattering& multiple_scattering,
                                      double sun_elevation_rad);
};

/// The light that a glossy surface mirrors, relative to LevelSky, in layers of kSide x kSide
/// texels.
struct GlossMirror {
  static constexpr std::size_t kSide = 48;
  static constexpr std::size_t kHorizons = 24, kAltitudes = 2;
  /// Layers A of all horizons at the lower altitude, those at the higher one, and one layer B,
  /// whose rows are those of A and whose columns are horizons. B is in the first band.
  static constexpr std::size_t kLayers = kAltitudes * kHorizons + 1;

  std::vector<BandTexel> waves;          // kLayers; empty: there is no water
  std::vector<BandTexel> land;           // likewise for Blinn-Phong land
  double lower_m = 0.0, higher_m = 0.0;  // the two altitudes

  /// Returns the sine of a horizon's elevation at a fraction of the layers, in [0, 1].
  [[nodiscard]] static double HorizonAt(double share);

  /// The surfaces to tabulate; null: none of this kind.
  struct Surfaces {
    const Water* water = nullptr;
    const Glossy* land = nullptr;
  };
  /// @param sky  sky of the same sun over these altitudes.
  [[nodiscard]] static GlossMirror Of(const OccludedSkyIrradiance& sky,
                                      const MultipleScattering& multiple_scattering,
                                      const Surfaces& surfaces, const glm::dvec3& to_light,
                                      double lower_altitude_m, double higher_altitude_m);
};

}  // namespace alpenglow::renderer
