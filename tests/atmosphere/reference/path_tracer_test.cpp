// SPDX-License-Identifier: MIT
#include "atmosphere/reference/path_tracer.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <array>
#include <atomic>
#include <cmath>
#include <iterator>
#include <set>
#include <span>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/reference/column_table.h"
#include "atmosphere/reference/path_sampling.h"
#include "atmosphere/reference/reference_solution.h"
#include "tests/fixtures/lorenz_mie.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/polarised_slab.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/stored_cases.h"

namespace alpenglow::atmosphere::reference {
namespace {

/// Every call traces at least 32 batches, of 251 paths each.
constexpr std::size_t kFewest = 32 * kPathsPerBatch;

Medium WithoutAbsorption() {
  Medium medium = MediumPreset("bruneton2017");
  medium.mie_scattering_per_m = medium.mie_extinction_per_m;
  medium.ozone_absorption_per_m.assign(3, 0.0);
  medium.ground_albedo.assign(3, 1.0);
  return medium;
}

Medium Empty(double albedo) {
  Medium medium = tests::WithoutAir(MediumPreset("bruneton2017"));
  medium.ground_albedo.assign(3, albedo);
  return medium;
}

TEST(ColumnTable, AgreesWithTheReferenceToOnePartInAMillion) {
  for (const char* name : {"earth", "hazy", "bruneton2017", "mars"}) {
    const Medium medium = MediumPreset(name);
    const ColumnTable table(medium);
    for (int i = 0; i < 200; ++i) {
      const double altitude = medium.atmosphere_height_m * std::pow((i % 20) / 19.5, 2.0);
      const double radius = medium.planet_radius_m + altitude;
      const double horizon =
          -std::sqrt(altitude * (radius + medium.planet_radius_m)) / radius + 1e-9;
      const double mu = horizon + (1.0 - horizon) * std::pow(i / 20 / 9.0, 2.0);
      const AirColumns columns =
          table.ToSpace(radius * std::sqrt((1.0 - mu) * (1.0 + mu)), radius * mu);
      const OpticalDepth truth = OpticalDepthAlong(medium, {altitude, mu, 1.0, mu});
      for (std::size_t band = 0; band < truth.tau.size(); ++band) {
        const double tau = medium.rayleigh_scattering_per_m[band] * columns.rayleigh +
                           medium.mie_extinction_per_m[band] * columns.mie +
                           medium.ozone_absorption_per_m[band] * columns.ozone;
        EXPECT_NEAR(tau, truth.tau[band], 1e-6 * truth.tau[band] + 1e-12)
            << name << " altitude " << altitude << " mu " << mu << ": cubic interpolation";
      }
    }
  }
}

TEST(PathTracer, FirstOrderIsTheIntegralOfSingleScattering) {
  const Medium medium = MediumPreset("bruneton2017");
  const std::pair<double, double> views[] = {
      {0.0, 20.0}, {0.0, 88.0}, {10000.0, 108.0}, {400000.0, 108.0}, {400000.0, 140.0}};
  constexpr std::array kSuns_deg{30.0, 92.0, 85.0, 96.0};
  for (const double sun_deg : std::span(kSuns_deg).first(tests::ScaledDown<std::size_t>(4, 2))) {
    for (const auto& [altitude, view_deg] : views) {
      const double azimuth_deg = view_deg < 100.0 ? 10.0 : 120.0;
      const ViewRay ray = RayFromAngles(altitude, view_deg, azimuth_deg, sun_deg);
      const RayRadiance truth = SingleScatteringAlong(medium, ray);
      const PathTracedRadiance traced =
          TraceRadiance(medium, ray, {.max_paths = kFewest, .max_order = 1});
      ASSERT_EQ(traced.single.size(), 3U);
      for (std::size_t band = 0; band < 3; ++band) {
        const double expected = truth.inscatter[band] + truth.ground[band];
        EXPECT_NEAR(traced.single[band], expected,
                    4.0 * traced.single_standard_error[band] + 3e-6 * expected + 1e-15)
            << altitude << " m, view " << view_deg << ", sun " << sun_deg
            << ": four standard errors and the columns' error of 1e-6";
        EXPECT_EQ(traced.single[band], traced.total[band]);
      }
    }
  }
}

// The truth is the mean of 2^17 paths, to 0.05 %. Paths whose roulette ignored the aureole were 1 %
// too dark, four times their standard error, or one of them was as bright as hundreds.
TEST(PathTracer, FindsTheLightOfANarrowPeakWithATrueError) {
  Medium mist = InScalarLight(MediumPreset("earth", {550.0}));
  mist.mie_phase = {DropletPhase(50.0)};
  mist.mie_extinction_per_m = {0.5 / 1200.0};
  mist.mie_scattering_per_m = {0.97 * 0.5 / 1200.0};
  const ViewRay ray = RayFromAngles(2.0, 50.0, 30.0, 50.0);
  for (const std::uint64_t seed : {5U, 6U, 7U}) {
    const PathTracedRadiance traced =
        TraceRadiance(mist, ray,
                      {.seed = seed,
                       .max_paths = tests::ScaledDown(1U << 13U, 1U << 11U),
                       .relative_error = 0.0});
    EXPECT_LT(traced.standard_error[0], 0.01 * traced.total[0]);
    EXPECT_NEAR(traced.total[0], 0.1644, 3.5 * traced.standard_error[0]) << "seed " << seed;
  }
}

// Every band is scattered its own way.
TEST(PathTracer, BandsOfDifferentPhaseFunctionsAreTracedTogether) {
  Medium medium = MediumPreset("bruneton2017");
  medium.mie_phase.clear();
  for (const double g : {0.2, 0.5, 0.85}) {
    medium.mie_phase.push_back(tests::LobeOf(g));
  }
  const ViewRay ray = RayFromAngles(2.0, 70.0, 30.0, 80.0);
  const int orders = tests::ScaledDown(PathOptions{}.max_order, 2);
  const PathTracedRadiance together =
      TraceRadiance(medium, ray, {.max_paths = kFewest, .max_order = orders});
  for (std::size_t band = 0; band < 3; ++band) {
    Medium alone = medium;
    alone.mie_phase = {medium.mie_phase[band]};
    const PathTracedRadiance other =
        TraceRadiance(alone, ray, {.seed = 5, .max_paths = kFewest, .max_order = orders});
    EXPECT_NEAR(together.total[band], other.total[band],
                4.0 * std::hypot(together.standard_error[band], other.standard_error[band]))
        << "band " << band << ": four standard errors";
  }
}

TEST(PathTracer, OmitsLightFromTheGroundAtTheEndOfASegment) {
  const Medium medium = Empty(1.0);
  ViewRay ray = RayFromAngles(1000.0, 180.0, 0.0, 60.0);
  EXPECT_NEAR(TraceRadiance(medium, ray).total[0], 0.5 / kPi, 1e-9)
      << "a white ground without air: cos 60 over pi";
  ray.length_m = 999.0;
  EXPECT_EQ(TraceRadiance(medium, ray).total[0], 0.0);
}

// Hard case 28.
TEST(PathTracer, EmptyAirOverABlackPlanetIsBlack) {
  const Medium medium = Empty(0.0);
  for (const double view_deg : {0.0, 89.0, 150.0}) {
    const auto traced = TraceRadiance(medium, RayFromAngles(1000.0, view_deg, 20.0, 40.0));
    for (const double value : traced.total) EXPECT_EQ(value, 0.0);
    for (const double error : traced.standard_error) EXPECT_EQ(error, 0.0);
    EXPECT_TRUE(traced.converged);
  }
}

// Hard case 43.
TEST(PathTracer, IsTheSameForAnyNumberOfThreads) {
  const Medium medium = MediumPreset("bruneton2017");
  const ViewRay ray = RayFromAngles(2.0, 80.0, 40.0, 93.0);
  std::vector<std::vector<double>> totals;
  constexpr std::array<std::size_t, 3> kThreads{1, 8, 2};
  for (const std::size_t threads :
       std::span(kThreads).first(tests::ScaledDown<std::size_t>(3, 2))) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    totals.push_back(TraceRadiance(medium, ray, {.max_paths = kFewest, .max_order = 3}).total);
  }
  EXPECT_EQ(totals.front(), totals[1]);
  EXPECT_EQ(totals.front(), totals.back());
}

TEST(PathTracer, StopsSoonOnRequest) {
  PathOptions endless{.max_paths = std::size_t{1} << 40U, .relative_error = 0.0};
  std::atomic<int> asked = 0;
  endless.stopped = [&] { return ++asked > 40; };
  const auto traced =
      TraceRadiance(MediumPreset("bruneton2017"), RayFromAngles(0, 80, 0, 60), endless);
  EXPECT_EQ(traced.paths, 0U);
  EXPECT_FALSE(traced.converged);
}

TEST(PathTracer, StandardErrorsEqualTheScatterBetweenSeeds) {
  // Two orders are enough, because every order has the same statistics.
  constexpr int kSeeds = tests::ScaledDown(30, 10);
  const Medium medium = MediumPreset("bruneton2017");
  const ViewRay ray = RayFromAngles(2.0, 75.0, 60.0, 94.0);
  double sum = 0.0, squares = 0.0, claimed = 0.0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const auto traced = TraceRadiance(
        medium, ray, {.seed = seed, .max_paths = kFewest, .relative_error = 0.0, .max_order = 2});
    sum += traced.total[1] / kSeeds;
    squares += traced.total[1] * traced.total[1] / kSeeds;
    claimed += traced.standard_error[1] * traced.standard_error[1] / kSeeds;
  }
  const double scatter = (squares - sum * sum) * kSeeds / (kSeeds - 1);
  // Chi-square of kSeeds - 1 degrees of freedom, 0.1 % at either end.
  EXPECT_GT(claimed / scatter, tests::ScaledDown(0.50, 0.32));
  EXPECT_LT(claimed / scatter, tests::ScaledDown(2.64, 7.8));
}

