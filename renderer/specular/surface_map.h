// SPDX-License-Identifier: MIT
// Light that spheres of glass and mirrors send onto a surface: a map of the points where photons reach
// it, and the irradiance there.
//
// Each photon spreads its power P over a disk of radius r of the surface, with the kernel
//
//   2 P / (pi r^2) (1 - d^2 / r^2)
//
// at the distance d (Jensen 1996, Global illumination using photon maps; Silverman 1986, Density
// estimation, 4.2: Epanechnikov's kernel in two dimensions). Structures narrower than r are lost. The
// surface counts as flat within r.
//
// Irradiances are per irradiance across the light at the spheres [1].
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "renderer/layer.h"
#include "renderer/specular/box_tree.h"
#include "renderer/specular/photon_beams.h"

namespace alpenglow::renderer {

/// Immutable; safe to use from many threads.
class SurfaceMap {
 public:
  /// @param beams  those that end on the surface count. Throws InputError unless the radius is positive
  ///     and finite.
  SurfaceMap(std::span<const PhotonBeam> beams, double radius_m);

  /// Returns the irradiance of the surface at a point on it. The noise of n random photons in the disk
  /// would be sqrt(4 / (3 n)) of it; photons of a sequence have less.
  [[nodiscard]] double Irradiance(const glm::dvec3& point) const;

 private:
  struct Spot {
    glm::dvec3 place;
    double area_m2;  // power per irradiance
  };
  [[nodiscard]] static std::vector<Spot> SpotsOf(std::span<const PhotonBeam> beams);
  [[nodiscard]] std::vector<Box> Boxes() const;

  double radius_m_;
  std::vector<Spot> spots_;
  BoxTree tree_;
};

}  // namespace alpenglow::renderer
