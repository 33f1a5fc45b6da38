// SPDX-License-Identifier: MIT
// View rays in a spherical atmosphere lit by a distant sun, with their extent and shadow, their
// samples, sums over the samples, and their panels. Samples and sums are plain data, shared by
// kernels and their callers.
//
// On a panel the integrand of single scattering is smooth. PanelsOf cuts a ray at the planet's
// shadow and at its perigee (and, on request, at the kinks of an ozone tent). In each panel the map
// of distance, that of ray_map.glsl, places samples densely in dense air.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/medium/medium.h"

namespace alpenglow::atmosphere {

struct ViewRay {
  double altitude_m = 0.0;  // of the observer; may lie above the top of the atmosphere
  double mu = 1.0;          // cosine of the view zenith angle, [-1, 1]
  double mu_s = 1.0;        // cosine of the sun's zenith angle at the observer, [-1, 1]
  double nu = 1.0;          // cosine between view direction and direction to the sun, [-1, 1]
  /// The ray ends at this distance, or at the ground or the top if nearer.
  double length_m = std::numeric_limits<double>::infinity();
  /// True if the ray reaches the point at length_m although it lies below altitude 0, or behind a
  /// dip of the line below altitude 0. Otherwise the ground ends a ray from altitude 0 or above.
  bool passes_ground = false;
};

/// Returns the ray with the given angles.
/// @param view_zenith_deg, sun_zenith_deg  in [0, 180].
/// @param relative_azimuth_deg  0 looks towards the sun's azimuth.
[[nodiscard]] ViewRay RayFromAngles(double altitude_m, double view_zenith_deg,
                                    double relative_azimuth_deg, double sun_zenith_deg);

/// Begin and end of a ray inside the shell, as distances from the observer.
enum class RayEnd { kSpace, kGround, kLength };
struct RayExtent {
  double begin_m = 0.0;  // > 0 for an observer above the top
  double end_m = 0.0;    // begin_m == end_m: the ray meets no air
  RayEnd end = RayEnd::kSpace;
};

/// Clips a ray to the air. A ray without a given length ends at the ground, which is the sphere of
/// altitude 0, or at the top. A horizontal ray at altitude 0 does not hit the ground; a ray below
/// the horizontal hits it there at distance 0. For an observer below the ground the sky is that
/// seen from the ground.
///
/// A ray of a given length that begins below altitude 0 or passes the ground is a segment of air
/// between two points, neither of which needs to lie above altitude 0: land lies below the sea at
/// some places, and the line between two points at the shore dips below it. Below altitude 0 air
/// has the density of altitude 0, so that both directions of a segment pass through the same air.
/// The ground ends only segments that lead deeper than DeepestAir, as no line between two places of
/// a planet does that can see each other.
///
/// Error below 1e-6 m for observers within 1e8 m (extended precision). Throws InputError for a ray
/// that is not finite, lower than half a radius below altitude 0, or higher than 1e12 m.
[[nodiscard]] RayExtent ExtentOf(const ViewRay& ray, double planet_radius_m,
                                 double atmosphere_height_m);

/// Returns whether light reflected by the ground is part of the light along a ray: true for rays
/// without a given length that hit the ground. A ray with a given length is a segment of air. Light
/// reflected at its end is not included: the caller adds it.
[[nodiscard]] bool BringsLightOfGround(const ViewRay& ray, const RayExtent& extent);

/// Returns the depth below altitude 0 to which air continues for segments [m]: 12 km, more than
/// that of any land, and on small planets a fiftieth of the radius.
[[nodiscard]] constexpr double DeepestAir(double planet_radius_m) {
  return std::min(12e3, 0.02 * planet_radius_m);
}

/// Returns the altitude from which the air along a ray is computed [m]: that of the observer for
/// segments no part of which is deeper than DeepestAir, else at least 0.
[[nodiscard]] double StartAltitude(const ViewRay& ray, double planet_radius_m);

/// The part of a segment below altitude 0, as distances from the observer. Empty if begin_m ==
/// end_m.
struct SubmergedSpan {
  double begin_m = 0.0;
  double end_m = 0.0;
  /// Cosine at which the line of the segment crosses altitude 0, without sign.
  double mu_ground = 0.0;

