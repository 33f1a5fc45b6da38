// SPDX-License-Identifier: MIT
#include "atmosphere/astronomy/ephemeris.h"

#include <erfa.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/math/constants.h"

namespace alpenglow::atmosphere {
namespace {

constexpr double kArcsecond = kRadiansPerDegree / 3600.0;

double Angle(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

glm::dvec3 Kilometres(const TerrestrialTime& time) {
  return MoonFromEarth(time).position_au * (kAstronomicalUnit_m / 1e3);
}

struct KnownPlace {
  double julian_day;
  glm::dvec3 position_km;
};

// All 35901 terms of ELP/MPP02 with the constants of DE405, summed by another program, which gives
// the positions that Y. T. Liu publishes of the same sum (github.com/ytliu0/ElpMpp02) to 1e-4 km.
constexpr std::array<KnownPlace, 6> kOfAllTerms{{
    {2433392.5, {133664.8, 335981.5, 181498.1}},
    {2442669.5, {59165.0, -364334.3, -131581.7}},
    {2451545.0, {-291608.4, -266716.8, -76102.5}},
    {2461265.25, {-280613.6, 214726.7, 99197.0}},
    {2473533.0, {-324859.5, 198775.3, 123645.7}},
    {2488033.5, {301000.3, 230039.9, 128293.1}},
}};

TEST(MoonOrbit, TermsLeftOutMoveItByLessThanAnArcsecond) {
  for (const auto& [day, all_km] : kOfAllTerms) {
    const glm::dvec3 here_km = Kilometres({day, 0.0});
    EXPECT_LT(Angle(here_km, all_km), 0.6 * kArcsecond) << day;
    EXPECT_NEAR(glm::length(here_km), glm::length(all_km), 3.0) << day;
  }
}

// JPL Horizons, DE441: geometric, ICRF, 2022 December 25, 0h TDB.
TEST(MoonOrbit, StandsWhereTheJetPropulsionLaboratoryHasIt) {
  const glm::dvec3 horizons_au{1.013355885727306e-3, -1.903485709903833e-3, -1.047798412089101e-3};
  const BodyState moon = MoonFromEarth({2459938.5, 0.0});
  EXPECT_LT(Angle(moon.position_au, horizons_au), 0.6 * kArcsecond);
  EXPECT_NEAR(glm::length(moon.position_au), glm::length(horizons_au), 3e3 / kAstronomicalUnit_m);
  const glm::dvec3 velocity{5.762732121285166e-4, 2.476878261262097e-4, 8.902329774047208e-5};
  EXPECT_LT(glm::length(moon.velocity_au_per_day - velocity), 1e-4 * glm::length(velocity))
      << "of which the light time of 1.3 s makes 0.1 m";
}

// Meeus' selection of an older theory, in another library: states 10 arcseconds in longitude, 4 in
// latitude, rms, and 20 km or so of distance.
TEST(MoonOrbit, AgreesWithErfaWithinTwentyArcseconds) {
  double square = 0.0;
  constexpr int kDays = 2000;
  for (int i = 0; i < kDays; ++i) {
    const double day = 2433282.5 + i * 27.4;  // 1950 to 2100
    double pv[2][3];
    eraMoon98(day, 0.0, pv);
    const glm::dvec3 erfa(pv[0][0], pv[0][1], pv[0][2]);
    const glm::dvec3 here = MoonFromEarth({day, 0.0}).position_au;
    const double angle = Angle(here, erfa);
    EXPECT_LT(angle, 20.0 * kArcsecond) << day;
    square += angle * angle / kDays;
  }
  EXPECT_LT(std::sqrt(square), 6.0 * kArcsecond);
}

TEST(MoonOrbit, ADayAndItsPartAreOneTime) {
  EXPECT_LT(glm::length(Kilometres({2461265.0, 0.25}) - Kilometres({2461265.25, 0.0})), 1e-3);
  const BodyState moon = MoonFromEarth({2461265.0, 0.25});
  const glm::dvec3 later = MoonFromEarth({2461265.0, 0.26}).position_au;
  EXPECT_LT(Angle(later - moon.position_au, moon.velocity_au_per_day), 0.01);
}

}  // namespace
}  // namespace alpenglow::atmosphere
