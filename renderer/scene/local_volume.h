// SPDX-License-Identifier: MIT
// Local participating media: a cloud of smoke, a fog bank, a plume of gas. Each has a density, 1 by
// default, within a box or an ellipsoid, which multiplies its optical properties per metre.
//
//   homogeneous   1
//   exponential   exp(-z / H), z the height over the bottom of the volume
//   grid          trilinear between samples (VolumeGrid)
//
// A volume is flat: the planet's curvature below it is ignored (over 2 km, 0.1 m).
//
// VolumeGrid holds densities on a regular grid within a box. Samples lie at the centres of nx x ny
// x nz equal cells of the unit cube; density is trilinear between them and constant beyond the
// outermost ones. Along a straight line such a density is a cubic between the planes of samples, so
// two Gauss points per piece give its integral exactly.
//
// Blocks of 4 samples a side store their largest density: rays skip empty blocks, and ray marching
// gets an upper bound of the density ahead.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "atmosphere/time_place/geodesy.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

inline constexpr int kMostGridSamples = 1024;  // along an axis

/// Immutable.
class VolumeGrid {
 public:
  /// @param size    samples along x, y, z, each in [2, kMostGridSamples].
  /// @param values  x fastest, z slowest; finite and not negative.
  /// Throws InputError that states the error.
  VolumeGrid(const std::array<int, 3>& size, std::vector<float> values);

  [[nodiscard]] const std::array<int, 3>& size() const { return size_; }
  [[nodiscard]] const std::vector<float>& values() const { return values_; }
  [[nodiscard]] double largest() const { return largest_; }

  /// Returns the density at a point of the unit cube; coordinates are clamped to the cube.
  [[nodiscard]] double At(const glm::dvec3& point) const;

  /// An interval of a line and an upper bound of the density on it.
  struct Piece {
    double begin, end;
    double largest;
  };
  /// Returns the intervals of origin + t direction, t in [begin, end], where density can differ
  /// from 0, in order: one per block. That part of the line must lie in the unit cube.
  [[nodiscard]] std::vector<Piece> PiecesAlong(const glm::dvec3& origin,
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
  std::vector<float> largest_in_block_;
  double largest_ = 0.0;
};

/// Throws InputError for a grid with a side outside of [2, kMostGridSamples].
void CheckGridSize(const std::array<int, 3>& size);

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

/// An interval of a line, as distances along it [m].
struct LineSpan {
  double begin_m, end_m;
};

/// An interval of a line and an upper bound of the density on it.
struct DensePiece {
  double begin_m, end_m;
  double largest;
};

/// Immutable; safe to use from many threads. Directions are unit vectors.
class LocalVolume {
 public:
  /// @param scale_height_m  of the density; empty: homogeneous. Must be empty if there is a grid.
  LocalVolume(const VolumePlacement& placement, std::optional<double> scale_height_m,
              std::shared_ptr<const VolumeGrid> grid);

  [[nodiscard]] const VolumePlacement& placement() const { return placement_; }
  [[nodiscard]] const VolumeGrid* grid() const { return grid_.get(); }
  /// Returns the middle of the bounding box.
  [[nodiscard]] glm::dvec3 Middle() const;

  /// Returns the point as fractions of size_m: the box becomes the unit cube.
  [[nodiscard]] glm::dvec3 UnitFromFrame(const glm::dvec3& point) const;
  [[nodiscard]] glm::dvec3 FrameFromUnit(const glm::dvec3& unit) const;

  /// Returns the density at a point; 0 outside.
  [[nodiscard]] double DensityAt(const glm::dvec3& point) const;

  /// Returns the interval of a line within [0, length_m] that is inside the volume.
  [[nodiscard]] std::optional<LineSpan> SpanAlong(const glm::dvec3& origin,
                                                  const glm::dvec3& direction,
                                                  double length_m) const;
  /// Returns the intervals of that part with density, in order.
  [[nodiscard]] std::vector<DensePiece> PiecesAlong(const glm::dvec3& origin,
                                                    const glm::dvec3& direction,
                                                    double length_m) const;
  /// Returns the integral of the density [m] over [0, length_m]. Relative error below 1e-10.
  [[nodiscard]] double Column(const glm::dvec3& origin, const glm::dvec3& direction,
                              double length_m) const;

 private:
  [[nodiscard]] double DensityIn(const glm::dvec3& unit) const;

  VolumePlacement placement_;
  std::optional<double> scale_height_m_;
  std::shared_ptr<const VolumeGrid> grid_;
};

}  // namespace alpenglow::renderer
