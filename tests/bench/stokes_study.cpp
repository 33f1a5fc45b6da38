// SPDX-License-Identifier: MIT
// Studies polarised light by the path tracer: its difference from the stored tables of Natraj, Li
// and Yung (2009) and from the stored cases on the sphere (both in the shared folder that tests
// use), the error of scalar light, the change due to aerosol that does not depolarise, and the
// computing time. Run by hand: studies stokes_study [slab|sphere|aerosol|time].
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/medium/phase_table.h"
#include "atmosphere/reference/path_tracer.h"
#include "tests/bench/studies.h"
#include "tests/fixtures/lorenz_mie.h"
#include "tests/fixtures/polarised_slab.h"
#include "tests/fixtures/stored_cases.h"

namespace alpenglow::atmosphere {
namespace {

/// Statistics of many differences.
class Spread {
 public:
  void Add(double value) {
    ++count_;
    squares_ += value * value;
    largest_ = std::max(largest_, std::abs(value));
  }
  [[nodiscard]] double Rms() const { return std::sqrt(squares_ / std::max(count_, 1)); }
  [[nodiscard]] double largest() const { return largest_; }
  [[nodiscard]] int count() const { return count_; }

 private:
  int count_ = 0;
  double squares_ = 0.0, largest_ = 0.0;
};

/// Differences of I, Q and U from the reference, relative to I and to their standard errors.
struct Comparison {
  Spread i, polarised, in_errors, error_of_i, scalar;

