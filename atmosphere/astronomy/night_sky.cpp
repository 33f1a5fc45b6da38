// SPDX-License-Identifier: MIT
#include "atmosphere/astronomy/night_sky.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "atmosphere/astronomy/ephemeris.h"
#include "atmosphere/base/csv.h"
#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"

namespace alpenglow::atmosphere {
namespace {

constexpr double kOfMagnitude0_lux = 2.54e-6;

struct Star {
  glm::dvec3 direction;        // unit vector at J2000.0
  glm::dvec3 motion_per_year;  // proper motion perpendicular to it
  double magnitude, colour_index;
};

Star StarOf(double right_deg, double up_deg, double right_mas, double up_mas, double magnitude,
            double colour_index) {
  constexpr double kMas = kRadiansPerDegree / 3.6e6;
  const double a = right_deg * kRadiansPerDegree, d = up_deg * kRadiansPerDegree;
  const glm::dvec3 east(-std::sin(a), std::cos(a), 0.0);
  const glm::dvec3 north(-std::sin(d) * std::cos(a), -std::sin(d) * std::sin(a), std::cos(d));
  return {{std::cos(d) * std::cos(a), std::cos(d) * std::sin(a), std::sin(d)},
          kMas * (right_mas * east + up_mas * north),
          magnitude,
          colour_index};
}

const std::vector<Star>& Catalogue() {
  static const std::vector<Star> kStars = [] {
    const auto columns =
        atmosphere::ReadColumns("atmosphere/data/bright_stars.csv", {1, 2, 3, 4, 5, 6});
    std::vector<Star> stars;
    for (std::size_t i = 0; i < columns[0].size(); ++i) {
      stars.push_back(StarOf(columns[0][i], columns[1][i], columns[2][i], columns[3][i],
                             columns[4][i], columns[5][i]));
    }
    return stars;
  }();
  return kStars;
}

constexpr double kLayer_m = 90e3;
constexpr double kAirglow_S10 = 180.0;

constexpr std::array<double, 19> kLongitudes_deg{0,  5,  10, 15,  20,  25,  30,  35,  40, 45,
                                                 60, 75, 90, 105, 120, 135, 150, 165, 180};
constexpr std::array<double, 11> kLatitudes_deg{0, 5, 10, 15, 20, 25, 30, 45, 60, 75, 90};

// Table in 1e-8 W m^-2 sr^-1 um^-1. Cells near the sun that are empty in the source have the value
// of the nearest cell at the edge.
constexpr std::array<std::array<double, 11>, 19> kZodiacal{{
    {11500, 6780, 4740, 3140, 1610, 985, 640, 275, 150, 100, 77},
    {11500, 6780, 4740, 2940, 1540, 945, 625, 271, 150, 100, 77},
    {11500, 6780, 4740, 2470, 1370, 865, 590, 264, 148, 100, 77},
    {11500, 6780, 3440, 1860, 1110, 755, 525, 251, 146, 100, 77},
    {6400, 4480, 2410, 1410, 910, 635, 454, 237, 141, 99, 77},
    {3840, 2830, 1730, 1100, 749, 545, 410, 223, 136, 97, 77},
    {2480, 1870, 1220, 845, 615, 467, 365, 207, 131, 95, 77},
    {1650, 1270, 910, 680, 510, 397, 320, 193, 125, 93, 77},
    {1180, 940, 700, 530, 416, 338, 282, 179, 120, 92, 77},
    {910, 730, 555, 442, 356, 292, 250, 166, 116, 90, 77},
    {505, 442, 352, 292, 243, 209, 183, 134, 104, 86, 77},
    {338, 317, 269, 227, 196, 172, 151, 116, 93, 82, 77},
    {259, 251, 225, 193, 166, 147, 132, 104, 86, 79, 77},
    {212, 210, 197, 170, 150, 133, 119, 96, 82, 77, 77},
    {188, 186, 177, 154, 138, 125, 113, 90, 77, 74, 77},
    {179, 178, 166, 147, 134, 122, 110, 90, 77, 73, 77},
    {179, 178, 165, 148, 137, 127, 116, 96, 79, 72, 77},
    {196, 192, 179, 165, 151, 141, 131, 104, 82, 72, 77},
    {230, 212, 195, 178, 163, 148, 134, 105, 83, 72, 77},
}};

struct GridCell {
  std::size_t low;
  double share;  // weight of the next node
};

template <std::size_t kCount>
GridCell GridCellAt(const std::array<double, kCount>& nodes, double x) {
  const auto above = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, x);
  const auto low = static_cast<std::size_t>(above - nodes.begin()) - 1;
  return {low, std::clamp((x - nodes[low]) / (nodes[low + 1] - nodes[low]), 0.0, 1.0)};
}

/// Returns a difference of two angles, wrapped to [-pi, pi].
double Turned(double angle_rad) { return std::remainder(angle_rad, 2.0 * kPi); }

// Returns the rotation from GCRS, whose axes are those of J2000.0 within 0.03 arcseconds;
// obliquity: IAU 2006.
glm::dmat3 EclipticFromGcrs() {
  constexpr double kObliquity = 23.43928 * kRadiansPerDegree;
  const double c = std::cos(kObliquity), s = std::sin(kObliquity);
  return glm::transpose(glm::dmat3(1.0, 0.0, 0.0, 0.0, c, s, 0.0, -s, c));
}

// The Hipparcos and Tycho Catalogues (ESA SP-1200, 1997), volume 1, equation 1.5.11, by rows.
glm::dmat3 GalacticFromGcrs() {
  return glm::transpose(glm::dmat3(-0.0548755604, -0.8734370902, -0.4838350155,  //
                                   0.4941094279, -0.4448296300, 0.7469822445,    //
                                   -0.8676661490, -0.1980763734, 0.4559837762));
}

struct Angles {
  double longitude_rad, latitude_rad;
};
Angles AnglesOf(const glm::dvec3& unit) {
  return {std::atan2(unit.y, unit.x), std::asin(std::clamp(unit.z, -1.0, 1.0))};
}

}  // namespace

