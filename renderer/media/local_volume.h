// SPDX-License-Identifier: MIT
// A body of one of three densities, 1 by default: a cloud of smoke, a fog bank, a plume of gas, a
// fire.
//
//   homogeneous   1
//   exponential   exp(-z / H), z the height over the bottom of the volume
//   grid          trilinear between samples (VolumeGrid)
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "renderer/media/local_body.h"
#include "renderer/scene/scene.h"
#include "renderer/scene/volume_grid.h"
#include "renderer/surface/scene_ground.h"

namespace alpenglow::renderer {

/// Immutable; safe to use from many threads. Directions are unit vectors.
class LocalVolume final : public LocalBody {
 public:
  /// @param scale_height_m  of the density; empty: homogeneous. Must be empty if there is a grid.
  LocalVolume(const VolumePlacement& placement, std::optional<double> scale_height_m,
              std::shared_ptr<const VolumeGrid> grid, MediumOptics optics = {},
              ScatteringOrders orders = ScatteringOrders::kAll);

  [[nodiscard]] std::optional<std::array<int, 3>> Samples() const override;
  [[nodiscard]] double DensityAt(const glm::dvec3& point) const override;
  [[nodiscard]] std::vector<DensePiece> PiecesAlong(const glm::dvec3& origin,
                                                    const glm::dvec3& direction,
                                                    double length_m) const override;
  [[nodiscard]] double LargestBetween(const glm::dvec3& from, const glm::dvec3& to,
                                      double largest) const override;
  /// Relative error below 1e-10.
  [[nodiscard]] double Column(const glm::dvec3& origin, const glm::dvec3& direction,
                              double length_m) const override;

 private:
  [[nodiscard]] double DensityIn(const glm::dvec3& unit) const;

  std::optional<double> scale_height_m_;
  std::shared_ptr<const VolumeGrid> grid_;
};

/// Returns the volumes of a scene that attenuate or emit; others would only cut rays. Throws
/// InputError "volume N: ..." for grids that cannot be read.
[[nodiscard]] MediaList VolumesOf(const Scene& scene, const SceneGround& ground,
                                  const Medium& medium);

}  // namespace alpenglow::renderer
