// SPDX-License-Identifier: MIT
// Tiles of terrain: their sources (elevation models from files and folders, a mesh, or the built-in
// range), the lattice of all levels of detail, and the heights of one tile at all levels.
//
// The lattice has equal steps of latitude and longitude. Level k has every 2^k-th sample of both
// axes, counted from the north-west corner of the lattice, and always its last row and column, so
// that every level ends at the same rim. A sample is identified by its column and row of level 0, a
// vertex of level k by i and j: column min(i 2^k, last).
//
// A level of a HeightPyramid is the binomial mean (1 2 1) of the next finer level along each axis.
// On the rim of a tile the mean is taken along the rim only, so that two tiles that share samples
// there have equal heights at every level.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/time_place/geodesy.h"
#include "renderer/elevation/elevation.h"
#include "renderer/elevation/mesh.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// A rectangle of samples of level 0, both ends included.
struct LatticeBox {
  int first_column = 0, first_row = 0;
  int last_column = -1, last_row = -1;

  [[nodiscard]] bool Holds(int column, int row) const {
    return column >= first_column && column <= last_column && row >= first_row && row <= last_row;
  }
  [[nodiscard]] bool Touches(const LatticeBox& other) const {
    return first_column <= other.last_column && other.first_column <= last_column &&
           first_row <= other.last_row && other.first_row <= last_row;
  }
};

/// A position between the samples, in columns and rows of level 0.
struct LatticePlace {
  double column = 0.0, row = 0.0;
};

struct LandLattice {
  double west_rad = 0.0, north_rad = 0.0;  // of sample (0, 0)
  double step_lon_rad = 0.0, step_lat_rad = 0.0;
  int last_column = 0, last_row = 0;

  /// Returns whether the columns go once around the earth, so that the last one is the first one
  /// again.
  [[nodiscard]] bool ClosesAroundTheEarth() const {
    return last_column > 0 &&
           std::abs(last_column * step_lon_rad - 2.0 * std::numbers::pi) < 1e-3 * step_lon_rad;
  }
  /// Returns the column from 0 to last_column - 1 on the meridian of a column of a lattice that
  /// closes around the earth.
  [[nodiscard]] double WithinTurn(double column) const {
    return column - last_column * std::floor(column / last_column);
  }

  /// Returns the index of the last vertex of a level.
  [[nodiscard]] int LastVertex(int last_sample, int level) const {
    return (last_sample + (1 << level) - 1) >> level;
  }
  [[nodiscard]] int LastI(int level) const { return LastVertex(last_column, level); }
  [[nodiscard]] int LastJ(int level) const { return LastVertex(last_row, level); }
  /// Returns the column of a vertex. Beyond the rim it is that of the rim, unless the lattice
  /// closes around the earth: columns then go on, and WithinTurn returns the sample at the same
  /// place.
  [[nodiscard]] int ColumnOf(int i, int level) const {
    const int step = 1 << level;
    if (!ClosesAroundTheEarth()) return std::clamp(i * step, 0, last_column);
    const int last_i = LastI(level);
    return i > last_i ? last_column + (i - last_i) * step : std::min(i * step, last_column);
  }
  [[nodiscard]] int RowOf(int j, int level) const {
    return std::clamp(j * (1 << level), 0, last_row);
  }

  /// Returns the position of a sample. Rows beyond a pole are moved to the pole.
  [[nodiscard]] Place PlaceOf(int column, int row, double height_m) const {
    constexpr double kPole = 0.5 * std::numbers::pi;
    return PlaceFromRadians(std::clamp(north_rad - row * step_lat_rad, -kPole, kPole),
                            west_rad + column * step_lon_rad, height_m);
  }

