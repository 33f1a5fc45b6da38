// SPDX-License-Identifier: MIT
// Closed-form columns are compared with quadrature of the densities, which is written here without
// the shared texts. Light on extreme rays is right or continuous.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/medium/medium.h"
#include "atmosphere/ray/ray.h"
#include "atmosphere/ray/shell.h"
#include "atmosphere/ray/single_scattering.h"
#include "atmosphere/shared_glsl/instruction_set.h"

namespace alpenglow::atmosphere {
namespace {

using Columns = std::array<double, 3>;

// This column [m] has an optical depth below 1e-16: aerosol at 80 km, which float holds as a
// subnormal.
constexpr double kNothing_m = 1e-12;

Medium Earth() { return MediumPreset("earth", WavelengthSet(4)); }

double OzoneDensity(const OzoneLayer& layer, double h) {
  const double y = h / layer.top_m;
  if (layer.shape == OzoneShape::kSmooth) {
    return y < 1.0 ? 2075.94140625 * std::pow(y, 4) * std::pow(1.0 - y, 8) : 0.0;
  }
  return std::fmax(0.0, std::fmin((h - layer.bottom_m) / (layer.peak_m - layer.bottom_m),
                                  (layer.top_m - h) / (layer.top_m - layer.peak_m)));
}

/// Returns columns [m] along the whole straight line from an altitude to the top, in extended
/// precision.
Columns ColumnsByQuadrature(const Medium& medium, double altitude_m, double mu) {
  const long double radius = medium.planet_radius_m;
  const long double r = radius + altitude_m;
  const auto altitude = [&](double t) {
    const long double d = t;
    return static_cast<double>(std::sqrt(r * r + 2 * r * mu * d + d * d) - radius);
  };
  std::vector<double> points{0.0};
  // The line crosses the tent's edges, the scale heights and the top here, and has its lowest
  // point.
  for (const double z :
       {medium.ozone.bottom_m, medium.ozone.peak_m, medium.ozone.top_m, 600.0, 1200.0, 2400.0,
        4800.0, 8000.0, 16000.0, 60000.0, medium.atmosphere_height_m}) {
    const long double discriminant = r * r * mu * mu - (altitude_m - z) * (r + radius + z);
    if (discriminant < 0) continue;
    for (const long double root : {-std::sqrt(discriminant), std::sqrt(discriminant)}) {
      const auto t = static_cast<double>(-r * mu + root);
      if (t > 0.0) points.push_back(t);
    }
  }
  if (mu < 0.0) points.push_back(static_cast<double>(-r * mu));
  std::sort(points.begin(), points.end());
  const auto densities = [&](double t) {
    const double h = altitude(t);
    return std::vector<double>{MoleculeDensity(medium, h), std::exp(-h / medium.mie_scale_height_m),
                               OzoneDensity(medium.ozone, h)};
  };
  const auto result = IntegrateAdaptively(densities, 3, points, 1e-12);
  return {result.value[0], result.value[1], result.value[2]};
}

/// Returns rays of all directions that do not meet the ground, with cosines that float holds
/// exactly, because the formula does not cause the rounding of other cosines.
std::vector<std::array<double, 2>> RaysToSpace(double radius_m) {
  std::vector<std::array<double, 2>> rays;
  for (const double altitude_m :
       {0.0, 0.01, 2.0, 500.0, 3000.0, 12000.0, 30000.0, 60000.0, 80000.0, 100000.0, 119000.0}) {
    for (const double mu : {1.0, 0.7, 0.3, 0.1, 0.03, 0.01, 1e-3, 1e-5, 0.0, -1e-5, -1e-3, -0.01,
                            -0.03, -0.06, -0.09, -0.13}) {
      const auto exact = static_cast<double>(static_cast<float>(mu));
      const double perigee = shared::PerigeeAltitude(altitude_m / 1000.0, exact, radius_m / 1000.0);
      if (mu >= 0.0 || perigee >= 0.0) rays.push_back({altitude_m, exact});
    }
  }
  return rays;
}

TEST(OpticalDepth, ClosedFormColumnsEqualQuadrature) {
  const Medium medium = Earth();
  const SingleScattering<double> in_double(medium);
  const SingleScattering<float> in_float(medium);
  for (const auto& [altitude_m, mu] : RaysToSpace(medium.planet_radius_m)) {
    const Columns exact = ColumnsByQuadrature(medium, altitude_m, mu);
    const std::array<double, 3> wide = in_double.ColumnsToSpace(altitude_m, mu);
    const std::array<float, 3> narrow = in_float.ColumnsToSpace(altitude_m, mu);
    for (std::size_t species = 0; species < 3; ++species) {
      SCOPED_TRACE(::testing::Message()
                   << "species " << species << " from " << altitude_m << " m along mu " << mu);
      const double bound = species == 2 ? 6e-6 : 3e-6;
      const double floor_m = species == 2 ? 1e-7 * EquivalentDepth_m(medium.ozone) : kNothing_m;
      EXPECT_NEAR(wide[species], exact[species], bound * exact[species] + floor_m)
          << "series cut after 1/X: 4e-7 to 3e-6; ten nodes through the smooth ozone, twice";
      // Near the top a column is a difference, of densities whose exponent has lost digits.
      const double narrow_bound = altitude_m > 100000.0 ? 1.5e-5 : 1.2e-5;
      EXPECT_NEAR(static_cast<double>(narrow[species]), exact[species],
                  narrow_bound * exact[species] + floor_m)
          << "and rounding of the perigee, 1.5 cm of a scale height of 1200 m";
    }
  }
}

// Hard case 9.
TEST(OpticalDepth, FloatIsRightForEveryRayInEveryInstructionSet) {
  const Medium medium = Earth();
  const SingleScattering<double> in_double(medium);
  const SingleScattering<float> in_float(medium);
  std::vector<float> altitudes, cosines;
  for (float altitude_m = 0.0F; altitude_m <= 100e3F; altitude_m += 390.625F) {
    for (int i = 0; i <= 160; ++i) {
      const float mu = std::pow(static_cast<float>(i - 40) / 120.0F, 3.0F);
      const double perigee = shared::PerigeeAltitude(double{altitude_m} / 1e3, double{mu},
                                                     medium.planet_radius_m / 1e3);
      if (mu < 0.0F && perigee < 0.0) continue;
      altitudes.push_back(altitude_m);
      cosines.push_back(mu);
    }
  }
  ASSERT_GT(cosines.size(), 30000U);
  for (const InstructionSet set : AvailableInstructionSets()) {
    const InstructionSetScope scope(set);
    const auto columns =
        in_float.ColumnsToSpace(std::span<const float>(altitudes), std::span<const float>(cosines));
    for (std::size_t i = 0; i < cosines.size(); ++i) {
      const auto exact = in_double.ColumnsToSpace(double{altitudes[i]}, double{cosines[i]});
      for (std::size_t species = 0; species < 3; ++species) {
        // Above 60 km the smooth ozone ends within float's step of the altitude.
        const double floor_m = species == 2 ? 1e-7 * EquivalentDepth_m(medium.ozone) : kNothing_m;
        ASSERT_NEAR(static_cast<double>(columns[species][i]), exact[species],
                    1.2e-5 * exact[species] + floor_m)
            << NameOf(set) << ", species " << species << " from " << altitudes[i] << " m along mu "
            << cosines[i];
      }
    }
  }
}

double Transmittance(const Medium& medium, const ViewRay& ray) {
  return SingleScattering<double>(medium).TransmittanceAlong(ray)[0];
}

double Radiance(const SingleScattering<double>& air, const ViewRay& ray) {
  return air.Inscatter(air.Scatter(air.Sample(ray, {})), ray.nu)[0];
}

// Hard case 14.
TEST(OpticalDepth, OneMillimetreHasAccurateDepthAndLight) {
  const Medium medium = Earth();
  const SingleScattering<double> air(medium);
  const SingleScattering<float> in_float(medium);
  for (const double mu : {1.0, 0.0, -0.01, -1.0}) {
    const ViewRay ray{100.0, mu, 0.5, 0.3, 1e-3};
    const double density_r = MoleculeDensity(medium, 100.0);
    const double density_m = std::exp(-100.0 / medium.mie_scale_height_m);
    const double depth = 1e-3 * (medium.rayleigh_scattering_per_m[0] * density_r +
                                 medium.mie_extinction_per_m[0] * density_m);
    EXPECT_NEAR(1.0 - air.TransmittanceAlong(ray)[0], depth, 1e-6 * depth + 2e-16)
        << "density changes by 1e-7 over a millimetre";
    const double light =
        1e-3 * air.TransmittanceToSpace(100.0, 0.5)[0] *
        (medium.rayleigh_scattering_per_m[0] * density_r * RayleighPhaseValues(medium, 0.3)[0] +
         medium.mie_scattering_per_m[0] * density_m * Phase(medium.mie_phase.front(), 0.3));
    EXPECT_NEAR(Radiance(air, ray), light, 1e-5 * light);
    const float light_in_float =
        in_float.Inscatter(in_float.Scatter(in_float.Sample(ray, {})), ray.nu)[0];
    EXPECT_NEAR(static_cast<double>(light_in_float), light, 2e-5 * light) << "no noise in float";
  }
}

// Hard case 5.
TEST(OpticalDepth, RaysOutsideTheAirAreExactlyClearAndBlack) {
  const Medium medium = Earth();
  const SingleScattering<double> air(medium);
  for (const double altitude_m : {400e3, 35786e3, 1e8}) {
    const double r = medium.planet_radius_m + altitude_m;
    const double tangent = medium.planet_radius_m + medium.atmosphere_height_m + 1.0;
    const double mu = -std::sqrt((r - tangent) * (r + tangent)) / r;
    for (const double view : {mu, 0.0, 0.5, 1.0}) {
      const ViewRay ray{altitude_m, view, 0.5, 0.3};
      EXPECT_EQ(Transmittance(medium, ray), 1.0) << altitude_m << " " << view;
      EXPECT_EQ(Radiance(air, ray), 0.0) << altitude_m << " " << view;
    }
  }
}

// Hard case 5.
TEST(OpticalDepth, LimbShinesFromSpace) {
  const Medium medium = Earth();
  const SingleScattering<double> air(medium);
  for (const double altitude_m : {400e3, 35786e3, 1e8}) {
    const double r = medium.planet_radius_m + altitude_m;
    const double tangent = medium.planet_radius_m + 20e3;
    const double mu = -std::sqrt((r - tangent) * (r + tangent)) / r;
    const ViewRay limb{altitude_m, mu, std::sqrt(1.0 - mu * mu), 0.0};
    EXPECT_GT(Radiance(air, limb), 1e-3) << altitude_m;
    EXPECT_LT(Radiance(air, limb), 1.0) << altitude_m;
  }
}

// Hard case 8.
TEST(OpticalDepth, ARayGrazingTheTopFromOutsideIsClearAndDark) {
  const Medium medium = Earth();
  const SingleScattering<double> air(medium);
  const double r = medium.planet_radius_m + 400e3;
  const double r_top = medium.planet_radius_m + medium.atmosphere_height_m;
  double mu = -std::sqrt((r - r_top) * (r + r_top)) / r;
  for (int i = 0; i < 4; ++i) mu = std::nextafter(mu, -1.0);
  for (int i = 0; i < 8; ++i, mu = std::nextafter(mu, 1.0)) {
    const ViewRay ray{400e3, mu, 0.5, 0.3};
    EXPECT_NEAR(Transmittance(medium, ray), 1.0, 1e-9);
    EXPECT_NEAR(Radiance(air, ray), 0.0, 1e-9);
    EXPECT_GE(Radiance(air, ray), 0.0);
  }
}

// Hard case 4.
TEST(OpticalDepth, IsContinuousThroughTheTop) {
  const Medium medium = Earth();
  const SingleScattering<double> air(medium);
  const double zenith_at_noon = Radiance(air, {2.0, 1.0, 0.9, 0.9});
  for (const double mu : {-1.0, -0.5, -0.19, -0.17, 0.0, 1.0}) {
    const auto at = [&](double offset_m) {
      return ViewRay{medium.atmosphere_height_m + offset_m, mu, 0.5, 0.5 * mu};
    };
    for (const double offset_m : {1e-6, -1e-6}) {
      EXPECT_NEAR(Transmittance(medium, at(offset_m)), Transmittance(medium, at(0.0)), 1e-9) << mu;
      EXPECT_NEAR(Radiance(air, at(offset_m)), Radiance(air, at(0.0)), 1e-6 * zenith_at_noon) << mu;
    }
  }
}

// Hard case 7.
TEST(OpticalDepth, LightIsContinuousAcrossTheHorizon) {
  const Medium medium = Earth();
  const SingleScattering<double> air(medium);
  for (const double altitude_m : {0.01, 1.7, 1000.0, 11000.0, 60000.0, 400e3}) {
    const double horizon =
        shared::HorizonCosine(altitude_m / 1000.0, medium.planet_radius_m / 1000.0);
    // The sky behind the horizon and the air in front of it differ by what lies behind: compare the
    // two sides of a step that both end in space, and both at the ground.
    for (const double side : {1e-7, -1e-7}) {
      const double mu = horizon + side;
      const double next = std::nextafter(mu, 1.0);
      const double here = Radiance(air, {altitude_m, mu, 0.4, 0.1});
      EXPECT_NEAR(Radiance(air, {altitude_m, next, 0.4, 0.1}), here, 1e-6 * here)
          << altitude_m << " " << side;
    }
  }
}

// Hard case 6.
TEST(OpticalDepth, IsContinuousDuringAClimbIntoSpace) {
  const Medium medium = Earth();
  const SingleScattering<double> air(medium);
  for (const double mu : {1.0, 0.2, 0.0, -0.02, -0.3, -1.0}) {
    double before = Radiance(air, {1.7, mu, 0.5, 0.3}), peak = before;
    for (double altitude_m = 1.7; altitude_m < 400e3; altitude_m *= 1.002) {
      const double now = Radiance(air, {altitude_m, mu, 0.5, 0.3});
      peak = std::fmax(peak, now);
      // A step of 0.2 % of the altitude is at most 20 m below 10 km; above, 1 % of a scale height
      // per 40 m, and a limb ray gains with its root.
      EXPECT_NEAR(now, before, 0.05 * peak) << mu << " at " << altitude_m;
      before = now;
    }
  }
}

// Hard case 11.
TEST(OpticalDepth, ASunAtTheZenithLightsAllAzimuthsEqually) {
  const Medium medium = Earth();
  const SingleScattering<double> air(medium);
  for (const double view_zenith : {0.0, 30.0, 60.0, 89.0}) {
    const double north = Radiance(air, RayFromAngles(2.0, view_zenith, 0.0, 0.0));
    for (const double azimuth : {33.0, 90.0, 180.0, 301.0}) {
      EXPECT_NEAR(Radiance(air, RayFromAngles(2.0, view_zenith, azimuth, 0.0)), north,
                  1e-6 * north);
    }
  }
}

// Hard case 2.
TEST(OpticalDepth, ObserversBelowTheSphereSeeTheSkyOfTheGround) {
  const Medium medium = Earth();
  const SingleScattering<double> air(medium);
  for (const double altitude_m : {-430.0, -11000.0}) {
    for (const double mu : {1.0, 0.1, 0.0}) {
      EXPECT_EQ(Radiance(air, {altitude_m, mu, 0.5, 0.3}), Radiance(air, {0.0, mu, 0.5, 0.3}));
      EXPECT_GT(Radiance(air, {altitude_m, mu, 0.5, 0.3}), 0.0);
    }
  }
}

}  // namespace
}  // namespace alpenglow::atmosphere
