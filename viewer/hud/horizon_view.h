// SPDX-License-Identifier: MIT
// Where directions lie in the picture, so that instruments lie over what they speak of: by the
// camera of the renderer.
#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "renderer/camera/camera_rays.h"
#include "viewer/hud/hud_model.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

class HorizonView {
 public:
  /// @param width, height  of the picture [pixels], >= 1.
  HorizonView(const HudFlight& flight, int width, int height);

  /// Pixels from the upper left corner; nothing for what lies behind the eye or more than four
  /// widths of the picture away from its middle.
  [[nodiscard]] std::optional<glm::dvec2> PixelOf(const HudDirection& direction) const;
  /// Pixels per radian in the middle of the picture.
  [[nodiscard]] double PixelsPerRadian() const { return 1.0 / rays_.PixelAngle(); }

 private:
  CameraRays rays_;
  glm::dvec2 middle_;
};

}  // namespace alpenglow::viewer
