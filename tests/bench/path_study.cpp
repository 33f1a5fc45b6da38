// SPDX-License-Identifier: MIT
// Measures the time of the path tracer to an error of half a percent, and the error of single
// scattering plus MultipleScattering relative to it, by regime over quasi-random rays. Run by hand:
// path_study [times|irradiance|errors|rays], where rays prints every ray of errors. Times are for
// all cores of an otherwise idle machine.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string_view>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/reference/path_tracer.h"
#include "lut/evaluate/eval.h"

namespace alpenglow::lut {
namespace {

void PrintTimes() {
  struct View {
    double sun_deg, zenith_deg, azimuth_deg;
  };
  fmt::print(
      "| air | sun | view zenith | azimuth | paths | s | standard errors, by wavelength |\n");
  fmt::print("|---|---|---|---|---|---|---|\n");
  for (const char* name : {"earth", "hazy"}) {
    const Medium medium = MediumPreset(name);
    for (const View& view : {View{45.0, 60.0, 90.0},
                             {45.0, 60.0, 15.0},
                             {5.0, 85.0, 90.0},
                             {-3.0, 80.0, 20.0},
                             {-6.0, 80.0, 20.0},
                             {-6.0, 0.0, 0.0},
                             {-6.0, 80.0, 180.0},
                             {-10.0, 80.0, 20.0},
                             {-10.0, 0.0, 0.0},
                             {-10.0, 80.0, 180.0},
                             {-12.0, 80.0, 20.0}}) {
      const ViewRay ray =
          RayFromAngles(2.0, view.zenith_deg, view.azimuth_deg, 90.0 - view.sun_deg);
      const auto start = std::chrono::steady_clock::now();
      const auto traced =
          reference::TraceRadiance(medium, ray, {.max_paths = 2000000, .relative_error = 0.005});
      const double seconds =
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      fmt::print("| {} | {} | {} | {} | {} | {:.2f} |", name, view.sun_deg, view.zenith_deg,
                 view.azimuth_deg, traced.paths, seconds);
      for (std::size_t band = 0; band < traced.total.size(); ++band)
        fmt::print(" {:.2f} %", 100.0 * traced.standard_error[band] / traced.total[band]);
      fmt::print(" |\n");
    }
  }
}

// Prints the irradiance of the sky on the ground: MultipleScattering relative to traced paths.
void PrintIrradiance() {
  fmt::print("\n| air | sun | error of irradiance, by wavelength | standard errors |\n");
  fmt::print("|---|---|---|---|\n");
  for (const char* name : {"earth", "hazy"}) {
    const Medium medium = MediumPreset(name);
    const auto evaluator = MakeIntegralEvaluator(medium);
    for (const double sun_deg : {60.0, 10.0, 2.0, 0.0, -2.0, -4.0, -6.0, -8.0, -10.0, -12.0}) {
      const double mu_s = std::sin(sun_deg * kRadiansPerDegree);
      const Case sky{"", 0, Quantity::kIrradianceSky, {0.0, 1.0, mu_s, mu_s}};
      evaluator->Prepare({&sky, 1});
      const Estimates fast = evaluator->Evaluate(sky);
      const auto truth =
          reference::TraceIrradiance(medium, 0.0, mu_s, reference::PlaneSide::kFromAbove,
                                     {.max_paths = 200000, .relative_error = 0.002});
      fmt::print("| {} | {} |", name, sun_deg);
      for (std::size_t band = 0; band < fast.size(); ++band)
        fmt::print(" {:.2f} %", 100.0 * (fast[band].value / truth.value[band] - 1.0));
      fmt::print(" |");
      for (std::size_t band = 0; band < fast.size(); ++band)
        fmt::print(" {:.2f} %", 100.0 * truth.standard_error[band] / truth.value[band]);
      fmt::print(" |\n");
    }
  }
}

struct Regime {
  const char* name;
  double low_deg, high_deg;
  int rays;
};

ViewRay RayNumber(int i, const Regime& regime) {
  constexpr double kAltitudes_m[] = {2.0, 2.0, 3000.0, 10000.0};
  const double sun_deg = regime.low_deg + (regime.high_deg - regime.low_deg) * Halton(i, 2);
  // A third of the views goes down to the ground or below the horizon; a third is within 12 degrees
  // above the horizontal.
  const double share = Halton(i, 3);
  const double view_deg = i % 3 == 0   ? 92.0 + 60.0 * share
                          : i % 3 == 1 ? 78.0 + 12.0 * share
                                       : 78.0 * share;
  return RayFromAngles(kAltitudes_m[i % 4], view_deg, 180.0 * Halton(i, 5), 90.0 - sun_deg);
}

struct Row {
  ViewRay ray;
  std::vector<double> error, sigma, multiple;  // relative, by wavelength
};

std::vector<Row> Compare(const Medium& medium, const Evaluator& evaluator, const Regime& regime) {
  std::vector<Row> rows;
  for (int i = 1; i <= regime.rays; ++i) {
    Row row{RayNumber(i, regime), {}, {}, {}};
    const Estimates fast = evaluator.Evaluate({"", 0, Quantity::kTotal, row.ray});
    const auto truth =
        reference::TraceRadiance(medium, row.ray, {.max_paths = 300000, .relative_error = 0.001});
    for (std::size_t band = 0; band < truth.total.size(); ++band) {
      row.error.push_back(fast[band].value / truth.total[band] - 1.0);
      row.sigma.push_back(truth.standard_error[band] / truth.total[band]);
      row.multiple.push_back(1.0 - truth.single[band] / truth.total[band]);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

void PrintRow(const Row& row) {
  fmt::print("  {:5.0f} m  view {:5.1f}  nu {:5.2f}  sun {:5.1f} :", row.ray.altitude_m,
             std::acos(row.ray.mu) / kRadiansPerDegree, row.ray.nu,
             90.0 - std::acos(row.ray.mu_s) / kRadiansPerDegree);
  for (std::size_t band = 0; band < row.error.size(); ++band) {
    fmt::print("  {:6.2f} +- {:.2f} % ({:.0f} % multiple)", 100.0 * row.error[band],
               100.0 * row.sigma[band], 100.0 * row.multiple[band]);
  }
  fmt::print("\n");
}

void PrintErrors(bool every_ray) {
  fmt::print(
      "\n| air | sun | rays | rms error | largest | rms of the reference solution's standard error "
      "|\n");
  fmt::print("|---|---|---|---|---|---|\n");
  for (const char* name : {"earth", "hazy"}) {
    const Medium medium = MediumPreset(name);
    const auto evaluator = MakeIntegralEvaluator(medium);
    const Case total{"", 0, Quantity::kTotal, {}};
    evaluator->Prepare({&total, 1});
    for (const Regime& regime : {Regime{"5 to 60", 5.0, 60.0, 12},
                                 {"0 to 5", 0.0, 5.0, 6},
                                 {"-4 to 0", -4.0, 0.0, 6},
                                 {"-8 to -4", -8.0, -4.0, 6}}) {
      double squares = 0.0, largest = 0.0, sigmas = 0.0;
      std::size_t count = 0;
      const std::vector<Row> rows = Compare(medium, *evaluator, regime);
      for (const Row& row : rows) {
        for (std::size_t band = 0; band < row.error.size(); ++band, ++count) {
          squares += row.error[band] * row.error[band];
          sigmas += row.sigma[band] * row.sigma[band];
          largest = std::max(largest, std::abs(row.error[band]));
        }
      }
      const double n = static_cast<double>(count);
      fmt::print("| {} | {} | {} | {:.2f} % | {:.2f} % | {:.2f} % |\n", name, regime.name,
                 regime.rays, 100.0 * std::sqrt(squares / n), 100.0 * largest,
                 100.0 * std::sqrt(sigmas / n));
      if (every_ray) std::for_each(rows.begin(), rows.end(), PrintRow);
    }
  }
}

}  // namespace
}  // namespace alpenglow::lut

int main(int argc, char** argv) {
  const std::string_view part = argc > 1 ? argv[1] : "";
  if (part == "" || part == "times") alpenglow::lut::PrintTimes();
  if (part == "" || part == "irradiance") alpenglow::lut::PrintIrradiance();
  if (part == "" || part == "errors" || part == "rays") alpenglow::lut::PrintErrors(part == "rays");
}
