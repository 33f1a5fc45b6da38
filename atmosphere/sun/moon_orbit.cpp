// SPDX-License-Identifier: MIT
#include "atmosphere/sun/moon_orbit.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <vector>

#include "atmosphere/number/constants.h"
#include "atmosphere/text/embedded_table.h"

namespace alpenglow::atmosphere {
namespace {

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

// Each as published for ELP plus what fits it to DE405 and DE406 (Chapront and Francou 2003, table
// 3 and section 4.3); of perigee and node with what follows from the constants of the fit.
constexpr Polynomial kMoonLongitude{Arcseconds(218.0, 18.0, 59.95571 - 0.07008),
                                    1732559343.73604 - 0.35106, -6.8084 - 0.03743,
                                    0.006604 - 0.00018865, -3.169e-5 - 1.024e-5};
constexpr Polynomial kPerigee{Arcseconds(83.0, 21.0, 11.67475 + 0.20794),
                              14643420.3171 + 0.08017 - 0.0040985, -38.2631 + 0.00470602,
                              -0.045047 - 0.00025213, 0.00021301};
constexpr Polynomial kNode{Arcseconds(125.0, 2.0, 40.39816 - 0.07215),
                           -6967919.5383 - 0.04317 + 0.0000009, 6.359 - 0.0026107,
                           0.007625 - 0.00010712, -3.586e-5};
constexpr Polynomial kEarthLongitude{Arcseconds(100.0, 27.0, 59.13885 - 0.00033),
                                     129597742.293 + 0.00732, -0.0202, 9e-6, 1.5e-7};
constexpr Polynomial kPerihelion{Arcseconds(102.0, 56.0, 14.45766 - 0.00749), 1161.24342, 0.529265,
                                 -1.1814e-4, 1.1379e-5};
// Of Mercury to Neptune, mean longitudes.
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
constexpr double kPrecession = 5028.79695;  // a century [arcseconds]
// Semi-major axis of DE405 over that of the series.
constexpr double kScale = 384747.961370173 / 384747.980674318;
// Of the ecliptic in the axes of DE405, which are those of the GCRS: Chapront, Chapront-Touze and
// Francou (2002), Astronomy & Astrophysics 387, 700.
constexpr double kObliquity_rad = Arcseconds(23.0, 26.0, 21.40960) * kArcsecond;
constexpr double kEquinox_rad = -0.05028 * kArcsecond;

/// Multiples of these: D, F, l, l' of Delaunay, the planets, the longitude from a fixed equinox.
std::array<double, kArguments> ArgumentsAt(double centuries) {
  const double moon = Value(kMoonLongitude, centuries), earth = Value(kEarthLongitude, centuries);
  std::array<double, kArguments> all{
      moon - earth + Arcseconds(180.0, 0.0, 0.0), moon - Value(kNode, centuries),
      moon - Value(kPerigee, centuries), earth - Value(kPerihelion, centuries)};
  for (std::size_t i = 0; i < kPlanets.size(); ++i) all[4 + i] = Value(kPlanets[i], centuries);
  all[12] = moon + kPrecession * centuries;
  // Whole turns, of which there are a thousand a century, would cost digits of each multiple.
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

/// Longitude beyond the mean one and latitude [arcseconds], distance [km].
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

/// From the ecliptic of the date to that of J2000.0: Laskar (1986), Astronomy & Astrophysics 157,
/// 59, as ELP has it.
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

}  // namespace

BodyState MoonFromEarth(const TerrestrialTime& time) {
  const auto centuries = [&](double after_days) {
    return (time.day - kDayOf2000 + (time.part + after_days)) / kDaysOfCentury;
  };
  // It serves the 1.3 seconds that the light takes, in which this errs by 0.2 m.
  constexpr double kMinute = 1.0 / 1440.0;
  const glm::dvec3 position = PositionAt(centuries(0.0));
  return {position, (PositionAt(centuries(kMinute)) - position) / kMinute};
}

}  // namespace alpenglow::atmosphere
