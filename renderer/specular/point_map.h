// SPDX-License-Identifier: MIT
// A map of points where photons are scattered, and their light along a ray: the alternative to BeamMap.
//
// Each beam has one point at a random distance s, with a density that falls like the transmittance of the
// deepest band; its weight makes the mean right in every medium. A ray receives the light of the points
// within a radius r of it, P / (pi r^2) each (Jarosz, Zwicker and Jensen 2008, Comput. Graph. Forum 27,
// 557: a ray and points). Beams have less noise for the same number of photons: README.md.
//
// Radiances are per irradiance by the light above the media at the spheres [1/sr].
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "renderer/specular/beam_media.h"
#include "renderer/specular/box_tree.h"
#include "renderer/specular/photon_beams.h"

namespace alpenglow::renderer {

/// Immutable; safe to use from many threads.
class PointMap {
 public:
  /// Throws InputError unless the radius is positive and finite.
  /// @param seed  of the distances along beams.
  PointMap(std::span<const PhotonBeam> beams, LocalMedia media, double radius_m,
           std::uint64_t seed = 1);

  /// Returns the light that arrives at the origin of a ray.
  /// @param direction  unit, away from the origin. @param length_m  may be infinite.
  [[nodiscard]] SpectrumOf<double> Radiance(const glm::dvec3& origin, const glm::dvec3& direction,
                                            double length_m) const;

  /// Returns the memory of points and tree [bytes].
  [[nodiscard]] std::size_t bytes() const {
    return points_.all.size() * sizeof(Point) + points_.column_m.size() * sizeof(double) +
           tree_.bytes();
  }

 private:
  struct Point {
    glm::dvec3 place;
    glm::dvec3 direction;  // of its beam
    double weight;         // power per irradiance times the length of beam that it stands for
  };
  [[nodiscard]] std::vector<Box> Boxes() const;
  struct Points {
    std::vector<Point> all;
    std::vector<double> column_m;  // [point][medium]
  };
  [[nodiscard]] static Points PointsOn(std::span<const PhotonBeam> beams, const LocalMedia& media,
                                       std::uint64_t seed);

  LocalMedia media_;
  double radius_m_;
  Points points_;
  BoxTree tree_;
};

}  // namespace alpenglow::renderer
