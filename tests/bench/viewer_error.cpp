// SPDX-License-Identifier: MIT
// Measures the errors of the tables of the viewer's air by eye, sun and quality, and the time to
// compute them. Run by hand:
//   studies viewer_error QUALITY "ALTITUDES [m]" "ELEVATIONS OF THE SUN [deg]" MEDIUM
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "tests/bench/studies.h"
#include "tests/lut/camera_tables/air_reference.h"

namespace alpenglow::lut {
namespace {

std::string TextOf(const alpenglow::tests::AirErrors& errors) {
  return fmt::format("{:6.3f} {:6.3f} {:6.2f}", 100.0 * errors.Rms(),
                     100.0 * errors.Percentile(99.0), 100.0 * errors.Percentile(100.0));
}

void Study(const SolvedAir& air, AirQuality quality, const EyeUnderLight& eye) {
  const MediumTables medium = MakeMediumTables(air);
  const AirTablesSize size = AirTablesSizeOf(quality, eye.altitude_m);
  const auto start = std::chrono::steady_clock::now();
  const AirTables tables = MakeAirTables(air, medium, eye, size);
  const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
  const alpenglow::tests::AirReading reading(tables);
  const alpenglow::tests::AirReference reference(air, eye);
  constexpr int kRays = 1500;
  fmt::print("{:9.0f} {:6.1f} {:>3}x{}x{:<3} {:7.2f} | {} | {} | {}\n", eye.altitude_m,
             std::asin(eye.mu_s()) / kRadiansPerDegree, size.columns, size.rows + size.ground_rows,
             size.distances, time.count(),
             TextOf(tests::SkyErrors(reference, reading, tables.map, kRays)),
             TextOf(tests::WayErrors(reference, reading, tables.map, kRays)),
             TextOf(tests::TransmittanceErrors(reference, reading, tables.map, kRays)));
}

std::vector<double> NumbersOf(const char* text) {
  std::vector<double> numbers;
  std::istringstream stream(text);
  for (double number; stream >> number;) numbers.push_back(number);
  return numbers;
}

}  // namespace
}  // namespace alpenglow::lut

void alpenglow::tests::ViewerError(int argc, char** argv) {
  using namespace alpenglow::lut;
  const auto quality = static_cast<AirQuality>(argc > 1 ? std::atoi(argv[1]) : 3);
  const SolvedAir air =
      alpenglow::tests::SolvedAsClearAir(MediumPreset(argc > 4 ? argv[4] : "earth"));
  fmt::print(
      "errors in %: rms, 99 %, largest\n{:>9} {:>6} {:>10} {:>7} | {:^20} | {:^20} | {:^20}\n",
      "eye m", "sun", "size", "ms", "sky", "ways", "transmittance");
  for (const double altitude : NumbersOf(argc > 2 ? argv[2] : "2 1500 9000 12000 30000 400000")) {
    for (const double sun : NumbersOf(argc > 3 ? argv[3] : "60 30 6 0.2 -2 -6 -10"))
      Study(air, quality, alpenglow::tests::EyeUnderSun(altitude, sun));
  }
}
