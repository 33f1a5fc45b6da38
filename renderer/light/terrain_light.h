// SPDX-License-Identifier: MIT
// Light that slopes send to each other.
//
// Where the horizon of a place stands over the plane of its surface it sees other ground.
// SlopeViews walks from the nodes of a coarse grid outwards along kHorizonAzimuths directions, in
// steps that grow, and keeps for each direction a few nodes that stand for the ground in view:
// strips between one elevation and the next higher one weigh as much as the light that they bring,
// and the kept nodes lie at even shares of that weight. SlopeLight asks once, for one position of
// the sun, what all nodes send on, and sums it up for every node and direction; the air in between
// dims it and adds its own light, taken to be that of the sky over the horizon there. A point of
// the picture weighs the directions by its own normal and horizon. Light goes from slope to slope
// as often as it is asked to; once is most of it.
//
// Light of the sky, and of other slopes, on terrain that hides a part of the sky.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "renderer/ground/band_light.h"
#include "renderer/ground/reflectance.h"
#include "renderer/ground/scene_ground.h"
#include "renderer/light/open_sky.h"
#include "renderer/shadow/horizon_map.h"
#include "renderer/terrain/mesh.h"

namespace alpenglow::renderer {

/// A node of the coarse grid as a place on the ground.
struct SlopePlace {
  glm::dvec3 point;
  glm::dvec3 normal;  // unit, of the plane through the neighbours
};

/// What the nodes of a coarse grid see of each other. Immutable.
class SlopeViews {
 public:
  static constexpr std::size_t kMostNodes = std::size_t{1} << 15;
  static constexpr std::size_t kStrips = 3;  // kept a direction

  /// @param heights  at most 2^24 nodes.
  SlopeViews(HeightRaster heights, const Medium& medium);

  [[nodiscard]] const HeightRaster& heights() const { return heights_; }
  [[nodiscard]] const std::vector<SlopePlace>& places() const { return places_; }
  /// Light that a direction brings when all ground there has radiance 1, per radian of azimuth.
  [[nodiscard]] float Weight(std::size_t node, std::size_t azimuth) const {
    return weight_[node * kHorizonAzimuths + azimuth];
  }

  /// A node in view, and the step of kAirDepth that the air before it has.
  struct Seen {
    std::uint32_t node;
    std::uint8_t air;
  };
  [[nodiscard]] Seen At(std::size_t node, std::size_t azimuth, std::size_t strip) const {
    const std::uint32_t packed = seen_[(node * kHorizonAzimuths + azimuth) * kStrips + strip];
    return {packed & 0xFFFFFFU, static_cast<std::uint8_t>(packed >> 24)};
  }
  /// Optical depth of a step, in the first band that the air dims.
  [[nodiscard]] static double AirDepth(std::uint8_t step);

 private:
  void Walk(std::size_t node, std::size_t azimuth, const Medium& medium);

  HeightRaster heights_;
  std::vector<SlopePlace> places_;
  std::vector<float> weight_;
  std::vector<std::uint32_t> seen_;
  float summit_m_;  // the highest of the heights
};

/// For one position of the sun. Immutable; safe to ask from many threads.
class SlopeLight {
 public:
  /// What a place sends on of the light that comes from sun and sky, as radiance per unit solar
  /// irradiance [1/sr], the same in all directions.
  using Outgoing = std::function<BandLight(const SlopePlace& place)>;

  /// The same for any number of threads.
  /// @param mu_s  zenith cosine of the sun at the frame's origin.
  SlopeLight(const SlopeViews& views, const Medium& medium, const Outgoing& outgoing,
             const OpenSky& sky, double mu_s);

  /// Irradiance [1] that other ground brings, below the horizons.
  [[nodiscard]] BandLight Irradiance(const glm::dvec3& point, const SurfaceSectors& surface,
                                     const Horizons& horizons) const;
  /// Radiance [1/sr] of the ground that is seen in a horizontal direction.
  /// @param horizon  the sine of its elevation there.
  /// @param beyond  radiance of what is seen instead where the coarse grid has next to nothing of
  ///     that ground.
  [[nodiscard]] BandLight Radiance(const glm::dvec3& point, const BetweenAzimuths& azimuth,
                                   double horizon, const BandLight& beyond) const;

  [[nodiscard]] const SlopeViews& views() const { return views_; }
  /// SlopeViews::Weight times radiance: [node][azimuth][band], the number of bands rounded up to a
  /// multiple of 4.
  [[nodiscard]] std::span<const float> light() const { return light_; }

 private:
  struct Neighbours;
  void Gather(const std::vector<float>& sent, const std::vector<float>& through,
              const std::vector<float>& air);

  const SlopeViews& views_;
  std::size_t bands_, stride_;
  std::vector<float> light_;  // weight times radiance: [node][azimuth][band]
};

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
