// SPDX-License-Identifier: MIT
// A medium within a box or an ellipsoid: a cloud of smoke, a fog bank, a plume of gas, a fire. Its
// density is 1 by default:
//
//   homogeneous   1
//   exponential   exp(-z / H), z the height over the bottom of the volume
//   grid          trilinear between samples (VolumeGrid)
//
// A volume is flat: the planet's curvature below it is ignored (over 2 km, 0.1 m).
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "renderer/media/local_medium.h"
#include "renderer/scene/scene.h"
#include "renderer/scene/volume_grid.h"
#include "renderer/surface/scene_ground.h"

namespace alpenglow::renderer {

/// An interval of a line, as distances along it [m].
struct LineSpan {
  double begin_m, end_m;
};

/// Immutable; safe to use from many threads. Directions are unit vectors.
class LocalVolume final : public LocalMedium {
 public:
  /// @param scale_height_m  of the density; empty: homogeneous. Must be empty if there is a grid.
  LocalVolume(const VolumePlacement& placement, std::optional<double> scale_height_m,
              std::shared_ptr<const VolumeGrid> grid, MediumOptics optics = {});

  [[nodiscard]] const VolumePlacement& placement() const { return placement_; }
  [[nodiscard]] const VolumeGrid* grid() const { return grid_.get(); }
  /// Returns the middle of the bounding box.
  [[nodiscard]] glm::dvec3 Middle() const;

  /// Returns the point as fractions of size_m: the box becomes the unit cube.
  [[nodiscard]] glm::dvec3 UnitFromFrame(const glm::dvec3& point) const;
  [[nodiscard]] glm::dvec3 FrameFromUnit(const glm::dvec3& unit) const;

  /// Returns the interval of a line within [0, length_m] that is inside the volume.
  [[nodiscard]] std::optional<LineSpan> SpanAlong(const glm::dvec3& origin,
                                                  const glm::dvec3& direction,
                                                  double length_m) const;

  [[nodiscard]] double DensityAt(const glm::dvec3& point) const override;
  [[nodiscard]] std::vector<DensePiece> PiecesAlong(const glm::dvec3& origin,
                                                    const glm::dvec3& direction,
                                                    double length_m) const override;
  [[nodiscard]] double LargestBetween(const glm::dvec3& from, const glm::dvec3& to,
                                      double largest) const override;
  /// Relative error below 1e-10.
  [[nodiscard]] double Column(const glm::dvec3& origin, const glm::dvec3& direction,
                              double length_m) const override;
  [[nodiscard]] std::unique_ptr<const LitMedium> LitBy(const MediaSources& sources) const override;

 private:
  [[nodiscard]] double DensityIn(const glm::dvec3& unit) const;

  VolumePlacement placement_;
  std::optional<double> scale_height_m_;
  std::shared_ptr<const VolumeGrid> grid_;
};

/// Returns the volumes of a scene that attenuate or emit; others would only cut rays. Throws
/// InputError "volume N: ..." for grids that cannot be read.
[[nodiscard]] MediaList VolumesOf(const Scene& scene, const SceneGround& ground,
                                  const Medium& medium);

}  // namespace alpenglow::renderer
