// SPDX-License-Identifier: MIT
// Where the land comes from: elevation models by file and folder, or the built-in range.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "renderer/scene/scene.h"
#include "renderer/terrain/elevation.h"
#include "viewer/land/height_pyramid.h"

namespace alpenglow::viewer {

struct LandSource {
  /// Elevation models as ReadElevation reads them, and folders of such (.hgt, .tif, .tiff, .dem;
  /// other files there are passed over). The first that has a place counts.
  std::vector<std::filesystem::path> files;
  VoidPolicy voids = VoidPolicy::kFill;
  /// Without files: the built-in range around this place; without either there is no land.
  std::optional<GeodeticPosition> range_centre;
  std::uint32_t range_seed = 0;
  /// Instead of all that: a mesh (ReadObj) in metres east, north and up of a place on the
  /// ellipsoid.
  struct Mesh {
    std::filesystem::path file;
    GeodeticPosition place;
    UpAxis up = UpAxis::kZ;
  };
  std::optional<Mesh> mesh = std::nullopt;

  [[nodiscard]] bool IsEmpty() const { return files.empty() && !range_centre && !mesh; }
};

/// The land of a scene: its elevation model, its mesh or the built-in range.
[[nodiscard]] LandSource LandSourceOf(const Scene& scene);

/// Sides on which a tile goes on by one of its own steps, to the samples of its neighbours: there
/// the lattice has samples between the last ones of the tile and the first ones of its neighbour.
struct TilePads {
  bool west = false, north = false, east = false, south = false;

  [[nodiscard]] bool Any() const { return west || north || east || south; }
};

/// One file, a part of a large one, or the built-in range (no file).
struct LandTile {
  std::filesystem::path file;
  bool is_from_folder = false;
  std::optional<GridWindow> part;  // of the file's grid; nothing: all of it
  TilePads pads;
  LatticeBox box;  // of the samples that it has on the lattice
  int level = 0;   // of the lattice that comes nearest to its own spacing, from the fine side
};

/// The tiles of a source on a common lattice: the samples of the tile with the narrowest rows.
/// Tiles whose samples lie elsewhere are read between their samples. Two samples at most one step
/// apart are neighbours, whatever tiles they are of: what lies between them is land. Files of more
/// than 2^25 samples are cut into tiles if CanBeCut.
class LandTiles {
 public:
  /// Reads headers, no heights. Throws InputError for a file that is named and cannot be read, and
  /// for a folder without models; what cannot be read in a folder is left out and noted.
  explicit LandTiles(const LandSource& source);

  [[nodiscard]] const LandLattice& lattice() const { return lattice_; }
  [[nodiscard]] const std::vector<LandTile>& tiles() const { return tiles_; }
  [[nodiscard]] const LandSource& source() const { return source_; }
  /// The grid of a tile, without heights and pads.
  [[nodiscard]] const ElevationGrid& ExtentOf(int tile) const {
    return extents_[static_cast<std::size_t>(tile)];
  }
  /// Of all tiles, at height 0. There is at least one.
  [[nodiscard]] GeodeticPosition Middle() const {
    return lattice_.PlaceOf(lattice_.last_column / 2, lattice_.last_row / 2, 0.0);
  }
  /// Indices of tiles that touch a box, in their order.
  [[nodiscard]] std::vector<int> Touching(const LatticeBox& box) const;
  /// One line each about what was left out.
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

 private:
  void AddFile(const std::filesystem::path& file, bool is_from_folder);
  void AddFolder(const std::filesystem::path& folder);
  void AddParts(const LandTile& tile, const ElevationGrid& grid);
  void LayLattice();
  void PlaceTile(std::size_t index);

  LandSource source_;
  LandLattice lattice_;
  std::vector<LandTile> tiles_;
  std::vector<ElevationGrid> extents_;  // one a tile, without heights
  std::vector<std::string> notes_;
};

/// Heights of a tile, and what there is to say about them.
struct ReadTile {
  std::shared_ptr<const HeightPyramid> heights;
  std::string note;  // empty: nothing
};

/// Reads a tile whole, from `level` of the lattice on, and of its neighbours the samples that lie on
/// its pads. Throws InputError as ReadElevation does.
[[nodiscard]] ReadTile ReadLandTile(const LandTiles& tiles, int tile, int level);

}  // namespace alpenglow::viewer
