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
#include <gdal_priv.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "atmosphere/base/error.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

constexpr double kDeepestGround_m = -12000.0;  // the Challenger Deep is at -10,935 m
constexpr double kHighestGround_m = 9000.0;
constexpr float kVoid = std::numeric_limits<float>::quiet_NaN();

struct CloseDataset {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<GDALDataset, CloseDataset>;

std::string LastGdalError() {
  std::string text = CPLGetLastErrorMsg();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.empty() ? "no reason given" : text;
}

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

Dataset Open(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) RefuseFile(file, "there is no such file");
  RegisterDrivers();
  Dataset dataset(static_cast<GDALDataset*>(GDALOpenEx(
      file.c_str(), GDAL_OF_RASTER | GDAL_OF_VERBOSE_ERROR, kElevationDrivers, nullptr, nullptr)));
  if (!dataset) {
    RefuseFile(file, fmt::format("not a readable {} ({})", kElevationFormats, LastGdalError()));
  }
  return dataset;
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

OGRSpatialReference ReadCrs(const std::filesystem::path& file, GDALDataset& dataset) {
  const OGRSpatialReference* stored = dataset.GetSpatialRef();
  if (stored == nullptr || stored->IsEmpty()) RefuseFile(file, "has no coordinate system");
  if (!stored->IsGeographic() && !stored->IsProjected()) {
    RefuseFile(file, "has a coordinate system that is neither geographic nor projected");
  }
  const double equatorial = stored->GetSemiMajor();
  const double polar = stored->GetSemiMinor();
  const auto of_the_earth = [](double radius_m) { return radius_m > 6.35e6 && radius_m < 6.39e6; };
  if (!of_the_earth(equatorial) || !of_the_earth(polar)) {
    RefuseFile(file,
               fmt::format("has the coordinate system of a body with radii {} and {} m; it must "
                           "be of the earth",
                           equatorial, polar));
  }
  OGRSpatialReference crs = *stored;
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return crs;
}

/// The unit of heights, and a note on it.
struct HeightUnit {
  double metres = 1.0;
  std::string note;  // empty: none
};

// Returns the metres per unit. GDAL reports the vertical unit of a compound system and of USGS DEM
// files as the band's unit.
double MetresPerUnit(const std::filesystem::path& file, const std::string& unit) {
  static const std::pair<const char*, double> kUnits[] = {
      {"", 1.0},
      {"m", 1.0},
      {"metre", 1.0},
      {"meter", 1.0},
      {"metres", 1.0},
      {"meters", 1.0},
      {"ft", 0.3048},
      {"foot", 0.3048},
      {"feet", 0.3048},
      {"us-ft", 1200.0 / 3937.0},
      {"us survey foot", 1200.0 / 3937.0},
      {"us survey feet", 1200.0 / 3937.0},
      {"foot_us", 1200.0 / 3937.0},
  };
  std::string name = unit;
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  for (const auto& [known, metres] : kUnits) {
    if (name == known) return metres;
  }
  RefuseFile(file, "has heights in '" + unit + "'; metres and feet are read");
}

// Returns the unit of heights. Without a declared unit it is feet on a map in feet, as in surveys
// in feet, else metres, with a note if the map is not in metres.
HeightUnit UnitOf(const std::filesystem::path& file, GDALRasterBand& band,
                  const OGRSpatialReference& crs) {
  const std::string unit = band.GetUnitType();
  if (!unit.empty()) return {MetresPerUnit(file, unit), ""};
  const char* name = nullptr;
  const double map_unit_m = crs.IsProjected() != 0 ? crs.GetLinearUnits(&name) : 1.0;
  constexpr double kFoot_m = 0.3048, kFeetDiffer_m = 1e-5, kRounding = 1e-9;
  if (std::abs(map_unit_m - 1.0) < kRounding) return {};
  const bool is_in_feet = std::abs(map_unit_m - kFoot_m) < kFeetDiffer_m;
  return {is_in_feet ? map_unit_m : 1.0,
          fmt::format("heights have no unit, and the map is in {}; they are taken in {} (declare "
                      "the unit of the band otherwise)",
                      name, is_in_feet ? name : "metre")};
}

// Returns whether a value is customarily nodata, even if the file does not declare it.
bool IsCustomaryVoid(double value) {
  return value == -32768.0 || value == -32767.0 || value == -9999.0 ||
         value == static_cast<double>(std::numeric_limits<float>::lowest());
}

// Returns the values of a band within a window; nullopt if the file is damaged.
template <typename Value>
std::optional<std::vector<Value>> ValuesIn(GDALRasterBand& band, const PixelWindow& window,
                                           GDALDataType type) {
  std::vector<Value> values(static_cast<std::size_t>(window.columns) *
                            static_cast<std::size_t>(window.rows));
  if (band.RasterIO(GF_Read, window.column, window.row, window.columns, window.rows, values.data(),
                    window.columns, window.rows, type, 0, 0, nullptr) != CE_None) {
    return std::nullopt;
  }
  return values;
}

std::vector<float> ReadSamples(const std::filesystem::path& file, GDALRasterBand& band,
                               const PixelWindow& window) {
  if (std::int64_t{window.columns} * window.rows > kMostElevationSamples) {
    RefuseFile(file, fmt::format("has {} x {} samples{}; at most {} can be held", window.columns,
                                 window.rows, window.columns < band.GetXSize() ? " in sight" : "",
                                 kMostElevationSamples));
  }
  std::optional<std::vector<float>> samples = ValuesIn<float>(band, window, GDT_Float32);
  if (!samples) RefuseFile(file, "is damaged or cut short (" + LastGdalError() + ")");
  return std::move(*samples);
}

// Reads an alpha band as a mask, because GDAL makes no mask of an alpha band of floats.
std::vector<std::uint8_t> ReadAlpha(const std::filesystem::path& file, GDALRasterBand& alpha,
                                    const PixelWindow& window) {
  const std::optional<std::vector<float>> values = ValuesIn<float>(alpha, window, GDT_Float32);
  if (!values) RefuseFile(file, "has a damaged alpha band (" + LastGdalError() + ")");
  std::vector<std::uint8_t> mask;
  mask.reserve(values->size());
  for (const float value : *values) mask.push_back(value > 0.0F ? 255 : 0);
  return mask;
}

// Returns the file's mask or alpha band, 0 where a sample is invalid; empty if there is none.
std::vector<std::uint8_t> ReadMask(const std::filesystem::path& file, GDALRasterBand& band,
                                   const PixelWindow& window) {
  GDALDataset& dataset = *band.GetDataset();
  if (dataset.GetRasterCount() == 2) return ReadAlpha(file, *dataset.GetRasterBand(2), window);
  if ((band.GetMaskFlags() & (GMF_PER_DATASET | GMF_ALPHA)) == 0) return {};
  std::optional<std::vector<std::uint8_t>> mask =
      ValuesIn<std::uint8_t>(*band.GetMaskBand(), window, GDT_Byte);
  if (!mask) RefuseFile(file, "has a damaged mask (" + LastGdalError() + ")");
  return std::move(*mask);
}

// Converts a band's samples to heights.
class Decoder {
 public:
  Decoder(GDALRasterBand& band, double unit_m)
      : unit_m_(unit_m), scale_(band.GetScale()), offset_(band.GetOffset()) {
    int has_nodata = 0;
    const double nodata = band.GetNoDataValue(&has_nodata);
    if (has_nodata != 0) nodata_ = static_cast<float>(nodata);
  }
  [[nodiscard]] bool IsVoid(float raw) const {
    return std::isnan(raw) || raw == nodata_ || IsCustomaryVoid(static_cast<double>(raw));
  }
  [[nodiscard]] double Height(float raw) const {
    return (static_cast<double>(raw) * scale_ + offset_) * unit_m_;
  }

