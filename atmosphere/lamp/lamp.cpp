// SPDX-License-Identifier: MIT
#include "atmosphere/lamp/lamp.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"

namespace alpenglow::atmosphere {
namespace {

/// Interval of a table with ascending points that contains a value.
struct Between {
  std::size_t low, high;
  double share;  // interpolation weight of the higher one
};

Between Find(const std::vector<double>& points, double x) {
  const auto above = std::upper_bound(points.begin(), points.end(), x);
  if (above == points.begin()) return {0, 0, 0.0};
  const auto high = static_cast<std::size_t>(above - points.begin());
  if (high == points.size()) return {high - 1, high - 1, 0.0};
  return {high - 1, high, (x - points[high - 1]) / (points[high] - points[high - 1])};
}

// If the table does not cover a whole turn around the axis, it is interpolated from its last to its
// first column.
Between FindAround(const std::vector<double>& points, double x) {
  const double past_last = x - points.back();
  const double gap = 2.0 * kPi - points.back();
  if (past_last > 0.0 && gap > 0.0) return {points.size() - 1, 0, std::min(past_last / gap, 1.0)};
  return Find(points, x);
}

double FromTable(const LampTable& table, const glm::dvec3& cosines) {
  const double gamma = std::atan2(std::hypot(cosines.y, cosines.z), cosines.x);
  if (gamma > table.gamma_rad.back() || gamma < table.gamma_rad.front()) return 0.0;
  const Between row = Find(table.gamma_rad, gamma);
  const auto column = [&](std::size_t c) {
    const double* values = table.intensity.data() + c * table.gamma_rad.size();
    return (1.0 - row.share) * values[row.low] + row.share * values[row.high];
  };
  if (table.c_rad.size() == 1) return column(0);
  const double c = std::atan2(cosines.z, cosines.y);
  const Between around = FindAround(table.c_rad, c < 0.0 ? c + 2.0 * kPi : c);
  return (1.0 - around.share) * column(around.low) + around.share * column(around.high);
}

void RequireAscending(const std::vector<double>& angles, double high, const std::string& name) {
  for (std::size_t i = 0; i < angles.size(); ++i) {
    RequireInRange(angles[i], 0.0, high, name);
    if (i > 0 && !(angles[i - 1] < angles[i])) {
      throw InputError(
          fmt::format("{}: {} after {}; angles must ascend", name, angles[i], angles[i - 1]));
    }
  }
}

void ValidateTable(const LampTable& table, const std::string& prefix) {
  if (table.gamma_rad.size() < 2 || table.c_rad.empty() || table.c_rad.front() != 0.0 ||
      table.intensity.size() != table.gamma_rad.size() * table.c_rad.size()) {
    throw InputError(
        fmt::format("{}.table has {} values for {} by {} angles; it must have at least "
                    "two gammas, a C that begins at 0, and a value for each pair",
                    prefix, table.intensity.size(), table.gamma_rad.size(), table.c_rad.size()));
  }
  RequireAscending(table.gamma_rad, kPi * (1.0 + 1e-12), prefix + ".table.gamma");
  RequireAscending(table.c_rad, 2.0 * kPi * (1.0 + 1e-12), prefix + ".table.c");
  for (const double value : table.intensity) {
    RequireInRange(value, 0.0, 1e12, prefix + ".table.intensity");
  }
}

}  // namespace

double RelativeIntensity(const LampProfile& profile, const glm::dvec3& cosines) {
  switch (profile.kind) {
    case LampProfile::Kind::kIsotropic:
      return 1.0;
    case LampProfile::Kind::kCosinePower:
      return cosines.x > 0.0 ? std::pow(cosines.x, profile.exponent) : 0.0;
    case LampProfile::Kind::kCone:
      return shared::SpotShare(cosines.x, std::cos(profile.inner_rad), std::cos(profile.outer_rad));
    case LampProfile::Kind::kTable:
      return FromTable(profile.table, cosines);
  }
  throw InternalError("unknown kind of lamp profile");
}

double RelativeIntensity(const Lamp& lamp, const glm::dvec3& direction) {
  if (lamp.profile.kind == LampProfile::Kind::kIsotropic) return 1.0;
  return RelativeIntensity(lamp.profile,
                           {glm::dot(direction, lamp.axis), glm::dot(direction, lamp.side),
                            glm::dot(direction, glm::cross(lamp.side, lamp.axis))});
}

void Validate(const LampProfile& profile, const std::string& prefix) {
  switch (profile.kind) {
    case LampProfile::Kind::kIsotropic:
      return;
    case LampProfile::Kind::kCosinePower:
      RequireInRange(profile.exponent, 0.0, 1e6, prefix + ".exponent");
      return;
    case LampProfile::Kind::kCone:
      RequireInRange(profile.outer_rad, 0.0, kPi * (1.0 + 1e-12), prefix + ".outer");
      if (!(profile.inner_rad >= 0.0 && profile.inner_rad < profile.outer_rad)) {
        throw InputError(fmt::format("{}.inner is {} rad; it must lie in [0, {}), inside the outer",
                                     prefix, profile.inner_rad, profile.outer_rad));
      }
      return;
    case LampProfile::Kind::kTable:
      ValidateTable(profile.table, prefix);
      return;
  }
}

double LampAir::AltitudeOf(const glm::dvec3& point) const {
  return altitude_at_origin_m + glm::dot(up, point);
}

double LampLayer::LogDensity(double altitude_m) const {
  return shared::LayerLogDensity(altitude_m - base_m, 1.0 / scale_height_m);
}

double LampLayer::Density(double altitude_m) const { return std::exp(LogDensity(altitude_m)); }

double LampLayer::ColumnBetween(double length_m, double from_m, double to_m) const {
  const double log_from = LogDensity(from_m), log_to = LogDensity(to_m);
  return ExponentialColumn(length_m, std::exp(log_from), std::exp(log_to), log_from - log_to);
}

LampAir HomogeneousAir(double scattering_per_m, double extinction_per_m,
                       const PhaseFunction& phase) {
  LampLayer layer;
  layer.scattering_per_m = SpectrumOf<double>(1);
  layer.extinction_per_m = SpectrumOf<double>(1);
  layer.scattering_per_m[0] = scattering_per_m;
  layer.extinction_per_m[0] = extinction_per_m;
  layer.phase = phase;
  return {{layer}};
}

double ExponentialColumn(double length_m, double rho_a, double rho_b, double rise_over_h) {
  return shared::LampColumn(length_m, rho_a, rho_b, rise_over_h);
}

SpectrumOf<double> TransmittanceBetween(const LampAir& air, const glm::dvec3& from,
                                        const glm::dvec3& to) {
  const double length = glm::length(to - from);
  const double z_from = air.AltitudeOf(from);
  const double z_to = air.AltitudeOf(to);
  SpectrumOf<double> tau(air.bands());
  for (const LampLayer& layer : air.layers) {
    const double column = layer.ColumnBetween(length, z_from, z_to);
    for (std::size_t band = 0; band < tau.size(); ++band) {
      tau[band] += layer.extinction_per_m[band] * column;
    }
  }
  for (std::size_t band = 0; band < tau.size(); ++band) tau[band] = std::exp(-tau[band]);
  return tau;
}

}  // namespace alpenglow::atmosphere
