// SPDX-License-Identifier: MIT
// The tables of one eye's air as a graphics card would read them: linear between texels.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "atmosphere/math/constants.h"
#include "atmosphere/medium/phase_text.h"
#include "lut/camera_tables/air_tables.h"
#include "lut/tables/transmittance_table.h"

namespace alpenglow::tests {

using namespace lut;

/// Between texels, places counted in texels from the first.
inline glm::dvec4 Linear(const AirTexels& texels, double x, double y = 0.0, double z = 0.0) {
  glm::dvec4 sum(0.0);
  const auto cell = [](double at, int n) {
    const int first = std::clamp(static_cast<int>(std::floor(at)), 0, std::max(n - 2, 0));
    return std::pair(first, std::clamp(at - first, 0.0, 1.0));
  };
  const auto [i, u] = cell(x, texels.width);
  const auto [j, v] = cell(y, texels.height);
  const auto [k, w] = cell(z, texels.depth);
  for (int corner = 0; corner < 8; ++corner) {
    const int a = corner & 1, b = corner >> 1 & 1, c = corner >> 2;
    const double weight = (a ? u : 1.0 - u) * (b ? v : 1.0 - v) * (c ? w : 1.0 - w);
    if (weight > 0.0) sum += weight * glm::dvec4(texels.At(i + a, j + b, k + c));
  }
  return sum;
}

struct AirToPoint {
  glm::dvec4 single, multiple_scattering, transmittance;
};

/// An eye under a sun in the north that is seen at this elevation, without refraction.
inline EyeUnderLight EyeUnderSun(double altitude_m, double elevation_deg) {
  const double elevation = elevation_deg * kRadiansPerDegree;
  return {altitude_m, Unrefracted({0.0, std::cos(elevation), std::sin(elevation)})};
}

class AirReading {
 public:
  explicit AirReading(const AirTables& tables) : AirReading(tables, tables.eye) {}
  /// The constructor reads the tables for another eye and another sun, as AirTextures::SetView
  /// does.
  AirReading(const AirTables& tables, const EyeUnderLight& eye)
      : tables_(tables),
        mu_s_(eye.mu_s()),
        sun_(std::acos(std::clamp(eye.mu_s(), -1.0, 1.0))),
        sun_seen_(eye.zenith_angle_seen_rad()),
        dip_(-std::asin(shared::HorizonCosine<double>(std::max(eye.altitude_m, 0.0) / 1000.0,
                                                      tables.map.radius))) {}

  /// @param angle  over the horizon [rad]; azimuth from the sun's, in [0, pi].
  [[nodiscard]] glm::dvec4 Sky(double angle, double azimuth) const {
    const AirMap& map = tables_.map;
    if (map.altitude > map.top && angle > map.sky_range) return glm::dvec4(0.0);
    const AirTablesSize& size = tables_.size;
    const double mu = std::sin(angle - dip_);
    const double foot =
        shared::AirFoot<double>(map.altitude, mu, angle < 0.0 ? 1.0 : 0.0, map.radius);
    return Twilight(angle, azimuth, foot) * Mix(angle, azimuth, tables_.sky_mix) *
           Linear(tables_.sky, Column(azimuth, size.sky_columns),
                  Row(angle, map.sky_range, size.sky_rows, size.sky_ground_rows));
  }

  [[nodiscard]] glm::dvec4 ToSpace(double angle) const {
    const AirMap& map = tables_.map;
    if (map.altitude > map.top && angle > map.sky_range) return glm::dvec4(1.0);
    return Linear(tables_.to_space, Row(angle, map.sky_range, tables_.size.through_rows,
                                        tables_.size.through_ground_rows));
  }

