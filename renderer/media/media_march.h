// SPDX-License-Identifier: MIT
// Integrates light along a ray through all media of a scene:
//
//   L = integral of  T(t) sum over media density(t) j(t)  dt,     T = exp(-sum of columns)
//
// The ray is divided into panels. A panel has the 7 nodes of Kronrod's rule, three of which are
// Gauss nodes (Kronrod 1965; the numbers are those of QUADPACK, Piessens et al. 1983). Columns at
// the nodes are integrals of the polynomial through the densities there, so that only densities and
// sources need to be evaluated. The difference of the two rules is the error estimate; a panel
// whose error exceeds its share is halved. No panel is initially deeper than 2 in optical depth or
// longer than a block of a grid, so that none steps over unseen structure. Stretches without density
// are skipped.
//
// A medium whose light was found without the forward peak of its phase function attenuates its own
// light and that of wide sources behind it by less than its extinction. Light of narrow sources
// behind it (disks, stars) suffers all of it.
#pragma once

#include <cstddef>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "renderer/media/local_media.h"

namespace alpenglow::renderer {

/// A stretch of the ray. Pieces are in order and do not overlap; there are no media between them.
struct MarchedPiece {
  double begin_m, end_m;
  // Transmittance for light from the end, and its mean over the piece:
  Spectrum transmittance, mean_transmittance;
  // Transmittance of bodies alone, without layers, and its mean:
  Spectrum past_bodies, mean_past_bodies;
};

struct MarchedLight {
  Spectrum radiance;  // W m^-2 sr^-1 nm^-1
  // Transmittance of all media for light of wide and of narrow sources behind; values of the first
  // below 1e-6 in every band are not resolved:
  Spectrum transmittance, narrow_transmittance;
  double error = 0.0;     // estimate, relative to the radiance of the brightest band
  std::size_t nodes = 0;  // number of evaluations of the sources
  std::vector<MarchedPiece> pieces;
};

/// Returns the light that media of these densities send towards the origin at a point [W m^-2
/// sr^-1 nm^-1 per metre], without attenuation by media in between.
/// @param columns_m  the integrals of the densities from the origin to the point.
using MediaSource =
    std::function<Spectrum(double distance_m, const glm::dvec3& point,
                           std::span<const double> densities, std::span<const double> columns_m)>;

inline constexpr double kMarchTolerance = 2e-3;

/// Integrates the light along a ray.
/// @param direction  unit.
/// @param length_m  may be infinite.
/// @param tolerance  of the result's relative error, in [1e-6, 0.1]. It is tested against midpoint
///     sums a thousand times finer, over homogeneous, exponential and turbulent gridded bodies,
///     with sources that are smooth or follow a shadow: tests/renderer/media/media_march_test.cpp.
/// @param cuts_m  distances where panels must end: where the ray is nearest to a lamp.
/// @param extinction_per_m  of each medium at density 1, for light of wide sources; empty: that of
///     the optics of all.
[[nodiscard]] MarchedLight MarchMedia(const LocalMedia& media, const glm::dvec3& origin,
                                      const glm::dvec3& direction, double length_m,
                                      const MediaSource& source, double tolerance = kMarchTolerance,
                                      std::span<const double> cuts_m = {},
                                      std::span<const SpectrumOf<double>> extinction_per_m = {});

/// Media that attenuate light from behind them.
enum class Behind { kAll, kBodies };

/// Returns the light of the air itself that arrives through media; it is scattered in front of
/// them, inside and behind them. The result is exact in front of and behind media. Within stretches
/// of media over which transmittance falls by 0.15 at most, light is assumed to increase linearly.
/// @param upto  light of the air up to a distance, increasing.
/// @param whole  of the whole ray.
[[nodiscard]] Spectrum DimmedByMedia(const std::vector<MarchedPiece>& pieces,
                                     const std::function<Spectrum(double)>& upto,
                                     const Spectrum& whole, Behind behind);

/// Returns the transmittance of bodies over a distance, up to the ends of pieces.
[[nodiscard]] Spectrum LeftByBodies(const std::vector<MarchedPiece>& pieces, double distance_m,
                                    std::size_t bands);

}  // namespace alpenglow::renderer
