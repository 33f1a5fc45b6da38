// SPDX-License-Identifier: MIT
// What the ground of a scene is made of, place by place, and how it sends light on.
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>

#include "renderer/ground/band_light.h"
#include "renderer/ground/colour_drape.h"
#include "renderer/ground/reflectance.h"
#include "renderer/ground/surface.h"
#include "renderer/scene/scene.h"

namespace alpenglow::renderer {

class GroundMaterial;

/// The ground at a place: how it sends light on.
class GroundPatch {
 public:
  /// @param albedo  of the diffuse body; not used by water and snow.
  GroundPatch(const GroundMaterial& material, GroundCover::Kind kind, BandLight albedo)
      : material_(material), kind_(kind), albedo_(std::move(albedo)) {}
  /// Water.
  GroundPatch(const GroundMaterial& material, const GroundPoint& at);

  [[nodiscard]] bool IsWater() const { return kind_ == GroundCover::Kind::kWater; }
  /// Of water, with the waves that are resolved there.
  [[nodiscard]] glm::dvec3 WaterNormal(const glm::dvec3& up) const { return waves_.Normal(up); }
  /// Whether it mirrors the sky.
  [[nodiscard]] bool IsGlossy() const {
    return IsWater() || kind_ == GroundCover::Kind::kBlinnPhong;
  }

  /// Radiance over irradiance from one direction [1/sr].
  [[nodiscard]] BandLight Brdf(const ReflectionAngles& at) const;
  /// Of water, the part of it that the surface mirrors.
  [[nodiscard]] double Glitter(const ReflectionAngles& at) const {
    return Water::Glitter(at, waves_.slope_variance);
  }
  /// Share of an even sky that is sent to an eye, but for what is mirrored.
  [[nodiscard]] BandLight BodyAlbedo(double mu_eye) const;
  /// Empty for what is not glossy.
  [[nodiscard]] MirroredRays Mirrored(const glm::dvec3& normal, const glm::dvec3& to_eye) const;

 private:
  const GroundMaterial& material_;
  GroundCover::Kind kind_;
  BandLight albedo_;
  WavySurface waves_{0.0, 0.0, 0.0};
};

/// Immutable; safe to ask from many threads.
class GroundMaterial {
 public:
  /// @param drape  colours or land cover over the terrain, or nothing.
  GroundMaterial(const GroundCover& cover, std::shared_ptr<const ColourDrape> drape,
                 std::span<const double> wavelengths_nm);

  /// The terrain at a point.
  /// @param at  the point as its material sees it; normal_up: vertical component of the normal of
  ///     the mesh.
  /// @param season  what covers mountains.
  [[nodiscard]] GroundPatch OfTerrain(const GroundPoint& at, const glm::dvec3& point,
                                      double normal_up, const MountainSurface& season) const;
  /// The planet beyond terrain.
  /// @param planet_albedo  where the cover is that of mountains: of the season's low land around
  ///     terrain, the medium's where there is none.
  [[nodiscard]] GroundPatch OfPlanet(const GroundPoint& at, const BandLight& planet_albedo) const;

  /// Whether any of it mirrors the sky.
  [[nodiscard]] bool HasGloss() const;

  [[nodiscard]] const GroundCover& cover() const { return cover_; }
  [[nodiscard]] const ColourDrape* drape() const { return drape_.get(); }
  [[nodiscard]] const BandsOfColour& bands_of_colour() const { return bands_of_colour_; }
  /// Of the cover's one colour.
  [[nodiscard]] const BandLight& albedo() const { return albedo_; }
  [[nodiscard]] const RoughDiffuse& rough() const { return rough_; }
  [[nodiscard]] const Glossy& glossy() const { return glossy_; }
  [[nodiscard]] const Water& water() const { return water_; }
  [[nodiscard]] const Snow& snow() const { return snow_; }
  /// The highest ground that is sea; nothing: there is none.
  [[nodiscard]] std::optional<double> WaterLine_m() const;

 private:
  friend class GroundPatch;
  /// @param draped  what the drape shows there.
  [[nodiscard]] BandLight AlbedoAt(const GroundPoint& at, double normal_up,
                                   const MountainSurface& season,
                                   const std::optional<std::array<double, 3>>& draped) const;
  [[nodiscard]] bool HasLandCover() const { return drape_ && drape_->IsLandCover(); }

  GroundCover cover_;
  std::shared_ptr<const ColourDrape> drape_;
  BandsOfColour bands_of_colour_;
  BandLight albedo_;
  RoughDiffuse rough_;
  Glossy glossy_;
  Water water_;
  Snow snow_;
};

}  // namespace alpenglow::renderer
