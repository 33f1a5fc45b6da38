// SPDX-License-Identifier: MIT
// This header provides the ground as triangles in a local frame. It contains the split of four
// samples into two triangles and the height on these, normals for each vertex (means of the normals
// of its triangles, weighted by their areas), heights of a mesh on a regular grid in the mesh's
// frame, and MeshHeights, fast heights of a mesh that is one surface. ReadMesh reads a mesh from a
// file.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/time_place/geodesy.h"
#include "renderer/elevation/elevation.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Axis of a mesh's file that points up. Wavefront OBJ does not specify it.
enum class UpAxis {
  kZ,  // x east, y north, z up
  kY,  // x east, y up, z south
};

/// Heights [m] of the 4 x 4 samples around a cell, row by row from the north-west. The cell's own
/// corners are 5 (north-west), 6, 9 and 10 (south-east).
using CellHeights = std::array<double, 16>;

/// Returns whether the middle of the diagonal from north-west to south-east is nearer to the cubic
/// height at the cell's centre than the middle of the other diagonal; false beside a void.
[[nodiscard]] inline bool FallingDiagonalFits(const CellHeights& around) {
  constexpr std::array<double, 4> kWeight{-1.0 / 16.0, 9.0 / 16.0, 9.0 / 16.0, -1.0 / 16.0};
  double centre = 0.0;
  for (std::size_t i = 0; i < around.size(); ++i)
    centre += kWeight[i / 4] * kWeight[i % 4] * around[i];
  const double falling = 0.5 * (around[5] + around[10]);
  const double rising = 0.5 * (around[9] + around[6]);
  return std::abs(falling - centre) < std::abs(rising - centre);
}

/// Returns the height [m] on the triangle over a place in the cell, `east` and `south` of its
/// north-west corner as fractions of the cell; nullopt beside a void.
[[nodiscard]] inline std::optional<double> HeightOnTriangles(const CellHeights& around, double east,
                                                             double south) {
  const double nw = around[5], ne = around[6], sw = around[9], se = around[10];
  const bool void_off_falling = std::isnan(ne) || std::isnan(sw);
  const bool void_off_rising = std::isnan(nw) || std::isnan(se);
  const bool falling = void_off_falling || (!void_off_rising && FallingDiagonalFits(around));
  double height = 0.0;
  if (falling) {
    height = east > south ? nw + east * (ne - nw) + south * (se - ne)
                          : nw + south * (sw - nw) + east * (se - sw);
  } else {
    height = east + south < 1.0 ? nw + east * (ne - nw) + south * (sw - nw)
                                : se + (1.0 - east) * (sw - se) + (1.0 - south) * (ne - se);
  }
  if (std::isnan(height)) return std::nullopt;
  return height;
}

/// Returns unit normals, one per position; (0, 0, 1) if a position belongs to no triangle.
[[nodiscard]] std::vector<std::array<float, 3>> SmoothNormals(
    const std::vector<glm::dvec3>& positions,
    const std::vector<std::array<std::uint32_t, 3>>& triangles);

/// Triangles in the ENU frame of a LocalFrame [m], single precision: a position 100 km from the
/// origin is rounded by up to 4 mm per coordinate.
struct TriangleMesh {
  std::vector<std::array<float, 3>> positions;
  std::vector<std::array<float, 3>> normals;            // unit, one per position
  std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise seen from outside
};

/// A mesh that was read from a file.
struct MeshModel {
  TriangleMesh mesh;
  std::string message;  // one line on parts of the file that the mesh omits; empty: none
};

/// Reads a file whose coordinates are metres from the place of the scene. Its extension determines
/// its format, and a file with an unknown extension is read as Wavefront OBJ (ReadObj). Throws
/// InputError, naming the file, if it cannot be read or has no triangles.
[[nodiscard]] MeshModel ReadMesh(const std::filesystem::path& file, UpAxis up);

/// Converts a position or a normal of a mesh to double precision.
[[nodiscard]] inline glm::dvec3 ToDouble(const std::array<float, 3>& v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

/// Makes a mesh of a grid. Every sample becomes a vertex, placed through ECEF, so that curvature
/// and ellipsoid are correct. Triangles beside a void are omitted. A grid that goes once around the
/// earth is closed, also over a pole.
[[nodiscard]] TriangleMesh MeshFromElevation(const ElevationGrid& grid, const LocalFrame& frame);

/// Heights z [m] over (x, y) = (first_x_m + column cell_m, first_y_m + row cell_m). Cells are
/// squares in the frame of a mesh, which those of an ElevationGrid are not.
struct HeightRaster {
  double first_x_m = 0.0, first_y_m = 0.0;
  double cell_m = 0.0;
  int columns = 0, rows = 0;
  std::vector<float> z_m;  // rows x columns; kNothing where there is no ground

  static constexpr float kNothing = -1e30F;

  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
  [[nodiscard]] float at(int column, int row) const { return z_m[index(column, row)]; }
  [[nodiscard]] std::array<double, 2> Place(int column, int row) const {
    return {first_x_m + column * cell_m, first_y_m + row * cell_m};
  }
};

/// The cell of a grid that contains a place, after the place is clamped to the grid, and the
/// position in the cell.
struct GridCell {
  int column, row;  // the lower corner
  float x, y;       // in [0, 1]
};
[[nodiscard]] GridCell CellAt(const HeightRaster& raster, double x_m, double y_m);

/// Returns the uppermost surface of a mesh, with at most `most_nodes` >= 4 nodes and cells no finer
/// than the mesh itself (for a few large triangles: than a 512th of its extent). The result does
/// not depend on the number of threads.
[[nodiscard]] HeightRaster RasterOf(const TriangleMesh& mesh, std::size_t most_nodes);

/// A rectangle in the frame of the ground, east and north [m].
struct FlatRectangle {
  double west_m, south_m, width_m, depth_m;
};

/// Returns the bounding rectangle of all vertices.
[[nodiscard]] FlatRectangle RectangleOf(const TriangleMesh& mesh);

/// Heights of a mesh on its triangles. It is immutable and can be used by many threads. It refers to
/// the mesh.
class MeshHeights {
 public:
  explicit MeshHeights(const TriangleMesh& mesh);

  /// Returns z [m] of the triangle at a place, to the rounding of its corners; nullopt outside of
  /// the mesh.
  [[nodiscard]] std::optional<double> At(double x_m, double y_m) const;

 private:
  struct Cells {
    std::size_t first_column, last_column, first_row, last_row;
  };
  [[nodiscard]] Cells Under(const std::array<std::uint32_t, 3>& triangle) const;
  template <typename Visit>
  void VisitCells(const Visit& visit) const;

  const TriangleMesh& mesh_;
  double west_m_ = 0.0, south_m_ = 0.0, cell_m_ = 1.0;
  std::size_t columns_ = 0, rows_ = 0;
  std::vector<std::uint32_t> first_;      // first triangle of each cell; one entry more than cells
  std::vector<std::uint32_t> triangles_;  // triangles, cell by cell
};

}  // namespace alpenglow::renderer
