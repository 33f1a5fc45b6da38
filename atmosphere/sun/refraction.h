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

namespace alpenglow::atmosphere {

/// The air of almanacs at kHorizonWavelength_nm.
[[nodiscard]] BendingAir AlmanacAir(double earth_radius_m = kEarthMeanRadius_m);

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

/// Refraction [rad] of the *true* elevation, seen from `height_m`: as atmosphere::Refraction, for an
/// observer on a mountain, in an aeroplane or in orbit. Below the sea horizon, where only sunlit peaks
/// show where the sun is, the refraction on it fades to 0 within 3 degrees. Some ten microseconds a
/// call.
[[nodiscard]] double RefractionFromHeight(double true_elevation_rad, double height_m,
                                          double earth_radius_m = kEarthMeanRadius_m);
/// The same, in any air that bends gently.
[[nodiscard]] double RefractionFromHeight(const BendingAir& air, double true_elevation_rad,
                                          double height_m);

/// Returns the lift [rad] of a sun or moon of a *true* elevation with which its straight rays light the
/// air about as bent rays do: a fifth of the refraction seen from sea level, 7' from the horizon
/// down, whatever the height of the eye.
///
/// A bent ray that grazes the planet arrives higher than a straight one, but it stays low for longer,
/// and spreads: straight rays from where the sun is seen bring up to twice the light. Light scattered
/// once (450, 550, 650 nm) towards eyes from sea level to 3 km is then within 5 % (rms over directions)
/// of that of bent rays while the sun is up, 6 % down to -4 degrees and 17 % down to -8, where blue is
/// brighter and red, whose light comes through lower air, darker. Not in these figures is the sky up to
/// 10 degrees over the horizon opposite a sun that has set, where light scattered once ends.
/// tests/bench/bent_twilight.cpp compares shares.
[[nodiscard]] double LiftForAir(const BendingAir& air, double true_elevation_rad);

}  // namespace alpenglow::atmosphere
