// SPDX-License-Identifier: MIT
// A view ray in a spherical atmosphere lit by a distant sun: all that radiance depends on.
#pragma once

#include <limits>

namespace alpenglow::atmosphere {

struct ViewRay {
  double altitude_m = 0.0;  // of the observer; may lie above the top of the atmosphere
  double mu = 1.0;          // cosine of the view zenith angle, [-1, 1]
  double mu_s = 1.0;        // cosine of the sun's zenith angle at the observer, [-1, 1]
  double nu = 1.0;          // cosine between view direction and direction to the sun, [-1, 1]
  /// The ray ends here, or at the ground or the top if nearer.
  double length_m = std::numeric_limits<double>::infinity();
};

/// @param view_zenith_deg, sun_zenith_deg  in [0, 180].
/// @param relative_azimuth_deg  0 looks towards the sun's azimuth.
[[nodiscard]] ViewRay RayFromAngles(double altitude_m, double view_zenith_deg,
                                    double relative_azimuth_deg, double sun_zenith_deg);

/// Where a ray begins and ends inside the shell, as distances from the observer.
enum class RayEnd { kSpace, kGround, kLength };
struct RayExtent {
  double begin_m = 0.0;  // > 0 for an observer above the top
  double end_m = 0.0;    // begin_m == end_m: the ray meets no air
  RayEnd end = RayEnd::kSpace;
};

/// Clips a ray to the shell between ground and top. A horizontal ray at altitude 0 does not hit the
/// ground; one below the horizontal there hits it at distance 0. An observer below the ground sees
/// the sky as from the ground. Error below 1e-6 m for observers within 1e8 m (extended precision).
/// Throws InputError for a ray that is not finite or not above the centre of the planet.
[[nodiscard]] RayExtent ExtentOf(const ViewRay& ray, double planet_radius_m,
                                 double atmosphere_height_m);

/// Whether what the ground reflects is part of what a ray brings: of rays that end where they meet
/// it. A ray whose length is given is a segment of air: it ends at the ground when that is nearer,
/// but what lies behind its end, be it the ground, is left to whoever asked for the segment.
[[nodiscard]] bool BringsLightOfGround(const ViewRay& ray, const RayExtent& extent);

/// The piece of a ray that lies in the shadow of the planet (a half-cylinder behind it), clipped to
/// [begin_m, end_m]. Empty when dark_begin_m == dark_end_m.
struct ShadowSpan {
  double dark_begin_m = 0.0;
  double dark_end_m = 0.0;
};
[[nodiscard]] ShadowSpan PlanetShadow(const ViewRay& ray, const RayExtent& extent,
                                      double planet_radius_m);

}  // namespace alpenglow::atmosphere
