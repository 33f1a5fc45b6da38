// SPDX-License-Identifier: MIT
// This file spans a membrane over each void: Laplace's equation, from the coarsest pyramid level to
// the finest.
//
// Pulling averages the valid samples of 2 x 2 into one. Pushing starts the voids of a level with
// the interpolated values of the coarser level and relaxes them (Gauss-Seidel with
// over-relaxation). Long waves converge on coarse levels, where sweeps are cheap, so a few sweeps
// per level are enough.
#include "renderer/elevation/elevation_raster.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <mutex>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "atmosphere/math/units.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

constexpr double kDeepestGround_m = -12000.0;  // the Challenger Deep is at -10,935 m
constexpr double kHighestGround_m = 9000.0;
constexpr float kVoid = std::numeric_limits<float>::quiet_NaN();

// The formats of elevation models: their names for messages, GDAL's drivers and the extensions of
// their files.
constexpr char kElevationFormats[] = "GeoTIFF, SRTM .hgt or USGS DEM";
constexpr const char* kElevationDrivers[] = {"GTiff", "SRTMHGT", "USGSDEM", nullptr};
constexpr const char* kElevationExtensions[] = {".hgt", ".tif", ".tiff", ".dem"};

void RegisterDrivers() {
  static std::once_flag once;
  std::call_once(once, [] {
    GDALRegister_GTiff();
    GDALRegister_SRTMHGT();
    GDALRegister_USGSDEM();
  });
}

// The place of an SRTM tile stands in its name only: GDAL reads N46E008.hgt, with more words behind
// the first dot, but no "N46E008 (1).hgt".
bool IsNamedByPlace(const std::filesystem::path& file) {
  const std::string name = file.filename().string();
  constexpr std::string_view kPattern = "NddEddd.";  // a digit for each d, a side for each letter
  for (std::size_t i = 0; i < kPattern.size(); ++i) {
    const char letter = i < name.size() ? UpperCase(name[i]) : '\0';
    const bool fits = kPattern[i] == 'd'   ? letter >= '0' && letter <= '9'
                      : kPattern[i] == 'N' ? letter == 'N' || letter == 'S'
                      : kPattern[i] == 'E' ? letter == 'E' || letter == 'W'
                                           : letter == kPattern[i];
    if (!fits) return false;
  }
  return true;
}

RasterFile Open(const std::filesystem::path& file) {
  if (HasExtension(file, ".hgt") && !IsNamedByPlace(file)) {
    RefuseFile(file,
               "not a readable SRTM .hgt: its name must be the place of its south-western "
               "corner, as N46E008.hgt");
  }
  RegisterDrivers();
  return OpenRaster(file, {kElevationFormats, kElevationDrivers, "elevation models"});
}

// Returns whether there is one band of heights, possibly with an alpha band that marks valid
// samples.
bool HasOneBandOfHeights(GDALDataset& dataset) {
  const int bands = dataset.GetRasterCount();
  return bands == 1 ||
         (bands == 2 && dataset.GetRasterBand(2)->GetColorInterpretation() == GCI_AlphaBand);
}

void CheckLayout(const std::filesystem::path& file, GDALDataset& dataset) {
  if (!HasOneBandOfHeights(dataset)) {
    RefuseFile(file,
               fmt::format("has {} bands; an elevation model has 1", dataset.GetRasterCount()));
  }
  const int columns = dataset.GetRasterXSize();
  const int rows = dataset.GetRasterYSize();
  if (columns < 2 || rows < 2) {
    RefuseFile(file, fmt::format("has {} x {} samples; at least 2 x 2 are needed", columns, rows));
  }
  if (GDALDataTypeIsComplex(dataset.GetRasterBand(1)->GetRasterDataType()) != 0) {
    RefuseFile(file, "has complex samples; heights are real");
  }
}