  /// Returns the lattice position of a place. Of the equivalent longitudes (modulo 2 pi), it takes
  /// the one nearest to the middle of the lattice.
  [[nodiscard]] LatticePlace At(double latitude_rad, double longitude_rad) const {
    const double middle = west_rad + 0.5 * last_column * step_lon_rad;
    const double east = std::remainder(longitude_rad - middle, 2.0 * std::numbers::pi);
    return {0.5 * last_column + east / step_lon_rad, RowAt(latitude_rad)};
  }
  /// Returns the row of a latitude. Between a pole and a row beyond it, rows are as PlaceOf moves
  /// them: the pole has that row.
  [[nodiscard]] double RowAt(double latitude_rad) const {
    constexpr double kPole = 0.5 * std::numbers::pi;
    const double row = (north_rad - latitude_rad) / step_lat_rad;
    const double north_pole = (north_rad - kPole) / step_lat_rad;
    const double south_pole = (north_rad + kPole) / step_lat_rad;
    if (north_pole > 0.0 && row < 1.0) return (row - north_pole) / (1.0 - north_pole);
    if (south_pole < last_row && row > last_row - 1.0)
      return last_row - (south_pole - row) / (south_pole - (last_row - 1.0));
    return row;
  }
};

/// The samples of a level along one axis of a box: multiples of 2^level, and the last sample of the
/// box.
struct LevelAxis {
  int first = 0, last = -1, level = 0;

  LevelAxis(int first_sample, int last_sample, int of_level)
      : first(((first_sample + (1 << of_level) - 1) >> of_level) << of_level),
        last(last_sample),
        level(of_level) {}
  [[nodiscard]] int count() const {
    return first > last ? 1 : ((last - first + (1 << level) - 1) >> level) + 1;
  }
  [[nodiscard]] int SampleOf(int index) const { return std::min(first + (index << level), last); }
  /// Returns the index of a sample, which the level must have.
  [[nodiscard]] int IndexOf(int sample) const {
    return sample == last ? count() - 1 : (sample - first) >> level;
  }
};

/// Heights of one tile at all its levels of detail. Immutable. The finest levels may be left out.
/// Files have grids of their own (ElevationGrid); this is one of them, on the lattice that all tiles
/// share, with the levels that a moving eye needs. Heights that are all whole metres take two bytes
/// per sample, others four.
class HeightPyramid {
 public:
  /// @param box       samples of the tile.
  /// @param level     level of the given heights, whose spacing is that of the tile's own samples.
  /// @param height_m  rows from the north, over the LevelAxis of columns and rows.
  HeightPyramid(const LatticeBox& box, int level, std::vector<float> height_m);

  /// Returns a copy without the levels finer than `level`.
  [[nodiscard]] HeightPyramid From(int level) const;

  /// Returns the height [m] at a sample of the box that `level` has. If the pyramid has no level as
  /// fine, the height is interpolated bilinearly. NaN: no height.
  [[nodiscard]] float At(int level, int column, int row) const;

  [[nodiscard]] const LatticeBox& box() const { return box_; }
  /// The finest level that is stored.
  [[nodiscard]] int finest() const { return finest_; }
  [[nodiscard]] std::size_t bytes() const;
  /// Returns the largest size [bytes] of such a pyramid if `level` is its finest level.
  [[nodiscard]] static std::size_t BytesOf(const LatticeBox& box, int level);

 private:
  class Level;

  [[nodiscard]] std::size_t IndexOf(int level, int column, int row) const;
  [[nodiscard]] float Between(int column, int row) const;

  LatticeBox box_;
  int finest_;
  std::vector<std::shared_ptr<const Level>> levels_;  // [0] is level finest_
};

struct LandSource {
  /// Elevation models in the formats of ReadElevation, and folders of such files (.hgt, .tif,
  /// .tiff, .dem; other files in a folder are ignored). If several cover a place, the first one is
  /// used.
  std::vector<std::filesystem::path> files;
  VoidPolicy voids = VoidPolicy::kFill;
  /// Centre of the built-in range, which is used if there are no files. Without either there is no
  /// land.
  std::optional<Place> range_centre;
  std::uint32_t range_seed = 0;
  /// A mesh (ReadMesh) in metres east, north and up of a place on the ellipsoid. It replaces all
  /// other sources.
  struct Mesh {
    std::filesystem::path file;
    Place place;
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
  [[nodiscard]] Place Middle() const {
    return lattice_.PlaceOf(lattice_.last_column / 2, lattice_.last_row / 2, 0.0);
  }
  /// Returns the indices of the tiles that touch a box, in ascending order. If the lattice closes
  /// around the earth, the columns of the box may lie beyond it.
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
