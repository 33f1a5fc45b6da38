// SPDX-License-Identifier: MIT
// Refraction of a view: it moves land and the horizon, or nothing that one could see.
#pragma once

#include <optional>

#include "atmosphere/ray/land_lift.h"
#include "viewer/paint/painted_view.h"

namespace alpenglow::viewer {

/// Returns how air bends the rays of a view; nothing where neither the farthest land nor the planet's
/// horizon moves by more than half a pixel.
/// @param farthest_land_m  of the land about the eye, whatever part of a picture is painted.
[[nodiscard]] std::optional<LandBend> BendOf(const PaintedView& view, const Medium& medium,
                                             double farthest_land_m);

}  // namespace alpenglow::viewer
