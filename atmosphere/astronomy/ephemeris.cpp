// SPDX-License-Identifier: MIT
#include "atmosphere/astronomy/ephemeris.h"

#include <erfa.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numeric>
#include <vector>

#include "atmosphere/astronomy/ephemeris_tables.h"
#include "atmosphere/base/csv.h"
#include "atmosphere/math/constants.h"

namespace alpenglow::atmosphere {
namespace {

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

/// Returns the vector from the observer to the body at the time when the light left it.
glm::dvec3 LightPath_au(const BodyState& body, const BodyState& observer) {
  glm::dvec3 path = body.position_au - observer.position_au;
  for (int step = 0; step < 2; ++step) {  // bodies move by 1e-4 of the path: error 1e-12
    const double light_days = glm::length(path) * kLightDaysPerAu;
    path = body.position_au - light_days * body.velocity_au_per_day - observer.position_au;
  }
  return path;
}

/// Returns the apparent direction of light that arrives along `path`, for a moving observer at a
/// distance from the sun (aberration).
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

constexpr double kArcsecond = kRadiansPerDegree / 3600.0;
constexpr double kDayOf2000 = 2451545.0;
constexpr double kDaysOfCentury = 36525.0;
constexpr std::size_t kArguments = 13;

constexpr double Arcseconds(double degrees, double minutes, double seconds) {
  return (degrees * 60.0 + minutes) * 60.0 + seconds;
}

/// Coefficients of powers of the time in Julian centuries from J2000.0 [arcseconds].
using Polynomial = std::array<double, 5>;

double Value(const Polynomial& polynomial, double centuries) {
  return std::accumulate(polynomial.rbegin(), polynomial.rend(), 0.0,
                         [&](double sum, double next) { return sum * centuries + next; });
}

// Each value is the one published for ELP plus the correction that fits it to DE405 and DE406
// (Chapront and Francou 2003, table 3 and section 4.3); perigee and node also include the terms
// that follow from the constants of the fit.
constexpr Polynomial kMoonLongitude{Arcseconds(218.0, 18.0, 59.95571 - 0.07008),
                                    1732559343.73604 - 0.35106, -6.8084 - 0.03743,
                                    0.006604 - 0.00018865, -3.169e-5 - 1.024e-5};
constexpr Polynomial kPerigee{Arcseconds(83.0, 21.0, 11.67475 + 0.20794),
                              14643420.3171 + 0.08017 - 0.0040985, -38.2631 + 0.00470602,
                              -0.045047 - 0.00025213, 0.00021301};
constexpr Polynomial kAscendingNode{Arcseconds(125.0, 2.0, 40.39816 - 0.07215),
                                    -6967919.5383 - 0.04317 + 0.0000009, 6.359 - 0.0026107,
                                    0.007625 - 0.00010712, -3.586e-5};
constexpr Polynomial kEarthLongitude{Arcseconds(100.0, 27.0, 59.13885 - 0.00033),
                                     129597742.293 + 0.00732, -0.0202, 9e-6, 1.5e-7};
constexpr Polynomial kPerihelion{Arcseconds(102.0, 56.0, 14.45766 - 0.00749), 1161.24342, 0.529265,
                                 -1.1814e-4, 1.1379e-5};
// Mean longitudes of Mercury to Neptune.
constexpr std::array<Polynomial, 8> kPlanets{{
    {Arcseconds(252.0, 15.0, 3.216919), 538101628.66888},
    {Arcseconds(181.0, 58.0, 44.758419), 210664136.45777},
    {Arcseconds(100.0, 27.0, 59.13885), 129597742.293},
    {Arcseconds(355.0, 26.0, 3.642778), 68905077.65936},
    {Arcseconds(34.0, 21.0, 5.379392), 10925660.57335},
    {Arcseconds(50.0, 4.0, 38.902495), 4399609.33632},
    {Arcseconds(314.0, 3.0, 4.354234), 1542482.57845},
    {Arcseconds(304.0, 20.0, 56.808371), 786547.897},
}};
constexpr double kPrecession = 5028.79695;  // per century [arcseconds]
// Semi-major axis of DE405 divided by that of the series.
constexpr double kScale = 384747.961370173 / 384747.980674318;
// Orientation of the ecliptic in the axes of DE405, which are those of the GCRS: Chapront,
// Chapront-Touze and Francou (2002), Astronomy & Astrophysics 387, 700.
constexpr double kObliquity_rad = Arcseconds(23.0, 26.0, 21.40960) * kArcsecond;
constexpr double kEquinox_rad = -0.05028 * kArcsecond;

/// Returns the arguments of the series: D, F, l, l' of Delaunay, the planets, the longitude from a
/// fixed equinox. The terms use multiples of them.
std::array<double, kArguments> ArgumentsAt(double centuries) {
  const double moon = Value(kMoonLongitude, centuries), earth = Value(kEarthLongitude, centuries);
  std::array<double, kArguments> all{
      moon - earth + Arcseconds(180.0, 0.0, 0.0), moon - Value(kAscendingNode, centuries),
      moon - Value(kPerigee, centuries), earth - Value(kPerihelion, centuries)};
  for (std::size_t i = 0; i < kPlanets.size(); ++i) all[4 + i] = Value(kPlanets[i], centuries);
  all[12] = moon + kPrecession * centuries;
  // Whole turns, a thousand per century, would cost digits in each multiple.
  for (double& argument : all) argument = std::remainder(argument, 1296000.0) * kArcsecond;
  return all;
}

struct Term {
  std::size_t coordinate;
  int power;
  std::array<double, kArguments> multiples;
  double amplitude, phase_rad;
};

const std::vector<Term>& Terms() {
  static const std::vector<Term> kTerms = [] {
    std::vector<int> columns(4 + kArguments);
    std::iota(columns.begin(), columns.end(), 0);
    const auto table = atmosphere::ReadColumns("atmosphere/data/moon_elp_mpp02.csv", columns);
    std::vector<Term> terms;
    for (std::size_t row = 0; row < table[0].size(); ++row) {
      Term term{static_cast<std::size_t>(table[0][row]),
                static_cast<int>(table[1][row]),
                {},
                table[2 + kArguments][row],
                table[3 + kArguments][row]};
      for (std::size_t i = 0; i < kArguments; ++i) term.multiples[i] = table[2 + i][row];
      terms.push_back(term);
    }
    return terms;
  }();
  return kTerms;
}

/// Returns the longitude minus the mean longitude, and the latitude [arcseconds], and the distance
/// [km].
std::array<double, 3> SumsAt(double centuries) {
  const std::array<double, kArguments> arguments = ArgumentsAt(centuries);
  std::array<double, 3> sums{};
  for (const Term& term : Terms()) {
    const double phase = std::inner_product(arguments.begin(), arguments.end(),
                                            term.multiples.begin(), term.phase_rad);
    sums[term.coordinate] += term.amplitude * std::pow(centuries, term.power) * std::sin(phase);
  }
  return sums;
}

/// Rotates from the ecliptic of the date to that of J2000.0: Laskar (1986), Astronomy &
/// Astrophysics 157, 59, as used by ELP.
glm::dvec3 OnEclipticOf2000(const glm::dvec3& date, double t) {
  const double p =
      t * (0.10180391e-4 + t * (0.47020439e-6 + t * (-0.5417367e-9 + t * -0.2507948e-11)));
  const double q =
      t * (-0.113469002e-3 + t * (0.12372674e-6 + t * (0.1265417e-8 + t * -0.1371808e-11)));
  const double tilt = 2.0 * std::sqrt(1.0 - p * p - q * q);
  return {(1.0 - 2.0 * p * p) * date.x + 2.0 * p * q * date.y + p * tilt * date.z,
          2.0 * p * q * date.x + (1.0 - 2.0 * q * q) * date.y - q * tilt * date.z,
          -p * tilt * date.x + q * tilt * date.y + (1.0 - 2.0 * p * p - 2.0 * q * q) * date.z};
}

glm::dvec3 OnEquator(const glm::dvec3& ecliptic) {
  const double sine = std::sin(kObliquity_rad), cosine = std::cos(kObliquity_rad);
  const glm::dvec3 tilted{ecliptic.x, cosine * ecliptic.y - sine * ecliptic.z,
                          sine * ecliptic.y + cosine * ecliptic.z};
  const double across = std::sin(kEquinox_rad), along = std::cos(kEquinox_rad);
  return {along * tilted.x - across * tilted.y, across * tilted.x + along * tilted.y, tilted.z};
}

glm::dvec3 PositionAt(double centuries) {
  const auto [longitude, latitude, distance_km] = SumsAt(centuries);
  const double v =
      (std::remainder(Value(kMoonLongitude, centuries), 1296000.0) + longitude) * kArcsecond;
  const double u = latitude * kArcsecond;
  const glm::dvec3 direction{std::cos(v) * std::cos(u), std::sin(v) * std::cos(u), std::sin(u)};
  const double distance_au = kScale * distance_km * 1e3 / kAstronomicalUnit_m;
  return OnEquator(OnEclipticOf2000(distance_au * direction, centuries));
}

struct Planet {
  int number;                      // number in eraPlan94
  double magnitude;                // at 1 au from sun and earth, fully lit
  std::array<double, 3> by_phase;  // per degree of phase angle, its square, its cube
  double colour_index;
};

constexpr std::array<Planet, 5> kVisiblePlanets{{
    {1, -0.42, {0.0380, -0.000273, 0.000002}, 0.93},
    {2, -4.40, {0.0009, 0.000239, -0.00000065}, 0.82},
    {4, -1.52, {0.016, 0.0, 0.0}, 1.36},
    {5, -9.40, {0.005, 0.0, 0.0}, 0.83},
    {6, -8.88, {0.0, 0.0, 0.0}, 1.04},
}};
constexpr int kSaturn = 6;

BodyState StateOf(int number, const EarthAndSun& bodies, const TerrestrialTime& time) {
  double pv[2][3];
  eraPlan94(time.day, time.part, number, pv);
  return {bodies.sun.position_au + glm::dvec3(pv[0][0], pv[0][1], pv[0][2]),
          bodies.sun.velocity_au_per_day + glm::dvec3(pv[1][0], pv[1][1], pv[1][2])};
}

// Returns the contribution of the rings to Saturn's magnitude, from their opening angle; the pole
// of Saturn J2000: Archinal et al. (2018).
double RingMagnitude(const glm::dvec3& from_earth) {
  constexpr double kRight = 40.589 * kRadiansPerDegree, kUp = 83.537 * kRadiansPerDegree;
  const glm::dvec3 pole(std::cos(kUp) * std::cos(kRight), std::cos(kUp) * std::sin(kRight),
                        std::sin(kUp));
  const double sine = std::abs(glm::dot(pole, glm::normalize(from_earth)));
  return sine * (1.25 * sine - 2.60);
}

double MagnitudeOf(const Planet& planet, const BodyState& body, const EarthAndSun& bodies) {
  const glm::dvec3 from_sun = body.position_au - bodies.sun.position_au;
  const glm::dvec3 from_earth = body.position_au - bodies.earth.position_au;
  const double degrees =
      std::atan2(glm::length(glm::cross(from_sun, from_earth)), glm::dot(from_sun, from_earth)) /
      kRadiansPerDegree;
  const auto& by = planet.by_phase;
  const double phase = degrees * (by[0] + degrees * (by[1] + degrees * by[2]));
  return planet.magnitude + phase +
         5.0 * std::log10(glm::length(from_sun) * glm::length(from_earth)) +
         (planet.number == kSaturn ? RingMagnitude(from_earth) : 0.0);
}

}  // namespace

TerrestrialTime TerrestrialTimeAt(const UtcTime& instant, double delta_t_s) {
  return {kModifiedJulianEpoch + instant.modified_julian_day,
          (instant.second_of_day + delta_t_s) / kSecondsPerDay};
}

TurnedEarth TurnedEarthAt(const UtcTime& instant, double delta_t_s) {
  const EarthAndAxes earth = EarthAndAxesAt(TerrestrialTimeAt(instant, delta_t_s));
  const double angle_rad = eraEra00(kModifiedJulianEpoch + instant.modified_julian_day,
                                    instant.second_of_day / kSecondsPerDay) -
                           earth.equation_of_the_origins_rad;
  const double sine = std::sin(angle_rad), cosine = std::cos(angle_rad);
  return {earth.bodies,
          glm::dmat3(cosine, -sine, 0.0, sine, cosine, 0.0, 0.0, 0.0, 1.0) * earth.true_from_gcrs};
}

glm::dmat3 EcefFromGcrs(const UtcTime& instant, double delta_t_s) {
  return TurnedEarthAt(instant, delta_t_s).ecef_from_gcrs;
}

// TDB - TT, below 2 ms, moves the sun by 1e-4 arcseconds.
EarthAndSun EarthAndSunAt(const UtcTime& instant, double delta_t_s) {
  return EarthAndAxesAt(TerrestrialTimeAt(instant, delta_t_s)).bodies;
}

ApparentPlace SeenFrom(const Place& place, const glm::dmat3& ecef_from_gcrs,
                       const EarthAndSun& bodies, const BodyState& body) {
  const LocalFrame frame(kWgs84, place);
  const BodyState observer =
      ObserverOf(bodies.earth, frame.EcefFromEnu(Point<Enu>{}), glm::transpose(ecef_from_gcrs));
  const glm::dvec3 path_au = LightPath_au(body, observer);
  const double sun_au = glm::length(bodies.sun.position_au - observer.position_au);
  const Vector<Ecef> direction{
      glm::normalize(ecef_from_gcrs * Aberrated(path_au, observer.velocity_au_per_day, sun_au))};
  const glm::dvec3 enu = frame.EnuFromEcef(direction).xyz;
  return {std::atan2(enu.z, std::hypot(enu.x, enu.y)), Azimuth(enu), glm::length(path_au),
          direction};
}

BodyState MoonFromEarth(const TerrestrialTime& time) {
  const auto centuries = [&](double after_days) {
    return (time.day - kDayOf2000 + (time.part + after_days)) / kDaysOfCentury;
  };
  // The velocity is used for the 1.3 seconds of light time, in which its error is 0.2 m.
  constexpr double kMinute = 1.0 / 1440.0;
  const glm::dvec3 position = PositionAt(centuries(0.0));
  return {position, (PositionAt(centuries(kMinute)) - position) / kMinute};
}

std::array<PointLight, 5> PlanetsAt(const Place& place, const UtcTime& instant) {
  const double delta_t_s = DeltaT(instant);
  const auto [bodies, ecef_from_gcrs] = TurnedEarthAt(instant, delta_t_s);
  const TerrestrialTime time = TerrestrialTimeAt(instant, delta_t_s);
  std::array<PointLight, 5> lights{};
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const BodyState body = StateOf(kVisiblePlanets[i].number, bodies, time);
    lights[i] = {SeenFrom(place, ecef_from_gcrs, bodies, body).direction,
                 MagnitudeOf(kVisiblePlanets[i], body, bodies), kVisiblePlanets[i].colour_index};
  }
  return lights;
}

}  // namespace alpenglow::atmosphere
