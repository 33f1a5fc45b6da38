// SPDX-License-Identifier: MIT
// Sun, moon and their light in the sky of a picture: a list of the sun, the moon, or both.
//
// In a solar eclipse the sunlight is what the moon leaves uncovered as seen from the eye, for the
// whole picture. The first light casts the shadows: the sun until it has set for all land, at 3.5
// degrees below the horizontal, then the moon if it is bright enough. The shadows of the second
// light are omitted: while the sun is first, the moon's beams bring less than 0.4 % of the sun's
// light on level ground, and afterwards land intercepts none of the sun's.
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/sky_bodies.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/refraction/refracted_view.h"
#include "atmosphere/time_place/geodesy.h"
#include "atmosphere/time_place/time.h"
#include "lut/camera_tables/air_tables.h"
#include "renderer/illumination/lighting.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// The lights of the sky, at least one, in the frame east, north, up of the eye. The first casts the
/// shadows.
using LightsOfSky = std::vector<DistantLight>;

/// Distances of the farthest ground in view, as angles at the planet's centre [rad].
struct GroundReach {
  double land_rad;    // land of any height
  double planet_rad;  // the planet without land, at height 0
};

/// Returns whether no part of a light's disk is above the horizon of any ground in view.
[[nodiscard]] bool HasSetOnGround(const DistantLight& light, const GroundReach& reach);

/// Returns the light of a source, or null if it is not in the list.
[[nodiscard]] const DistantLight* OfSource(const LightsOfSky& lights, LightSource source);

/// A solved medium, with values of it that would take milliseconds in every frame.
struct AirOfSky {
  explicit AirOfSky(std::shared_ptr<const SolvedAir> solved)
      : air(std::move(solved)),
        colour(air->medium().wavelengths_nm),
        refracting(GentleAirOf(air->medium())) {}

  std::shared_ptr<const SolvedAir> air;
  BandColour colour;
  BendingAir refracting;
};

/// Returns the illuminance [lux] of a level surface by a light and the sky that it lights.
[[nodiscard]] double LevelIlluminance(const DistantLight& source, const AirOfSky& air,
                                      double altitude_m);

/// Sun, moon and their light, as one place sees them at one instant.
struct FrameSky {
  SkyBodies bodies;              // without refraction
  SunInSky sun;                  // apparent
  std::optional<MoonDisk> moon;  // apparent, before the sun in an eclipse; empty: there is none
  bool is_eclipse;               // whether the moon covers part of the sun
  LightsOfSky lights;
  double level_lux;  // illuminance of level ground at the eye by the lights and their skies
  double key_share;  // the part of it by the first light and its sky
};

/// Returns a bound of the share of the first light in the light of any direction of the sky (test:
/// LightsOfSky.ShareOfTheKeyLightInTheSkyIsBounded). It is largest near the light and near the horizon
/// below it.
[[nodiscard]] double MostShareOfKeyLight(const FrameSky& sky);

/// Computes the sky of an eye. A light is included if its contribution on a level surface at the
/// eye, in the band nearest to 555 nm, exceeds a ten-thousandth of the other's. Planets other than
/// the Earth have no moon and no eclipses; their only light is the sun.
[[nodiscard]] FrameSky FrameSkyAt(const Place& eye, const UtcTime& now, const AirOfSky& air);

/// Keeps the sky of the newest place, time and medium, so that it is computed once per frame.
class FrameSkyFollower {
 public:
  [[nodiscard]] const std::shared_ptr<const FrameSky>& At(
      const Place& eye, const UtcTime& now, const std::shared_ptr<const SolvedAir>& air);

 private:
  std::optional<AirOfSky> air_;
  std::shared_ptr<const FrameSky> sky_;
};

}  // namespace alpenglow::viewer
