// SPDX-License-Identifier: MIT
// Finds the pixels that see only sky without tracing a ray: those well above the skyline, not near
// the sun or the moon, and not at the limb of the planet (LimbView). All rays of such a pixel have
// one sky radiance, that of its middle (shared_samples.h), and so have all rays of its neighbours
// that count for it. One ray through the middle gives the same result as many.
#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "renderer/picture/skyline.h"

namespace alpenglow::renderer {

class FrameContext;
class PixelShader;

/// Immutable, safe to share between threads. Refers to the frame.
class UnoccludedSkyPixels {
 public:
  /// No pixel counts as open sky where sky can be visible below ground, a lens blurs, the camera
  /// moves, or the scene has spheres.
  explicit UnoccludedSkyPixels(const PixelShader& shader);

  /// Returns whether all rays that count for a pixel see only sky, without a disk in it.
  [[nodiscard]] bool Has(int x, int y) const;

 private:
  /// Returns the range of azimuths that the picture, with a margin, covers.
  [[nodiscard]] Skyline::Arc ArcAround(const glm::dvec3& up) const;

  const FrameContext& frame_;
  double around_rad_;  // angular radius around the middle of a pixel that contains everything its
                       // rays see
  std::optional<Skyline> skyline_;
};

}  // namespace alpenglow::renderer
