// SPDX-License-Identifier: MIT
// The lattice that all levels of detail stand on: latitudes and longitudes in even steps.
//
// Level k has every 2^k-th sample of both axes, from the lattice's north-west corner, and its last
// row and column whatever their numbers, so that every level ends at the same rim. A sample is
// named by its column and row of level 0, a vertex of level k by i and j: column min(i 2^k, last).
//
// Heights of one tile at all levels of detail.
//
// A level is the binomial mean (1 2 1) of the next finer one along each axis. At a tile's rim only
// along the rim, so that two tiles which share samples there agree on them at every level.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <vector>

#include "atmosphere/sun/geodesy.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// A rectangle of samples of level 0, both ends included.
struct LatticeBox {
  int first_column = 0, first_row = 0;
  int last_column = -1, last_row = -1;

  [[nodiscard]] bool Holds(int column, int row) const {
    return column >= first_column && column <= last_column && row >= first_row && row <= last_row;
  }
  [[nodiscard]] bool Touches(const LatticeBox& other) const {
    return first_column <= other.last_column && other.first_column <= last_column &&
           first_row <= other.last_row && other.first_row <= last_row;
  }
};

/// A place between the samples, in columns and rows of level 0.
struct LatticePlace {
  double column = 0.0, row = 0.0;
};

struct LandLattice {
  double west_rad = 0.0, north_rad = 0.0;  // of sample (0, 0)
  double step_lon_rad = 0.0, step_lat_rad = 0.0;
  int last_column = 0, last_row = 0;

  /// Of the vertices of a level.
  [[nodiscard]] int LastVertex(int last_sample, int level) const {
    return (last_sample + (1 << level) - 1) >> level;
  }
  [[nodiscard]] int LastI(int level) const { return LastVertex(last_column, level); }
  [[nodiscard]] int LastJ(int level) const { return LastVertex(last_row, level); }
  [[nodiscard]] int ColumnOf(int i, int level) const {
    return std::clamp(i * (1 << level), 0, last_column);
  }
  [[nodiscard]] int RowOf(int j, int level) const {
    return std::clamp(j * (1 << level), 0, last_row);
  }

  /// Where a sample lies; rows that a grid has beyond a pole lie on it.
  [[nodiscard]] GeodeticPosition PlaceOf(int column, int row, double height_m) const {
    constexpr double kPole = 0.5 * std::numbers::pi;
    return {std::clamp(north_rad - row * step_lat_rad, -kPole, kPole),
            west_rad + column * step_lon_rad, height_m};
  }

  /// The turn of the longitude that comes nearest to the lattice's middle.
  [[nodiscard]] LatticePlace At(double latitude_rad, double longitude_rad) const {
    const double middle = west_rad + 0.5 * last_column * step_lon_rad;
    const double east = std::remainder(longitude_rad - middle, 2.0 * std::numbers::pi);
    return {0.5 * last_column + east / step_lon_rad, (north_rad - latitude_rad) / step_lat_rad};
  }
};

/// Heights [m]; NaN: none. Whole metres take two bytes a sample, others four.
class HeightSamples {
 public:
  explicit HeightSamples(std::vector<float> height_m);
  [[nodiscard]] float at(std::size_t index) const {
    if (whole_m_.empty()) return real_m_[index];
    return whole_m_[index] == kNone ? std::numeric_limits<float>::quiet_NaN()
                                    : static_cast<float>(whole_m_[index]);
  }
  [[nodiscard]] std::size_t bytes() const {
    return sizeof(float) * real_m_.size() + sizeof(std::int16_t) * whole_m_.size();
  }

 private:
  static constexpr std::int16_t kNone = std::numeric_limits<std::int16_t>::min();
  std::vector<float> real_m_;
  std::vector<std::int16_t> whole_m_;
};

/// The samples of a level along one axis of a box: multiples of 2^level, and the box's last.
struct LevelAxis {
  int first = 0, last = -1, level = 0;

  LevelAxis(int first_sample, int last_sample, int of_level)
      : first(((first_sample + (1 << of_level) - 1) >> of_level) << of_level),
        last(last_sample),
        level(of_level) {}
  [[nodiscard]] int count() const {
    return first > last ? 1 : ((last - first + (1 << level) - 1) >> level) + 1;
  }
  [[nodiscard]] int SampleOf(int index) const { return std::min(first + (index << level), last); }
  /// Index of a sample that the level has.
  [[nodiscard]] int IndexOf(int sample) const {
    return sample == last ? count() - 1 : (sample - first) >> level;
  }
};

/// Immutable. Levels may be left out from the finest on.
class HeightPyramid {
 public:
  /// @param box      of the tile's samples.
  /// @param level    of the heights that are given: the tile's own spacing is that of this level.
  /// @param height_m rows from the north over the LevelAxis of columns and rows.
  HeightPyramid(const LatticeBox& box, int level, std::vector<float> height_m);

  /// The same without the levels finer than this one.
  [[nodiscard]] HeightPyramid From(int level) const;

  /// Height [m] at a sample of the box that `level` has; bilinear where the pyramid has nothing as
  /// fine; NaN: none.
  [[nodiscard]] float At(int level, int column, int row) const;

  [[nodiscard]] const LatticeBox& box() const { return box_; }
  /// The finest level that is there.
  [[nodiscard]] int finest() const { return finest_; }
  [[nodiscard]] std::size_t bytes() const;
  /// What such a pyramid takes [bytes] at most, from this level on.
  [[nodiscard]] static std::size_t BytesOf(const LatticeBox& box, int level);

 private:
  [[nodiscard]] std::size_t IndexOf(int level, int column, int row) const;
  [[nodiscard]] float Between(int column, int row) const;

  LatticeBox box_;
  int finest_;
  std::vector<std::shared_ptr<const HeightSamples>> levels_;  // [0] is finest_
};

}  // namespace alpenglow::viewer
