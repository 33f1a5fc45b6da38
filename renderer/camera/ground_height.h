// SPDX-License-Identifier: MIT
// What a flight asks of the ground.
#pragma once

#include <functional>

#include "atmosphere/sun/geodesy.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Height of the ground [m] over the ellipsoid, under a place.
using GroundHeight = std::function<double(const GeodeticPosition&)>;

}  // namespace alpenglow::renderer