// Hard case 30.
TEST(PathTracer, ConservesEnergyWithoutAbsorption) {
  const Medium medium = WithoutAbsorption();
  const double top = medium.planet_radius_m + medium.atmosphere_height_m;
  const std::size_t bands = medium.wavelengths_nm.size();
  // Shares of the light that meets the disk of the shell's radius, which is 1.
  std::vector<double> leaves(bands, 0.0), error(bands, 0.0);
  struct Panel {
    double low, high;
    int nodes;
  };
  // Over zones of the shell: mean of the flux through the top, times two for the sphere. Every node
  // has its own seed, because errors of equal paths would not be independent.
  std::uint64_t seed = 0;
  for (const Panel& panel : {Panel{-0.3, -0.05, tests::ScaledDown(5, 3)},
                             {-0.05, 0.1, tests::ScaledDown(5, 3)},
                             {0.1, 1.0, tests::ScaledDown(7, 4)}}) {
    const GaussRule& rule = GaussLegendre(panel.nodes);
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      const double width = panel.high - panel.low;
      const auto flux = TraceIrradiance(
          medium, medium.atmosphere_height_m, panel.low + width * rule.node[i],
          PlaneSide::kFromBelow,
          {.seed = ++seed, .max_paths = tests::ScaledDown<std::size_t>(2, 1) * kFewest});
      for (std::size_t band = 0; band < bands; ++band) {
        leaves[band] += 2.0 * width * rule.weight[i] * flux.value[band];
        error[band] += std::pow(2.0 * width * rule.weight[i] * flux.standard_error[band], 2.0);
      }
    }
  }
  // Beams that pass the planet without meeting air or ground.
  const GaussRule& rule = GaussLegendre(48);
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double b = medium.planet_radius_m + medium.atmosphere_height_m * rule.node[i];
    const double mu = -std::sqrt((1.0 - b / top) * (1.0 + b / top));
    const auto depth = OpticalDepthAlong(medium, {medium.atmosphere_height_m, mu, 1.0, mu});
    for (std::size_t band = 0; band < bands; ++band) {
      leaves[band] += rule.weight[i] * medium.atmosphere_height_m * 2.0 * b / (top * top) *
                      std::exp(-depth.tau[band]);
    }
  }
  for (std::size_t band = 0; band < bands; ++band) {
    EXPECT_NEAR(leaves[band], 1.0, 4.0 * std::sqrt(error[band]) + 2e-4)
        << "band " << band << ": four standard errors, and the Gauss rules over the zones";
  }
}

