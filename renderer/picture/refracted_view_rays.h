// SPDX-License-Identifier: MIT
// RefractedViewRays holds the refracted rays of a picture: whether refraction moves anything
// visible, and where refracted rays meet the ground.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <memory>

#include "atmosphere/refraction/refracted_view.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/picture/scene_lighting.h"
#include "renderer/surface/refracted_fan.h"
#include "renderer/surface/scene_geometry.h"

namespace alpenglow::renderer {

class FrameContext;

/// Effect of refraction on the sun, on terrain and on the horizon of a sea without terrain.
struct RefractedViewRays {
  RefractedView view;
  glm::dvec3 up;               // at the eye, unit
  glm::dvec3 to_sun, to_moon;  // unit, without refraction
  bool moves_ground = false;  // moves the farthest terrain or the horizon by more than half a pixel
  std::shared_ptr<const RefractedFan> fan =
      nullptr;  // rays to terrain; null: terrain does not move

  [[nodiscard]] double ElevationOf(const glm::dvec3& direction) const;
  /// Returns the direction, unit, from which light of a band arrives that is seen in `direction`.
  [[nodiscard]] glm::dvec3 TrueDirection(const glm::dvec3& direction, std::size_t band) const;
};

/// Returns the refraction if it moves something in the picture by more than half a pixel; else
/// null.
[[nodiscard]] std::shared_ptr<const RefractedViewRays> RefractedViewRaysOf(
    const FrameContext& frame, const Observer& observer);

/// Returns the hit of a bent ray, for a frame with RefractedViewRays. Terrain appears within 0.1'
/// of the solution of the ray equation.
/// @param expected_m  expected length of the ray; 0: unknown.
[[nodiscard]] Hit OnRefractedRay(const FrameContext& frame, const CameraRay& ray,
                                 double expected_m);

}  // namespace alpenglow::renderer
