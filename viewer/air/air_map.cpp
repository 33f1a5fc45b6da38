// SPDX-License-Identifier: MIT
#include "viewer/air/air_map.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/number/constants.h"

namespace alpenglow::viewer {
namespace {

// Angle below the horizontal at which rays from altitude h touch the sphere of altitude z <= h.
double DipTo(double z, double h, double radius) {
  const double depth = std::max(h - z, 0.0);
  const double r = radius + h;
  return std::atan2(std::sqrt(depth * (2.0 * r - depth)), r - depth);
}

}  // namespace

AirMap::AirMap(const Medium& medium, double altitude_m, double ceiling_m, double twilight_fall_)
    : altitude(std::max(altitude_m, 0.0) / kMetresPerKilometre),
      ceiling(ceiling_m / kMetresPerKilometre),
      top(medium.atmosphere_height_m / kMetresPerKilometre),
      radius(medium.planet_radius_m / kMetresPerKilometre),
      horizon_dip(DipTo(0.0, altitude, radius)),
      sky_range(horizon_dip + (altitude > top ? -DipTo(top, altitude, radius) : 0.5 * kPi)),
      air_sky_range(horizon_dip +
                    (altitude > ceiling ? -DipTo(ceiling, altitude, radius) : 0.5 * kPi)),
      ground_range(0.5 * kPi - horizon_dip),
      twilight_fall(twilight_fall_),
      twilight_reference(altitude > ceiling ? radius : radius + altitude) {
  // From above all land, what is seen of its air is seen through all of the rest.
  const double layers = altitude * kMetresPerKilometre / medium.rayleigh_scale_height_m;
  sky_crowding = ground_crowding = altitude > ceiling ? 0.0 : 6.0 / (1.0 + layers) - 2.0;
}

}  // namespace alpenglow::viewer
