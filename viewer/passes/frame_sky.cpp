// SPDX-License-Identifier: MIT
#include "viewer/passes/frame_sky.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/math/constants.h"

namespace alpenglow::viewer {

namespace {

// Above this elevation the sun contributes more than a thousand times the brightest moon.
constexpr double kMoonDoesNotCount_rad = 1.0 * kRadiansPerDegree;
// Below this elevation the sun lights no land, and land shades no air: from the highest summit the
// horizon is 3.02 degrees down, and the sun's radius is 0.27 degrees.
constexpr double kSetOnLand_rad = -3.5 * kRadiansPerDegree;
// Largest share of a light in the light of a direction of the sky over its share on a level surface.
// It is largest near the light and near the horizon below it: a sky that contributes a ten-thousandth
// on a level surface contributes at most a 160th there.
constexpr double kMostOverLevelShare = 60.0;

std::size_t GreenBand(const std::vector<double>& wavelengths_nm) {
  const auto off = [](double nm) { return std::abs(nm - 555.0); };
  return static_cast<std::size_t>(
      std::min_element(wavelengths_nm.begin(), wavelengths_nm.end(),
                       [&](double a, double b) { return off(a) < off(b); }) -
      wavelengths_nm.begin());
}

// Returns the irradiance of a level surface by a light and the sky that it lights.
Spectrum LevelLight(const DistantLight& source, const AirOfSky& air, double altitude_m) {
  const double mu = source.direction.seen.z;
  Spectrum light =
      air.air->multiple_scattering().SkyIrradiance(altitude_m, source.direction.for_air.z);
  if (mu > 0.0) {
    light = light + static_cast<float>(mu) * air.air->BeamLeft(altitude_m, mu);
  }
  return light * source.irradiance;
}

// Returns the sunlight that the moon does not cover.
DistantLight BesideMoon(const DistantLight& sun, const SkyBodies& bodies, const Medium& medium) {
  const EclipsedDisk disk = bodies.Eclipse();
  if (!disk.IsCovered()) return sun;
  const Lighting whole = LightingOf(sun, bodies.instant, bodies.place, medium);
  return whole.EclipsedBy(disk, medium.wavelengths_nm).source;
}

// Returns the lights of a planet with a moon.
LightsOfSky LightsOf(const SkyBodies& bodies, const SunInSky& sun, const MoonDisk& moon,
                     const AirOfSky& air, double altitude_m) {
  constexpr double kUnseenShare = 1e-4;  // in the sky at most kMostOverLevelShare times as much
  const Medium& medium = air.air->medium();
  const DistantLight whole_sun = SunlightOf(sun, medium);
  const DistantLight by_sun = BesideMoon(whole_sun, bodies, medium);
  if (sun.elevation_rad() > kMoonDoesNotCount_rad) return {by_sun};
  const DistantLight by_moon =
      MoonlightOf(moon, bodies, MoonColour(moon, medium.wavelengths_nm), whole_sun.irradiance);
  const std::size_t green = GreenBand(medium.wavelengths_nm);
  const auto of_sun = double{LevelLight(by_sun, air, altitude_m)[green]};
  const auto of_moon = double{LevelLight(by_moon, air, altitude_m)[green]};
  if (of_moon <= kUnseenShare * of_sun) return {by_sun};
  if (of_sun <= kUnseenShare * of_moon) return {by_moon};
  if (sun.elevation_rad() < kSetOnLand_rad) return {by_moon, by_sun};
  return {by_sun, by_moon};
}

}  // namespace

double MostShareOfKeyLight(const FrameSky& sky) {
  return std::min(kMostOverLevelShare * sky.key_share, 1.0);
}

FrameSky FrameSkyAt(const Place& eye, const UtcTime& now, const AirOfSky& air) {
  const SkyBodies bodies = SkyBodiesAt(eye, now);
  FrameSky sky{bodies, bodies.ApparentSun(air.refracting), std::nullopt, false, {}, 0.0, 1.0};
  const double altitude_m = std::max(eye.height_m, 0.0);
  if (air.air->medium().follows_wgs84) {
    sky.moon = bodies.ApparentMoonDisk(air.refracting);
    sky.lights = LightsOf(bodies, sky.sun, *sky.moon, air, altitude_m);
    sky.is_eclipse = bodies.Eclipse().IsCovered();
    if (sky.is_eclipse) sky.moon->direction.seen = ToMoonBefore(sky.sun, bodies);
  } else {
    sky.lights = {SunlightOf(sky.sun, air.air->medium())};
  }
  for (const DistantLight& light : sky.lights)
    sky.level_lux += LevelIlluminance(light, air, altitude_m);
  if (sky.lights.size() > 1)
    sky.key_share = LevelIlluminance(sky.lights.front(), air, altitude_m) / sky.level_lux;
  return sky;
}

const std::shared_ptr<const FrameSky>& FrameSkyFollower::At(
    const Place& eye, const UtcTime& now, const std::shared_ptr<const SolvedAir>& air) {
  const bool is_same_air = air_ && air_->air == air;
  if (is_same_air && sky_->bodies.place == eye && sky_->bodies.instant == now) return sky_;
  std::optional<AirOfSky> next;  // kept only with its sky, in case an error leaves this function
  if (!is_same_air) next.emplace(air);
  sky_ = std::make_shared<const FrameSky>(FrameSkyAt(eye, now, next ? *next : *air_));
  if (next) air_ = std::move(next);
  return sky_;
}

// Towards the light, ground sees it higher by the angle between the ground and the eye.
bool HasSetOnGround(const DistantLight& light, const GroundReach& reach) {
  const double elevation_rad = std::asin(std::clamp(light.direction.seen.z, -1.0, 1.0));
  return elevation_rad < kSetOnLand_rad - reach.land_rad &&
         elevation_rad < -light.radius_rad - reach.planet_rad;
}

const DistantLight* OfSource(const LightsOfSky& lights, LightSource source) {
  for (const DistantLight& light : lights)
    if (light.body == source) return &light;
  return nullptr;
}

double LevelIlluminance(const DistantLight& source, const AirOfSky& air, double altitude_m) {
  return air.colour.Xyz(LevelLight(source, air, altitude_m))[1];
}

}  // namespace alpenglow::viewer
