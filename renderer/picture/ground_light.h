// SPDX-License-Identifier: MIT
// What a point of the ground sends towards the eye: light of the sun's disk, of the sky and of
// lamps, reflected by what the ground is made of.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>

#include "renderer/ground/band_light.h"
#include "renderer/ground/scene_geometry.h"
#include "renderer/ground/surface.h"
#include "renderer/lamp/lamp_light.h"
#include "renderer/light/lighting.h"
#include "renderer/light/picture_stokes.h"
#include "renderer/light/terrain_light.h"
#include "renderer/media/media_light.h"

namespace alpenglow::renderer {

/// A point of the ground as an eye meets it, whatever shines on it.
struct SeenGround {
  GroundPatch patch;
  Hit hit;            // with the normal of water where that is
  BandLight albedo;   // of its body towards the eye
  glm::dvec3 up;      // unit
  glm::dvec3 to_eye;  // unit
};

/// Light that leaves the ground towards the eye, of a distant light and its sky.
struct NaturalRadiance {
  BandLight radiance;            // W m^-2 sr^-1 nm^-1
  float disk_visibility = 0.0F;  // the part of the disk that is seen, 0 to 1
};

/// The ground of a scene, whatever air is over it.
struct GroundParts {
  const SceneGround& ground;
  const SceneGeometry& geometry;
  const LampLight& lamps;
  const HorizonsOnDemand& horizons;
  const GroundMaterial& material;
};

/// What shines on the ground.
struct GroundSources {
  const Lighting& light;
  const MediaLight* media = nullptr;  // fog and volumes between sun, sky and ground; null: none
};

/// Immutable, safe to share between threads. Refers to what it was made from.
class GroundLight {
 public:
  GroundLight(const GroundParts& parts, const SunlitAir& air);

  /// What terrain makes of the light of sky and sun, as far as the effects of the light say; null
  /// where it makes nothing of it.
  [[nodiscard]] std::shared_ptr<const TerrainLight> OnTerrain(const GroundSources& from) const;

  /// @param hit  of terrain or planet; to_eye: unit. @param light  its surface and waves count.
  [[nodiscard]] SeenGround SeenFrom(const Hit& hit, const glm::dvec3& to_eye,
                                    const Lighting& light) const;

  /// What a light and its sky make it send towards the eye.
  /// @param disk_sample  a point of the light's disk, uniform in the unit square: penumbrae average
  ///     over samples.
  [[nodiscard]] NaturalRadiance Natural(const SeenGround& seen, const GroundSources& from,
                                        std::array<double, 2> disk_sample) const;

  /// The same of lamps, W m^-2 sr^-1 nm^-1. @param near  those that may light it.
  [[nodiscard]] BandLight OfLamps(const SeenGround& seen, const LampNodes& near) const;

  /// Q and U of what water mirrors of sun and sky, in the axes of the picture: as of unpolarised
  /// light, which that of the sky is not. A part p of it that is polarised changes what a wave near
  /// Brewster's angle shows of it by up to p. Everything else that the ground sends counts as
  /// unpolarised.
  [[nodiscard]] PolarisedLight Polarised(const SeenGround& seen, const GroundSources& from,
                                         const PictureAxes& axes,
                                         std::array<double, 2> disk_sample) const;

  [[nodiscard]] LocalSun LocalSunAt(const glm::dvec3& point, const Lighting& light) const;

 private:
  /// Cosine between the shading normal and a point of the disk, in whose direction it is asked; 0 where terrain or the planet
  /// stands before it.
  [[nodiscard]] double LitCosine(const Hit& hit, const Lighting& light, const LocalSun& sun,
                                 const glm::dvec3& to_disk) const;
  /// Of the sun through the air, per unit solar irradiance [1]; nothing in the shade.
  [[nodiscard]] std::optional<BandLight> SunIrradiance(const Hit& hit, const GroundSources& from,
                                                       const LocalSun& sun,
                                                       const glm::dvec3& to_disk) const;
  [[nodiscard]] BandLight SkyIrradiance(const Hit& hit, const GroundSources& from,
                                        const LocalSun& sun) const;
  /// What a slope sends to others, per unit solar irradiance [1/sr].
  [[nodiscard]] BandLight SentToSlopes(const SlopePlace& place, const GroundSources& from,
                                       const TerrainLight& sky) const;
  /// @param cosine  of eye and normal of the mesh.
  [[nodiscard]] GroundPatch PatchAt(const Hit& hit, const Lighting& light, const glm::dvec3& up,
                                    double cosine) const;
  /// Of the sky, and of slopes before it, in a glossy surface, per unit solar irradiance [1/sr].
  [[nodiscard]] BandLight Mirrored(const GroundPatch& patch, const Hit& hit,
                                   const glm::dvec3& to_eye, const Lighting& light,
                                   const LocalSun& sun) const;
  /// What is seen of it in a mirrored ray.
  [[nodiscard]] BandLight SeenIn(const MirroredRay& ray, const Hit& hit, const Lighting& light,
                                 const LocalSun& sun) const;

  GroundParts parts_;
  const AirIntegrator<float>& air_;
  const BentBeam& beam_;
  const DiffuseLight& diffuse_;
};

}  // namespace alpenglow::renderer