std::vector<PointLight> StarsAt(const UtcTime& instant, double faintest) {
  constexpr double kModifiedDayOf2000 = 51544.5, kDaysOfYear = 365.25;
  const double years =
      (instant.modified_julian_day + instant.second_of_day / kSecondsPerDay - kModifiedDayOf2000) /
      kDaysOfYear;
  const glm::dmat3 ecef_from_gcrs = EcefFromGcrs(instant, DeltaT(instant));
  std::vector<PointLight> lights;
  for (const Star& star : Catalogue()) {
    if (star.magnitude > faintest) break;
    const glm::dvec3 now = glm::normalize(star.direction + years * star.motion_per_year);
    lights.push_back({{ecef_from_gcrs * now}, star.magnitude, star.colour_index});
  }
  return lights;
}

double IlluminanceOf(double magnitude) {
  return kOfMagnitude0_lux * std::pow(10.0, -0.4 * magnitude);
}

double MagnitudeOf(double lux) { return -2.5 * std::log10(lux / kOfMagnitude0_lux); }

double TemperatureOf(double colour_index) {
  const double scaled = 0.92 * colour_index;
  return 4600.0 * (1.0 / (scaled + 1.7) + 1.0 / (scaled + 0.62));
}

double LuminanceOfSurfaceBrightness(double magnitudes) {
  return 10.8e4 * std::pow(10.0, -0.4 * magnitudes);
}

double ZenithOfBortleClass(int bortle_class) {
  constexpr std::array<double, 9> kZeniths{kNaturalZenith, kNaturalZenith, 21.4,  20.85, 19.75,
                                           18.75,          18.25,          17.75, 17.0};
  ALPENGLOW_ENSURE(bortle_class, >=, 1);
  ALPENGLOW_ENSURE(bortle_class, <=, 9);
  return kZeniths.at(static_cast<std::size_t>(bortle_class - 1));
}

double VanRhijn(double sin_z) {
  const double ratio = kEarthMeanRadius_m * sin_z / (kEarthMeanRadius_m + kLayer_m);
  return 1.0 / std::sqrt(1.0 - ratio * ratio);
}

