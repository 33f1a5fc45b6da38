// SPDX-License-Identifier: MIT
// The light of a scene seen by an observer: sun, moon and night sky, and their illuminance.
#pragma once

#include <glm/vec3.hpp>

#include "atmosphere/astronomy/sky_bodies.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/illumination/lighting.h"
#include "renderer/picture/prepared_scene.h"
#include "renderer/surface/scene_ground.h"

namespace alpenglow::renderer {

/// The eye of a picture, and sun and moon at its instant.
struct Observer {
  FrameTransform from_eye;  // to the frame of the scene
  SkyBodies bodies;         // from the place of the eye
};

/// Returns the observer of the middle pose, or the scene's own. Takes sun and moon from the shot if
/// it has them. Throws InputError as FromEyeAt does.
[[nodiscard]] Observer ObserverOf(const PreparedScene& scene, const CameraSample& camera_sample);

/// Returns the light of sun, moon and night sky, each if it may be visible, in the scene's frame.
[[nodiscard]] Lighting LightingAt(const PreparedScene& scene, const Observer& observer);

/// Returns the illuminance of one light and its sky on a level plane at a point, without terrain
/// [lux].
[[nodiscard]] double IlluminanceBy(const PreparedScene& scene, const DistantLight& source,
                                   const glm::dvec3& eye, const Lighting& light);
/// Returns the illuminance of all distant lights and the sky on a level plane at a point, without
/// terrain [lux].
[[nodiscard]] double Illuminance(const PreparedScene& scene, const glm::dvec3& eye,
                                 const Lighting& light);

}  // namespace alpenglow::renderer
