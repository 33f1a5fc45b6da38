// SPDX-License-Identifier: MIT
// Provides the tables of a solved medium for one eye and one sun, which the GPU interpolates: the
// sky, light scattered into a ray up to any distance along it, and transmittance. Light is per unit
// solar irradiance [1/sr]. Texels of four floats hold one value per band.
//
// The stored quantities vary little between texels. Light of the sky is divided by a mix of phase
// functions with the fractions that they have near the sun,
//
//   L(direction) = sky(direction) [p_R(nu) m_R + p_M(nu) m_M + m_0],
//
// where nu is the cosine of the angle to the direction in which the sun is seen. An aureole is
// therefore as sharp as the phase function at the pixel. Here p_M includes the light that aerosol
// scatters more than once around the sun (MultipleScattering::GlowFactor), for the column of
// aerosol in the direction of the sun. For other columns the quotient varies, but slowly: where
// that light varies within a degree it is near the sun. Light scattered on the way to a point is
// also divided by 1 - T, where T is the transmittance along the way. The result is a mean source,
// which hardly changes with distance,
//
//   S(direction, d) = single (1 - T) [p_R(nu) a_R + p_M(nu) a_M],
//   D(direction, d) = diffuse (1 - T),   T = exp(-d extinction)
//
// S is sunlight outside of the planet's own shadow, without the shadows of terrain: scattered once,
// and with what is added around the sun. Where the latter would take more than half of the former,
// away from the sun, the rest belongs to D. D is all other light scattered more than once. If
// the sun has set in view (HasSetInView), D is all light, since no aureole and no shadow need S apart.
// Shaders then read one table less.
// air_map.glsl defines the axes.
//
// This header also reads the shared text air_map.glsl as C++.
#pragma once

#include <array>
#include <bit>
#include <glm/vec4.hpp>
#include <memory>
#include <vector>

#include "atmosphere/medium/medium.h"
#include "atmosphere/ray/shell.h"
#include "lut/camera_tables/eye_under_light.h"
#include "lut/layer.h"
#include "lut/multiple_scattering/solved_air.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/shared_glsl/shared_begin.h"
#include "lut/camera_tables/air_map.glsl"
#include "atmosphere/shared_glsl/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared

namespace alpenglow::lut {

/// Axes of the tables of one eye. Angles are in radians, lengths in km.
struct AirMap {
  AirMap(const Medium& medium, double altitude_m, double twilight_fall_);

  double altitude, top, radius;
  double ceiling = 9.0;       // upper bound of the height of land
  double horizon_dip;         // angle of the horizon below the horizontal
  double sky_range;           // from the horizon up to the zenith or to the upper edge of the air
  double air_sky_range;       // up to the zenith or to where rays miss all land
  double ground_range;        // from the horizon down to the nadir
  double twilight_fall;       // twilight_fall of MomentGrid
  double twilight_reference;  // approximate radius at which the light is scattered
  double sky_crowding, ground_crowding;  // crowding of the distances
};

struct AirTablesSize {
  int sky_columns, sky_rows, sky_ground_rows;  // size of the table sky
  double sky_fineness;  // node counts of its SkyView, relative to SkyViewSizeFor
  int columns, rows, ground_rows, distances;  // size of the tables single and diffuse
  int extinction_rows, extinction_ground_rows, extinction_distances;
  int through_rows, through_ground_rows;  // size of the table to_space
  bool operator==(const AirTablesSize&) const = default;
};

/// Returns `side`, or one more if it is a power of two greater than 1. Mesa's software driver
/// recompiles a program when a side of a texture that it reads becomes a power of two or ceases to
/// be one. Such frames took 0.3 to 0.9 s, measured with its shader cache disabled.
/// @param side  > 0.
[[nodiscard]] constexpr int OffPowersOfTwo(int side) {
  return side > 1 && std::has_single_bit(static_cast<unsigned>(side)) ? side + 1 : side;
}

/// Resolution of tables. Each step halves the error approximately and doubles the computation time.
enum class AirQuality { kFirst, kLow, kMedium, kHigh };

/// Returns the size of the tables. For a high eye there are more columns, because the terminator
/// crosses the rows, and fewer distances, because paths through the air below are short. kFirst is
/// for a first frame that must not wait. No side of a texture is a power of two (OffPowersOfTwo),
/// because the quality changes during a flight.
[[nodiscard]] AirTablesSize AirTablesSizeOf(AirQuality quality, double altitude_m);

/// A table of texels of four floats, x fastest.
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

/// Returns whether the sun has set so far that neither its aureole nor shadows of terrain in the air are
/// seen: it is seen lower than -3.2 degrees (SunShadowMapOf has shadows down to -3), and at the eye's
/// horizon its beams pass higher than three scale heights of the aerosol.
[[nodiscard]] bool HasSetInView(const Medium& medium, const AirMap& map, const EyeUnderLight& eye);

/// Tables for one eye and one light. They are plain data and never modified after their construction.
struct AirTables {
  AirTablesSize size;
  EyeUnderLight eye;
  AirMap map;
  bool has_set;                         // HasSetInView
  std::array<glm::vec4, 3> sky_mix;     // m_R, m_M, m_0
  std::array<glm::vec4, 2> single_mix;  // a_R, a_M
  /// Extinction at altitude 0 and below [1/km]: a ray that goes on below altitude 0 is lit as at
  /// its crossing, and one from an eye at or below altitude 0 as the horizontal ray.
  glm::vec4 extinction_below;
  /// Phase function by which the light is divided: MediumTables::phase with the light around the
  /// sun (MultipleScattering::GlowFactor), and at least a tenth of it.
  AirTexels phase;
  AirTexels sky;         // [azimuth, row]: rows above the horizon, then rows below it
  AirTexels to_space;    // [row]: transmittance of whole rays, to space or to the bare ground
  AirTexels extinction;  // [distance, row]: mean along the path [1/km]
  AirTexels single;      // [azimuth, row, distance]; 0 if has_set
  AirTexels multiple_scattering;
};

/// Throws InputError if the medium has more bands than a texel.
void RequireFourBands(const Medium& medium);

/// Tables that depend on the medium alone.
struct MediumTables {
  /// Phase function of the aerosol, [node]: PhaseNode of phase.glsl, from forward to backward.
  AirTexels phase;
  /// On the map of table_maps.glsl, [zenith cosine, altitude]: the first half of the rows
  /// holds the transmittance of straight rays to space, by which air is illuminated. The second
  /// half holds the transmitted fraction of the beam of a disk on ground and media
  /// (RefractedBeam::Left).
  AirTexels to_sun;
};

/// Throws InputError for a medium of more than four bands.
[[nodiscard]] MediumTables MakeMediumTables(const SolvedAir& air);

/// Computes the tables on the calling thread alone. `air` and `medium` must belong to one medium;
/// no reference to them is kept. Throws InputError for a medium of more than four bands.
[[nodiscard]] AirTables MakeAirTables(const SolvedAir& air, const MediumTables& medium,
                                      const EyeUnderLight& eye, const AirTablesSize& size);

/// A solved medium with its tables for the GPU. It is immutable and can be shared between threads.
struct TabulatedAir {
  SolvedAir air;
  MediumTables tables;
};

/// Solves the medium on the calling thread alone, so that drawing keeps the other processors.
/// Throws InputError for a medium that Validate rejects or that has more than four bands.
[[nodiscard]] std::shared_ptr<const TabulatedAir> TabulateAir(
    const Medium& medium, AirSolution solution = AirSolution::kFull);

}  // namespace alpenglow::lut
