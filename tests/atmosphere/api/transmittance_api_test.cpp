// SPDX-License-Identifier: MIT
// The transmittance of the public atmosphere, against numerical integration.
#include <alpenglow/atmosphere.h>
#include <alpenglow/errors.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "atmosphere/api/local_rays.h"
#include "atmosphere/reference/reference_solution.h"
#include "tests/fixtures/fault_of.h"

namespace alpenglow {
namespace {

constexpr LocalPoint kTower{.east_m = 30.0, .up_m = 250.0};

TEST(Transmittance, AgreesWithIntegration) {
  for (const char* const preset : {"earth", "mars"}) {
    const Atmosphere air = Atmosphere::Preset(preset);
    for (const double elevation_deg : {90.0, 30.0, 5.0, 0.0, -0.3}) {
      for (const double distance_m : {1e3, 80e3, std::numeric_limits<double>::infinity()}) {
        const Direction direction = DirectionFromAngles(elevation_deg, 70.0);
        const glm::dvec3 along = UnitVectorOf(direction);
        const auto depth = atmosphere::reference::OpticalDepthAlong(
            air.medium(),
            RayFrom(AltitudeOf(kTower, air.planet_radius_m()), along, along, distance_m));
        const Spectrum found = air.Transmittance(kTower, direction, distance_m);
        for (std::size_t band = 0; band < found.size(); ++band) {
          const double expected = std::exp(-depth.tau[band]);
          EXPECT_NEAR(double{found[band]}, expected, 6e-6 * depth.tau[band] * expected + 1e-7)
              << preset << ", " << elevation_deg << ", " << distance_m;
        }
      }
    }
  }
}

TEST(Transmittance, IsZeroThroughTheGround) {
  const Atmosphere air;
  const Direction down = DirectionFromAngles(-5.0, 0.0);
  EXPECT_EQ(air.Transmittance(kTower, down)[0], 0.0F);
  EXPECT_GT(air.Transmittance(kTower, down, 1000.0)[0], 0.5F);
  EXPECT_EQ(air.Transmittance(kTower, down, 0.0)[0], 1.0F);
  EXPECT_EQ(air.Transmittance({.up_m = 1e9}, {.up = 1.0})[0], 1.0F) << "space";
}

TEST(Transmittance, OfManyRaysEqualsThatOfSingleRays) {
  const Atmosphere air = Atmosphere::Preset("earth", {400.0, 500.0, 600.0, 700.0, 800.0});
  const std::vector<Direction> directions{{.up = 1.0}, {.east = 1.0}, {.north = 1.0, .up = 0.1}};
  const std::vector<double> distances_m{1e3, std::numeric_limits<double>::infinity(), 2e4};
  std::vector<float> result(15);
  air.Transmittance(kTower, directions, distances_m, result);
  for (std::size_t ray = 0; ray < 3; ++ray) {
    const Spectrum one = air.Transmittance(kTower, directions[ray], distances_m[ray]);
    for (std::size_t band = 0; band < 5; ++band) EXPECT_EQ(result[5 * ray + band], one[band]);
  }
}

TEST(Transmittance, OfImpossibleRaysIsRefused) {
  const Atmosphere air;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)air.Transmittance(kTower, {.up = 0.0}), InputError);
  EXPECT_THROW((void)air.Transmittance({.up_m = kNan}, {}), InputError);
  for (const double distance_m : {-1.0, kNan}) {
    EXPECT_THAT(tests::FaultOf([&] { return air.Transmittance(kTower, {}, distance_m); }),
                testing::HasSubstr("distance_m is"));
  }
  std::vector<float> result(7);
  EXPECT_THROW(air.Transmittance(kTower, Direction{}, 1.0, result), InputError);
}

}  // namespace
}  // namespace alpenglow
