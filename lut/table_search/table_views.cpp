// SPDX-License-Identifier: MIT
#include "lut/table_search/table_views.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/base/error.h"
#include "atmosphere/base/finite.h"
#include "atmosphere/base/names.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/reference/path_tracer.h"
#include "atmosphere/reference/reference_solution.h"
#include "lut/cli/program.h"

namespace alpenglow::lut {
namespace {

constexpr MultipleScatteringOptions kFinest{.altitudes = 40,
                                            .sun_angles = 80,
                                            .degree = 8,
                                            .zenith_nodes = 16,
                                            .azimuth_nodes = 12,
                                            .ray_nodes = 14,
                                            .later_zenith_nodes = 10,
                                            .later_azimuth_nodes = 10,
                                            .later_ray_nodes = 10};
// Sampling along the rays of true values.
constexpr Sampling kFinestSampling{.nodes = 32, .split_ozone = true, .dark_samples = true};

constexpr std::size_t kMostPaths = 400000;

double Between(double low, double high, double share) { return low + (high - low) * share; }

/// Returns an altitude from 2 m to 10 km; half of them lie below 140 m.
double AltitudeOf(double share) { return 2.0 * std::pow(5000.0, share); }

/// Returns a zenith angle; half of the views lie within 12 degrees above the horizontal.
double SkyZenithOf(double share) {
  return share < 0.5 ? Between(0.0, 78.0, 2.0 * share) : Between(78.0, 89.9, 2.0 * share - 1.0);
}

ViewRay RayOf(ViewKind kind, std::size_t i, const Medium& medium) {
  const int point = static_cast<int>(i) + 1;  // point 0 is the corner of all ranges
  const double altitude_m = AltitudeOf(Halton(point, 2));
  const double azimuth_deg = 180.0 * Halton(point, 5);
  const double sun = Halton(point, 7);
  if (kind == ViewKind::kAerialPerspective) {
    ViewRay ray = RayFromAngles(altitude_m, Between(60.0, 100.0, Halton(point, 3)), azimuth_deg,
                                90.0 - Between(2.0, 90.0, sun));
    const RayExtent extent = ExtentOf(ray, medium.planet_radius_m, medium.atmosphere_height_m);
    // The ray ends in the air, before the ground.
    ray.length_m = std::min(500.0 * std::pow(200.0, Halton(point, 11)), 0.999 * extent.end_m);
    return ray;
  }
  const double sun_deg = kind == ViewKind::kSky        ? Between(2.0, 90.0, sun)
                         : kind == ViewKind::kTwilight ? Between(-6.0, 2.0, sun)
                                                       : Between(-6.0, 90.0, sun);
  return RayFromAngles(altitude_m, SkyZenithOf(Halton(point, 3)), azimuth_deg, 90.0 - sun_deg);
}

double Length(const std::vector<double>& values) {
  double squares = 0.0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares);
}

/// Returns |a - b| / |b|; 0 if both are 0.
double RelativeDistance(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> difference(b.size());
  for (std::size_t band = 0; band < b.size(); ++band) difference[band] = a[band] - b[band];
  const double length = Length(difference);
  return length == 0.0 ? 0.0 : length / Length(b);
}

std::vector<double> Values(const Spectrum& bands) {
  return {bands.values().begin(), bands.values().end()};
}

ReferenceView ViewReference(const Medium& medium, const SingleScattering<float>& air,
                            const MultipleScattering& finest, ViewKind kind, std::size_t i) {
  ReferenceView view{kind, RayOf(kind, i, medium), {}, {}};
  if (kind == ViewKind::kIrradiance) {
    view.light = Values(finest.SkyIrradiance(view.ray.altitude_m, view.ray.mu_s));
    return view;
  }
  reference::RayRadiance once = reference::SingleScatteringAlong(medium, view.ray);
  const Spectrum more = finest.InscatterAlong(air.Sample(view.ray, kFinestSampling), view.ray.nu);
  view.light = std::move(once.inscatter);
  for (std::size_t band = 0; band < view.light.size(); ++band) {
    view.light[band] += static_cast<double>(more[band]);
  }
  view.transmittance = std::move(once.transmittance);
  return view;
}

double ErrorOf(const TableLookup& tables, const ReferenceView& view) {
  if (view.kind == ViewKind::kIrradiance) {
    return RelativeDistance(Values(tables.SkyIrradiance(view.ray.altitude_m, view.ray.mu_s)),
                            view.light);
  }
  double error = RelativeDistance(Values(tables.InscatterOfAllOrders(view.ray)), view.light);
  const Spectrum transmittance = tables.Transmittance(view.ray);
  for (std::size_t band = 0; band < transmittance.size(); ++band) {
    const auto value = static_cast<double>(transmittance[band]);
    error = std::max(error, std::abs(value - view.transmittance[band]));
  }
  return error;
}

}  // namespace

