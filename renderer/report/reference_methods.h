// SPDX-License-Identifier: MIT
// This header provides the reference methods of the report.
//
// The reference for light shafts is single scattering along a ray, with an occlusion ray against
// the terrain at each of many points, each towards a different point of the sun's disk.
//
// For lamps, random test cases beside rays have reference results. Rules of the literature
// integrate the same light, and so does the closed form of Sun, Ramamoorthi, Narasimhan and Nayar
// (2005), "A practical analytic single scattering model for real time rendering", ACM TOG 24, 1040,
// for isotropic scattering in homogeneous air.
//
// For clouds there is the sunlight of octaves by Wrenninge, Kulla and Lundqvist (2013), "Oz: the great
// and volumetric", ACM SIGGRAPH Talks, 46, as engines of games use it. Octave i stands for light of
// higher orders by less extinction towards the sun and a wider phase function:
//
//   L = integral of sum_i b^i w sigma p(nu; c^i g) exp(-a^i tau_s) exp(-tau) dt
//
// with the optical depths tau to the eye and tau_s to the sun. Octave 0 is light of first collisions.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <vector>

#include "atmosphere/lamp/airlight.h"
#include "atmosphere/ray/single_scattering.h"
#include "renderer/cloud_light/cloud_sun_map.h"
#include "renderer/cloud_light/cloud_tracking.h"
#include "renderer/clouds/cloud_field.h"
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

/// Properties that a set of test cases shares.
struct LampTestKind {
  double g = 0.8;                                                   // Henyey-Greenstein
  double scale_height_m = std::numeric_limits<double>::infinity();  // of the layer
  bool beam = false;                                                // a cone, not isotropic
  bool through = false;    // the ray passes through the lamp, a ball of 0.1 m
  bool clear_air = false;  // adds molecules and aerosol to the layer
};

/// A lamp, a ray and the air around them.
struct LampTestCase {
  LampAir air;
  Lamp lamp;
  LampSegment segment;
  double truth = 0.0;     // reference result of reference::AirlightAlong
  bool converged = true;  // whether the reference converged
};

/// Returns test case i >= 1: extinction 1e-4 to 0.1 per metre at the lowest point, distance of the
/// lamp from the ray 0.1 to 100 m, segments of 10 to 1000 m, and the lamp beside, before or behind
/// the segment.
[[nodiscard]] LampTestCase LampTestCaseNumber(int i, const LampTestKind& kind);

/// Rule for integrating the light of a lamp along a ray, in one band.
enum class LampRule {
  kUniform,      // midpoints of equal steps
  kEquiAngular,  // midpoints of equal angles seen from the lamp: Kulla and Fajardo (2012),
                 // Computer Graphics Forum 31, 1519, stratified
  kHalfAngle,    // Gauss-Legendre in tan(theta / 2)
  kAsinh,        // Gauss-Legendre in asinh((t - t_c) / D)
};

/// Integrates a test case with a rule over its whole segment, which must be finite.
[[nodiscard]] double AirlightByRule(LampRule rule, const LampTestCase& work, int nodes);

/// Returns F(u, v) of Sun et al. (2005), equation 11: the integral of exp(-u tan xi) over xi from 0
/// to v. Error below 1e-11.
/// @param u >= 0, v in [0, pi/2].
[[nodiscard]] double SunFunction(double u, double v);

/// Returns airlight by Sun et al. (2005), equation 10: an isotropic lamp in homogeneous air that
/// scatters isotropically, per unit intensity. It is computed as published, as the difference of
/// two values of F: its relative error is unbounded when the lamp approaches the line of the ray
/// outside of the segment.
/// @param along_m, across_m  position of the lamp along the ray, and its distance from the ray
/// (> 0).
/// @param length_m  length of the segment; may be infinite.
[[nodiscard]] double AirlightOfSun2005(double scattering_per_m, double extinction_per_m,
                                       double length_m, double along_m, double across_m);

/// Numbers of the octaves: a, b, c and how many there are.
struct CloudOctaves {
  double attenuation = 0.5, contribution = 0.5, eccentricity = 0.5;
  int count = 8;
};

/// Sunlight along a ray for unit irradiance across the beam [1/sr], and what clouds leave of the
/// light behind it.
struct OctaveLight {
  double sun = 0.0, transmittance = 1.0;
};

/// Returns the light of octaves in a field whose phase function is that of Henyey and Greenstein. It
/// is integrated in steps of an optical depth of 0.25, from 2 to 20 m, up to a transmittance of
/// 0.001. For one octave it is within 2 % of traced paths of one scattering.
/// @param map  of the same field, for the depths towards the sun.
[[nodiscard]] OctaveLight OctaveSunlight(const CloudField& field, const CloudSunMap& map, double g,
                                         const CloudRay& ray, const CloudOctaves& octaves = {});

}  // namespace alpenglow::renderer
