// SPDX-License-Identifier: MIT
#include "renderer/elevation/geographic_grid.h"

#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "atmosphere/base/error.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
// Largest distance [samples] of a sample from the ideal grid at which it is still copied without
// resampling.
constexpr double kOnGrid = 1e-3;
// Every 4th sample of a row is transformed exactly, the others linearly between: on a map of radius
// R samples around a pole the row bends by 4^2 / (8 R), elsewhere by far less.
constexpr int kTransformStride = 4;

struct DestroyTransformation {
  void operator()(OGRCoordinateTransformation* transformation) const {
    OGRCoordinateTransformation::DestroyCT(transformation);
  }
};
using Transformation = std::unique_ptr<OGRCoordinateTransformation, DestroyTransformation>;

OGRSpatialReference Wgs84Degrees() {
  OGRSpatialReference wgs84;
  wgs84.SetWellKnownGeogCS("WGS84");
  wgs84.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return wgs84;
}

// Returns the horizontal part only: heights are interpreted as above the ellipsoid, whatever the
// vertical system.
OGRSpatialReference Horizontal(const OGRSpatialReference& crs) {
  OGRSpatialReference horizontal = crs;
  horizontal.StripVertical();
  horizontal.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return horizontal;
}

Transformation MakeTransformation(const OGRSpatialReference& from, const OGRSpatialReference& to,
                                  const std::string& file) {
  Transformation made(OGRCreateCoordinateTransformation(&from, &to));
  if (!made) {
    const std::string fault = FaultOfProj();
    RefuseFile(file, fault.empty()
                         ? "no transformation between its coordinate system and WGS84 is known"
                         : fault);
  }
  return made;
}

struct LonLat {  // degrees
  double lon;
  double lat;
};

// Returns the copy of a longitude that is nearest to another one [degrees].
double Unwrap(double lon, double near) { return lon - 360.0 * std::round((lon - near) / 360.0); }

class Footprint {
 public:
  Footprint(const ElevationRaster& raster, const std::string& file)
      : raster_(raster),
        file_(file),
        wgs84_from_file_(MakeTransformation(Horizontal(raster.crs), Wgs84Degrees(), file)),
        geographic_(raster.crs.IsGeographic()) {}

  // Returns the position of a sample. Longitudes of a geographic file may run over 180 degrees and
  // are kept.
  [[nodiscard]] LonLat At(double row, double column) const {
    double x = raster_.CentreX(column);
    double y = raster_.CentreY(row);
    if (geographic_) CheckAngles(x, y);
    const double file_lon = x;
    if (!wgs84_from_file_->Transform(1, &x, &y) || !std::isfinite(x) || !std::isfinite(y)) {
      throw InputError(
          fmt::format("{}: row {}, column {} is not a place on the earth", file_, row, column));
    }
    return {geographic_ ? Unwrap(x, file_lon * raster_.crs.GetAngularUnits() / kDegree) : x, y};
  }

 private:
  void CheckAngles(double lon, double lat) const {
    const double unit_deg = raster_.crs.GetAngularUnits() / kDegree;
    if (!(std::abs(lat * unit_deg) <= 90.0 + 1e-9)) {
      throw InputError(fmt::format("{}: has a sample at latitude {}; it must lie in [-90, 90]",
                                   file_, lat * unit_deg));
    }
    if (!(std::abs(lon * unit_deg) <= 720.0)) {
      throw InputError(fmt::format("{}: has a sample at longitude {}; it must lie in [-720, 720]",
                                   file_, lon * unit_deg));
    }
  }

  const ElevationRaster& raster_;
  const std::string& file_;
  Transformation wgs84_from_file_;
  bool geographic_;
};

// Corner sample and steps, in degrees; rows may run north or south.
struct RegularGrid {
  LonLat first;
  double step_lon;
  double step_lat;
};

// Returns the grid that the corners span.
RegularGrid SpannedGrid(const Footprint& footprint, const ElevationRaster& raster) {
  const LonLat first = footprint.At(0, 0);
  const LonLat last = footprint.At(raster.rows - 1, raster.columns - 1);
  return {first, (last.lon - first.lon) / (raster.columns - 1),
          (last.lat - first.lat) / (raster.rows - 1)};
}

