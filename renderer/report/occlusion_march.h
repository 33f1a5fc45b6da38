// SPDX-License-Identifier: MIT
// This header provides the reference for light shafts: single scattering along a ray, with an
// occlusion ray against the terrain at each of many points, each towards a different point of the
// sun's disk.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "atmosphere/ray/single_scattering.h"
#include "renderer/layer.h"
#include "renderer/terrain/terrain.h"

namespace alpenglow::renderer {

/// A sun, an eye over terrain, and rays from the eye, in the frame of the terrain.
struct ShaftView {
  glm::dvec3 eye, to_sun;
  double sun_radius_rad;
  std::vector<glm::dvec3> directions;
};

/// Returns the rays of a picture that looks `heading_deg` from north, with the sun at a bearing of
/// 20 degrees from there: some rays pass close to the sun, some far from it.
[[nodiscard]] ShaftView ViewWithSun(double eye_height_m, double heading_deg,
                                    double sun_elevation_deg, int width, int height);

[[nodiscard]] ViewRay RayOf(const ShaftView& view, std::size_t i, double length_m);

/// Returns the distance at which ray i hits the terrain [m]; infinite if it does not.
[[nodiscard]] double LengthOf(const ShaftView& view, std::size_t i, const Terrain& terrain);

/// Returns the distance from the disk's centre, in radii, that contains a fraction of the disk's
/// light: inverts the integral of LimbDarkening by bisection.
[[nodiscard]] double RadiusOfLight(double share);

/// A point of the disk: distance from the centre in radii, and angle.
struct DiskPoint {
  double rho, angle;
};

/// Returns points of the R2 sequence of the plane (Roberts 2018), with a density proportional to
/// the brightness of the disk.
[[nodiscard]] const std::vector<DiskPoint>& DiskPoints();

/// Returns the sunlight, in [0, 1], that passes the terrain at points of a ray. Each point has one
/// occlusion ray, towards successive points of the disk from number `first` on.
[[nodiscard]] std::vector<float> OccludedSunlight(const ShaftView& view,
                                                  const glm::dvec3& direction,
                                                  const Terrain& terrain,
                                                  std::span<const double> distances_m,
                                                  std::size_t first = 0);

/// Returns single scattering along ray i, by `count` equal steps in a coordinate that is dense near
/// the eye: t = length v / (1 + k (1 - v)), with half of the steps in the first 30 km.
/// @param offset  of the points in their steps, in [0, 1); it also selects the points of the disk.
[[nodiscard]] ScatteredOnce<float> MarchWithOcclusion(const SingleScattering<float>& air,
                                                      const ShaftView& view, std::size_t i,
                                                      const Terrain& terrain, int count,
                                                      double offset = 0.5);

}  // namespace alpenglow::renderer
