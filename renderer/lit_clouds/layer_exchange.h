// SPDX-License-Identifier: MIT
// Diffuse light between layers of clouds and the ground, as means over the fields.
//
// Layer i reflects the fraction R of diffuse light from either side and transmits T of it. Of the
// beam of the sun, which may come from below, it scatters the flux F downwards and U upwards. With the
// interface i below layer i, the fluxes obey
//
//   d_i     = T d_(i+1) + R u_i + F              diffuse light downwards
//   u_(i+1) = R d_(i+1) + T u_i + U              diffuse light upwards
//   u_0     = A (d_0 + s) + G                    on ground of albedo A below direct light s, with lamps
//   d_top   = E + S u_top                        below air that reflects S of diffuse light
//
// and u_i = A_i d_i + B_i leads from the ground to the top (adding method: van de Hulst 1980,
// Multiple Light Scattering, chapter 4).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace alpenglow::renderer {

/// Mean fluxes of a layer: of the beam that reaches it, and for unit flux from a uniform sky.
struct CloudLayerFluxes {
  double sun_up = 0.0;    // U
  double sun_down = 0.0;  // F
  double sky_up = 0.0;    // R
  double sky_down = 1.0;  // T
};

/// Light that enters from outside, as fluxes.
struct OuterFluxes {
  double sky = 0.0;               // E: diffuse light from above all layers, without S u_top
  double direct_on_ground = 0.0;  // s
  double reflection = 0.0;        // S, in [0, 1)
  double from_ground = 0.0;       // G: diffuse light that the ground emits
};

/// Diffuse fluxes at an interface.
struct InterfaceFluxes {
  double down = 0.0;
  double up = 0.0;
};

/// Returns the fluxes at the interfaces, from that above the ground to that above all layers.
/// @param layers  from the lowest to the highest. @param ground_albedo  in [0, 1].
[[nodiscard]] std::vector<InterfaceFluxes> FluxesBetween(std::span<const CloudLayerFluxes> layers,
                                                         const OuterFluxes& outer,
                                                         double ground_albedo);

}  // namespace alpenglow::renderer
