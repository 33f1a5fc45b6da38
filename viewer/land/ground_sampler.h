// SPDX-License-Identifier: MIT
// The function by which light and shade ask for the heights of the land around a place.
#pragma once

#include <functional>
#include <optional>

#include "atmosphere/sun/geodesy.h"
#include "renderer/terrain/elevation.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// The heights within half_width_m of a place, at most so many samples a side; empty where there is no
/// land. A mesh gives the part that comes nearest to the place (GridOverMesh). Other threads call it.
using GroundSampler = std::function<std::optional<ElevationGrid>(
    const GeodeticPosition& place, double half_width_m, int most_samples)>;

}  // namespace alpenglow::viewer
