// SPDX-License-Identifier: MIT
// The map of a low sun against beams that are followed one by one.
#include "renderer/cloud_light/cloud_low_sun_map.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "renderer/clouds/cloud_generator.h"
#include "tests/fixtures/directions.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/sphere_clouds.h"

namespace alpenglow::renderer {
namespace {

constexpr CloudLowSunOptions kShadeOfMap{.step_m = 10.0, .farthest_m = 180e3, .full_m = 60e3};

glm::dvec3 SunOfLowMap(double elevation_deg, double azimuth_deg) {
  return tests::DirectionAt(elevation_deg, azimuth_deg);
}

/// A field of cumulus, with a period of 5.12 km.
const CloudField& CumulusOfLowMap() {
  static const CloudField kField = [] {
    CloudOptions options = DefaultCloudOptions(CloudGenus::kCumulus);
    options.cover = 0.4;
    options.period_m = 5120.0;
    return MakeCloudField(options);
  }();
  return kField;
}

/// Means over points by beams and by the map, and the root mean square of their differences.
struct LowMapMeans {
  void Add(double beam, double map) {
    ++count;
    beams += (beam - beams) / count;
    by_map += (map - by_map) / count;
    squares += (beam - map) * (beam - map);
  }
  [[nodiscard]] double Scatter() const { return std::sqrt(squares / count); }
  /// Returns the error of the mean difference of points that are drawn independently.
  [[nodiscard]] double Error() const { return std::sqrt(squares) / count; }

  double count = 0.0, beams = 0.0, by_map = 0.0, squares = 0.0;
};

/// Returns a point of a period, moved towards the sun by a distance.
glm::dvec3 PointOfLowMap(const CloudField& field, int i, const glm::dvec2& offset_m) {
  const glm::dvec3 size = field.lattice().size_m();
  const double low_m = field.base_altitude_m(), depth_m = field.top_altitude_m() - low_m;
  return {field.lattice().origin_m.x + size.x * Halton(i, 2) + offset_m.x,
          field.lattice().origin_m.y + size.y * Halton(i, 3) + offset_m.y,
          low_m + depth_m * Halton(i, 5)};
}

struct LowMapCase {
  double elevation_deg, azimuth_deg, towards_m;

