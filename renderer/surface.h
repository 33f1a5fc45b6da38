// SPDX-License-Identifier: MIT
// What the ground is made of: albedo by slope and altitude, in bands.
#pragma once

#include <span>
#include <vector>

#include "atmosphere/single_scattering.h"

namespace alpenglow {

/// Where the materials of a mountain give way to one another.
struct MountainCover {
  double tree_line_m = 1900.0;
  double snow_line_m = 2700.0;
};

/// Lambertian albedo of mountain ground: forest and meadow below the tree line, rock and scree
/// above it and on steep slopes, snow above the snow line where the slope holds it.
class MountainSurface {
 public:
  MountainSurface(std::span<const double> wavelengths_nm, const MountainCover& cover);

  /// @param normal_up  vertical component of the unit normal, 1 on level ground.
  [[nodiscard]] Bands<float> Albedo(double altitude_m, double normal_up) const;

 private:
  MountainCover cover_;
  Bands<float> forest_, meadow_, rock_, snow_;
};

/// Tree and snow line at a latitude: highest in the subtropics, at sea level near the poles. A
/// smooth fit to Korner (1998), Oecologia 115, 445 (tree line) and to the mean snow line of
/// mountains; +-400 m.
[[nodiscard]] MountainCover CoverAtLatitude(double latitude_rad);

}  // namespace alpenglow
