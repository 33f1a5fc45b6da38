// SPDX-License-Identifier: MIT
/// @file
/// Points and directions in the local frame of an observer: x east, y north, z up.
///
/// The origin of the frame lies at altitude 0, on the sphere of the planet. The sphere curves away
/// below the plane z = 0: a point 10 km north of the origin with up_m = 0 has an altitude of 8 m.
#pragma once

#include <alpenglow/export.h>

namespace ALPENGLOW_EXPORT alpenglow {

/// A point relative to the origin of the local frame.
struct LocalPoint {
  double east_m = 0.0;   ///< [m]
  double north_m = 0.0;  ///< [m]
  double up_m = 0.0;     ///< [m]; equals the altitude above and below the origin
};

/// A direction in the local frame. Functions accept any length except 0.
struct Direction {
  double east = 0.0;   ///< x
  double north = 0.0;  ///< y
  double up = 1.0;     ///< z
};

/// Returns the unit vector of a direction. Throws InputError for an angle out of range.
/// @param elevation_deg  above the horizontal plane, in [-90, 90].
/// @param azimuth_deg  clockwise from north, in [-360, 360].
[[nodiscard]] Direction DirectionFromAngles(double elevation_deg, double azimuth_deg);

}  // namespace alpenglow