// Returns whether the samples lie on that grid, checked on a lattice over the raster.
bool LiesOn(const RegularGrid& grid, const Footprint& footprint, const ElevationRaster& raster) {
  constexpr int kLattice = 8;
  if (grid.step_lon == 0.0 || grid.step_lat == 0.0) return false;
  for (int i = 0; i <= kLattice; ++i) {
    for (int j = 0; j <= kLattice; ++j) {
      const double row = (raster.rows - 1.0) * i / kLattice;
      const double column = (raster.columns - 1.0) * j / kLattice;
      const LonLat place = footprint.At(row, column);
      const double off_column = (place.lon - grid.first.lon) / grid.step_lon - column;
      const double off_row = (place.lat - grid.first.lat) / grid.step_lat - row;
      if (!(std::abs(off_column) < kOnGrid && std::abs(off_row) < kOnGrid)) return false;
    }
  }
  return true;
}

// Returns a grid without heights.
ElevationGrid BareGrid(double west_deg, double north_deg, double step_lon_deg, double step_lat_deg,
                       int columns, int rows) {
  ElevationGrid grid;
  grid.west_rad = west_deg * kDegree;
  grid.north_rad = std::min(north_deg, 90.0) * kDegree;
  grid.step_lon_rad = step_lon_deg * kDegree;
  grid.step_lat_rad = step_lat_deg * kDegree;
  grid.columns = columns;
  grid.rows = rows;
  return grid;
}

void OpenHeights(ElevationGrid& grid) {
  grid.height_m.resize(grid.index(grid.rows, 0), std::numeric_limits<float>::quiet_NaN());
}

// Returns the samples' own grid, running eastwards and southwards, without heights.
ElevationGrid BareGridOf(const RegularGrid& from, const ElevationRaster& raster) {
  const double north =
      from.first.lat + (from.step_lat > 0.0 ? (raster.rows - 1) * from.step_lat : 0.0);
  const double west =
      from.first.lon + (from.step_lon < 0.0 ? (raster.columns - 1) * from.step_lon : 0.0);
  return BareGrid(west, north, std::abs(from.step_lon), std::abs(from.step_lat), raster.columns,
                  raster.rows);
}

// Copies the samples, mirrored if the file runs south to north or east to west.
ElevationGrid TakeOver(const RegularGrid& from, const ElevationRaster& raster) {
  const bool south_up = from.step_lat > 0.0;
  const bool east_first = from.step_lon < 0.0;
  ElevationGrid grid = BareGridOf(from, raster);
  OpenHeights(grid);
  for (int row = 0; row < raster.rows; ++row) {
    for (int column = 0; column < raster.columns; ++column) {
      const int source_row = south_up ? raster.rows - 1 - row : row;
      const int source_column = east_first ? raster.columns - 1 - column : column;
      grid.height_m[grid.index(row, column)] =
          raster.height_m[static_cast<std::size_t>(source_row) *
                              static_cast<std::size_t>(raster.columns) +
                          static_cast<std::size_t>(source_column)];
    }
  }
  return grid;
}

struct Bounds {  // degrees
  double west, east, south, north;
};

// Returns the bounds of the samples. The extremes of a projection lie on the rim, unless it
// contains a pole.
Bounds BoundsOf(const Footprint& footprint, const ElevationRaster& raster) {
  constexpr int kPieces = 64;
  const LonLat centre = footprint.At(0.5 * (raster.rows - 1), 0.5 * (raster.columns - 1));
  Bounds bounds{centre.lon, centre.lon, centre.lat, centre.lat};
  for (int i = 0; i <= kPieces; ++i) {
    const double row = (raster.rows - 1.0) * i / kPieces;
    const double column = (raster.columns - 1.0) * i / kPieces;
    for (const LonLat& place : {footprint.At(row, 0), footprint.At(row, raster.columns - 1),
                                footprint.At(0, column), footprint.At(raster.rows - 1, column)}) {
      const double lon = Unwrap(place.lon, centre.lon);
      bounds = {std::min(bounds.west, lon), std::max(bounds.east, lon),
                std::min(bounds.south, place.lat), std::max(bounds.north, place.lat)};
    }
  }
  return bounds;
}

