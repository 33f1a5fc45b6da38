// SPDX-License-Identifier: MIT
// A view ray in a spherical atmosphere lit by a distant sun: all that radiance depends on.
//
// Points along a ray and what is summed over them: plain data, shared by kernels and their callers.
//
// Optical depth: over the species, extinction at the ground times column.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "atmosphere/air/medium.h"
#include "atmosphere/number/numerics.h"

namespace alpenglow::atmosphere {

struct ViewRay {
  double altitude_m = 0.0;  // of the observer; may lie above the top of the atmosphere
  double mu = 1.0;          // cosine of the view zenith angle, [-1, 1]
  double mu_s = 1.0;        // cosine of the sun's zenith angle at the observer, [-1, 1]
  double nu = 1.0;          // cosine between view direction and direction to the sun, [-1, 1]
  /// The ray ends here, or at the ground or the top if nearer.
  double length_m = std::numeric_limits<double>::infinity();
};

/// @param view_zenith_deg, sun_zenith_deg  in [0, 180].
/// @param relative_azimuth_deg  0 looks towards the sun's azimuth.
[[nodiscard]] ViewRay RayFromAngles(double altitude_m, double view_zenith_deg,
                                    double relative_azimuth_deg, double sun_zenith_deg);

/// Where a ray begins and ends inside the shell, as distances from the observer.
enum class RayEnd { kSpace, kGround, kLength };
struct RayExtent {
  double begin_m = 0.0;  // > 0 for an observer above the top
  double end_m = 0.0;    // begin_m == end_m: the ray meets no air
  RayEnd end = RayEnd::kSpace;
};

/// Clips a ray to the shell between ground and top. A horizontal ray at altitude 0 does not hit the
/// ground; one below the horizontal there hits it at distance 0. An observer below the ground sees
/// the sky as from the ground. Error below 1e-6 m for observers within 1e8 m (extended precision).
/// Throws InputError for a ray that is not finite or not above the centre of the planet.
[[nodiscard]] RayExtent ExtentOf(const ViewRay& ray, double planet_radius_m,
                                 double atmosphere_height_m);

/// Whether what the ground reflects is part of what a ray brings: of rays that end where they meet
/// it. A ray whose length is given is a segment of air: it ends at the ground when that is nearer,
/// but what lies behind its end, be it the ground, is left to whoever asked for the segment.
[[nodiscard]] bool BringsLightOfGround(const ViewRay& ray, const RayExtent& extent);

/// The piece of a ray that lies in the shadow of the planet (a half-cylinder behind it), clipped to
/// [begin_m, end_m]. Empty when dark_begin_m == dark_end_m.
struct ShadowSpan {
  double dark_begin_m = 0.0;
  double dark_end_m = 0.0;
};
[[nodiscard]] ShadowSpan PlanetShadow(const ViewRay& ray, const RayExtent& extent,
                                      double planet_radius_m);

inline constexpr std::size_t kMaxBands = 40;
/// Panels of a ray cut at the six edges of the tent, six edges in the sunbeams, the perigee, both
/// edges of the planet's shadow and both ends.
inline constexpr std::size_t kMaxRayPanels = 17;
/// Every panel with the most nodes, and room for the last SIMD lanes.
inline constexpr std::size_t kMaxRaySamples =
    kMaxRayPanels * static_cast<std::size_t>(kMaxGaussNodes) + 16;

/// One value a wavelength.
template <typename Real>
struct Bands {
  std::array<Real, kMaxBands> value;  // the first `count`; the rest is never read
  std::size_t count = 0;

