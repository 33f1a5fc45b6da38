// SPDX-License-Identifier: MIT
// The caustic of a glass sphere under a wide light: a reference by cones, and paths from the eye.
//
// The light is a disk behind the sphere of sphere_caustic.h, around the direction -z, with the limb
// darkening of the sun. The reference is the mean of SphereCaustic over points of the disk.
//
// A path starts at the eye. It is scattered once, at a distance drawn from the transmittance of the fog,
// into a direction drawn from its phase function, and takes one order of DividedRay at the sphere. It
// finds light only if it leaves the sphere towards the disk: never, if the light is parallel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>

#include "renderer/cloud_light/cloud_path_tracer.h"
#include "renderer/layer.h"
#include "renderer/report/sphere_caustic.h"

namespace alpenglow::renderer {

/// A ray of sight of finite length.
struct CausticRay {
  glm::dvec3 eye, direction;  // the direction is a unit vector
  double length_m;
};

/// Points of the disk of a light: those of the R2 sequence of the plane (Roberts 2018) from number
/// `first` on.
struct DiskSample {
  double radius_rad;
  std::size_t first, count;
};

/// Returns the mean light of cones over points of a disk, per irradiance [1/sr].
[[nodiscard]] double LightOfCones(const SphereCaustic& cones, const CausticRay& ray,
                                  const DiskSample& disk);

/// Returns the light that paths find, per irradiance [1/sr], with its standard error.
/// @param light_radius_rad  of the disk, below 0.5; 0: the light is 0.
[[nodiscard]] CloudEstimate LightOfGlassPaths(const ThinFog& fog, double light_radius_rad,
                                              const CausticRay& ray, std::size_t paths,
                                              std::uint64_t seed);

}  // namespace alpenglow::renderer