double ZodiacalLight(double longitude_rad, double latitude_rad) {
  const GridCell i =
      GridCellAt(kLongitudes_deg, std::abs(Turned(longitude_rad)) / kRadiansPerDegree);
  const GridCell j = GridCellAt(kLatitudes_deg, std::abs(latitude_rad) / kRadiansPerDegree);
  const auto row = [&](std::size_t at) {
    return std::lerp(std::log(kZodiacal[at][j.low]), std::log(kZodiacal[at][j.low + 1]), j.share);
  };
  return 1e-8 * std::exp(std::lerp(row(i.low), row(i.low + 1), i.share));
}

double Starlight(double longitude_rad, double latitude_rad) {
  const double l = Turned(longitude_rad) / kRadiansPerDegree;
  const double b = latitude_rad / kRadiansPerDegree;
  const auto bell = [](double x) { return std::exp(-x * x); };
  const double disk =
      24.0 * (1.0 + 0.45 * std::cos(longitude_rad)) / std::hypot(std::sin(latitude_rad), 0.12);
  const double bulge = 400.0 * bell(l / 16.0) * bell((b + 5.0) / 6.0);
  // The dust lane deviates from the galactic plane by 4 degrees towards Aquila, and ends at Deneb.
  const double middle = 1.0 + 3.0 * std::sin(std::clamp(l, -30.0, 90.0) * 2.0 * kRadiansPerDegree);
  const double along = bell((l - 25.0) / 45.0);
  const double dust = 1.0 - 0.7 * along * bell((b - middle) / 3.5);
  return (disk + bulge) * dust;
}

NightSky::NightSky(const Place& place, const UtcTime& instant) {
  const double delta_t_s = DeltaT(instant);
  const LocalFrame frame(kWgs84, place);
  const auto axis = [&](const glm::dvec3& enu) { return frame.EcefFromEnu(Vector<Enu>{enu}).xyz; };
  const glm::dmat3 ecef_from_enu(axis({1.0, 0.0, 0.0}), axis({0.0, 1.0, 0.0}),
                                 axis({0.0, 0.0, 1.0}));
  const glm::dmat3 gcrs_from_enu = glm::transpose(EcefFromGcrs(instant, delta_t_s)) * ecef_from_enu;
  ecliptic_from_frame_ = EclipticFromGcrs() * gcrs_from_enu;
  galactic_from_frame_ = GalacticFromGcrs() * gcrs_from_enu;
  const EarthAndSun bodies = EarthAndSunAt(instant, delta_t_s);
  const glm::dvec3 to_sun =
      EclipticFromGcrs() * glm::normalize(bodies.sun.position_au - bodies.earth.position_au);
  sun_longitude_rad_ = AnglesOf(to_sun).longitude_rad;
}

NightSky NightSky::InFrame(const glm::dmat3& frame_from_enu) const {
  NightSky turned = *this;
  const glm::dmat3 enu_from_frame = glm::transpose(frame_from_enu);
  turned.ecliptic_from_frame_ = ecliptic_from_frame_ * enu_from_frame;
  turned.galactic_from_frame_ = galactic_from_frame_ * enu_from_frame;
  return turned;
}

NightRadiance NightSky::Towards(const glm::dvec3& direction, const glm::dvec3& up,
                                double altitude_m) const {
  constexpr double kNanometresPerMicrometre = 1e3;
  constexpr double kSunAt500nm = 1.916;  // W m^-2 nm^-1: ASTM G173-03, mean over 10 nm
  const double mu = glm::dot(direction, up);
  // Directions below the horizon, visible only from a height, have the values of the horizon.
  const double sin_z = mu > 0.0 ? std::sqrt(std::max(1.0 - mu * mu, 0.0)) : 1.0;
  const Angles ecliptic = AnglesOf(ecliptic_from_frame_ * direction);
  const Angles galactic = AnglesOf(galactic_from_frame_ * direction);
  return {altitude_m < kLayer_m ? kAirglow_S10 * kS10_cd_per_m2 * VanRhijn(sin_z) : 0.0,
          ZodiacalLight(ecliptic.longitude_rad - sun_longitude_rad_, ecliptic.latitude_rad) /
              kNanometresPerMicrometre / kSunAt500nm,
          kS10_cd_per_m2 * Starlight(galactic.longitude_rad, galactic.latitude_rad)};
}

}  // namespace alpenglow::atmosphere
