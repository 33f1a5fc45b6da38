// SPDX-License-Identifier: MIT
// The fraction of diffuse light from below that the air above an altitude sends back.
//
// Molecules and aerosol above the altitude are one plane layer of their mixture, which is solved for
// even light from below to all orders (layers/layer_field.h). Ozone counts as absorbing nothing: it is
// above nearly all of the air that scatters the light back.
#pragma once

#include <vector>

#include "atmosphere/medium/medium.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Returns it for each band, in [0, 1]. For molecules without depolarisation it is within 0.005 of the
/// spherical albedo of Vermote and others (1997, IEEE Trans. Geosci. Remote Sens. 35, 675).
/// @param altitude_m  at least 0.
[[nodiscard]] std::vector<double> ReflectionOfAirAbove(const Medium& medium, double altitude_m);

}  // namespace alpenglow::renderer
