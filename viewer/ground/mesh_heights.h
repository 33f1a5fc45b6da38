// SPDX-License-Identifier: MIT
// Heights of a mesh that is one surface, quickly: the triangles over each cell of a grid.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "renderer/terrain/mesh.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// Immutable; safe to ask from many threads. Refers to the mesh.
class MeshHeights {
 public:
  explicit MeshHeights(const TriangleMesh& mesh);

  /// z [m] of the triangle over a place, to the rounding of its corners; nothing beside the mesh.
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
  std::vector<std::uint32_t> first_;      // of a cell's triangles; one more than cells
  std::vector<std::uint32_t> triangles_;  // cell by cell
};

}  // namespace alpenglow::viewer
