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
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "renderer/ground/band_light.h"
#include "renderer/light/open_sky.h"
#include "renderer/shadow/horizon_map.h"
#include "renderer/terrain/height_raster.h"

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

}  // namespace alpenglow::renderer
