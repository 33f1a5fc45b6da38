// SPDX-License-Identifier: MIT
#include "lut/report/report_measure.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/reference/reference_solution.h"
#include "lut/cli/program.h"

namespace alpenglow::lut {
namespace {

/// Calls use(ray, band, scale) for every ray and wavelength; errors are divided by the scale.
template <typename Use>
void ForEveryValue(const std::vector<ReferenceRay>& rays, ErrorKind kind, const Use& use) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const ReferenceRay& ray = rays[i];
    for (std::size_t band = 0; band < ray.truth.size(); ++band) {
      const double floor = ray.floor.empty() ? 0.0 : ray.floor[band];
      use(i, band,
          kind == ErrorKind::kRelative ? std::max({ray.truth[band], floor, kDarkestValue}) : 1.0);
    }
  }
}

/// Calls use(ray, band, value) for every ray and wavelength that strict errors count.
template <typename Use>
void ForEveryStrictValue(const std::vector<ReferenceRay>& rays, const Use& use) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    for (std::size_t band = 0; band < rays[i].truth.size(); ++band) {
      if (rays[i].truth[band] > kDarkestValue) use(i, band, rays[i].truth[band]);
    }
  }
}

// Returns the rms of the reference's standard errors, each divided by a scale that `visit`
// provides.
template <typename Visit>
double NoiseOver(const std::vector<ReferenceRay>& rays, const Visit& visit) {
  double squares = 0.0;
  std::size_t count = 0;
  visit([&](std::size_t i, std::size_t band, double scale) {
    if (rays[i].sigma.empty()) return;
    const double noise = rays[i].sigma[band] / scale;
    squares += noise * noise;
    ++count;
  });
  return count == 0 ? 0.0 : std::sqrt(squares / static_cast<double>(count));
}

// Returns the cosine of the zenith angle at which an observer in space sees a ray with that
// perigee.
double CosineOfPerigee(double radius_m, double altitude_m, double perigee_m) {
  return -std::sqrt((altitude_m - perigee_m) * (2.0 * radius_m + altitude_m + perigee_m)) /
         (radius_m + altitude_m);
}

// Returns the ray with the sun at the regime's elevation as seen from its lowest point, `low_m`
// along it.
ViewRay WithSunAtLowest(const Medium& medium, ViewRay ray, double low_m, int i,
                        const ReportRegime& regime) {
  constexpr double kLow_deg = 5.0;
  const SunRange sun = regime.sun.value();
  const double share = Halton(i, 2);
  const double elevation_deg = share < 0.5
                                   ? sun.lowest_deg + (kLow_deg - sun.lowest_deg) * 2.0 * share
                                   : kLow_deg + (sun.highest_deg - kLow_deg) * (2.0 * share - 1.0);
  const double elevation = elevation_deg * kRadiansPerDegree, azimuth = kPi * Halton(i, 5);
  const double sine = std::sqrt((1.0 - ray.mu) * (1.0 + ray.mu));
  // Angle by which the vertical turns along the ray to the lowest point.
  const double turn =
      std::atan2(low_m * sine, medium.planet_radius_m + ray.altitude_m + low_m * ray.mu);
  const double along = std::cos(elevation) * std::cos(azimuth), up = std::sin(elevation);
  const double x = along * std::cos(turn) + up * std::sin(turn);
  const double z = up * std::cos(turn) - along * std::sin(turn);
  ray.mu_s = std::clamp(z, -1.0, 1.0);
  ray.nu = std::clamp(x * sine + z * ray.mu, -1.0, 1.0);
  return ray;
}

ViewRay LimbFromSpaceNumber(const Medium& medium, int i, const ReportRegime& regime) {
  const double radius_m = medium.planet_radius_m;
  const double highest_m = std::min(100e3, 0.9 * medium.atmosphere_height_m);
  const double perigee_m = highest_m * (0.001 + 0.998 * Halton(i, 3));
  const ViewRay ray{.altitude_m = kSpaceAltitude_m,
                    .mu = CosineOfPerigee(radius_m, kSpaceAltitude_m, perigee_m)};
  return WithSunAtLowest(medium, ray, -(radius_m + ray.altitude_m) * ray.mu, i, regime);
}

