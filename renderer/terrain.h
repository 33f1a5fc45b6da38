// SPDX-License-Identifier: MIT
// The ground as triangles in a local frame, and rays against it.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "atmosphere/geodesy.h"

namespace alpenglow {

/// Heights over a regular grid of geodetic coordinates. Row 0 is the northernmost.
struct ElevationGrid {
  double west_rad = 0.0;   // longitude of column 0
  double north_rad = 0.0;  // latitude of row 0
  double step_lon_rad = 0.0;
  double step_lat_rad = 0.0;  // positive: rows go south
  int columns = 0;
  int rows = 0;
  std::vector<float> height_m;  // rows x columns; NaN where there is no ground (a void left open)

  [[nodiscard]] float at(int row, int column) const {
    return height_m[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                    static_cast<std::size_t>(column)];
  }
  /// Bilinear height [m] at a place; nothing outside the grid or beside a void.
  [[nodiscard]] std::optional<double> HeightAt(double latitude_rad, double longitude_rad) const;
};

enum class VoidPolicy { kFill, kLeaveOpen };

struct ElevationModel {
  ElevationGrid grid;
  std::size_t voids = 0;         // samples without data in the file
  std::size_t voids_filled = 0;  // of which were filled from their surroundings
};

/// Reads a digital elevation model: GeoTIFF, SRTM .hgt, USGS DEM; any coordinate system of the
/// earth (resampled to geographic WGS84), metres or feet. Heights are taken as above the ellipsoid.
/// Throws InputError naming the file and the fault for no or a foreign coordinate system, a rotated
/// or missing geotransform, several bands, complex samples, latitudes over 90, one row or column,
/// no valid sample, heights that no ground on earth has, damaged or truncated files.
[[nodiscard]] ElevationModel ReadElevation(const std::filesystem::path& file, VoidPolicy voids);

/// A mountain range that needs no file: generated, eroded, the same on every machine, centred on a
/// place.
[[nodiscard]] ElevationGrid BuiltInRange(const GeodeticPosition& centre);

/// Triangles in the ENU frame of a LocalFrame [m], single precision.
struct TriangleMesh {
  std::vector<std::array<float, 3>> positions;
  std::vector<std::array<float, 3>> normals;  // unit, one a position
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Every sample becomes a vertex, placed through ECEF, so curvature and ellipsoid are right.
[[nodiscard]] TriangleMesh MeshFromElevation(const ElevationGrid& grid, const LocalFrame& frame);

/// Reads a Wavefront OBJ whose coordinates are ENU metres around `frame`'s origin. Throws
/// InputError for no triangles, degenerate or non-finite ones, indices out of range.
[[nodiscard]] TriangleMesh ReadObj(const std::filesystem::path& file);

struct TerrainHit {
  double distance_m;
  glm::dvec3 normal;  // unit, interpolated, towards the sky
};

/// Triangles ready for rays (Embree). Immutable; safe to ask from many threads.
class Terrain {
 public:
  explicit Terrain(TriangleMesh mesh);
  ~Terrain();
  Terrain(Terrain&&) noexcept;
  Terrain& operator=(Terrain&&) noexcept;

  /// Nearest hit. Origin and direction in the mesh's frame; throws InternalError unless all finite.
  [[nodiscard]] std::optional<TerrainHit> Intersect(const glm::dvec3& origin,
                                                    const glm::dvec3& direction) const;
  /// Whether anything stands within (0, length_m) of the ray; the origin is moved off the surface
  /// along `normal` by the error bound of the hit point.
  [[nodiscard]] bool Occluded(const glm::dvec3& origin, const glm::dvec3& normal,
                              const glm::dvec3& direction, double length_m) const;

  [[nodiscard]] const TriangleMesh& mesh() const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace alpenglow
