// SPDX-License-Identifier: MIT
// Sun and moon as one place sees them at one instant: computed once, and passed to everything that
// depends on place and time.
#pragma once

#include "atmosphere/astronomy/eclipse.h"
#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/refraction/refraction.h"
#include "atmosphere/time_place/geodesy.h"
#include "atmosphere/time_place/time.h"

namespace alpenglow::atmosphere {

/// Returns the sun with refraction by any air that bends rays gently (ApparentSunAt).
/// @param sun  without refraction. @param height_m  of the eye above the ellipsoid.
[[nodiscard]] SunPosition Refracted(const SunPosition& sun, double height_m, const BendingAir& air);
/// Returns the moon with refraction (ApparentMoonAt).
[[nodiscard]] MoonPosition Refracted(const MoonPosition& moon, double height_m,
                                     const BendingAir& air);

/// Sun and moon without refraction.
struct SkyBodies {
  GeodeticPosition place;
  UtcInstant instant;
  SunPosition sun;
  MoonPosition moon;

  /// Returns the moon in front of the sun.
  [[nodiscard]] EclipsedDisk Eclipse() const { return EclipsedDiskOf(sun, moon); }
  /// Returns the fraction of the sun's light at 550 nm that the moon covers, [0, 1]; exactly 1 in
  /// totality.
  [[nodiscard]] double CoveredLight() const;
  [[nodiscard]] SunPosition ApparentSun(const BendingAir& air) const {
    return Refracted(sun, place.height_m, air);
  }
  /// Returns the disk of the moon with refraction, in the frame east, north, up of the place.
  [[nodiscard]] MoonDisk ApparentMoonDisk(const BendingAir& air) const;
};

[[nodiscard]] SkyBodies SkyBodiesAt(const GeodeticPosition& place, const UtcInstant& instant);

}  // namespace alpenglow::atmosphere
