// SPDX-License-Identifier: MIT
// The clouds of a sky in the mirror of level ground, as one eye sees it.
//
// A table over the azimuth and the elevation e of mirrored rays holds what clouds leave of the clear
// sky and what they add. The entry of a direction is that of the point of the mirror at which the eye
// sees it: for an eye at the height h the point at the distance along the ground
//
//   s = R (sqrt(tan(e)^2 + 2 h / R) - tan(e))
//
// on a planet of the radius R. Rays that waves mirror elsewhere have the clouds of their direction, as
// if they came from there. Entries are 0.7 degrees apart in azimuth and in elevation 0.3 degrees at 1
// and 1.6 degrees at 30; waves of calm water blur more. They are computed on demand.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <mutex>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// The change of the light of a clear sky by clouds.
struct CloudChange {
  Spectrum left;   // factor on the light of the clear sky
  Spectrum added;  // per unit solar irradiance [1/sr]
};

/// An eye over level ground, in the frame of a scene.
struct MirrorEye {
  glm::dvec3 foot;          // on the mirror, below the eye
  glm::dvec3 up{0, 0, 1};   // unit
  double height_m = 0.0;    // above the mirror
  double radius_m = 6.4e6;  // of the planet
};

/// Safe to use from many threads.
class MirroredClouds {
 public:
  using Trace = std::function<CloudChange(const glm::dvec3& point, const glm::dvec3& direction)>;

  /// @param trace  returns what clouds change along a ray; it is called from many threads.
  MirroredClouds(const MirrorEye& eye, Trace trace);

  /// Returns what clouds change in a direction, linear between entries.
  /// @param up  the vertical at the mirror, unit.
  [[nodiscard]] CloudChange Towards(const glm::dvec3& direction, const glm::dvec3& up) const;

  static constexpr int kAzimuths = 512, kElevations = 65;

 private:
  [[nodiscard]] const CloudChange& Entry(int azimuth, int elevation) const;

  MirrorEye eye_;
  glm::dvec3 east_, north_;
  Trace trace_;
  std::unique_ptr<std::once_flag[]> asked_;
  mutable std::vector<CloudChange> entry_;  // azimuth first
};

}  // namespace alpenglow::renderer
