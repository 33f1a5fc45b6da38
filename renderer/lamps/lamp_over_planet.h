// SPDX-License-Identifier: MIT
// This header integrates the light that the air scatters from a distant lamp to a point, over a
// spherical planet. Airlight (atmosphere/lamp/airlight.h) has air over a plane; tens of kilometres
// from a lamp, the planet's curvature lowers the ground, and its shadow rises into the air.
//
// Altitudes are exact at the nodes of a ray and at the ends of pieces of at most 25 km between the
// lamp and a node. Columns between them are those of an altitude that is linear there, which is too
// high by up to 12 m.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "atmosphere/lamp/lamp.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// An isotropic lamp of intensity 1, and a point in its light.
struct LampOverPlanet {
  const std::vector<LampLayer>& layers;
  double planet_radius_m = 0.0;
  double ground_altitude_m = 0.0;  // where rays and the light of the lamp end; below the point
  double point_altitude_m = 0.0;
  glm::dvec3 to_lamp_m{0.0};  // from the point; z is its vertical
};

/// Returns the radiance that arrives at the point from a direction [sr^-1 m^-2], in every band.
/// @param direction  unit.
[[nodiscard]] SpectrumOf<double> AirlightOverPlanet(const LampOverPlanet& at,
                                                    const glm::dvec3& direction);

}  // namespace alpenglow::renderer
