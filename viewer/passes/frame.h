// SPDX-License-Identifier: MIT
// One frame of the viewer: the data that all passes share that draw a view, computed once. It is
// the viewer's counterpart of FrameContext (renderer/picture/frame_context.h).
//
//   view    eye, time and size
//   sky     bodies and lights, as the eye sees them
//   bend    refraction of the rays
//   disks   of sun and moon, in the view
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "renderer/illumination/distant_light.h"
#include "viewer/passes/frame_sky.h"
#include "viewer/passes/painted_view.h"

namespace alpenglow::viewer {

/// A disk in the sky, at its apparent position.
struct SkyDisk {
  LightSource of;
  glm::dvec3 towards;  // unit, in the frame east, north, up of the eye
  double radius_rad;
};

struct Frame {
  PaintedView view;
  std::shared_ptr<const FrameSky> sky;
  std::optional<LandBend> bend;  // empty: it moves nothing visible
  std::vector<SkyDisk> disks;

  [[nodiscard]] const LightsOfSky& lights() const { return sky->lights; }
  /// Returns the light that casts the shadows.
  [[nodiscard]] const DistantLight& key_light() const { return sky->lights.front(); }
};

/// @param sky  of the eye and the time of the view.
[[nodiscard]] Frame FrameOf(const PaintedView& view, std::shared_ptr<const FrameSky> sky,
                            const std::optional<LandBend>& bend);

}  // namespace alpenglow::viewer
