// SPDX-License-Identifier: MIT
#include "atmosphere/sun/planets.h"

#include <erfa.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/number/constants.h"
#include "atmosphere/sun/apparent_place.h"

namespace alpenglow::atmosphere {
namespace {

struct Planet {
  int number;                      // of eraPlan94
  double magnitude;                // at 1 au from sun and earth, full
  std::array<double, 3> by_phase;  // per degree of the phase angle, its square, its cube
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

// Of the rings, by how far they are open; the pole of Saturn J2000: Archinal et al. (2018).
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

std::array<PointLight, 5> PlanetsAt(const GeodeticPosition& place, const UtcInstant& instant) {
  const double delta_t_s = DeltaT(instant);
  const EarthAndSun bodies = EarthAndSunAt(instant, delta_t_s);
  const glm::dmat3 ecef_from_gcrs = EcefFromGcrs(instant, delta_t_s);
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
