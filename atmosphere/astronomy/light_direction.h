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
// SunPosition (sun.h) and MoonPosition (moon.h) are what an ephemeris finds, as angles, with
// distances; DirectionOf turns them into vectors, which light everything.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

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

}  // namespace alpenglow::atmosphere
