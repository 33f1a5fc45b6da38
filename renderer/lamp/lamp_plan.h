// SPDX-License-Identifier: MIT
// What a picture needs of the lamps, tile by tile.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <vector>

#include "atmosphere/ray/single_scattering.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

struct LampSettings {
  int nodes = 12;  // of Airlight, see there
  /// Of a tile's lamp light: what standing for others and being left out may add up to.
  double share_of_error = 5e-3;
  double floor_cd_per_m2 = 0.0;  // errors below this do not matter
};

/// Nodes of the tree of lamps, by number.
using LampNodes = std::vector<std::uint32_t>;

/// What a tile of a picture sees of the lamps.
struct LampTile {
  LampNodes near_air;  // light in the air that varies between its pixels
  LampNodes far_air;   // light in the air that is smooth over it
  LampNodes surface;   // on surfaces
  LampNodes seen;      // lamps in the picture
  /// Of far_air, at (x0 + 4 i, y0 + 4 j); empty without any.
  std::vector<Bands<float>> lattice;
  std::vector<double> lattice_length_m;  // of the rays there; NaN where terrain shades lamps
};

struct LampPlan {
  static constexpr int kTile = 16;    // pixels
  static constexpr int kSpacing = 4;  // pixels
  static constexpr int kLattice = kTile / kSpacing + 1;
  int columns = 0;
  std::vector<LampTile> tiles;

  [[nodiscard]] const LampTile& At(int x, int y) const {
    return tiles[static_cast<std::size_t>(y / kTile) * static_cast<std::size_t>(columns) +
                 static_cast<std::size_t>(x / kTile)];
  }
};

/// A ray from the eye, and where it meets something.
struct LampRayEnd {
  glm::dvec3 direction{0.0};
  double length_m = 0.0;
};

/// Where a ray of the camera ends [m]; infinite in the sky.
using RayTrace = std::function<double(const CameraRay& ray)>;

}  // namespace alpenglow::renderer
