// SPDX-License-Identifier: MIT
#include "atmosphere/ray/ray.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/ray/shell.h"

namespace alpenglow::atmosphere {
namespace {

using Extended = long double;

void RequireFinite(const ViewRay& ray, double planet_radius_m) {
  RequireInRange(ray.altitude_m, -0.5 * planet_radius_m, 1e12, "altitude_m");
  RequireInRange(ray.mu, -1.0, 1.0, "mu (cosine of the view zenith angle)");
  RequireInRange(ray.mu_s, -1.0, 1.0, "mu_s (cosine of the sun zenith angle)");
  RequireInRange(ray.nu, -1.0, 1.0, "nu (cosine between view and sun)");
  if (!(ray.length_m >= 0.0))
    throw InputError(fmt::format("length_m is {}; it must be >= 0", ray.length_m));
}

// Distances at which a line crosses the sphere of altitude z; none if it passes above.
struct Crossings {
  bool exist;
  Extended near, far;
};

Crossings CrossAltitude(Extended h, Extended mu, Extended z, Extended radius) {
  const Extended a = (radius + h) * mu;
  const Extended c = (h - z) * (2 * radius + h + z);
  const Extended discriminant = a * a - c;
  if (discriminant < 0) return {false, 0, 0};
  const Extended root = std::sqrt(discriminant);
  // Conjugate roots: one root is computed without cancellation, the other is c over it.
  const Extended far_side = a > 0 ? -a - root : -a + root;
  const Extended other = far_side != 0 ? c / far_side : 0;
  return {true, std::min(far_side, other), std::max(far_side, other)};
}

}  // namespace

ViewRay RayFromAngles(double altitude_m, double view_zenith_deg, double relative_azimuth_deg,
                      double sun_zenith_deg) {
  const double view = view_zenith_deg * kRadiansPerDegree;
  const double sun = sun_zenith_deg * kRadiansPerDegree;
  const double azimuth = relative_azimuth_deg * kRadiansPerDegree;
  ViewRay ray;
  ray.altitude_m = altitude_m;
  ray.mu = std::cos(view);
  ray.mu_s = std::cos(sun);
  ray.nu =
      std::clamp(ray.mu * ray.mu_s + std::sin(view) * std::sin(sun) * std::cos(azimuth), -1.0, 1.0);
  return ray;
}

namespace {

// Returns whether a ray of finite length stays more than a metre inside the shell, away from ground
// and top.
bool EndsWellInside(const ViewRay& ray, double planet_radius_m, double atmosphere_height_m) {
  constexpr double kMargin_m = 1.0;
  if (!(ray.length_m < 1e6)) return false;
  const auto altitude = [&](double distance_m) {
    return shared::AltitudeAlongRay<double>(ray.altitude_m, ray.mu, distance_m, planet_radius_m);
  };
  const double perigee_m = -(planet_radius_m + ray.altitude_m) * ray.mu;
  const double lowest = altitude(std::clamp(perigee_m, 0.0, ray.length_m));
  const double highest = std::max(ray.altitude_m, altitude(ray.length_m));
  return lowest > kMargin_m && highest < atmosphere_height_m - kMargin_m;
}

}  // namespace

RayExtent ExtentOf(const ViewRay& ray, double planet_radius_m, double atmosphere_height_m) {
  RequireFinite(ray, planet_radius_m);
  if (EndsWellInside(ray, planet_radius_m, atmosphere_height_m))
    return {0.0, ray.length_m, RayEnd::kLength};
  const Extended h = std::max(ray.altitude_m, 0.0);
  const Crossings top = CrossAltitude(h, ray.mu, atmosphere_height_m, planet_radius_m);
  if (!top.exist || top.far <= 0) return {};
  RayExtent extent;
  extent.begin_m = static_cast<double>(std::max<Extended>(top.near, 0));
  if (h <= atmosphere_height_m) extent.begin_m = 0.0;
  extent.end_m = static_cast<double>(top.far);
  if (ray.mu < 0.0) {
    if (const Crossings ground = CrossAltitude(h, ray.mu, 0, planet_radius_m); ground.exist) {
      extent.end_m = static_cast<double>(std::max<Extended>(ground.near, 0));
      extent.end = RayEnd::kGround;
    }
  }
  if (ray.length_m < extent.end_m) {
    extent.end_m = std::max(ray.length_m, extent.begin_m);
    extent.end = RayEnd::kLength;
  }
  return extent;
}

bool BringsLightOfGround(const ViewRay& ray, const RayExtent& extent) {
  return extent.end == RayEnd::kGround && std::isinf(ray.length_m);
}

ShadowSpan PlanetShadow(const ViewRay& ray, const RayExtent& extent, double planet_radius_m) {
  // If the sun is above the plane through the planet's centre at both ends, there is no shadow in
  // between.
  const double height_m = (planet_radius_m + std::max(ray.altitude_m, 0.0)) * ray.mu_s;
  if (height_m + extent.begin_m * ray.nu > 0.0 && height_m + extent.end_m * ray.nu > 0.0) return {};
  const Extended h = std::max(ray.altitude_m, 0.0), mu = ray.mu, mu_s = ray.mu_s, nu = ray.nu;
  const Extended a = (1 - nu) * (1 + nu);
  const Extended radius = planet_radius_m;
  if (shared::MeetsShadow(h, mu, mu_s, nu, a, radius) == 0) return {};
  const Extended begin =
      std::max<Extended>(extent.begin_m, shared::ShadowBegin(h, mu, mu_s, nu, a, radius));
  const Extended end =
      std::min<Extended>(extent.end_m, shared::ShadowEnd(h, mu, mu_s, nu, a, radius));
  if (!(begin < end)) return {};
  return {static_cast<double>(begin), static_cast<double>(end)};
}

}  // namespace alpenglow::atmosphere
