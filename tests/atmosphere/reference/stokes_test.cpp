// SPDX-License-Identifier: MIT
// Polarised light by the path tracer.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/lorenz_mie.h"
#include "atmosphere/reference/path_tracer.h"
#include "atmosphere/reference/reference_solution.h"
#include "tests/fixtures/polarised_slab.h"
#include "tests/fixtures/stored_cases.h"

namespace alpenglow::atmosphere::reference {
namespace {

PolarisedScattering RoundMolecules(const Medium& medium) {
  return {std::vector<double>(medium.wavelengths_nm.size(), 0.0)};
}

Medium WithoutAerosol(const char* preset) {
  Medium medium = MediumPreset(preset);
  std::fill(medium.mie_scattering_per_m.begin(), medium.mie_scattering_per_m.end(), 0.0);
  std::fill(medium.mie_extinction_per_m.begin(), medium.mie_extinction_per_m.end(), 0.0);
  return medium;
}

TEST(PathTracedStokes, AreThePublishedOnesOfALayerOfMolecules) {
  for (const slab::Row& row : slab::kRows) {
    const Medium medium = slab::Layer(row.tau, row.albedo);
    const PathTracedStokes traced = TraceStokes(medium, RoundMolecules(medium), slab::RayOf(row),
                                                {.max_paths = 16000, .relative_error = 0.003});
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
    EXPECT_LT(traced.i.standard_error[0], 0.005 * traced.i.total[0]);
    EXPECT_LT(std::max(traced.q.standard_error[0], traced.u.standard_error[0]),
              0.005 * traced.i.total[0]);
  }
}

// Light that was scattered once vibrates across the plane of view and sun.
TEST(PathTracedStokes, OrderOneVibratesAcrossThePlaneOfTheSunAsStrongAsRayleighSaid) {
  Medium medium = WithoutAerosol("bruneton2017");
  std::fill(medium.ground_albedo.begin(), medium.ground_albedo.end(), 0.0);
  constexpr double kDepolarisation = 0.03;
  for (const double azimuth_deg : {0.0, 50.0, 140.0}) {
    for (const double view_deg : {0.0, 60.0, 150.0}) {
      const ViewRay ray = RayFromAngles(5000.0, view_deg, azimuth_deg, 70.0);
      const RayRadiance round = SingleScatteringAlong(medium, ray);
      const PathTracedStokes traced = TraceStokes(medium, {std::vector<double>(3, kDepolarisation)},
                                                  ray, {.max_paths = 8000, .max_order = 1});
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

TEST(PathTracedStokes, AerosolAndGroundThatDepolariseLeaveScalarLight) {
  Medium medium = MediumPreset("hazy");
  std::fill(medium.rayleigh_scattering_per_m.begin(), medium.rayleigh_scattering_per_m.end(), 0.0);
  const ViewRay ray = RayFromAngles(100.0, 80.0, 30.0, 60.0);
  const PathTracedRadiance scalar = TraceRadiance(medium, ray, {.max_paths = 8000});
  const PathTracedStokes traced =
      TraceStokes(medium, RoundMolecules(medium), ray, {.max_paths = 8000});
  for (std::size_t band = 0; band < scalar.total.size(); ++band) {
    EXPECT_NEAR(traced.i.total[band], scalar.total[band], 1e-12 * scalar.total[band])
        << "the same paths";
    EXPECT_EQ(traced.q.total[band], 0.0);
    EXPECT_EQ(traced.u.total[band], 0.0);
  }
}

// The same air, called molecules and called small spheres.
TEST(PathTracedStokes, SmallSpheresOfLorenzAndMieAreMolecules) {
  const Medium molecules = WithoutAerosol("bruneton2017");
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
  const PathOptions options{.max_paths = 16000, .relative_error = 0.002};
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

TEST(PathTracedStokes, RefuseWhatIsNoScattering) {
  const Medium medium = MediumPreset("bruneton2017");
  const ViewRay ray = RayFromAngles(0.0, 10.0, 0.0, 20.0);
  const SphereRatios lame{.a3 = {1.0, -1.0}, .b1 = {0.0}, .b2 = {0.0, 0.0}};
  EXPECT_THROW(TraceStokes(medium, {{0.03}}, ray), InputError) << "three wavelengths";
  EXPECT_THROW(TraceStokes(medium, {{0.0, 0.0, 0.6}}, ray), InputError);
  EXPECT_THROW(TraceStokes(medium, {{0.0, 0.0, 0.0}, {lame}}, ray), InputError);
  EXPECT_THROW(TraceStokes(medium, {{0.0, 0.0, 0.0}, {{}, {}}}, ray), InputError);
}

void ExpectStoredStokes(const std::set<std::string>& ids) {
  if (!stored::Available()) GTEST_SKIP() << "no stored cases at " << stored::Folder();
  const auto media = stored::Media();
  const auto results = stored::Results("polarised_results.csv");
  std::size_t compared = 0;
  for (const stored::Row& row : stored::Read("polarised.csv")) {
    if (ids.count(row.at("id")) == 0) continue;
    const Medium& medium = media.at(row.at("set"));
    const std::vector<double> depolarisation(medium.wavelengths_nm.size(),
                                             stored::Number(row, "depolarisation"));
    const PathTracedStokes traced = TraceStokes(medium, {depolarisation}, stored::RayOf(row),
                                                {.max_paths = 60000, .relative_error = 0.004});
    // Azimuths beyond 180 degrees have the sun to the right of the view.
    const double side = stored::Number(row, "raz_deg") > 180.0 ? -1.0 : 1.0;
    for (const stored::Row& result : results.at(row.at("id"))) {
      const std::size_t band = stored::Band(medium, result);
      const auto expect = [&](const std::string& name, const PathTracedRadiance& part,
                              double sign) {
        const double error =
            std::hypot(stored::Number(result, name + "_std_err"), part.standard_error[band]);
        EXPECT_NEAR(part.total[band], sign * stored::Number(result, name), 4.0 * error)
            << row.at("id") << " " << name << " " << medium.wavelengths_nm[band]
            << " nm: four standard errors";
        EXPECT_LT(part.standard_error[band], 0.01 * stored::Number(result, "I"))
            << row.at("id") << " " << name;
      };
      expect("I", traced.i, 1.0);
      expect("Q", traced.q, 1.0);
      expect("U", traced.u, side);
    }
    ++compared;
  }
  EXPECT_EQ(compared, ids.size());
}

TEST(PathTracedStokes, AgreeWithStoredSkies) {
  ExpectStoredStokes({"P000", "P012", "P016", "P032", "P040", "P044"});
}
TEST(PathTracedStokes, AgreeWithStoredTwilightAndViewsFromSpace) {
  ExpectStoredStokes({"P004", "P020", "P024", "P028"});
}

}  // namespace
}  // namespace alpenglow::atmosphere::reference
