// SPDX-License-Identifier: MIT
// What shafts are held against: light scattered once along a ray, with an occlusion ray against the
// terrain at each of many points of it, every one towards another point of the sun's disk.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "atmosphere/ray/single_scattering.h"
#include "renderer/layer.h"
#include "renderer/terrain/terrain.h"

namespace alpenglow::renderer {

/// A sun, an eye over terrain and rays from it, in the frame of the terrain.
struct ShaftView {
  glm::dvec3 eye, to_sun;
  double sun_radius_rad;
  std::vector<glm::dvec3> directions;
};

/// Rays of a picture that looks `heading_deg` from north, with the sun at a bearing of 20 degrees
/// from there: some rays pass close to the sun, some far from it.
[[nodiscard]] ShaftView ViewWithSun(double eye_height_m, double heading_deg,
                                    double sun_elevation_deg, int width, int height);

[[nodiscard]] ViewRay RayOf(const ShaftView& view, std::size_t i, double length_m);

/// Where ray i meets the terrain [m]; infinite where it does not.
[[nodiscard]] double LengthOf(const ShaftView& view, std::size_t i, const Terrain& terrain);

/// Distance from the disk's centre, in radii, within which a share of its light comes: inverts the
/// integral of LimbDarkening by halving.
[[nodiscard]] double RadiusOfLight(double share);

/// A point of the disk: distance from the centre in radii, and angle.
struct DiskPoint {
  double rho, angle;
};

/// Points of the plane's R2 sequence (Roberts 2018), as dense as the disk is bright.
[[nodiscard]] const std::vector<DiskPoint>& DiskPoints();

/// Sunlight, in [0, 1], that passes the terrain at points of a ray: one occlusion ray each, towards
/// the points of the disk from the `first` one on.
[[nodiscard]] std::vector<float> OccludedSunlight(const ShaftView& view,
                                                  const glm::dvec3& direction,
                                                  const Terrain& terrain,
                                                  std::span<const double> distances_m,
                                                  std::size_t first = 0);

/// Light scattered once along ray i, by `count` equal steps in a distance that is dense near the
/// eye: t = length v / (1 + k (1 - v)), with half of the steps in the first 30 km.
/// @param offset  of the points in their steps, in [0, 1); also says which points of the disk.
[[nodiscard]] ScatteredOnce<float> MarchWithOcclusion(const AirIntegrator<float>& air,
                                                      const ShaftView& view, std::size_t i,
                                                      const Terrain& terrain, int count,
                                                      double offset = 0.5);

}  // namespace alpenglow::renderer
