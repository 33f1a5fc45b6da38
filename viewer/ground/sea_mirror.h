// SPDX-License-Identifier: MIT
// The sky that waves show, as a table: what Water::Mirrored sums ray by ray, over the zenith cosine
// of the eye and its azimuth from the sun's.
//
// Nodes run evenly in sqrt(mu_eye), dense where the eye looks along the water, and in the sine of
// half the azimuth from the direction to the eye that faces the sun, dense in its glare. Values are
// over LevelSky at altitude 0 under the same sun: places with another sun have the same sky, as
// bright as a level there is lit.
#pragma once

#include <array>
#include <vector>

#include "renderer/ground/reflectance.h"
#include "renderer/light/open_sky.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// One value a band, the rest 0.
using BandTexel = std::array<float, 4>;

/// Irradiance of the sky on a level at altitude 0, per unit solar irradiance, at even steps of the
/// sun's elevation. Darker suns are as the lowest.
struct LevelSky {
  static constexpr std::size_t kNodes = 1024;
  static constexpr double kLowest_rad = -0.35, kRange_rad = 1.93;

  /// Error of the value between nodes: below 2e-3 of it.
  [[nodiscard]] static std::vector<BandTexel> Of(const DiffuseLight& diffuse);
  /// The value itself.
  [[nodiscard]] static BandLight Under(const DiffuseLight& diffuse, double sun_elevation_rad);
};

/// Radiance [1/sr] over LevelSky, rows of equal mu_eye.
struct SeaMirror {
  static constexpr std::size_t kSide = 48;

  /// @param sky  over the same sun.
  [[nodiscard]] static std::vector<BandTexel> Of(const OpenSky& sky, const DiffuseLight& diffuse,
                                                 const Water& water, const glm::dvec3& to_sun);
};

}  // namespace alpenglow::viewer