  void Add(const reference::PathTracedStokes& traced, std::size_t band, const slab::Stokes& truth,
           const slab::Stokes& errors) {
    const auto one = [&](const reference::PathTracedRadiance& part, double value, double error) {
      const double difference = part.total[band] - value;
      const double sigma = std::hypot(part.standard_error[band], error);
      if (sigma > 1e-12 * truth.i) in_errors.Add(difference / sigma);  // else rounding
      return difference;
    };
    i.Add(one(traced.i, truth.i, errors.i) / truth.i);
    polarised.Add(std::hypot(one(traced.q, truth.q, errors.q), one(traced.u, truth.u, errors.u)) /
                  truth.i);
    error_of_i.Add(std::hypot(traced.i.standard_error[band], errors.i) / truth.i);
  }
  void Print(const std::string& name) const {
    fmt::print("| {} | {} | {:.3f} / {:.3f} % | {:.3f} % | {:.3f} / {:.3f} % | {:.2f} / {:.1f} |",
               name, i.count(), 100.0 * i.Rms(), 100.0 * i.largest(), 100.0 * error_of_i.Rms(),
               100.0 * polarised.Rms(), 100.0 * polarised.largest(), in_errors.Rms(),
               in_errors.largest());
    fmt::print(" {:.1f} / {:.1f} % |\n", 100.0 * scalar.Rms(), 100.0 * scalar.largest());
  }
};

void PrintHead() {
  fmt::print(
      "| | values | I, rms / max | standard error of I | Q and U over I | in standard errors |"
      " scalar I |\n|---|---|---|---|---|---|---|\n");
}

reference::PolarisedScattering Molecules(const Medium& medium, double depolarisation) {
  return {std::vector<double>(medium.wavelengths_nm.size(), depolarisation)};
}

slab::Row FromCells(const stored::Row& row) {
  return {stored::Number(row, "tau"), stored::Number(row, "albedo"), row.at("direction") == "UP",
          stored::Number(row, "mu0"), stored::Number(row, "mu"),     stored::Number(row, "phi_deg"),
          stored::Number(row, "i"),   stored::Number(row, "q"),      stored::Number(row, "u")};
}

// For views straight up and down, the tracer has the sun straight ahead; for other views, at an
// azimuth.
slab::Stokes Ahead(const slab::Stokes& seen, bool down, double azimuth_deg) {
  const double twice = 2.0 * azimuth_deg * kRadiansPerDegree;
  return {seen.i, seen.q * std::cos(twice) + (down ? -seen.u : seen.u) * std::sin(twice), 0.0};
}

// Compares every 37th row with mu, mu0 >= 0.15.
void PrintSlab() {
  fmt::print("\nSlabs of molecules, every 37th row with mu, mu0 >= 0.15\n\n");
  PrintHead();
  std::map<std::string, Comparison> comparisons;
  std::size_t number = 0;
  for (const stored::Row& cells : stored::ReadData("tables/rayleigh_slab_stokes_natraj2009.csv")) {
    const slab::Row row = FromCells(cells);
    if (row.mu < 0.15 || row.mu0 < 0.15 || ++number % 37 != 0) continue;
    const Medium medium = slab::Layer(row.tau, row.albedo);
    const ViewRay ray = slab::RayOf(row);
    const reference::PathOptions options{
        .seed = number, .max_paths = 400000, .relative_error = 0.001};
    const auto traced = reference::TraceStokes(medium, Molecules(medium, 0.0), ray, options);
    const double scalar = reference::TraceRadiance(medium, ray, options).total[0];
    slab::Stokes truth = slab::Seen(row);
    if (row.mu == 1.0) truth = Ahead(truth, row.up, row.azimuth_deg);
    Comparison& all = comparisons[fmt::format("depth {}, albedo {}", row.tau, row.albedo)];
    all.Add(traced, 0, truth, {5e-9, 5e-9, 5e-9});
    all.scalar.Add(scalar / truth.i - 1.0);
  }
  for (const auto& [name, comparison] : comparisons) comparison.Print(name);
}

// If the azimuth of a case is beyond 180 degrees, the sun is on the other side.
slab::Stokes AsTraced(const stored::Row& row, const stored::Row& result) {
  const double zenith_deg = stored::Number(row, "vza_deg");
  const double azimuth_deg = stored::Number(row, "raz_deg");
  const slab::Stokes stokes{stored::Number(result, "I"), stored::Number(result, "Q"),
                            stored::Number(result, "U")};
  if (zenith_deg == 0.0 || zenith_deg == 180.0)
    return Ahead(stokes, zenith_deg > 90.0, azimuth_deg);
  return {stokes.i, stokes.q, azimuth_deg > 180.0 ? -stokes.u : stokes.u};
}

void PrintSphere() {
  fmt::print("\nStored cases on the sphere\n\n");
  PrintHead();
  std::map<std::string, Comparison> comparisons;
  const auto media = stored::Media();
  const auto results = stored::Results("polarised_results.csv");
  for (const stored::Row& row : stored::Read("polarised.csv")) {
    const Medium& medium = media.at(row.at("set"));
    const auto traced =
        reference::TraceStokes(medium, Molecules(medium, stored::Number(row, "depolarisation")),
                               stored::RayOf(row), {.max_paths = 2000000, .relative_error = 0.001});
    Comparison one;
    for (const stored::Row& result : results.at(row.at("id"))) {
      const slab::Stokes truth = AsTraced(row, result);
      const slab::Stokes errors{stored::Number(result, "I_std_err"),
                                stored::Number(result, "Q_std_err"),
                                stored::Number(result, "U_std_err")};
      for (Comparison* comparison : {&one, &comparisons[row.at("tag")]}) {
        comparison->Add(traced, stored::Band(medium, result), truth, errors);
        comparison->scalar.Add(stored::Number(result, "I_scalar") / truth.i - 1.0);
      }
    }
    one.Print(row.at("id"));
  }
  for (const auto& [name, comparison] : comparisons) comparison.Print(name);
}

/// An aerosol that consists of spheres.
struct Spheres {
  const char* name;
  std::complex<double> index;
  SizeDistribution sizes;
};

/// Air with the amount of aerosol of a preset, made of spheres.
struct SphereAir {
  Medium medium;
  reference::PolarisedScattering scattering;
};

SphereAir AirWith(const char* preset, const Spheres& spheres) {
  constexpr int kAngles = 720;
  std::vector<double> angle_rad, angle_deg;
  for (int i = 0; i <= kAngles; ++i) {
    angle_deg.push_back(180.0 * i / kAngles);
    angle_rad.push_back(kPi * i / kAngles);
  }
  SphereAir air{MediumPreset(preset), {}};
  air.medium.mie_phase.clear();
  for (const double wavelength_nm : air.medium.wavelengths_nm) {
    const SphereScattering light =
        ScatterBySpheres(spheres.index, spheres.sizes, wavelength_nm, angle_rad);
    air.scattering.depolarisation.push_back(AirDepolarisation(wavelength_nm));
    air.scattering.aerosol.push_back(light.polarised);
    air.medium.mie_phase.push_back(
        {.kind = PhaseKind::kTable,
         .table = std::make_shared<const PhaseTable>(angle_deg, light.per_sr)});
  }
  return air;
}

/// Change relative to I, by band, if the aerosol depolarises.
struct Change {
  std::vector<Spread> i, polarised;

