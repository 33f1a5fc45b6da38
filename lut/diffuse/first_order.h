// SPDX-License-Identifier: MIT
// Sunlight scattered once, and reflected by the ground, that arrives at the nodes of DiffuseLight's
// table: the first of the successive orders.
#pragma once

#include <vector>

#include "lut/diffuse/diffuse_march.h"

namespace alpenglow {

/// Radiance per unit solar irradiance [1/sr] along one march:
/// [(band * suns + sun) * azimuths + azimuth].
[[nodiscard]] std::vector<float> SunlightScatteredOnce(const DiffuseMarches& marches,
                                                       std::size_t altitude, const March& march,
                                                       int ray_nodes);

}  // namespace alpenglow