  [[nodiscard]] bool Exists() const { return begin_m < end_m; }
};
[[nodiscard]] SubmergedSpan SubmergedPart(const ViewRay& ray, const RayExtent& extent,
                                          double planet_radius_m);

/// The segment of a ray in the shadow of the planet (a half-cylinder behind it), clipped to
/// [begin_m, end_m]. Empty if dark_begin_m == dark_end_m.
struct ShadowSpan {
  double dark_begin_m = 0.0;
  double dark_end_m = 0.0;
};
[[nodiscard]] ShadowSpan PlanetShadow(const ViewRay& ray, const RayExtent& extent,
                                      double planet_radius_m);

/// Maximum number of panels of a ray: it is cut at the six edges of the tent, six edges in the
/// sunbeams, the perigee or both crossings of altitude 0, both edges of the planet's shadow and
/// both ends.
inline constexpr std::size_t kMaxRayPanels = 17;
/// Capacity for every panel with the largest number of nodes, and for padding to SIMD lanes.
inline constexpr std::size_t kMaxRaySamples =
    kMaxRayPanels * static_cast<std::size_t>(kMaxGaussNodes) + 16;

/// Number and placement of samples along a ray.
struct Sampling {
  /// Gauss nodes of an ordinary ray, in [1, 32]. Rays past the limb and through the edge of the
  /// planet's shadow automatically have more (PanelsOf).
  int nodes = 12;
  bool split_ozone = false;   // cut panels where an ozone tent has a kink
  bool dark_samples = false;  // also in the planet's shadow (for multiple scattering)
};

/// A point of a quadrature rule along a ray: distance from the observer and weight [m].
struct RayNode {
  double distance_m, weight_m;
};

/// Method for columns from the observer to samples.
enum class ViewColumns {
  /// Differences of columns to space, for any samples.
  kFromSpace,
  /// Integrals of density from each sample to the next, by 4 Gauss nodes: nothing is subtracted, so
  /// that short segments lose no digits. Samples must begin in the air and be in order of distance;
  /// relative error 6e-10 x^8 if density changes by e^x from one sample to the next.
  kBetweenSamples
};

/// Points along a ray, as a structure of arrays. Lengths are in km, measured from the entry of the
/// ray into the air.
template <typename Real>
struct alignas(64) RaySamples {
  using Row = std::array<Real, kMaxRaySamples>;
  alignas(64) Row distance, weight;  // weight: Gauss weight times the derivative of the map
  alignas(64) Row lit;               // 1 in sunlight, 0 in the shadow of the planet
  alignas(64) Row altitude, mu, mu_s;
  alignas(64) Row rayleigh_density, mie_density;        // relative to altitude 0
  alignas(64) Row view_rayleigh, view_mie, view_ozone;  // columns from the observer
  alignas(64) Row sun_rayleigh, sun_mie, sun_ozone;     // columns to the sun
  std::size_t count = 0;                                // number of samples
  std::size_t padded = 0;  // count rounded up to whole SIMD lanes; the rest has weight 0
  RayExtent extent;