  [[nodiscard]] AirToPoint To(double angle, double azimuth, double distance_km) const {
    using namespace shared;
    const AirMap& map = tables_.map;
    const AirTablesSize& size = tables_.size;
    const double over = map.altitude > 0.0 ? angle : std::max(angle, 0.0);
    const bool ground = over < 0.0;
    const double mu = std::sin(over - dip_);
    const double begin = AirEntry<double>(map.altitude, mu, map.top, map.radius);
    const double end = ground ? AirEndDown<double>(map.altitude, mu, map.radius)
                              : AirEndUp<double>(map.altitude, mu, map.ceiling, map.radius);
    const double near = AirEntry<double>(map.altitude, mu, map.ceiling, map.radius);
    const double reach = std::max(end - near, 1e-3);
    const double beyond = std::clamp(distance_km - near, 0.0, reach);
    const double way = std::clamp(distance_km, begin, near + reach) - begin;
    const double w =
        AirNodeFromShare<double>(beyond / reach, ground ? map.ground_crowding : map.sky_crowding);
    const double below = ground ? std::max(distance_km - near - reach, 0.0) : 0.0;
    const glm::dvec4 tau = way * Linear(tables_.extinction, w * (size.extinction_distances - 1),
                                        Row(over, map.air_sky_range, size.extinction_rows,
                                            size.extinction_ground_rows)) +
                           below * glm::dvec4(tables_.extinction_below);
    const double x = Column(azimuth, size.columns);
    const double y = Row(over, map.air_sky_range, size.rows, size.ground_rows);
    const double z = w * (size.distances - 1);
    glm::dvec4 absorbed;
    for (int band = 0; band < 4; ++band) absorbed[band] = -std::expm1(-tau[band]);
    absorbed *= Twilight(angle, azimuth, near + 0.5 * beyond);
    return {Mix(angle, azimuth, {tables_.single_mix[0], tables_.single_mix[1], glm::vec4(0.0F)}) *
                absorbed * Linear(tables_.single, x, y, z),
            absorbed * Linear(tables_.multiple_scattering, x, y, z), glm::exp(-tau)};
  }

 private:
  [[nodiscard]] static double Column(double azimuth, int columns) {
    const double sine = std::sin(0.5 * azimuth);
    return shared::AirColumn<double>(sine * sine) * (columns - 1);
  }
  [[nodiscard]] double Row(double angle, double sky_range, int sky, int ground) const {
    const double range = angle < 0.0 ? tables_.map.ground_range : sky_range;
    const double v = shared::AirRow<double>(std::tan(0.5 * std::abs(angle)), std::tan(0.5 * range));
    return angle < 0.0 ? sky + v * (ground - 1) : v * (sky - 1);
  }
  [[nodiscard]] double SunCosine(double angle, double azimuth, double sun) const {
    const double zenith = 0.5 * kPi + dip_ - angle;
    return std::clamp(
        std::cos(zenith) * std::cos(sun) + std::sin(zenith) * std::sin(sun) * std::cos(azimuth),
        -1.0, 1.0);
  }
  [[nodiscard]] double Twilight(double angle, double azimuth, double distance_km) const {
    const AirMap& map = tables_.map;
    return shared::AirTwilight<double>(map.altitude, mu_s_, SunCosine(angle, azimuth, sun_),
                                       distance_km, map.twilight_fall, map.twilight_reference,
                                       map.radius);
  }
  /// @param mix  of molecules, aerosol and the rest.
  [[nodiscard]] glm::dvec4 Mix(double angle, double azimuth,
                               const std::array<glm::vec4, 3>& mix) const {
    const double nu = SunCosine(angle, azimuth, sun_seen_);
    const double node =
        shared::PhaseNode<double>(std::max(0.5 - 0.5 * nu, 0.0)) * (tables_.phase.width - 1);
    return 0.0596831036594607509 * (1.0 + nu * nu) * glm::dvec4(mix[0]) +
           Linear(tables_.phase, node) * glm::dvec4(mix[1]) + glm::dvec4(mix[2]);
  }

  const AirTables& tables_;
  double mu_s_, sun_, sun_seen_, dip_;
};

}  // namespace alpenglow::tests