 private:
  double unit_m_, scale_, offset_;
  std::optional<float> nodata_;
};

// Converts raw samples into metres and NaN, in place; returns the number of voids.
std::size_t ConvertToMetres(const std::filesystem::path& file, GDALRasterBand& band,
                            const PixelWindow& window, double unit_m, std::vector<float>& samples) {
  const std::vector<std::uint8_t> mask = ReadMask(file, band, window);
  const Decoder decoder(band, unit_m);
  std::size_t voids = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (decoder.IsVoid(samples[i]) || (!mask.empty() && mask[i] == 0)) {
      samples[i] = kVoid;
      ++voids;
      continue;
    }
    const double height_m = decoder.Height(samples[i]);
    if (!(height_m >= kDeepestGround_m && height_m <= kHighestGround_m)) {
      const auto columns = static_cast<std::size_t>(window.columns);
      RefuseFile(
          file, fmt::format("has the height {} m at row {}, column {}; the ground of the earth "
                            "lies in [{}, {}] m",
                            height_m, i / columns + static_cast<std::size_t>(window.row),
                            i % columns + static_cast<std::size_t>(window.column), kDeepestGround_m,
                            kHighestGround_m));
    }
    samples[i] = static_cast<float>(height_m);
  }
  return voids;
}

ElevationRaster HeaderOf(const std::filesystem::path& file, GDALDataset& dataset) {
  CheckLayout(file, dataset);
  ElevationRaster raster;
  raster.columns = dataset.GetRasterXSize();
  raster.rows = dataset.GetRasterYSize();
  raster.crs = ReadCrs(file, dataset);
  raster.geotransform = ReadGeotransform(file, dataset);
  return raster;
}

}  // namespace

std::span<const char* const> ElevationExtensions() { return kElevationExtensions; }

ElevationRaster ReadElevationHeader(const std::filesystem::path& file) {
  const QuietGdal quiet;
  const Dataset dataset = Open(file);
  return HeaderOf(file, *dataset);
}

ElevationRaster ReadElevationRaster(const std::filesystem::path& file,
                                    const std::optional<PixelWindow>& window) {
  const QuietGdal quiet;
  const Dataset dataset = Open(file);
  ElevationRaster raster = HeaderOf(file, *dataset);
  const PixelWindow wanted = window.value_or(PixelWindow{0, 0, raster.columns, raster.rows});
  raster.geotransform[0] += wanted.column * raster.geotransform[1];
  raster.geotransform[3] += wanted.row * raster.geotransform[5];
  raster.columns = wanted.columns;
  raster.rows = wanted.rows;
  GDALRasterBand& band = *dataset->GetRasterBand(1);
  const HeightUnit unit = UnitOf(file, band, raster.crs);
  raster.unit_note = unit.note;
  raster.height_m = ReadSamples(file, band, wanted);
  raster.voids = ConvertToMetres(file, band, wanted, unit.metres, raster.height_m);
  if (!window && raster.voids == raster.height_m.size())
    RefuseFile(file, "has no valid sample, only voids");
  return raster;
}

namespace {

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
