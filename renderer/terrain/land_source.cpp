// SPDX-License-Identifier: MIT
#include "renderer/terrain/land_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "renderer/procedural_mountains/procedural_mountains.h"
#include "renderer/terrain/loaded_heights.h"

namespace alpenglow::renderer {
namespace {

bool IsWhole(float height_m) {
  return std::isnan(height_m) || (height_m == std::round(height_m) && std::abs(height_m) < 32000);
}

// Returns the binomial mean if both neighbours exist, otherwise the middle value.
float Binomial(float before, float middle, float after) {
  const float mean = 0.25F * before + 0.5F * middle + 0.25F * after;
  return std::isnan(mean) ? middle : mean;
}

// The samples of a level along one axis, as indices into the next finer level.
struct Means {
  struct Mean {
    std::size_t middle;
    bool has_neighbours;
  };
  std::vector<Mean> of;
  std::size_t finer;  // number of samples of the finer level

  Means(int first_sample, int last_sample, int level)
      : finer(static_cast<std::size_t>(LevelAxis(first_sample, last_sample, level - 1).count())) {
    const LevelAxis axis(first_sample, last_sample, level);
    const LevelAxis from(first_sample, last_sample, level - 1);
    const int step = 1 << (level - 1);
    for (int index = 0; index < axis.count(); ++index) {
      const int sample = axis.SampleOf(index);
      of.push_back({static_cast<std::size_t>(from.IndexOf(sample)),
                    sample % (2 * step) == 0 && sample - step >= from.first &&
                        sample + step <= last_sample});
    }
  }
};

// Averages along the rows, then along the columns. On a rim the mean is taken along it, never
// across it.
std::vector<float> Coarser(const LatticeBox& box, int level, const std::vector<float>& finer) {
  const Means columns(box.first_column, box.last_column, level);
  const Means rows(box.first_row, box.last_row, level);
  const std::size_t width = columns.of.size();
  std::vector<float> narrow(width * rows.finer);
  for (std::size_t row = 0; row < rows.finer; ++row) {
    const float* const from = &finer[row * columns.finer];
    for (std::size_t i = 0; i < width; ++i) {
      const auto [at, both] = columns.of[i];
      narrow[row * width + i] = both ? Binomial(from[at - 1], from[at], from[at + 1]) : from[at];
    }
  }
  std::vector<float> means(width * rows.of.size());
  for (std::size_t j = 0; j < rows.of.size(); ++j) {
    const auto [row, both] = rows.of[j];
    const float* const at = &narrow[row * width];
    for (std::size_t i = 0; i < width; ++i)
      means[j * width + i] = both ? Binomial(*(at + i - width), at[i], at[i + width]) : at[i];
  }
  return means;
}

constexpr double kPole = 0.5 * std::numbers::pi;

// Returns the mean height of a row.
float MeanOfRow(const ElevationGrid& grid, int row) {
  double sum = 0.0;
  for (int column = 0; column < grid.columns; ++column)
    sum += static_cast<double>(grid.at(row, column));
  return static_cast<float>(sum / grid.columns);
}

// Closes a grid that spans all longitudes: repeats its first column at the end and adds a row at a
// pole that its rim surrounds. If the grid has heights, they are extended as well.
ElevationGrid Closed(ElevationGrid grid) {
  if (!grid.ClosesAroundTheEarth()) return grid;
  const auto reaches = [&](int row, double pole) {
    const double gap = std::abs(pole - grid.LatitudeOfRow(row));
    return gap < 1.001 * grid.step_lat_rad && gap > 1e-12;
  };
  const bool north = reaches(0, kPole), south = reaches(grid.rows - 1, -kPole);
  ElevationGrid closed = grid;
  closed.columns = grid.columns + 1;
  closed.rows = grid.rows + (north ? 1 : 0) + (south ? 1 : 0);
  closed.north_rad = grid.north_rad + (north ? grid.step_lat_rad : 0.0);
  closed.height_m.clear();
  if (grid.height_m.empty()) return closed;
  for (int row = north ? -1 : 0; row < grid.rows + (south ? 1 : 0); ++row) {
    const int within = std::clamp(row, 0, grid.rows - 1);
    const float pole_m = MeanOfRow(grid, within);
    for (int column = 0; column < closed.columns; ++column)
      closed.height_m.push_back(row == within ? grid.at(row, column % grid.columns) : pole_m);
  }
  return closed;
}

bool IsModel(const std::filesystem::path& file) {
  const auto extensions = ElevationExtensions();
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](const char* extension) { return HasExtension(file, extension); });
}

