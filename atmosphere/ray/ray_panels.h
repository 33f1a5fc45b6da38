// SPDX-License-Identifier: MIT
// Where single scattering along a ray is sampled: panels on which the integrand is smooth, each
// with a map that is dense where the air is.
//
// A ray is cut at the planet's shadow and at its perigee (and, for a tent of ozone, on request
// where it bends the light). The map of distance in a panel is that of ray_map.glsl.
#pragma once

#include <array>
#include <cstddef>

#include "atmosphere/air/medium.h"
#include "atmosphere/number/constants.h"
#include "atmosphere/ray/ray.h"
#include "atmosphere/ray/ray_kernel.h"

namespace alpenglow::atmosphere {

[[nodiscard]] inline double Kilometres(double metres) { return metres / kMetresPerKilometre; }

/// A stretch of the ray on which the altitude is monotone [km from the entry].
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

/// By what kilometres are multiplied for the map of ray_map.glsl, whose lengths are those of air as
/// deep as the Earth's: 1 in such air and deeper. In a layer of scale height 100 m it is 64, so that
/// nodes stand where the air is.
[[nodiscard]] double MapLengthsPerKm(const Medium& medium);

/// The entry of a ray into the air: the observer, or the first point in the shell.
[[nodiscard]] RayEntry EntryOf(const ViewRay& ray, const RayExtent& extent, const Medium& medium);

/// @param sampling  nodes of an ordinary panel. One whose lower end sunbeams graze, or where the
/// planet's shadow begins, gets half as many more; so does one that comes down through the air at a
/// slant, or goes on from the perigee of such a ray, twice if the ray began above 60 km or sunbeams
/// graze it; at most 64. Then all have about the same error.
[[nodiscard]] RayPanels PanelsOf(const ViewRay& ray, const RayExtent& extent, const RayEntry& entry,
                                 const Medium& medium, const Sampling& sampling);

/// Distances at which the line from altitude h along mu crosses altitude z [km], inside and outside
/// of [0, length] alike; none if it passes above.
struct LineCrossings {
  std::size_t count;
  std::array<double, 2> distance;
};
[[nodiscard]] LineCrossings CrossingsOf(double h, double mu, double z, double radius);

}  // namespace alpenglow::atmosphere