  void Add(const SphereAir& air, const ViewRay& ray) {
    const reference::PathOptions options{.max_paths = 60000, .relative_error = 0.002};
    const auto full = reference::TraceStokes(air.medium, air.scattering, ray, options);
    const auto plain =
        reference::TraceStokes(air.medium, {air.scattering.depolarisation}, ray, options);
    for (std::size_t band = 0; band < i.size(); ++band) {
      const double whole = full.i.total[band];
      i[band].Add(plain.i.total[band] / whole - 1.0);
      polarised[band].Add(std::hypot(plain.q.total[band] - full.q.total[band],
                                     plain.u.total[band] - full.u.total[band]) /
                          whole);
    }
  }
};

Change ChangeUnder(double sun_deg, const SphereAir& air) {
  const std::size_t bands = air.medium.wavelengths_nm.size();
  Change change{std::vector<Spread>(bands), std::vector<Spread>(bands)};
  for (const double zenith_deg : {10.0, 50.0, 80.0, 88.0}) {
    for (const double azimuth_deg : {5.0, 60.0, 120.0, 175.0})
      change.Add(air, RayFromAngles(2.0, zenith_deg, azimuth_deg, 90.0 - sun_deg));
  }
  return change;
}

void PrintAerosol() {
  fmt::print("\nAerosol that depolarises in place of spheres that do not: change over I\n\n");
  fmt::print("| air | spheres | sun | wavelength | values | I, rms / max | Q and U, rms / max |\n");
  fmt::print("|---|---|---|---|---|---|---|\n");
  for (const char* preset : {"earth", "hazy"}) {
    for (const Spheres& spheres : {Spheres{"fine, 0.15 um", {1.45, 0.005}, {0.15, 0.2}},
                                   {"coarse, 1.5 um", {1.36, 0.0}, {1.5, 0.25}}}) {
      const SphereAir air = AirWith(preset, spheres);
      for (const double sun_deg : {60.0, 10.0, -3.0}) {
        const Change change = ChangeUnder(sun_deg, air);
        for (std::size_t band = 0; band < change.i.size(); ++band) {
          const Spread &i = change.i[band], &polarised = change.polarised[band];
          fmt::print("| {} | {} | {} | {} nm | {} | {:.2f} / {:.2f} % | {:.1f} / {:.1f} % |\n",
                     preset, spheres.name, sun_deg, air.medium.wavelengths_nm[band], i.count(),
                     100.0 * i.Rms(), 100.0 * i.largest(), 100.0 * polarised.Rms(),
                     100.0 * polarised.largest());
        }
      }
    }
  }
}

template <typename Trace>
double Seconds(const Trace& trace) {
  const auto begin = std::chrono::steady_clock::now();
  static_cast<void>(trace());
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void PrintTime() {
  const Medium medium = MediumPreset("earth");
  const ViewRay ray = RayFromAngles(2.0, 60.0, 90.0, 45.0);
  const reference::PathOptions options{.max_paths = 200000, .relative_error = 0.0};
  const double scalar = Seconds([&] { return reference::TraceRadiance(medium, ray, options); });
  const double stokes = Seconds(
      [&] { return reference::TraceStokes(medium, Molecules(medium, 0.0279), ray, options); });
  fmt::print("\n200 000 paths, four wavelengths: scalar {:.2f} s, polarised {:.2f} s\n", scalar,
             stokes);
}

}  // namespace
}  // namespace alpenglow::atmosphere

void alpenglow::tests::StokesStudy(int argc, char** argv) {
  const std::string_view part = argc > 1 ? argv[1] : "";
  if (part == "" || part == "slab") atmosphere::PrintSlab();
  if (part == "" || part == "sphere") atmosphere::PrintSphere();
  if (part == "" || part == "aerosol") atmosphere::PrintAerosol();
  if (part == "" || part == "time") atmosphere::PrintTime();
}
