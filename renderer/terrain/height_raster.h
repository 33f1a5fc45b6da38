// SPDX-License-Identifier: MIT
// Heights of a mesh on a regular grid of its own frame.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "renderer/terrain/mesh.h"

namespace alpenglow::renderer {

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
