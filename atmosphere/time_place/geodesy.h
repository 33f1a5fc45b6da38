// SPDX-License-Identifier: MIT
// Conversion of places between geodetic, earth-centred earth-fixed (ECEF) and east-north-up (ENU)
// coordinates, in double, and the transform of points and directions between two local frames.
//
// Values have their frame as a type: Point<Ecef> - Point<Enu> does not compile. A difference of
// points is a Vector of that frame. Arithmetic is GeographicLib's (Karney): error below 10 nm near
// the earth.
#pragma once

#include <alpenglow/place_time.h>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "atmosphere/math/constants.h"

namespace alpenglow::atmosphere {

struct Ecef {};  // x to longitude 0, z to the north pole
struct Enu {};   // x east, y north, z up, at the origin of a LocalFrame

template <typename Frame>
struct Vector {
  glm::dvec3 xyz{0.0};
};

template <typename Frame>
struct Point {
  glm::dvec3 xyz{0.0};  // m
};

template <typename Frame>
[[nodiscard]] Vector<Frame> operator-(const Point<Frame>& to, const Point<Frame>& from) {
  return {to.xyz - from.xyz};
}
template <typename Frame>
[[nodiscard]] Point<Frame> operator+(const Point<Frame>& from, const Vector<Frame>& step) {
  return {from.xyz + step.xyz};
}

/// An ellipsoid of revolution. Flattening 0 is a sphere.
struct Ellipsoid {
  double equatorial_radius_m;
  double flattening;
};

/// WGS84 (NIMA TR8350.2, 2000).
inline constexpr Ellipsoid kWgs84{6378137.0, 1.0 / 298.257223563};

/// Returns the longitude [degrees] of the same meridian in (-180, 180]: -180 becomes 180, values
/// inside are returned unchanged. Throws InputError if it is not finite.
[[nodiscard]] double WrappedLongitude(double longitude_deg);

/// Returns the place with WrappedLongitude, so that 180 and -180 are one place, and so are 190 and
/// -170.
[[nodiscard]] Place WithWrappedLongitude(const Place& place);

/// Returns WithWrappedLongitude(place). Throws InputError naming the coordinate if the latitude is not in [-90, 90], the
/// longitude not in [-180, 360], the height not finite or below -12 km.
[[nodiscard]] Place CheckedPlace(const Place& place);

/// Returns a place whose coordinates were computed in radians. They are neither checked nor
/// wrapped.
[[nodiscard]] constexpr Place PlaceFromRadians(double latitude_rad, double longitude_rad,
                                               double height_m) {
  return {latitude_rad / kRadiansPerDegree, longitude_rad / kRadiansPerDegree, height_m};
}

/// The longitude may have any finite value. Throws InputError if the latitude is outside [-90, 90],
/// a coordinate is not finite, or the ellipsoid is invalid.
[[nodiscard]] Point<Ecef> EcefFromGeodetic(const Ellipsoid& ellipsoid, const Place& place);
/// Returns the geodetic coordinates of a point. At the centre of the earth, where the nearest point
/// of the ellipsoid is not unique, it returns the north pole. NaN gives NaN.
[[nodiscard]] Place GeodeticFromEcef(const Ellipsoid& ellipsoid, const Point<Ecef>& point);

/// Returns the radius of the sphere that osculates the ellipsoid at a latitude: the mean (Gaussian)
/// radius sqrt(M N) of the meridian and prime-vertical curvatures [m].
[[nodiscard]] double OsculatingRadius(const Ellipsoid& ellipsoid, double latitude_rad);

/// The east-north-up frame at a place.
class LocalFrame {
 public:
  LocalFrame(const Ellipsoid& ellipsoid, const Place& origin);

  [[nodiscard]] Point<Enu> EnuFromEcef(const Point<Ecef>& point) const;
  [[nodiscard]] Point<Ecef> EcefFromEnu(const Point<Enu>& point) const;
  [[nodiscard]] Vector<Enu> EnuFromEcef(const Vector<Ecef>& vector) const;
  [[nodiscard]] Vector<Ecef> EcefFromEnu(const Vector<Enu>& vector) const;
  [[nodiscard]] Point<Enu> EnuFromGeodetic(const Place& place) const;
  [[nodiscard]] Place GeodeticFromEnu(const Point<Enu>& point) const;

  [[nodiscard]] const Place& origin() const { return origin_; }
  [[nodiscard]] const Ellipsoid& ellipsoid() const { return ellipsoid_; }

 private:
  Ellipsoid ellipsoid_;
  Place origin_;
  Point<Ecef> origin_ecef_;
  glm::dvec3 east_, north_, up_;  // unit vectors in ECEF
};

/// A rigid transform from one local frame (east, north, up) to another of the same ellipsoid.
class FrameTransform {
 public:
  /// Two frames that are the same.
  FrameTransform() = default;
  FrameTransform(const LocalFrame& to, const LocalFrame& from);
  /// A frame whose axes are parallel to those of the frame `to`. @param origin_m  of the frame `from`.
  explicit FrameTransform(const glm::dvec3& origin_m) : origin_m_(origin_m) {}

  /// Returns a point [m] of the frame `from` in the frame `to`.
  [[nodiscard]] glm::dvec3 Point(const glm::dvec3& point_m) const {
    return origin_m_ + axes_ * point_m;
  }
  /// Returns a direction of the frame `from` in the frame `to`.
  [[nodiscard]] glm::dvec3 Along(const glm::dvec3& direction) const { return axes_ * direction; }
  /// Returns a direction of the frame `to` in the frame `from`.
  [[nodiscard]] glm::dvec3 AlongBack(const glm::dvec3& direction) const {
    return direction * axes_;
  }
  /// Returns a point [m] of the frame `to` in the frame `from`.
  [[nodiscard]] glm::dvec3 PointBack(const glm::dvec3& point_m) const {
    return (point_m - origin_m_) * axes_;
  }

  /// Returns east, north and up of the frame `from`, as columns, in the frame `to`.
  [[nodiscard]] const glm::dmat3& axes() const { return axes_; }
  /// Returns the origin of the frame `from` in the frame `to` [m].
  [[nodiscard]] const glm::dvec3& origin_m() const { return origin_m_; }

 private:
  glm::dmat3 axes_{1.0};
  glm::dvec3 origin_m_{0.0};
};

/// Returns the distance between the origins of two frames of the same ellipsoid [m].
[[nodiscard]] double DistanceBetween(const LocalFrame& a, const LocalFrame& b);

}  // namespace alpenglow::atmosphere
