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

constexpr float kNoHeight = std::numeric_limits<float>::quiet_NaN();

/// The vertices of one level in a part of the lattice.
class LevelHeights {
 public:
  LevelHeights(const LandTiles& tiles,
               const std::vector<std::shared_ptr<const HeightPyramid>>& heights, int level,
               const LatticeBox& box)
      : lattice_(tiles.lattice()), level_(level) {
    for (const int tile : tiles.Touching(box))
      if (heights[static_cast<std::size_t>(tile)])
        near_.push_back(heights[static_cast<std::size_t>(tile)].get());
  }

  /// Returns the height at a vertex.
  [[nodiscard]] float At(int column, int row) const {
    for (const HeightPyramid* pyramid : near_) {
      if (!pyramid->box().Holds(column, row)) continue;
      const float height = pyramid->At(level_, column, row);
      if (!std::isnan(height)) return height;
    }
    return kNoHeight;
  }
  /// Returns the bilinear height between the vertices. If the lattice closes around the earth, the
  /// column may be any.
  [[nodiscard]] float Between(double column, double row) const {
    const bool closes = lattice_.ClosesAroundTheEarth();
    const Step x = StepAt(closes ? lattice_.WithinTurn(column) : column, lattice_.last_column);
    const Step y = StepAt(row, lattice_.last_row);
    const auto along = [&](int at_row) {
      const float west = At(x.low, at_row);
      return x.share == 0.0F ? west : std::lerp(west, At(x.high, at_row), x.share);
    };
    const float north = along(y.low);
    return y.share == 0.0F ? north : std::lerp(north, along(y.high), y.share);
  }

 private:
  struct Step {
    int low, high;
    float share;
  };
  [[nodiscard]] Step StepAt(double sample, int last) const {
    const double within = std::clamp(sample, 0.0, static_cast<double>(last));
    const int low = std::min((static_cast<int>(within) >> level_) << level_, last);
    const int high = std::min(low + (1 << level_), last);
    const double share = high > low ? (within - low) / (high - low) : 0.0;
    return {low, high, static_cast<float>(share)};
  }

  const LandLattice& lattice_;
  int level_;
  std::vector<const HeightPyramid*> near_;
};

/// Vertices of one level of a lattice, both ends included.
struct VertexSpan {
  int level, first_i, first_j, last_i, last_j;
};

