// SPDX-License-Identifier: MIT
// The density of fog over the whole scene: exp(-(h - base) / H) over the sphere, 1 throughout when
// H is infinite; nothing above the top of the atmosphere.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "renderer/scene/local_volume.h"

namespace alpenglow::renderer {

/// Immutable. Directions are unit vectors in the frame of SceneGround, whose sphere has its centre
/// at (0, 0, -R).
class FogLayer {
 public:
  /// @param scale_height_m  > 0; may be infinite.
  /// @param top_m  of the atmosphere over the sphere.
  FogLayer(double base_m, double scale_height_m, double planet_radius_m, double top_m);

  [[nodiscard]] double base_m() const { return base_m_; }
  [[nodiscard]] double scale_height_m() const { return scale_height_m_; }

  [[nodiscard]] double AltitudeOf(const glm::dvec3& point) const;
  [[nodiscard]] double DensityAtAltitude(double altitude_m) const;
  [[nodiscard]] double DensityAt(const glm::dvec3& point) const {
    return DensityAtAltitude(AltitudeOf(point));
  }

  /// The pieces of a line within [0, length_m] where density may be over 1e-9, in order; each
  /// begins or ends where the line is lowest if it goes through there.
  [[nodiscard]] std::vector<DensePiece> PiecesAlong(const glm::dvec3& origin,
                                                    const glm::dvec3& direction,
                                                    double length_m) const;

  /// Integral of the density from an altitude to space [m], vertically.
  [[nodiscard]] double ColumnAbove(double altitude_m) const;
  /// Along a direction that does not meet the planet. Relative error below 1e-6.
  [[nodiscard]] double ColumnToSpace(const glm::dvec3& point, const glm::dvec3& direction) const;

 private:
  double base_m_, scale_height_m_, planet_radius_m_, top_m_;
  double thin_m_;  // altitude over which density is below 1e-9
};

}  // namespace alpenglow::renderer
