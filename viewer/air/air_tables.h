// SPDX-License-Identifier: MIT
// The air of one eye and one sun as tables that a graphics card interpolates: sky, light scattered
// into a ray up to any distance on it, and transmittance. Per unit solar irradiance [1/sr]; texels
// of four floats hold one value a band.
//
// What is stored changes little from texel to texel. Light of the sky is divided by a mix of phase
// functions with the shares that they have near the sun,
//
//   L(direction) = sky(direction) [p_R(nu) m_R + p_M(nu) m_M + m_0],
//
// nu the cosine of the angle to where the sun is seen, so that an aureole is as sharp as the phase function at the pixel; p_M has with it the glow of light that
// aerosol scatters more than once. Light on the way to a point is
// divided by 1 - T as well, T the transmittance on that way: a mean source, which hardly changes
// with distance,
//
//   S(direction, d) = single (1 - T) [p_R(nu) a_R + p_M(nu) a_M],
//   D(direction, d) = diffuse (1 - T),   T = exp(-d extinction)
//
// S is sunlight scattered once where the planet's own shadow lets it in, terrain left out; D all
// light scattered more than once. Axes: air_map.glsl.
//
// This header also reads the shared text air_map.glsl as C++.
#pragma once

#include <array>
#include <glm/vec4.hpp>
#include <vector>

#include "atmosphere/air/medium.h"
#include "atmosphere/ray/bent_view.h"
#include "atmosphere/ray/shell.h"
#include "atmosphere/ray/single_scattering.h"
#include "lut/diffuse/multiple_scattering.h"
#include "viewer/layer.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/dialect/shared_begin.h"
#include "viewer/air/air_map.glsl"
#include "atmosphere/dialect/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared

namespace alpenglow::viewer {

/// The axes of one eye's tables. Angles in radians, lengths in km.
struct AirMap {
  /// @param ceiling_m  that no land exceeds.
  AirMap(const Medium& medium, double altitude_m, double ceiling_m, double twilight_fall_);

  double altitude, ceiling, top, radius;
  double horizon_dip;         // of the horizon below the horizontal
  double sky_range;           // from the horizon up to the zenith or to the upper edge of the air
  double air_sky_range;       // up to the zenith or to where rays miss all land
  double ground_range;        // from the horizon down to the nadir
  double twilight_fall;       // of DiffuseGrid
  double twilight_reference;  // radius about where the light comes from
  double sky_crowding, ground_crowding;  // of distances
};

struct AirTablesSize {
  int sky_columns, sky_rows, sky_ground_rows;  // of the sky
  double sky_fineness;  // of the SkyView that it is read from: times the nodes of SkyViewSizeFor
  int columns, rows, ground_rows, distances;  // of ways to a point
  int extinction_rows, extinction_ground_rows, extinction_distances;
  int through_rows, through_ground_rows;  // of TransmittanceToSpace
  bool operator==(const AirTablesSize&) const = default;
};

/// How fine tables are. Each step is about twice as exact and takes about twice as long to make.
enum class AirQuality { kFirst, kLow, kMedium, kHigh };

/// From high up rows are longer, because the terminator crosses them, and ways through the air
/// below short. kFirst is for a first frame that must not wait. No side of a texture is a power of
/// two (gl_objects.h): qualities change while one flies.
[[nodiscard]] AirTablesSize AirTablesSizeOf(AirQuality quality, double altitude_m);

/// Texels of four floats, x fastest.
struct AirTexels {
  AirTexels(int width_, int height_, int depth_ = 1)
      : width(width_),
        height(height_),
        depth(depth_),
        texel(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
              static_cast<std::size_t>(depth)) {}

  int width, height, depth;
  std::vector<glm::vec4> texel;

  [[nodiscard]] glm::vec4& At(int x, int y, int z = 0) {
    return texel[static_cast<std::size_t>((z * height + y) * width + x)];
  }
  [[nodiscard]] const glm::vec4& At(int x, int y, int z = 0) const {
    return texel[static_cast<std::size_t>((z * height + y) * width + x)];
  }
};

/// Eye and sun that tables are for.
struct AirEye {
  double altitude_m = 0.0;  // below 0: as at 0
  double mu_s = 1.0;        // cosine of the zenith angle at the eye of the sun that lights the air
  double ceiling_m = 9000.0;       // no land is higher
  double lower_for_air_rad = 0.0;  // by how much that sun stands lower than where it is seen

  /// This cosine is of the sun where it is seen: aureoles are about it.
  [[nodiscard]] double zenith_angle_seen_rad() const;
};

/// Plain data; never changed once made.
struct AirTables {
  AirTablesSize size;
  AirEye eye;
  AirMap map;
  std::array<glm::vec4, 3> sky_mix;     // m_R, m_M, m_0
  std::array<glm::vec4, 2> single_mix;  // a_R, a_M
  /// Phase function of whole rays: MediumTables::phase with the glow about the sun (DiffuseLight::GlowFactor).
  AirTexels sky_phase;
  AirTexels sky;         // [azimuth, row]: rows above the horizon, then rows below it
  AirTexels to_space;    // [row]: transmittance of whole rays, to space or to the bare ground
  AirTexels extinction;  // [distance, row]: mean on the way [1/km]
  AirTexels single;      // [azimuth, row, distance]
  AirTexels diffuse;
};

/// Throws InputError for a medium of more bands than a texel has.
void RequireFourBands(const Medium& medium);

/// What depends on the medium alone.
struct MediumTables {
  /// Phase function of the aerosol, [node]: PhaseNode of phase.glsl, from forward to backward.
  AirTexels phase;
  /// On the map of transmittance_map.glsl, [zenith cosine, altitude]: transmittance of straight rays
  /// to space, by which air is lit, and over it what is left of the beam of a disk on ground and fog
  /// (BentBeam::Left).
  AirTexels to_sun;
};

/// @param beam  of the medium of `air`.
[[nodiscard]] MediumTables MakeMediumTables(const AirIntegrator<float>& air, const BentBeam& beam);

/// On the calling thread alone. `air`, `diffuse` and `medium` must be of one medium; neither is
/// kept. Throws InputError for a medium of more than four bands.
[[nodiscard]] AirTables MakeAirTables(const AirIntegrator<float>& air, const DiffuseLight& diffuse,
                                      const MediumTables& medium, const AirEye& eye,
                                      const AirTablesSize& size);

}  // namespace alpenglow::viewer
