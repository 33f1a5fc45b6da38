// SPDX-License-Identifier: MIT
// This header provides a smooth surface through the heights of an elevation model: a cubic
// B-spline, whose second derivatives are continuous, with its derivatives.
//
//   z(u, v) = sum of c_ij b(u - i) b(v - j),   b the cubic B-spline of unit spacing
//
// The coefficients c are those with which z equals the heights at the samples, or has the heights
// as its means over the samples' cells; SRTM3, for instance, has means of 3 x 3 samples of 1
// arcsecond. They follow from the samples by recursive filters (Unser, Aldroubi, Eden 1993, IEEE
// Trans. Signal Processing 41, 821 and 834). Beyond the rim the heights are mirrored at the samples
// of the rim.
//
// Coordinates are metres to the east and north of the north-western sample. Used by the study and
// tests so far.
#pragma once

#include <cstddef>
#include <vector>

#include "renderer/relief/relief.h"

namespace alpenglow::renderer {

/// Heights on a grid of metres, rows from the north.
struct MetricGrid {
  int columns = 0, rows = 0;
  double spacing_east_m = 0.0, spacing_north_m = 0.0;
  std::vector<float> height_m;  // rows x columns
};

enum class SampleMeaning { kPoints, kCellMeans };

class HeightSpline {
 public:
  /// Throws InputError if the grid is empty, a spacing is not positive or a height is not finite:
  /// voids must have been filled, as a spline through them would have spires.
  HeightSpline(const MetricGrid& grid, SampleMeaning meaning);

  /// Returns height and derivatives. Beyond half a cell outside the grid the coordinates are those
  /// of its rim.
  [[nodiscard]] ModelAt<double> At(double east_m, double north_m) const;

  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] double spacing_east_m() const { return spacing_east_m_; }
  [[nodiscard]] double spacing_north_m() const { return spacing_north_m_; }
  /// Returns the smaller one of the two spacings.
  [[nodiscard]] double spacing_m() const {
    return spacing_east_m_ < spacing_north_m_ ? spacing_east_m_ : spacing_north_m_;
  }

 private:
  [[nodiscard]] double Coefficient(int column, int row) const;

  int columns_, rows_;
  double spacing_east_m_, spacing_north_m_;
  std::vector<float> coefficients_m_;
};

}  // namespace alpenglow::renderer
