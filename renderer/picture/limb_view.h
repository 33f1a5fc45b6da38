// SPDX-License-Identifier: MIT
// LimbView describes the air at the limb of the planet, seen from above. There the light of the sky
// can change by a factor e within a fraction of a pixel.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "atmosphere/refraction/refraction.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/surface/scene_geometry.h"

namespace alpenglow::renderer {

/// Straight rays past the planet and down to it, from one eye. Immutable.
class LimbView {
 public:
  LimbView(const SceneGeometry& geometry, const Medium& medium, const CameraRays& camera,
           const PixelFilter& filter);

  [[nodiscard]] const glm::dvec3& up() const { return up_; }
  [[nodiscard]] double radius_m() const { return radius_m_; }
  [[nodiscard]] double altitude_m() const { return altitude_m_; }
  /// Returns the air that bends rays.
  [[nodiscard]] const BendingAir& bending_air() const { return bending_air_; }

  /// Returns whether the density of the air at the lowest point ahead changes by more than 15 %
  /// within a pixel. There the light of the sky differs within a pixel, and pixels are sampled;
  /// elsewhere the sky in the middle of a pixel stands for the whole.
  [[nodiscard]] bool IsSteepAt(const glm::dvec3& direction) const;
  /// Returns the cosine between the vertical and a ray where it meets the planet; 0 if it does not.
  /// @param mu  sine of the ray's elevation at the eye.
  [[nodiscard]] double GroundCosine(double mu) const;
  [[nodiscard]] double GroundCosine(const glm::dvec3& direction) const {
    return GroundCosine(glm::dot(direction, up_));
  }

 private:
  glm::dvec3 up_;
  BendingAir bending_air_;
  double radius_m_, altitude_m_, top_m_;
  double pixel_rad_, filter_rad_;  // width of a pixel; radius of its filter
  double molecules_m_, haze_m_;    // scale heights
  double hazy_below_m_;            // altitude below which haze matters
};

}  // namespace alpenglow::renderer