TEST(PathTracer, RefusesInvalidRaysAndOptions) {
  const Medium medium = MediumPreset("bruneton2017");
  const ViewRay ray = RayFromAngles(0.0, 10.0, 0.0, 20.0);
  EXPECT_THROW(static_cast<void>(TraceRadiance(medium, ray, {.max_order = 0})), InputError);
  EXPECT_THROW(static_cast<void>(TraceRadiance(medium, ray, {.relative_error = -1.0})), InputError);
  EXPECT_THROW(static_cast<void>(TraceRadiance(medium, ray, {.relative_error = std::nan("")})),
               InputError);
  EXPECT_THROW(static_cast<void>(TraceRadiance(medium, {0.0, std::nan(""), 1.0, 1.0})), InputError);
  EXPECT_THROW(static_cast<void>(TraceIrradiance(medium, -5.0, 0.5, PlaneSide::kFromAbove)),
               InputError);
  EXPECT_THROW(static_cast<void>(TraceIrradiance(medium, 0.0, 1.5, PlaneSide::kFromAbove)),
               InputError);
}

/// Returns the first two of these cases under the sanitizers, otherwise all.
std::set<std::string> TracedIds(std::set<std::string> ids) {
  while (tests::kSanitized && ids.size() > 2) ids.erase(std::prev(ids.end()));
  return ids;
}

