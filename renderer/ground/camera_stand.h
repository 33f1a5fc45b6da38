// SPDX-License-Identifier: MIT
// Where the camera of a picture stands in the frame of the scene.
#pragma once

#include <span>

#include "renderer/camera/camera_path.h"
#include "renderer/camera/moving_camera.h"
#include "renderer/ground/scene_ground.h"

namespace alpenglow::renderer {

/// The scene's own eye.
[[nodiscard]] CameraStand StandOfScene(const SceneGround& ground);

/// An eye at another place: the frame stays that of the scene. Throws InputError where it is below
/// the ground (of several surfaces: below the lowest), or more than 500 km from the scene's place.
[[nodiscard]] CameraStand StandAt(const SceneGround& ground, const GeodeticPosition& place);

/// Height over the ellipsoid [m] of a scene's ground under a place: the highest of it, and 0 where
/// there is none. Throws InputError more than 500 km from the scene's place.
[[nodiscard]] double GroundHeightUnder(const SceneGround& ground, const GeodeticPosition& place);

/// The scene's camera, or one with its lens that takes these poses one after the other.
[[nodiscard]] MovingCamera CameraOn(const SceneGround& ground, const Camera& camera,
                                    std::span<const CameraPose> poses, int width, int height);

}  // namespace alpenglow::renderer
