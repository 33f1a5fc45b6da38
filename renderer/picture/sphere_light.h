// SPDX-License-Identifier: MIT
// Spheres of glass and mirrors of a scene: their places, and the light that one distant light sends
// through them onto the ground and into media (caustics).
//
// The spheres of a scene share the sunlight at the first of them that is lit: they stand near each
// other. Beams end at the ground, or after 12 radii of the largest sphere. The radius of beams or points
// is half a pixel at the nearest sphere, or more where the photons are too few for that: points need a
// wider one. On the ground, light is found up to 200 radii away, and has at least the radius with which
// evenly spread photons have a noise of 6 %.
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "renderer/media/local_media.h"
#include "renderer/scene/scene.h"
#include "renderer/specular/beam_map.h"
#include "renderer/specular/point_map.h"
#include "renderer/specular/specular_sphere.h"
#include "renderer/specular/surface_map.h"
#include "renderer/surface/scene_geometry.h"
#include "renderer/surface/scene_ground.h"

namespace alpenglow::renderer {

/// Returns the spheres of a scene in the frame of its ground. Throws InputError "scene.toml:
/// object[0].height_m ..." for a sphere whose underside is below the ground.
[[nodiscard]] std::vector<SpecularSphere> SpheresOf(const Scene& scene, const SceneGround& ground);

/// The surroundings of spheres in one light.
struct SphereSurroundings {
  const std::vector<SpecularSphere>& spheres;
  const SceneGeometry& geometry;
  DiskOfLight light;
  Spectrum irradiance;  // at the spheres, W m^-2 nm^-1
  int photons;
  PhotonMap map;
  glm::dvec3 eye;
  double pixel_rad;
};

/// The caustics of one light. Immutable; safe to use from many threads.
class Caustics {
 public:
  /// @param media  nothing: caustics on the ground alone.
  Caustics(const SphereSurroundings& around, const std::optional<LocalMedia>& media);

  /// Returns the light that media send to the origin of a ray [W m^-2 sr^-1 nm^-1].
  [[nodiscard]] Spectrum Along(const glm::dvec3& origin, const glm::dvec3& direction,
                               double length_m) const;
  /// Returns the irradiance of the ground at a point [W m^-2 nm^-1].
  [[nodiscard]] Spectrum OnGround(const glm::dvec3& point) const;

 private:
  using MediaMap = std::variant<BeamMap, PointMap>;
  Caustics(const SphereSurroundings& around, const std::optional<LocalMedia>& media,
           std::vector<PhotonBeam> beams);
  [[nodiscard]] static std::optional<MediaMap> MapOf(const SphereSurroundings& around,
                                                     const std::optional<LocalMedia>& media,
                                                     std::vector<PhotonBeam> beams);

  Spectrum irradiance_;
  SurfaceMap on_ground_;
  std::optional<MediaMap> in_media_;
};

}  // namespace alpenglow::renderer
