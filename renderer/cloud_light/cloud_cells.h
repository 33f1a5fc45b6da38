// SPDX-License-Identifier: MIT
// The coarse cells of a field on which light of higher orders is solved.
//
// A cell of which more than half holds cloud is full, with the mean extinction of the part that holds
// cloud; all others are clear. Spreading the cloud of a border over its whole cell would make clouds
// wider and thinner. Light is needed in full cells and around them: in their 26 neighbours, and in
// all other cells with cloud and their neighbours, so that every point with cloud lies between cells
// that know the light. Only these cells are stored, full ones first.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <vector>

#include "renderer/cloud_light/cloud_track_kernel.h"
#include "renderer/clouds/cloud_field.h"

namespace alpenglow::renderer {

/// A box of equal cells.
struct CloudCellLattice {
  std::array<int, 3> count{1, 1, 1};  // along x, y, z; each >= 1
  glm::dvec3 origin_m{0.0};           // corner with the least coordinates
  glm::dvec3 cell_m{1.0};             // sides of a cell, > 0
};

/// The content of a cell.
struct CloudCellContent {
  double extinction_per_m = 0.0;  // mean of the part that holds cloud
  double share = 0.0;             // of the cell that holds cloud
};

/// Immutable; safe to use from many threads. It does not refer to the field.
class CloudCells {
 public:
  /// Returns the content of a cell, which is a box. Safe to call from many threads.
  using Content = std::function<CloudCellContent(const CloudBox&)>;

  /// Samples the field with as many threads as are free; the result does not depend on their number.
  /// @param cell_m  side of a cell, in [10, 10000]; cells of shallow fields are flatter, so that
  /// there are at least kLeastLevels of them. A period is a multiple of the cells. Throws InputError
  /// for sides out of range and for more than 10^9 cells.
  CloudCells(const CloudField& field, double cell_m);
  /// Makes the cells of any medium in an open box.
  CloudCells(const CloudCellLattice& lattice, const Content& content);

  static constexpr int kLeastLevels = 6;

  [[nodiscard]] const std::array<int, 3>& count() const { return count_; }
  [[nodiscard]] const glm::dvec3& cell_m() const { return cell_m_; }
  [[nodiscard]] CloudCellLattice lattice() const { return {count_, origin_m_, cell_m_}; }
  [[nodiscard]] bool is_periodic() const { return is_periodic_; }
  /// Returns whether these are cells of any medium in an open box.
  [[nodiscard]] bool is_body() const { return is_body_; }
  [[nodiscard]] std::size_t full() const { return extinction_per_m_.size(); }
  /// Returns the number of stored cells.
  [[nodiscard]] std::size_t size() const { return place_.size(); }
  /// Returns the extinction of a full cell, not scaled.
  [[nodiscard]] double Extinction_per_m(std::size_t cell) const {
    return static_cast<double>(extinction_per_m_[cell]);
  }
  /// Returns the middle of a stored cell.
  [[nodiscard]] glm::dvec3 Middle(std::size_t cell) const;
  /// Returns the full cell at a place along x, y and z within count(), or -1.
  [[nodiscard]] std::int32_t FullCellOf(const std::array<int, 3>& place) const {
    const std::int32_t cell = stored_[PlaceOf(place[0], place[1], place[2])];
    return cell < static_cast<std::int32_t>(full()) ? cell : -1;
  }
  /// Returns the full cell that holds a point, or the nearest one of the cells around it, within two
  /// cells; of equally near ones that with the greatest component along `ahead`. Returns -1 if
  /// there is none.
  [[nodiscard]] std::int32_t FullCellAt(const glm::dvec3& point, const glm::dvec3& ahead) const;

  /// Stored cells around a point and their weights, which sum to 1; `count` is 0 far from clouds.
  struct Mixture {
    std::array<std::uint32_t, 8> cell;
    std::array<float, 8> weight;
    int count;
  };
  /// Returns the trilinear mixture of the stored ones of eight neighbours.
  [[nodiscard]] Mixture Around(const glm::dvec3& point) const;

  /// The stored neighbours of a full cell that are full, along one axis. The slope of a value is
  /// per_m (after - before) + bend_per_m (before + after - 2 here).
  struct Neighbours {
    std::uint32_t before, after;  // places among lanes; that of the cell itself if it has none
    float per_m;                  // 1 / distance between both in a field; 0 if there is none
    float bend_per_m;             // 0 in a field
  };
  [[nodiscard]] const std::array<Neighbours, 3>& NeighboursOf(std::size_t full_cell) const {
    return neighbours_[full_cell];
  }
  /// Returns the place of a stored cell in arrays of the runs (CloudTrackWork).
  [[nodiscard]] std::uint32_t Lane(std::size_t cell) const { return lane_[cell]; }
  [[nodiscard]] std::size_t lanes() const { return kCloudLanes * blocks_; }

  /// Runs of cells by row: those with full cells, or those with any stored cell.
  struct Runs {
    std::vector<CloudTrackRun> run;
    std::vector<std::uint32_t> row_first;
  };
  [[nodiscard]] const Runs& full_runs() const { return full_runs_; }
  [[nodiscard]] const Runs& all_runs() const { return all_runs_; }

  [[nodiscard]] std::size_t bytes() const;

 private:
  [[nodiscard]] std::size_t PlaceOf(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(count_[1]) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(count_[0]) +
           static_cast<std::size_t>(x);
  }
  /// Returns a place after wrapping x and y, or a negative number outside of the cells.
  [[nodiscard]] std::ptrdiff_t WrappedPlace(int x, int y, int z) const;
  void Fill(const Content& content);
  void StoreCells(const std::vector<char>& has_cloud);
  void FindRuns();
  void FindNeighbours();
  /// Makes slopes those of a value that is linear in optical depth on both sides of a cell.
  void WeightNeighboursByDepth();

  std::array<int, 3> count_{};
  glm::dvec3 origin_m_{0.0}, cell_m_{1.0};
  bool is_periodic_ = true, is_body_ = false;
  std::vector<std::int32_t> stored_;     // of each place: number of the stored cell, or -1
  std::vector<std::uint32_t> place_;     // of each stored cell
  std::vector<std::uint32_t> lane_;      // of each stored cell
  std::vector<float> extinction_per_m_;  // of each full cell
  std::vector<std::array<Neighbours, 3>> neighbours_;
  Runs full_runs_, all_runs_;
  std::size_t blocks_ = 0;
};

}  // namespace alpenglow::renderer