std::array<double, 6> ReadGeotransform(const std::filesystem::path& file, GDALDataset& dataset) {
  std::array<double, 6> transform{};
  if (dataset.GetGeoTransform(transform.data()) != CE_None) {
    RefuseFile(file, "has no geotransform; where it lies is unknown");
  }
  if (transform[2] != 0.0 || transform[4] != 0.0) {
    RefuseFile(file, "has a rotated geotransform; only north-up and south-up are read");
  }
  for (const double term : transform) {
    if (!std::isfinite(term)) RefuseFile(file, "has a geotransform that is not finite");
  }
  if (transform[1] == 0.0 || transform[5] == 0.0) RefuseFile(file, "has pixels of no size");
  return transform;
}

/// The unit of heights, and a note on it.
struct HeightUnit {
  double metres = 1.0;
  std::string note;  // empty: none
};

constexpr double kUsSurveyFoot_m = 1200.0 / 3937.0;
constexpr std::pair<std::string_view, double> kHeightUnits[] = {
    {"", 1.0},
    {"m", 1.0},
    {"metre", 1.0},
    {"meter", 1.0},
    {"metres", 1.0},
    {"meters", 1.0},
    {"mm", 1e-3},
    {"millimetre", 1e-3},
    {"millimeter", 1e-3},
    {"cm", 1e-2},
    {"centimetre", 1e-2},
    {"centimeter", 1e-2},
    {"centimetres", 1e-2},
    {"centimeters", 1e-2},
    {"dm", 0.1},
    {"decimetre", 0.1},
    {"decimeter", 0.1},
    {"decimetres", 0.1},
    {"decimeters", 0.1},
    {"km", 1000.0},
    {"kilometre", 1000.0},
    {"kilometer", 1000.0},
    {"kilometres", 1000.0},
    {"kilometers", 1000.0},
    {"ft", kMetresPerFoot},
    {"foot", kMetresPerFoot},
    {"feet", kMetresPerFoot},
    {"international foot", kMetresPerFoot},
    {"us-ft", kUsSurveyFoot_m},
    {"ftus", kUsSurveyFoot_m},
    {"us ft", kUsSurveyFoot_m},
    {"us foot", kUsSurveyFoot_m},
    {"us survey foot", kUsSurveyFoot_m},
    {"us survey feet", kUsSurveyFoot_m},
    {"us_survey_foot", kUsSurveyFoot_m},
    {"foot_us", kUsSurveyFoot_m},
    {"survey foot", kUsSurveyFoot_m},
};

// Returns the name of a unit without what describes the heights: "m a.s.l." are metres.
std::string UnitOnly(std::string_view text) {
  const std::string lower = LowerCase(text);
  std::string_view unit = Trimmed(lower);
  for (const std::string_view height : {"a.s.l.", "asl", "amsl", "above sea level"}) {
    if (unit.ends_with(height)) unit.remove_suffix(height.size());
  }
  return std::string(Trimmed(unit));
}

// Returns the metres per unit. GDAL reports the vertical unit of a compound system and of USGS DEM
// files as the band's unit.
double MetresPerUnit(const std::filesystem::path& file, const std::string& unit) {
  const std::string name = UnitOnly(unit);
  for (const auto& [known, metres] : kHeightUnits) {
    if (name == known) return metres;
  }
  RefuseFile(file, fmt::format("has heights in '{}'; metres (also mm, cm, dm, km) and feet (also "
                               "US survey feet) are read",
                               unit));
}

// Returns the unit of heights. Without a declared unit it is feet on a map in feet, as in surveys
// in feet, else metres, with a note if the map is not in metres.
HeightUnit UnitOf(const std::filesystem::path& file, GDALRasterBand& band,
                  const OGRSpatialReference& crs) {
  const std::string unit = band.GetUnitType();
  if (!unit.empty()) return {MetresPerUnit(file, unit), ""};
  const char* name = nullptr;
  const double map_unit_m = crs.IsProjected() != 0 ? crs.GetLinearUnits(&name) : 1.0;
  constexpr double kFeetDiffer_m = 1e-5, kRounding = 1e-9;
  if (std::abs(map_unit_m - 1.0) < kRounding) return {};
  const bool is_in_feet = std::abs(map_unit_m - kMetresPerFoot) < kFeetDiffer_m;
  return {is_in_feet ? map_unit_m : 1.0,
          fmt::format("heights have no unit, and the map is in {}; they are taken in {} (declare "
                      "the unit of the band otherwise)",
                      name, is_in_feet ? name : "metre")};
}

