// SPDX-License-Identifier: MIT
#include "renderer/ground/land_cover.h"

namespace alpenglow::renderer {

std::optional<std::array<double, 3>> CoverOfClass(int number) {
  switch (number) {
    case 0:  // no data
      return {{0.0, 1.0, 1.0}};
    case 10:  // trees
    case 95:  // mangroves
      return {{1.0, 0.0, 0.0}};
    case 20:  // shrubs
      return {{0.5, 0.1, 0.0}};
    case 30:  // grass
      return {{0.0, 0.0, 0.0}};
    case 40:  // crops, of which some land lies open
      return {{0.0, 0.15, 0.0}};
    case 50:  // built-up
      return {{0.1, 0.5, 0.0}};
    case 60:  // bare, or sparsely grown
      return {{0.0, 1.0, 0.0}};
    case 70:  // snow and ice
      return {{0.0, 0.0, 1.0}};
    case 80:  // water
      return {{1.0, 1.0, 0.0}};
    case 90:  // wetland of herbs
      return {{0.2, 0.0, 0.0}};
    case 100:  // moss and lichen
      return {{0.0, 0.4, 0.0}};
    default:
      return std::nullopt;
  }
}

}  // namespace alpenglow::renderer