// Stored cases have errors of up to half a percent of the value; ours are a little larger.
void ExpectStoredRadiance(const std::set<std::string>& all) {
  const std::set<std::string> ids = TracedIds(all);
  constexpr double kError = tests::ScaledDown(0.008, 0.05);
  const int compared = stored::Compare(
      "multiple", [&](const stored::Row& row) { return ids.contains(row.at("id")); },
      [](const stored::Row& row, const Medium& medium) {
        const auto traced = TraceRadiance(medium, stored::RayOf(row),
                                          {.max_paths = 300000, .relative_error = kError});
        return [traced, &row](const stored::Row& expected, std::size_t band) {
          const double truth = stored::Number(expected, "total");
          const double error =
              std::hypot(stored::Number(expected, "std_err"), traced.standard_error[band]);
          EXPECT_NEAR(traced.total[band], truth, 4.0 * error)
              << row.at("id") << " band " << band << ": four standard errors";
          EXPECT_LE(traced.standard_error[band], 1.1 * kError * truth) << row.at("id");
        };
      });
  EXPECT_GE(compared, 3 * static_cast<int>(ids.size()));
}

TEST(PathTracer, AgreesWithStoredSkiesByDay) {
  ExpectStoredRadiance({"M000", "M004", "M008", "M024", "M028", "M132"});
}
TEST(PathTracer, AgreesWithStoredSkiesAtTheHorizonAndGround) {
  ExpectStoredRadiance({"M012", "M016", "M032", "M036", "M044", "M048", "M052", "M056", "M060"});
}
TEST(PathTracer, AgreesWithStoredSkiesInTwilight) {
  ExpectStoredRadiance({"M064", "M072", "M076", "M080", "M084", "M092", "M096", "M136"});
}
TEST(PathTracer, AgreesWithStoredViewsFromSpaceAndThroughAir) {
  ExpectStoredRadiance({"M100", "M104", "M108", "M112", "M116", "M120", "M128", "M140"});
}

TEST(PathTracer, AgreesWithStoredIrradiance) {
  constexpr double kError = tests::ScaledDown(0.007, 0.03);
  const int compared =
      stored::Compare("irradiance", stored::All, [](const stored::Row& row, const Medium& medium) {
        const PlaneSide side =
            row.at("quantity") == "irradiance_up" ? PlaneSide::kFromBelow : PlaneSide::kFromAbove;
        const auto traced =
            TraceIrradiance(medium, stored::Number(row, "h_m"),
                            std::cos(stored::Number(row, "sza_deg") * kRadiansPerDegree), side,
                            {.max_paths = 200000, .relative_error = kError});
        EXPECT_TRUE(traced.converged) << row.at("id");
        return [traced, &row](const stored::Row& expected, std::size_t band) {
          const double error =
              std::hypot(stored::Number(expected, "std_err"), traced.standard_error[band]);
          EXPECT_NEAR(traced.value[band], stored::Number(expected, "irradiance"), 4.0 * error)
              << row.at("id") << ": four standard errors";
        };
      });
  EXPECT_EQ(compared, 15);
}

PolarisedScattering RoundMolecules(const Medium& medium) {
  return {std::vector<double>(medium.wavelengths_nm.size(), 0.0)};
}

TEST(PathTracedStokes, AgreeWithPublishedValuesOfAMolecularLayer) {
  for (const slab::Row& row : std::span(slab::kRows).last(tests::ScaledDown<std::size_t>(9, 3))) {
    const Medium medium = slab::Layer(row.tau, row.albedo);
    const PathTracedStokes traced = TraceStokes(medium, RoundMolecules(medium), slab::RayOf(row),
                                                {.max_paths = kFewest, .relative_error = 0.003});
    const slab::Stokes truth = slab::Seen(row);
    // Four standard errors. The planet is not flat: 1e-6 / mu^2, 3e-5 at the lowest light.
    const auto expect = [&](const char* name, const PathTracedRadiance& part, double published) {
      EXPECT_NEAR(part.total[0], published, 4.0 * part.standard_error[0] + 3e-5 * truth.i)
          << name << ": depth " << row.tau << ", mu " << row.mu << ", sun " << row.mu0
          << ", azimuth " << row.azimuth_deg << (row.up ? ", from above" : ", from below");
    };
    expect("I", traced.i, truth.i);
    expect("Q", traced.q, truth.q);
    expect("U", traced.u, truth.u);
    EXPECT_LT(std::max({traced.i.standard_error[0], traced.q.standard_error[0],
                        traced.u.standard_error[0]}),
              0.007 * traced.i.total[0]);
  }
}

