// SPDX-License-Identifier: MIT
// Radiance that a point of the ground sends towards the eye: light of the sun's disk, of the sky
// and of lamps, reflected by the material of the ground.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "lut/multiple_scattering/polarised_scattering.h"
#include "lut/multiple_scattering/solved_air.h"
#include "renderer/illumination/lighting.h"
#include "renderer/illumination/terrain_irradiance.h"
#include "renderer/lamps/lamp_light.h"
#include "renderer/lit_clouds/lit_clouds.h"
#include "renderer/media/media_light.h"
#include "renderer/specular/specular_sphere.h"
#include "renderer/surface/scene_geometry.h"
#include "renderer/surface/surface.h"

namespace alpenglow::renderer {

/// A point of the ground as the eye sees it, independent of the illumination.
struct SeenGround {
  GroundPatch patch;
  Hit hit;            // on water, with the normal of the water surface
  Spectrum albedo;    // albedo of the body of the material, towards the eye
  glm::dvec3 up;      // unit
  glm::dvec3 to_eye;  // unit
};

/// Light of a distant source and of its sky that leaves the ground towards the eye.
struct NaturalRadiance {
  Spectrum radiance;             // W m^-2 sr^-1 nm^-1
  float disk_visibility = 0.0F;  // visible fraction of the disk, 0 to 1
};

/// The ground of a scene, independent of the air over it.
struct GroundParts {
  const SceneGround& ground;
  const SceneGeometry& geometry;
  const LampLight& lamps;
  const HorizonsOnDemand& horizons;
  const GroundMaterial& material;
  const std::vector<SpecularSphere>* spheres = nullptr;  // they cast shadows; null: none
};

/// Light sources of the ground.
struct GroundSources {
  const Lighting& light;
  // Between sun, sky and ground; null: none.
  const MediaLight* media = nullptr;
  const LitClouds* clouds = nullptr;
};

/// Immutable, safe to share between threads. Refers to the parts of the ground.
class GroundLight {
 public:
  GroundLight(const GroundParts& parts, const SolvedAir& air);

  /// Returns the light of sky and sun on terrain, computed as far as the effects of the light
  /// include it; null if terrain does not change that light.
  [[nodiscard]] std::shared_ptr<const TerrainIrradiance> OnTerrain(const GroundSources& from) const;

  /// @param hit  on terrain or planet. @param to_eye  unit. @param light  its surface and waves are
  ///     used.
  [[nodiscard]] SeenGround SeenFrom(const Hit& hit, const glm::dvec3& to_eye,
                                    const Lighting& light) const;

  /// Returns the radiance towards the eye that a distant light and its sky cause.
  /// @param disk_sample  a point of the light's disk, uniform in the unit square: penumbrae average
  ///     over samples.
  [[nodiscard]] NaturalRadiance Natural(const SeenGround& seen, const GroundSources& from,
                                        std::array<double, 2> disk_sample) const;

  /// Returns the radiance towards the eye that lamps cause, W m^-2 sr^-1 nm^-1. @param near  lamps
  /// that can light the point.
  [[nodiscard]] Spectrum OfLamps(const SeenGround& seen, const LampNodes& near) const;

  /// Returns the radiance towards the eye that media that glow cause, W m^-2 sr^-1 nm^-1.
  [[nodiscard]] Spectrum OfGlow(const SeenGround& seen, const MediaLight& media) const;

  /// Returns Q and U of the light of sun and sky that water mirrors, in the axes of the picture.
  /// The incident light is taken as unpolarised, although light of the sky is polarised. A degree
  /// of polarisation p of the incident light changes the result for a wave near Brewster's angle by
  /// up to p. All other light from the ground is taken as unpolarised.
  [[nodiscard]] PolarisedLight Polarised(const SeenGround& seen, const GroundSources& from,
                                         const ViewAxes& axes,
                                         std::array<double, 2> disk_sample) const;

  /// Returns the irradiance of a light on a surface that faces it, at a point above the ground, per
  /// irradiance above the air [1]; no value in the shade. Spheres cast no shadow on it.
  [[nodiscard]] std::optional<Spectrum> InAir(const glm::dvec3& point,
                                              const GroundSources& from) const;

  [[nodiscard]] LocalLight LocalLightAt(const glm::dvec3& point, const Lighting& light) const;

 private:
  /// Returns the cosine between the shading normal and the direction to a point of the disk; 0
  /// where terrain or the planet occludes that point.
  [[nodiscard]] double LitCosine(const Hit& hit, const Lighting& light, const LocalLight& sun,
                                 const glm::dvec3& to_disk) const;
  /// Returns the irradiance of the sun through the air, per unit solar irradiance [1]; no value in
  /// the shade.
  [[nodiscard]] std::optional<Spectrum> SunIrradiance(const Hit& hit, const GroundSources& from,
                                                      const LocalLight& sun,
                                                      const glm::dvec3& to_disk) const;
  /// Returns `cosine` times the transmittance of air, clouds and media for the visible part of the
  /// light's disk.
  [[nodiscard]] Spectrum BeamThrough(const glm::dvec3& point, const GroundSources& from,
                                     const LocalLight& sun, const glm::dvec3& to_disk,
                                     double cosine) const;
  [[nodiscard]] Spectrum SkyIrradiance(const Hit& hit, const GroundSources& from,
                                       const LocalLight& sun) const;
  /// Returns the radiance that a slope sends to other slopes, per unit solar irradiance [1/sr].
  [[nodiscard]] Spectrum SentToSlopes(const SlopePlace& place, const GroundSources& from,
                                      const TerrainIrradiance& sky) const;
  /// @param cosine  between the direction to the eye and the normal of the mesh.
  [[nodiscard]] GroundPatch PatchAt(const Hit& hit, const Lighting& light, const glm::dvec3& up,
                                    double cosine) const;
  /// Returns the radiance of the sky, of clouds and of the slopes in front of them, mirrored in a glossy
  /// surface, per unit solar irradiance [1/sr].
  [[nodiscard]] Spectrum Mirrored(const SeenGround& seen, const GroundSources& from,
                                  const LocalLight& sun) const;
  /// Returns the radiance that arrives along a mirrored ray, per unit solar irradiance [1/sr].
  [[nodiscard]] Spectrum SeenIn(const MirroredRay& ray, const Hit& hit, const GroundSources& from,
                                const LocalLight& sun) const;

  GroundParts parts_;
  SolvedAir air_;
};

}  // namespace alpenglow::renderer
