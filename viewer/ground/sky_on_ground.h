// SPDX-License-Identifier: MIT
// The sky that waves show, as a table: what Water::Mirrored sums ray by ray, over the zenith cosine
// of the eye and its azimuth from the sun's.
//
// Nodes run evenly in sqrt(mu_eye), dense where the eye looks along the water, and in the sine of
// half the azimuth from the direction to the eye that faces the sun, dense in its glare. Values are
// over LevelSky at altitude 0 under the same sun: places with another sun have the same sky, as
// bright as a level there is lit.
//
// The light of the open sky on slopes, for the sun of one moment, as a small table.
//
//   E(n) = integral of L(w) max(n.w, 0)   over the directions w above the horizontal
//
// It takes 3 ms on one thread, so that the light of land follows a sun that jumps: vertices keep the share of
// the open sky's light that terrain leaves them. Relief finer than the mesh changes the light in the ratio
// of two slopes under the open sky, too: over rough mountains that is wrong by below 2.1 % rms for
// MountainSurface's relief, which changes the light by 3.0 to 3.8 %.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "atmosphere/dialect/shared_math.h"
#include "renderer/ground/band_light.h"
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

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/dialect/shared_begin.h"
#include "viewer/ground/sky_tilt.glsl"
#include "atmosphere/dialect/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared

namespace alpenglow::viewer {

struct SkyTilt {
  static constexpr std::size_t kColumns = 9, kRows = 5;
  /// Irradiance per unit solar irradiance [1] in four bands, row by row; linear between nodes. Those of no
  /// slope, beyond n_sunward^2 + n_up^2 = 1, go on from those of slopes.
  std::array<std::array<float, 4>, kColumns * kRows> nodes{};

  /// @param air, diffuse  of one medium; mu_s: zenith cosine of the sun or moon.
  SkyTilt(const AirIntegrator<float>& air, const DiffuseLight& diffuse, double altitude_m,
          double mu_s);

  /// On a slope whose unit normal has these components upwards and towards the sun.
  [[nodiscard]] std::array<float, 4> On(double n_up, double n_sunward) const;
};

}  // namespace alpenglow::viewer
