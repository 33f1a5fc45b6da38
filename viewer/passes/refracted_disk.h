// SPDX-License-Identifier: MIT
// The disk of the sun or moon near the horizon: refraction flattens it, dispersion separates its
// colours, and extinction dims its lower limb. RefractedDisk has nodes of elevation across the
// disk, computed with the renderer's refracted rays; shaders interpolate between them
// (shaders/view/refracted_disks.glsl).
#pragma once

#include <array>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>

#include "atmosphere/medium/medium.h"
#include "lut/camera_tables/air_tables.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// Refraction and extinction across a disk, as values per band at nodes from the bottom upwards.
struct RefractedDisk {
  static constexpr int kNodes = 13;  // 3.4' apart: interpolated lifts are within 0.05' of the rays'

  double first_rad = 0.0, step_rad = 1.0;      // apparent elevation of the first node, spacing
  std::array<glm::vec4, kNodes> lift_rad{};    // apparent minus true elevation
  std::array<glm::vec4, kNodes> more_depth{};  // optical depth minus that of a straight ray

  /// Returns how far refraction shifts parts of the disk relative to each other [rad]: bands, and
  /// the lower half relative to the upper.
  [[nodiscard]] double Change() const;
};

/// Computes the refraction of a disk, which takes some milliseconds.
/// @param elevation_rad, radius_rad  of the disk, apparent.
[[nodiscard]] RefractedDisk RefractedDiskOf(const Medium& medium, double height_m,
                                            double elevation_rad, double radius_rad);

/// Keeps a RefractedDisk as long as eye and disk move little.
class RefractedDiskFollower {
 public:
  /// Returns null if the disk is so high, or so far below the horizon, that it is round, or if no
  /// part of it moves by `half_pixel_rad`.
  [[nodiscard]] const RefractedDisk* Follow(const std::shared_ptr<const SolvedAir>& air,
                                            double height_m, double elevation_rad,
                                            double radius_rad, double half_pixel_rad);

 private:
  struct Made {
    std::shared_ptr<const SolvedAir> air;
    double height_m, elevation_rad;
    RefractedDisk disk;
  };
  std::optional<Made> made_;
};

}  // namespace alpenglow::viewer
