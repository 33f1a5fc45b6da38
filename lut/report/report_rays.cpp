// SPDX-License-Identifier: MIT
#include "lut/report/report_rays.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/reference/path_tracer.h"
#include "atmosphere/reference/reference_solution.h"
#include "lut/cli/program.h"
#include "lut/report/report_baselines.h"

namespace alpenglow::lut {
namespace {

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

/// Returns, by wavelength, the lower bound of the radiance to which errors are relative.
std::vector<double> DarkestRadiance(const Medium& medium, const ViewRay& ray) {
  std::vector<double> floor =
      reference::SingleScatteringAlong(medium, ZenithOf(medium, ray)).inscatter;
  for (double& value : floor) value *= kDarkestPart;
  return floor;
}

/// Returns view number i, which ends just above the ground if it meets it.
ViewRay ViewAboveGroundNumber(const Medium& medium, int i, const ReportRegime& regime) {
  ViewRay ray = ViewNumber(medium, i, regime);
  const RayExtent extent = ExtentOf(ray, medium.planet_radius_m, medium.atmosphere_height_m);
  if (extent.end == RayEnd::kGround) ray.length_m = (1.0 - 1e-9) * extent.end_m;
  return ray;
}

/// Solves `count` rays of every regime. @param solve  function from a ray to its reference value.
template <typename Solve>
void SolveRays(RayStudy& study, int count, DrawRay draw, const Solve& solve) {
  study.SolveCases(static_cast<std::size_t>(count), [&](std::size_t r, std::size_t i) {
    const ViewRay ray = draw(study.medium(), static_cast<int>(i) + 1, kRegimes[r]);
    return std::optional(RayStudy::Solved{ray, solve(ray)});
  });
}

}  // namespace

ReferenceValue RadianceReference(std::vector<double> radiance, std::vector<double> sigma,
                                 const std::vector<double>& floor) {
  ReferenceValue reference{std::move(radiance), std::move(sigma), {}};
  for (std::size_t band = 0; band < reference.value.size(); ++band)
    reference.scale.push_back(std::max({reference.value[band], floor[band], kDarkestValue}));
  return reference;
}

double SunElevationNumber(int i, const ReportRegime& regime) {
  const SunRange sun = regime.sun.value();
  return sun.lowest_deg + (sun.highest_deg - sun.lowest_deg) * Halton(i, 2);
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

RayStudy::RayStudy(ReportTopic topic, const Medium& medium, const ReportEffort& effort)
    : ErrorStudy(std::move(topic), effort), medium_(medium), air_(medium) {
  this->topic().medium = medium;
}

void RayStudy::SolveTransmittance(DrawRay draw) {
  SolveRays(*this, effort().rays, draw, [&](const ViewRay& ray) {
    ReferenceValue reference;
    for (const double tau : reference::OpticalDepthAlong(medium_, ray).tau)
      reference.value.push_back(std::exp(-tau));
    return reference;
  });
  topic().reference.text =
      "adaptive Gauss-Legendre quadrature in extended precision, relative error "
      "of the optical depth below 1e-10";
}

void RayStudy::SolveSingleScattering(DrawRay draw) {
  SolveRays(*this, effort().rays, draw, [&](const ViewRay& ray) {
    return RadianceReference(reference::SingleScatteringAlong(medium_, ray).inscatter, {},
                             DarkestRadiance(medium_, ray));
  });
  topic().reference.text =
      "adaptive Gauss-Legendre quadrature in extended precision, relative error "
      "below 1e-8";
}

void RayStudy::SolveAllOrders() {
  reference::PathOptions options{.max_paths = effort().paths, .relative_error = 0.0};
  options.stopped = Interrupted;
  SolveRays(*this, effort().traced_rays, ViewAboveGroundNumber, [&](const ViewRay& ray) {
    reference::PathTracedRadiance traced = reference::TraceRadiance(medium_, ray, options);
    return RadianceReference(std::move(traced.total), std::move(traced.standard_error),
                             DarkestRadiance(medium_, ray));
  });
  topic().reference.text =
      fmt::format("backward path tracing of all orders, {} paths per ray", effort().paths);
}

void RayStudy::AddTransmittanceMarch(const std::string& series, MarchRule rule, int steps,
                                     bool in_summary) {
  Add(
      {.series = series,
       .parameter = fmt::format("{} steps", steps),
       .origin = MethodOrigin::kLiterature,
       .in_summary = in_summary},
      [&](const ViewRay& ray) { return MarchedTransmittance(medium_, ray, rule, steps); }, steps);
}

void RayStudy::AddScatteringMarch(MarchRule rule, int steps, bool in_summary) {
  Add(
      {.series = rule == MarchRule::kMidpoint ? "uniform march" : "quadratic march",
       .parameter = fmt::format("{} steps", steps),
       .origin = MethodOrigin::kLiterature,
       .in_summary = in_summary},
      [&](const ViewRay& ray) {
        const RayExtent extent =
            ExtentOf(ray, medium_.planet_radius_m, medium_.atmosphere_height_m);
        const auto samples = air_.SampleAt(ray, MarchNodes(rule, steps, extent));
        return air_.Inscatter(air_.Scatter(samples), ray.nu);
      },
      steps);
}

void RayStudy::AddScatteringTable(ReportRow row, const ScatteringTableOptions& options) {
  const auto [table, seconds] = Built(effort(), [&] { return ScatteringTable(medium_, options); });
  const ScatteringTableSize& size = options.size;
  row.parameter = fmt::format("{} x {} x {} x {}", size.altitudes, size.mu, size.mu_s, size.nu);
  row.memory_bytes = table.bytes();
  row.build_s = seconds;
  Add(std::move(row), [&, &table = table](const ViewRay& ray) {
    return air_.Inscatter(table.Lookup(ray), ray.nu);
  });
}

}  // namespace alpenglow::lut