// Returns the smaller ground distance [degrees of latitude] between neighbours at the raster's
// centre.
double GroundStep(const Footprint& footprint, const ElevationRaster& raster) {
  const double row = 0.5 * (raster.rows - 1);
  const double column = 0.5 * (raster.columns - 1);
  const LonLat centre = footprint.At(row, column);
  const auto length = [&](const LonLat& to) {
    return std::hypot((Unwrap(to.lon, centre.lon) - centre.lon) * std::cos(centre.lat * kDegree),
                      to.lat - centre.lat);
  };
  return 2.0 *
         std::min(length(footprint.At(row + 0.5, column)), length(footprint.At(row, column + 0.5)));
}

float Mix(float from, float to, double fraction) {
  if (fraction == 0.0) return from;  // the other value may be a void
  return static_cast<float>((1.0 - fraction) * static_cast<double>(from) +
                            fraction * static_cast<double>(to));
}

// Returns the bilinear value; NaN outside the samples and beside a void.
float SampleAt(const ElevationRaster& raster, double row, double column) {
  if (!(row >= 0.0 && column >= 0.0 && row <= raster.rows - 1 && column <= raster.columns - 1)) {
    return std::numeric_limits<float>::quiet_NaN();
  }
  const int r = std::min(static_cast<int>(row), raster.rows - 2);
  const int c = std::min(static_cast<int>(column), raster.columns - 2);
  const auto at = [&](int dr, int dc) {
    return raster
        .height_m[static_cast<std::size_t>(r + dr) * static_cast<std::size_t>(raster.columns) +
                  static_cast<std::size_t>(c + dc)];
  };
  return Mix(Mix(at(0, 0), at(0, 1), column - c), Mix(at(1, 0), at(1, 1), column - c), row - r);
}

// Pixel coordinates in the raster for the samples of one row of a grid.
class SourceCoordinates {
 public:
  SourceCoordinates(const ElevationRaster& raster, const std::string& file)
      : raster_(raster),
        file_from_wgs84_(MakeTransformation(Wgs84Degrees(), Horizontal(raster.crs), file)) {}

  // Returns whether a place lies between the raster's samples.
  [[nodiscard]] bool Holds(double lon_deg, double lat_deg) {
    double x = lon_deg;
    double y = lat_deg;
    if (!file_from_wgs84_->Transform(1, &x, &y)) return false;
    const double row = Row(y);
    const double column = Column(x);
    return row > 0.0 && column > 0.0 && row < raster_.rows - 1 && column < raster_.columns - 1;
  }

  void ResampleRow(ElevationGrid& grid, int row) {
    TransformNodes(grid, row);
    for (int column = 0; column < grid.columns; ++column) {
      const auto node = static_cast<std::size_t>(column / kTransformStride);
      const double t = (column % kTransformStride) / static_cast<double>(kTransformStride);
      const double x = (1.0 - t) * x_[node] + t * x_[node + 1];
      const double y = (1.0 - t) * y_[node] + t * y_[node + 1];
      grid.height_m[grid.index(row, column)] = SampleAt(raster_, Row(y), Column(x));
    }
  }

 private:
  [[nodiscard]] double Row(double y) const {
    return (y - raster_.geotransform[3]) / raster_.geotransform[5] - 0.5;
  }
  [[nodiscard]] double Column(double x) const {
    return (x - raster_.geotransform[0]) / raster_.geotransform[1] - 0.5;
  }
  void TransformNodes(const ElevationGrid& grid, int row) {
    const int nodes = grid.columns / kTransformStride + 2;
    x_.clear();
    for (int node = 0; node < nodes; ++node) {
      x_.push_back(grid.LongitudeOfColumn(node * kTransformStride) / kDegree);
    }
    y_.assign(x_.size(), grid.LatitudeOfRow(row) / kDegree);
    std::vector<int> fine(x_.size());
    file_from_wgs84_->Transform(nodes, x_.data(), y_.data(), nullptr, fine.data());
    for (std::size_t node = 0; node < fine.size(); ++node) {
      if (fine[node] == 0) x_[node] = std::numeric_limits<double>::quiet_NaN();
    }
  }

