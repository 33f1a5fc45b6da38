// SPDX-License-Identifier: MIT
// Heights of one tile at all levels of detail.
//
// A level is the binomial mean (1 2 1) of the next finer one along each axis. At a tile's rim only
// along the rim, so that two tiles which share samples there agree on them at every level.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "viewer/land/land_lattice.h"

namespace alpenglow::viewer {

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
