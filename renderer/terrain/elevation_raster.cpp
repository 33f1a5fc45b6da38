// SPDX-License-Identifier: MIT
#include "renderer/terrain/elevation_raster.h"

#include <fmt/format.h>
#include <gdal_priv.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <utility>

#include "atmosphere/text/error.h"

namespace alpenglow {
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

[[noreturn]] void Refuse(const std::filesystem::path& file, const std::string& fault) {
  throw InputError(fmt::format("{}: {}", file.string(), fault));
}

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
  if (!std::filesystem::is_regular_file(file, ignored)) Refuse(file, "there is no such file");
  RegisterDrivers();
  static const char* const kDrivers[] = {"GTiff", "SRTMHGT", "USGSDEM", nullptr};
  Dataset dataset(static_cast<GDALDataset*>(GDALOpenEx(
      file.c_str(), GDAL_OF_RASTER | GDAL_OF_VERBOSE_ERROR, kDrivers, nullptr, nullptr)));
  if (!dataset) {
    Refuse(file, "not a readable GeoTIFF, SRTM .hgt or USGS DEM (" + LastGdalError() + ")");
  }
  return dataset;
}

void CheckLayout(const std::filesystem::path& file, GDALDataset& dataset) {
  if (dataset.GetRasterCount() != 1) {
    Refuse(file, fmt::format("has {} bands; an elevation model has 1", dataset.GetRasterCount()));
  }
  const int columns = dataset.GetRasterXSize();
  const int rows = dataset.GetRasterYSize();
  if (columns < 2 || rows < 2) {
    Refuse(file, fmt::format("has {} x {} samples; at least 2 x 2 are needed", columns, rows));
  }
  if (std::int64_t{columns} * rows > kMostElevationSamples) {
    Refuse(file, fmt::format("has {} x {} samples; at most {} can be held", columns, rows,
                             kMostElevationSamples));
  }
  if (GDALDataTypeIsComplex(dataset.GetRasterBand(1)->GetRasterDataType()) != 0) {
    Refuse(file, "has complex samples; heights are real");
  }
}

std::array<double, 6> ReadGeotransform(const std::filesystem::path& file, GDALDataset& dataset) {
  std::array<double, 6> transform{};
  if (dataset.GetGeoTransform(transform.data()) != CE_None) {
    Refuse(file, "has no geotransform; where it lies is unknown");
  }
  if (transform[2] != 0.0 || transform[4] != 0.0) {
    Refuse(file, "has a rotated geotransform; only north-up and south-up are read");
  }
  for (const double term : transform) {
    if (!std::isfinite(term)) Refuse(file, "has a geotransform that is not finite");
  }
  if (transform[1] == 0.0 || transform[5] == 0.0) Refuse(file, "has pixels of no size");
  return transform;
}

OGRSpatialReference ReadCrs(const std::filesystem::path& file, GDALDataset& dataset) {
  const OGRSpatialReference* stored = dataset.GetSpatialRef();
  if (stored == nullptr || stored->IsEmpty()) Refuse(file, "has no coordinate system");
  if (!stored->IsGeographic() && !stored->IsProjected()) {
    Refuse(file, "has a coordinate system that is neither geographic nor projected");
  }
  const double equatorial = stored->GetSemiMajor();
  const double polar = stored->GetSemiMinor();
  const auto of_the_earth = [](double radius_m) { return radius_m > 6.35e6 && radius_m < 6.39e6; };
  if (!of_the_earth(equatorial) || !of_the_earth(polar)) {
    Refuse(file, fmt::format("has the coordinate system of a body with radii {} and {} m; it must "
                             "be of the earth",
                             equatorial, polar));
  }
  OGRSpatialReference crs = *stored;
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return crs;
}

// GDAL gives the vertical unit of a compound system and of USGS DEM files as the band's unit.
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
  Refuse(file, "has heights in '" + unit + "'; metres and feet are read");
}

// Values that are nodata by custom though the file does not declare them.
bool IsCustomaryVoid(double value) {
  return value == -32768.0 || value == -32767.0 || value == -9999.0 ||
         value == static_cast<double>(std::numeric_limits<float>::lowest());
}

std::vector<float> ReadSamples(const std::filesystem::path& file, GDALDataset& dataset) {
  const int columns = dataset.GetRasterXSize();
  const int rows = dataset.GetRasterYSize();
  std::vector<float> samples(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  const CPLErr status = dataset.GetRasterBand(1)->RasterIO(
      GF_Read, 0, 0, columns, rows, samples.data(), columns, rows, GDT_Float32, 0, 0, nullptr);
  if (status != CE_None) Refuse(file, "is damaged or cut short (" + LastGdalError() + ")");
  return samples;
}

// Turns raw samples into metres and NaN, in place; returns the number of voids.
std::size_t ConvertToMetres(const std::filesystem::path& file, GDALRasterBand& band,
                            std::vector<float>& samples) {
  const double unit_m = MetresPerUnit(file, band.GetUnitType());
  const double scale = band.GetScale();
  const double offset = band.GetOffset();
  int has_nodata = 0;
  const auto nodata = static_cast<float>(band.GetNoDataValue(&has_nodata));
  std::size_t voids = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const float raw = samples[i];
    if (std::isnan(raw) || (has_nodata != 0 && raw == nodata) ||
        IsCustomaryVoid(static_cast<double>(raw))) {
      samples[i] = kVoid;
      ++voids;
      continue;
    }
    const double height_m = (static_cast<double>(raw) * scale + offset) * unit_m;
    if (!(height_m >= kDeepestGround_m && height_m <= kHighestGround_m)) {
      const auto columns = static_cast<std::size_t>(band.GetXSize());
      Refuse(file,
             fmt::format("has the height {} m at row {}, column {}; the ground of the earth "
                         "lies in [{}, {}] m",
                         height_m, i / columns, i % columns, kDeepestGround_m, kHighestGround_m));
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

ElevationRaster ReadElevationHeader(const std::filesystem::path& file) {
  const QuietGdal quiet;
  const Dataset dataset = Open(file);
  return HeaderOf(file, *dataset);
}

ElevationRaster ReadElevationRaster(const std::filesystem::path& file) {
  const QuietGdal quiet;
  const Dataset dataset = Open(file);
  ElevationRaster raster = HeaderOf(file, *dataset);
  raster.height_m = ReadSamples(file, *dataset);
  raster.voids = ConvertToMetres(file, *dataset->GetRasterBand(1), raster.height_m);
  if (raster.voids == raster.height_m.size()) Refuse(file, "has no valid sample, only voids");
  return raster;
}

}  // namespace alpenglow
