// SPDX-License-Identifier: MIT
#include "viewer/ground/drape_texels.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace alpenglow::viewer {

FlatRectangle RectangleOf(const TriangleMesh& mesh) {
  double west = std::numeric_limits<double>::infinity(), south = west, east = -west, north = -west;
  for (const auto& position : mesh.positions) {
    west = std::min(west, static_cast<double>(position[0]));
    east = std::max(east, static_cast<double>(position[0]));
    south = std::min(south, static_cast<double>(position[1]));
    north = std::max(north, static_cast<double>(position[1]));
  }
  return {west, south, east - west, north - south};
}

FlatRectangle CoveredPart(const ColourDrape& drape, const FlatRectangle& of) {
  constexpr int kSteps = 100;
  const double step_x_m = of.width_m / kSteps, step_y_m = of.depth_m / kSteps;
  int west = kSteps, south = kSteps, east = -1, north = -1;
  for (int i = 0; i < kSteps * kSteps; ++i) {
    const int x = i % kSteps, y = i / kSteps;
    const glm::dvec3 middle(of.west_m + step_x_m * (x + 0.5), of.south_m + step_y_m * (y + 0.5),
                            0.0);
    if (!drape.At(middle, 0.0, 0.0)) continue;
    west = std::min(west, x - 1), east = std::max(east, x + 2);
    south = std::min(south, y - 1), north = std::max(north, y + 2);
  }
  if (east < 0) return of;
  west = std::max(west, 0), south = std::max(south, 0);
  east = std::min(east, kSteps), north = std::min(north, kSteps);
  return {of.west_m + west * step_x_m, of.south_m + south * step_y_m, (east - west) * step_x_m,
          (north - south) * step_y_m};
}

// At altitude 0 points of the frame are their own feet.
DrapeTexels::DrapeTexels(const ColourDrape& drape, const FlatRectangle& over, std::size_t most)
    : place(over), columns(most), rows(most) {
  const double step_x_m = over.width_m / static_cast<double>(columns);
  const double step_y_m = over.depth_m / static_cast<double>(rows);
  rgba.resize(columns * rows);
  tbb::parallel_for(std::size_t{0}, rgba.size(), [&](std::size_t i) {
    const glm::dvec3 point(over.west_m + step_x_m * (static_cast<double>(i % columns) + 0.5),
                           over.south_m + step_y_m * (static_cast<double>(i / columns) + 0.5), 0.0);
    const auto rgb = drape.At(point, 0.0, std::max(step_x_m, step_y_m));
    std::array<std::uint16_t, 4>& texel = rgba[i];
    for (std::size_t k = 0; rgb && k < 3; ++k)
      texel[k] = static_cast<std::uint16_t>(std::lround(65535.0 * (*rgb)[k]));
    if (rgb) texel[3] = 65535;
  });
}

}  // namespace alpenglow::viewer
