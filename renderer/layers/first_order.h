// SPDX-License-Identifier: MIT
// Sunlight that is scattered once in a stack of layers, with the exact phase function and the
// forward peak of all orders (peak_series.h), along one line of sight.
//
//   I = integral of  w / (1 - w f) p_eff(nu, tau) e^(-tau / mu_s) e^(-t) dt
//
// The exponentials are those after delta-M. In each layer p_eff has 8 Gauss nodes, even in the light
// that they send.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "renderer/layer.h"
#include "renderer/layers/layer_stack.h"
#include "renderer/layers/line_of_sight.h"

namespace alpenglow::renderer {

/// A direction in which light travels.
struct LightWay {
  double mu;       // cosine to the vertical, > 0 upwards
  double azimuth;  // from that in which the sun's beam travels [rad]
};

/// Returns the azimuth of light that comes to an eye along a ray. The vertical is the z axis.
/// @param ray  direction from the eye. @param to_sun  likewise.
[[nodiscard]] double AzimuthFromBeam(const glm::dvec3& ray, const glm::dvec3& to_sun);

/// Returns the radiance per unit irradiance across the beam [1/sr].
/// @param mu_s  cosine of the sun's zenith angle, in (0, 1]. @param line  of way.mu, never 0.
[[nodiscard]] double SunScatteredOnce(const LayerStack& stack, double mu_s,
                                      const std::vector<LineSegment>& line, const LightWay& way);

}  // namespace alpenglow::renderer
