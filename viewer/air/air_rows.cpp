// SPDX-License-Identifier: MIT
#include "viewer/air/air_rows.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/air/phase_text.h"
#include "atmosphere/number/constants.h"

namespace alpenglow::viewer {
namespace {

constexpr double kHair_rad = 1e-9;  // off the horizon, to the side of it that a row belongs to

AirRow RowAt(const AirMap& map, bool ground, double v, double range) {
  const double half_tangent = shared::AirHalfTangent<double>(v, std::tan(0.5 * range));
  const double angle = std::max(2.0 * std::atan(half_tangent), kHair_rad) * (ground ? 1.0 : -1.0);
  const double zenith = std::clamp(0.5 * kPi + map.horizon_dip + angle, 0.0, kPi);
  return {ground, zenith, std::cos(zenith), std::sin(zenith)};
}

double Sine(double cosine) { return std::sqrt(std::max((1.0 - cosine) * (1.0 + cosine), 0.0)); }

}  // namespace

glm::vec4 Vec4Of(const Bands<float>& bands) { return Vec4Of(bands.value, bands.count); }

glm::vec4 Vec4Of(const std::array<float, kMaxBands>& per_band, std::size_t bands) {
  glm::vec4 texel(0.0F);
  for (std::size_t band = 0; band < bands; ++band)
    texel[static_cast<glm::length_t>(band)] = per_band[band];
  return texel;
}

std::vector<AirRow> RowsOf(const AirMap& map, int sky, double sky_range, int ground) {
  std::vector<AirRow> rows;
  for (int i = 0; i < sky; ++i) rows.push_back(RowAt(map, false, Unit(i, sky), sky_range));
  for (int i = 0; i < ground; ++i)
    rows.push_back(RowAt(map, true, Unit(i, ground), map.ground_range));
  return rows;
}

std::vector<double> AzimuthsOf(int columns) {
  std::vector<double> azimuths;
  for (int i = 0; i < columns; ++i)
    azimuths.push_back(4.0 * std::atan(shared::AirQuarterTangent<double>(Unit(i, columns))));
  return azimuths;
}

double SunCosineOf(const AirRow& row, double mu_s, double azimuth) {
  return std::clamp(row.mu * mu_s + row.sine * Sine(mu_s) * std::cos(azimuth), -1.0, 1.0);
}

float AirPhases::OfMolecules(double nu) {
  return static_cast<float>(shared::PhaseRayleigh<double>(nu));
}

glm::vec4 AirPhases::OfAerosol(double nu) const {
  const double place = shared::PhaseNode<double>(0.5 - 0.5 * nu) * (nodes_.width - 1);
  const int cell = std::min(static_cast<int>(place), nodes_.width - 2);
  const auto t = static_cast<float>(place - cell);
  return nodes_.At(cell, 0) + t * (nodes_.At(cell + 1, 0) - nodes_.At(cell, 0));
}

float TwilightAt(const AirMap& map, double mu_s, double nu, double distance_km) {
  return static_cast<float>(shared::AirTwilight<double>(
      map.altitude, mu_s, nu, distance_km, map.twilight_fall, map.twilight_reference, map.radius));
}

}  // namespace alpenglow::viewer
