// SPDX-License-Identifier: MIT
// Apparent positions of land and of the bare planet under refraction
// (atmosphere/refraction/refracted_view.h), with the parameters of the block View. Without
// refraction, apparent and true positions are equal.
//
// Pixels, the air in front of them, media and shafts use apparent directions and true distances, as
// in the renderer. Ground is lit and coloured at its true position.

float LiftAt(float altitude_km, float distance_km) {
  return LandLift(EYE_ALTITUDE, altitude_km, distance_km, PLANET_RADIUS, BEND_TOP, BEND_USUAL,
                  bend_slopes.x, bend_slopes.y, bend_slopes.z, bend_falls.x, bend_falls.y,
                  bend_falls.z);
}

float RoughLiftAt(float altitude_km, float distance_km) {
  return RoughLandLift(EYE_ALTITUDE, altitude_km, distance_km, PLANET_RADIUS, BEND_TOP, BEND_USUAL,
                       bend_slopes.x, bend_slopes.y, bend_slopes.z, bend_falls.x, bend_falls.y,
                       bend_falls.z);
}

// Returns v rotated upwards by a small angle [rad] in its vertical plane; `level` is length(v.xy).
vec3 TurnedUp(vec3 v, float level, float angle) {
  float shrink = 0.5 * angle * angle;
  float nearer = level > 0.0 ? 1.0 - shrink - angle * v.z / level : 1.0;
  return vec3(nearer * v.xy, (1.0 - shrink) * v.z + angle * level);
}

// Returns the apparent position of land, at the same distance. Metres from the eye.
vec3 SeenAt(vec3 place) {
  if (BEND_USUAL == 0.0) return place;
  float distance_km = 1e-3 * length(place);
  float altitude =
      AltitudeAlongRay(EYE_ALTITUDE, 1e-3 * place.z / max(distance_km, 1e-6), distance_km, PLANET_RADIUS);
  return TurnedUp(place, length(place.xy), LiftAt(altitude, distance_km));
}

// Returns the true position of land that appears in a direction at a distance. Metres from the eye.
vec3 PlaceSeen(vec3 direction, float distance_m) {
  vec3 seen = distance_m * direction;
  if (BEND_USUAL == 0.0) return seen;
  float distance_km = 1e-3 * distance_m, level = length(direction.xy);
  float altitude = AltitudeAlongRay(EYE_ALTITUDE, direction.z, distance_km, PLANET_RADIUS);
  float rise = level * level * distance_km;
  // The true altitude is lower than the apparent one, which changes the lift slightly.
  float lower = altitude - rise * RoughLiftAt(altitude, distance_km);
  return TurnedUp(seen, distance_m * level, -LiftAt(lower, distance_km));
}

// Returns whether the bare planet is seen in a direction.
bool SeesPlanet(vec3 direction) {
  return GroundClearance(EYE_ALTITUDE, direction.z, LOOK_RADIUS) > 0.0;
}

// Returns the distance at which it is seen.
float PlanetDistance(vec3 direction) {
  return DistanceDownTo(EYE_ALTITUDE, min(direction.z, -1e-9), 0.0, LOOK_RADIUS);
}

// Returns the direction of the straight line to the planet's ground at a distance, in the vertical
// plane of `direction`. For ground behind the horizon it is the direction of the horizon.
vec3 DirectionToGround(vec3 direction, float distance_km) {
  if (LOOK_RADIUS == PLANET_RADIUS) return direction;
  float h = EYE_ALTITUDE, d = max(distance_km, 1e-6);
  float mu = -(h * (2.0 * PLANET_RADIUS + h) + d * d) / (2.0 * d * (PLANET_RADIUS + h));
  float level = sqrt(max((1.0 - mu) * (1.0 + mu), 0.0));
  return vec3(level / max(length(direction.xy), 1e-9) * direction.xy, mu);
}

// Returns the position of the planet's ground that is seen in a direction. Metres from the eye.
vec3 PlanetPlace(vec3 direction, float distance_km) {
  return 1e3 * distance_km * DirectionToGround(direction, distance_km);
}

// Returns the straight line under which the sky table holds the visible ground and the air before
// it.
vec3 StraightToPlanet(vec3 direction) {
  // Stay slightly in front of the horizon, so that rounding never yields a ray of the sky.
  float reach = 0.99 * HorizonDistance(EYE_ALTITUDE, PLANET_RADIUS);
  return DirectionToGround(direction, min(PlanetDistance(direction), reach));
}
