// SPDX-License-Identifier: MIT
#include "lut/report/report_rays.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "atmosphere/judge/judge.h"
#include "atmosphere/number/constants.h"
#include "atmosphere/number/halton.h"
#include "atmosphere/text/error.h"
#include "lut/program/program.h"

namespace alpenglow {
namespace {

/// Calls use(ray, band, scale) for every ray and wavelength; errors are divided by the scale.
template <typename Use>
void ForEveryValue(const std::vector<JudgedRay>& rays, ErrorKind kind, const Use& use) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const JudgedRay& ray = rays[i];
    for (std::size_t band = 0; band < ray.truth.size(); ++band) {
      const double floor = ray.floor.empty() ? 0.0 : ray.floor[band];
      const double scale = kind == ErrorKind::kRelative ? std::max(ray.truth[band], floor) : 1.0;
      if (scale > 0.0) use(i, band, scale);
    }
  }
}

}  // namespace

JudgedRays JudgeRays(ErrorKind kind, int count, const DrawRay& draw, const AskJudge& ask) {
  JudgedRays result;
  result.kind = kind;
  const auto start = std::chrono::steady_clock::now();
  for (std::size_t r = 0; r < kReportRegimes; ++r) {
    std::vector<JudgedRay>& rays = result.rays[r];
    rays.resize(static_cast<std::size_t>(count));
    tbb::parallel_for(0, count, [&](int i) {
      if (Interrupted()) return;
      rays[static_cast<std::size_t>(i)] = ask(draw(i + 1, kRegimes[r]));
    });
    ThrowIfInterrupted();
    result.judge.noise[r] = NoiseOf(rays, kind);
  }
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  result.judge.time_s = taken.count() / (static_cast<double>(kReportRegimes) * count);
  return result;
}

double SunElevationNumber(int i, const ReportRegime& regime) {
  const SunRange sun = regime.sun.value();
  return sun.lowest_deg + (sun.highest_deg - sun.lowest_deg) * Halton(i, 2);
}

std::vector<double> DarkestRadiance(const Medium& medium, const ViewRay& ray) {
  std::vector<double> floor =
      judge::SingleScatteringAlong(medium, {ray.altitude_m, 1.0, ray.mu_s, ray.mu_s}).inscatter;
  for (double& value : floor) value *= kDarkestPart;
  return floor;
}

ViewRay ViewNumber(const Medium& medium, int i, const ReportRegime& regime) {
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
  const double radius_m = medium.planet_radius_m;
  const double altitude_m = elevation < 0.0
                                ? std::min((radius_m + low_m) / std::cos(elevation) - radius_m,
                                           medium.atmosphere_height_m)
                                : low_m;
  const double mu = std::sin(elevation);
  return {altitude_m, mu, mu, 1.0};
}

JudgedRays JudgedSunbeams(const Medium& medium, int count) {
  JudgedRays result = JudgeRays(
      ErrorKind::kAbsolute, count,
      [&](int i, const ReportRegime& regime) { return SunbeamNumber(medium, i, regime); },
      [&](const ViewRay& ray) {
        const judge::OpticalDepth depth = judge::OpticalDepthAlong(medium, ray);
        JudgedRay judged{ray, {}, {}, {}};
        for (const double tau : depth.tau)
          judged.truth.push_back(depth.blocked ? 0.0 : std::exp(-tau));
        return judged;
      });
  result.judge.text =
      "adaptive Gauss-Legendre quadrature in extended precision, relative error "
      "of the optical depth below 1e-10";
  return result;
}

JudgedRays JudgedViews(const Medium& medium, int count) {
  JudgedRays result = JudgeRays(
      ErrorKind::kRelative, count,
      [&](int i, const ReportRegime& regime) { return ViewNumber(medium, i, regime); },
      [&](const ViewRay& ray) {
        return JudgedRay{ray,
                         judge::SingleScatteringAlong(medium, ray).inscatter,
                         {},
                         DarkestRadiance(medium, ray)};
      });
  result.judge.text =
      "adaptive Gauss-Legendre quadrature in extended precision, relative error "
      "below 1e-8";
  return result;
}

JudgedRays TracedViews(const Medium& medium, int count, std::size_t paths) {
  judge::PathOptions options{.max_paths = paths, .relative_error = 0.0};
  options.stopped = Interrupted;
  JudgedRays result = JudgeRays(
      ErrorKind::kRelative, count,
      [&](int i, const ReportRegime& regime) {
        ViewRay ray = ViewNumber(medium, i, regime);
        const RayExtent extent = ExtentOf(ray, medium.planet_radius_m, medium.atmosphere_height_m);
        if (extent.end == RayEnd::kGround) ray.length_m = (1.0 - 1e-9) * extent.end_m;
        return ray;
      },
      [&](const ViewRay& ray) {
        judge::PathTracedRadiance traced = judge::TraceRadiance(medium, ray, options);
        return JudgedRay{ray, std::move(traced.total), std::move(traced.standard_error),
                         DarkestRadiance(medium, ray)};
      });
  result.judge.text = fmt::format("backward path tracing of all orders, {} paths a ray", paths);
  return result;
}

double NoiseOf(const std::vector<JudgedRay>& rays, ErrorKind kind) {
  double squares = 0.0;
  std::size_t count = 0;
  ForEveryValue(rays, kind, [&](std::size_t i, std::size_t band, double scale) {
    if (rays[i].sigma.empty()) return;
    const double noise = rays[i].sigma[band] / scale;
    squares += noise * noise;
    ++count;
  });
  return count == 0 ? 0.0 : std::sqrt(squares / static_cast<double>(count));
}

ErrorStatistics StatisticsOf(const std::vector<JudgedRay>& rays, ErrorKind kind,
                             const std::vector<std::vector<double>>& answers) {
  ALPENGLOW_ENSURE(answers.size(), ==, rays.size());
  std::vector<double> errors;
  ForEveryValue(rays, kind, [&](std::size_t i, std::size_t band, double scale) {
    errors.push_back(std::abs(answers[i][band] - rays[i].truth[band]) / scale);
  });
  return StatisticsOfErrors(std::move(errors), NoiseOf(rays, kind));
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
  return result;
}

}  // namespace alpenglow