// Returns the vertical ray whose light is compared with that of a ray: at the observer, or at the
// lowest point of a ray from above the air.
ViewRay ZenithOf(const Medium& medium, const ViewRay& ray) {
  if (ray.altitude_m <= medium.atmosphere_height_m)
    return {ray.altitude_m, 1.0, ray.mu_s, ray.mu_s};
  const double r = medium.planet_radius_m + ray.altitude_m;
  const RayExtent extent = ExtentOf(ray, medium.planet_radius_m, medium.atmosphere_height_m);
  const double low_m = extent.end == RayEnd::kGround ? extent.end_m : std::max(-r * ray.mu, 0.0);
  const double low_r = std::sqrt(r * r + low_m * (low_m + 2.0 * r * ray.mu));
  const double mu_s = std::clamp((r * ray.mu_s + low_m * ray.nu) / low_r, -1.0, 1.0);
  return {std::max(low_r - medium.planet_radius_m, 0.0), 1.0, mu_s, mu_s};
}

}  // namespace

ReferenceRays SolveReferenceRays(ErrorKind kind, int count, const DrawRay& draw,
                                 const SolveReference& ask) {
  ReferenceRays result;
  result.kind = kind;
  const auto start = std::chrono::steady_clock::now();
  for (std::size_t r = 0; r < kReportRegimes; ++r) {
    std::vector<ReferenceRay>& rays = result.rays[r];
    rays.resize(static_cast<std::size_t>(count));
    tbb::parallel_for(0, count, [&](int i) {
      if (Interrupted()) return;
      rays[static_cast<std::size_t>(i)] = ask(draw(i + 1, kRegimes[r]));
    });
    ThrowIfInterrupted();
    result.reference.noise[r] = NoiseOf(rays, kind);
  }
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  result.reference.time_s = taken.count() / (static_cast<double>(kReportRegimes) * count);
  return result;
}

double SunElevationNumber(int i, const ReportRegime& regime) {
  const SunRange sun = regime.sun.value();
  return sun.lowest_deg + (sun.highest_deg - sun.lowest_deg) * Halton(i, 2);
}

std::vector<double> DarkestRadiance(const Medium& medium, const ViewRay& ray) {
  std::vector<double> floor =
      reference::SingleScatteringAlong(medium, ZenithOf(medium, ray)).inscatter;
  for (double& value : floor) value *= kDarkestPart;
  return floor;
}

ViewRay GroundFromSpaceNumber(const Medium& medium, int i, const ReportRegime& regime) {
  const double radius_m = medium.planet_radius_m;
  const double horizon = std::acos(CosineOfPerigee(radius_m, kSpaceAltitude_m, 0.0));
  const double share = Halton(i, 3) * Halton(i, 3);
  const ViewRay ray{.altitude_m = kSpaceAltitude_m,
                    .mu = std::cos(horizon + (kPi - horizon) * share)};
  return WithSunAtLowest(medium, ray, ExtentOf(ray, radius_m, medium.atmosphere_height_m).end_m, i,
                         regime);
}

ViewRay ViewNumber(const Medium& medium, int i, const ReportRegime& regime) {
  if (regime.from_space) {
    return Halton(i, 11) < 0.5 ? GroundFromSpaceNumber(medium, i, regime)
                               : LimbFromSpaceNumber(medium, i, regime);
  }
  constexpr std::array<double, 3> kAltitudes_m{2.0, 1500.0, 10000.0};
  const double altitude_m = kAltitudes_m[static_cast<std::size_t>(3.0 * Halton(i, 7))];
  const double kind = Halton(i, 11), share = Halton(i, 3);
  const double horizon_deg =
      90.0 +
      std::acos(medium.planet_radius_m / (medium.planet_radius_m + altitude_m)) / kRadiansPerDegree;
  const double zenith_deg = kind < 0.5    ? std::acos(share) / kRadiansPerDegree
                            : kind < 0.75 ? 80.0 + 10.0 * share
                                          : horizon_deg + 1.0 + (179.0 - horizon_deg) * share;
  return RayFromAngles(altitude_m, zenith_deg, 180.0 * Halton(i, 5),
                       90.0 - SunElevationNumber(i, regime));
}

ViewRay SunbeamNumber(const Medium& medium, int i, const ReportRegime& regime) {
  const double elevation = SunElevationNumber(i, regime) * kRadiansPerDegree;
  const double share = Halton(i, 3);
  const double low_m = 0.5 * medium.atmosphere_height_m * share * share;
  const double radius_m = medium.planet_radius_m, top_m = medium.atmosphere_height_m;
  const double altitude_m =
      elevation < 0.0 ? (radius_m + low_m) / std::cos(elevation) - radius_m : low_m;
  // Lower suns light no air.
  if (regime.from_space || altitude_m > top_m) {
    const double mu = CosineOfPerigee(radius_m, top_m, low_m);
    return {top_m, mu, mu, 1.0};
  }
  const double mu = std::sin(elevation);
  return {altitude_m, mu, mu, 1.0};
}

