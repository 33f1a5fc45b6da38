// SPDX-License-Identifier: MIT
// The cells of a body on which light of all orders is solved, and the limited body.
//
// The solution by moments needs cells that are not many mean free paths deep: what leaves a body
// comes from its outermost mean free path, which such cells do not resolve. Cells that are too deep
// are given less extinction. The optical depth of a cell, t = extinction x its shortest side, is at
// most kMostDepth and, with t' the depth of a cell beside it (0 outside of the body), at most
//
//   2^(s - 1) max(kOuterDepth, 2 t')     s = distance between both / shortest side
//
// so that the depth of cells doubles from one to the next below a surface. A deep body of this limited
// extinction looks like the true one, because its light depends on albedo and phase function alone.
// Differences remain: light spreads over some cells below a surface instead of some mean free paths,
// so that edges are soft and balls a little flat, and some more light passes through the body.
//
// A ray from the eye passes the true body. The light of higher orders on it is that of the limited
// body at the same optical depth from the eye (VolumeWay).
//
// The axes of cells are those of the body from the longest to the shortest side: tracks of
// cloud_moments.h enter through the plane of the first two and leave flat bodies after few cells.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <utility>
#include <vector>

#include "renderer/cloud_light/cloud_cells.h"
#include "renderer/media/local_body.h"

namespace alpenglow::renderer {

/// A ray from the eye through a body, by the columns of the limited body along it.
class VolumeWay {
 public:
  struct Node {
    double distance_m, column_m;  // increasing; the column is that of the limited body
  };
  VolumeWay(const glm::dvec3& origin, const glm::dvec3& direction, std::vector<Node> nodes)
      : origin_(origin), direction_(direction), nodes_(std::move(nodes)) {}

  /// Returns the point up to which the limited body has a column; the end if it has less.
  [[nodiscard]] glm::dvec3 At(double column_m) const;

 private:
  glm::dvec3 origin_, direction_;
  std::vector<Node> nodes_;
};

/// Immutable; safe to use from many threads. It refers to the body.
class VolumeCells {
 public:
  struct Options {
    double
        thickest_per_m;   // scaled extinction of the thickest band at density 1, for sizes of cells
    double scaled_per_m;  // that of which the depth of cells is limited
    double most_cells;    // of the finest grid in the box of the body, >= 64
  };
  VolumeCells(const LocalBody& volume, const Options& options);

  static constexpr double kOuterDepth = 1.0, kMostDepth = 8.0;

  /// Returns the grids from the coarsest to the finest. The extinction of a cell is the mean density
  /// of the limited body.
  [[nodiscard]] const std::vector<std::shared_ptr<const CloudCells>>& grids() const {
    return grids_;
  }
  /// Returns whether a cell has less extinction than the body.
  [[nodiscard]] bool is_limited() const { return is_limited_; }
  /// Returns a point or a direction of SceneGround's frame in that of the cells, and the reverse.
  [[nodiscard]] glm::dvec3 PointInCells(const glm::dvec3& point) const {
    return (point - middle_) * frame_from_cells_;
  }
  [[nodiscard]] glm::dvec3 DirectionInCells(const glm::dvec3& direction) const {
    return direction * frame_from_cells_;
  }
  [[nodiscard]] glm::dvec3 PointInFrame(const glm::dvec3& in_cells) const {
    return middle_ + frame_from_cells_ * in_cells;
  }
  [[nodiscard]] glm::dvec3 DirectionInFrame(const glm::dvec3& in_cells) const {
    return frame_from_cells_ * in_cells;
  }
  /// Returns the mixture of cells of the finest grid around a point.
  [[nodiscard]] CloudCells::Mixture Around(const glm::dvec3& point) const {
    return grids_.back()->Around(PointInCells(point));
  }

  /// Returns the column of the limited body along a ray [m].
  [[nodiscard]] double Column(const glm::dvec3& origin, const glm::dvec3& direction,
                              double length_m) const;
  /// Returns the way of an eye's ray up to a column of the limited body.
  [[nodiscard]] VolumeWay WayAlong(const glm::dvec3& origin, const glm::dvec3& direction,
                                   double most_column_m) const;
  /// Returns the mean irradiance of a beam in every full cell of a grid, for unit irradiance before
  /// the body. All power that the beam loses is that of cells.
  /// @param travel  unit. @param scaled_per_m  extinction at density 1.
  [[nodiscard]] std::vector<float> BeamIn(const CloudCells& cells, const glm::dvec3& travel,
                                          double scaled_per_m) const;
  /// Calls visit(point, density) for points of a cell in the limited body; points are in
  /// SceneGround's frame.
  template <typename Visit>
  void EachSample(const CloudBox& cell, const Visit& visit) const;
  [[nodiscard]] int samples_per_side() const { return samples_per_side_; }  // of a cell

 private:
  [[nodiscard]] double DensityAt(const glm::dvec3& in_cells) const;
  [[nodiscard]] std::size_t PlaceOf(const glm::dvec3& in_cells) const;
  [[nodiscard]] CloudCellContent ContentOf(const CloudBox& cell) const;
  void Limit(double scaled_per_m);
  template <typename Visit>
  void EachStretch(const glm::dvec3& origin, const glm::dvec3& direction, double length_m,
                   const Visit& visit) const;

  const LocalBody& volume_;
  glm::dvec3 middle_;
  glm::dmat3 frame_from_cells_;
  int samples_per_side_;
  CloudCellLattice lattice_;  // of the finest grid
  std::vector<float> kept_;   // extinction relative to that of the body, of each cell of lattice_
  bool is_limited_ = false;
  std::vector<std::shared_ptr<const CloudCells>> grids_;
};

template <typename Visit>
void VolumeCells::EachSample(const CloudBox& cell, const Visit& visit) const {
  const glm::dvec3 step = (cell.high - cell.low) / static_cast<double>(samples_per_side_);
  for (int z = 0; z < samples_per_side_; ++z) {
    for (int y = 0; y < samples_per_side_; ++y) {
      for (int x = 0; x < samples_per_side_; ++x) {
        const glm::dvec3 in_cells = cell.low + (glm::dvec3(x, y, z) + 0.5) * step;
        const double density = DensityAt(in_cells);
        if (density > 0.0) visit(PointInFrame(in_cells), density);
      }
    }
  }
}

}  // namespace alpenglow::renderer
