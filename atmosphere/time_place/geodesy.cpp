// SPDX-License-Identifier: MIT
#include "atmosphere/time_place/geodesy.h"

#include <fmt/format.h>

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/Math.hpp>
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"

namespace alpenglow::atmosphere {
namespace {

/// Sine and cosine of both angles, exact at multiples of 90 degrees, so that a pole lies on the
/// axis, and longitudes 180 and -180 are the same meridian to the last bit.
struct Orientation {
  double latitude_degrees, longitude_degrees;
  double sin_latitude, cos_latitude, sin_longitude, cos_longitude;
};

Orientation OrientationOf(const Place& place) {
  // Quotients of radians may differ from 90 degrees by a rounding error, and GeographicLib returns
  // NaN beyond 90. A larger excess is an error of the caller.
  constexpr double kRounding_degrees = 1e-12;
  Orientation result;
  RequireInRange(place.latitude_deg, -90.0 - kRounding_degrees, 90.0 + kRounding_degrees,
                 "latitude");
  result.latitude_degrees = std::clamp(place.latitude_deg, -90.0, 90.0);
  result.longitude_degrees = WrappedLongitude(place.longitude_deg);
  GeographicLib::Math::sincosd(result.latitude_degrees, result.sin_latitude, result.cos_latitude);
  GeographicLib::Math::sincosd(result.longitude_degrees, result.sin_longitude,
                               result.cos_longitude);
  return result;
}

GeographicLib::Geocentric EarthOf(const Ellipsoid& ellipsoid) {
  try {
    return {ellipsoid.equatorial_radius_m, ellipsoid.flattening};
  } catch (const GeographicLib::GeographicErr&) {
    throw InputError(fmt::format(
        "ellipsoid has radius {} m and flattening {}; the radius must be positive and finite, the "
        "flattening below 1",
        ellipsoid.equatorial_radius_m, ellipsoid.flattening));
  }
}

}  // namespace

double WrappedLongitude(double longitude_deg) {
  if (!std::isfinite(longitude_deg)) {
    throw InputError(fmt::format("longitude is {}; it must be finite", longitude_deg));
  }
  if (longitude_deg > -180.0 && longitude_deg <= 180.0) return longitude_deg;
  const double wrapped = std::remainder(longitude_deg, 360.0);
  return wrapped == -180.0 ? 180.0 : wrapped;
}

Place WithWrappedLongitude(const Place& place) {
  return {place.latitude_deg, WrappedLongitude(place.longitude_deg), place.height_m};
}

Place CheckedPlace(const Place& place) {
  RequireInRange(place.latitude_deg, -90.0, 90.0, "latitude");
  RequireInRange(place.longitude_deg, -180.0, 360.0, "longitude");
  if (!(std::isfinite(place.height_m) && place.height_m >= -12000.0)) {
    throw InputError(
        fmt::format("height_m is {}; it must be finite and at least -12000", place.height_m));
  }
  return WithWrappedLongitude(place);
}

Point<Ecef> EcefFromGeodetic(const Ellipsoid& ellipsoid, const Place& place) {
  const Orientation at = OrientationOf(place);
  if (!std::isfinite(place.height_m)) {
    throw InputError(fmt::format("height_m is {}; it must be finite", place.height_m));
  }
  Point<Ecef> point;
  EarthOf(ellipsoid).Forward(at.latitude_degrees, at.longitude_degrees, place.height_m, point.xyz.x,
                             point.xyz.y, point.xyz.z);
  return point;
}

Place GeodeticFromEcef(const Ellipsoid& ellipsoid, const Point<Ecef>& point) {
  double latitude = 0.0;
  double longitude = 0.0;
  double height_m = 0.0;
  EarthOf(ellipsoid).Reverse(point.xyz.x, point.xyz.y, point.xyz.z, latitude, longitude, height_m);
  return {latitude, longitude == -180.0 ? 180.0 : longitude, height_m};
}

double OsculatingRadius(const Ellipsoid& ellipsoid, double latitude_rad) {
  // The radii are M = a (1 - e^2) / w^3 and N = a / w with w^2 = 1 - e^2 sin^2(latitude);
  // e^2 = f (2 - f). The mean over all azimuths of the radii of the normal sections is sqrt(M N)
  // (Gauss).
  const double f = ellipsoid.flattening;
  const double sine = std::sin(latitude_rad);
  return ellipsoid.equatorial_radius_m * (1.0 - f) / (1.0 - f * (2.0 - f) * sine * sine);
}

LocalFrame::LocalFrame(const Ellipsoid& ellipsoid, const Place& origin)
    : ellipsoid_(ellipsoid), origin_(origin), origin_ecef_(EcefFromGeodetic(ellipsoid, origin)) {
  const Orientation at = OrientationOf(origin);
  east_ = {-at.sin_longitude, at.cos_longitude, 0.0};
  north_ = {-at.sin_latitude * at.cos_longitude, -at.sin_latitude * at.sin_longitude,
            at.cos_latitude};
  up_ = {at.cos_latitude * at.cos_longitude, at.cos_latitude * at.sin_longitude, at.sin_latitude};
}

Vector<Enu> LocalFrame::EnuFromEcef(const Vector<Ecef>& vector) const {
  return {{glm::dot(east_, vector.xyz), glm::dot(north_, vector.xyz), glm::dot(up_, vector.xyz)}};
}

Vector<Ecef> LocalFrame::EcefFromEnu(const Vector<Enu>& vector) const {
  return {vector.xyz.x * east_ + vector.xyz.y * north_ + vector.xyz.z * up_};
}

Point<Enu> LocalFrame::EnuFromEcef(const Point<Ecef>& point) const {
  return {EnuFromEcef(point - origin_ecef_).xyz};
}

Point<Ecef> LocalFrame::EcefFromEnu(const Point<Enu>& point) const {
  return origin_ecef_ + EcefFromEnu(Vector<Enu>{point.xyz});
}

Point<Enu> LocalFrame::EnuFromGeodetic(const Place& place) const {
  return EnuFromEcef(EcefFromGeodetic(ellipsoid_, place));
}

Place LocalFrame::GeodeticFromEnu(const Point<Enu>& point) const {
  return GeodeticFromEcef(ellipsoid_, EcefFromEnu(point));
}

FrameTransform::FrameTransform(const LocalFrame& to, const LocalFrame& from)
    : origin_m_(to.EnuFromGeodetic(from.origin()).xyz) {
  for (glm::length_t axis = 0; axis < 3; ++axis) {
    glm::dvec3 unit(0.0);
    unit[axis] = 1.0;
    axes_[axis] = to.EnuFromEcef(from.EcefFromEnu(Vector<Enu>{unit})).xyz;
  }
}

double DistanceBetween(const LocalFrame& a, const LocalFrame& b) {
  return glm::length(a.EnuFromGeodetic(b.origin()).xyz);
}

}  // namespace alpenglow::atmosphere