// Returns whether the samples of a grid coincide with those of its tile.
bool IsTile(const LandLattice& lattice, const LandTile& tile, const ElevationGrid& grid) {
  const auto like = [](double a, double b) { return std::abs(a - b) < 1e-2; };  // samples
  return tile.level == 0 && tile.box.last_column - tile.box.first_column == grid.columns - 1 &&
         tile.box.last_row - tile.box.first_row == grid.rows - 1 &&
         like((grid.columns - 1) * grid.step_lon_rad / lattice.step_lon_rad, grid.columns - 1) &&
         like((grid.rows - 1) * grid.step_lat_rad / lattice.step_lat_rad, grid.rows - 1) &&
         like((lattice.north_rad - grid.north_rad) / lattice.step_lat_rad, tile.box.first_row) &&
         like(std::remainder(
                  grid.west_rad - lattice.west_rad - tile.box.first_column * lattice.step_lon_rad,
                  2.0 * std::numbers::pi) /
                  lattice.step_lon_rad,
              0.0);
}

// Returns the heights of a grid at the lattice samples of a tile. Samples on the lattice are copied
// without interpolation.
std::vector<float> OnLattice(const LandLattice& lattice, const LandTile& tile, ElevationGrid grid) {
  if (IsTile(lattice, tile, grid)) return std::move(grid.height_m);
  const LevelAxis columns(tile.box.first_column, tile.box.last_column, tile.level);
  const LevelAxis rows(tile.box.first_row, tile.box.last_row, tile.level);
  const double lon_ratio = lattice.step_lon_rad / grid.step_lon_rad;
  const double lat_ratio = lattice.step_lat_rad / grid.step_lat_rad;
  const double west =
      std::remainder(
          lattice.west_rad + tile.box.first_column * lattice.step_lon_rad - grid.west_rad,
          2.0 * std::numbers::pi) /
      grid.step_lon_rad;
  const double north = (grid.north_rad - lattice.north_rad) / grid.step_lat_rad;
  struct Span {
    int low;
    double share;
  };
  // Picks the nearest sample if it is equal up to rounding of the steps, otherwise two to
  // interpolate.
  const auto span = [](double place, int count) {
    const double nearest = std::round(place);
    const double snapped = std::abs(place - nearest) < 1e-2 ? nearest : place;
    // The tile may exceed the grid by the tolerance for samples that count as on the lattice.
    const double inside = std::clamp(snapped, 0.0, count - 1.0);
    const double low = std::floor(inside);
    return Span{static_cast<int>(low), inside - low};
  };
  std::vector<float> heights;
  heights.reserve(static_cast<std::size_t>(columns.count()) *
                  static_cast<std::size_t>(rows.count()));
  for (int j = 0; j < rows.count(); ++j) {
    const Span y = span(north + rows.SampleOf(j) * lat_ratio, grid.rows);
    for (int i = 0; i < columns.count(); ++i) {
      const Span x =
          span(west + (columns.SampleOf(i) - tile.box.first_column) * lon_ratio, grid.columns);
      const auto along = [&](int row) {
        if (x.share == 0.0) return static_cast<double>(grid.at(row, x.low));
        return (1.0 - x.share) * static_cast<double>(grid.at(row, x.low)) +
               x.share * static_cast<double>(grid.at(row, x.low + 1));
      };
      const double height = y.share == 0.0
                                ? along(y.low)
                                : (1.0 - y.share) * along(y.low) + y.share * along(y.low + 1);
      heights.push_back(static_cast<float>(height));
    }
  }
  return heights;
}

}  // namespace

