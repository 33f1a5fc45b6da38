// SPDX-License-Identifier: MIT
#include "renderer/elevation/gdal_file.h"

#include <cpl_conv.h>
#include <cpl_minixml.h>
#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string_view>

#include "atmosphere/base/error.h"
#include "atmosphere/base/file_format.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

// A nodata value of this size is no value of any quantity; text in a file often rounds it.
constexpr double kBeyondAllValues = 1e30;
constexpr double kRoundingOfText = 1e-4;

constexpr double kLargestFloat = static_cast<double>(std::numeric_limits<float>::max());

// Files use the largest float, the largest double or infinity for samples without data, declare one
// and store another, and round them as text to as few digits as -3.4e38. This function makes them
// one value.
double WithOneLargestValue(double value) {
  constexpr double kTwoDigits = 1e-3;
  return std::abs(value) >= (1.0 - kTwoDigits) * kLargestFloat ? std::copysign(kLargestFloat, value)
                                                               : value;
}

// GDAL returns the nodata value of 64-bit integers by other functions only.
std::optional<double> DeclaredNodata(GDALRasterBand& band) {
  int is_declared = 0;
  double nodata = 0.0;
  switch (band.GetRasterDataType()) {
    case GDT_Int64:
      nodata = static_cast<double>(band.GetNoDataValueAsInt64(&is_declared));
      break;
    case GDT_UInt64:
      nodata = static_cast<double>(band.GetNoDataValueAsUInt64(&is_declared));
      break;
    default:
      nodata = band.GetNoDataValue(&is_declared);
  }
  if (is_declared == 0) return std::nullopt;
  if (band.GetRasterDataType() == GDT_Float32 && std::abs(nodata) < kLargestFloat)
    nodata = static_cast<double>(static_cast<float>(nodata));
  return nodata;
}

std::string EnvironmentText(const char* name) {
  const char* value = std::getenv(name);
  return fmt::format("{}={}", name, value == nullptr ? "" : value);
}

bool ReportsScale(GDALRasterBand& band) {
  int has_scale = 0, has_offset = 0;
  band.GetScale(&has_scale);
  band.GetOffset(&has_offset);
  return has_scale != 0 || has_offset != 0;
}

/// While an object of this class exists, GDAL ignores sidecars in this thread.
class WithoutSidecars {
 public:
  WithoutSidecars() { CPLSetThreadLocalConfigOption(kOption, "NO"); }
  ~WithoutSidecars() {
    CPLSetThreadLocalConfigOption(kOption, before_ ? before_->c_str() : nullptr);
  }
  WithoutSidecars(const WithoutSidecars&) = delete;
  WithoutSidecars& operator=(const WithoutSidecars&) = delete;

 private:
  static constexpr const char* kOption = "GDAL_PAM_ENABLED";
  static std::optional<std::string> Now() {
    const char* value = CPLGetThreadLocalConfigOption(kOption, nullptr);
    return value == nullptr ? std::nullopt : std::optional<std::string>(value);
  }
  std::optional<std::string> before_ = Now();
};

struct DestroyXml {
  void operator()(CPLXMLNode* node) const { CPLDestroyXMLNode(node); }
};

/// Returns whether a band has a scale or an offset in the sidecar (.aux.xml) of its file.
bool SidecarDeclaresScale(const std::filesystem::path& file, int band) {
  const std::string sidecar = file.string() + ".aux.xml";
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(sidecar, ignored)) return false;
  const std::unique_ptr<CPLXMLNode, DestroyXml> parsed(CPLParseXMLFile(sidecar.c_str()));
  const CPLXMLNode* root = parsed ? CPLGetXMLNode(parsed.get(), "=PAMDataset") : nullptr;
  for (const CPLXMLNode* node = root ? root->psChild : nullptr; node; node = node->psNext) {
    if (node->eType != CXT_Element || !EQUAL(node->pszValue, "PAMRasterBand")) continue;
    if (std::string_view(CPLGetXMLValue(node, "band", "")) != fmt::format("{}", band)) continue;
    if (CPLGetXMLNode(node, "Scale") != nullptr || CPLGetXMLNode(node, "Offset") != nullptr)
      return true;
  }
  return false;
}

