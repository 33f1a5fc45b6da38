// SPDX-License-Identifier: MIT
// This header describes the lighting of a scene at one time: the sun or a single light in its place
// (DistantLight), the visible moon, eclipses, the seasonal cover of the ground, and the night sky.
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/sky_bodies.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/medium/medium.h"
#include "atmosphere/ray/single_scattering.h"
#include "atmosphere/refraction/refracted_view.h"
#include "atmosphere/time_place/geodesy.h"
#include "atmosphere/time_place/time.h"
#include "lut/multiple_scattering/multiple_scattering.h"
#include "renderer/effects/effects.h"
#include "renderer/illumination/distant_light.h"
#include "renderer/illumination/night_light.h"
#include "renderer/illumination/terrain_irradiance.h"
#include "renderer/layer.h"
#include "renderer/surface/scene_geometry.h"
#include "renderer/surface/surface.h"

namespace alpenglow::renderer {

/// Returns the unit direction (east, north, up of the eye) to the moon during a solar eclipse. It
/// is lifted by the refraction of the sun's centre behind it, because the sun is drawn as a round
/// disk and the moon's disk must be round too.
[[nodiscard]] glm::dvec3 ToMoonBefore(const SunInSky& apparent_sun, const SkyBodies& bodies);

/// The sun partly covered by the moon at Lighting::moon.
struct EclipsedSun {
  EclipsedDisk disk;
  Spectrum whole;  // irradiance without the moon
};

/// Light in the air and on surfaces by one distant light, and what is visible beside it.
struct Lighting {
  DistantLight source;      // the sun, uncovered by the moon; after By(), any single light
  MountainSurface surface;  // with its seasonal cover
  double sea_s = 0.0;       // time of the waves, see SeaTime
  std::optional<MoonDisk> moon = std::nullopt;  // visible disk
  Spectrum moon_colour = {};                    // reflectance relative to that at 550 nm
  glm::dvec3 moon_turn{0.0};  // axis and angle [rad] of its motion while the shutter is open
  std::optional<EclipsedSun> eclipse = std::nullopt;  // `source` is then the uncovered part
  /// The moon, if its light may be visible beside the sun's.
  std::optional<DistantLight> moonlight = std::nullopt;
  /// The night sky, if it may be visible beside the sun; null: it is not visible.
  std::shared_ptr<const NightLight> night = nullptr;
  /// False: the sun is so far below the horizon that its light is invisible.
  bool shows = true;
  EffectSet effects = EffectSet::All();
  /// Light of sky and slopes on terrain; null: the ground receives the sky of a plain.
  std::shared_ptr<const TerrainIrradiance> on_terrain = nullptr;

  /// Returns the irradiance of the sun above the air without the moon in front of it.
  [[nodiscard]] const Spectrum& WholeSun() const {
    return eclipse ? eclipse->whole : source.irradiance;
  }
  /// Returns this lighting with the moon in front of the sun. Each band keeps the uncovered
  /// fraction, with limb darkening, but at least that of the corona, a millionth of the whole sun
  /// (Cox 2000, Allen's Astrophysical Quantities, 14.8: 0.6 to 1.5 over the solar cycle). In
  /// totality there is no other light: scattering from sunlit air outside the shadow is neglected.
  [[nodiscard]] Lighting EclipsedBy(const EclipsedDisk& disk,
                                    const std::vector<double>& wavelengths_nm) const;
  /// Returns sun and moon, each if it may be visible.
  [[nodiscard]] std::vector<DistantLight> Lights() const;
  /// Returns the same scene with a single light as its source.
  [[nodiscard]] Lighting By(const DistantLight& light) const;
};

/// Returns the lighting for the sun's position, with the seasonal cover of the ground at a place.
/// @param wetness  see MountainSurface.
[[nodiscard]] Lighting LightingOf(const SunInSky& sun, const UtcTime& instant, const Place& place,
                                  const Medium& medium, double wetness = 0.0);
/// Returns the lighting by any distant light.
[[nodiscard]] Lighting LightingOf(const DistantLight& light, const UtcTime& instant,
                                  const Place& place, const Medium& medium, double wetness = 0.0);

/// Returns the moon's reflectance at the phase of the disk, relative to that at 550 nm.
[[nodiscard]] Spectrum MoonColour(const MoonDisk& moon, const std::vector<double>& wavelengths_nm);

/// Returns the depression of the sun below an eye's horizontal [rad] at which it lights none of the
/// air visible to the eye. The last visible air is at the top of the atmosphere, beyond the eye's
/// horizon by the dip of the horizon seen from the top. The last sunlit air is at the top as well,
/// a further dip away. One degree is added for refraction.
[[nodiscard]] double DepressionOfDarkAir(double altitude_m, double radius_m,
                                         double atmosphere_height_m);

/// Returns moonlight at the place of the bodies.
/// @param disk  its direction is used.
/// @param sun  irradiance of the sun there.
[[nodiscard]] DistantLight MoonlightOf(const MoonDisk& disk, const SkyBodies& bodies,
                                       const Spectrum& colour, const Spectrum& sun);

}  // namespace alpenglow::renderer
