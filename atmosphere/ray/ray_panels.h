// SPDX-License-Identifier: MIT
// Panels of a ray on which the integrand of single scattering is smooth, each with a map that
// places samples densely in dense air.
//
// A ray is cut at the planet's shadow and at its perigee (and, on request, at the kinks of an ozone
// tent). The map of distance in a panel is that of ray_map.glsl.
#pragma once

#include <array>
#include <cstddef>

#include "atmosphere/math/constants.h"
#include "atmosphere/medium/medium.h"
#include "atmosphere/ray/ray.h"
#include "atmosphere/ray/ray_kernel.h"

namespace alpenglow::atmosphere {

[[nodiscard]] inline double Kilometres(double metres) { return metres / kMetresPerKilometre; }

/// A segment of the ray on which the altitude is monotone [km from the entry].
struct RayPanel {
  double begin, end;
  bool lit;        // outside the shadow of the planet
  bool rises;      // its lower end is its beginning
  double stretch;  // b of ray_map.glsl
  int nodes;
};

struct RayPanels {
  static constexpr std::size_t kMost = kMaxRayPanels;
  std::array<RayPanel, kMost> panel;
  std::size_t count = 0;
};

/// Returns the factor that scales kilometres for the map of ray_map.glsl, whose lengths refer to
/// air as deep as the Earth's: 1 for such air and deeper. In a layer of scale height 100 m it is
/// 64, so that nodes are placed in the air.
[[nodiscard]] double MapLengthsPerKm(const Medium& medium);

/// Returns the entry of a ray into the air: the observer, or the first point in the shell.
[[nodiscard]] RayEntry EntryOf(const ViewRay& ray, const RayExtent& extent, const Medium& medium);

/// Returns the panels of a ray. The number of nodes is chosen so that all panels have about the
/// same error.
/// @param sampling  nodes of an ordinary panel. A panel has half as many more if sunbeams graze its
/// lower end, or if the planet's shadow begins there. So has a panel that descends through the air
/// at a slant, or continues from the perigee of such a ray; it has twice this increase if the ray
/// began above 60 km or sunbeams graze it. The maximum is 64.
[[nodiscard]] RayPanels PanelsOf(const ViewRay& ray, const RayExtent& extent, const RayEntry& entry,
                                 const Medium& medium, const Sampling& sampling);

/// Distances at which the line from altitude h along mu crosses altitude z [km], both inside and
/// outside of [0, length]; none if it passes above.
struct LineCrossings {
  std::size_t count;
  std::array<double, 2> distance;
};
[[nodiscard]] LineCrossings CrossingsOf(double h, double mu, double z, double radius);

}  // namespace alpenglow::atmosphere