/// The heights [m] of one level; NaN where there is none.
class HeightPyramid::Level {
 public:
  explicit Level(std::vector<float> height_m) {
    if (!std::all_of(height_m.begin(), height_m.end(), IsWhole)) {
      real_m_ = std::move(height_m);
      return;
    }
    whole_m_.reserve(height_m.size());
    for (const float height : height_m)
      whole_m_.push_back(std::isnan(height) ? kNone : static_cast<std::int16_t>(height));
  }

  [[nodiscard]] float at(std::size_t index) const {
    if (whole_m_.empty()) return real_m_[index];
    return whole_m_[index] == kNone ? std::numeric_limits<float>::quiet_NaN()
                                    : static_cast<float>(whole_m_[index]);
  }
  [[nodiscard]] std::size_t bytes() const {
    return sizeof(float) * real_m_.size() + sizeof(std::int16_t) * whole_m_.size();
  }

 private:
  static constexpr std::int16_t kNone = std::numeric_limits<std::int16_t>::min();
  std::vector<float> real_m_;
  std::vector<std::int16_t> whole_m_;
};

HeightPyramid::HeightPyramid(const LatticeBox& box, int level, std::vector<float> height_m)
    : box_(box), finest_(level) {
  const auto samples =
      static_cast<std::size_t>(LevelAxis(box.first_column, box.last_column, level).count() *
                               LevelAxis(box.first_row, box.last_row, level).count());
  ALPENGLOW_ENSURE(height_m.size(), ==, samples);
  const int across = std::max(box.last_column - box.first_column, box.last_row - box.first_row);
  for (int next = level + 1; (1 << next) < 2 * across; ++next) {
    std::vector<float> coarser = Coarser(box, next, height_m);
    levels_.push_back(std::make_shared<const Level>(std::move(height_m)));
    height_m = std::move(coarser);
  }
  levels_.push_back(std::make_shared<const Level>(std::move(height_m)));
}

std::size_t HeightPyramid::IndexOf(int level, int column, int row) const {
  const LevelAxis columns(box_.first_column, box_.last_column, level);
  const LevelAxis rows(box_.first_row, box_.last_row, level);
  return static_cast<std::size_t>(rows.IndexOf(row)) * static_cast<std::size_t>(columns.count()) +
         static_cast<std::size_t>(columns.IndexOf(column));
}

HeightPyramid HeightPyramid::From(int level) const {
  HeightPyramid coarser(*this);
  const int most = finest_ + static_cast<int>(levels_.size()) - 1;
  const int wanted = std::clamp(level, finest_, most);
  coarser.levels_.erase(coarser.levels_.begin(), coarser.levels_.begin() + (wanted - finest_));
  coarser.finest_ = wanted;
  return coarser;
}

// Interpolates bilinearly in the finest level.
float HeightPyramid::Between(int column, int row) const {
  const LevelAxis columns(box_.first_column, box_.last_column, finest_);
  const LevelAxis rows(box_.first_row, box_.last_row, finest_);
  struct Span {
    int low, high;
    float share;
  };
  const auto span = [](const LevelAxis& axis, int sample) {
    const int within = std::max(sample, std::min(axis.first, axis.last));
    const int index = std::clamp((within - axis.first) >> axis.level, 0, axis.count() - 1);
    const int low = axis.SampleOf(index);
    const int high = axis.SampleOf(std::min(index + 1, axis.count() - 1));
    return Span{
        low, high,
        high > low ? static_cast<float>(within - low) / static_cast<float>(high - low) : 0.0F};
  };
  const Span x = span(columns, column), y = span(rows, row);
  const auto along = [&](int at_row) {
    const float west = At(finest_, x.low, at_row);
    if (x.share == 0.0F) return west;
    return (1.0F - x.share) * west + x.share * At(finest_, x.high, at_row);
  };
  const float north = along(y.low);
  return y.share == 0.0F ? north : (1.0F - y.share) * north + y.share * along(y.high);
}

float HeightPyramid::At(int level, int column, int row) const {
  const int coarsest = finest_ + static_cast<int>(levels_.size()) - 1;
  if (level < finest_) return Between(column, row);
  const int from = std::min(level, coarsest);
  return levels_[static_cast<std::size_t>(from - finest_)]->at(IndexOf(from, column, row));
}

