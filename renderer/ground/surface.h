// SPDX-License-Identifier: MIT
// What the ground is made of: albedo by slope and altitude in bands, and relief finer than the
// mesh.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "atmosphere/ray/single_scattering.h"
#include "renderer/ground/mountain_cover.h"

namespace alpenglow {

/// A point of the ground as its material sees it.
struct GroundPoint {
  double east_m, north_m;  // anchored to the planet, so that the pattern does not follow the eye
  double altitude_m;
  double footprint_m;             // what one ray of the picture covers: finer detail is left out
  double across_m = footprint_m;  // its width across the ray
  double cosine = 1.0;            // of the ray and the normal of the mesh
};

/// Water at a point: the slopes of the waves that a footprint resolves, and what is left.
struct WavySurface {
  double slope_east = 0.0, slope_north = 0.0;
  double slope_variance;  // of the waves that are not resolved

  [[nodiscard]] glm::dvec3 Normal(const glm::dvec3& up) const;
};

/// @param slope_variance  of all waves.
[[nodiscard]] WavySurface WavesAt(const GroundPoint& point, double slope_variance);

/// Lambertian albedo of mountain ground: forest and meadow below the tree line, rock and scree
/// above it and on steep slopes, snow above the snow line where the slope holds it. Lines and
/// slopes waver by fractal noise from 10 m to 1 km, as on real mountains; crowns, tussocks and stones
/// are lighter and darker spots from 12 m down to 5 cm.
class MountainSurface {
 public:
  /// Albedos of pure materials.
  struct Materials {
    Bands<float> forest, meadow, rock, snow;
  };

  /// @param wetness  of rock and meadow, in [0, 1]; leaves of a wood shed water.
  MountainSurface(std::span<const double> wavelengths_nm, const MountainCover& cover,
                  double wetness = 0.0);

  [[nodiscard]] const MountainCover& cover() const { return cover_; }
  [[nodiscard]] const Materials& materials() const { return materials_; }

  /// @param normal_up  vertical component of the unit normal, 1 on level ground.
  /// @param mapped  instead of what altitude and slope make of it; the snow of the season lies on it.
  [[nodiscard]] Bands<float> Albedo(const GroundPoint& point, double normal_up,
                                    const std::optional<MappedCover>& mapped = std::nullopt) const;

  /// The normal with the relief that a mesh of 30 to 100 m spacing does not have: unit, tilted by
  /// about 8 degrees rms where the footprint is small, unchanged where it is over 110 m.
  [[nodiscard]] static glm::dvec3 DetailedNormal(const GroundPoint& point,
                                                 const glm::dvec3& normal);

 private:
  MountainCover cover_;
  Materials materials_;
};

}  // namespace alpenglow
