// SPDX-License-Identifier: MIT
#include "atmosphere/sun/apparent_place.h"

#include <erfa.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "atmosphere/number/constants.h"

namespace alpenglow::atmosphere {
namespace {

constexpr double kModifiedJulianEpoch = 2400000.5;
constexpr double kSpeedOfLight_m_per_s = 299792458.0;  // exact, SI
constexpr double kLightDaysPerAu = kAstronomicalUnit_m / kSpeedOfLight_m_per_s / kSecondsPerDay;

glm::dvec3 Vec(const double* v) { return {v[0], v[1], v[2]}; }

BodyState ObserverOf(const BodyState& earth, const Point<Ecef>& place,
                     const glm::dmat3& gcrs_from_ecef) {
  const glm::dvec3 velocity_m_per_s =
      glm::cross(glm::dvec3(0.0, 0.0, kEarthRotation_rad_per_s), place.xyz);
  return {earth.position_au + gcrs_from_ecef * place.xyz / kAstronomicalUnit_m,
          earth.velocity_au_per_day +
              gcrs_from_ecef * velocity_m_per_s * (kSecondsPerDay / kAstronomicalUnit_m)};
}

/// From the observer to the body as it was when the light left.
glm::dvec3 LightPath_au(const BodyState& body, const BodyState& observer) {
  glm::dvec3 path = body.position_au - observer.position_au;
  for (int step = 0; step < 2; ++step) {  // bodies move by 1e-4 of the path: twice leaves 1e-12
    const double light_days = glm::length(path) * kLightDaysPerAu;
    path = body.position_au - light_days * body.velocity_au_per_day - observer.position_au;
  }
  return path;
}

/// Direction in which an observer, moving so far from the sun, sees light that arrives along `path`.
glm::dvec3 Aberrated(const glm::dvec3& path_au, const glm::dvec3& velocity_au_per_day,
                     double sun_au) {
  const double distance_au = glm::length(path_au);
  const glm::dvec3 beta = velocity_au_per_day * kLightDaysPerAu;
  double natural[3] = {path_au.x / distance_au, path_au.y / distance_au, path_au.z / distance_au};
  double velocity[3] = {beta.x, beta.y, beta.z};
  double proper[3];
  eraAb(natural, velocity, sun_au, std::sqrt(1.0 - glm::dot(beta, beta)), proper);
  return Vec(proper);
}

double Azimuth(const glm::dvec3& enu) {
  const double azimuth = std::atan2(enu.x, enu.y);
  const double turned = azimuth < 0.0 ? azimuth + 2.0 * kPi : azimuth;
  return turned < 2.0 * kPi ? turned : 0.0;  // -1e-17 + 2 pi rounds to 2 pi
}

}  // namespace

TerrestrialTime TerrestrialTimeAt(const UtcInstant& instant, double delta_t_s) {
  return {kModifiedJulianEpoch + instant.modified_julian_day,
          (instant.second_of_day + delta_t_s) / kSecondsPerDay};
}

glm::dmat3 EcefFromGcrs(const UtcInstant& instant, double delta_t_s) {
  const double day = kModifiedJulianEpoch + instant.modified_julian_day;
  const double ut1 = instant.second_of_day / kSecondsPerDay;
  const double tt = TerrestrialTimeAt(instant, delta_t_s).part;
  double true_from_gcrs[3][3];
  eraPnm06a(day, tt, true_from_gcrs);
  double r[3][3];
  eraCr(true_from_gcrs, r);
  eraRz(eraGst06(day, ut1, day, tt, true_from_gcrs), r);
  return {r[0][0], r[1][0], r[2][0], r[0][1], r[1][1], r[2][1], r[0][2], r[1][2], r[2][2]};
}

// Status 1 of eraEpv00, outside 1900-2100, only says that the error is no longer bounded by 0.02
// arcseconds. TDB - TT, below 2 ms, moves the sun by 1e-4 arcseconds.
EarthAndSun EarthAndSunAt(const UtcInstant& instant, double delta_t_s) {
  double heliocentric[2][3];
  double barycentric[2][3];
  const TerrestrialTime time = TerrestrialTimeAt(instant, delta_t_s);
  eraEpv00(time.day, time.part, heliocentric, barycentric);
  const BodyState earth{Vec(barycentric[0]), Vec(barycentric[1])};
  return {
      earth,
      {earth.position_au - Vec(heliocentric[0]), earth.velocity_au_per_day - Vec(heliocentric[1])}};
}

ApparentPlace SeenFrom(const GeodeticPosition& place, const glm::dmat3& ecef_from_gcrs,
                       const EarthAndSun& bodies, const BodyState& body) {
  const LocalFrame frame(kWgs84, place);
  const BodyState observer =
      ObserverOf(bodies.earth, EcefFromGeodetic(kWgs84, place), glm::transpose(ecef_from_gcrs));
  const glm::dvec3 path_au = LightPath_au(body, observer);
  const double sun_au = glm::length(bodies.sun.position_au - observer.position_au);
  const Vector<Ecef> direction{
      glm::normalize(ecef_from_gcrs * Aberrated(path_au, observer.velocity_au_per_day, sun_au))};
  const glm::dvec3 enu = frame.EnuFromEcef(direction).xyz;
  return {std::atan2(enu.z, std::hypot(enu.x, enu.y)), Azimuth(enu), glm::length(path_au),
          direction};
}

}  // namespace alpenglow::atmosphere
