// SPDX-License-Identifier: MIT
#include "renderer/picture/scene_lighting.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <optional>

#include "atmosphere/astronomy/ephemeris.h"
#include "atmosphere/math/constants.h"
#include "renderer/illumination/night_light.h"

namespace alpenglow::renderer {
namespace {

// A light below this fraction of the light already present is invisible.
constexpr double kUnseenShare = 1e-4;
// Illuminance of the moonless night sky.
constexpr double kNightSky_lux = 1e-3;

/// Returns the rotation of the moon while the shutter is open: westwards with the stars, less its
/// own motion among them of 13.18 degrees a day (Meeus 1998, Astronomical Algorithms, chapter 47),
/// here taken along the equator.
glm::dvec3 MoonTurn(double open_s, double latitude_rad, const FrameTransform& from_eye) {
  constexpr double kBack_rad_per_s = 13.17640 / kSecondsPerDay * kRadiansPerDegree;
  const glm::dvec3 pole = from_eye.Along({0.0, std::cos(latitude_rad), std::sin(latitude_rad)});
  return -(kEarthRotation_rad_per_s - kBack_rad_per_s) * open_s * pole;
}

/// Adds the night sky and moonlight to `light` if the sun is dim enough.
void AddNight(const PreparedScene& scene, const Observer& observer, Lighting& light) {
  const Medium& medium = scene.medium();
  const SceneGeometry& geometry = scene.geometry();
  const glm::dvec3& eye = observer.from_eye.origin_m();
  light.moon_colour = MoonColour(*light.moon, medium.wavelengths_nm);
  const double sun_lux = Illuminance(scene, eye, light);
  if (sun_lux > kDaylight_lux) return;
  const DistantLight moonlight =
      MoonlightOf(*light.moon, observer.bodies, light.moon_colour, light.WholeSun());
  const double moon_lux = IlluminanceBy(scene, moonlight, eye, light);
  if (moon_lux > kUnseenShare * (sun_lux + kNightSky_lux)) light.moonlight = moonlight;
  const double depression_rad =
      -std::asin(glm::dot(light.source.direction.for_air, geometry.UpAt(eye)));
  light.shows = sun_lux > kUnseenShare * (moon_lux + kNightSky_lux) ||
                depression_rad < DepressionOfDarkAir(geometry.AltitudeOf(eye), geometry.radius_m(),
                                                     medium.atmosphere_height_m);
  const std::optional<Spectrum>& towns = scene.towns();
  const double towns_lux = towns ? kPi * scene.colour().Xyz(*towns)[1] : 0.0;  // upper bound
  if (kNightSky_lux + towns_lux < kUnseenShare * sun_lux) return;
  light.night = std::make_shared<NightLight>(
      NightSky(observer.bodies.place, observer.bodies.instant).InFrame(observer.from_eye.axes()),
      scene.air().whole().air.single_scattering(), scene.colour(), geometry.UpAt(eye),
      geometry.AltitudeOf(eye), towns);
}

}  // namespace

Observer ObserverOf(const PreparedScene& scene, const CameraSample& camera_sample) {
  const SceneGround& ground = scene.ground();
  const Place& place = scene.scene().place;
  const auto pose = camera_sample.middle();
  const FrameTransform from_eye = pose ? FromEyeAt(ground, pose->place) : FromSceneEye(ground);
  if (camera_sample.bodies) return {from_eye, *camera_sample.bodies};
  const Place eye =
      pose ? pose->place : Place{place.latitude_deg, place.longitude_deg, ground.eye_height_m};
  return {from_eye, SkyBodiesAt(eye, camera_sample.instant)};
}

double IlluminanceBy(const PreparedScene& scene, const DistantLight& source, const glm::dvec3& eye,
                     const Lighting& light) {
  const AirOverGround& over_ground = scene.air().whole();
  const LocalLight sun = over_ground.ground_light.LocalLightAt(eye, light.By(source));
  const auto direct = static_cast<float>(sun.visible_fraction * std::max(sun.mu_s_effective, 0.0));
  const Spectrum irradiance =
      direct * over_ground.air.BeamLeft(sun.altitude_m, sun.mu_s_effective) +
      over_ground.air.multiple_scattering().SkyIrradiance(sun.altitude_m, sun.mu_s_for_air);
  return scene.colour().Xyz(source.irradiance * irradiance)[1];
}

double Illuminance(const PreparedScene& scene, const glm::dvec3& eye, const Lighting& light) {
  double lux = light.night ? scene.colour().Xyz(light.night->OnSurface(1.0))[1] : 0.0;
  for (const DistantLight& source : light.Lights()) lux += IlluminanceBy(scene, source, eye, light);
  return lux;
}

Lighting LightingAt(const PreparedScene& scene, const Observer& observer) {
  const Medium& medium = scene.medium();
  const BendingAir air = GentleAirOf(medium);
  const SkyBodies& bodies = observer.bodies;
  const glm::dmat3& frame_from_enu = observer.from_eye.axes();
  const SunInSky sun = bodies.ApparentSun(air);
  Lighting light =
      LightingOf(sun, bodies.instant, scene.scene().place, medium, scene.scene().ground.wetness);
  light.source.direction = frame_from_enu * light.source.direction;
  if (!medium.follows_wgs84) return light;  // other planets have other moons
  light.moon = bodies.ApparentMoonDisk(air);
  const EclipsedDisk disk = bodies.Eclipse();
  if (disk.IsCovered()) {
    light = light.EclipsedBy(disk, medium.wavelengths_nm);
    light.moon->direction.seen = ToMoonBefore(sun, bodies);
  }
  light.moon->direction = frame_from_enu * light.moon->direction;
  light.moon->to_sun = frame_from_enu * light.moon->to_sun;
  light.moon_turn =
      MoonTurn(scene.scene().camera.shutter_s, bodies.place.latitude_rad(), observer.from_eye);
  AddNight(scene, observer, light);
  return light;
}

}  // namespace alpenglow::renderer