// Returns whether a height in the unit of its file is customarily a void. It counts only in files
// that declare no nodata value and have no mask.
bool IsCustomaryVoid(double height) {
  return height == -32768.0 || height == -32767.0 || height == -9999.0 ||
         height == static_cast<double>(std::numeric_limits<float>::lowest()) ||
         height == std::numeric_limits<double>::lowest();
}

void RequireHoldable(const std::filesystem::path& file, GDALRasterBand& band,
                     const PixelWindow& window) {
  if (std::int64_t{window.columns} * window.rows <= kMostElevationSamples) return;
  RefuseFile(file, fmt::format("has {} x {} samples{}; at most {} can be held", window.columns,
                               window.rows, window.columns < band.GetXSize() ? " in sight" : "",
                               kMostElevationSamples));
}

/// Returns for each sample of a window whether it is valid; empty if the file has no such band.
using ValidSamples = std::vector<bool>;

// Reads an alpha band as a mask, because GDAL makes no mask of an alpha band of floats.
ValidSamples ReadMask(const std::filesystem::path& file, GDALRasterBand& band,
                      const PixelWindow& window) {
  GDALDataset& dataset = *band.GetDataset();
  const bool has_alpha = dataset.GetRasterCount() == 2;
  if (!has_alpha && (band.GetMaskFlags() & (GMF_PER_DATASET | GMF_ALPHA)) == 0) return {};
  GDALRasterBand& mask = has_alpha ? *dataset.GetRasterBand(2) : *band.GetMaskBand();
  std::vector<float> values(static_cast<std::size_t>(window.columns) *
                            static_cast<std::size_t>(window.rows));
  if (mask.RasterIO(GF_Read, window.column, window.row, window.columns, window.rows, values.data(),
                    window.columns, window.rows, GDT_Float32, 0, 0, nullptr) != CE_None) {
    RefuseFile(file, fmt::format("has a damaged {} ({})", has_alpha ? "alpha band" : "mask",
                                 LastGdalError()));
  }
  ValidSamples valid;
  valid.reserve(values.size());
  for (const float value : values) valid.push_back(value > 0.0F);
  return valid;
}

/// Reads the heights of a band in parts.
class HeightReader {
 public:
  HeightReader(const std::filesystem::path& file, GDALRasterBand& band, double unit_m)
      : file_(file), band_(band), values_(file, band), unit_m_(unit_m) {}

  /// Returns metres, and NaN for voids.
  [[nodiscard]] std::vector<float> Heights(const PixelWindow& window) const {
    const ValidSamples valid = ReadMask(file_, band_, window);
    std::optional<std::vector<double>> stored = values_.Read(window);
    if (!stored) RefuseFile(file_, "is damaged or cut short (" + LastGdalError() + ")");
    const bool is_declared = values_.nodata().has_value() || !valid.empty();
    std::vector<float> height_m(stored->size(), kVoid);
    for (std::size_t i = 0; i < stored->size(); ++i) {
      const double sample = (*stored)[i], height = values_.Value(sample);
      if (values_.IsNodata(sample) || (!valid.empty() && !valid[i])) continue;
      if (!is_declared && IsCustomaryVoid(height)) continue;
      if (!(height * unit_m_ >= kDeepestGround_m && height * unit_m_ <= kHighestGround_m))
        FailAt(window, i, height * unit_m_);
      height_m[i] = static_cast<float>(height * unit_m_);
    }
    return height_m;
  }

