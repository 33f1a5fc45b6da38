// SPDX-License-Identifier: MIT
// Pixels in which nothing but sky is seen, without a ray: those well over the skyline, and not near
// the sun or the moon.
//
// All rays of such a pixel see one sky, that of its middle (shared_rays.h), and so do all rays of its
// neighbours that count for it. One ray through the middle says as much as many.
#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "renderer/ground/skyline.h"

namespace alpenglow::renderer {

struct PictureFrame;
struct SceneState;

/// Immutable, safe to share between threads. Refers to the frame.
class OpenSkyPixels {
 public:
  /// No pixel is of open sky where sky may be seen under ground, a lens blurs, or the camera moves.
  OpenSkyPixels(const SceneState& scene, const PictureFrame& frame);

  /// Returns whether all rays that count for a pixel see the sky, and no disk in it.
  [[nodiscard]] bool Has(int x, int y) const;

 private:
  /// Returns the azimuths of the eye's vertical planes that the picture shows, and that lie around it.
  [[nodiscard]] Skyline::Arc ArcAround(const glm::dvec3& up) const;

  const PictureFrame& frame_;
  double around_rad_;  // of the middle of a pixel: what its rays see lies within that
  std::optional<Skyline> skyline_;
};

}  // namespace alpenglow::renderer
