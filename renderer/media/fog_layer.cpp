// SPDX-License-Identifier: MIT
#include "renderer/media/fog_layer.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "atmosphere/text/error.h"
#include "renderer/ground/scene_geometry.h"
#include "renderer/media/fog_layer_text.h"

namespace alpenglow::renderer {
namespace {

constexpr double kThin = 1e-9;

}  // namespace

FogLayer::FogLayer(double base_m, double scale_height_m, double planet_radius_m, double top_m)
    : base_m_(base_m),
      scale_height_m_(scale_height_m),
      planet_radius_m_(planet_radius_m),
      top_m_(top_m),
      thin_m_(std::isinf(scale_height_m)
                  ? top_m
                  : std::min(base_m - scale_height_m * std::log(kThin), top_m)) {
  ALPENGLOW_ENSURE(scale_height_m, >, 0.0);
}

double FogLayer::AltitudeOf(const glm::dvec3& point) const {
  return AltitudeOverSphere(point, planet_radius_m_);
}

double FogLayer::DensityAtAltitude(double altitude_m) const {
  if (altitude_m > thin_m_) return 0.0;
  return shared::FogDensity(altitude_m - base_m_, scale_height_m_);
}

std::vector<DensePiece> FogLayer::PiecesAlong(const glm::dvec3& origin, const glm::dvec3& direction,
                                              double length_m) const {
  const glm::dvec3 from = origin + glm::dvec3(0.0, 0.0, planet_radius_m_);
  const double lowest_m = -glm::dot(from, direction);
  const double perigee_m = AltitudeOf(origin + lowest_m * direction);
  if (perigee_m >= thin_m_) return {};
  const double half =
      std::sqrt((thin_m_ - perigee_m) * (2.0 * planet_radius_m_ + thin_m_ + perigee_m));
  const double begin = std::max(lowest_m - half, 0.0);
  const double end = std::min(lowest_m + half, length_m);
  std::vector<DensePiece> pieces;
  const auto add = [&](double a, double b) {
    if (!(a < b)) return;
    const double most =
        std::max(DensityAt(origin + a * direction), DensityAt(origin + b * direction));
    if (most > 0.0) pieces.push_back({a, b, most});
  };
  add(begin, std::min(end, std::max(begin, lowest_m)));
  add(std::max(begin, std::min(end, lowest_m)), end);
  return pieces;
}

double FogLayer::ColumnAbove(double altitude_m) const {
  if (std::isinf(scale_height_m_)) return std::max(top_m_ - altitude_m, 0.0);
  return scale_height_m_ * DensityAtAltitude(altitude_m);
}

double FogLayer::ColumnToSpace(const glm::dvec3& point, const glm::dvec3& direction) const {
  const double altitude = AltitudeOf(point);
  const double r = planet_radius_m_ + altitude;
  const double mu = std::clamp(
      glm::dot(point + glm::dvec3(0.0, 0.0, planet_radius_m_), direction) / r, -1.0, 1.0);
  if (std::isinf(scale_height_m_)) {
    const double rest = (top_m_ - altitude) * (planet_radius_m_ + top_m_ + r);
    return rest <= 0.0 ? 0.0 : rest / (r * mu + std::sqrt(r * r * mu * mu + rest));
  }
  const auto upwards = [&](double from_m, double cosine) {
    return shared::FogColumnUp(from_m, cosine, DensityAtAltitude(from_m), scale_height_m_,
                               planet_radius_m_);
  };
  if (mu >= 0.0) return upwards(altitude, mu);
  const double perigee = altitude - r * (1.0 - std::sqrt(1.0 - mu * mu));
  return std::max(2.0 * upwards(perigee, 0.0) - upwards(altitude, -mu), 0.0);
}

}  // namespace alpenglow::renderer
