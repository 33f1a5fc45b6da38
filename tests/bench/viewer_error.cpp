// SPDX-License-Identifier: MIT
// Errors of the tables of the viewer's air, by eye, sun and size, and the time that making them
// takes. Run by hand.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <vector>

#include "atmosphere/number/halton.h"
#include "renderer/light/aerial_perspective.h"
#include "tests/fixtures/sky_view_errors.h"
#include "tests/viewer/air/air_reading.h"

namespace alpenglow {
namespace {

struct Errors {
  std::vector<double> relative;
  void Add(double error) { relative.push_back(std::abs(error)); }
  [[nodiscard]] std::string Text() {
    std::sort(relative.begin(), relative.end());
    double sum = 0.0;
    for (const double e : relative) sum += e * e;
    const auto at = [&](double share) {
      return 100.0 *
             relative[static_cast<std::size_t>(share * static_cast<double>(relative.size() - 1))];
    };
    return fmt::format("{:6.3f} {:6.3f} {:6.2f}",
                       100.0 * std::sqrt(sum / static_cast<double>(relative.size())), at(0.99),
                       at(1.0));
  }
};

struct Air {
  explicit Air(const Medium& of) : medium(of) {}
  Medium medium;
  AirIntegrator<float> air{medium};
  DiffuseLight diffuse{medium};
  AerialPerspective aerial{air, diffuse};
  MediumTables tables = MakeMediumTables(air);
  AirIntegrator<double> exact{medium};
};

void Study(const Air& air, const char* name, double altitude_m, double sun_deg,
           const AirTablesSize& size) {
  const AirEye eye{altitude_m, std::sin(sun_deg * kRadiansPerDegree)};
  const auto start = std::chrono::steady_clock::now();
  const AirTables tables = MakeAirTables(air.air, air.diffuse, air.tables, eye, size);
  const double ms =
      1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const tests::AirReading reading(tables, air.tables);
  const AirMap& map = tables.map;
  Errors sky, total, single, through;
  const DirectSky direct(air.medium, air.diffuse);
  const int kRays = 1500;
  double mean = 0.0;
  std::vector<std::pair<double, double>> sky_pairs;
  for (int i = 1; i <= kRays; ++i) {
    const double u = Halton(i, 2), azimuth = kPi * Halton(i, 3);
    const double angle = i % 2 == 0 ? (u - 0.5) * 0.35 : std::asin(2.0 * u - 1.0) + map.horizon_dip;
    if (angle > map.sky_range - 1e-6 || angle < -map.ground_range) continue;
    const double mu = std::sin(angle - map.horizon_dip);
    const double nu = std::clamp(
        mu * eye.mu_s +
            std::sqrt((1 - mu) * (1 + mu) * (1 - eye.mu_s) * (1 + eye.mu_s)) * std::cos(azimuth),
        -1.0, 1.0);
    const auto exact = direct.Radiance({altitude_m, mu, eye.mu_s, nu});
    const glm::dvec4 seen = reading.Sky(angle, azimuth);
    for (int band = 0; band < 4; ++band) {
      mean += exact[(std::size_t)band];
      sky_pairs.push_back({seen[band], exact[(std::size_t)band]});
    }
  }
  mean /= (double)sky_pairs.size();
  for (auto [seen, exact] : sky_pairs) sky.Add((seen - exact) / std::max(exact, 1e-3 * mean));
  for (int i = 1; i <= kRays; ++i) {
    const double azimuth = kPi * Halton(i, 3);
    const double v = Halton(i, 2);
    const bool ground = i % 2 == 0;
    // Points of land: of the ray below the horizon anywhere below the ceiling
    const double angle =
        ground ? -map.ground_range * v * v * v : std::min(map.air_sky_range, 0.35) * v * v;
    const double mu = std::sin(angle - map.horizon_dip);
    const double z = map.ceiling * Halton(i, 7) * 0.99;
    double d = 0.0;
    if (map.altitude > z) {
      d = shared::DistanceDownTo<double>(map.altitude, mu, z, map.radius);
      if (!ground) {
        if (shared::PerigeeAltitude<double>(map.altitude, mu, map.radius) > z) continue;
        if (Halton(i, 11) < 0.5) d = -2.0 * (map.radius + map.altitude) * mu - d;
      }
      if (mu >= 0)
        continue;
      else if (ground && map.altitude < map.ceiling)
        d *= Halton(i, 11);
    } else {
      d = ground ? shared::DistanceDownTo<double>(map.altitude, mu, 0.0, map.radius) * Halton(i, 11)
                 : shared::DistanceUpTo<double>(map.altitude, mu, z, map.radius);
    }
    const double nu = std::clamp(
        mu * eye.mu_s +
            std::sqrt((1 - mu) * (1 + mu) * (1 - eye.mu_s) * (1 + eye.mu_s)) * std::cos(azimuth),
        -1.0, 1.0);
    ViewRay ray{altitude_m, mu, eye.mu_s, nu, 1000.0 * d};
    const auto light = air.aerial.Along(ray, {.sky = 16});
    const auto samples = air.aerial.Sample(ray, nullptr, {.sky = 16});
    const auto direct_single = air.air.Inscatter(air.air.Scatter(samples), nu);
    const auto seen = reading.To(angle, azimuth, d);
    for (std::size_t band = 0; band < 4; ++band) {
      const double whole = (double)light.inscatter[band];
      if (whole < 1e-12) continue;
      total.Add((seen.single[(int)band] + seen.diffuse[(int)band]) / whole - 1.0);
      single.Add((seen.single[(int)band] - (double)direct_single[band]) / whole);
      through.Add(seen.transmittance[(int)band] - (double)light.transmittance[band]);
    }
  }
  fmt::print("{:8} {:9.0f} {:6.1f} {}x{}x{} {:6.2f} ms  sky {}  total {}  single {}  T {}\n", name,
             altitude_m, sun_deg, size.columns, size.rows + size.ground_rows, size.distances, ms,
             sky.Text(), total.Text(), single.Text(), through.Text());
}

std::vector<double> NumbersOf(const char* text) {
  std::vector<double> numbers;
  std::istringstream stream(text);
  for (double number; stream >> number;) numbers.push_back(number);
  return numbers;
}

}  // namespace
}  // namespace alpenglow

// viewer_error QUALITY "ALTITUDES [m]" "ELEVATIONS OF THE SUN [deg]" MEDIUM
int main(int argc, char** argv) {
  using namespace alpenglow;
  const int quality = argc > 1 ? std::atoi(argv[1]) : 3;
  const char* name = argc > 4 ? argv[4] : "earth";
  const Air air(MediumPreset(name));
  for (const double altitude : NumbersOf(argc > 2 ? argv[2] : "2 1500 9000 12000 30000 400000")) {
    for (const double sun : NumbersOf(argc > 3 ? argv[3] : "60 30 6 0.2 -2 -6 -10")) {
      Study(air, name, altitude, sun, AirTablesSizeOf(static_cast<AirQuality>(quality), altitude));
    }
  }
}
