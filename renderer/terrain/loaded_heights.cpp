// SPDX-License-Identifier: MIT
#include "renderer/terrain/loaded_heights.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "atmosphere/base/error.h"
#include "renderer/elevation/mesh.h"

namespace alpenglow::renderer {
namespace {

constexpr double kWholeTurn = 2.0 * std::numbers::pi;
constexpr double kOnLattice = 1e-2;  // samples

/// A range on one axis, in samples of the lattice.
struct Range {
  double first, last, step;
};

Range ColumnsOf(const LandLattice& lattice, const ElevationGrid& grid, double near_rad) {
  const double west = std::remainder(grid.west_rad - near_rad, kWholeTurn) + near_rad;
  const double first = (west - lattice.west_rad) / lattice.step_lon_rad;
  const double step = grid.step_lon_rad / lattice.step_lon_rad;
  return {first, first + (grid.columns - 1) * step, step};
}

Range RowsOf(const LandLattice& lattice, const ElevationGrid& grid) {
  const double first = (lattice.north_rad - grid.north_rad) / lattice.step_lat_rad;
  const double step = grid.step_lat_rad / lattice.step_lat_rad;
  return {first, first + (grid.rows - 1) * step, step};
}

// Returns whether two ranges come within one step of each other.
bool AreNear(const Range& a, const Range& b) {
  const double step = std::max(a.step, b.step) + kOnLattice;
  return a.first <= b.last + step && b.first <= a.last + step;
}

// Returns whether the lattice has a sample between two ranges that are at most one step apart.
bool HasGap(const Range& before, const Range& after, double step) {
  const double gap = after.first - before.last;
  return gap <= step + kOnLattice &&
         std::floor(before.last + kOnLattice) + 1.0 < after.first - kOnLattice;
}

}  // namespace

TilePads PadsOf(const LandLattice& lattice, const std::vector<ElevationGrid>& extents,
                std::size_t index) {
  const ElevationGrid& own = extents[index];
  const Range columns = ColumnsOf(lattice, own, own.west_rad), rows = RowsOf(lattice, own);
  TilePads pads;
  for (std::size_t i = 0; i < extents.size(); ++i) {
    if (i == index) continue;
    const Range across = ColumnsOf(lattice, extents[i], own.west_rad);
    const Range down = RowsOf(lattice, extents[i]);
    if (!AreNear(columns, across) || !AreNear(rows, down)) continue;
    pads.east = pads.east || HasGap(columns, across, columns.step);
    pads.west = pads.west || HasGap(across, columns, columns.step);
    pads.south = pads.south || HasGap(rows, down, rows.step);
    pads.north = pads.north || HasGap(down, rows, rows.step);
  }
  return pads;
}

ElevationGrid PaddedExtent(const ElevationGrid& grid, const TilePads& pads) {
  ElevationGrid padded;
  padded.step_lon_rad = grid.step_lon_rad;
  padded.step_lat_rad = grid.step_lat_rad;
  padded.west_rad = grid.west_rad - (pads.west ? grid.step_lon_rad : 0.0);
  padded.north_rad = grid.north_rad + (pads.north ? grid.step_lat_rad : 0.0);
  padded.columns = grid.columns + (pads.west ? 1 : 0) + (pads.east ? 1 : 0);
  padded.rows = grid.rows + (pads.north ? 1 : 0) + (pads.south ? 1 : 0);
  return padded;
}

namespace {

/// A position in rows and columns of a grid.
struct TilePlace {
  double row, column;
};

TilePlace TilePlaceIn(const ElevationGrid& grid, double latitude_rad, double longitude_rad) {
  const double middle = grid.west_rad + 0.5 * (grid.columns - 1) * grid.step_lon_rad;
  return {(grid.north_rad - latitude_rad) / grid.step_lat_rad,
          0.5 * (grid.columns - 1) +
              std::remainder(longitude_rad - middle, kWholeTurn) / grid.step_lon_rad};
}

// Returns whether a tile covers a place. Samples represent cells, so a tile extends half a step
// beyond its outermost samples.
bool Has(const ElevationGrid& grid, const TilePlace& at) {
  constexpr double kBeyond = 0.5 + kOnLattice;
  return at.row >= -kBeyond && at.column >= -kBeyond && at.row <= grid.rows - 1 + kBeyond &&
         at.column <= grid.columns - 1 + kBeyond;
}

/// The samples of other tiles around the pads of one tile.
class Rims {
 public:
  Rims(const LandTiles& tiles, int tile, const ElevationGrid& padded) {
    for (int other = 0; other < static_cast<int>(tiles.tiles().size()); ++other) {
      if (other != tile) Add(tiles, other, padded);
    }
  }