// Returns the vertices within half_width_m of a place, at the finest level that has no more than
// most_samples per side; empty if the lattice has fewer than two there.
std::optional<VertexSpan> SpanAround(const LandLattice& lattice, const Place& place,
                                     double half_width_m, int most_samples) {
  const SampleSize size = SampleSizeAt(lattice, place.latitude_rad());
  const LatticePlace at = lattice.At(place.latitude_rad(), place.longitude_rad());
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

constexpr double kPoleLatitude_rad = 0.5 * std::numbers::pi;

/// A grid without heights, and the level of the lattice whose vertices it interpolates.
struct GridOnLevel {
  ElevationGrid grid;
  int level;
};

/// The rows of a lattice within an angle of a place.
struct RowsAround {
  double north_rad, south_rad;
  bool north_pole, south_pole;  // whether they contain a pole

  RowsAround(const LandLattice& lattice, double latitude_rad, double reach_rad) {
    constexpr double kRounding_rad = 1e-12;
    const double southern = lattice.north_rad - lattice.last_row * lattice.step_lat_rad;
    north_rad = std::min(latitude_rad + reach_rad, lattice.north_rad);
    south_rad = std::max(latitude_rad - reach_rad, southern);
    north_pole = north_rad >= kPoleLatitude_rad - kRounding_rad;
    south_pole = south_rad <= kRounding_rad - kPoleLatitude_rad;
    north_rad = std::min(north_rad, kPoleLatitude_rad);
    south_rad = std::max(south_rad, -kPoleLatitude_rad);
  }
};

// Returns the smallest level at which a number of steps has no more than most_samples vertices.
int LevelFor(double steps, int most_samples) {
  return std::max(static_cast<int>(std::ceil(std::log2(steps / (most_samples - 1.0)))), 0);
}

// Returns the half width in longitude of a circle around a place; pi if it contains a pole.
double HalfTurn(double latitude_rad, double reach_rad) {
  const double sine = std::sin(reach_rad) / std::max(std::cos(latitude_rad), 1e-12);
  return std::abs(latitude_rad) + reach_rad < kPoleLatitude_rad && sine < 1.0
             ? std::asin(sine)
             : 2.0 * kPoleLatitude_rad;
}

// Sets the rows of a grid: multiples of its step from a pole, otherwise from the first row of the
// lattice.
void SetRows(ElevationGrid& grid, const LandLattice& lattice, const RowsAround& rows) {
  const double step = grid.step_lat_rad;
  const double first =
      rows.north_pole ? rows.north_rad
                      : lattice.north_rad -
                            step * std::ceil((lattice.north_rad - rows.north_rad) / step - 1e-6);
  const auto steps = [&](double from) {
    return static_cast<int>(std::floor((from - rows.south_rad) / step + 1e-6));
  };
  const int count = steps(rows.south_pole ? rows.north_rad : first);
  grid.north_rad = rows.south_pole ? rows.south_rad + count * step : first;
  grid.rows = count + 1;
}

// Returns a grid over the part of a lattice around the earth that lies within half_width_m of a
// place, if this part contains a pole of the lattice or crosses its first column; else nullopt.
std::optional<GridOnLevel> GridOverSeam(const LandLattice& lattice, const Place& place,
                                        double half_width_m, int most_samples) {
  if (!lattice.ClosesAroundTheEarth()) return std::nullopt;
  const double reach_rad =
      half_width_m * lattice.step_lat_rad / SampleSizeAt(lattice, place.latitude_rad()).row_m;
  const RowsAround rows(lattice, place.latitude_rad(), reach_rad);
  const double half = HalfTurn(place.latitude_rad(), reach_rad) / lattice.step_lon_rad;
  const double middle = lattice.At(place.latitude_rad(), place.longitude_rad()).column;
  const bool is_whole = 2.0 * half >= lattice.last_column;
  const bool crosses = middle - half < 0.0 || middle + half > lattice.last_column;
  if (!(rows.north_rad > rows.south_rad) || !(is_whole || crosses)) return std::nullopt;
  const double wide = is_whole ? lattice.last_column : 2.0 * half;
  const int row_level =
      LevelFor((rows.north_rad - rows.south_rad) / lattice.step_lat_rad, most_samples);
  const int column_level = LevelFor(wide, most_samples - 1);
  const double step = 1 << column_level;
  const double first = is_whole ? 0.0 : std::floor((middle - half) / step) * step;
  GridOnLevel outline{{}, std::min(row_level, column_level)};
  ElevationGrid& grid = outline.grid;
  grid.step_lat_rad = lattice.step_lat_rad * (1 << row_level);
  SetRows(grid, lattice, rows);
  grid.columns =
      static_cast<int>(is_whole ? std::round(wide / step) : std::ceil(wide / step) + 1.0);
  grid.step_lon_rad =
      is_whole ? 4.0 * kPoleLatitude_rad / grid.columns : step * lattice.step_lon_rad;
  grid.west_rad = lattice.west_rad + first * lattice.step_lon_rad;
  return grid.rows < 2 || grid.columns < 2 ? std::nullopt : std::optional(outline);
}

// Returns the samples of a lattice that contain a grid.
LatticeBox BoxAround(const LandLattice& lattice, const ElevationGrid& grid) {
  const double first = (grid.west_rad - lattice.west_rad) / lattice.step_lon_rad;
  const double wide = grid.columns * grid.step_lon_rad / lattice.step_lon_rad;
  return {static_cast<int>(std::floor(first)), 0, static_cast<int>(std::ceil(first + wide)),
          lattice.last_row};
}

/// The samples that SampledGrid needs, and their level.
struct NeededSamples {
  LatticeBox box;
  int level;
};

std::optional<NeededSamples> SamplesAround(const LandLattice& lattice, const Place& place,
                                           double half_width_m, int most_samples) {
  if (const auto over = GridOverSeam(lattice, place, half_width_m, most_samples))
    return NeededSamples{BoxAround(lattice, over->grid), over->level};
  const std::optional<VertexSpan> span = SpanAround(lattice, place, half_width_m, most_samples);
  if (!span) return std::nullopt;
  const int level = span->level;
  return NeededSamples{{lattice.ColumnOf(span->first_i, level), lattice.RowOf(span->first_j, level),
                        lattice.ColumnOf(span->last_i, level), lattice.RowOf(span->last_j, level)},
                       level};
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
  const LevelHeights heights(
      *tiles_, heights_, level,
      {lattice.ColumnOf(first_i, level), lattice.RowOf(first_j, level),
       lattice.ColumnOf(first_i + columns - 1, level), lattice.RowOf(first_j + rows - 1, level)});
  for (int j = first_j; j < first_j + rows; ++j) {
    const int row = lattice.RowOf(j, level);
    for (int i = first_i; i < first_i + columns; ++i) {
      const int column = lattice.ColumnOf(i, level);
      const bool is_beyond = column < 0 || column > lattice.last_column;
      block.height_m.push_back(is_beyond ? heights.Between(column, row) : heights.At(column, row));
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

std::optional<ElevationGrid> LoadedHeights::SampledGrid(const Place& place, double half_width_m,
                                                        int most_samples) const {
  if (tiles_->tiles().empty()) return std::nullopt;
  const LandLattice& lattice = tiles_->lattice();
  if (const auto over = GridOverSeam(lattice, place, half_width_m, most_samples)) {
    ElevationGrid grid = over->grid;
    const LevelHeights heights(*tiles_, heights_, over->level, BoxAround(lattice, grid));
    grid.height_m.reserve(grid.index(grid.rows, 0));
    for (int row = 0; row < grid.rows; ++row) {
      const double at_row = lattice.RowAt(grid.LatitudeOfRow(row));
      for (int column = 0; column < grid.columns; ++column)
        grid.height_m.push_back(heights.Between(
            (grid.LongitudeOfColumn(column) - lattice.west_rad) / lattice.step_lon_rad, at_row));
    }
    return grid;
  }
  const std::optional<VertexSpan> span = SpanAround(lattice, place, half_width_m, most_samples);
  if (!span) return std::nullopt;
  const auto [level, i0, j0, i1, j1] = *span;
  const double step = 1 << level;
  const Place corner = lattice.PlaceOf(i0 << level, j0 << level, 0.0);
  ElevationGrid grid;
  grid.west_rad = corner.longitude_rad();
  grid.north_rad = corner.latitude_rad();
  grid.step_lon_rad = step * lattice.step_lon_rad;
  grid.step_lat_rad = step * lattice.step_lat_rad;
  grid.columns = i1 - i0 + 1;
  grid.rows = j1 - j0 + 1;
  grid.height_m = Block(level, i0, j0, grid.columns, grid.rows).height_m;
  return grid;
}

std::optional<ElevationGrid> ReadHeightsAround(const std::shared_ptr<const LandTiles>& tiles,
                                               const Place& place, double half_width_m,
                                               int most_samples, std::vector<std::string>& notes) {
  if (tiles->tiles().empty()) return std::nullopt;
  const std::optional<NeededSamples> part =
      SamplesAround(tiles->lattice(), place, half_width_m, most_samples);
  if (!part) return std::nullopt;
  const auto& [box, level] = *part;
  std::vector<std::shared_ptr<const HeightPyramid>> heights(tiles->tiles().size());
  for (const int tile : tiles->Touching(box)) {
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
