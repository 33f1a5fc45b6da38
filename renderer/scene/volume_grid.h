// SPDX-License-Identifier: MIT
// Densities on a regular grid within a box, and the place of a volume.
//
// Samples lie at the centres of nx x ny x nz equal cells of the unit cube; density is trilinear
// between them and constant beyond the outermost ones. Along a straight line such a density is a
// cubic between the planes of samples, so two Gauss points per piece give its integral exactly.
//
// Blocks of 4 samples a side store bounds of their values: rays skip empty blocks, and ray marching
// gets an upper bound of the density ahead.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "renderer/layer.h"

namespace alpenglow::renderer {

inline constexpr int kMostGridSamples = 1024;  // along an axis

/// The values that a grid may have.
enum class GridValues {
  kDensities,  // not negative
  kAny,        // of any quantity
};

/// An interval of a line and bounds of the values on it.
struct ValuePiece {
  double begin, end;
  double least, largest;
};

/// An interval of a line along which the values are a cubic polynomial, in Bernstein's form: the
/// values lie between the least and the largest coefficient, and the mean of the coefficients is the
/// mean of the values.
struct CubicPiece {
  double begin, end;
  std::array<double, 4> coefficients;

  /// @param s  in [0, 1], from begin to end.
  [[nodiscard]] double At(double s) const;
};

/// An interval of a line and an upper bound of the density on it.
struct DensePiece {
  double begin_m, end_m;
  double largest;
};

/// Immutable.
class VolumeGrid {
 public:
  /// @param size    samples along x, y, z, each in [2, kMostGridSamples].
  /// @param values  x fastest, z slowest; finite.
  /// Throws InputError that states the error.
  VolumeGrid(const std::array<int, 3>& size, std::vector<float> values,
             GridValues allowed = GridValues::kDensities);

  [[nodiscard]] const std::array<int, 3>& size() const { return size_; }
  [[nodiscard]] const std::vector<float>& values() const { return values_; }
  [[nodiscard]] double largest() const { return largest_; }

  /// Returns the value at a point of the unit cube; coordinates are clamped to the cube.
  [[nodiscard]] double At(const glm::dvec3& point) const;

  /// Returns the intervals of origin + t direction, t in [begin_m, end_m], where density can differ
  /// from 0, in order: one per block. That part of the line must lie in the unit cube.
  [[nodiscard]] std::vector<DensePiece> PiecesAlong(const glm::dvec3& origin,
                                                    const glm::dvec3& direction, double begin_m,
                                                    double end_m) const;

  /// Return a part of a line that lies in the unit cube in pieces, in order: one per block with bounds
  /// of its values, and one per cell between samples. Values of pieces have rounding errors of 1e-14
  /// of the largest value.
  [[nodiscard]] std::vector<ValuePiece> BlocksAlong(const glm::dvec3& origin,
                                                    const glm::dvec3& direction, double begin,
                                                    double end) const;
  [[nodiscard]] std::vector<CubicPiece> CubicsAlong(const glm::dvec3& origin,
                                                    const glm::dvec3& direction, double begin,
                                                    double end) const;

  /// Returns the integral of density over t from begin to end. Exact except for rounding: relative
  /// error below 1e-12.
  [[nodiscard]] double Column(const glm::dvec3& origin, const glm::dvec3& direction, double begin,
                              double end) const;

 private:
  [[nodiscard]] std::size_t Index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size_[1]) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(size_[0]) +
           static_cast<std::size_t>(x);
  }
  void FindLargest();

  std::array<int, 3> size_;
  std::array<int, 3> blocks_{};
  std::vector<float> values_;
  std::vector<float> least_in_block_, largest_in_block_;
  double largest_ = 0.0;
};

/// Throws InputError for a grid with a side outside of [2, kMostGridSamples].
void CheckGridSize(const std::array<int, 3>& size);

/// The orders of scattering of which a volume has light: the first alone, or all.
enum class ScatteringOrders { kSingle, kAll };

/// Position and orientation of a volume, in the frame of SceneGround.
struct VolumePlacement {
  enum class Shape { kBox, kEllipsoid };
  Shape shape = Shape::kBox;
  glm::dvec3 bottom{0.0};            // middle of the underside
  glm::dvec3 across{1.0, 0.0, 0.0};  // orthogonal unit vectors
  glm::dvec3 ahead{0.0, 1.0, 0.0};
  glm::dvec3 up{0.0, 0.0, 1.0};
  glm::dvec3 size_m{1.0};  // across, ahead, up
};

}  // namespace alpenglow::renderer
