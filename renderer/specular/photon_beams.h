// SPDX-License-Identifier: MIT
// Photons that a distant light sends onto spheres of glass and mirrors, followed to the ground or to the
// end of the scene. The straight parts of their paths behind a sphere are the beams that light a medium.
//
// A photon stands for a part of the disk of cross-section pi R^2 that a sphere holds into the light. It
// starts from a point of the light's disk, with the sun's limb darkening, at a point of the
// cross-section; both are points of Halton's sequence, shifted by the seed (Cranley and Patterson 1976,
// SIAM J. Numer. Anal. 13, 904). At a sphere it takes one order of DividedRay with the probability of
// its power, so that all photons keep their power (Russian roulette, Arvo and Kirk 1990, SIGGRAPH 24,
// 63).
// Light that another sphere takes first is counted there.
//
// Powers are areas: the power per irradiance by the light on a plane across it. They do not include
// attenuation, which a map of the beams adds for its medium.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "renderer/specular/specular_sphere.h"

namespace alpenglow::renderer {

/// A disk in the sky.
struct DiskOfLight {
  glm::dvec3 to_light{0.0, 0.0, 1.0};  // unit
  double radius_rad = 0.0;             // 0: parallel light
};

struct PhotonBeam {
  glm::dvec3 origin, direction;  // the direction is a unit vector
  double length_m;
  double area_m2;  // power per irradiance
  /// The number of beams that led to this one. The beam of the leg before is the one before in the list.
  int leg;
  bool ends_on_surface = false;  // at DistanceToEnd, before a sphere and before `longest_m`
};

inline constexpr double kMostPhotons = 1e7;

struct PhotonOptions {
  int photons = 100000;    // in [1, 1e7]
  std::uint64_t seed = 1;  // of the shift of the sequence
  double longest_m = 1e4;  // of a beam, > 0
};

/// Returns the distance along a ray to what ends a beam, such as the ground [m]; may be infinite.
using DistanceToEnd = std::function<double(const glm::dvec3& origin, const glm::dvec3& direction)>;

/// Returns the beams of all photons, in their order. The result does not depend on the number of
/// threads. Throws InputError for options or spheres out of range.
/// @param spheres  apart from each other. @param end  must be safe to call from many threads.
[[nodiscard]] std::vector<PhotonBeam> FollowPhotons(std::span<const SpecularSphere> spheres,
                                                    const DiskOfLight& light,
                                                    const PhotonOptions& options,
                                                    const DistanceToEnd& end);

}  // namespace alpenglow::renderer
