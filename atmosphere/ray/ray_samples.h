// SPDX-License-Identifier: MIT
// Points along a ray and what is summed over them: plain data, shared by kernels and their callers.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "atmosphere/number/quadrature.h"
#include "atmosphere/ray/ray.h"

namespace alpenglow::atmosphere {

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

}  // namespace alpenglow::atmosphere
