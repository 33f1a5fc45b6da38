// SPDX-License-Identifier: MIT
#include "lut/multiple_scattering/multiple_scattering.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <array>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/medium/atmosphere_file.h"
#include "atmosphere/medium/phase_forms.h"
#include "atmosphere/shared_glsl/instruction_set.h"
#include "tests/fixtures/bands_near.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/small_light.h"
#include "tests/fixtures/solved_media.h"
#include "tests/fixtures/stored_cases.h"

namespace alpenglow::lut {
namespace {

TEST(LegendreCoefficients, OfMoleculesAreOneZeroOneTenth) {
  const auto chi = LegendreCoefficients({.kind = PhaseKind::kRayleigh}, 4);
  const std::vector<double> expected{1.0, 0.0, 0.1, 0.0, 0.0};
  for (std::size_t l = 0; l < chi.size(); ++l) EXPECT_NEAR(chi[l], expected[l], 1e-12) << l;
}

TEST(LegendreCoefficients, OfHenyeyGreensteinArePowersOfG) {
  for (const double g : {-0.999, -0.99, -0.6, 0.0, 0.3, 0.8, 0.99, 0.999}) {
    const auto chi = LegendreCoefficients(tests::LobeOf(g), 8192);
    for (std::size_t l = 0; l < chi.size(); ++l)
      ASSERT_NEAR(chi[l], std::pow(g, static_cast<double>(l)), 1e-6) << g << ", degree " << l;
  }
}

/// Returns the integrals of a phase function times Legendre polynomials by the midpoint rule.
std::vector<double> MidpointCoefficients(const PhaseFunction& phase, int degree, int steps) {
  std::vector<double> chi(static_cast<std::size_t>(degree) + 1, 0.0);
  for (int i = 0; i < steps; ++i) {
    const double angle = kPi * (i + 0.5) / steps;
    const std::vector<double> series = LegendreSeries(degree, std::cos(angle));
    const double light = 2.0 * kPi * std::sin(angle) * kPi / steps * Phase(phase, std::cos(angle));
    for (std::size_t l = 0; l < chi.size(); ++l)
      chi[l] += light * series[l] * 4.0 * kPi / (2.0 * static_cast<double>(l) + 1.0);
  }
  return chi;
}

/// Returns two phase functions of each kind except tables, with parameters near alternate ends of
/// their ranges.
std::vector<PhaseFunction> PhasesOfEveryFormula() {
  std::vector<PhaseFunction> phases;
  for (const PhaseForm& form : PhaseForms()) {
    if (form.kind == PhaseKind::kTable) continue;
    for (double share : {0.05, 0.95}) {
      PhaseFunction& phase = phases.emplace_back(PhaseFunction{.kind = form.kind});
      for (const PhaseParameter& parameter : form.parameters) {
        phase.*parameter.member = std::lerp(parameter.low, parameter.high, share);
        share = 1.0 - share;
      }
    }
  }
  return phases;
}

// 40000 midpoints are exact to 1e-7 for lobes of 3 degrees and wider.
TEST(LegendreCoefficients, OfEveryKindEqualTheIntegralsToOneInAMillion) {
  std::vector<PhaseFunction> phases = PhasesOfEveryFormula();
  phases.push_back(DropletPhase(4.0));
  constexpr int kDegree = tests::ScaledDown(170, 40);
  for (const PhaseFunction& phase : phases) {
    const std::vector<double> chi = LegendreCoefficients(phase, kDegree);
    const std::vector<double> expected = MidpointCoefficients(phase, kDegree, 40000);
    for (std::size_t l = 0; l < chi.size(); ++l)
      ASSERT_NEAR(chi[l], expected[l], 1e-6) << NameOf(phase.kind) << ", degree " << l;
  }
}

TEST(SphericalHarmonics, AreOrthonormalOverTheSphere) {
  const GaussRule& rule = GaussLegendre(16);
  constexpr int kAzimuths = 32;
  std::array<std::array<double, kMaxMoments>, kMaxMoments> product{};
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    for (int k = 0; k < kAzimuths; ++k) {
      const double phi = 2.0 * kPi * (k + 0.5) / kAzimuths;
      const auto y = SphericalHarmonics(kMaxDegree, static_cast<float>(2.0 * rule.node[i] - 1.0),
                                        static_cast<float>(std::cos(phi)));
      for (std::size_t a = 0; a < kMaxMoments; ++a) {
        for (std::size_t b = 0; b < kMaxMoments; ++b) {
          product[a][b] += static_cast<double>(y[a]) * static_cast<double>(y[b]) * 2.0 *
                           rule.weight[i] * 2.0 * kPi / kAzimuths;
        }
      }
    }
  }
  for (std::size_t a = 0; a < kMaxMoments; ++a) {
    for (std::size_t b = 0; b < kMaxMoments; ++b) {
      EXPECT_NEAR(product[a][b], a == b ? 1.0 : 0.0, 2e-6) << a << " " << b << ": float harmonics";
    }
  }
}

TEST(MultipleScattering, SunCoordinateIsInvertible) {
  for (double v = 0.0; v <= 1.0; v += 0.01) {
    EXPECT_NEAR(MultipleScattering::SunCoordinate(MultipleScattering::SunNodes().MuS(v)), v, 1e-12);
  }
}

// Hard case 28.
TEST(MultipleScattering, EmptyAirOverABlackPlanetIsDark) {
  Medium medium = tests::WithoutAir(MediumPreset("bruneton2017"));
  medium.ground_albedo.assign(3, 0.0);
  const MultipleScattering light(medium, tests::kSmallLight);
  EXPECT_TRUE(light.converged());
  for (const float value : light.values()) EXPECT_EQ(value, 0.0F);
}

TEST(MultipleScattering, SurvivesARoundTripThroughItsValues) {
  const Medium air = MediumPreset("bruneton2017");
  const MultipleScattering light(air, tests::kSmallLight);
  const MultipleScattering back(air, tests::kSmallLight,
                                {light.values(), light.orders(), light.converged()});
  EXPECT_EQ(back.orders(), light.orders());
  EXPECT_EQ(back.SkyIrradiance(500.0, 0.3), light.SkyIrradiance(500.0, 0.3));
  EXPECT_THROW(MultipleScattering(air, {}, {light.values(), 1, true}), InputError)
      << "of other options";
  std::vector<float> broken = light.values();
  broken[7] = std::nanf("");
  EXPECT_THROW(MultipleScattering(air, tests::kSmallLight, {broken, 1, true}), InputError);
}

/// Returns the constructor's message on kSmallLight with one option changed.
template <typename Value>
std::string RefusalOf(Value MultipleScatteringOptions::*option, Value value) {
  MultipleScatteringOptions options = tests::kSmallLight;
  options.*option = value;
  return tests::FaultOf([&] { MultipleScattering(MediumPreset("bruneton2017"), options); });
}

TEST(MultipleScattering, NumbersOfNodesOutOfRangeAreRefusedByName) {
  using Options = MultipleScatteringOptions;
  const std::pair<int Options::*, std::string> counts[] = {
      {&Options::zenith_nodes, "zenith_nodes"},
      {&Options::azimuth_nodes, "azimuth_nodes"},
      {&Options::ray_nodes, "ray_nodes"},
      {&Options::later_zenith_nodes, "later_zenith_nodes"},
      {&Options::later_azimuth_nodes, "later_azimuth_nodes"},
      {&Options::later_ray_nodes, "later_ray_nodes"},
      {&Options::max_orders, "max_orders"}};
  for (const auto& [count, name] : counts) {
    for (const int value : {-1, 0, 100000})
      EXPECT_EQ(RefusalOf(count, value).find(name + " is " + std::to_string(value)), 0U) << name;
  }
  EXPECT_EQ(RefusalOf(&Options::tolerance, -0.5).find("tolerance is -0.5"), 0U);
}

TEST(MultipleScattering, EveryBandHasItsOwnPhaseFunction) {
  Medium medium = MediumPreset("hazy");
  medium.mie_phase.clear();
  for (const double g : {0.5, 0.6, 0.7, 0.8}) {
    medium.mie_phase.push_back(tests::LobeOf(g));
  }
  MultipleScatteringOptions few_orders = tests::kSmallLight;
  few_orders.max_orders = 4;
  few_orders.tolerance = 1e-9;
  const MultipleScattering light(medium, few_orders);
  const ViewRay ray{2.0, 0.5, 0.7, 0.9};
  const auto inscatter = [&ray](const Medium& air, const MultipleScattering& multiple_scattering) {
    const SingleScattering<float> single_scattering(air);
    return multiple_scattering.InscatterAlong(
        single_scattering.Sample(ray, {.nodes = 8, .split_ozone = false, .dark_samples = true}),
        ray.nu);
  };
  for (std::size_t band = 0; band < 4; ++band) {
    Medium shared = medium;
    shared.mie_phase = {medium.mie_phase[band]};
    const MultipleScattering alone(shared, few_orders);
    EXPECT_EQ(inscatter(medium, light)[band], inscatter(shared, alone)[band]) << "band " << band;
  }
}

TEST(LegendreCoefficients, OfATableAreThoseOfLinearInterpolation) {
  const Medium desert = MediumFromToml("[aerosol]\nmixture = \"desert\"\n", "desert");
  const PhaseFunction& phase = desert.mie_phase.front();
  const auto chi = LegendreCoefficients(phase, 6);
  EXPECT_NEAR(chi[0], 1.0, 1e-7);
  EXPECT_NEAR(chi[1], MeanCosine(phase), 1e-7);
  // The sum over a million angles has an error of second order in the step.
  double p2 = 0.0;
  constexpr int kSteps = 1000000;
  for (int i = 0; i < kSteps; ++i) {
    const double angle = kPi * (i + 0.5) / kSteps;
    const double c = std::cos(angle);
    p2 += 2.0 * kPi * std::sin(angle) * kPi / kSteps * Phase(phase, c) * (1.5 * c * c - 0.5);
  }
  EXPECT_NEAR(chi[2], p2, 1e-6);
  const std::vector<double> high = LegendreCoefficients(phase, 600);
  const std::vector<double> expected = MidpointCoefficients(phase, 600, 20000);
  for (const std::size_t l : {14U, 64U, 160U, 171U, 600U})
    EXPECT_NEAR(high[l], expected[l], 2e-6) << l;
}

// Hard case 43.
TEST(MultipleScattering, IsTheSameForAnyNumberOfThreads) {
  const Medium medium = MediumPreset("bruneton2017");
  std::vector<std::vector<float>> values;
  for (const std::size_t threads : {1U, 2U, 8U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    values.push_back(MultipleScattering(medium, tests::kSmallLight).values());
  }
  EXPECT_EQ(values[0], values[1]);
  EXPECT_EQ(values[0], values[2]);
}

// The radiances are those of reference::TraceRadiance with max_order one more, to 0.1 %.
TEST(MultipleScattering, AGivenNumberOfOrdersEqualsPathsOfThatLength) {
  const Medium air = MediumPreset("bruneton2017");
  const ViewRay ray = RayFromAngles(1000.0, 60.0, 90.0, 50.0);
  const SingleScattering<float> single_scattering(air);
  const RaySamples<float> samples =
      single_scattering.Sample(ray, {.nodes = 16, .split_ozone = false, .dark_samples = true});
  const Spectrum once = single_scattering.Inscatter(single_scattering.Scatter(samples), ray.nu);
  const std::pair<int, std::array<double, 3>> traced[] = {{1, {0.0292002, 0.0132663, 0.00611043}},
                                                          {3, {0.0335968, 0.0140777, 0.00627687}}};
  for (const auto& [orders, truth] : traced) {
    const MultipleScattering light(air, {.exact_orders = orders});
    EXPECT_EQ(light.orders(), orders);
    const Spectrum more = light.InscatterAlong(samples, ray.nu);
    for (std::size_t band = 0; band < more.size(); ++band) {
      EXPECT_NEAR(static_cast<double>(once[band] + more[band]) / truth[band], 1.0, 5e-3)
          << orders << " orders, band " << band << ": 4 standard errors and 0.1 % of the moments";
    }
  }
}

TEST(MultipleScattering, TenNodesAreAccurateToATenthOfAPercentInHaze) {
  const Medium hazy = MediumPreset("hazy");
  MultipleScatteringOptions options{
      .altitudes = 8, .sun_angles = 16, .ray_nodes = 32, .exact_orders = 1};
  const MultipleScattering truth(hazy, options);
  options.ray_nodes = 10;
  const MultipleScattering light(hazy, options);
  double squares = 0.0;
  int values = 0;
  for (int altitude = 0; altitude < options.altitudes; ++altitude) {
    for (int sun = 0; sun < options.sun_angles; ++sun) {
      const double u = altitude / (options.altitudes - 1.0), v = sun / (options.sun_angles - 1.0);
      const std::vector<float> found = light.ValuesAt(u, v), exact = truth.ValuesAt(u, v);
      for (std::size_t band = 0; band < light.bands(); ++band) {  // of the mean radiance
        if (exact[band] < 1e-9F) continue;
        squares += std::pow(static_cast<double>(found[band] / exact[band]) - 1.0, 2.0);
        ++values;
      }
    }
  }
  EXPECT_LT(std::sqrt(squares / values), 1e-3)
      << "root mean square over day and twilight, by the "
         "map of ray_map.glsl; by a rational map 7e-4 by day, 2e-3 after";
}

// Hard case 29.
TEST(MultipleScattering, ThickConservativeAirConvergesOrReportsIt) {
  Medium medium = MediumPreset("bruneton2017");
  for (std::size_t band = 0; band < medium.wavelengths_nm.size(); ++band) {
    medium.mie_scattering_per_m[band] = medium.mie_extinction_per_m[band] =
        5.0 / medium.mie_scale_height_m;
    medium.ground_albedo[band] = 1.0;
    medium.ozone_absorption_per_m[band] = 0.0;
  }
  MultipleScatteringOptions few = tests::kSmallLight;
  few.max_orders = 5;
  EXPECT_FALSE(MultipleScattering(medium, few).converged());
  MultipleScatteringOptions many = tests::kSmallLight;
  many.max_orders = 2000;
  const MultipleScattering light(medium, many);
  EXPECT_TRUE(light.converged());
  for (const float value : light.values()) EXPECT_TRUE(std::isfinite(value));
}

/// Returns light of all orders in the air of a stored set, which is solved once, with the options
/// of Sky (include/alpenglow/sky.h), whose bounds rest on the comparisons with these sets.
const MultipleScattering& StoredLight(const std::string& set, const Medium& medium) {
  static std::map<std::string, MultipleScattering> lights;
  return lights.try_emplace(set, medium, OptionsFor(medium)).first->second;
}

// Compares light of all orders with the stored path-traced totals of a regime. Under the
// sanitizers, only the air of the earth is solved.
void ExpectStoredTotals(const std::string& tag_filter, std::set<std::string> sets,
                        double relative_tolerance) {
  if (tests::kSanitized) sets = {"earth"};
  const auto media = stored::Media();
  const auto results = stored::Results("multiple_results.csv");
  int compared = 0;
  double squares = 0.0;
  for (const stored::Row& row : stored::Read("multiple.csv")) {
    const std::string set = row.at("set");
    if (row.at("tag") != tag_filter || !sets.contains(set)) continue;
    const Medium& medium = media.at(set);
    const MultipleScattering& light = StoredLight(set, medium);
    const SingleScattering<float> air(medium);
    const ViewRay ray = stored::RayOf(row);
    const auto samples = air.Sample(ray, {.nodes = 16, .split_ozone = true, .dark_samples = true});
    if (samples.extent.end == RayEnd::kGround) continue;
    const auto once = air.Inscatter(air.Scatter(samples), ray.nu);
    const auto more = light.InscatterAlong(samples, ray.nu);
    for (const stored::Row& expected : results.at(row.at("id"))) {
      const std::size_t band = stored::Band(medium, expected);
      const double error =
          static_cast<double>(once[band] + more[band]) / stored::Number(expected, "total") - 1.0;
      squares += error * error;
      ++compared;
    }
  }
  EXPECT_GE(compared, tests::ScaledDown(9, 3));
  EXPECT_LT(std::sqrt(squares / compared), relative_tolerance) << tag_filter;
}

TEST(MultipleScattering, DaylightAgreesWithPathTracingToAnEighthOfAPercent) {
  ExpectStoredTotals("day", {"earth", "earth_a03", "rayleigh"}, 1.25e-3);
}

TEST(MultipleScattering, TwilightAgreesWithPathTracingToOnePercent) {
  // This includes two hazy rays with the sun 10 degrees down, where the stored sigma is 0.6 %.
  ExpectStoredTotals("twilight", {"earth", "earth_a03", "rayleigh", "spec5"}, 1e-2);
}

TEST(MultipleScattering, AirInFrontOfALowSunAgreesWithPathTracing) {
  // The glow around the sun of light scattered twice by aerosol is narrower than degree 6.
  ExpectStoredTotals("aerial perspective", {"earth", "haze20mix", "spec5"}, 1.5e-2);
}

// Nobody tuned to these views. Coarse moments are weak there. The radiances are those of
// reference::TraceRadiance, to 0.3 %.
TEST(MultipleScattering, HazeAgreesWithTheReferenceAtLowSunAndInTwilight) {
  struct View {
    double altitude_m, zenith_deg, azimuth_deg, sun_deg;
    std::array<double, 4> traced;
  };
  const Medium medium = MediumPreset("hazy");
  const MultipleScattering light(medium);
  const SingleScattering<float> air(medium);
  for (const View& view :
       {View{3000.0, 84.0, 20.0, 4.0, {0.0504253, 0.0561471, 0.0473182, 0.0497485}},
        {2.0, 82.0, 170.0, 2.0, {0.00653782, 0.00756772, 0.00636627, 0.00774458}},
        {2.0, 40.0, 60.0, -2.0, {0.000818066, 0.000559482, 0.000352837, 0.000422304}},
        {10000.0, 88.0, 40.0, -4.0, {0.00278787, 0.00226728, 0.00130451, 0.00184523}}}) {
    const ViewRay ray =
        RayFromAngles(view.altitude_m, view.zenith_deg, view.azimuth_deg, 90.0 - view.sun_deg);
    const auto samples = air.Sample(ray, {.nodes = 20, .split_ozone = true, .dark_samples = true});
    const auto once = air.Inscatter(air.Scatter(samples), ray.nu);
    const auto more = light.InscatterAlong(samples, ray.nu);
    for (std::size_t band = 0; band < light.bands(); ++band) {
      EXPECT_NEAR(static_cast<double>(once[band] + more[band]) / view.traced[band], 1.0, 0.029)
          << "sun " << view.sun_deg << " band " << band << ": 2 % and three standard errors";
    }
  }
}

// The irradiances are those of reference::TraceIrradiance, to 0.3 %.
TEST(MultipleScattering, LightOnHorizontalSurfacesAgreesWithPathTracing) {
  struct Surface {
    double altitude_m, sun_deg, up;
    std::array<double, 4> traced;
  };
  const MultipleScattering& light = tests::Earth().multiple_scattering();
  for (const Surface& surface :
       {Surface{0.0, 40.0, 1.0, {0.13789, 0.0900898, 0.0715137, 0.0553918}},
        {0.0, 3.0, 1.0, {0.0276428, 0.0234161, 0.0181633, 0.0184367}},
        {0.0, -5.0, 1.0, {0.00017282, 0.000110839, 6.19253e-05, 8.76625e-05}},
        {9000.0, 40.0, 1.0, {0.0409951, 0.0199226, 0.0136641, 0.00873826}},
        {9000.0, 40.0, -1.0, {0.128162, 0.106546, 0.0997061, 0.100789}},
        {9000.0, 3.0, 1.0, {0.0218578, 0.0117728, 0.00734535, 0.00558897}},
        {9000.0, 3.0, -1.0, {0.0190512, 0.018613, 0.015438, 0.0173108}},
        {9000.0, -5.0, 1.0, {0.00020299, 0.0001176, 6.25477e-05, 8.56788e-05}}}) {
    const auto found = light.Irradiance(
        surface.altitude_m, std::sin(surface.sun_deg * kRadiansPerDegree), surface.up, 1.0);
    for (std::size_t band = 0; band < light.bands(); ++band) {
      EXPECT_NEAR(static_cast<double>(found[band]) / surface.traced[band], 1.0, 0.02)
          << surface.altitude_m << " m, sun " << surface.sun_deg << ", from " << surface.up
          << ": 1 % and three standard errors";
    }
  }
}

// Hard case 23.
TEST(MultipleScattering, IsNeverNegative) {
  for (const char* name : {"hazy", "clear-mountain"}) {
    const Medium medium = MediumPreset(name);
    const MultipleScattering light(medium, tests::kSmallLight);
    const SingleScattering<float> air(medium);
    for (const double altitude_m : {0.0, 9000.0, 70000.0}) {
      for (double sun_deg = -20.0; sun_deg <= 90.0; sun_deg += 11.0) {
        const double mu_s = std::sin(sun_deg * kRadiansPerDegree);
        for (const double zenith_deg : {0.0, 60.0, 89.0, 91.0, 120.0, 180.0}) {
          const ViewRay ray = RayFromAngles(altitude_m, zenith_deg, 150.0, 90.0 - sun_deg);
          const auto samples = air.Sample(ray, {.nodes = 8, .dark_samples = true});
          const auto inscatter = light.InscatterAlong(samples, ray.nu);
          const auto irradiance =
              light.Irradiance(altitude_m, mu_s, std::cos(zenith_deg * kRadiansPerDegree), -1.0);
          for (std::size_t band = 0; band < light.bands(); ++band) {
            EXPECT_GE(inscatter[band], 0.0F) << sun_deg << " " << zenith_deg;
            EXPECT_GE(irradiance[band], 0.0F) << sun_deg << " " << zenith_deg;
          }
        }
      }
    }
  }
}

// Ramamoorthi and Hanrahan's sum is written out. What the series misses follows P_8.
TEST(MultipleScattering, LightOnSlopesIsTheClampedCosineOfTheMoments) {
  const Medium medium = MediumPreset("earth");
  MultipleScatteringOptions options = tests::kSmallLight;
  options.degree = 6;
  const MultipleScattering light(medium, options);
  const std::array<double, 7> cosine{kPi, 2 * kPi / 3, kPi / 4, 0.0, -kPi / 24, 0.0, kPi / 64};
  const double mu_s = 0.2;
  const double altitude_m = 1700.0;
  const auto values = light.ValuesAt(std::sqrt(altitude_m / medium.atmosphere_height_m),
                                     MultipleScattering::SunCoordinate(mu_s));
  const Moments upward = SphericalHarmonics(6, 1.0F, 1.0F);
  for (const double tilt_deg : {0.0, 20.0, 55.0, 90.0, 130.0, 180.0}) {
    for (const double azimuth : {-1.0, -0.2, 0.7}) {
      const double up = std::cos(tilt_deg * kRadiansPerDegree);
      const Moments harmonic =
          SphericalHarmonics(6, static_cast<float>(up), static_cast<float>(azimuth));
      const double missing = std::legendre(8U, up);
      const auto found = light.Irradiance(altitude_m, mu_s, up, azimuth);
      for (std::size_t band = 0; band < light.bands(); ++band) {
        const auto moment = [&](std::size_t i) {
          return static_cast<double>(values[i * light.bands() + band]);
        };
        double expected = missing * moment(light.channels() - 1);
        for (int l = 0; l <= 6; ++l) {
          for (int m = 0; m <= l; ++m) {
            const std::size_t i = MomentIndex(l, m);
            expected +=
                cosine[static_cast<std::size_t>(l)] * moment(i) *
                (static_cast<double>(harmonic[i]) - missing * static_cast<double>(upward[i]));
          }
        }
        EXPECT_NEAR(static_cast<double>(found[band]), expected, 2e-5 * moment(0))
            << tilt_deg << " degrees, azimuth " << azimuth << ": sums in single precision";
      }
    }
  }
}

TEST(MultipleScattering, IsTheSameWithEveryInstructionSet) {
  const Medium medium = MediumPreset("hazy");
  const ViewRay ray = RayFromAngles(2.0, 70.0, 30.0, 88.0);
  const auto both = [&] {
    const MultipleScattering light(medium, tests::kSmallLight);
    const auto samples =
        SingleScattering<float>(medium).Sample(ray, {.nodes = 12, .dark_samples = true});
    return std::tuple(light.values(), light.InscatterAlong(samples, ray.nu),
                      light.Irradiance(900.0, 0.1, 0.8, -0.3));
  };
  const InstructionSetScope plain(InstructionSet::kBaseline);
  const auto [values, inscatter, irradiance] = both();
  for (const InstructionSet set : AvailableInstructionSets()) {
    const InstructionSetScope scope(set);
    const auto [found, found_inscatter, found_irradiance] = both();
    EXPECT_TRUE(tests::BandsNear(found, values, 1e-4, 1e-5))
        << NameOf(set) << ": float, summed in another order";
    EXPECT_TRUE(tests::BandsNear(found_inscatter, inscatter, 1e-4));
    EXPECT_TRUE(tests::BandsNear(found_irradiance, irradiance, 1e-4));
  }
}

TEST(MultipleScattering, SkyIrradianceAgreesWithPathTracing) {
  const int compared = stored::Compare(
      "irradiance", [](const stored::Row& row) { return row.at("quantity") == "irradiance_down"; },
      [](const stored::Row& row, const Medium& medium) {
        const auto irradiance =
            StoredLight(row.at("set"), medium)
                .SkyIrradiance(stored::Number(row, "h_m"),
                               std::cos(stored::Number(row, "sza_deg") * kRadiansPerDegree));
        return [irradiance, &row](const stored::Row& expected, std::size_t band) {
          const double truth = stored::Number(expected, "irradiance");
          EXPECT_NEAR(static_cast<double>(irradiance[band]), truth, 0.01 * truth) << row.at("id");
        };
      });
  EXPECT_GE(compared, 9);
}

// Hard case 31.
TEST(MultipleScattering, ThinnestAndThickestLayersHaveLight) {
  for (const auto& [rayleigh_m, mie_m] : {std::pair{200.0, 100.0},
                                          {8000.0, 100.0},
                                          {8000.0, 200e3},
                                          {200e3, 1200.0},
                                          {200e3, 200e3}}) {
    Medium medium = MediumPreset("bruneton2017");
    medium.rayleigh_deficit = {};
    for (double& value : medium.rayleigh_scattering_per_m)
      value *= medium.rayleigh_scale_height_m / rayleigh_m;
    for (auto* list : {&medium.mie_scattering_per_m, &medium.mie_extinction_per_m}) {
      for (double& value : *list) value *= medium.mie_scale_height_m / mie_m;
    }
    medium.rayleigh_scale_height_m = rayleigh_m;
    medium.mie_scale_height_m = mie_m;
    const MultipleScattering light(medium, tests::kSmallLight);
    for (const float value : light.values()) EXPECT_TRUE(std::isfinite(value));
    // More than nothing falls on the ground, and less than the sun.
    const auto sky = light.SkyIrradiance(0.0, 0.7);
    for (std::size_t band = 0; band < sky.size(); ++band) {
      EXPECT_GT(sky[band], 0.0F) << rayleigh_m << " " << mie_m;
      EXPECT_LT(sky[band], 1.0F) << rayleigh_m << " " << mie_m;
    }
  }
}

// Hard case 29.
TEST(MultipleScattering, MissingOrdersAreReportedAtOpticalDepthFifty) {
  Medium medium = MediumPreset("bruneton2017");
  for (std::size_t band = 0; band < medium.wavelengths_nm.size(); ++band) {
    medium.mie_extinction_per_m[band] = 50.0 / medium.mie_scale_height_m;
    medium.mie_scattering_per_m[band] = 0.99 * medium.mie_extinction_per_m[band];
  }
  MultipleScatteringOptions options = tests::kSmallLight;
  std::vector<float> brightest;
  for (const int orders : {5, 400, 800}) {
    options.max_orders = orders;
    const MultipleScattering light(medium, options);
    EXPECT_EQ(light.converged(), orders > 5) << orders;
    for (const float value : light.values()) EXPECT_TRUE(std::isfinite(value));
    brightest.push_back(light.SkyIrradiance(1e4, 0.7)[0]);
  }
  EXPECT_EQ(brightest[1], brightest[2]) << "what has converged asks for no further orders";
}

Medium ThickMolecules(double optical_depth) {
  Medium medium = MediumPreset("earth", {550.0});
  medium.rayleigh_deficit = {};
  medium.ground_albedo = {0.1};
  medium.rayleigh_scale_height_m = 8000.0;
  medium.rayleigh_scattering_per_m = {optical_depth / medium.rayleigh_scale_height_m};
  medium.mie_scattering_per_m = medium.mie_extinction_per_m = {0.0};
  medium.ozone_absorption_per_m = {0.0};
  return medium;
}

TEST(MultipleScattering, MediaWithMissingOrdersAreNamedOnStandardError) {
  MultipleScatteringOptions few = tests::kSmallLight;
  few.max_orders = 20;
  int airs = 0;
  for (const double depth : {20.0, 30.0, 20.0}) {
    Medium thick = ThickMolecules(depth);
    thick.name = "the thick test";
    testing::internal::CaptureStderr();
    EXPECT_FALSE(MultipleScattering(thick, few).converged())
        << "the light on the ground still increases from order to order";
    const std::string said = testing::internal::GetCapturedStderr();
    if (++airs <= 2) {
      EXPECT_EQ(said.find("alpenglow: warning: the air of the thick test is too thick"), 0U)
          << said;
    } else {
      EXPECT_EQ(said, "") << "the air of the first warning";
    }
  }
}

// The irradiances are those of 1e6 paths each of scalar light through a plane layer, with a standard
// error of 0.2 to 0.6 %; the curvature of the planet changes them by less than 1 %.
TEST(MultipleScattering, LightBelowThickMoleculesAgreesWithPaths) {
  struct Layer {
    double depth, albedo, sun_60, sun_0;
  };
  std::vector<Layer> layers{{20.0, 0.0, 0.026907, 0.078704}, {40.0, 0.8, 0.061916, 0.180633}};
  layers.resize(tests::ScaledDown(layers.size(), std::size_t{1}));
  for (const auto& [depth, albedo, sun_60, sun_0] : layers) {
    Medium medium = ThickMolecules(depth);
    medium.polarised = false;
    medium.ground_albedo = {albedo};
    MultipleScatteringOptions options = OptionsFor(medium);
    options.degree = 2;
    options.sun_angles = tests::ScaledDown(options.sun_angles, 12);
    const MultipleScattering light(medium, options);
    EXPECT_TRUE(light.converged()) << depth;
    EXPECT_LT(light.orders(), 120) << "single orders would be 200 to 2000";
    for (const auto& [mu_s, paths] : {std::pair{0.5, sun_60}, {1.0, sun_0}}) {
      EXPECT_NEAR(static_cast<double>(light.SkyIrradiance(0.0, mu_s)[0]) / paths, 1.0,
                  depth > 20.0 ? 0.06 : 0.03)
          << depth << " " << albedo << " " << mu_s
          << ": measured; without exact weights of the marches 25 % is missing at 20";
    }
  }
}

// The irradiances are those of 1e6 paths through a plane layer, with a standard error of 0.1 to
// 0.2 %.
TEST(MultipleScattering, LightBelowThickFogAgreesWithPaths) {
  Medium medium = ThickMolecules(0.0);
  medium.polarised = false;
  medium.mie_scale_height_m = 1200.0;
  medium.mie_phase = {tests::LobeOf(0.85)};
  medium.mie_scattering_per_m = medium.mie_extinction_per_m = {15.65 / 1200.0};
  MultipleScatteringOptions options = OptionsFor(medium);
  options.sun_angles = 12;
  options.max_orders = 40;
  const MultipleScattering light(medium, options);
  for (const auto& [mu_s, paths] : {std::pair{0.5, 0.16367}, {1.0, 0.47967}}) {
    EXPECT_NEAR(static_cast<double>(light.SkyIrradiance(0.0, mu_s)[0]) / paths, 1.0, 0.02)
        << mu_s << ": measured; with fewer directions the light is 50 % too bright";
  }
}

// The irradiance is that of skylut eval --method path-trace --max-error 3%: 0.0352, with a standard
// error of 0.001. It contains polarisation.
TEST(MultipleScattering, PolarisedLightBelowThickMoleculesAgreesWithPaths) {
  const Medium thick = ThickMolecules(16.0);
  MultipleScatteringOptions options = OptionsFor(thick);
  options.sun_angles = tests::ScaledDown(options.sun_angles, 12);
  const MultipleScattering light(thick, options);
  EXPECT_TRUE(light.converged());
  EXPECT_NEAR(static_cast<double>(light.SkyIrradiance(0.0, 0.5)[0]) / 0.0352, 1.0, 0.06)
      << "two standard errors";
}

TEST(MultipleScattering, DefaultOptionsAreAccurateForThickMolecules) {
  Medium medium = ThickMolecules(5.0);
  medium.ground_albedo = {0.0};
  MultipleScatteringOptions options;
  options.degree = 2;
  options.sun_angles = 16;
  EXPECT_NEAR(static_cast<double>(MultipleScattering(medium, options).SkyIrradiance(0.0, 0.5)[0]) /
                  0.090627,
              1.0, 0.02)
      << "as above; without exact weights 12 % is missing";
}

// The irradiances are those of reference::TraceIrradiance, to 0.4 %, in the
// blue under the lower sun to 0.8 %.
TEST(MultipleScattering, NarrowPeaksLightTheGround) {
  const Medium mars = MediumPreset("mars", {450.0, 650.0});
  const MultipleScattering light(mars);
  const std::pair<double, std::array<double, 2>> traced[] = {{20.0, {0.229906, 0.324081}},
                                                             {60.0, {0.164096, 0.229872}}};
  for (const auto& [sun_zenith_deg, truth] : traced) {
    const double mu_s = std::cos(sun_zenith_deg * kRadiansPerDegree);
    const Spectrum found = light.SkyIrradiance(0.0, mu_s);
    for (std::size_t band = 0; band < found.size(); ++band) {
      EXPECT_NEAR(static_cast<double>(found[band]) / truth[band], 1.0, 0.05)
          << sun_zenith_deg
          << ": 4 standard errors and 3 %; without the peak 10 to 40 % are missing";
      EXPECT_EQ(light.SkyIrradiance(mars.atmosphere_height_m, mu_s)[band], 0.0F) << "no sky there";
    }
  }
}

}  // namespace
}  // namespace alpenglow::lut
