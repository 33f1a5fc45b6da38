// SPDX-License-Identifier: MIT
// Air changes the disk of sun or moon near the horizon: it flattens it, spreads its colours and
// dims its lower limb. Nodes of elevation across the disk, by the renderer's bent rays; shaders
// interpolate (shaders/bent_disks.glsl).
#pragma once

#include <array>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>

#include "viewer/air/solved_air.h"

namespace alpenglow::viewer {

/// Values by band, node by node upwards.
struct BentDisk {
  static constexpr int kNodes = 13;  // 3.4' apart: between them lifts are within 0.05' of the rays'

  double first_rad = 0.0, step_rad = 1.0;      // apparent elevations of the nodes
  std::array<glm::vec4, kNodes> lift_rad{};    // apparent less true elevation
  std::array<glm::vec4, kNodes> more_depth{};  // optical depth, more than if the ray were straight

  /// By how much the air shifts parts of the disk against each other [rad]: bands, and the lower
  /// half against the upper.
  [[nodiscard]] double Change() const;
};

/// Some milliseconds. @param elevation_rad, radius_rad  of the disk, apparent.
[[nodiscard]] BentDisk BentDiskOf(const Medium& medium, double height_m, double elevation_rad,
                                  double radius_rad);

/// The same, kept while eye and disk stay about where they are.
class BentDiskFollower {
 public:
  /// Null where the disk stands so high or so far under the horizon that it is round, or where no
  /// part of it moves by `half_pixel_rad`.
  [[nodiscard]] const BentDisk* Follow(const std::shared_ptr<const SolvedAir>& air, double height_m,
                                       double elevation_rad, double radius_rad,
                                       double half_pixel_rad);

 private:
  struct Made {
    std::shared_ptr<const SolvedAir> air;
    double height_m, elevation_rad;
    BentDisk disk;
  };
  std::optional<Made> made_;
};

}  // namespace alpenglow::viewer
