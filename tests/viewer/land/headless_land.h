// SPDX-License-Identifier: MIT
// Scenes over a tile of mountains, for pictures of the graphics card.
#pragma once

#include "renderer/scene/scene.h"
#include "tests/fixtures/sanitized.h"
#include "tests/renderer/terrain/land_files.h"
#include "tests/viewer/shaders/headless.h"

namespace alpenglow::tests {

using namespace viewer;

using HeadlessLand = HeadlessWith<LandFolder>;

/// Writes a tile of mountains of every fourth sample, which is prepared in less time.
/// @param first_column, first_row  the sample of the land in the north-western corner.
inline void WriteCoarseTile(const std::filesystem::path& file, int first_column, int first_row) {
  constexpr int kStride = 4;
  WriteTile(file, first_column, first_row, (kTileSamples - 1) / kStride + 1, kStride);
}

/// Writes a tile of mountains, under the sanitizers a coarse one.
inline void WriteQuickTile(const std::filesystem::path& file, int first_column, int first_row) {
  if (kSanitized) return WriteCoarseTile(file, first_column, first_row);
  WriteTile(file, first_column, first_row);
}

/// A folder with one tile, and a current OpenGL context.
class HeadlessTile : public HeadlessLand {
 protected:
  void SetUp() override {
    HeadlessLand::SetUp();
    WriteQuickTile(folder_ / "land.tif", 0, 0);
  }

  /// In air of three bands, quick to solve.
  [[nodiscard]] Scene SceneOverTile(const Place& place, const Camera& camera) const {
    Scene scene;
    scene.medium = MediumPreset("bruneton2017");
    scene.place = place;
    scene.camera = camera;
    scene.terrain.kind = TerrainSource::Kind::kElevationModel;
    scene.terrain.file = folder_ / "land.tif";
    return scene;
  }
};

}  // namespace alpenglow::tests
