// SPDX-License-Identifier: MIT
// Rasters that GDAL reads: opening a file of a known format, and the values that its samples stand
// for. What a file declares (nodata value, scale, offset, sign) is applied; nothing is guessed.
#pragma once

#include <cpl_error.h>
#include <gdal_priv.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace alpenglow::renderer {

/// While an object of this class exists, GDAL stores its messages (CPLGetLastErrorMsg) instead of
/// printing them.
class QuietGdal {
 public:
  QuietGdal() {
    CPLPushErrorHandler(CPLQuietErrorHandler);
    CPLErrorReset();
  }
  ~QuietGdal() { CPLPopErrorHandler(); }
  QuietGdal(const QuietGdal&) = delete;
  QuietGdal& operator=(const QuietGdal&) = delete;
};

struct CloseDataset {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using RasterFile = std::unique_ptr<GDALDataset, CloseDataset>;

struct RasterFormats {
  const char* names;           // "GeoTIFF or PNG"
  const char* const* drivers;  // of GDAL, ending with null; they must be registered
  const char* purpose;         // "pictures on terrain", for messages
};

/// Opens a file; throws InputError if it is none, or in another format, which the message names.
[[nodiscard]] RasterFile OpenRaster(const std::filesystem::path& file,
                                    const RasterFormats& formats);

/// Returns GDAL's last message on one line.
[[nodiscard]] std::string LastGdalError();

/// Returns why PROJ knows no coordinate systems (its database is missing or of another version);
/// empty if it knows them. It must be called when a coordinate system cannot be used, because GDAL
/// reports another reason or none.
[[nodiscard]] std::string FaultOfProj();

/// Returns the coordinate system of a file on a map of the earth, with x to the east and y to the
/// north. Throws InputError if the file has none, or one that is neither geographic nor projected,
/// or one of another body.
[[nodiscard]] OGRSpatialReference CrsOfTheEarth(const std::filesystem::path& file,
                                                GDALDataset& dataset);

/// A part of the pixels of a file.
struct PixelWindow {
  int column = 0, row = 0;
  int columns = 0, rows = 0;
};

/// The values of a band as its file declares them.
class BandValues {
 public:
  /// Throws InputError for a scale of 0 and for a scale or offset that is not finite.
  BandValues(const std::filesystem::path& file, GDALRasterBand& band);

  /// Returns the stored samples of a window, row by row; nullopt if the file is damaged.
  [[nodiscard]] std::optional<std::vector<double>> Read(const PixelWindow& window) const;
  /// Returns whether a stored sample is NaN or the declared nodata value.
  [[nodiscard]] bool IsNodata(double stored) const;
  /// Returns stored * scale + offset.
  [[nodiscard]] double Value(double stored) const { return stored * scale_ + offset_; }

  [[nodiscard]] const std::optional<double>& nodata() const { return nodata_; }
  /// Returns whether the file declares a scale or an offset, also of 1 and 0.
  [[nodiscard]] bool HasScale() const { return has_scale_; }

 private:
  GDALRasterBand& band_;
  bool has_signed_bytes_;
  double scale_, offset_;
  bool has_scale_;
  std::optional<double> nodata_;
};

}  // namespace alpenglow::renderer
