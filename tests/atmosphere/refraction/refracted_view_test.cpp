// SPDX-License-Identifier: MIT
// Refracted rays against the ray equation.
#include "atmosphere/refraction/refracted_view.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "atmosphere/reference/reference_solution.h"

namespace alpenglow::atmosphere {
namespace {

using reference::PeckAndReeder;
using reference::RayEquation;

constexpr double kDegree = kRadiansPerDegree;
constexpr double kMinute = kRadiansPerDegree / 60.0;

constexpr std::array kHeights_m{0.0, 2.0, 100.0, 3000.0, 12e3, 40e3, 110e3, 400e3, 36e6};

TEST(RefractedView, ApparentElevationIsThatOfTheRayEquationFromTheHorizonUpAtEveryHeight) {
  const Medium medium = MediumPreset("earth");
  for (const double height : kHeights_m) {
    const RefractedView view(medium, height);
    for (const double over : {0.01, 0.1, 0.3, 1.0, 4.0, 15.0, 60.0}) {
      const double elevation = view.horizon_rad() + over * kDegree;
      for (const std::size_t band : {std::size_t{0}, medium.wavelengths_nm.size() - 1}) {
        const RayEquation equation(medium, PeckAndReeder(medium.wavelengths_nm[band]));
        const double refraction = equation.Follow(elevation, height).refraction_rad;
        EXPECT_NEAR((elevation - view.TrueElevation(elevation, band)) / kMinute,
                    refraction / kMinute, 0.1)
            << "a tenth of an arcminute; blue and red have horizons of their own below 0.01 "
               "degrees; "
            << height << " m, " << over << " degrees over the horizon, band " << band;
      }
    }
  }
}

TEST(RefractedView, TheSettingDiskIsAsFlatAsByTheRayEquation) {
  const Medium medium = MediumPreset("earth");
  const RayEquation equation(medium, PeckAndReeder(kHorizonWavelength_nm));
  constexpr double kDiameter = 32.0 * kMinute;
  for (const double height : {2.0, 3000.0, 12e3}) {
    const RefractedView view(medium, height);
    const double horizon = view.horizon_rad();
    // The lower limb stands on the horizon, the upper where the reference solution finds what is as much higher.
    const double lower = horizon + 1e-3 * kMinute;
    const double truly = lower - equation.Follow(lower, height).refraction_rad + kDiameter;
    double upper = lower + kDiameter;
    for (int i = 0; i < 12; ++i) upper = truly + equation.Follow(upper, height).refraction_rad;
    const double flat =
        (view.ApparentElevationOf(view.TrueElevation(lower) + kDiameter) - lower) / kDiameter;
    EXPECT_NEAR(flat, (upper - lower) / kDiameter, 0.002) << height << " m";
    EXPECT_LT(flat, 0.91) << "to be seen with the naked eye";
  }
}

TEST(RefractedView, TheUpperRimIsGreenAndBlueByTheDispersionOfAir) {
  const RefractedView view(MediumPreset("earth", {450.0, 550.0, 650.0}), 2.0);
  // Young (2000), Optics and Photonics News 11(3), 31-37: at the horizon green is lifted by some 10
  // to 20 arcseconds over red.
  const double red_to_green =
      view.TrueElevation(view.horizon_rad(), 2) - view.TrueElevation(view.horizon_rad(), 1);
  const double green_to_blue =
      view.TrueElevation(view.horizon_rad(), 1) - view.TrueElevation(view.horizon_rad(), 0);
  EXPECT_NEAR(red_to_green * 60.0 / kMinute, 13.0, 5.0);
  EXPECT_GT(green_to_blue, red_to_green);
}

TEST(RefractedView, TheHorizonLiesWhereRaysOfTheEquationJustMissTheGround) {
  const Medium medium = MediumPreset("earth");
  const RayEquation equation(medium, PeckAndReeder(kHorizonWavelength_nm));
  for (const double height : {2.0, 100.0, 3000.0, 12e3, 400e3}) {
    const RefractedView view(medium, height);
    const double little = 0.02 * kMinute;
    EXPECT_FALSE(equation.Follow(view.horizon_rad() + little, height).is_ground) << height;
    EXPECT_TRUE(equation.Follow(view.horizon_rad() - little, height).is_ground) << height;
    const double geometric = -std::acos(medium.planet_radius_m / (medium.planet_radius_m + height));
    EXPECT_GT(view.horizon_rad(), geometric) << "air lifts the horizon";
    // As far as the horizon but for where the ray is almost level.
    const double below = view.horizon_rad() - 0.01 * std::max(-view.horizon_rad(), 1e-3);
    const auto ground = view.ToGround(below);
    ASSERT_TRUE(ground);
    const auto found = equation.Follow(below, height);
    ASSERT_TRUE(found.is_ground);
    EXPECT_NEAR(ground->angle_rad / found.angle_rad, 1.0, 0.002) << height << " m";
  }
}

TEST(RefractedView, GroundNearByIsWhereStraightRaysFindIt) {
  const Medium medium = MediumPreset("earth");
  const RefractedView view(medium, 2.0);
  for (const double degrees : {-10.0, -45.0, -89.0}) {
    const double range_m = view.ToGround(degrees * kDegree)->angle_rad * medium.planet_radius_m;
    EXPECT_NEAR(range_m, 2.0 / std::tan(-degrees * kDegree), 1e-3) << degrees << ": a millimetre";
  }
  EXPECT_FALSE(view.ToGround(0.01)) << "the sky";
}

TEST(RefractedView, TheSunShinesThroughTheColumnOfTheRefractedRay) {
  const Medium medium = MediumPreset("earth");
  const RayEquation equation(medium, PeckAndReeder(kHorizonWavelength_nm)), straight(medium, 0.0);
  Medium clear = medium;
  clear.mie_extinction_per_m.assign(medium.wavelengths_nm.size(), 0.0);
  for (const double height : {2.0, 3000.0, 40e3}) {
    const RefractedView view(clear, height);
    for (const double over : {0.01, 0.5, 2.0, 6.0}) {
      const double elevation = view.horizon_rad() + over * kDegree;
      const double refracted_m = equation.Follow(elevation, height).column_m;
      const double more_m = refracted_m - straight.Follow(elevation, height).column_m;
      EXPECT_NEAR(view.MoreOpticalDepth(elevation, 0) / medium.rayleigh_scattering_per_m[0], more_m,
                  0.002 * refracted_m)
          << height << " m, " << over << " degrees over the horizon";
    }
  }
}

TEST(RefractedView, NoAirBendsNothing) {
  Medium medium = MediumPreset("earth");
  for (double& scattering : medium.rayleigh_scattering_per_m) scattering = 0.0;
  const RefractedView view(medium, 1000.0);
  EXPECT_EQ(view.TrueElevation(0.3, 0), 0.3);
  EXPECT_NEAR(view.horizon_rad(),
              -std::acos(medium.planet_radius_m / (medium.planet_radius_m + 1000.0)), 1e-12);
  EXPECT_EQ(view.MoreOpticalDepth(0.0, 0), 0.0);
}

TEST(RefractedView, AirThatWouldTrapRaysIsTakenToBendNone) {
  Medium medium = MediumPreset("earth");
  medium.rayleigh_scale_height_m = 500.0;
  medium.rayleigh_deficit = {};
  medium.refraction = RefractionBy::kMolecules;
  EXPECT_FALSE(GentlyBends(BendingAirOf(medium, 550.0)));
  EXPECT_EQ(RefractedView(medium, 2.0).TrueElevation(0.0, 0), 0.0);
}

}  // namespace
}  // namespace alpenglow::atmosphere