  Bands() = default;
  /// All zero.
  explicit Bands(std::size_t bands) : count(bands) { std::fill_n(value.begin(), bands, Real(0)); }
  Real& operator[](std::size_t band) { return value[band]; }
  const Real& operator[](std::size_t band) const { return value[band]; }
  friend bool operator==(const Bands& a, const Bands& b) {
    return std::equal(a.value.begin(), a.value.begin() + static_cast<std::ptrdiff_t>(a.count),
                      b.value.begin(), b.value.begin() + static_cast<std::ptrdiff_t>(b.count));
  }
};

/// How finely a ray is sampled.
struct Sampling {
  /// Gauss nodes of an ordinary ray, in [1, 32]. Rays past the limb and through the edge of the
  /// planet's shadow take more by themselves (ray_panels.h).
  int nodes = 12;
  bool split_ozone = false;   // cut panels where a tent of ozone bends the integrand
  bool dark_samples = false;  // sample the air in the planet's shadow too (light of higher orders)
};

/// The least sampling whose error, root mean square over the rays of a sky, relative, is below
/// `max_error`, in [0, 1]; not below 1e-6 with 20 nodes.
[[nodiscard]] Sampling SamplingForError(double max_error);

/// A point of a quadrature rule along a ray: distance from the observer and weight [m].
struct RayNode {
  double distance_m, weight_m;
};

/// How columns from the observer to samples are found.
enum class ViewColumns {
  /// Differences of columns to space, for any samples.
  kFromSpace,
  /// Integrals of density from each sample to the next, by 4 Gauss nodes: nothing is subtracted,
  /// so that short ways lose no digits. Samples must begin in the air and be in order of distance;
  /// relative error 6e-10 x^8 if density changes by e^x from one to the next.
  kBetweenSamples
};

/// Points along a ray, structure of arrays. Lengths
/// in km, measured from where the ray enters the air.
template <typename Real>
struct alignas(64) RaySamples {
  using Row = std::array<Real, kMaxRaySamples>;
  alignas(64) Row distance, weight;  // weight: Gauss weight times the derivative of the map
  alignas(64) Row lit;               // 1 in sunlight, 0 in the shadow of the planet
  alignas(64) Row altitude, mu, mu_s;
  alignas(64) Row rayleigh_density, mie_density;        // relative to altitude 0
  alignas(64) Row view_rayleigh, view_mie, view_ozone;  // columns from the observer
  alignas(64) Row sun_rayleigh, sun_mie, sun_ozone;     // columns to the sun
  std::size_t count = 0;                                // samples
  std::size_t padded = 0;  // count rounded up to whole SIMD lanes; the rest has weight 0
  RayExtent extent;

  /// Samples that have a weight.
  [[nodiscard]] std::size_t Nodes() const {
    return static_cast<std::size_t>(
        std::count_if(weight.begin(), weight.begin() + static_cast<std::ptrdiff_t>(count),
                      [](Real w) { return w != Real(0); }));
  }
};

/// Light scattered once, without phase functions: the factor of p_R(nu) and of p_M(nu), per unit
/// solar irradiance [1].
template <typename Real>
struct ScatteredOnce {
  Bands<Real> rayleigh, mie;
};

/// Columns of molecules, aerosol and ozone: densities relative to where extinctions are given,
/// integrated along a way [km or m].
template <typename T>
struct ColumnSet {
  T rayleigh, mie, ozone;
};

/// Extinction coefficients per length of the columns, at relative density 1.
template <typename T>
struct Extinction {
  T rayleigh, mie, ozone;
};

/// Those of a band of a medium [1/m].
template <typename T>
[[nodiscard]] Extinction<T> ExtinctionAt(const Medium& medium, std::size_t band) {
  return {static_cast<T>(medium.rayleigh_scattering_per_m[band]),
          static_cast<T>(medium.mie_extinction_per_m[band]),
          static_cast<T>(medium.ozone_absorption_per_m[band])};
}

/// The judges have their own.
template <typename T>
[[nodiscard]] inline T OpticalDepthOf(const Extinction<T>& extinction,
                                      const ColumnSet<T>& columns) {
  return extinction.rayleigh * columns.rayleigh + extinction.mie * columns.mie +
         extinction.ozone * columns.ozone;
}

}  // namespace alpenglow::atmosphere
