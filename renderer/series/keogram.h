// SPDX-License-Identifier: MIT
// A keogram: the middle columns of the pictures of a series side by side, so that one image shows
// their course (Eather, Mende, Reference 1976, J. Geophys. Res. 81, 3219).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "atmosphere/time_place/time.h"
#include "lut/image/image.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Grows by the middle column of each picture, which is repeated: short series would be too narrow to
/// see.
class Keogram {
 public:
  /// @param frames  that will be added, >= 1.
  /// @param zone    of the scale of hours; nothing: UTC.
  Keogram(int frames, std::optional<std::string> zone);

  /// Adds a developed picture; all must have the same height.
  void Add(const UtcTime& instant, const DisplayImage& picture);

  /// Returns the columns of the added pictures, at least one, above a scale of hours. The scale is
  /// left blank where frames are not in the order of time.
  [[nodiscard]] DisplayImage Image() const;

  /// Columns of a frame, so that the image is about kUsualWidth wide, and pixels of the scale.
  static constexpr int kFewestColumns = 4, kMostColumns = 32, kUsualWidth = 640, kScaleHeight = 32;

  /// Returns the number of columns of each frame.
  [[nodiscard]] int columns() const { return columns_; }

 private:
  /// Returns the column of an instant between two frames; no value beside all frames.
  [[nodiscard]] std::optional<double> ColumnOf(const UtcTime& instant) const;

  int columns_;
  std::optional<std::string> zone_;
  int height_ = 0;
  std::vector<UtcTime> instants_;
  std::vector<std::uint8_t> rgb_;  // picture by picture
};

}  // namespace alpenglow::renderer
