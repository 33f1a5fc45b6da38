// SPDX-License-Identifier: MIT
// Names of track files, which both programs distinguish from camera paths by their extension.
#pragma once

#include <filesystem>

#include "atmosphere/base/parsing.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Returns whether a path is a track for ReadTrack; otherwise it is a file for ReadCameraPath.
[[nodiscard]] inline bool IsTrack(const std::filesystem::path& file) {
  return HasExtension(file, ".gpx") || HasExtension(file, ".kml");
}

}  // namespace alpenglow::renderer
