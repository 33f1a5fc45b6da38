// SPDX-License-Identifier: MIT
// Light along a ray through local media:
//
//   L = integral of  T(t) sum over bodies density(t) j(t)  dt,     T = exp(-sum of columns)
//
// in panels. A panel holds 7 nodes of Kronrod's rule, three of which are Gauss's (Kronrod 1965; the
// numbers are those of QUADPACK, Piessens et al. 1983). Columns at the nodes are integrals of the
// polynomial through the densities there, so that nothing but densities and sources is asked for.
// The two rules' difference is the error; a panel that is off by more than its share is halved. No
// panel begins deeper than 2 in optical depth or longer than a block of a grid, so that none steps
// over what it has not seen; pieces without density are passed over.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "renderer/ground/band_light.h"
#include "renderer/media/local_media.h"

namespace alpenglow::renderer {

/// A stretch of the ray, in order, without overlap; between them there is nothing.
struct MarchedPiece {
  double begin_m, end_m;
  // What is left of light from the end; mean over the piece of what is left:
  BandLight transmittance, mean_transmittance;
  // The same of volumes alone, without fog:
  BandLight past_volumes, mean_past_volumes;
};

struct MarchedLight {
  BandLight radiance;       // W m^-2 sr^-1 nm^-1
  BandLight transmittance;  // of all; below 1e-6 in every band it counts as that
  double error = 0.0;       // estimate, relative to the radiance of the brightest band
  std::size_t nodes = 0;    // where sources were asked for
  std::vector<MarchedPiece> pieces;
};

/// What bodies of these densities send towards the origin at a point [W m^-2 sr^-1 nm^-1 a metre],
/// media in between aside.
using MediaSource = std::function<BandLight(double distance_m, const glm::dvec3& point,
                                            std::span<const double> densities)>;

inline constexpr double kMarchTolerance = 2e-3;

/// @param direction  unit; @param length_m may be infinite.
/// @param tolerance  of the result's relative error, in [1e-6, 0.1]. Held against a thousand times
///     finer midpoint sums over homogeneous, exponential and turbulent gridded bodies, with sources
///     that are smooth or follow a shadow: tests/renderer/media_march_test.cpp.
/// @param cuts_m  distances where panels shall end: where the ray is nearest to a lamp.
[[nodiscard]] MarchedLight MarchMedia(const LocalMedia& media, const glm::dvec3& origin,
                                      const glm::dvec3& direction, double length_m,
                                      const MediaSource& source, double tolerance = kMarchTolerance,
                                      std::span<const double> cuts_m = {});

}  // namespace alpenglow::renderer
