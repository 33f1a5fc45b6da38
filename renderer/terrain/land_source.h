// SPDX-License-Identifier: MIT
// Sources of terrain: elevation models from files and folders, a mesh, or the built-in range.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "renderer/elevation/elevation.h"
#include "renderer/elevation/mesh.h"
#include "renderer/terrain/height_pyramid.h"

namespace alpenglow::renderer {

struct LandSource {
  /// Elevation models in the formats of ReadElevation, and folders of such files (.hgt, .tif,
  /// .tiff, .dem; other files in a folder are ignored). If several cover a place, the first one is
  /// used.
  std::vector<std::filesystem::path> files;
  VoidPolicy voids = VoidPolicy::kFill;
  /// Centre of the built-in range, which is used if there are no files. Without either there is no
  /// land.
  std::optional<GeodeticPosition> range_centre;
  std::uint32_t range_seed = 0;
  /// A mesh (ReadObj) in metres east, north and up of a place on the ellipsoid. It replaces all
  /// other sources.
  struct Mesh {
    std::filesystem::path file;
    GeodeticPosition place;
    UpAxis up = UpAxis::kZ;
  };
  std::optional<Mesh> mesh = std::nullopt;

  [[nodiscard]] bool IsEmpty() const { return files.empty() && !range_centre && !mesh; }
};

/// Sides on which a tile is extended by one of its own steps, using samples of its neighbours.
/// Padding is needed if the lattice has samples between the last samples of the tile and the first
/// ones of its neighbour.
struct TilePads {
  bool west = false, north = false, east = false, south = false;

  [[nodiscard]] bool Any() const { return west || north || east || south; }
};

/// One file, a part of a large file, or the built-in range (no file).
struct LandTile {
  std::filesystem::path file;
  bool is_from_folder = false;
  std::optional<GridWindow> part;  // window of the file's grid; empty: all of it
  TilePads pads;
  LatticeBox box;  // samples of the lattice that the tile covers
  int level = 0;   // lattice level of the tile's own spacing, rounded to the finer level
};

/// The tiles of a source on a common lattice, which has the samples of the tile with the smallest
/// step of latitude. Tiles whose samples lie off the lattice are interpolated. Two samples at most
/// one step apart are neighbours even if they belong to different tiles: the area between them is
/// land. Files of more than 2^25 samples are cut into tiles if CanBeCut.
class LandTiles {
 public:
  /// Reads headers, not heights. Throws InputError if a file that is named explicitly cannot be
  /// read, or if a folder has no elevation models. Unreadable files in a folder are left out, with
  /// a note.
  explicit LandTiles(const LandSource& source);

  [[nodiscard]] const LandLattice& lattice() const { return lattice_; }
  [[nodiscard]] const std::vector<LandTile>& tiles() const { return tiles_; }
  [[nodiscard]] const LandSource& source() const { return source_; }
  /// Returns the grid of a tile, without heights and pads.
  [[nodiscard]] const ElevationGrid& ExtentOf(int tile) const {
    return extents_[static_cast<std::size_t>(tile)];
  }
  /// Returns the middle of all tiles, at height 0. There must be at least one tile.
  [[nodiscard]] GeodeticPosition Middle() const {
    return lattice_.PlaceOf(lattice_.last_column / 2, lattice_.last_row / 2, 0.0);
  }
  /// Returns the indices of the tiles that touch a box, in ascending order.
  [[nodiscard]] std::vector<int> Touching(const LatticeBox& box) const;
  /// One line per file that was left out.
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
  std::vector<ElevationGrid> extents_;  // one per tile, without heights
  std::vector<std::string> notes_;
};

/// Heights of a tile, and a note about them.
struct ReadTile {
  std::shared_ptr<const HeightPyramid> heights;
  std::string note;  // may be empty
};

/// Reads a whole tile, keeps levels from `level` of the lattice on, and reads the samples of its
/// neighbours that lie on its pads. Throws InputError as ReadElevation does.
[[nodiscard]] ReadTile ReadLandTile(const LandTiles& tiles, int tile, int level);

}  // namespace alpenglow::renderer