std::string_view NameOf(ViewKind kind) {
  constexpr EnumNames kNames{{std::pair{ViewKind::kSky, "sky by day"},
                              {ViewKind::kAerialPerspective, "aerial perspective"},
                              {ViewKind::kTwilight, "twilight"},
                              {ViewKind::kIrradiance, "irradiance of the sky"}}};
  return kNames.Of(kind);
}

MultipleScattering FinestMultipleScattering(const Medium& medium) {
  const MultipleScatteringOptions needed = OptionsFor(medium);
  MultipleScatteringOptions options = kFinest;
  options.delta_m = needed.delta_m;
  options.degree = std::max(options.degree, needed.degree);
  options.azimuth_nodes = std::max(options.azimuth_nodes, needed.azimuth_nodes);
  options.later_zenith_nodes = std::max(options.later_zenith_nodes, needed.later_zenith_nodes);
  options.later_azimuth_nodes = std::max(options.later_azimuth_nodes, needed.later_azimuth_nodes);
  options.later_ray_nodes = std::max(options.later_ray_nodes, needed.later_ray_nodes);
  return MultipleScattering(medium, options);
}

ReferenceViews::ReferenceViews(const Medium& medium, const MultipleScattering& finest,
                               std::size_t views_of_a_kind, std::size_t first)
    : views_(kViewKinds.size() * views_of_a_kind) {
  const SingleScattering<float> air(medium);
  tbb::parallel_for(std::size_t{0}, views_.size(), [&](std::size_t k) {
    if (Interrupted()) return;
    views_[k] = ViewReference(medium, air, finest, kViewKinds[k / views_of_a_kind],
                              first + k % views_of_a_kind);
  });
  ThrowIfInterrupted();
}

ErrorStatistics ReferenceViews::ErrorsOf(const TableLookup& tables, ViewKind kind) const {
  std::vector<const ReferenceView*> views;
  for (const ReferenceView& view : views_) {
    if (view.kind == kind) views.push_back(&view);
  }
  std::vector<double> errors(views.size());
  tbb::parallel_for(std::size_t{0}, views.size(),
                    [&](std::size_t i) { errors[i] = ErrorOf(tables, *views[i]); });
  return ErrorStatistics(std::move(errors));
}

double ReferenceViews::PathCheck::Unexplained() const {
  return std::sqrt(std::max(rms * rms - noise * noise, 0.0));
}

ReferenceViews::PathCheck ReferenceViews::HeldAgainstPaths(const Medium& medium, ViewKind kind,
                                                           std::size_t views,
                                                           double standard_error) const {
  std::vector<const ReferenceView*> all;
  for (const ReferenceView& view : views_) {
    if (view.kind == kind) all.push_back(&view);
  }
  views = std::min(views, all.size());
  const reference::PathOptions options{
      .max_paths = kMostPaths, .relative_error = standard_error, .stopped = Interrupted};
  std::vector<double> errors, noises;
  for (std::size_t i = 0; i < views; ++i) {
    const ReferenceView& view = *all[i * all.size() / views];
    std::vector<double> value, noise;
    if (kind == ViewKind::kIrradiance) {
      auto traced = reference::TraceIrradiance(medium, view.ray.altitude_m, view.ray.mu_s,
                                               reference::PlaneSide::kFromAbove, options);
      value = std::move(traced.value);
      noise = std::move(traced.standard_error);
    } else {
      auto traced = reference::TraceRadiance(medium, view.ray, options);
      value = std::move(traced.total);
      noise = std::move(traced.standard_error);
    }
    ThrowIfInterrupted();
    errors.push_back(RelativeDistance(view.light, value));
    noises.push_back(Length(value) > 0.0 ? Length(noise) / Length(value) : 0.0);
  }
  return {RmsOf(errors), RmsOf(noises)};
}

}  // namespace alpenglow::lut
