// SPDX-License-Identifier: MIT
// Light that slopes send to each other.
//
// A place whose horizon is above the plane of its surface sees other ground. SlopeViews walks
// outwards from the nodes of a coarse grid along kHorizonAzimuths directions, in growing steps, and
// keeps for each direction a few nodes that represent the ground in view. A strip between one
// elevation and the next higher one is weighted by the light that it would bring, and the kept
// nodes are at equal fractions of the total weight. For one position of the sun,
// TerrainInterreflection evaluates once the outgoing light of all nodes, and sums it for every node
// and direction. The air in between dims this light and adds its own, which is assumed to be that
// of the sky above the horizon there. A point of the picture weights the directions by its own
// normal and horizon. Light may be propagated between slopes several times; the first time
// contributes most of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "renderer/elevation/mesh.h"
#include "renderer/illumination/occluded_sky.h"
#include "renderer/visibility/horizon_map.h"

namespace alpenglow::renderer {

/// A node of the coarse grid as a place on the ground.
struct SlopePlace {
  glm::dvec3 point;
  glm::dvec3 normal;  // unit, of the plane through the neighbours
};

/// Visibility between the nodes of a coarse grid. Immutable.
class SlopeViews {
 public:
  static constexpr std::size_t kMostNodes = std::size_t{1} << 15;
  static constexpr std::size_t kStrips = 3;  // kept per direction

  /// @param heights  at most 2^24 nodes.
  SlopeViews(HeightRaster heights, const Medium& medium);

  [[nodiscard]] const HeightRaster& heights() const { return heights_; }
  [[nodiscard]] const std::vector<SlopePlace>& places() const { return places_; }
  /// Returns the light from a direction when all ground there has radiance 1, per radian of
  /// azimuth.
  [[nodiscard]] float Weight(std::size_t node, std::size_t azimuth) const {
    return weight_[node * kHorizonAzimuths + azimuth];
  }

  /// A visible node, and the optical depth of the air in front of it as a step of AirDepth.
  struct Seen {
    std::uint32_t node;
    std::uint8_t air;
  };
  [[nodiscard]] Seen At(std::size_t node, std::size_t azimuth, std::size_t strip) const {
    const std::uint32_t packed = seen_[(node * kHorizonAzimuths + azimuth) * kStrips + strip];
    return {packed & 0xFFFFFFU, static_cast<std::uint8_t>(packed >> 24)};
  }
  /// Returns the optical depth of a step, in the first band that the air dims.
  [[nodiscard]] static double AirDepth(std::uint8_t step);

 private:
  void Walk(std::size_t node, std::size_t azimuth, const Medium& medium);

  HeightRaster heights_;
  std::vector<SlopePlace> places_;
  std::vector<float> weight_;
  std::vector<std::uint32_t> seen_;
  float summit_m_;  // greatest height
};

/// Light between slopes for one position of the sun. Immutable; safe to use from many threads.
class TerrainInterreflection {
 public:
  /// Returns the light from sun and sky that a place reflects, as radiance per unit solar
  /// irradiance [1/sr], the same in all directions.
  using Outgoing = std::function<Spectrum(const SlopePlace& place)>;

  /// The result does not depend on the number of threads.
  /// @param mu_s  zenith cosine of the sun at the frame's origin.
  TerrainInterreflection(const SlopeViews& views, const Medium& medium, const Outgoing& outgoing,
                         const OccludedSkyIrradiance& sky, double mu_s);

  /// Returns the irradiance [1] from other ground, below the horizons.
  [[nodiscard]] Spectrum Irradiance(const glm::dvec3& point, const SurfaceSectors& surface,
                                    const Horizons& horizons) const;
  /// Returns the radiance [1/sr] of the ground that is visible in a horizontal direction.
  /// @param horizon  the sine of its elevation there.
  /// @param beyond  radiance that replaces ground which is almost absent from the coarse grid.
  [[nodiscard]] Spectrum Radiance(const glm::dvec3& point, const BetweenAzimuths& azimuth,
                                  double horizon, const Spectrum& beyond) const;

  [[nodiscard]] const SlopeViews& views() const { return views_; }
  /// SlopeViews::Weight times radiance: [node][azimuth][band], with the number of bands rounded up
  /// to a multiple of 4.
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
