// SPDX-License-Identifier: MIT
// This header provides the surroundings of lamps: ground, and air as layers of exponential density.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "atmosphere/lamp/lamp.h"
#include "atmosphere/medium/medium.h"
#include "renderer/scene/scene.h"
#include "renderer/surface/scene_ground.h"

namespace alpenglow::renderer {

/// Ground and air layers that lamps are placed in. Immutable, safe to share between threads. Refers
/// to the ground.
class LampStage {
 public:
  LampStage(const Scene& scene, const SceneGround& ground, const Medium& medium);

  [[nodiscard]] const SceneGround& ground() const { return *ground_; }
  /// Layers of molecules, of aerosol, and those of the scene.
  [[nodiscard]] const std::vector<LampLayer>& layers() const { return layers_; }
  [[nodiscard]] std::size_t bands() const { return bands_; }
  [[nodiscard]] double planet_radius_m() const { return planet_radius_m_; }

  [[nodiscard]] double AltitudeOf(const glm::dvec3& point) const;
  [[nodiscard]] glm::dvec3 UpAt(const glm::dvec3& point) const;
  /// Returns the terrain below a point, along z (SurfaceUnderPoint).
  [[nodiscard]] std::optional<SurfaceUnder> TerrainAt(const glm::dvec3& point) const;
  /// Returns the height of the terrain there [m along z], or `otherwise` without terrain.
  [[nodiscard]] double TerrainUnder(const glm::dvec3& point, double otherwise) const;
  /// Returns the height above the terrain [m]; 0 below it.
  [[nodiscard]] double HeightOverGround(const glm::dvec3& point) const;
  /// Returns whether neither terrain nor the planet lies between two points.
  [[nodiscard]] bool Sees(const glm::dvec3& from, const glm::dvec3& to) const;

  /// Returns whether terrain or the planet shades a surface from a lamp.
  /// @param smooth_point  TerrainHit::smooth_point, where shadow rays start.
  /// @param geometric_normal  unit.
  [[nodiscard]] bool Shades(const Lamp& lamp, const glm::dvec3& smooth_point,
                            const glm::dvec3& geometric_normal) const;

  /// Returns the height of the sphere of the planet at a point [m along z].
  [[nodiscard]] double PlanetUnder(const glm::dvec3& point) const;

  /// Returns the layers above the plane that touches the sphere below a point.
  [[nodiscard]] LampAir AirAround(const glm::dvec3& middle) const;
  /// Returns the transmittance of the layers of the scene alone.
  [[nodiscard]] Spectrum LayerTransmittance(const glm::dvec3& from, const glm::dvec3& direction,
                                            double length_m) const;

 private:
  /// Returns whether the planet lies between two points. Where terrain covers the planet, only
  /// terrain hides: a basin can lie below the sphere.
  [[nodiscard]] bool HiddenByPlanet(const glm::dvec3& from, const glm::dvec3& to) const;

  const SceneGround* ground_;
  double planet_radius_m_;
  std::vector<LampLayer> layers_;
  std::size_t bands_;
};

}  // namespace alpenglow::renderer