  /// Returns the height from another tile; empty if no tile has one.
  [[nodiscard]] std::optional<double> At(double latitude_rad, double longitude_rad) const {
    for (const Rim& rim : rims_) {
      const TilePlace at = TilePlaceIn(rim.extent, latitude_rad, longitude_rad);
      if (!Has(rim.extent, at)) continue;
      const double row = std::clamp(at.row, 0.0, rim.extent.rows - 1.0);
      const double column = std::clamp(at.column, 0.0, rim.extent.columns - 1.0);
      const std::optional<double> height =
          rim.heights.HeightAt(rim.extent.north_rad - row * rim.extent.step_lat_rad,
                               rim.extent.west_rad + column * rim.extent.step_lon_rad);
      if (height) return height;
    }
    return std::nullopt;
  }

 private:
  struct Rim {
    ElevationGrid extent;
    ElevationGrid heights;  // of the required part only
  };

  // Adds the part of the other grid that overlaps the padded one, with a margin of one or two
  // samples.
  void Add(const LandTiles& tiles, int other, const ElevationGrid& padded) {
    const ElevationGrid& extent = tiles.ExtentOf(other);
    const TilePlace first = TilePlaceIn(extent, padded.north_rad, padded.west_rad);
    const double last_row =
        first.row + (padded.rows - 1) * padded.step_lat_rad / extent.step_lat_rad;
    const double last_column =
        first.column + (padded.columns - 1) * padded.step_lon_rad / extent.step_lon_rad;
    const GridWindow window = Shared(first, {last_row, last_column}, extent);
    if (window.columns < 2 || window.rows < 2) return;
    std::optional<ElevationGrid> heights =
        Read(tiles.tiles()[static_cast<std::size_t>(other)], window, tiles.source().voids);
    if (heights) rims_.push_back({extent, std::move(*heights)});
  }

  struct Span {
    int first = 0, count = 0;
  };
  // Returns the samples of an axis around a range of positions; none if the axis does not reach it.
  static Span Between(double from, double to, int count) {
    if (to < -1.0 || from > count) return {};
    const double first = std::clamp(std::floor(from) - 1.0, 0.0, count - 2.0);
    const double last = std::clamp(std::ceil(to) + 1.0, first + 1.0, count - 1.0);
    return {static_cast<int>(first), static_cast<int>(last - first) + 1};
  }
  static GridWindow Shared(const TilePlace& first, const TilePlace& last,
                           const ElevationGrid& extent) {
    const Span columns = Between(first.column, last.column, extent.columns);
    const Span rows = Between(first.row, last.row, extent.rows);
    return {columns.first, rows.first, columns.count, rows.count};
  }

  static std::optional<ElevationGrid> Read(const LandTile& tile, GridWindow window,
                                           VoidPolicy voids) {
    if (tile.part) {
      window.first_column += tile.part->first_column;
      window.first_row += tile.part->first_row;
    }
    try {
      if (tile.file.empty() || !CanBeCut(tile.file)) return std::nullopt;
      return ReadElevation(tile.file, voids, window).grid;
    } catch (const InputError&) {
      return std::nullopt;  // reported when that tile itself is read
    }
  }

