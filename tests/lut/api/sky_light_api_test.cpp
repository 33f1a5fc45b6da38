// SPDX-License-Identifier: MIT
// The light of sun and sky on planes, the disk, polarisation, and batches of the public headers.
#include <alpenglow/errors.h>
#include <alpenglow/panorama.h>
#include <alpenglow/sky.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/medium/medium.h"
#include "lut/api/conversions.h"
#include "tests/fixtures/fault_of.h"

namespace alpenglow {
namespace {

using atmosphere::kPi;
using atmosphere::kRadiansPerDegree;
using testing::HasSubstr;

constexpr LocalPoint kHill{.east_m = 100.0, .north_m = -200.0, .up_m = 500.0};

const Sky& EarthSky() {
  static const Sky sky{Atmosphere()};
  return sky;
}

SunInSky SunAtElevation(double elevation_deg, double azimuth_deg = 200.0) {
  return {.elevation_deg = elevation_deg, .azimuth_deg = azimuth_deg};
}

Direction Of(const glm::dvec3& vector) { return {vector.x, vector.y, vector.z}; }

// Light has the same bits but for one rounding in each of the two ways to apply the factor.
TEST(SkyLight, FollowsTheDistanceOfTheSunEverywhere) {
  SunInSky sun = SunAtElevation(30.0);
  const Sunlight mean = sun;
  sun.distance_au = 1.0166;  // in July
  const auto expect_less = [&](const Spectrum& far, const Spectrum& near) {
    for (std::size_t band = 0; band < far.size(); ++band)
      EXPECT_NEAR(double{far[band]} / double{near[band]}, 1.0 / (1.0166 * 1.0166), 1e-6);
  };
  const Direction view = DirectionFromAngles(20.0, 140.0);
  const LocalPoint peak{.north_m = 20e3, .up_m = 2000.0};
  expect_less(EarthSky().Radiance(kHill, view, sun), EarthSky().Radiance(kHill, view, mean));
  expect_less(EarthSky().PolarisationOf(kHill, view, sun).q,
              EarthSky().PolarisationOf(kHill, view, mean).q);
  expect_less(EarthSky().DiskRadiance(kHill, sun.ToSun(), sun),
              EarthSky().DiskRadiance(kHill, sun.ToSun(), mean));
  expect_less(EarthSky().Between(kHill, peak, sun).inscattered,
              EarthSky().Between(kHill, peak, mean).inscattered);
  EXPECT_EQ(EarthSky().Between(kHill, peak, sun).transmittance,
            EarthSky().Between(kHill, peak, mean).transmittance);
  expect_less(EarthSky().SunIrradiance(kHill, sun), EarthSky().SunIrradiance(kHill, mean));
  expect_less(EarthSky().SkyIrradiance(kHill, sun), EarthSky().SkyIrradiance(kHill, mean));
}

// Irradiances are floats, the illuminance is summed as double: 1e-5 is some roundings of bands.
TEST(SkyLight, ColourOfIrradiancesAgreesWithTheIlluminance) {
  for (const double elevation_deg : {70.0, 20.0, 0.1, -0.1, -4.0}) {
    SunInSky sun = SunAtElevation(elevation_deg);
    sun.distance_au = 1.0166;
    sun.lower_for_air_deg = 0.1;
    const LocalPoint eye{.up_m = 300.0};
    const Spectrum light = EarthSky().SunIrradiance(eye, sun) + EarthSky().SkyIrradiance(eye, sun);
    EXPECT_NEAR(Luminance(EarthSky().atmosphere().ColourOf(light)) /
                    HorizontalIlluminance(EarthSky(), eye.up_m, sun),
                1.0, 1e-5)
        << elevation_deg;
  }
}

TEST(SkyLight, SunOnAPlaneFollowsTheCosineOfItsAngle) {
  const SunInSky sun = SunAtElevation(30.0, 90.0);
  const LocalPoint eye{.up_m = 2.0};
  const auto share = [&](const Direction& normal) {
    return double{EarthSky().SunIrradiance(eye, sun, normal)[1]} /
           double{EarthSky().SunIrradiance(eye, sun, sun.ToSun())[1]};
  };
  EXPECT_NEAR(share({}), 0.5, 1e-6);
  EXPECT_NEAR(share({.east = 7.0, .up = 0.0}), std::sqrt(0.75), 1e-6) << "normals of any length";
  EXPECT_EQ(share({.east = -1.0, .up = 0.0}), 0.0) << "the wall is in its own shadow";
  EXPECT_EQ(share({.up = -1.0}), 0.0);
  const Sunlight low = SunAtElevation(-1.0);
  EXPECT_EQ(EarthSky().SunIrradiance(eye, low, low.to_sun)[0], 0.0F) << "the ground is before it";
  EXPECT_GT(EarthSky().SunIrradiance({.up_m = 10e3}, low, low.to_sun)[0], 0.0F)
      << "from an aeroplane the horizon is lower";
}

// The slow way sums the disk in rings. 64 rings and the midpoint rule leave less than 1e-3 at the
// limb, where the radiance has a steep slope; the air changes by less over the disk.
TEST(SkyLight, DiskHoldsTheIrradianceOfThePlaneThatFacesIt) {
  const SunInSky sun = SunAtElevation(25.0);
  const glm::dvec3 centre = UnitVectorOf(sun.ToSun());
  const glm::dvec3 right = glm::normalize(glm::cross(centre, glm::dvec3(0.0, 0.0, 1.0)));
  const glm::dvec3 above = glm::cross(right, centre);
  constexpr int kRings = 64, kSectors = 8;
  const double radius_rad = sun.angular_radius_rad();
  std::vector<double> sum(EarthSky().atmosphere().wavelengths_nm().size());
  for (int ring = 0; ring < kRings; ++ring) {
    const double out = radius_rad * (ring + 0.5) / kRings;
    for (int sector = 0; sector < kSectors; ++sector) {
      const double turn = 2.0 * kPi * (sector + 0.5) / kSectors;
      const glm::dvec3 view = std::cos(out) * centre +
                              std::sin(out) * (std::cos(turn) * right + std::sin(turn) * above);
      const Spectrum light = EarthSky().DiskRadiance(kHill, Of(view), sun);
      const double solid_angle = std::sin(out) * radius_rad / kRings * 2.0 * kPi / kSectors;
      for (std::size_t band = 0; band < sum.size(); ++band)
        sum[band] += solid_angle * double{light[band]};
    }
  }
  const Spectrum expected = EarthSky().SunIrradiance(kHill, sun, sun.ToSun());
  for (std::size_t band = 0; band < sum.size(); ++band)
    EXPECT_NEAR(sum[band] / double{expected[band]}, 1.0, 1e-3) << band;
  const Direction beside = DirectionFromAngles(25.0 + 0.27, 200.0);
  EXPECT_EQ(EarthSky().DiskRadiance(kHill, beside, sun)[0], 0.0F);
  const SunInSky low = SunAtElevation(-5.0);
  EXPECT_EQ(EarthSky().DiskRadiance(kHill, low.ToSun(), low)[0], 0.0F);
}

/// Returns the distance to the ground along a ray from an altitude; 0 if it goes to space.
double DistanceToGround(double altitude_m, double mu) {
  const double ground_m = EarthSky().atmosphere().planet_radius_m();
  const double radius_m = ground_m + altitude_m;
  const double under_root = ground_m * ground_m - radius_m * radius_m * (1.0 - mu * mu);
  return mu < 0.0 && under_root > 0.0 ? -radius_m * mu - std::sqrt(under_root) : 0.0;
}

/// Sums the radiance of sky and ground over the directions before a plane.
double SummedIrradiance(const LocalPoint& eye, const Sunlight& sun, const glm::dvec3& normal) {
  constexpr int kZeniths = 60, kAzimuths = 72;
  const Atmosphere& air = EarthSky().atmosphere();
  const double of_ground =
      air.medium().ground_albedo[1] / kPi *
      double{(EarthSky().SunIrradiance({}, sun) + EarthSky().SkyIrradiance({}, sun))[1]};
  double sum = 0.0;
  for (int row = 0; row < kZeniths; ++row) {
    const double mu = 1.0 - 2.0 * (row + 0.5) / kZeniths, sine = std::sqrt(1.0 - mu * mu);
    for (int column = 0; column < kAzimuths; ++column) {
      const double turn = 2.0 * kPi * (column + 0.5) / kAzimuths;
      const glm::dvec3 view(sine * std::sin(turn), sine * std::cos(turn), mu);
      const double cosine = glm::dot(view, normal);
      if (cosine <= 0.0) continue;
      double light = double{EarthSky().Radiance(eye, Of(view), sun)[1]};
      if (const double far_m = DistanceToGround(eye.up_m, mu); far_m > 0.0)
        light += of_ground * double{air.Transmittance(eye, Of(view), far_m)[1]};
      sum += 4.0 * kPi / (kZeniths * kAzimuths) * cosine * light;
    }
  }
  return sum;
}

// Moments of a low degree hold the light on planes: their error is given relative to the horizontal
// plane. The sum itself has an error of 1 % beside the aureole of the sun.
TEST(SkyLight, OnPlanesOfTheSkyIsTheSumOfItsRadiance) {
  const LocalPoint eye{.up_m = 500.0};
  for (const double elevation_deg : {50.0, 15.0, -3.0}) {
    const Sunlight sun = SunAtElevation(elevation_deg, 90.0);
    const double level = double{EarthSky().SkyIrradiance(eye, sun)[1]};
    for (const auto& [slope_deg, azimuth_deg] : {std::pair{90.0, 90.0},
                                                 {60.0, -90.0},
                                                 {30.0, 0.0},
                                                 {-20.0, 45.0},
                                                 {0.0, 90.0},
                                                 {0.0, 270.0},
                                                 {0.0, 180.0},
                                                 {-90.0, 0.0}}) {
      const Direction normal = DirectionFromAngles(slope_deg, azimuth_deg);
      EXPECT_NEAR(double{EarthSky().SkyIrradiance(eye, sun, normal)[1]} / level,
                  SummedIrradiance(eye, sun, UnitVectorOf(normal)) / level, 0.04)
          << elevation_deg << ": " << slope_deg << ", " << azimuth_deg;
    }
  }
  const Sunlight sun = SunAtElevation(40.0);
  EXPECT_NEAR(double{EarthSky().SkyIrradiance(eye, sun, {.east = 1e-5})[1]} /
                  double{EarthSky().SkyIrradiance(eye, sun)[1]},
              1.0, 1e-3)
      << "no step beside the horizontal";
}

// Molecules polarise perpendicularly to the plane through the sun; light of higher orders turns it
// by a few degrees at 90 degrees from a sun of 20 degrees, well above the horizon.
TEST(SkyLight, IsPolarisedAcrossThePlaneThroughTheSun) {
  const SunInSky sun = SunAtElevation(20.0, 180.0);
  const glm::dvec3 to_sun = UnitVectorOf(sun.ToSun());
  for (const double azimuth_deg : {90.0, 115.0, 140.0, 220.0, 245.0, 270.0}) {
    const Direction view = DirectionFromAngles(50.0, azimuth_deg);
    const glm::dvec3 ray = UnitVectorOf(view);
    const glm::dvec3 right = glm::normalize(glm::cross(ray, glm::dvec3(0.0, 0.0, 1.0)));
    const glm::dvec3 above = glm::cross(right, ray);
    const glm::dvec3 across = glm::cross(ray, to_sun);
    const double expected = std::atan2(glm::dot(across, right), glm::dot(across, above));
    const Polarisation light = EarthSky().PolarisationOf(kHill, view, sun);
    const double found = 0.5 * std::atan2(double{light.u[1]}, double{light.q[1]});
    EXPECT_LT(std::abs(std::remainder(found - expected, kPi)), 4.0 * kRadiansPerDegree)
        << azimuth_deg;
    const double degree = std::hypot(double{light.q[1]}, double{light.u[1]}) /
                          double{EarthSky().Radiance(kHill, view, sun)[1]};
    EXPECT_GT(degree, 0.1);
    EXPECT_LT(degree, 0.9);
  }
}

/// Arguments of three rays.
struct Rays {
  std::vector<LocalPoint> eyes{kHill, {.up_m = 2.0}, {.east_m = 3e3, .up_m = 9e3}};
  std::vector<LocalPoint> objects{{.up_m = 30.0}, {.north_m = 20e3}, {.north_m = 5e3}};
  std::vector<Direction> views{{.up = 1.0}, DirectionFromAngles(30.0, 200.0), {.up = -1.0}};
  std::vector<Sunlight> suns{SunAtElevation(30.0), SunAtElevation(2.0), SunAtElevation(-3.0)};
};

/// Expects that the results of a ray are a spectrum.
void ExpectRay(const std::vector<float>& results, std::size_t ray, const Spectrum& light) {
  for (std::size_t band = 0; band < light.size(); ++band)
    EXPECT_EQ(results.at(ray * light.size() + band), light[band]) << ray << ", " << band;
}

TEST(Batches, EqualSingleCalls) {
  const Rays of;
  const Sky& sky = EarthSky();
  const std::size_t values = 3 * sky.atmosphere().wavelengths_nm().size();
  std::vector<float> radiance(values), disk(values), q(values), u(values), through(values),
      scattered(values), direct(values), diffuse(values);
  sky.Radiance(of.eyes, of.views, of.suns, radiance);
  sky.DiskRadiance(of.eyes, of.views, of.suns, disk);
  sky.PolarisationOf(of.eyes, of.views, of.suns, q, u);
  sky.Between(of.eyes, of.objects, of.suns, through, scattered);
  sky.SunIrradiance(of.eyes, of.suns, of.views, direct);
  sky.SkyIrradiance(of.eyes, of.suns, of.views, diffuse);
  for (std::size_t i = 0; i < 3; ++i) {
    const LocalPoint& eye = of.eyes[i];
    ExpectRay(radiance, i, sky.Radiance(eye, of.views[i], of.suns[i]));
    ExpectRay(disk, i, sky.DiskRadiance(eye, of.views[i], of.suns[i]));
    ExpectRay(q, i, sky.PolarisationOf(eye, of.views[i], of.suns[i]).q);
    ExpectRay(u, i, sky.PolarisationOf(eye, of.views[i], of.suns[i]).u);
    ExpectRay(through, i, sky.Between(eye, of.objects[i], of.suns[i]).transmittance);
    ExpectRay(scattered, i, sky.Between(eye, of.objects[i], of.suns[i]).inscattered);
    ExpectRay(direct, i, sky.SunIrradiance(eye, of.suns[i], of.views[i]));
    ExpectRay(diffuse, i, sky.SkyIrradiance(eye, of.suns[i], of.views[i]));
  }
  sky.Radiance(of.eyes[0], of.views, of.suns[1], radiance);
  ExpectRay(radiance, 2, sky.Radiance(of.eyes[0], of.views[2], of.suns[1]));
}

TEST(Batches, OfOtherLengthsAreRefused) {
  const Rays of;
  const Sky& sky = EarthSky();
  const std::size_t bands = sky.atmosphere().wavelengths_nm().size();
  std::vector<float> two(2 * bands), three(3 * bands), odd(3 * bands + 1);
  EXPECT_THAT(
      tests::FaultOf([&] { return sky.Radiance(of.eyes[0], of.views, of.suns[0], two), 0; }),
      HasSubstr("views has 3 values for 2 rays"));
  EXPECT_THAT(
      tests::FaultOf([&] { return sky.Radiance(of.eyes[0], of.views, of.suns[0], odd), 0; }),
      HasSubstr("the result has"));
  EXPECT_THAT(tests::FaultOf(
                  [&] { return sky.Between(of.eyes[0], of.objects, of.suns[0], three, two), 0; }),
              HasSubstr("the results have"));
  std::vector<float> none;
  EXPECT_NO_THROW(sky.Radiance(std::vector<LocalPoint>(), of.views[0], of.suns[0], none));
  std::vector<Sunlight> suns = of.suns;
  suns[2].distance_au = 0.0;
  EXPECT_THAT(tests::FaultOf([&] { return sky.Radiance(of.eyes, of.views, suns, three), 0; }),
              HasSubstr("sun.distance_au is 0"));
}

}  // namespace
}  // namespace alpenglow
