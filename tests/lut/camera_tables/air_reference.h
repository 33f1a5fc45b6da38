// SPDX-License-Identifier: MIT
// The air of one eye and one sun evaluated directly, ray by ray, with many nodes in double: what
// its tables are held against. Errors of rays all over the sphere, most of them near the horizon.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "atmosphere/math/numerics.h"
#include "tests/fixtures/sky_view_errors.h"
#include "tests/fixtures/solved_media.h"
#include "tests/lut/camera_tables/air_reading.h"

namespace alpenglow::tests {

using namespace lut;

/// Relative errors, as of a sky view.
using AirErrors = SkyViewErrors;

class AirReference {
 public:
  AirReference(const SolvedAir& air, const EyeUnderLight& eye)
      : exact_(air.medium()), air_(air), sky_(air.medium(), air.multiple_scattering()), eye_(eye) {}

  /// Returns the light of the whole ray, in the band.
  [[nodiscard]] SpectrumOf<double> Sky(const AirMap& map, double angle, double azimuth) const {
    const ViewRay ray = RayOf(map, angle, azimuth);
    return sky_.Radiance(ray, SeenCosineOf(ray.mu, azimuth));
  }

  /// From the eye to a distance.
  [[nodiscard]] AirToPoint To(const AirMap& map, double angle, double azimuth,
                              double distance_km) const {
    ViewRay ray = RayOf(map, angle, azimuth);
    ray.length_m = 1000.0 * distance_km;
    const double nu_seen = SeenCosineOf(ray.mu, azimuth);
    const SpectrumOf<double> single = exact_.Inscatter(
        exact_.Scatter(exact_.Sample(ray, {.nodes = 32, .split_ozone = true})), nu_seen);
    const Spectrum multiple_scattering = air_.multiple_scattering().InscatterAlong(
        air_.single_scattering().Sample(ray, {.nodes = 32, .dark_samples = true}), ray.nu, nu_seen,
        SegmentEnd::kOpen);
    const SpectrumOf<double> left = exact_.TransmittanceAlong(ray);
    AirToPoint to{glm::dvec4(0.0), glm::dvec4(0.0), glm::dvec4(1.0)};
    for (std::size_t band = 0; band < left.size(); ++band) {
      const auto i = static_cast<glm::length_t>(band);
      to.single[i] = single[band];
      to.multiple_scattering[i] = static_cast<double>(multiple_scattering[band]);
      to.transmittance[i] = left[band];
    }
    return to;
  }

 private:
  [[nodiscard]] ViewRay RayOf(const AirMap& map, double angle, double azimuth) const {
    const double mu = std::sin(angle - map.horizon_dip);
    return {eye_.altitude_m, mu, eye_.mu_s(), CosineOf(mu, eye_.mu_s(), azimuth)};
  }
  [[nodiscard]] double SeenCosineOf(double mu, double azimuth) const {
    return CosineOf(mu, std::cos(eye_.zenith_angle_seen_rad()), azimuth);
  }
  [[nodiscard]] static double CosineOf(double mu, double mu_s, double azimuth) {
    const double sines = std::sqrt((1.0 - mu) * (1.0 + mu) * (1.0 - mu_s) * (1.0 + mu_s));
    return std::clamp(mu * mu_s + sines * std::cos(azimuth), -1.0, 1.0);
  }

  SingleScattering<double> exact_;
  const SolvedAir& air_;
  DirectSky sky_;
  EyeUnderLight eye_;
};

/// A place that land may be seen at.
struct LandPoint {
  double angle, azimuth, distance_km;
};

/// Land between sea level and the ceiling, before the bare planet and behind its horizon.
inline std::vector<LandPoint> LandPoints(const AirMap& map, int count) {
  using namespace shared;
  std::vector<LandPoint> points;
  for (int i = 1; static_cast<int>(points.size()) < count && i < 20 * count; ++i) {
    const double v = Halton(i, 2), share = Halton(i, 5), azimuth = kPi * Halton(i, 3);
    const bool ground = i % 2 == 0;
    const double angle =
        ground ? -map.ground_range * v * v * v : std::min(map.air_sky_range, 0.35) * v * v;
    const double mu = std::sin(angle - map.horizon_dip);
    const double near = AirEntry<double>(map.altitude, mu, map.ceiling, map.radius);
    const double end = ground ? AirEndDown<double>(map.altitude, mu, map.radius)
                              : AirEndUp<double>(map.altitude, mu, map.ceiling, map.radius);
    if (end > near) points.push_back({angle, azimuth, near + share * (end - near)});
  }
  return points;
}

/// Returns errors of the light of all orders, in all bands.
inline AirErrors WayErrors(const AirReference& reference, const AirReading& reading,
                           const AirMap& map, const std::vector<LandPoint>& points) {
  AirErrors errors;
  for (const LandPoint& point : points) {
    const AirToPoint exact = reference.To(map, point.angle, point.azimuth, point.distance_km);
    const AirToPoint read = reading.To(point.angle, point.azimuth, point.distance_km);
    for (glm::length_t band = 0; band < 4; ++band) {
      const double light = exact.single[band] + exact.multiple_scattering[band];
      if (light > 0.0)
        errors.sorted.push_back(
            std::abs(read.single[band] + read.multiple_scattering[band] - light) / light);
    }
  }
  std::sort(errors.sorted.begin(), errors.sorted.end());
  return errors;
}

inline AirErrors WayErrors(const AirReference& reference, const AirReading& reading,
                           const AirMap& map, int count) {
  return WayErrors(reference, reading, map, LandPoints(map, count));
}

/// Returns absolute errors of the transmittance.
inline AirErrors TransmittanceErrors(const AirReference& reference, const AirReading& reading,
                                     const AirMap& map, int count) {
  AirErrors errors;
  for (const LandPoint& point : LandPoints(map, count)) {
    const AirToPoint exact = reference.To(map, point.angle, point.azimuth, point.distance_km);
    const AirToPoint read = reading.To(point.angle, point.azimuth, point.distance_km);
    for (glm::length_t band = 0; band < 4; ++band)
      errors.sorted.push_back(std::abs(read.transmittance[band] - exact.transmittance[band]));
  }
  std::sort(errors.sorted.begin(), errors.sorted.end());
  return errors;
}

/// Relative to the radiance or to a thousandth of its mean, where that is more.
inline AirErrors SkyErrors(const AirReference& reference, const AirReading& reading,
                           const AirMap& map, int count) {
  std::vector<std::pair<double, double>> pairs;
  double mean = 0.0;
  for (int i = 1; i <= count; ++i) {
    const double u = 2.0 * Halton(i, 2) - 1.001, azimuth = kPi * Halton(i, 3);
    const double v = i % 2 == 0 ? u : u * u * u;
    const double angle = 0.998 * v * (v > 0.0 ? map.sky_range : map.ground_range);
    const SpectrumOf<double> exact = reference.Sky(map, angle, azimuth);
    const glm::dvec4 read = reading.Sky(angle, azimuth);
    for (std::size_t band = 0; band < exact.size(); ++band) {
      pairs.emplace_back(exact[band], read[static_cast<glm::length_t>(band)]);
      mean += exact[band];
    }
  }
  mean /= static_cast<double>(pairs.size());
  AirErrors errors;
  for (const auto& [exact, read] : pairs)
    errors.sorted.push_back(std::abs(read - exact) / std::max(exact, 1e-3 * mean));
  std::sort(errors.sorted.begin(), errors.sorted.end());
  return errors;
}

}  // namespace alpenglow::tests
