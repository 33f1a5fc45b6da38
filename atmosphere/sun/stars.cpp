// SPDX-License-Identifier: MIT
#include "atmosphere/sun/stars.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/number/constants.h"
#include "atmosphere/sun/apparent_place.h"
#include "atmosphere/text/embedded_table.h"

namespace alpenglow::atmosphere {
namespace {

constexpr double kOfMagnitude0_lux = 2.54e-6;

struct Star {
  glm::dvec3 direction;        // at J2000.0
  glm::dvec3 motion_per_year;  // across it
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

}  // namespace

std::vector<PointLight> StarsAt(const UtcInstant& instant, double faintest) {
  constexpr double kDayOf2000 = 51544.5, kDaysOfYear = 365.25;
  const double years =
      (instant.modified_julian_day + instant.second_of_day / 86400.0 - kDayOf2000) / kDaysOfYear;
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

}  // namespace alpenglow::atmosphere