ReferenceRays ReferenceSunbeams(const Medium& medium, int count) {
  ReferenceRays result = SolveReferenceRays(
      ErrorKind::kAbsolute, count,
      [&](int i, const ReportRegime& regime) { return SunbeamNumber(medium, i, regime); },
      [&](const ViewRay& ray) {
        const reference::OpticalDepth depth = reference::OpticalDepthAlong(medium, ray);
        ReferenceRay solution{ray, {}, {}, {}};
        for (const double tau : depth.tau)
          solution.truth.push_back(depth.blocked ? 0.0 : std::exp(-tau));
        return solution;
      });
  result.reference.text =
      "adaptive Gauss-Legendre quadrature in extended precision, relative error "
      "of the optical depth below 1e-10";
  return result;
}

ReferenceRays ReferenceSkyRays(const Medium& medium, int count) {
  ReferenceRays result = SolveReferenceRays(
      ErrorKind::kRelative, count,
      [&](int i, const ReportRegime& regime) { return ViewNumber(medium, i, regime); },
      [&](const ViewRay& ray) {
        return ReferenceRay{ray,
                            reference::SingleScatteringAlong(medium, ray).inscatter,
                            {},
                            DarkestRadiance(medium, ray)};
      });
  result.reference.text =
      "adaptive Gauss-Legendre quadrature in extended precision, relative error "
      "below 1e-8";
  return result;
}

ReferenceRays TracedViews(const Medium& medium, int count, std::size_t paths) {
  reference::PathOptions options{.max_paths = paths, .relative_error = 0.0};
  options.stopped = Interrupted;
  ReferenceRays result = SolveReferenceRays(
      ErrorKind::kRelative, count,
      [&](int i, const ReportRegime& regime) {
        ViewRay ray = ViewNumber(medium, i, regime);
        const RayExtent extent = ExtentOf(ray, medium.planet_radius_m, medium.atmosphere_height_m);
        if (extent.end == RayEnd::kGround) ray.length_m = (1.0 - 1e-9) * extent.end_m;
        return ray;
      },
      [&](const ViewRay& ray) {
        reference::PathTracedRadiance traced = reference::TraceRadiance(medium, ray, options);
        return ReferenceRay{ray, std::move(traced.total), std::move(traced.standard_error),
                            DarkestRadiance(medium, ray)};
      });
  result.reference.text = fmt::format("backward path tracing of all orders, {} paths a ray", paths);
  return result;
}

double NoiseOf(const std::vector<ReferenceRay>& rays, ErrorKind kind) {
  return NoiseOver(rays, [&](const auto& use) { ForEveryValue(rays, kind, use); });
}

ErrorStatistics StatisticsOf(const std::vector<ReferenceRay>& rays, ErrorKind kind,
                             const std::vector<std::vector<double>>& answers) {
  ALPENGLOW_ENSURE(answers.size(), ==, rays.size());
  std::vector<double> errors, strict;
  const auto add_to = [&](std::vector<double>& list) {
    return [&](std::size_t i, std::size_t band, double scale) {
      list.push_back(std::abs(answers[i][band] - rays[i].truth[band]) / scale);
    };
  };
  ForEveryValue(rays, kind, add_to(errors));
  ForEveryStrictValue(rays, add_to(strict));
  ErrorStatistics result = StatisticsOfErrors(std::move(errors), NoiseOf(rays, kind));
  const double noise = NoiseOver(rays, [&](const auto& use) { ForEveryStrictValue(rays, use); });
  const ErrorStatistics relative = StatisticsOfErrors(std::move(strict), noise);
  result.strict_rms = relative.rms;
  result.strict_percentile_99 = relative.percentile_99;
  return result;
}

ErrorStatistics StatisticsOfErrors(std::vector<double> errors, double noise) {
  if (errors.empty()) return {};
  std::sort(errors.begin(), errors.end());
  const std::size_t n = errors.size();
  double squares = 0.0;
  for (const double error : errors) squares += error * error;
  const double rms_squared = squares / static_cast<double>(n) - noise * noise;
  ErrorStatistics result;
  result.median = errors[n / 2];
  result.percentile_99 = errors[std::min(n - 1, n * 99 / 100)];
  result.largest = errors.back();
  result.rms_is_bound = noise > 0.0 && rms_squared < 0.25 * noise * noise;
  result.rms = result.rms_is_bound ? 0.5 * noise : std::sqrt(rms_squared);
  result.strict_rms = result.rms;
  result.strict_percentile_99 = result.percentile_99;
  return result;
}

}  // namespace alpenglow::lut