  const ElevationRaster& raster_;
  Transformation file_from_wgs84_;
  std::vector<double> x_, y_;
};

// Returns a grid over the bounds with about `step` [degrees of latitude] between neighbours. If it
// contains a pole, the columns go once around and the first row lies half a step from the pole.
ElevationGrid GridOver(const Bounds& bounds, double step, bool north_pole, bool south_pole,
                       const std::string& file) {
  const bool closed = north_pole || south_pole;
  const double nearest_equator = bounds.south < 0.0 && bounds.north > 0.0
                                     ? 0.0
                                     : std::min(std::abs(bounds.south), std::abs(bounds.north));
  const double wide = closed ? 360.0 : bounds.east - bounds.west;
  const double high = (north_pole ? 90.0 - 0.5 * step : bounds.north) -
                      (south_pole ? -90.0 + 0.5 * step : bounds.south);
  const double columns =
      std::ceil(wide * std::cos(nearest_equator * kDegree) / step) + (closed ? 0.0 : 1.0);
  const double rows = std::ceil(high / step) + 1.0;
  if (!(columns * rows <= static_cast<double>(kMostElevationSamples))) {
    throw InputError(
        fmt::format("{}: covers {} to {} degrees east and {} to {} degrees north, "
                    "which takes {} samples; at most {} can be held",
                    file, bounds.west, bounds.east, bounds.south, bounds.north, columns * rows,
                    kMostElevationSamples));
  }
  const double columns_used = std::max(columns, 2.0);
  const double rows_used = std::max(rows, 2.0);
  const double north = north_pole ? 90.0 - 0.5 * step : bounds.north;
  return BareGrid(bounds.west, north, wide / (closed ? columns_used : columns_used - 1.0),
                  high / (rows_used - 1.0), static_cast<int>(columns_used),
                  static_cast<int>(rows_used));
}

ElevationGrid BareGridAround(const Footprint& footprint, const ElevationRaster& raster,
                             SourceCoordinates& source, const std::string& file) {
  return GridOver(BoundsOf(footprint, raster), GroundStep(footprint, raster),
                  source.Holds(0.0, 90.0), source.Holds(0.0, -90.0), file);
}

ElevationGrid Resample(const Footprint& footprint, const ElevationRaster& raster,
                       const std::string& file) {
  SourceCoordinates source(raster, file);
  ElevationGrid grid = BareGridAround(footprint, raster, source, file);
  OpenHeights(grid);
  for (int row = 0; row < grid.rows; ++row) source.ResampleRow(grid, row);
  return grid;
}

}  // namespace

ElevationGrid GeographicGrid(const ElevationRaster& raster, const std::string& file) {
  const Footprint footprint(raster, file);
  const RegularGrid spanned = SpannedGrid(footprint, raster);
  if (LiesOn(spanned, footprint, raster)) return TakeOver(spanned, raster);
  return Resample(footprint, raster, file);
}

std::optional<PixelWindow> PixelsOf(const ElevationRaster& raster, const GridWindow& window,
                                    const std::string& file) {
  const Footprint footprint(raster, file);
  const RegularGrid spanned = SpannedGrid(footprint, raster);
  // A window whose columns run west would have to be mirrored.
  if (!LiesOn(spanned, footprint, raster) || spanned.step_lon < 0.0) return std::nullopt;
  const int row =
      spanned.step_lat > 0.0 ? raster.rows - window.first_row - window.rows : window.first_row;
  return PixelWindow{window.first_column, row, window.columns, window.rows};
}

ElevationGrid GeographicExtent(const ElevationRaster& raster, const std::string& file) {
  const Footprint footprint(raster, file);
  const RegularGrid spanned = SpannedGrid(footprint, raster);
  if (LiesOn(spanned, footprint, raster)) return BareGridOf(spanned, raster);
  SourceCoordinates source(raster, file);
  return BareGridAround(footprint, raster, source, file);
}

}  // namespace alpenglow::renderer
