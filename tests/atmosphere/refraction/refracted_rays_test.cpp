// SPDX-License-Identifier: MIT
// Refracted rays, light of the sun's disk on ground at any height, and the lift of land and planet
// as shaders have it are compared with the ray equation and with integration along bent rays.
#include "atmosphere/refraction/refracted_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "atmosphere/ray/shell.h"
#include "atmosphere/reference/reference_solution.h"
#include "tests/fixtures/bands_near.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/refracted_twilight.h"

namespace alpenglow::atmosphere {
namespace {

using reference::PeckAndReeder;
using reference::RayEquation;

constexpr double kDegree = kRadiansPerDegree;
constexpr double kMinute = kRadiansPerDegree / 60.0;

constexpr std::array kHeights_m{0.0, 2.0, 100.0, 3000.0, 12e3, 40e3, 110e3, 400e3, 36e6};

TEST(RefractedView, ApparentElevationFollowsTheRayEquation) {
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

TEST(RefractedView, FlatteningOfTheSettingDiskFollowsTheRayEquation) {
  const Medium medium = MediumPreset("earth");
  const RayEquation equation(medium, PeckAndReeder(kHorizonWavelength_nm));
  constexpr double kDiameter = 32.0 * kMinute;
  for (const double height : {2.0, 3000.0, 12e3}) {
    const RefractedView view(medium, height);
    const double horizon = view.horizon_rad();
    // The lower limb stands on the horizon, the upper where the equation finds what is as much
    // higher.
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

TEST(RefractedView, UpperRimIsGreenAndBlueByDispersion) {
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

TEST(RefractedView, HorizonFollowsTheRayEquation) {
  const Medium medium = MediumPreset("earth");
  const RayEquation equation(medium, PeckAndReeder(kHorizonWavelength_nm));
  for (const double height : {2.0, 100.0, 3000.0, 12e3, 400e3}) {
    const RefractedView view(medium, height);
    const double little = 0.02 * kMinute;
    EXPECT_FALSE(equation.Follow(view.horizon_rad() + little, height).is_ground) << height;
    EXPECT_TRUE(equation.Follow(view.horizon_rad() - little, height).is_ground) << height;
    const double geometric = -std::acos(medium.planet_radius_m / (medium.planet_radius_m + height));
    EXPECT_GT(view.horizon_rad(), geometric) << "air lifts the horizon";
    // This ray is almost as long as that to the horizon, but not almost level.
    const double below = view.horizon_rad() - 0.01 * std::max(-view.horizon_rad(), 1e-3);
    const auto ground = view.ToGround(below);
    ASSERT_TRUE(ground);
    const auto found = equation.Follow(below, height);
    ASSERT_TRUE(found.is_ground);
    EXPECT_NEAR(ground->angle_rad / found.angle_rad, 1.0, 0.002) << height << " m";
  }
}

TEST(RefractedView, NearbyGroundIsWhereStraightRaysMeetIt) {
  const Medium medium = MediumPreset("earth");
  const RefractedView view(medium, 2.0);
  for (const double degrees : {-10.0, -45.0, -89.0}) {
    const double range_m = view.ToGround(degrees * kDegree)->angle_rad * medium.planet_radius_m;
    EXPECT_NEAR(range_m, 2.0 / std::tan(-degrees * kDegree), 1e-3) << degrees << ": a millimetre";
  }
  EXPECT_FALSE(view.ToGround(0.01)) << "the sky";
}

TEST(RefractedView, SunlightHasTheColumnOfTheRefractedRay) {
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

TEST(RefractedView, WithoutAirRaysAreStraight) {
  Medium medium = MediumPreset("earth");
  for (double& scattering : medium.rayleigh_scattering_per_m) scattering = 0.0;
  const RefractedView view(medium, 1000.0);
  EXPECT_EQ(view.TrueElevation(0.3, 0), 0.3);
  EXPECT_NEAR(view.horizon_rad(),
              -std::acos(medium.planet_radius_m / (medium.planet_radius_m + 1000.0)), 1e-12);
  EXPECT_EQ(view.MoreOpticalDepth(0.0, 0), 0.0);
}

TEST(RefractedView, RaysAreStraightInAirThatWouldTrapThem) {
  Medium medium = MediumPreset("earth");
  medium.rayleigh_scale_height_m = 500.0;
  medium.rayleigh_deficit = {};
  medium.refraction = RefractionBy::kMolecules;
  EXPECT_FALSE(GentlyBends(BendingAirOf(medium, 550.0)));
  EXPECT_EQ(RefractedView(medium, 2.0).TrueElevation(0.0, 0), 0.0);
}

constexpr std::array kLitHeights_m{0.0, 3000.0, 8000.0};
constexpr std::array kSunElevations_deg{0.1, 0.3, 1.0, 2.0, 5.0, 10.0};

Medium EarthOfThreeBands() { return MediumPreset("earth", {450.0, 550.0, 650.0}); }

TEST(RefractedBeam, AgreesWithTheRayEquationInMoleculesToOnePercent) {
  const Medium medium = tests::MoleculesOf(EarthOfThreeBands());
  const SingleScattering<float> air(medium);
  const RefractedBeam beam(medium);
  const RayEquation equation(medium, PeckAndReeder(kHorizonWavelength_nm));
  for (const double height_m : kLitHeights_m) {
    for (const double elevation_deg : kSunElevations_deg) {
      constexpr double kStep = 2e-4;
      const double seen = elevation_deg * kRadiansPerDegree;
      const auto found = equation.Follow(seen, height_m);
      const double slope = (equation.Follow(seen + kStep, height_m).refraction_rad -
                            equation.Follow(seen - kStep, height_m).refraction_rad) /
                           (2.0 * kStep);
      const double spread = std::cos(seen) / std::cos(seen - found.refraction_rad) / (1.0 - slope);
      const Spectrum left = beam.Left(air, height_m, std::sin(seen));
      for (std::size_t band = 0; band < 3; ++band) {
        const double expected =
            spread * std::exp(-medium.rayleigh_scattering_per_m[band] * found.column_m);
        // Columns of bent rays are good to 2e-3, which is 0.8 % of blue light through a depth of 4
        // on the horizon; the table adds its interpolation.
        EXPECT_NEAR(static_cast<double>(left[band]) / expected, 1.0, 0.01)
            << height_m << " m, " << elevation_deg << " degrees, band " << band;
      }
    }
  }
}

TEST(RefractedBeam, AgreesWithRefractedRaysToTwoPercent) {
  const Medium medium = EarthOfThreeBands();
  const SingleScattering<float> air(medium);
  const RefractedBeam beam(medium);
  for (const double height_m : kLitHeights_m) {
    const tests::RefractedTwilight rays(medium, height_m);
    for (const double elevation_deg : kSunElevations_deg) {
      const double seen = elevation_deg * kRadiansPerDegree;
      EXPECT_TRUE(tests::BandsNear(beam.Left(air, height_m, std::sin(seen)),
                                   rays.Beam(seen, height_m), 0.02))
          << "ozone takes up to 1.4 % more of green along a bent ray; " << height_m << " m, "
          << elevation_deg << " degrees";
    }
  }
}

TEST(RefractedBeam, InterpolatedValuesAgreeWithRaysToThreePercent) {
  const Medium medium = EarthOfThreeBands();
  const SingleScattering<float> air(medium);
  const RefractedBeam beam(medium);
  for (const double height_m : {20.0, 200.0, 700.0, 1500.0, 5500.0, 11e3}) {
    const tests::RefractedTwilight rays(medium, height_m);
    const double horizon_rad = GrazingElevation(GentleAirOf(medium), height_m);
    for (const double over_deg : {0.3, 0.5, 1.1, 3.0, 20.0}) {
      const double seen = horizon_rad + over_deg * kRadiansPerDegree;
      EXPECT_TRUE(tests::BandsNear(beam.Left(air, height_m, std::sin(seen)),
                                   rays.Beam(seen, height_m), 0.03))
          << "linear between nodes of columns; " << height_m << " m, " << over_deg
          << " degrees over the horizon";
    }
  }
}

TEST(RefractedBeam, FadesSmoothlyAsTheSunSinks) {
  // A sun that sinks by a minute of arc: what is left falls by a share that changes by a tenth of
  // itself at most from each to the next, or by 1e-3 high up where it hardly falls.
  const Medium medium = EarthOfThreeBands();
  const SingleScattering<float> air(medium);
  const RefractedBeam beam(medium);
  for (const double height_m : kLitHeights_m) {
    const auto log_at = [&](double minutes) {
      return std::log(
          static_cast<double>(beam.Left(air, height_m, std::sin(minutes * kMinute))[2]));
    };
    double before = log_at(600.0) - log_at(599.0);
    for (double minutes = 599.0; minutes > 0.0; minutes -= 1.0) {
      const double fall = log_at(minutes) - log_at(minutes - 1.0);
      EXPECT_GT(fall, 0.0) << height_m << " m, " << minutes;
      EXPECT_NEAR(fall, before, std::max(0.1 * before, 1e-3)) << height_m << " m, " << minutes;
      before = fall;
    }
  }
}

TEST(RefractedBeam, EqualsStraightRaysWithoutRefraction) {
  Medium medium = EarthOfThreeBands();
  medium.rayleigh_scattering_per_m.assign(3, 0.0);
  const SingleScattering<float> air(medium);
  EXPECT_EQ(RefractedBeam(medium).Left(air, 100.0, 0.01), air.TransmittanceToSpace(100.0, 0.01));
}

TEST(RefractedBeam, IsNeverBrighterThanStraightRays) {
  const Medium medium = EarthOfThreeBands();
  const RefractedBeam beam(medium);
  for (const double height_m : {-50.0, 0.0, 9e3, 39e3, 41e3, 99e3, 400e3}) {
    for (const double mu : {-1.0, -0.05, 0.0, 0.01, 0.3, 1.0}) {
      const Spectrum over = beam.OverStraight(height_m, mu);
      for (std::size_t band = 0; band < 3; ++band) {
        EXPECT_GE(over[band], 0.0F) << height_m << " m, " << mu;
        EXPECT_LE(over[band], 1.0F) << height_m << " m, " << mu;
      }
    }
  }
}

struct LandSight {
  double distance_m, place_m, lift_rad;
};

/// Returns where a ray of the equation is after a way, seen from the eye.
LandSight SightAlong(const Medium& medium, double elevation_rad, double eye_m, double way_m) {
  const RayEquation equation(medium, PeckAndReeder(kHorizonWavelength_nm));
  const auto end = equation.Follow(elevation_rad, eye_m, way_m);
  const double up_m = end.state.y - medium.planet_radius_m - eye_m;
  return {std::hypot(end.state.x, up_m),
          std::hypot(end.state.x, end.state.y) - medium.planet_radius_m,
          elevation_rad - std::atan2(up_m, end.state.x)};
}

TEST(LandLift, FollowsTheRayEquationFromEveryHeight) {
  const Medium medium = MediumPreset("earth");
  constexpr double kHighestLand_m = 9000.0;
  for (const double eye_m : {2.0, 100.0, 1e3, 3e3, 8e3, 12e3, 16e3, 25e3, 40e3, 100e3, 400e3}) {
    const BendingAir air = GentleAirOf(medium);
    const LandBend bend = LandBendOf(air, eye_m);
    const double horizon_m = std::sqrt(eye_m * (eye_m + 2.0 * medium.planet_radius_m));
    int seen = 0;
    for (const double over_minutes : {0.1, 2.0, 10.0, 40.0}) {
      const double elevation = GrazingElevation(air, eye_m) + over_minutes * kMinute;
      for (double way_m = 20e3; way_m < horizon_m + 350e3; way_m += std::max(20e3, 0.05 * way_m)) {
        const LandSight sight = SightAlong(medium, elevation, eye_m, way_m);
        if (sight.place_m > kHighestLand_m || sight.place_m < 0.0) continue;
        ++seen;
        EXPECT_NEAR(LiftOfLand(bend, eye_m, sight.place_m, sight.distance_m) / kMinute,
                    sight.lift_rad / kMinute, eye_m <= 16e3 ? 0.3 : 0.5)
            << "the bounds of LiftOfLand; eye " << eye_m << " m, " << over_minutes
            << "' over the horizon, " << sight.place_m << " m high, " << sight.distance_m
            << " m away";
      }
    }
    EXPECT_GT(seen, 3) << eye_m;
  }
}

TEST(LandLift, OfAMountain100KilometresAwayIsFourArcminutes) {
  const LandBend bend = LandBendOf(GentleAirOf(MediumPreset("earth")), 500.0);
  EXPECT_NEAR(LiftOfLand(bend, 500.0, 4000.0, 100e3) / kMinute, 4.2, 0.3)
      << "half of 100 km times the curvature, a sixth of the earth's";
}

TEST(LandLift, LargestLiftCoversLandAndHorizon) {
  const Medium medium = MediumPreset("earth");
  const BendingAir air = GentleAirOf(medium);
  for (const double eye_m : {2.0, 1e3, 12e3, 400e3}) {
    const LandBend bend = LandBendOf(air, eye_m);
    const double geometric_rad =
        -std::acos(medium.planet_radius_m / (medium.planet_radius_m + eye_m));
    constexpr double kFarthest_m = 60e3;
    const double most_rad = MostLiftOfPlanet(bend, eye_m, kFarthest_m);
    EXPECT_GT(most_rad, GrazingElevation(air, eye_m) - geometric_rad - 0.01 * kMinute) << eye_m;
    for (const double place_m : {0.0, 1e3, 3e3})
      EXPECT_GE(most_rad, LiftOfLand(bend, eye_m, place_m, 30e3)) << eye_m << ", " << place_m;
  }
  const double half_curved_rad = -0.5 * 60e3 * CurvaturePerMetreAt(air, 0.0);
  EXPECT_NEAR(MostLiftOfPlanet(LandBendOf(air, 2.0), 2.0, 60e3) / half_curved_rad, 1.0, 0.05)
      << "half of 60 km times the curvature at the ground, which the horizon 5 km away does not "
         "reach";
}

TEST(LandLift, IsZeroWithoutAir) {
  BendingAir air = GentleAirOf(MediumPreset("earth"));
  air.refractivity = 0.0;
  const LandBend bend = LandBendOf(air, 3000.0);
  EXPECT_EQ(LiftOfLand(bend, 3000.0, 1000.0, 150e3), 0.0);
  EXPECT_NEAR(MostLiftOfPlanet(bend, 3000.0, 150e3), 0.0, 1e-9);
  EXPECT_NEAR(bend.look_radius_km, bend.radius_km, 1e-3) << "a metre";
}

TEST(LandLift, ApparentPlanetHasTheRefractedHorizon) {
  const Medium medium = MediumPreset("earth");
  const RayEquation equation(medium, PeckAndReeder(kHorizonWavelength_nm));
  for (const double eye_m : {2.0, 100.0, 3e3, 12e3, 400e3}) {
    const LandBend bend = LandBendOf(GentleAirOf(medium), eye_m);
    const double horizon_rad =
        std::asin(shared::HorizonCosine(eye_m / kMetresPerKilometre, bend.look_radius_km));
    constexpr double kLittle = 0.02 * kMinute;
    EXPECT_FALSE(equation.Follow(horizon_rad + kLittle, eye_m).is_ground) << eye_m;
    EXPECT_TRUE(equation.Follow(horizon_rad - kLittle, eye_m).is_ground) << eye_m;
    // The ground is half way to the horizon, along a straight line to the planet as it looks.
    const double elevation = 1.3 * horizon_rad;
    const auto found = equation.Follow(elevation, eye_m);
    const double away_m = std::hypot(found.state.x, found.state.y - medium.planet_radius_m - eye_m);
    EXPECT_NEAR(shared::DistanceDownTo(eye_m / kMetresPerKilometre, std::sin(elevation), 0.0,
                                       bend.look_radius_km) *
                    kMetresPerKilometre / away_m,
                1.0, 0.03)
        << eye_m;
  }
}

}  // namespace
}  // namespace alpenglow::atmosphere