// Light that was scattered once vibrates across the plane of view and sun.
TEST(PathTracedStokes, FirstOrderVibratesAcrossThePlaneOfTheSun) {
  Medium medium = tests::WithoutAerosol(MediumPreset("bruneton2017"));
  std::fill(medium.ground_albedo.begin(), medium.ground_albedo.end(), 0.0);
  constexpr double kDepolarisation = 0.03;
  for (const double azimuth_deg : {0.0, 50.0, 140.0}) {
    for (const double view_deg : {0.0, 60.0, 150.0}) {
      const ViewRay ray = RayFromAngles(5000.0, view_deg, azimuth_deg, 70.0);
      const RayRadiance round = SingleScatteringAlong(medium, ray);
      const PathTracedStokes traced = TraceStokes(medium, {std::vector<double>(3, kDepolarisation)},
                                                  ray, {.max_paths = kFewest, .max_order = 1});
      // Upwards in the picture and to the right, of the sun beside the view.
      const double zenith = view_deg * kRadiansPerDegree, sun = 70.0 * kRadiansPerDegree;
      const double azimuth = view_deg > 0.0 ? azimuth_deg * kRadiansPerDegree : 0.0;
      const double up =
          std::sin(zenith) * std::cos(sun) - std::cos(zenith) * std::sin(sun) * std::cos(azimuth);
      const double right = -std::sin(sun) * std::sin(azimuth);
      const ScatteringMatrix matrix = RayleighMatrix(kDepolarisation, ray.nu);
      for (std::size_t band = 0; band < 3; ++band) {
        const double i = round.inscatter[band] * matrix.a1 / RayleighMatrix(0.0, ray.nu).a1;
        const double q =
            i * matrix.b1 / matrix.a1 * (up * up - right * right) / (up * up + right * right);
        const double u = i * matrix.b1 / matrix.a1 * 2.0 * up * right / (up * up + right * right);
        // Four standard errors, and the columns' error of 1e-6.
        EXPECT_NEAR(traced.i.total[band], i, 4.0 * traced.i.standard_error[band] + 3e-6 * i);
        EXPECT_NEAR(traced.q.total[band], q, 4.0 * traced.q.standard_error[band] + 3e-6 * i);
        EXPECT_NEAR(traced.u.total[band], u, 4.0 * traced.u.standard_error[band] + 3e-6 * i);
      }
    }
  }
}

TEST(PathTracedStokes, DepolarisingAerosolAndGroundLeaveScalarLight) {
  Medium medium = MediumPreset("hazy");
  std::fill(medium.rayleigh_scattering_per_m.begin(), medium.rayleigh_scattering_per_m.end(), 0.0);
  const ViewRay ray = RayFromAngles(100.0, 80.0, 30.0, 60.0);
  const PathTracedRadiance scalar = TraceRadiance(medium, ray, {.max_paths = kFewest});
  const PathTracedStokes traced =
      TraceStokes(medium, RoundMolecules(medium), ray, {.max_paths = kFewest});
  for (std::size_t band = 0; band < scalar.total.size(); ++band) {
    EXPECT_NEAR(traced.i.total[band], scalar.total[band], 1e-12 * scalar.total[band])
        << "the same paths";
    EXPECT_EQ(traced.q.total[band], 0.0);
    EXPECT_EQ(traced.u.total[band], 0.0);
  }
}