/// Returns whether a file declares that a band has the scale 1 and the offset 0. GDAL reports both
/// as declared if the file has a sidecar for any purpose, such as statistics. The file is therefore
/// asked without its sidecar.
bool DeclaresUnitScale(const std::filesystem::path& file, GDALRasterBand& band) {
  if (!ReportsScale(band)) return false;
  if (SidecarDeclaresScale(file, band.GetBand())) return true;
  const WithoutSidecars without_sidecars;
  const RasterFile alone(static_cast<GDALDataset*>(
      GDALOpenEx(file.c_str(), GDAL_OF_RASTER, nullptr, nullptr, nullptr)));
  return alone && ReportsScale(*alone->GetRasterBand(band.GetBand()));
}

}  // namespace

std::string LastGdalError() {
  std::string text = CPLGetLastErrorMsg();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.empty() ? "no reason given" : text;
}

RasterFile OpenRaster(const std::filesystem::path& file, const RasterFormats& formats) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) RefuseFile(file, "there is no such file");
  RasterFile dataset(static_cast<GDALDataset*>(GDALOpenEx(
      file.c_str(), GDAL_OF_RASTER | GDAL_OF_VERBOSE_ERROR, formats.drivers, nullptr, nullptr)));
  if (dataset) return dataset;
  const std::string reason = LastGdalError();
  const std::optional<FileFormat> format = FormatOfFile(file);
  const bool is_wanted =
      GDALIdentifyDriverEx(file.c_str(), GDAL_OF_RASTER, formats.drivers, nullptr) != nullptr;
  if (format && !is_wanted)
    RefuseFormat(file, *format, fmt::format("{} are read as {}", formats.purpose, formats.names));
  RefuseFile(file, fmt::format("not a readable {} ({})", formats.names, reason));
}

std::string FaultOfProj() {
  CPLErrorReset();
  constexpr int kWgs84 = 4326;
  OGRSpatialReference known;
  if (known.importFromEPSG(kWgs84) == OGRERR_NONE) return "";
  return fmt::format("PROJ finds no usable proj.db ({}, {}): {}", EnvironmentText("PROJ_DATA"),
                     EnvironmentText("PROJ_LIB"), LastGdalError());
}

OGRSpatialReference CrsOfTheEarth(const std::filesystem::path& file, GDALDataset& dataset) {
  const OGRSpatialReference* stored = dataset.GetSpatialRef();
  const bool is_known = stored != nullptr && (stored->IsGeographic() || stored->IsProjected());
  if (!is_known) {
    if (const std::string fault = FaultOfProj(); !fault.empty()) RefuseFile(file, fault);
  }
  if (stored == nullptr || stored->IsEmpty()) RefuseFile(file, "has no coordinate system");
  if (!is_known)
    RefuseFile(file, "has a coordinate system that is neither geographic nor projected");
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

BandValues::BandValues(const std::filesystem::path& file, GDALRasterBand& band)
    : band_(band),
      scale_(band.GetScale()),
      offset_(band.GetOffset()),
      has_scale_(scale_ != 1.0 || offset_ != 0.0 || DeclaresUnitScale(file, band)),
      nodata_(DeclaredNodata(band)) {
  // GDAL up to 3.6 reads signed bytes as unsigned ones and declares them by this item.
  const char* type = band.GetMetadataItem("PIXELTYPE", "IMAGE_STRUCTURE");
  has_signed_bytes_ = type != nullptr && std::string_view(type) == "SIGNEDBYTE";
  if (scale_ == 0.0 || !std::isfinite(scale_) || !std::isfinite(offset_)) {
    RefuseFile(file, fmt::format("declares scale {} and offset {}; both must be finite, and the "
                                 "scale other than 0",
                                 scale_, offset_));
  }
}

std::optional<std::vector<double>> BandValues::Read(const PixelWindow& window) const {
  std::vector<double> stored(static_cast<std::size_t>(window.columns) *
                             static_cast<std::size_t>(window.rows));
  if (band_.RasterIO(GF_Read, window.column, window.row, window.columns, window.rows, stored.data(),
                     window.columns, window.rows, GDT_Float64, 0, 0, nullptr) != CE_None) {
    return std::nullopt;
  }
  if (has_signed_bytes_) {
    for (double& sample : stored) sample -= sample > 127.0 ? 256.0 : 0.0;
  }
  return stored;
}

bool BandValues::IsNodata(double stored) const {
  if (std::isnan(stored)) return true;
  if (!nodata_) return false;
  const double nodata = WithOneLargestValue(*nodata_), sample = WithOneLargestValue(stored);
  return sample == nodata || (std::abs(nodata) > kBeyondAllValues &&
                              std::abs(sample - nodata) <= kRoundingOfText * std::abs(nodata));
}

}  // namespace alpenglow::renderer