  /// Returns the number of samples with non-zero weight.
  [[nodiscard]] std::size_t Nodes() const {
    return static_cast<std::size_t>(
        std::count_if(weight.begin(), weight.begin() + static_cast<std::ptrdiff_t>(count),
                      [](Real w) { return w != Real(0); }));
  }
};

/// Single scattering without phase functions: the factors of p_R(nu) and of p_M(nu), per unit solar
/// irradiance [1].
template <typename Real>
struct ScatteredOnce {
  SpectrumOf<Real> rayleigh, mie;
};

/// Columns of molecules, aerosol and ozone: densities relative to the reference altitude of the
/// extinctions, integrated along a path [km or m].
template <typename T>
struct ColumnSet {
  T rayleigh, mie, ozone;
};

/// Extinction coefficients per length of the columns, at relative density 1.
template <typename T>
struct Extinction {
  T rayleigh, mie, ozone;
};

/// Returns the extinction coefficients of a band of a medium [1/m].
template <typename T>
[[nodiscard]] Extinction<T> ExtinctionAt(const Medium& medium, std::size_t band) {
  return {static_cast<T>(medium.rayleigh_scattering_per_m[band]),
          static_cast<T>(medium.mie_extinction_per_m[band]),
          static_cast<T>(medium.ozone_absorption_per_m[band])};
}

/// Returns the optical depth: over the species, extinction at the ground times column. The
/// reference solutions have their own function.
template <typename T>
[[nodiscard]] inline T OpticalDepthOf(const Extinction<T>& extinction,
                                      const ColumnSet<T>& columns) {
  return extinction.rayleigh * columns.rayleigh + extinction.mie * columns.mie +
         extinction.ozone * columns.ozone;
}

/// The observer, moved to the entry of the ray into the air; all distances are counted from here.
struct RayEntry {
  double altitude_km, mu, mu_s, nu;
  /// SubmergedSpan, as distances from the entry. The columns of such a ray consist of those above
  /// altitude 0 and the length below it.
  double submerged_begin_km = 0.0, submerged_end_km = 0.0, mu_ground = 0.0;

  [[nodiscard]] bool IsSubmerged() const { return submerged_begin_km < submerged_end_km; }
};

/// Returns whether ClimbSeries (optical_depth.glsl) is not valid up to the top of the air: its
/// error is 6e-6 of a climb by a twentieth of the radius, and beyond the radius it has no bound.
[[nodiscard]] constexpr bool IsTall(double top, double radius) { return top > 0.05 * radius; }

[[nodiscard]] inline double Kilometres(double metres) { return metres / kMetresPerKilometre; }

/// A segment of the ray on which the altitude is monotone [km from the entry].
struct RayPanel {
  double begin, end;
  bool lit;        // outside the shadow of the planet
  bool rises;      // its lower end is its beginning
  double stretch;  // b of ray_map.glsl
  int nodes;
};

struct RayPanels {
  static constexpr std::size_t kMost = kMaxRayPanels;
  std::array<RayPanel, kMost> panel;
  std::size_t count = 0;
};

/// Returns the factor that scales kilometres for the map of ray_map.glsl, whose lengths refer to
/// air as deep as the Earth's: 1 for such air and deeper. In a layer of scale height 100 m it is
/// 64, so that nodes are placed in the air.
[[nodiscard]] double MapLengthsPerKm(const Medium& medium);

/// Returns the entry of a ray into the air: the observer, or the first point in the shell.
[[nodiscard]] RayEntry EntryOf(const ViewRay& ray, const RayExtent& extent, const Medium& medium);

/// Returns the panels of a ray. The number of nodes is chosen so that all panels have about the
/// same error.
/// @param sampling  nodes of an ordinary panel. A panel has half as many more if sunbeams graze its
/// lower end, or if the planet's shadow begins there. So has a panel that descends through the air
/// at a slant, or continues from the perigee of such a ray; it has twice this increase if the ray
/// began above 60 km or sunbeams graze it. The maximum is 64.
[[nodiscard]] RayPanels PanelsOf(const ViewRay& ray, const RayExtent& extent, const RayEntry& entry,
                                 const Medium& medium, const Sampling& sampling);

/// Distances at which the line from altitude h along mu crosses altitude z [km], both inside and
/// outside of [0, length]; none if it passes above.
struct LineCrossings {
  std::size_t count;
  std::array<double, 2> distance;
};
[[nodiscard]] LineCrossings CrossingsOf(double h, double mu, double z, double radius);

}  // namespace alpenglow::atmosphere
