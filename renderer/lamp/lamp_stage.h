// SPDX-License-Identifier: MIT
// What the lamps of a scene stand in: its ground, and its molecules, aerosol and fog as layers of
// exponential density.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "atmosphere/air/medium.h"
#include "atmosphere/lamp/lamp.h"
#include "renderer/ground/ground_heights.h"
#include "renderer/ground/scene_ground.h"
#include "renderer/scene/scene.h"

namespace alpenglow::renderer {

/// Immutable, safe to share between threads. Refers to the ground.
class LampStage {
 public:
  LampStage(const Scene& scene, const SceneGround& ground, const Medium& medium);

  [[nodiscard]] const SceneGround& ground() const { return *ground_; }
  /// Fog is the last.
  [[nodiscard]] const std::vector<LampLayer>& layers() const { return layers_; }
  [[nodiscard]] std::size_t bands() const { return bands_; }

  [[nodiscard]] double AltitudeOf(const glm::dvec3& point) const;
  [[nodiscard]] glm::dvec3 UpAt(const glm::dvec3& point) const;
  /// The terrain that a point is over, along z (SurfaceUnderPoint).
  [[nodiscard]] std::optional<SurfaceUnder> TerrainAt(const glm::dvec3& point) const;
  /// Its height there [m along z], or `otherwise`.
  [[nodiscard]] double TerrainUnder(const glm::dvec3& point, double otherwise) const;
  /// Over the terrain [m]; a point below it has none.
  [[nodiscard]] double HeightOverGround(const glm::dvec3& point) const;
  /// Whether no terrain stands between two points.
  [[nodiscard]] bool Sees(const glm::dvec3& from, const glm::dvec3& to) const;

  /// Whether terrain keeps a lamp's light from a surface.
  /// @param smooth_point  TerrainHit's, which shadow rays begin at; geometric_normal: unit.
  [[nodiscard]] bool Shades(const Lamp& lamp, const glm::dvec3& smooth_point,
                            const glm::dvec3& geometric_normal) const;

  /// The layers over the plane that touches the sphere below a point.
  [[nodiscard]] LampAir AirAround(const glm::dvec3& middle) const;
  /// Of the fog alone.
  [[nodiscard]] Bands<float> FogTransmittance(const glm::dvec3& from, const glm::dvec3& direction,
                                              double length_m) const;

 private:
  const SceneGround* ground_;
  double planet_radius_m_;
  std::vector<LampLayer> layers_;
  bool has_fog_;
  std::size_t bands_;
};

}  // namespace alpenglow::renderer