// One medium is described twice: as molecules and as small spheres.
TEST(PathTracedStokes, SmallMieSpheresScatterLikeMolecules) {
  const Medium molecules = tests::WithoutAerosol(MediumPreset("bruneton2017"));
  Medium spheres = molecules;
  std::swap(spheres.mie_scattering_per_m, spheres.rayleigh_scattering_per_m);
  spheres.mie_extinction_per_m = spheres.mie_scattering_per_m;
  spheres.mie_scale_height_m = molecules.rayleigh_scale_height_m;
  spheres.mie_phase = {{.kind = PhaseKind::kRayleigh}};
  PolarisedScattering scattering = RoundMolecules(spheres);
  std::vector<double> angles;
  constexpr int kSteps = 180;
  for (int i = 0; i <= kSteps; ++i) angles.push_back(kPi * i / kSteps);
  scattering.aerosol = {ScatterBySphere({1.33, 0.0}, 0.01, angles).polarised};
  const ViewRay ray = RayFromAngles(0.0, 75.0, 60.0, 80.0);
  const PathOptions options{.max_paths = kFewest, .relative_error = 0.002};
  const PathTracedStokes a = TraceStokes(molecules, RoundMolecules(molecules), ray, options);
  const PathTracedStokes b = TraceStokes(spheres, scattering, ray, options);
  for (std::size_t band = 0; band < 3; ++band) {
    const auto expect = [&](const PathTracedRadiance& one, const PathTracedRadiance& other) {
      EXPECT_NEAR(one.total[band], other.total[band],
                  4.0 * std::hypot(one.standard_error[band], other.standard_error[band]) +
                      3e-4 * a.i.total[band])
          << "four standard errors; ratios are lines over a degree, 3e-4";
    };
    expect(a.i, b.i);
    expect(a.q, b.q);
    expect(a.u, b.u);
  }
}

TEST(PathTracedStokes, RefuseInvalidScatteringMatrices) {
  const Medium medium = MediumPreset("bruneton2017");
  const ViewRay ray = RayFromAngles(0.0, 10.0, 0.0, 20.0);
  const SphereRatios lame{.a3 = {1.0, -1.0}, .b1 = {0.0}, .b2 = {0.0, 0.0}};
  EXPECT_THROW(static_cast<void>(TraceStokes(medium, {{0.03}}, ray)), InputError)
      << "three wavelengths";
  EXPECT_THROW(static_cast<void>(TraceStokes(medium, {{0.0, 0.0, 0.6}}, ray)), InputError);
  EXPECT_THROW(static_cast<void>(TraceStokes(medium, {{0.0, 0.0, 0.0}, {lame}}, ray)), InputError);
  EXPECT_THROW(static_cast<void>(TraceStokes(medium, {{0.0, 0.0, 0.0}, {{}, {}}}, ray)),
               InputError);
}

void ExpectStoredStokes(const std::set<std::string>& all) {
  const std::set<std::string> ids = TracedIds(all);
  constexpr double kError = tests::ScaledDown(0.008, 0.05);
  const int compared = stored::Compare(
      "polarised", [&](const stored::Row& row) { return ids.contains(row.at("id")); },
      [](const stored::Row& row, const Medium& medium) {
        const std::vector<double> depolarisation(medium.wavelengths_nm.size(),
                                                 stored::Number(row, "depolarisation"));
        const PathTracedStokes traced = TraceStokes(medium, {depolarisation}, stored::RayOf(row),
                                                    {.max_paths = 60000, .relative_error = kError});
        // Azimuths beyond 180 degrees have the sun to the right of the view.
        const double side = stored::Number(row, "raz_deg") > 180.0 ? -1.0 : 1.0;
        return [traced, side, &row](const stored::Row& result, std::size_t band) {
          const auto expect = [&](const std::string& name, const PathTracedRadiance& part,
                                  double sign) {
            const double error =
                std::hypot(stored::Number(result, name + "_std_err"), part.standard_error[band]);
            EXPECT_NEAR(part.total[band], sign * stored::Number(result, name), 4.0 * error)
                << row.at("id") << " " << name << " band " << band << ": four standard errors";
            EXPECT_LT(part.standard_error[band], 1.5 * kError * stored::Number(result, "I"))
                << row.at("id") << " " << name;
          };
          expect("I", traced.i, 1.0);
          expect("Q", traced.q, 1.0);
          expect("U", traced.u, side);
        };
      });
  EXPECT_GE(compared, 3 * static_cast<int>(ids.size()));
}

TEST(PathTracedStokes, AgreeWithStoredSkies) {
  ExpectStoredStokes({"P000", "P012", "P016", "P032", "P040", "P044"});
}
TEST(PathTracedStokes, AgreeWithStoredTwilightAndViewsFromSpace) {
  ExpectStoredStokes({"P004", "P020", "P024", "P028"});
}

}  // namespace
}  // namespace alpenglow::atmosphere::reference
