// SPDX-License-Identifier: MIT
// An elevation model as far as it may be seen: of models of the whole earth only what lies around
// the camera is read.
#pragma once

#include <string>

#include "atmosphere/sun/geodesy.h"
#include "renderer/layer.h"
#include "renderer/scene/scene.h"
#include "renderer/terrain/elevation.h"

namespace alpenglow::renderer {

/// The angle of the horizon below the horizontal, which is also its distance on the earth's curve
/// [radians], on a sphere without air.
[[nodiscard]] double HorizonDip(double height_m);

/// The samples of a grid within a distance [radians of the earth's curve] of a place, at least
/// 2 x 2; of a place outside of it those nearest to it.
[[nodiscard]] GridWindow WindowAround(const ElevationGrid& grid, const GeodeticPosition& place,
                                      double distance_rad);

struct ModelInSight {
  ElevationModel model;
  ElevationGrid extent;  // of the whole model, without heights
  std::string message;   // what is told about what was read; empty: nothing
};

/// The elevation model of a scene. One of more than 2^25 samples that CanBeCut is read as far as
/// ground of any height may be seen from the camera. Throws InputError as ReadElevation does, and
/// where there is no valid sample in sight.
[[nodiscard]] ModelInSight ReadModelInSight(const Scene& scene);

}  // namespace alpenglow::renderer
