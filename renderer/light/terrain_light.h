// SPDX-License-Identifier: MIT
// Light of the sky, and of other slopes, on terrain that hides a part of the sky.
#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include "renderer/ground/reflectance.h"
#include "renderer/ground/scene_ground.h"
#include "renderer/light/open_sky.h"
#include "renderer/light/slope_light.h"
#include "renderer/shadow/horizon_map.h"

namespace alpenglow::renderer {

/// What terrain hides from its places, whatever shines. Immutable.
class TerrainHorizons {
 public:
  TerrainHorizons(const TriangleMesh& mesh, const Medium& medium);

  [[nodiscard]] const HorizonMap& map() const { return map_; }
  [[nodiscard]] const SlopeViews& views() const { return views_; }
  /// Of the ground; altitudes are those over the frame's plane.
  [[nodiscard]] const OpenSky::Extent& extent() const { return extent_; }

 private:
  TerrainHorizons(const HeightRaster& heights, const TriangleMesh& mesh, const Medium& medium);

  HorizonMap map_;
  SlopeViews views_;
  OpenSky::Extent extent_;
};

/// The horizons of a scene, made when first asked for: not every picture needs them.
class HorizonsOnDemand {
 public:
  /// Refers to both.
  HorizonsOnDemand(const SceneGround& ground, const Medium& medium)
      : ground_(ground), medium_(medium) {}

  /// Null for no terrain and for ground that is not one surface.
  [[nodiscard]] std::shared_ptr<const TerrainHorizons> Get() const;

 private:
  const SceneGround& ground_;
  const Medium& medium_;
  mutable std::once_flag once_;
  mutable std::shared_ptr<const TerrainHorizons> made_;
};

/// A place on terrain and how a surface lies there.
struct SlopePoint {
  glm::dvec3 point;
  glm::dvec3 normal;  // unit, in the frame
  glm::dvec3 up;      // unit: the vertical there
  double altitude_m;
  double mu_s;  // zenith cosine there of the sun that lights the air
};

/// For one position of the sun. Immutable; safe to ask from many threads.
///
/// Error of Irradiance against rays that meet sky, air and slopes, the slopes lit by sun and sky,
/// over rough mountains with the sun at 30 degrees: root mean square below 4 % with an albedo of
/// 0.15 (without horizons, from the moments of the light: more than three times that), below 9 %
/// with 0.8; the mean is off by less than half of that.
class TerrainLight {
 public:
  /// Light of the sky alone.
  /// @param horizons  null: a plain.
  TerrainLight(std::shared_ptr<const TerrainHorizons> horizons, const AirIntegrator<float>& air,
               const DiffuseLight& diffuse, const glm::dvec3& to_sun);

  [[nodiscard]] const OpenSky& sky() const { return sky_; }
  [[nodiscard]] const TerrainHorizons* horizons() const { return horizons_.get(); }
  /// Null before AddSlopes.
  [[nodiscard]] const SlopeLight* slopes() const { return slopes_ ? &*slopes_ : nullptr; }

  /// Adds what slopes send to each other. Needs horizons.
  void AddSlopes(const Medium& medium, const SlopeLight::Outgoing& outgoing, double mu_s);

  /// Per unit solar irradiance [1].
  struct OnSlope {
    BandLight sky, slopes;
  };
  /// Needs horizons.
  [[nodiscard]] OnSlope On(const SlopePoint& at) const;
  /// Of sky and slopes, per unit solar irradiance [1]. Needs horizons.
  [[nodiscard]] BandLight Irradiance(const SlopePoint& at) const {
    const OnSlope on = On(at);
    return on.sky + on.slopes;
  }

  /// Radiance [1/sr] of the sky in a direction, whatever stands before it.
  [[nodiscard]] BandLight SkyRadiance(const SlopePoint& at, const glm::dvec3& direction) const;
  /// Radiance [1/sr] in a direction: of the sky, and of the ground there as far as the directions
  /// that it stands for lie below the horizon. Needs horizons.
  [[nodiscard]] BandLight Radiance(const SlopePoint& at, const glm::dvec3& direction,
                                   const Spread& spread = {}) const;

 private:
  std::shared_ptr<const TerrainHorizons> horizons_;
  OpenSky sky_;
  std::optional<SlopeLight> slopes_;
};

}  // namespace alpenglow::renderer
