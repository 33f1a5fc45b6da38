// SPDX-License-Identifier: MIT
// Measures the time of the path tracer to an error of half a percent, and the error of the sky's
// irradiance on the ground by MultipleScattering relative to it.
//   studies path_study [times|irradiance]
// Times are for all cores of an otherwise idle machine.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <string_view>

#include "atmosphere/math/constants.h"
#include "atmosphere/reference/path_tracer.h"
#include "lut/evaluate/eval.h"
#include "lut/evaluate/integral_evaluator.h"
#include "tests/bench/studies.h"

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

}  // namespace
}  // namespace alpenglow::lut

void alpenglow::tests::PathStudy(int argc, char** argv) {
  const std::string_view part = argc > 1 ? argv[1] : "";
  if (part == "" || part == "times") lut::PrintTimes();
  if (part == "" || part == "irradiance") lut::PrintIrradiance();
}