 private:
  [[noreturn]] void FailAt(const PixelWindow& window, std::size_t sample, double height_m) const {
    const auto columns = static_cast<std::size_t>(window.columns);
    RefuseFile(
        file_,
        fmt::format("has the height {} m at row {}, column {}; the ground of the earth lies in "
                    "[{}, {}] m, and {}",
                    height_m, sample / columns + static_cast<std::size_t>(window.row),
                    sample % columns + static_cast<std::size_t>(window.column), kDeepestGround_m,
                    kHighestGround_m,
                    values_.nodata()
                        ? fmt::format("{} is the declared nodata value", *values_.nodata())
                        : "no nodata value is declared"));
  }

  const std::filesystem::path& file_;
  GDALRasterBand& band_;
  BandValues values_;
  double unit_m_;
};

// Reads a window by rows, so that the samples in double precision need little memory.
std::vector<float> ReadHeights(const std::filesystem::path& file, GDALRasterBand& band,
                               const PixelWindow& window, double unit_m) {
  RequireHoldable(file, band, window);
  constexpr int kSamplesAtOnce = 1 << 22;
  const HeightReader reader(file, band, unit_m);
  const int rows_at_once = std::max(kSamplesAtOnce / window.columns, 1);
  std::vector<float> height_m;
  height_m.reserve(static_cast<std::size_t>(window.columns) *
                   static_cast<std::size_t>(window.rows));
  for (int row = 0; row < window.rows; row += rows_at_once) {
    const std::vector<float> part = reader.Heights({window.column, window.row + row, window.columns,
                                                    std::min(rows_at_once, window.rows - row)});
    height_m.insert(height_m.end(), part.begin(), part.end());
  }
  return height_m;
}

ElevationRaster HeaderOf(const std::filesystem::path& file, GDALDataset& dataset) {
  CheckLayout(file, dataset);
  ElevationRaster raster;
  raster.columns = dataset.GetRasterXSize();
  raster.rows = dataset.GetRasterYSize();
  raster.crs = CrsOfTheEarth(file, dataset);
  raster.geotransform = ReadGeotransform(file, dataset);
  return raster;
}

constexpr int kSweeps = 40;
constexpr double kOverRelaxation = 1.7;

struct Level {
  int rows = 0;
  int columns = 0;
  std::vector<double> height;  // NaN: a void that has not been pushed yet

  [[nodiscard]] std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
  [[nodiscard]] double clamped(int row, int column) const {
    return height[index(std::clamp(row, 0, rows - 1), std::clamp(column, 0, columns - 1))];
  }
};

double MeanOfValid(const Level& fine, int row, int column) {
  double sum = 0.0;
  int count = 0;
  for (int r = row; r < std::min(row + 2, fine.rows); ++r) {
    for (int c = column; c < std::min(column + 2, fine.columns); ++c) {
      const double height = fine.height[fine.index(r, c)];
      if (std::isnan(height)) continue;
      sum += height;
      ++count;
    }
  }
  return count == 0 ? std::numeric_limits<double>::quiet_NaN() : sum / count;
}

Level Pull(const Level& fine) {
  Level coarse{(fine.rows + 1) / 2, (fine.columns + 1) / 2, {}};
  coarse.height.reserve(static_cast<std::size_t>(coarse.rows) *
                        static_cast<std::size_t>(coarse.columns));
  for (int row = 0; row < coarse.rows; ++row) {
    for (int column = 0; column < coarse.columns; ++column) {
      coarse.height.push_back(MeanOfValid(fine, 2 * row, 2 * column));
    }
  }
  return coarse;
}

// Returns the bilinear value of the coarse level at the centre of a fine sample.
double Interpolate(const Level& coarse, int fine_row, int fine_column) {
  const double row = 0.5 * fine_row - 0.25;
  const double column = 0.5 * fine_column - 0.25;
  const int r = static_cast<int>(std::floor(row));
  const int c = static_cast<int>(std::floor(column));
  const double fr = row - r;
  const double fc = column - c;
  return (1.0 - fr) * ((1.0 - fc) * coarse.clamped(r, c) + fc * coarse.clamped(r, c + 1)) +
         fr * ((1.0 - fc) * coarse.clamped(r + 1, c) + fc * coarse.clamped(r + 1, c + 1));
}

