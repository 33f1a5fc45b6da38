// SPDX-License-Identifier: MIT
// Which way four samples are cut into two triangles, and the height on these.
//
// A normal for each vertex: the mean of the normals of its triangles, weighted by their areas.
//
// The ground as triangles in a local frame.
//
// Heights of a mesh on a regular grid of its own frame.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "atmosphere/sun/geodesy.h"
#include "renderer/layer.h"
#include "renderer/terrain/elevation.h"

namespace alpenglow::renderer {

/// The axis of a mesh's file that points up. Wavefront OBJ has no rule.
enum class UpAxis {
  kZ,  // x east, y north, z up
  kY,  // x east, y up, z south
};

/// Heights [m] of the 4 x 4 samples around a cell, row by row from the north-west. The cell's own
/// corners are 5 (north-west), 6, 9 and 10 (south-east).
using CellHeights = std::array<double, 16>;

/// Whether the middle of the diagonal from north-west to south-east is nearer than the other's to
/// the cubic height at the cell's centre; beside a void: false.
[[nodiscard]] inline bool FallingDiagonalFits(const CellHeights& around) {
  constexpr std::array<double, 4> kWeight{-1.0 / 16.0, 9.0 / 16.0, 9.0 / 16.0, -1.0 / 16.0};
  double centre = 0.0;
  for (std::size_t i = 0; i < around.size(); ++i)
    centre += kWeight[i / 4] * kWeight[i % 4] * around[i];
  const double falling = 0.5 * (around[5] + around[10]);
  const double rising = 0.5 * (around[9] + around[6]);
  return std::abs(falling - centre) < std::abs(rising - centre);
}

/// Height [m] on the triangle over a place in the cell, `east` and `south` of its north-west corner
/// as shares of the cell; nothing beside a void.
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

/// Unit normals, one a position; (0, 0, 1) where a position belongs to no triangle.
[[nodiscard]] std::vector<std::array<float, 3>> SmoothNormals(
    const std::vector<glm::dvec3>& positions,
    const std::vector<std::array<std::uint32_t, 3>>& triangles);

/// Triangles in the ENU frame of a LocalFrame [m], single precision: a position 100 km from the
/// origin is rounded by up to 4 mm a coordinate.
struct TriangleMesh {
  std::vector<std::array<float, 3>> positions;
  std::vector<std::array<float, 3>> normals;            // unit, one a position
  std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise seen from outside
};

/// A position or a normal of a mesh in double precision.
[[nodiscard]] inline glm::dvec3 ToDouble(const std::array<float, 3>& v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

/// Every sample becomes a vertex, placed through ECEF, so curvature and
/// ellipsoid are right. Beside a void triangles are left out. A grid
/// that goes once around the earth is closed, and over a pole too.
[[nodiscard]] TriangleMesh MeshFromElevation(const ElevationGrid& grid, const LocalFrame& frame);

/// Heights z [m] over (x, y) = (first_x_m + column cell_m, first_y_m + row cell_m).
struct HeightRaster {
  double first_x_m = 0.0, first_y_m = 0.0;
  double cell_m = 0.0;
  int columns = 0, rows = 0;
  std::vector<float> z_m;  // rows x columns; kNothing where no ground is

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

/// The cell of a grid that a place lies in, moved into the grid, and where.
struct GridCell {
  int column, row;  // the lower corner
  float x, y;       // in [0, 1]
};
[[nodiscard]] GridCell CellAt(const HeightRaster& raster, double x_m, double y_m);

/// The uppermost surface of a mesh, at most `most_nodes` >= 4 nodes
/// and none finer than the mesh itself (of a few large triangles:
/// than a 512th of its extent). The same for any number of threads.
[[nodiscard]] HeightRaster RasterOf(const TriangleMesh& mesh, std::size_t most_nodes);

}  // namespace alpenglow::renderer
