// SPDX-License-Identifier: MIT
// The direction of the sun or the moon in one frame. Refraction gives each of them two directions,
// because it bends rays less before they reach high air than before they reach the eye (LiftForAir
// of refraction.h):
//
//   seen     where the disk is visible: for the disk itself, the centre of its aureole, shadows, and
//            light on the ground
//   for_air  from where straight rays light the air like the refracted rays: for columns of air
//            between the light and the air, the planet's shadow in the air, and multiple scattering
//
// SunInSky (sun.h) and MoonPosition (moon.h) are what an ephemeris finds, as angles with
// distances; DirectionOf turns them into vectors, which light everything.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "atmosphere/math/angles.h"

namespace alpenglow::atmosphere {

struct LightDirection {
  glm::dvec3 seen;     // unit
  glm::dvec3 for_air;  // unit

  bool operator==(const LightDirection&) const = default;
};

/// Returns the direction of a light without refraction. @param to_light  unit.
[[nodiscard]] inline LightDirection Unrefracted(const glm::dvec3& to_light) {
  return {to_light, to_light};
}

/// Returns the direction in another frame.
[[nodiscard]] inline LightDirection operator*(const glm::dmat3& to_from,
                                              const LightDirection& direction) {
  return {to_from * direction.seen, to_from * direction.for_air};
}

/// Returns the unit vector that a number of further steps on the great circle from `before` to `now`
/// lead to.
[[nodiscard]] inline glm::dvec3 MovedOn(double steps, const glm::dvec3& before,
                                        const glm::dvec3& now) {
  const glm::dvec3 axis = glm::cross(before, now);
  const double sine = glm::length(axis);
  if (sine == 0.0) return now;
  const double turn = steps * AngleBetween(before, now);
  return glm::normalize(std::cos(turn) * now + std::sin(turn) / sine * glm::cross(axis, now));
}
[[nodiscard]] inline LightDirection MovedOn(double steps, const LightDirection& before,
                                            const LightDirection& now) {
  return {MovedOn(steps, before.seen, now.seen), MovedOn(steps, before.for_air, now.for_air)};
}

}  // namespace alpenglow::atmosphere
