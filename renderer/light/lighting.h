// SPDX-License-Identifier: MIT
// Air of one medium as ground, fog and volumes in it are lit through it.
//
// Where the moon is drawn while it stands before the sun.
//
// The sun over a scene at one time: where it stands, what it sends above the air, what of its disk
// a point sees over the planet's horizon, and what the season makes of the ground; by night what
// else shines. All lights so far away that they are a direction have one form (DistantLight), by
// which tables, terrain and fog serve each of them: radiance of air lit from a direction is linear
// in the irradiance.
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "atmosphere/air/medium.h"
#include "atmosphere/ray/bent_view.h"
#include "atmosphere/ray/single_scattering.h"
#include "atmosphere/sun/eclipse.h"
#include "atmosphere/sun/geodesy.h"
#include "atmosphere/sun/moon.h"
#include "atmosphere/sun/sun.h"
#include "atmosphere/sun/time.h"
#include "lut/diffuse/multiple_scattering.h"
#include "renderer/effect/effects.h"
#include "renderer/ground/band_light.h"
#include "renderer/ground/scene_geometry.h"
#include "renderer/ground/surface.h"
#include "renderer/layer.h"
#include "renderer/light/night_light.h"
#include "renderer/light/terrain_light.h"

namespace alpenglow::renderer {

/// Refers to all three.
struct SunlitAir {
  const AirIntegrator<float>& air;
  const BentBeam& beam;         // of sun and moon themselves
  const DiffuseLight& diffuse;  // of the sky

  /// Returns the irradiance across the beams of a disk whose irradiance above the air is 1. @param mu  see BentBeam::Left.
  [[nodiscard]] Bands<float> BeamLeft(double altitude_m, double mu) const {
    return beam.Left(air, altitude_m, mu);
  }
};

/// Unit, east, north and up of the eye: towards the moon, lifted as refraction lifts the middle of the
/// sun behind it, for what hides part of a round sun is round.
[[nodiscard]] glm::dvec3 ToMoonBefore(const SunPosition& apparent_sun, const GeodeticPosition& eye,
                                      const UtcInstant& instant);

/// A light so far away that it shines everywhere from one direction, and lights the air from another
/// where refraction lifts it (SunForAir of sun.h).
struct DistantLight {
  glm::dvec3 to_light;          // unit, to the middle of its disk as it is seen
  glm::dvec3 to_light_for_air;  // unit
  double radius_rad;            // of the disk
  BandLight irradiance;         // above the air, W m^-2 nm^-1
};

/// The sun with the moon before it, which stands where Lighting::moon says.
struct EclipsedSun {
  EclipsedDisk disk;
  BandLight whole;  // irradiance as if there were no moon
};

/// Light in the air and on surfaces for one position of the sun.
struct Lighting {
  glm::dvec3 to_sun;          // unit, to where it is seen
  glm::dvec3 to_sun_for_air;  // unit, to where its straight rays light the air from
  double sun_radius_rad;
  BandLight irradiance;                         // of the sun above the air, W m^-2 nm^-1
  MountainSurface surface;                      // as the season covers it
  double sea_s = 0.0;                           // time of the waves, see SeaTime
  std::optional<MoonDisk> moon = std::nullopt;  // as a thing to see
  BandLight moon_colour = {};                   // of its reflectance, relative to that at 550 nm
  glm::dvec3 moon_turn{0.0};  // axis and angle [rad] by which it moves while the shutter is open
  std::optional<EclipsedSun> eclipse = std::nullopt;  // `irradiance` is of what is left then
  /// The moon where it could show beside the sun.
  std::optional<DistantLight> moonlight = std::nullopt;
  /// The sky of the night where it could show beside the sun; null: it could not.
  std::shared_ptr<const NightLight> night = nullptr;
  /// False: the sun stands so deep under the horizon that nobody could tell it from none.
  bool shows = true;
  EffectSet effects = EffectSet::All();
  /// Of sky and slopes on terrain; null: the ground sees the sky of a plain.
  std::shared_ptr<const TerrainLight> on_terrain = nullptr;

  /// Of the sun above the air without the moon before it.
  [[nodiscard]] const BandLight& WholeSun() const { return eclipse ? eclipse->whole : irradiance; }
  /// The same with the moon before the sun: what is left of each band with the limb's darkening, but
  /// never less than the corona's, a millionth of the whole sun (Cox 2000, Allen's Astrophysical
  /// Quantities, 14.8: 0.6 to 1.5 in the sun's cycle). That is all the light there is inside of
  /// totality: what the air outside of the shadow sends in is left out.
  [[nodiscard]] Lighting EclipsedBy(const EclipsedDisk& disk,
                                    const std::vector<double>& wavelengths_nm) const;
  [[nodiscard]] DistantLight Sun() const {
    return {to_sun, to_sun_for_air, sun_radius_rad, irradiance};
  }
  /// Of sun and moon those that could show.
  [[nodiscard]] std::vector<DistantLight> Lights() const;
  /// The same scene with one light alone, as if that were the sun.
  [[nodiscard]] Lighting By(const DistantLight& light) const;
};

/// The sun as it stands, the ground as the season covers it at that place.
/// @param wetness  see MountainSurface.
[[nodiscard]] Lighting LightingOf(const SunPosition& sun, const UtcInstant& instant,
                                  const GeodeticPosition& place, const Medium& medium,
                                  double wetness = 0.0);

/// Of the moon's reflectance at the phase that the disk has, relative to that at 550 nm.
[[nodiscard]] BandLight MoonColour(const MoonDisk& moon, const std::vector<double>& wavelengths_nm);

/// How far under the horizontal of an eye the sun stands [rad] where of all the air that one sees
/// from there none is lit by it: the last of it that shows over the planet is at the top, beyond the
/// eye's horizon by as much as that is seen from the top, and the last that is lit is there, too.
/// By a degree more, for what refraction lifts.
[[nodiscard]] double DepressionOfDarkAir(double altitude_m, double radius_m,
                                         double atmosphere_height_m);

/// The moon as it stands over a place, as a light. @param disk  its direction counts.
/// @param sun  irradiance of the sun there. @param earth_sun_au  distance of the place from it.
[[nodiscard]] DistantLight MoonlightOf(const MoonDisk& disk, const GeodeticPosition& place,
                                       const UtcInstant& instant, double earth_sun_au,
                                       const BandLight& colour, const BandLight& sun);

/// The sun over a point, terrain aside.
struct LocalSun {
  double altitude_m;
  glm::dvec3 up;
  double mu_s_for_air;      // of DistantLight::to_light_for_air: for the light of the sky
  double visible_fraction;  // of the disk over the planet's horizon
  double mu_s_effective;    // of that part
};

[[nodiscard]] LocalSun LocalSunAt(const SceneGeometry& geometry, const glm::dvec3& point,
                                  const DistantLight& sun);

}  // namespace alpenglow::renderer
