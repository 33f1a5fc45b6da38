// SPDX-License-Identifier: MIT
// Distances along a way.
#pragma once

#include <glm/geometric.hpp>

#include "atmosphere/sun/geodesy.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Places that are closer are the same place: a receiver does not tell them apart.
inline constexpr double kSamePlace_m = 0.5;

/// The chord between two places [m].
[[nodiscard]] inline double DistanceBetween(const GeodeticPosition& a, const GeodeticPosition& b) {
  return glm::length((EcefFromGeodetic(kWgs84, a) - EcefFromGeodetic(kWgs84, b)).xyz);
}

}  // namespace alpenglow::renderer