std::size_t HeightPyramid::bytes() const {
  std::size_t sum = 0;
  for (const auto& level : levels_) sum += level->bytes();
  return sum;
}

std::size_t HeightPyramid::BytesOf(const LatticeBox& box, int level) {
  const double columns = box.last_column - box.first_column + 1.0;
  const double rows = box.last_row - box.first_row + 1.0;
  return static_cast<std::size_t>(4.0 / 3.0 * sizeof(float) * columns * rows *
                                  std::pow(0.25, level));
}

LandTiles::LandTiles(const LandSource& source) : source_(source) {
  if (source.mesh) return;
  for (const std::filesystem::path& path : source.files) {
    if (std::filesystem::is_directory(path)) {
      AddFolder(path);
    } else {
      AddFile(path, false);
    }
  }
  if (source.files.empty() && source.range_centre) {
    tiles_.emplace_back();
    extents_.push_back(Closed(ProceduralMountainsExtent(*source.range_centre)));
  }
  if (tiles_.empty()) return;
  LayLattice();
  for (std::size_t index = 0; index < tiles_.size(); ++index) {
    tiles_[index].pads = PadsOf(lattice_, extents_, index);
    PlaceTile(index);
  }
  lattice_.last_column = 0;
  lattice_.last_row = 0;
  int first_column = std::numeric_limits<int>::max(), first_row = first_column;
  for (const LandTile& tile : tiles_) {
    first_column = std::min(first_column, tile.box.first_column);
    first_row = std::min(first_row, tile.box.first_row);
  }
  lattice_.west_rad += first_column * lattice_.step_lon_rad;
  lattice_.north_rad -= first_row * lattice_.step_lat_rad;
  for (LandTile& tile : tiles_) {
    tile.box.first_column -= first_column;
    tile.box.last_column -= first_column;
    tile.box.first_row -= first_row;
    tile.box.last_row -= first_row;
    lattice_.last_column = std::max(lattice_.last_column, tile.box.last_column);
    lattice_.last_row = std::max(lattice_.last_row, tile.box.last_row);
  }
}

void LandTiles::AddFile(const std::filesystem::path& file, bool is_from_folder) {
  LandTile tile;
  tile.file = file;
  tile.is_from_folder = is_from_folder;
  const ElevationGrid grid = ReadElevationExtent(file);
  constexpr double kManySamples = 1 << 25;
  const bool is_large = static_cast<double>(grid.columns) * grid.rows > kManySamples;
  if (is_large && CanBeCut(file)) {
    AddParts(tile, grid);
    return;
  }
  extents_.push_back(Closed(grid));
  tiles_.push_back(tile);
}

// Adds the parts of a large file. Neighbouring parts share the samples of their rims. In a grid
// that spans all longitudes, the last part ends on the first column.
void LandTiles::AddParts(const LandTile& tile, const ElevationGrid& grid) {
  constexpr int kSteps = 4096;  // per side
  const int last_column = grid.ClosesAroundTheEarth() ? grid.columns : grid.columns - 1;
  for (int row = 0; row < grid.rows - 1; row += kSteps) {
    for (int column = 0; column < last_column; column += kSteps) {
      LandTile part = tile;
      part.part = GridWindow{column, row, std::min(kSteps, last_column - column) + 1,
                             std::min(kSteps, grid.rows - 1 - row) + 1};
      ElevationGrid extent = grid;
      extent.west_rad = grid.LongitudeOfColumn(column);
      extent.north_rad = grid.LatitudeOfRow(row);
      extent.columns = part.part->columns;
      extent.rows = part.part->rows;
      extents_.push_back(std::move(extent));
      tiles_.push_back(std::move(part));
    }
  }
}

void LandTiles::AddFolder(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (IsModel(entry.path())) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  const std::size_t before = tiles_.size();
  for (const std::filesystem::path& file : files) {
    try {
      AddFile(file, true);
    } catch (const InputError& error) {
      notes_.push_back(fmt::format("left out: {}", error.what()));
    }
  }
  if (tiles_.size() > before) return;
  if (!files.empty()) {
    throw InputError(fmt::format("{}: no elevation model in this folder can be read; {}",
                                 folder.string(), notes_.back()));
  }
  throw InputError(fmt::format("{}: no elevation model ({}) in this folder", folder.string(),
                               fmt::join(ElevationExtensions(), ", ")));
}

