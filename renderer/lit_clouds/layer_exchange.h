// SPDX-License-Identifier: MIT
// Diffuse light between layers of clouds and the ground, as means over the fields.
//
// Layer i reflects the fraction R of diffuse light from either side and transmits T of it. It
// transmits D of the sun's flux without scattering, F as diffuse light downwards, and U upwards. With
// the interface i below layer i, the fluxes obey
//
//   s_i     = D s_(i+1)                                  direct light
//   d_i     = T d_(i+1) + R u_i + F s_(i+1)              diffuse light downwards
//   u_(i+1) = R d_(i+1) + T u_i + U s_(i+1)              diffuse light upwards
//   u_0     = A (d_0 + s_0)                              on ground of albedo A
//
// and u_i = A_i d_i + B_i leads from the ground to the top (adding method: van de Hulst 1980,
// Multiple Light Scattering, chapter 4).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace alpenglow::renderer {

/// Mean fluxes of a layer for unit flux from the light, or from a uniform sky, through its top.
struct CloudLayerFluxes {
  double sun_up = 0.0;      // U
  double sun_direct = 1.0;  // D
  double sun_down = 0.0;    // F
  double sky_up = 0.0;      // R
  double sky_down = 1.0;    // T
};

/// Fluxes at an interface.
struct InterfaceFluxes {
  double down = 0.0;  // diffuse
  double up = 0.0;
  double direct = 0.0;
};

/// Returns the fluxes at the interfaces, from that above the ground to that above all layers.
/// @param layers  from the lowest to the highest. @param above  what arrives at the top; `up` is not
///     read. @param ground_albedo  in [0, 1].
[[nodiscard]] std::vector<InterfaceFluxes> FluxesBetween(std::span<const CloudLayerFluxes> layers,
                                                         const InterfaceFluxes& above,
                                                         double ground_albedo);

}  // namespace alpenglow::renderer
