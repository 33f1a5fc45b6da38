// SPDX-License-Identifier: MIT
// Sunlight scattered once, and reflected by the ground, that arrives at the nodes of DiffuseLight's
// table: the first of the successive orders.
#pragma once

#include <vector>

#include "lut/diffuse/diffuse_march.h"

namespace alpenglow::lut {

/// Per unit solar irradiance along one march: [(band * suns + sun) * azimuths + azimuth].
struct SunlightOfMarch {
  std::vector<float> radiance;   // [1/sr]
  std::vector<float> molecules;  // scattered by them, without phase function [1]
};

[[nodiscard]] SunlightOfMarch SunlightScatteredOnce(const DiffuseMarches& marches,
                                                    std::size_t altitude, const March& march,
                                                    const DiffuseLightOptions& options);

}  // namespace alpenglow::lut
