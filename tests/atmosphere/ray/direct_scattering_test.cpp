// SPDX-License-Identifier: MIT
// Direct integration (atmosphere/ray/direct_scattering.h) is compared with SingleScattering.
#include "atmosphere/ray/direct_scattering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/medium/medium.h"
#include "atmosphere/ray/ray.h"
#include "atmosphere/ray/shell.h"
#include "atmosphere/shared_glsl/instruction_set.h"
#include "tests/fixtures/bands_near.h"
#include "tests/fixtures/direct_regimes.h"

namespace alpenglow::atmosphere {
namespace {

using tests::DirectRegime;
using tests::DirectRegimes;
using tests::ErrorsOf;
using tests::ErrorSummary;
using tests::ReferenceRays;
using tests::ReferenceRaysOf;

constexpr int kFirst = 20001, kRays = 150;
constexpr std::array kModes{DirectMode::kFast, DirectMode::kNormal};

TEST(DirectScattering, KeepsItsErrorBoundsInEveryRegimeAndPreset) {
  for (const std::string& preset : MediumPresetNames()) {
    const DirectScattering direct(MediumPreset(preset));
    for (const DirectRegime& regime : DirectRegimes()) {
      SCOPED_TRACE(preset + ", " + regime.name);
      const ReferenceRays reference =
          ReferenceRaysOf(regime, direct.reference().medium(), kFirst, kRays);
      const auto errors = [&](DirectMode mode) {
        return ErrorsOf(reference, direct.reference(),
                        [&](const ViewRay& ray) { return direct.Scatter(ray, mode); });
      };
      const ErrorSummary fast = errors(DirectMode::kFast), normal = errors(DirectMode::kNormal);
      EXPECT_LT(fast.rms, preset == "earth" ? 3.9e-3 : 7e-3);
      if (preset == "earth") {
        EXPECT_LT(fast.percentile99, 1.4e-2);
      }
      EXPECT_LT(normal.rms, 7e-4);
      EXPECT_LT(normal.percentile99, 3.5e-3);
    }
  }
}

/// Air over a small planet, as tall as Validate allows, or almost.
Medium TallAir(double radius_m, double scale_height_m, double top_m) {
  Medium medium = InScalarLight(MediumPreset("bruneton2017"));
  const auto scale = [](std::vector<double>& values, double factor) {
    for (double& value : values) value *= factor;
  };
  scale(medium.rayleigh_scattering_per_m, medium.rayleigh_scale_height_m / scale_height_m);
  scale(medium.mie_scattering_per_m, 2.0 * medium.mie_scale_height_m / scale_height_m);
  scale(medium.mie_extinction_per_m, 2.0 * medium.mie_scale_height_m / scale_height_m);
  scale(medium.ozone_absorption_per_m, 0.0);
  medium.planet_radius_m = radius_m;
  medium.rayleigh_scale_height_m = scale_height_m;
  medium.mie_scale_height_m = 0.5 * scale_height_m;
  medium.atmosphere_height_m = top_m;
  Validate(medium);
  return medium;
}

TEST(DirectScattering, IsRightInTallAirOverSmallPlanets) {
  for (const Medium& medium : {TallAir(6371e3, 8e3, 2400e3), TallAir(2575e3, 30e3, 1000e3),
                               TallAir(1188.3e3, 45e3, 1200e3), TallAir(1000e3, 20e3, 1200e3),
                               TallAir(500e3, 20e3, 6000e3), TallAir(50e3, 2e3, 600e3)}) {
    const DirectScattering direct(medium);
    const SingleScattering<double> exact(medium);
    for (const double zenith_deg : {0.0, 45.0, 80.0, 89.0, 100.0, 170.0}) {
      for (const double altitude_m : {10.0, 4.0 * medium.rayleigh_scale_height_m}) {
        for (const double sun_deg : {50.0, 88.0}) {
          const ViewRay ray = RayFromAngles(altitude_m, zenith_deg, 60.0, sun_deg);
          const auto found =
              direct.reference().Inscatter(direct.Scatter(ray, DirectMode::kNormal), ray.nu);
          const auto truth =
              exact.Inscatter(exact.Scatter(exact.Sample(ray, {.nodes = 32})), ray.nu);
          for (std::size_t band = 0; band < truth.size(); ++band) {
            EXPECT_NEAR(static_cast<double>(found[band]), truth[band], 2e-2 * truth[band])
                << "radius " << medium.planet_radius_m << ", view " << zenith_deg << ", sun "
                << sun_deg << ": columns within 2 (H / R)^2 of the scale height over the radius, "
                << "and 14 nodes for up to 300 scale heights";
          }
        }
      }
    }
  }
}

// Returns the relative error of the worst band of a ray.
double ErrorOfRay(const DirectScattering& direct, const ScatteredOnce<float>& scattered,
                  const ViewRay& ray, const SpectrumOf<double>& truth) {
  std::vector<double> errors;
  tests::AddErrors(direct.reference().Inscatter(scattered, ray.nu), truth, errors);
  double largest = 0.0;
  for (const double error : errors) largest = std::max(largest, error);
  return largest;
}

// Returns rays along edges of geometry: straight up and down, level, near the horizon, towards the
// sun and away from it, from the ground, the top and space, whole and cut.
ViewRay EdgeRay(int i) {
  const auto cosine = [i](int base) {
    const double choice = Halton(i, base), value = 2.0 * Halton(i, base + 6) - 1.0;
    if (choice < 0.15) return choice < 0.05 ? 0.0 : choice < 0.1 ? 1.0 : -1.0;
    return (choice < 0.3 ? 5e-4 : choice < 0.6 ? 0.15 : 1.0) * value;
  };
  ViewRay ray{.mu = cosine(5), .mu_s = cosine(7)};
  const double u = Halton(i, 2), v = Halton(i, 3);
  ray.altitude_m = u < 0.1 ? 0.0 : u < 0.2 ? 120e3 : u < 0.3 ? 1e6 * v : 120e3 * v * v;
  const double sines = std::sqrt((1.0 - ray.mu * ray.mu) * (1.0 - ray.mu_s * ray.mu_s));
  const double turn = i % 5 == 0 ? (i % 2 == 0 ? 1.0 : -1.0) : std::cos(kPi * Halton(i, 17));
  ray.nu = std::clamp(ray.mu * ray.mu_s + sines * turn, -1.0, 1.0);
  if (i % 3 == 0) ray.length_m = std::pow(10.0, 6.5 * Halton(i, 19));
  return ray;
}

TEST(DirectScattering, EdgeRaysAreFiniteAndNotNegative) {
  for (const std::string& preset : MediumPresetNames()) {
    const DirectScattering direct(MediumPreset(preset));
    for (int i = 1; i <= 6000; ++i) {
      for (const DirectMode mode : kModes) {
        const ScatteredOnce<float> light = direct.Scatter(EdgeRay(i), mode);
        for (std::size_t band = 0; band < light.rayleigh.size(); ++band) {
          ASSERT_TRUE(std::isfinite(light.rayleigh[band]) && light.rayleigh[band] >= 0.0F) << i;
          ASSERT_TRUE(std::isfinite(light.mie[band]) && light.mie[band] >= 0.0F) << i;
        }
      }
    }
  }
}

// Returns whether a ray is a segment that leads below altitude 0, which direct integration does not
// follow.
bool IsSubmerged(const ViewRay& ray, const Medium& medium) {
  const RayExtent extent = ExtentOf(ray, medium.planet_radius_m, medium.atmosphere_height_m);
  return SubmergedPart(ray, extent, medium.planet_radius_m).Exists();
}

TEST(DirectScattering, EdgeRaysAreWithinTenPercent) {
  const Medium medium = MediumPreset("earth");
  const DirectScattering direct(medium);
  const SingleScattering<double> fine(medium);
  for (int i = 1; i <= 3000; ++i) {
    const ViewRay ray = EdgeRay(i);
    if (IsSubmerged(ray, medium)) continue;
    const auto truth = fine.Inscatter(fine.Scatter(fine.Sample(ray, {.nodes = 24})), ray.nu);
    for (const DirectMode mode : kModes)
      EXPECT_LT(ErrorOfRay(direct, direct.Scatter(ray, mode), ray, truth), 0.1) << i;
  }
}

Medium OnPlanetOf(Medium medium, double radius_m) {
  medium.planet_radius_m = radius_m;
  return medium;
}

// These are the smallest planets that a medium may have, and one larger than Jupiter.
TEST(DirectScattering, KeepsItsErrorBoundsOnPlanetsOfAnySize) {
  for (const Medium& medium :
       {OnPlanetOf(MediumPreset("bruneton2017"), 200e3), OnPlanetOf(MediumPreset("earth"), 223e3),
        OnPlanetOf(MediumPreset("mars"), 280e3), OnPlanetOf(MediumPreset("earth"), 8e7)}) {
    const DirectScattering direct(medium);
    const DirectRegime day{"day", [](int i, const Medium&) {
                             return RayFromAngles(10e3 * Halton(i, 2), 89.0 * Halton(i, 3),
                                                  180.0 * Halton(i, 5), 85.0 * Halton(i, 7));
                           }};
    const ErrorSummary errors =
        ErrorsOf(ReferenceRaysOf(day, medium, kFirst, kRays), direct.reference(),
                 [&](const ViewRay& ray) { return direct.Scatter(ray, DirectMode::kNormal); });
    const auto [lowest, highest] =
        std::minmax({medium.rayleigh_scale_height_m, medium.mie_scale_height_m});
    const double flatness = highest / medium.planet_radius_m;
    EXPECT_LT(errors.rms, std::max({7e-4, 2.0 * flatness * flatness,
                                    6e-10 * std::pow(medium.planet_radius_m / lowest, 1.5)}))
        << medium.name << ", " << medium.planet_radius_m;
  }
}

TEST(DirectScattering, SegmentsOfLengthZeroAreExactlyZero) {
  const DirectScattering direct(MediumPreset("earth"));
  const ViewRay ray{100.0, 0.1, 0.5, 0.3, 0.0};
  const ScatteredOnce<float> light = direct.Scatter(ray, DirectMode::kNormal);
  EXPECT_EQ(light.rayleigh, Spectrum(light.rayleigh.size()));
  EXPECT_EQ(light.mie, Spectrum(light.mie.size()));
  EXPECT_EQ(direct.Sample(ray, {}).count, 0U);
}

TEST(DirectScattering, LightOfOneMillimetreOfAirIsAccurate) {
  const Medium medium = MediumPreset("earth");
  const DirectScattering direct(medium);
  const SingleScattering<double> fine(medium);
  const ViewRay ray{100.0, 0.1, 0.5, 0.3, 1e-3};
  const auto truth = fine.Scatter(fine.Sample(ray, {}));
  const auto light = direct.Scatter(ray, DirectMode::kFast);
  EXPECT_TRUE(tests::BandsNear(light.rayleigh, truth.rayleigh, 2e-4));
}

TEST(DirectScattering, SamplesScatterTheSameLight) {
  const DirectScattering direct(MediumPreset("earth"));
  for (const DirectRegime& regime : DirectRegimes()) {
    for (int i = 1; i <= 30; ++i) {
      const ViewRay ray = regime.ray(i, direct.reference().medium());
      for (const DirectMode mode : kModes) {
        const auto light = direct.Scatter(ray, mode);
        const auto same = direct.reference().Scatter(direct.Sample(ray, {.mode = mode}));
        EXPECT_TRUE(tests::BandsNear(same.rayleigh, light.rayleigh, 2e-4, 1e-13))
            << regime.name << ' ' << i;
      }
    }
  }
}

// Columns differ by a thousandth, by what single precision leaves of a difference, and by the fit
// of ozone, up to three times (0.6 km of it are 1e-3 of an optical depth).
void ExpectColumns(const ColumnSet<float>& found, const ColumnSet<double>& truth) {
  EXPECT_NEAR(static_cast<double>(found.rayleigh), truth.rayleigh, 1e-3 * truth.rayleigh + 3e-3);
  EXPECT_NEAR(static_cast<double>(found.mie), truth.mie, 1e-3 * truth.mie + 3e-3);
  EXPECT_NEAR(static_cast<double>(found.ozone), truth.ozone, 1e-3 * truth.ozone + 0.6);
}

// Expects that positions, weights and columns of samples are those of SingleScattering at the same
// places.
void ExpectSamplesOf(const SingleScattering<double>& fine, const ViewRay& ray,
                     const RaySamples<float>& samples) {
  if (samples.count == 0) return;  // the ray meets no air
  std::vector<RayNode> nodes;
  double length_km = 0.0;
  for (std::size_t i = 0; i < samples.count; ++i) {
    nodes.push_back({1000.0 * static_cast<double>(samples.distance[i]) + samples.extent.begin_m,
                     1000.0 * static_cast<double>(samples.weight[i])});
    length_km += static_cast<double>(samples.weight[i]);
  }
  EXPECT_NEAR(1000.0 * length_km / (samples.extent.end_m - samples.extent.begin_m), 1.0, 1e-5);
  const RaySamples<double> truth = fine.SampleAt(ray, nodes);
  for (std::size_t i = 0; i < samples.count; ++i) {
    if (samples.weight[i] == 0.0F) continue;
    EXPECT_NEAR(static_cast<double>(samples.altitude[i]), truth.altitude[i], 2e-3);
    EXPECT_NEAR(static_cast<double>(samples.mu[i]), truth.mu[i], 2e-6);
    EXPECT_NEAR(static_cast<double>(samples.mu_s[i]), truth.mu_s[i], 2e-6);
    EXPECT_NEAR(static_cast<double>(samples.rayleigh_density[i]), truth.rayleigh_density[i],
                4e-4 * truth.rayleigh_density[i] + 1e-12);
    ExpectColumns({samples.view_rayleigh[i], samples.view_mie[i], samples.view_ozone[i]},
                  {truth.view_rayleigh[i], truth.view_mie[i], truth.view_ozone[i]});
    if (samples.lit[i] == 0.0F) continue;
    ExpectColumns({samples.sun_rayleigh[i], samples.sun_mie[i], samples.sun_ozone[i]},
                  {truth.sun_rayleigh[i], truth.sun_mie[i], truth.sun_ozone[i]});
  }
}

TEST(DirectScattering, SamplesCoverTheRayAtTheirDistances) {
  for (const char* preset : {"earth", "bruneton2017"}) {
    const Medium medium = MediumPreset(preset);
    const DirectScattering direct(medium);
    const SingleScattering<double> fine(medium);
    for (const DirectRegime& regime : DirectRegimes()) {
      SCOPED_TRACE(std::string(preset) + ", " + regime.name);
      for (int i = 1; i <= 20; ++i) {
        const ViewRay ray = regime.ray(i, medium);
        ExpectSamplesOf(fine, ray,
                        direct.Sample(ray, {.mode = kModes[static_cast<std::size_t>(i % 2)],
                                            .dark_samples = true}));
      }
    }
  }
}

TEST(DirectScattering, EndsOfRaysEqualThoseOfExtentOf) {
  const Medium medium = MediumPreset("earth");
  const DirectScattering direct(medium);
  for (int i = 1; i <= 2000; ++i) {
    const ViewRay ray = EdgeRay(i);
    if (IsSubmerged(ray, medium)) continue;
    const RayExtent extent = ExtentOf(ray, medium.planet_radius_m, medium.atmosphere_height_m);
    const RaySamples<float> samples = direct.Sample(ray, {});
    EXPECT_NEAR(samples.extent.begin_m, extent.begin_m, 0.01) << i;
    EXPECT_NEAR(samples.extent.end_m, extent.end_m, 0.01) << i;
  }
}

TEST(DirectScattering, ColumnsOfShortSegmentsAreAccurate) {
  const Medium medium = MediumPreset("earth");
  const DirectScattering direct(medium);
  const SingleScattering<double> fine(medium);
  for (int i = 1; i <= 400; ++i) {
    const double altitude = 200.0 + 3000.0 * Halton(i, 2);
    const double length = std::pow(10.0, 5.0 * Halton(i, 3));
    // The way rises by two kilometres at most, and stays over the horizon of the planet.
    const double slope = std::min(2000.0 / length, 1.0) * (2.0 * Halton(i, 5) - 1.0);
    const ViewRay ray{altitude, std::max(slope, -100.0 / length), 0.5, 0.5, length};
    const DirectRay placed = direct.Place(ray, {.dark_samples = true});
    const ColumnSet<float> found = direct.ColumnsAlong(placed);
    const ColumnSet<double> truth = fine.ColumnsAlong(ray);
    EXPECT_NEAR(static_cast<double>(found.rayleigh) / truth.rayleigh, 1.0, 1e-6) << length;
    EXPECT_NEAR(static_cast<double>(found.mie) / truth.mie, 1.0, 2e-6) << length;
    EXPECT_NEAR(static_cast<double>(found.ozone), truth.ozone, 2e-4 * truth.ozone + 1e-9)
        << "its density goes with the fourth power of the altitude";
  }
}

// Gives the lanes of every panel that share of what the planet lets through.
LaneLight ShareOfLight(const DirectRay& placed, float share) {
  LaneLight light{};
  VisitPanels(placed, [&](const PanelNodes& nodes) {
    for (std::size_t j = 0; j < nodes.count; ++j)
      light.factor[nodes.SampleOf(j)] = share * placed.panel[nodes.panel].lit;
  });
  return light;
}

TEST(DirectScattering, AFractionOfSunlightScalesEveryNode) {
  const Medium medium = MediumPreset("earth");
  const DirectScattering direct(medium);
  for (const DirectRegime& regime : DirectRegimes()) {
    SCOPED_TRACE(regime.name);
    for (int i = 1; i <= 20; ++i) {
      const ViewRay ray = regime.ray(i, medium);
      const DirectMode mode = kModes[static_cast<std::size_t>(i % 2)];
      const DirectRay placed = direct.Place(ray, {.mode = mode, .dark_samples = true});
      const LaneLight quarter = ShareOfLight(placed, 0.25F);
      const SampledLight found = direct.Sample(placed, &quarter);
      const float whole = direct.Scatter(placed, nullptr).rayleigh[0];
      EXPECT_NEAR(found.once.rayleigh[0], 0.25F * whole, 1e-6F * whole) << "rounding";
      EXPECT_NEAR(direct.reference().Scatter(found.samples).rayleigh[0], 0.25F * whole,
                  1e-4F * whole + 1e-12F)
          << "exponentials of two kinds in single precision";
      EXPECT_EQ(direct.Scatter(placed, &quarter).rayleigh[0], found.once.rayleigh[0]);
    }
  }
}

TEST(DirectScattering, BandsDoNotDependOnOtherBands) {
  std::vector<double> wavelengths_nm;
  for (int i = 0; i < 40; ++i) wavelengths_nm.push_back(380.0 + 10.0 * i);
  const DirectScattering all(MediumPreset("earth", wavelengths_nm));
  for (const std::size_t band : {0U, 17U, 39U}) {
    const DirectScattering one(MediumPreset("earth", {wavelengths_nm[band]}));
    const ViewRay ray = RayFromAngles(1000.0, 80.0, 30.0, 70.0);
    for (const DirectMode mode : kModes) {
      EXPECT_NEAR(one.Scatter(ray, mode).rayleigh[0] / all.Scatter(ray, mode).rayleigh[band], 1.0F,
                  3e-4F)
          << "one band may be called hard where another is not";
    }
  }
}

TEST(DirectScattering, InstructionSetsAgree) {
  const DirectScattering direct(MediumPreset("earth"));
  for (const DirectRegime& regime : DirectRegimes()) {
    for (int i = 1; i <= 20; ++i) {
      const ViewRay ray = regime.ray(i, direct.reference().medium());
      std::vector<float> light;
      for (const InstructionSet set : AvailableInstructionSets()) {
        const InstructionSetScope scope(set);
        light.push_back(direct.Scatter(ray, kModes[static_cast<std::size_t>(i % 2)]).rayleigh[0]);
      }
      for (const float other : light)
        EXPECT_NEAR(other, light[0], 1e-4F * light[0] + 1e-12F) << regime.name << ' ' << i;
    }
  }
}

TEST(DirectScattering, InvalidRaysAreRefused) {
  const DirectScattering direct(MediumPreset("earth"));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const ViewRay& ray :
       {ViewRay{nan, 0.5, 0.5, 0.5}, ViewRay{0.0, 1.1, 0.5, 0.5}, ViewRay{0.0, 0.5, nan, 0.5},
        ViewRay{0.0, 0.5, 0.5, -2.0}, ViewRay{0.0, 0.5, 0.5, 0.5, -1.0}}) {
    EXPECT_THROW(static_cast<void>(direct.Scatter(ray, DirectMode::kFast)), InputError);
  }
}

TEST(DirectColumns, AgreeWithTheColumnsOfTwoTerms) {
  const double radius = 6371.0;
  for (const double height : {1.2, 2.857, 6.8, 8.0}) {
    for (const double altitude : {0.0, 1.0, 10.0, 60.0}) {
      for (const double mu : {0.0, 0.003, 0.03, 0.1, 0.3, 1.0}) {
        const double root = std::sqrt((radius + altitude) / (2.0 * height));
        const double column = height * std::exp(-altitude / height) * root *
                              (1.0 + height / radius) *
                              shared::DirectColumnShape<double>(mu * root, 0.625 * height / radius);
        const double truth =
            shared::ExponentialColumnToInfinity<double>(altitude, mu, height, radius);
        EXPECT_NEAR(column / truth, 1.0, 1e-4) << height << ' ' << altitude << ' ' << mu;
      }
    }
  }
}

// Returns the column of the polynomials of direct_panels.h at an altitude [km].
double FittedOzone(const DirectAir& air, double altitude, double mu) {
  constexpr double k = static_cast<double>(kOzoneCosine);
  const double y = 2.0 * altitude / static_cast<double>(air.ozone_top) - 1.0;
  const double u = 2.0 * (1.0 + k) * mu / (mu + k) - 1.0;
  double sum = 0.0;
  for (std::size_t q = kOzoneCosines; q-- > 0;) {
    double of_height = 0.0;
    for (std::size_t a = kOzoneHeights; a-- > 0;)
      of_height = of_height * y + static_cast<double>(air.ozone_fit.up[q][a]);
    sum = sum * u + of_height;
  }
  return sum / (mu + k);
}

TEST(DirectAir, PolynomialsOfOzoneKeepItsOpticalDepth) {
  const Medium medium = MediumPreset("earth");
  const DirectAir air = DirectAirOf(medium);
  double largest_per_km = 0.0;
  for (const double per_m : medium.ozone_absorption_per_m)
    largest_per_km = std::max(largest_per_km, 1000.0 * per_m);
  const double top = static_cast<double>(air.ozone_top);
  for (int i = 0; i <= 100; ++i) {
    for (int j = 0; j <= 100; ++j) {
      const double altitude = 0.01 * i * top, mu = 1e-4 * j * j;
      const double truth = shared::SmoothOzoneColumnUp<double>(altitude, mu, top, air.radius);
      EXPECT_NEAR(largest_per_km * FittedOzone(air, altitude, mu), largest_per_km * truth, 3e-4);
    }
  }
}

}  // namespace
}  // namespace alpenglow::atmosphere
