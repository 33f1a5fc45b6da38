// SPDX-License-Identifier: MIT
// Scenes without terrain: an eye over the bare ellipsoid, as values and as a file.
#pragma once

#include "renderer/scene.h"

namespace alpenglow {

/// Angles of the camera in degrees.
inline Scene BareScene(double height_m, double heading, double pitch, double fov) {
  Scene scene;
  scene.place = PlaceFromDegrees(46.5, 8.0, 0.0);
  scene.camera = CameraFromDegrees({height_m, false}, heading, pitch, 0.0, fov);
  scene.medium = MediumPreset("earth");
  scene.terrain.kind = TerrainSource::Kind::kNone;
  return scene;
}

/// For tests of programs rather than of pictures: three bands, quick to prepare.
inline constexpr const char* kBareSceneText =
    "[place]\nlatitude = 46.5\nlongitude = 8.0\nzone = \"Europe/Zurich\"\n"
    "[time]\nutc = \"2026-06-21T10:00:00Z\"\n[terrain]\nnone = true\n"
    "[atmosphere]\npreset = \"bruneton2017\"\n";

}  // namespace alpenglow
