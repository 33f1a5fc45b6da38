// SPDX-License-Identifier: MIT
// Measures the light of local volumes (renderer/media/volume_orders.h) relative to traced paths, for
// six views of a plume of smoke:
//   studies volume_error [PATHS [SUN_DEG [DEPTH]]]
// with the largest optical depth 10 or 50, or 0 for both.
// Errors and the whole light are those of renderer/report/cloud_views.h. Rows are for light of the
// first order alone and of all orders; the first order has no light of the sky here. Times are of
// the processor, for all threads together, and wall time.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <glm/geometric.hpp>
#include <limits>
#include <string>
#include <vector>

#include "renderer/cloud_light/cloud_path_tracer.h"
#include "renderer/media/media_march.h"
#include "renderer/media/volume_orders.h"
#include "renderer/report/plume_light.h"
#include "tests/bench/processor_time.h"
#include "tests/bench/studies.h"

namespace alpenglow::tests {
namespace {

using namespace renderer;

constexpr std::array<PlumeCase, 6> kPlumes{{{10.0, 1.0, 0.85},
                                            {10.0, 0.8, 0.85},
                                            {10.0, 1.0, 0.7},
                                            {50.0, 1.0, 0.85},
                                            {50.0, 0.8, 0.85},
                                            {50.0, 1.0, 0.7}}};

void PrintRow(const PlumeCase& of, const std::string& method, double processor_s, double wall_s,
              const PlumeErrors& errors) {
  fmt::print(
      "| {}, {}, {} | {} | {:.2f}, {:.2f} | {:.1f} / {:+.1f} | {:.1f} / {:+.1f} | {:.1f} / {:+.1f} "
      "|\n",
      of.largest_depth, of.albedo, of.g, method, processor_s, wall_s, 100.0 * errors.sun.Rms(),
      100.0 * errors.sun.Bias(), 100.0 * errors.sky.Rms(), 100.0 * errors.sky.Bias(),
      100.0 * errors.whole.Rms(), 100.0 * errors.whole.Bias());
  std::fflush(stdout);
}

}  // namespace

void VolumeError(int count, char** arguments) {
  const std::size_t paths = count > 1 ? std::strtoul(arguments[1], nullptr, 10) : 1004;
  const double sun_deg = count > 2 ? std::atof(arguments[2]) : 35.0;
  const double depth = count > 3 ? std::atof(arguments[3]) : 0.0;
  const glm::dvec3 to_sun = TowardsAzimuth(20.0, sun_deg);
  fmt::print(
      "| depth, albedo, g | method | solve: processor, wall [s] | sun | sky | whole |\n"
      "|---|---|---|---|---|---|\n");
  for (const PlumeCase& of : kPlumes) {
    if (depth > 0.0 && of.largest_depth != depth) continue;
    const Plume plume = MakePlume(of);
    const std::vector<PlumeRay> traced = TracedPlume(plume, to_sun, paths, 16);
    PrintRow(of, "single", 0.0, 0.0, ErrorsOfPlume(traced, [&](const CloudRay& ray) {
               return FirstOrderOfPlume(plume, to_sun, ray);
             }));
    for (const double cells : {4096.0, 32768.0, 262144.0}) {
      const std::clock_t begin = std::clock();
      const auto wall = std::chrono::steady_clock::now();
      const PlumeOrders orders(plume, to_sun, cells);
      const double processor_s = tests::ProcessorSecondsSince(begin);
      const std::chrono::duration<double> wall_s = std::chrono::steady_clock::now() - wall;
      PrintRow(of, fmt::format("all, {} cells", cells), processor_s, wall_s.count(),
               ErrorsOfPlume(traced, [&](const CloudRay& ray) { return orders.Along(ray); }));
    }
  }
}

}  // namespace alpenglow::tests
