// SPDX-License-Identifier: MIT
// C++ reading of air_map.glsl, and what it says about one eye.
#pragma once

#include "atmosphere/air/medium.h"
#include "atmosphere/ray/shell.h"
#include "viewer/layer.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/dialect/shared_begin.h"
#include "viewer/air/air_map.glsl"
#include "atmosphere/dialect/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared

namespace alpenglow::viewer {

/// The axes of one eye's tables. Angles in radians, lengths in km.
struct AirMap {
  /// @param ceiling_m  that no land exceeds.
  AirMap(const Medium& medium, double altitude_m, double ceiling_m, double twilight_fall_);

  double altitude, ceiling, top, radius;
  double horizon_dip;         // of the horizon below the horizontal
  double sky_range;           // from the horizon up to the zenith or to the upper edge of the air
  double air_sky_range;       // up to the zenith or to where rays miss all land
  double ground_range;        // from the horizon down to the nadir
  double twilight_fall;       // of DiffuseGrid
  double twilight_reference;  // radius about where the light comes from
  double sky_crowding, ground_crowding;  // of distances
};

}  // namespace alpenglow::viewer
