// SPDX-License-Identifier: MIT
// How light and shade ask for the heights of the land around a place.
#pragma once

#include <functional>
#include <optional>

#include "atmosphere/sun/geodesy.h"
#include "renderer/terrain/elevation.h"

namespace alpenglow {

/// What lies within half_width_m of a place, at most so many samples a side; nothing where there is
/// no land. Of a mesh it is what comes nearest to the place (GridOverMesh). Asked on other threads.
using GroundSampler = std::function<std::optional<ElevationGrid>(
    const GeodeticPosition& place, double half_width_m, int most_samples)>;

}  // namespace alpenglow
