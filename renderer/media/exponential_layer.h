// SPDX-License-Identifier: MIT
// A medium over the whole scene, such as fog, whose density falls exponentially with altitude:
// exp(-(h - base) / H) above the sphere, and 1 throughout if H is infinite. It is 0 above the top
// of the atmosphere.
//
// This header also provides the functions of the shared text exponential_layer.glsl in C++.
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "atmosphere/lamp/lamp.h"  // LayerLogDensity of the shared text
#include "atmosphere/ray/ray.h"
#include "atmosphere/ray/shell.h"
#include "renderer/layers/layer_beam.h"
#include "renderer/media/local_medium.h"
#include "renderer/scene/scene.h"
#include "renderer/surface/scene_ground.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/shared_glsl/shared_begin.h"
#include "renderer/media/exponential_layer.glsl"
#include "atmosphere/shared_glsl/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared

namespace alpenglow::renderer {

/// Altitudes of a layer above the sphere of a planet [m].
struct LayerShape {
  double base_m = 0.0;             // where the density is 1
  double scale_height_m = 0.0;     // > 0; may be infinite
  double planet_radius_m = 0.0;    // the sphere's centre is at (0, 0, -R)
  double top_m = 0.0;              // of the atmosphere
  std::optional<double> bottom_m;  // of the lowest ground in the layer; empty: the base
};

/// Immutable; safe to use from many threads. Directions are unit vectors.
class ExponentialLayer final : public LocalMedium {
 public:
  explicit ExponentialLayer(const LayerShape& shape, MediumOptics optics = {});

  [[nodiscard]] double base_m() const { return shape_.base_m; }
  [[nodiscard]] double scale_height_m() const { return shape_.scale_height_m; }
  [[nodiscard]] double bottom_m() const { return shape_.bottom_m.value_or(shape_.base_m); }
  /// Returns the altitude above which the optical depth is 1, or that at which the density is 1/e of
  /// that on the lowest ground if that is higher; the lowest ground if the density is constant.
  [[nodiscard]] double HeadAltitude() const;

  [[nodiscard]] double AltitudeOf(const glm::dvec3& point) const;
  [[nodiscard]] double DensityAtAltitude(double altitude_m) const;
  /// Returns the integral of the density from an altitude vertically to space [m].
  [[nodiscard]] double ColumnAbove(double altitude_m) const;
  /// Returns the column along a direction that does not meet the planet. Relative error below 1e-6.
  [[nodiscard]] double ColumnToSpace(const glm::dvec3& point, const glm::dvec3& direction) const;

  [[nodiscard]] bool IsLayer() const override { return true; }
  [[nodiscard]] double DensityAt(const glm::dvec3& point) const override {
    return DensityAtAltitude(AltitudeOf(point));
  }
  /// Returns the pieces where the density may exceed 1e-9. If the lowest point of the line is among
  /// them, it is the end of one piece and the start of the next.
  [[nodiscard]] std::vector<DensePiece> PiecesAlong(const glm::dvec3& origin,
                                                    const glm::dvec3& direction,
                                                    double length_m) const override;
  /// Within a piece the density increases or decreases, so that the largest value is at an end.
  [[nodiscard]] double LargestBetween(const glm::dvec3& from, const glm::dvec3& to,
                                      double largest) const override;
  /// Absolute error below 1e-6 of the column from the denser end to space.
  [[nodiscard]] double Column(const glm::dvec3& origin, const glm::dvec3& direction,
                              double length_m) const override;
  [[nodiscard]] std::unique_ptr<const LitMedium> LitBy(const MediaSources& sources) const override;

  /// Returns the first order of sunlight, which is tabulated for the phase function at the first call.
  [[nodiscard]] const LayerBeam& beam() const;

 private:
  /// Returns the column to space from an altitude, for a zenith cosine >= 0.
  [[nodiscard]] double ColumnUp(double altitude_m, double mu) const;

  LayerShape shape_;
  double thin_m_;  // density is below 1e-9 above this altitude
  mutable std::once_flag tabulated_;
  mutable std::optional<LayerBeam> beam_;
};

/// Returns the layers of a scene, without those that lie wholly below the ground.
[[nodiscard]] MediaList LayersOf(const Scene& scene, const SceneGround& ground,
                                 const Medium& medium);

}  // namespace alpenglow::renderer
