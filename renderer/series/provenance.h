// SPDX-License-Identifier: MIT
// What made a picture, as names and values for its header, and a fingerprint of them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "lut/picture/image.h"
#include "renderer/camera/camera_path.h"
#include "renderer/picture/render.h"
#include "renderer/scene/scene.h"

namespace alpenglow::renderer {

/// Program, air, place, camera, ground and lamps of a scene; numbers
/// are written so that they read back exactly. The content of the
/// terrain's file is hashed: throws InputError when it cannot be read.
[[nodiscard]] Metadata SceneMetadata(const Scene& scene);

/// Place, height and angles of a camera, over those of SceneMetadata.
[[nodiscard]] Metadata PoseMetadata(const CameraPose& pose);

/// SceneMetadata, and the settings that the pixels depend on.
[[nodiscard]] Metadata PictureMetadata(const Scene& scene, const RenderSettings& settings);

/// What a file says of the rays that its picture took.
[[nodiscard]] Metadata NotesOn(const RayCount& rays, const RenderSettings& settings);

/// 16 hexadecimal digits, FNV-1a over names and values: equal for equal metadata.
[[nodiscard]] std::string Fingerprint(const Metadata& metadata);

}  // namespace alpenglow::renderer
