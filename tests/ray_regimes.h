// SPDX-License-Identifier: MIT
// Rays by what is hard about them: the height of the sun where the ray is lowest, and what the ray
// passes through. Low-discrepancy samples, the same for tests and benchmarks.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "atmosphere/constants.h"
#include "atmosphere/single_scattering.h"

namespace alpenglow::tests {

struct SunHeights {
  std::string name;
  double low_deg, high_deg;
};
inline const std::array<SunHeights, 3> kSunHeights{
    {{"5 to 90 deg", 5.0, 90.0}, {"0 to 5 deg", 0.0, 5.0}, {"-6 to 0 deg", -6.0, 0.0}}};

enum class RayView { kSky, kLength, kAircraftDown, kSpaceDown, kLimbInside, kLimbFromSpace };
struct NamedView {
  RayView view;
  std::string name;
};
inline const std::array<NamedView, 6> kRayViews{{{RayView::kSky, "sky from 2 m to 10 km"},
                                                 {RayView::kLength, "0.1 to 100 km of air"},
                                                 {RayView::kAircraftDown, "ground from 10 km"},
                                                 {RayView::kSpaceDown, "ground from 400 km"},
                                                 {RayView::kLimbInside, "limb from 3 to 60 km"},
                                                 {RayView::kLimbFromSpace, "limb from 400 km"}}};

/// Number i of the sequence of van der Corput in a base.
inline double RadicalInverse(int i, int base) {
  double value = 0.0, digit = 1.0;
  for (; i > 0; i /= base) value += (digit /= base) * (i % base);
  return value;
}

/// A ray whose sun has the given elevation and azimuth seen from the ray's lowest point, that lies
/// `low_m` along it.
inline ViewRay WithSunAt(ViewRay ray, double low_m, double radius_m, double elevation,
                         double azimuth) {
  const double sine = std::sqrt((1.0 - ray.mu) * (1.0 + ray.mu));
  const double turn =
      std::atan2(low_m * sine, radius_m + ray.altitude_m + low_m * ray.mu);  // of the vertical
  const double along = std::cos(elevation) * std::cos(azimuth), up = std::sin(elevation);
  const double x = along * std::cos(turn) + up * std::sin(turn);
  const double z = up * std::cos(turn) - along * std::sin(turn);
  ray.mu_s = std::clamp(z, -1.0, 1.0);
  ray.nu = std::clamp(x * sine + z * ray.mu, -1.0, 1.0);
  return ray;
}

/// Ray number i >= 1 of a regime.
inline ViewRay RayOfRegime(int i, const SunHeights& sun, RayView view, const Medium& medium) {
  const double radius = medium.planet_radius_m;
  const double u = RadicalInverse(i, 3), w = RadicalInverse(i, 7);
  const double elevation =
      (sun.low_deg + (sun.high_deg - sun.low_deg) * RadicalInverse(i, 2)) * kRadiansPerDegree;
  const double azimuth = kPi * RadicalInverse(i, 5);
  const auto third = static_cast<std::size_t>(i % 3);
  const auto horizon = [&](double altitude, double perigee) {
    return -std::sqrt((altitude - perigee) * (2.0 * radius + altitude + perigee)) /
           (radius + altitude);
  };
  ViewRay ray;
  ray.altitude_m = std::array{2.0, 1500.0, 10000.0}[third];
  double low_m = 0.0;
  switch (view) {
    case RayView::kSky:  // half of the views within 10 degrees of the horizontal
      ray.mu = std::cos((i % 2 == 0 ? 90.0 * u : 80.0 + 10.0 * u) * kRadiansPerDegree);
      break;
    case RayView::kLength:
      ray.mu = std::cos((80.0 + 10.0 * w) * kRadiansPerDegree);
      ray.length_m = std::pow(10.0, 2.0 + 3.0 * u);
      break;
    case RayView::kAircraftDown:
    case RayView::kSpaceDown:
      ray.altitude_m = view == RayView::kSpaceDown ? 400e3 : 10e3;
      ray.mu = std::cos(std::acos(horizon(ray.altitude_m, 0.0)) * (1.0 - u * u) + kPi * u * u);
      low_m = ExtentOf(ray, radius, medium.atmosphere_height_m).end_m;
      break;
    case RayView::kLimbInside:
    case RayView::kLimbFromSpace:
      ray.altitude_m = view == RayView::kLimbFromSpace ? 400e3 : std::array{3e3, 10e3, 60e3}[third];
      ray.mu = horizon(ray.altitude_m, std::min(ray.altitude_m, 100e3) * (0.001 + 0.998 * u));
      low_m = -(radius + ray.altitude_m) * ray.mu;
      break;
  }
  return WithSunAt(ray, low_m, radius, elevation, azimuth);
}

struct ErrorSummary {
  double rms = 0.0, percentile99 = 0.0, largest = 0.0;
};

/// Relative error of single scattering in float over a regime, all bands; the truth is 64 nodes a
/// panel in double. Light below 1e-12 of the sun's irradiance does not count.
inline ErrorSummary ErrorOfRegime(const Medium& medium, const SunHeights& sun, RayView view,
                                  const Sampling& sampling, int rays) {
  const AirIntegrator<float> air(medium);
  const AirIntegrator<double> fine(medium);
  std::vector<double> errors;
  for (int i = 1; i <= rays; ++i) {
    const ViewRay ray = RayOfRegime(i, sun, view, medium);
    const auto truth = fine.Inscatter(fine.Scatter(fine.Sample(ray, {.nodes = 64})), ray.nu);
    const auto fast = air.Inscatter(air.Scatter(air.Sample(ray, sampling)), ray.nu);
    for (std::size_t band = 0; band < air.bands(); ++band) {
      if (truth[band] < 1e-12) continue;
      errors.push_back(std::abs(static_cast<double>(fast[band]) / truth[band] - 1.0));
    }
  }
  if (errors.empty()) return {};
  std::sort(errors.begin(), errors.end());
  double squares = 0.0;
  for (const double error : errors) squares += error * error;
  return {std::sqrt(squares / static_cast<double>(errors.size())), errors[errors.size() * 99 / 100],
          errors.back()};
}

}  // namespace alpenglow::tests