void LandTiles::LayLattice() {
  const auto finest = std::min_element(
      extents_.begin(), extents_.end(), [](const ElevationGrid& a, const ElevationGrid& b) {
        // Steps that differ only by rounding count as equal.
        if (std::abs(a.step_lat_rad - b.step_lat_rad) > 1e-6 * a.step_lat_rad)
          return a.step_lat_rad < b.step_lat_rad;
        return a.step_lon_rad < (1.0 - 1e-6) * b.step_lon_rad;
      });
  lattice_.west_rad = finest->west_rad;
  lattice_.north_rad = finest->north_rad;
  lattice_.step_lon_rad = finest->step_lon_rad;
  lattice_.step_lat_rad = finest->step_lat_rad;
}

void LandTiles::PlaceTile(std::size_t index) {
  const ElevationGrid grid = PaddedExtent(extents_[index], tiles_[index].pads);
  // All parts of one file use the turn of longitude of its first part, so that they stay adjacent.
  const std::optional<GridWindow>& part = tiles_[index].part;
  const double east_rad = part ? part->first_column * grid.step_lon_rad : 0.0;
  const double turned_rad =
      std::remainder(grid.west_rad - east_rad - lattice_.west_rad, 2.0 * std::numbers::pi);
  const double column = (turned_rad + east_rad) / lattice_.step_lon_rad;
  const double row = (lattice_.north_rad - grid.north_rad) / lattice_.step_lat_rad;
  const double wide = (grid.columns - 1) * grid.step_lon_rad / lattice_.step_lon_rad;
  const double high = (grid.rows - 1) * grid.step_lat_rad / lattice_.step_lat_rad;
  constexpr double kOnLattice = 1e-2;  // samples
  LandTile& tile = tiles_[index];
  tile.box = {static_cast<int>(std::ceil(column - kOnLattice)),
              static_cast<int>(std::ceil(row - kOnLattice)),
              static_cast<int>(std::floor(column + wide + kOnLattice)),
              static_cast<int>(std::floor(row + high + kOnLattice))};
  const double ratio = std::min(grid.step_lon_rad / lattice_.step_lon_rad,
                                grid.step_lat_rad / lattice_.step_lat_rad);
  tile.level = std::max(static_cast<int>(std::floor(std::log2(ratio) + 1e-6)), 0);
}

std::vector<int> LandTiles::Touching(const LatticeBox& box) const {
  const int turns = lattice_.ClosesAroundTheEarth() ? 1 : 0;
  const auto touches = [&](const LandTile& tile) {
    for (int turn = -turns; turn <= turns; ++turn) {
      LatticeBox moved = box;
      moved.first_column += turn * lattice_.last_column;
      moved.last_column += turn * lattice_.last_column;
      if (tile.box.Touches(moved)) return true;
    }
    return false;
  };
  std::vector<int> touching;
  for (std::size_t tile = 0; tile < tiles_.size(); ++tile)
    if (touches(tiles_[tile])) touching.push_back(static_cast<int>(tile));
  return touching;
}

ReadTile ReadLandTile(const LandTiles& tiles, int tile, int level) {
  const LandTile& wanted = tiles.tiles()[static_cast<std::size_t>(tile)];
  ElevationModel model;
  if (wanted.file.empty()) {
    model.grid = ProceduralMountains(*tiles.source().range_centre, tiles.source().range_seed);
  } else {
    model = wanted.part ? ReadElevation(wanted.file, tiles.source().voids, *wanted.part)
                        : ReadElevation(wanted.file, tiles.source().voids);
  }
  ElevationGrid grid = Closed(std::move(model.grid));
  if (wanted.pads.Any()) grid = WithPads(tiles, tile, grid);
  const HeightPyramid all(wanted.box, wanted.level,
                          OnLattice(tiles.lattice(), wanted, std::move(grid)));
  return {std::make_shared<const HeightPyramid>(all.From(level)),
          NoteOn(model, wanted.file.string())};
}

}  // namespace alpenglow::renderer