  std::vector<Rim> rims_;
};

}  // namespace

ElevationGrid WithPads(const LandTiles& tiles, int tile, const ElevationGrid& grid) {
  const TilePads& pads = tiles.tiles()[static_cast<std::size_t>(tile)].pads;
  ElevationGrid padded = PaddedExtent(grid, pads);
  const Rims rims(tiles, tile, padded);
  const int first_row = pads.north ? -1 : 0, first_column = pads.west ? -1 : 0;
  for (int row = first_row; row < first_row + padded.rows; ++row) {
    for (int column = first_column; column < first_column + padded.columns; ++column) {
      const int own_row = std::clamp(row, 0, grid.rows - 1);
      const int own_column = std::clamp(column, 0, grid.columns - 1);
      float height = grid.at(own_row, own_column);
      if (row != own_row || column != own_column) {
        const auto other = rims.At(grid.LatitudeOfRow(row), grid.LongitudeOfColumn(column));
        height = other ? static_cast<float>(*other) : height;
      }
      padded.height_m.push_back(height);
    }
  }
  return padded;
}

namespace {

constexpr float kNoHeight = std::numeric_limits<float>::quiet_NaN();

}  // namespace

SampleSize SampleSizeAt(const LandLattice& lattice, double latitude_rad) {
  const double within = std::clamp(
      latitude_rad, lattice.north_rad - lattice.last_row * lattice.step_lat_rad, lattice.north_rad);
  const double e2 = kWgs84.flattening * (2.0 - kWgs84.flattening);
  const double sine = std::sin(within);
  const double w2 = 1.0 - e2 * sine * sine;
  const double across = kWgs84.equatorial_radius_m / std::sqrt(w2);
  // At a pole the step of a column vanishes. This lower bound keeps columns distinguishable.
  const double cosine = std::max(std::cos(within), 0.01);
  return {lattice.step_lon_rad * across * cosine, lattice.step_lat_rad * across * (1.0 - e2) / w2};
}

HeightBlock LoadedHeights::Block(int level, int first_i, int first_j, int columns, int rows) const {
  const LandLattice& lattice = tiles_->lattice();
  HeightBlock block{first_i, first_j, columns, rows, {}};
  block.height_m.reserve(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  const LatticeBox box{lattice.ColumnOf(first_i, level), lattice.RowOf(first_j, level),
                       lattice.ColumnOf(first_i + columns - 1, level),
                       lattice.RowOf(first_j + rows - 1, level)};
  std::vector<const HeightPyramid*> near;
  for (const int tile : tiles_->Touching(box))
    if (heights_[static_cast<std::size_t>(tile)])
      near.push_back(heights_[static_cast<std::size_t>(tile)].get());
  for (int j = first_j; j < first_j + rows; ++j) {
    const int row = lattice.RowOf(j, level);
    for (int i = first_i; i < first_i + columns; ++i) {
      const int column = lattice.ColumnOf(i, level);
      float height = kNoHeight;
      for (const HeightPyramid* pyramid : near) {
        if (!std::isnan(height)) break;
        if (pyramid->box().Holds(column, row)) height = pyramid->At(level, column, row);
      }
      block.height_m.push_back(height);
    }
  }
  return block;
}

std::optional<double> LoadedHeights::HeightUnder(double latitude_rad, double longitude_rad) const {
  const LandLattice& lattice = tiles_->lattice();
  const LatticePlace at = lattice.At(latitude_rad, longitude_rad);
  constexpr double kRounding = 1e-6;  // samples; the rim itself is land
  if (!(at.column >= -kRounding && at.column <= lattice.last_column + kRounding &&
        at.row >= -kRounding && at.row <= lattice.last_row + kRounding))
    return std::nullopt;
  if (tiles_->tiles().empty()) return std::nullopt;
  const int i = std::clamp(static_cast<int>(at.column), 0, lattice.last_column - 1);
  const int j = std::clamp(static_cast<int>(at.row), 0, lattice.last_row - 1);
  const HeightBlock block = Block(0, i - 1, j - 1, 4, 4);
  CellHeights around{};
  std::copy(block.height_m.begin(), block.height_m.end(), around.begin());
  return HeightOnTriangles(around, std::clamp(at.column - i, 0.0, 1.0),
                           std::clamp(at.row - j, 0.0, 1.0));
}

namespace {

/// Vertices of one level of a lattice, both ends included.
struct VertexSpan {
  int level, first_i, first_j, last_i, last_j;
};

// Returns the vertices within half_width_m of a place, at the finest level that has no more than
// most_samples per side; empty if the lattice has fewer than two there.
std::optional<VertexSpan> SpanAround(const LandLattice& lattice, const GeodeticPosition& place,
                                     double half_width_m, int most_samples) {
  const SampleSize size = SampleSizeAt(lattice, place.latitude_rad);
  const LatticePlace at = lattice.At(place.latitude_rad, place.longitude_rad);
  const double half_columns = half_width_m / size.column_m, half_rows = half_width_m / size.row_m;
  // The window is limited to the lattice.
  const auto within = [](double middle, double half, int last_sample) {
    return std::min(middle + half, static_cast<double>(last_sample)) - std::max(middle - half, 0.0);
  };
  const double most = std::max(within(at.column, half_columns, lattice.last_column),
                               within(at.row, half_rows, lattice.last_row));
  int level = 0;
  while (most / (1 << level) + 1.0 > most_samples) ++level;
  const double step = 1 << level;
  const auto first = [&](double from) {
    return std::max(static_cast<int>(std::ceil(from / step)), 0);
  };
  const auto last = [&](double to, int last_sample) {
    return std::min(static_cast<int>(std::floor(to / step)), last_sample >> level);
  };
  const int i0 = first(at.column - half_columns), j0 = first(at.row - half_rows);
  const int i1 = last(at.column + half_columns, lattice.last_column);
  const int j1 = last(at.row + half_rows, lattice.last_row);
  if (i1 <= i0 || j1 <= j0) return std::nullopt;
  if (std::max(lattice.last_column, lattice.last_row) < most_samples)
    return VertexSpan{level, 0, 0, lattice.last_column, lattice.last_row};
  return VertexSpan{level, i0, j0, i1, j1};
}

}  // namespace

std::optional<ElevationGrid> LoadedHeights::SampledGrid(const GeodeticPosition& place,
                                                        double half_width_m,
                                                        int most_samples) const {
  if (tiles_->tiles().empty()) return std::nullopt;
  const LandLattice& lattice = tiles_->lattice();
  const std::optional<VertexSpan> span = SpanAround(lattice, place, half_width_m, most_samples);
  if (!span) return std::nullopt;
  const auto [level, i0, j0, i1, j1] = *span;
  const double step = 1 << level;
  const GeodeticPosition corner = lattice.PlaceOf(i0 << level, j0 << level, 0.0);
  ElevationGrid grid;
  grid.west_rad = corner.longitude_rad;
  grid.north_rad = corner.latitude_rad;
  grid.step_lon_rad = step * lattice.step_lon_rad;
  grid.step_lat_rad = step * lattice.step_lat_rad;
  grid.columns = i1 - i0 + 1;
  grid.rows = j1 - j0 + 1;
  grid.height_m = Block(level, i0, j0, grid.columns, grid.rows).height_m;
  return grid;
}

std::optional<ElevationGrid> ReadHeightsAround(const std::shared_ptr<const LandTiles>& tiles,
                                               const GeodeticPosition& place, double half_width_m,
                                               int most_samples, std::vector<std::string>& notes) {
  if (tiles->tiles().empty()) return std::nullopt;
  const LandLattice& lattice = tiles->lattice();
  const std::optional<VertexSpan> span = SpanAround(lattice, place, half_width_m, most_samples);
  if (!span) return std::nullopt;
  const int level = span->level;
  std::vector<std::shared_ptr<const HeightPyramid>> heights(tiles->tiles().size());
  for (const int tile : tiles->Touching(
           {lattice.ColumnOf(span->first_i, level), lattice.RowOf(span->first_j, level),
            lattice.ColumnOf(span->last_i, level), lattice.RowOf(span->last_j, level)})) {
    const auto index = static_cast<std::size_t>(tile);
    try {
      ReadTile read = ReadLandTile(*tiles, tile, level);
      heights[index] = std::move(read.heights);
      if (!read.note.empty()) notes.push_back(std::move(read.note));
    } catch (const InputError& error) {
      if (!tiles->tiles()[index].is_from_folder) throw;
      notes.push_back(fmt::format("left out: {}", error.what()));
    }
  }
  return LoadedHeights(tiles, std::move(heights)).SampledGrid(place, half_width_m, most_samples);
}

}  // namespace alpenglow::renderer