  [[nodiscard]] glm::dvec2 offset_m() const {
    return towards_m * glm::dvec2(SunOfLowMap(0.0, azimuth_deg));
  }
};
constexpr std::array kLowMapCases{LowMapCase{2.6, 20.0, 0.0}, LowMapCase{1.0, 120.0, 40e3},
                                  LowMapCase{0.5, -75.0, -20e3}};

TEST(CloudLowSunMap, TransmittancesOfCumulusAreThoseOfBeams) {
  const CloudField& field = CumulusOfLowMap();
  for (const LowMapCase& of : kLowMapCases) {
    const CloudLowSun sun(field, SunOfLowMap(of.elevation_deg, of.azimuth_deg), kShadeOfMap);
    const CloudLowSunMap map(field, sun);
    LowMapMeans at_points, around;
    for (int i = 1; i <= tests::ScaledDown(8000, 800); ++i) {
      const glm::dvec3 point = PointOfLowMap(field, i, of.offset_m());
      const double beam = std::exp(-sun.OpticalDepth(point));
      at_points.Add(beam, map.Transmittance(point));
      around.Add(beam, map.TransmittanceAround(point));
    }
    EXPECT_NEAR(at_points.by_map, at_points.beams, 0.01 * at_points.beams + 3.0 * at_points.Error())
        << of.elevation_deg << " degrees";
    EXPECT_NEAR(around.by_map, around.beams, 0.02 * around.beams + 3.0 * around.Error())
        << of.elevation_deg << " degrees";
    EXPECT_LT(at_points.Error(), 0.03 * at_points.beams) << "the test must be able to fail";
    EXPECT_LT(at_points.Scatter(), 0.15) << of.elevation_deg << " degrees";
  }
}

TEST(CloudLowSunMap, DepthsInCumulusAreThoseOfBeams) {
  const CloudField& field = CumulusOfLowMap();
  for (const LowMapCase& of : kLowMapCases) {
    const CloudLowSun sun(field, SunOfLowMap(of.elevation_deg, of.azimuth_deg), kShadeOfMap);
    const CloudLowSunMap map(field, sun);
    LowMapMeans light, roots;
    for (int i = 1; light.count < tests::ScaledDown(8000.0, 400.0); ++i) {
      const glm::dvec3 point = PointOfLowMap(field, i, of.offset_m());
      if (field.Extinction_per_m(point) <= 0.0) continue;
      const double beam = sun.OpticalDepth(point), found = map.OpticalDepth(point);
      light.Add(std::exp(-beam), std::exp(-found));
      roots.Add(std::exp(-0.5 * beam), std::exp(-0.5 * found));
    }
    EXPECT_LT(light.Scatter(), 0.03) << of.elevation_deg << " degrees";
    EXPECT_NEAR(roots.by_map, roots.beams, 0.05 * roots.beams + 3.0 * roots.Error())
        << of.elevation_deg << " degrees";
  }
}

// A sun below the horizontal: beams sink out of the layer, and some return.
TEST(CloudLowSunMap, BeamsThatReturnAreThoseFollowed) {
  const CloudField field = tests::SphereClouds(0.004);
  for (const double elevation_deg : {-0.2, -0.6, -1.5}) {
    const CloudLowSun sun(field, SunOfLowMap(elevation_deg, 200.0), kShadeOfMap);
    const CloudLowSunMap map(field, sun);
    LowMapMeans inside, below, around;
    for (int i = 1; i <= tests::ScaledDown(3000, 300); ++i) {
      const glm::dvec3 point = PointOfLowMap(field, i, glm::dvec2(0.0));
      const double beam = std::exp(-sun.OpticalDepth(point));
      inside.Add(beam, map.Transmittance(point));
      around.Add(beam, map.TransmittanceAround(point));
      const glm::dvec3 lower = point - glm::dvec3(0.0, 0.0, 500.0);
      below.Add(std::exp(-sun.OpticalDepth(lower)), map.Transmittance(lower));
    }
    // Two thirds of the beams are lit, in stripes that are as fine as the cells.
    EXPECT_NEAR(inside.by_map, inside.beams, 0.01 + 3.0 * inside.Error()) << elevation_deg;
    EXPECT_NEAR(around.by_map, around.beams, 0.01 + 3.0 * around.Error()) << elevation_deg;
    EXPECT_NEAR(below.by_map, below.beams, 0.01 + 3.0 * below.Error()) << elevation_deg;
  }
}

TEST(CloudLowSunMap, PlaneLayerHasTheLightOfItsBeams) {
  const CloudField field = tests::PlaneLayer(0.04);
  for (const double elevation_deg : {3.0, 1.0, 0.0, -0.5}) {
    const CloudLowSun sun(field, SunOfLowMap(elevation_deg, 65.0), kShadeOfMap);
    const CloudLowSunMap map(field, sun);
    for (const double altitude_m : {200.0, 1001.0, 1100.0, 1300.0, 3000.0}) {
      const glm::dvec3 point(30.0, 40.0, altitude_m);
      // Rows are 20 m high: the way of a beam that grazes the top grows with the root of the depth below
      // it, which is not linear there.
      EXPECT_NEAR(map.Transmittance(point), std::exp(-sun.OpticalDepth(point)), 0.02)
          << elevation_deg << " degrees at " << altitude_m << " m";
    }
  }
}

TEST(CloudLowSunMap, PeriodicDepthsRepeat) {
  const CloudField& field = CumulusOfLowMap();
  const CloudLowSunMap map(field, CloudLowSun(field, SunOfLowMap(2.0, 20.0), kShadeOfMap));
  for (int i = 1; i <= 100; ++i) {
    const glm::dvec3 point = PointOfLowMap(field, i, glm::dvec2(0.0));
    EXPECT_NEAR(map.OpticalDepthAsAtPlace(point + glm::dvec3(3.0 * 5120.0, -5120.0, 0.0)),
                map.OpticalDepthAsAtPlace(point), 1e-4)
        << "rounding of floats";
  }
}

// The slope of the sun where the map ends is that where beams begin to be followed.
TEST(CloudLowSunMap, PointsOutOfReachHaveTheirBeams) {
  const CloudField field = tests::SphereClouds(0.004);
  const CloudLowSun sun(field, SunOfLowMap(1.0, 0.0), kShadeOfMap);
  const CloudLowSunMap map(field, sun);
  const glm::dvec3 far(250e3, 0.0, 1200.0);
  EXPECT_EQ(map.OpticalDepth(far), sun.OpticalDepth(far));
  EXPECT_EQ(map.TransmittanceAround(far), std::exp(-sun.OpticalDepth(far)));
}

TEST(CloudLowSunMap, OpenFieldsHaveTheirBeams) {
  const CloudField field = tests::SphereClouds(0.02, false);
  const CloudLowSun sun(field, SunOfLowMap(2.0, 20.0), kShadeOfMap);
  const CloudLowSunMap map(field, sun);
  EXPECT_EQ(map.bytes(), 0U);
  for (int i = 1; i <= 50; ++i) {
    const glm::dvec3 point = PointOfLowMap(field, i, glm::dvec2(0.0));
    EXPECT_EQ(map.OpticalDepth(point), sun.OpticalDepth(point));
  }
}

TEST(CloudLowSunMap, DoesNotDependOnTheNumberOfThreads) {
  const CloudField field = tests::SphereClouds(0.02);
  const CloudLowSun sun(field, SunOfLowMap(1.0, 20.0), kShadeOfMap);
  const CloudLowSunMap many(field, sun, {.plane_m = 1000.0});
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(CloudLowSunMap(field, sun, {.plane_m = 1000.0}).hash(), many.hash());
}

TEST(CloudLowSunMap, RefusesOptionsOutOfRange) {
  const CloudField field = tests::SphereClouds(0.02);
  const CloudLowSun sun(field, SunOfLowMap(1.0, 20.0), kShadeOfMap);
  EXPECT_THROW(CloudLowSunMap(field, sun, {.cell_m = 4.0}), InputError);
  EXPECT_THROW(CloudLowSunMap(field, sun, {.plane_m = std::nan("")}), InputError);
}

}  // namespace
}  // namespace alpenglow::renderer
