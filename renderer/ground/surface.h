// SPDX-License-Identifier: MIT
// What the ground is made of: albedo by slope and altitude in bands, and relief finer than the
// mesh.
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "atmosphere/ray/single_scattering.h"

namespace alpenglow {

/// Where the materials of a mountain give way to one another.
struct MountainCover {
  double tree_line_m = 1900.0;
  double snow_line_m = 2700.0;
};

/// A point of the ground as its material sees it.
struct GroundPoint {
  double east_m, north_m;  // anchored to the planet, so that the pattern does not follow the eye
  double altitude_m;
  double footprint_m;  // width that one ray of the picture covers: finer detail is left out
};

/// Lambertian albedo of mountain ground: forest and meadow below the tree line, rock and scree
/// above it and on steep slopes, snow above the snow line where the slope holds it. Lines and
/// slopes waver by fractal noise from 10 m to 1 km, as on real mountains.
class MountainSurface {
 public:
  /// Albedos of pure materials.
  struct Materials {
    Bands<float> forest, meadow, rock, snow;
  };

  MountainSurface(std::span<const double> wavelengths_nm, const MountainCover& cover);

  [[nodiscard]] const MountainCover& cover() const { return cover_; }
  [[nodiscard]] const Materials& materials() const { return materials_; }

  /// @param normal_up  vertical component of the unit normal, 1 on level ground.
  [[nodiscard]] Bands<float> Albedo(const GroundPoint& point, double normal_up) const;

  /// The normal with the relief that a mesh of 30 to 100 m spacing does not have: unit, tilted by
  /// about 7 degrees rms where the footprint is small, unchanged where it is over 100 m.
  [[nodiscard]] static glm::dvec3 DetailedNormal(const GroundPoint& point,
                                                 const glm::dvec3& normal);

 private:
  MountainCover cover_;
  Materials materials_;
};

/// Tree line and snow line at a latitude and season: the tree line highest in the subtropics and at
/// sea level near the poles, a smooth fit to Korner (1998), Oecologia 115, 445; the snow line 800 m
/// over it in the mean, 1300 m lower in late winter and as much higher in late summer beyond the
/// tropics. +-400 m, for looks.
[[nodiscard]] MountainCover CoverInSeason(double latitude_rad, int modified_julian_day);

}  // namespace alpenglow
