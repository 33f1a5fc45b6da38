// SPDX-License-Identifier: MIT
#include "viewer/ground/drape_texels.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace alpenglow {

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

// At altitude 0 points of the frame are their own feet.
DrapeTexels::DrapeTexels(const ColourDrape& drape, const FlatRectangle& over, std::size_t most)
    : place(over), columns(most), rows(most) {
  const double step_x_m = over.width_m / static_cast<double>(columns);
  const double step_y_m = over.depth_m / static_cast<double>(rows);
  rgba.reserve(columns * rows);
  for (std::size_t i = 0; i < columns * rows; ++i) {
    const glm::dvec3 point(over.west_m + step_x_m * (static_cast<double>(i % columns) + 0.5),
                           over.south_m + step_y_m * (static_cast<double>(i / columns) + 0.5), 0.0);
    const auto rgb = drape.At(point, 0.0, std::max(step_x_m, step_y_m));
    std::array<std::uint16_t, 4> texel{};
    for (std::size_t k = 0; rgb && k < 3; ++k)
      texel[k] = static_cast<std::uint16_t>(std::lround(65535.0 * (*rgb)[k]));
    if (rgb) texel[3] = 65535;
    rgba.push_back(texel);
  }
}

}  // namespace alpenglow