struct Sample {
  int row;
  int column;
};

std::vector<Sample> VoidsOf(const Level& level) {
  std::vector<Sample> voids;
  for (int row = 0; row < level.rows; ++row) {
    for (int column = 0; column < level.columns; ++column) {
      if (std::isnan(level.height[level.index(row, column)])) voids.push_back({row, column});
    }
  }
  return voids;
}

// Returns the mean of the existing neighbours: at the raster's edge the membrane is free.
double NeighbourMean(const Level& level, const Sample& at) {
  double sum = 0.0;
  int count = 0;
  const auto add = [&](int row, int column) {
    if (row < 0 || column < 0 || row >= level.rows || column >= level.columns) return;
    sum += level.height[level.index(row, column)];
    ++count;
  };
  add(at.row - 1, at.column);
  add(at.row + 1, at.column);
  add(at.row, at.column - 1);
  add(at.row, at.column + 1);
  return sum / count;
}

void Push(const Level& coarse, Level& fine) {
  const std::vector<Sample> voids = VoidsOf(fine);
  for (const Sample& at : voids) {
    fine.height[fine.index(at.row, at.column)] = Interpolate(coarse, at.row, at.column);
  }
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (const Sample& at : voids) {
      double& height = fine.height[fine.index(at.row, at.column)];
      height += kOverRelaxation * (NeighbourMean(fine, at) - height);
    }
  }
}

bool HasVoids(const Level& level) {
  return std::any_of(level.height.begin(), level.height.end(),
                     [](double height) { return std::isnan(height); });
}

}  // namespace

std::span<const char* const> ElevationExtensions() { return kElevationExtensions; }

ElevationRaster ReadElevationHeader(const std::filesystem::path& file) {
  const QuietGdal quiet;
  const RasterFile dataset = Open(file);
  return HeaderOf(file, *dataset);
}

ElevationRaster ReadElevationRaster(const std::filesystem::path& file,
                                    const std::optional<PixelWindow>& window) {
  const QuietGdal quiet;
  const RasterFile dataset = Open(file);
  ElevationRaster raster = HeaderOf(file, *dataset);
  const PixelWindow wanted = window.value_or(PixelWindow{0, 0, raster.columns, raster.rows});
  raster.geotransform[0] += wanted.column * raster.geotransform[1];
  raster.geotransform[3] += wanted.row * raster.geotransform[5];
  raster.columns = wanted.columns;
  raster.rows = wanted.rows;
  GDALRasterBand& band = *dataset->GetRasterBand(1);
  const HeightUnit unit = UnitOf(file, band, raster.crs);
  raster.unit_note = unit.note;
  raster.height_m = ReadHeights(file, band, wanted, unit.metres);
  raster.voids = static_cast<std::size_t>(std::count_if(
      raster.height_m.begin(), raster.height_m.end(), [](float h) { return std::isnan(h); }));
  if (!window && raster.voids == raster.height_m.size())
    RefuseFile(file, "has no valid sample, only voids");
  return raster;
}

std::size_t FillVoids(std::vector<float>& height, int rows, int columns) {
  std::vector<Level> pyramid(1);
  pyramid[0] = {rows, columns, std::vector<double>(height.begin(), height.end())};
  while (HasVoids(pyramid.back())) {
    ALPENGLOW_ENSURE(pyramid.back().height.size(), >, std::size_t{1});
    pyramid.push_back(Pull(pyramid.back()));
  }
  for (std::size_t level = pyramid.size() - 1; level > 0; --level) {
    Push(pyramid[level], pyramid[level - 1]);
  }
  std::size_t filled = 0;
  for (std::size_t i = 0; i < height.size(); ++i) {
    if (!std::isnan(height[i])) continue;
    height[i] = static_cast<float>(pyramid[0].height[i]);
    ++filled;
  }
  return filled;
}

}  // namespace alpenglow::renderer
