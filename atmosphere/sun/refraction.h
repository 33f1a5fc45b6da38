// SPDX-License-Identifier: MIT
// Refraction by rays: where light from outside the air arrives, seen from any height.
//
// Refractivity falls off with height as kAlmanacLayers (bent_ray.h) say, in spherical shells; at the
// ground it is that of air of 15 C and 1013.25 hPa at 550 nm. A star seen at the horizontal from sea
// level is lifted by the 34' of the almanacs. The model reproduces what almanacs tabulate apart:
// refraction at any elevation, the refracted dip of the sea horizon, and the refraction of a body
// that stands on it. The air of the earth presets bends rays alike. sun.h has a closed form for
// observers on the ground, of which this is the judge. Weather moves all of it by minutes of arc
// near the horizon.
#pragma once

#include "atmosphere/number/constants.h"
#include "atmosphere/sun/bent_ray.h"

namespace alpenglow {

/// Apparent minus true elevation [rad] of light that arrives at an observer `height_m` above sea
/// level under an apparent elevation, or, below the sea horizon, of the light that grazes it.
/// Within 1' of a ray traced through the U.S. Standard Atmosphere 1976 from the ground.
[[nodiscard]] double RefractionOfRay(double apparent_elevation_rad, double height_m,
                                     double earth_radius_m = kEarthMeanRadius_m);

/// The sea seen from above.
struct SeaHorizon {
  double dip_rad;             // depression of the horizon as it is seen, >= 0
  double true_elevation_rad;  // without air, of a point at infinity that is seen on the horizon
};

/// From `height_m` above the sea, from 0 to any distance; below 0 as from 0.
[[nodiscard]] SeaHorizon SeaHorizonFrom(double height_m,
                                        double earth_radius_m = kEarthMeanRadius_m);

/// Refraction [rad] of the *true* elevation, seen from `height_m`: as alpenglow::Refraction, for an
/// observer on a mountain, in an aeroplane or in orbit. Below the sea horizon there is nothing to be
/// seen but twilight: within 3 degrees the refraction on it fades to a quarter of the horizontal one
/// from sea level, 7', which is what lifts the light of high air, and at night to 0. Light that is
/// scattered once from a sun of -5 to -8 degrees comes out within 20 % of that of bent rays in blue
/// and green, and 50 % in red, whose light comes through lower air; without that lift it would be up
/// to 63 % too dark. Between 1 and -3 degrees, where sunlit peaks and the sun's disk have the whole
/// refraction, the sky has up to 40 % more light than it should. Some ten microseconds a call.
[[nodiscard]] double RefractionFromHeight(double true_elevation_rad, double height_m,
                                          double earth_radius_m = kEarthMeanRadius_m);
/// The same, in any air that bends gently.
[[nodiscard]] double RefractionFromHeight(const BendingAir& air, double true_elevation_rad,
                                          double height_m);

}  // namespace alpenglow
