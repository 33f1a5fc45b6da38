// SPDX-License-Identifier: MIT
// Single scattering along a ray, fast: Gauss-Legendre in a mapped distance, closed-form columns.
//
//   L = sum over species  phase(nu)  integral of  sigma_s(h) T(observer to point) T(point to sun)
//   ds
//
// The ray is cut where the integrand is not smooth (the planet's shadow, the perigee, on request
// the edges of the ozone tent); in each panel the distance is mapped by t = length v / (1 + k (1 -
// v)), dense at the lower end, so that a few nodes see both scale heights. Transmittance needs no
// march: columns between any two points are differences of the closed form in optical_depth.glsl.
//
// Samples are shared by everything that is integrated along a ray: lights of any order, any band.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "atmosphere/medium.h"
#include "atmosphere/ray.h"

namespace alpenglow {

inline constexpr std::size_t kMaxBands = 40;
/// Sixteen panels (a ray cut at the six edges of the tent, six edges in the sunbeams, the perigee
/// and the planet's shadow) of 32 nodes, and room for the last SIMD lanes.
inline constexpr std::size_t kMaxRaySamples = 528;

/// One value a wavelength.
template <typename Real>
struct Bands {
  std::array<Real, kMaxBands> value{};
  std::size_t count = 0;

  Bands() = default;
  explicit Bands(std::size_t bands) : count(bands) {}
  Real& operator[](std::size_t band) { return value[band]; }
  const Real& operator[](std::size_t band) const { return value[band]; }
};

/// How finely a ray is sampled.
struct Sampling {
  int nodes = 12;             // Gauss nodes of a panel that starts in dense air, in [1, 32]
  bool split_ozone = false;   // cut panels where ozone bends the integrand: for errors below 1e-3
  bool dark_samples = false;  // sample the air in the planet's shadow too (light of higher orders)
};

/// A point of a quadrature rule along a ray: distance from the observer and weight [m].
struct RayNode {
  double distance_m, weight_m;
};

/// Points along a ray, structure of arrays. Lengths in km, measured from the observer.
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
};

/// Light scattered once, without phase functions: the factor of p_R(nu) and of p_M(nu), per unit
/// solar irradiance [1].
template <typename Real>
struct ScatteredOnce {
  Bands<Real> rayleigh, mie;
};

/// A medium made ready for evaluation in Real = float or double. Immutable, safe to share between
/// threads.
template <typename Real>
class AirIntegrator {
 public:
  /// Throws InputError for a medium that Validate refuses or of more than kMaxBands wavelengths.
  explicit AirIntegrator(const Medium& medium);

  [[nodiscard]] const Medium& medium() const { return medium_; }
  [[nodiscard]] std::size_t bands() const { return medium_.wavelengths_nm.size(); }

  /// Columns [m] from a point along a direction of zenith cosine mu to space: molecules, aerosol,
  /// ozone. Relative error below 3e-6 (double) and 1.2e-5 (float) for altitudes in [0, top]. The
  /// direction must not meet the ground.
  [[nodiscard]] std::array<Real, 3> ColumnsToSpace(double altitude_m, double mu) const;

  /// Transmittance from a point to space along mu; 0 where the ground is in the way.
  [[nodiscard]] Bands<Real> TransmittanceToSpace(double altitude_m, double mu) const;

  /// Optical depth between the observer and the end of the ray.
  [[nodiscard]] Bands<Real> OpticalDepthAlong(const ViewRay& ray) const;

  /// Transmittance between the observer and the end of the ray.
  [[nodiscard]] Bands<Real> TransmittanceAlong(const ViewRay& ray) const;

  [[nodiscard]] RaySamples<Real> Sample(const ViewRay& ray, const Sampling& sampling) const;

  /// Samples at the nodes of any other rule, inside the air, at most kMaxRaySamples - 16: for
  /// marches that Sample is held against.
  [[nodiscard]] RaySamples<Real> SampleAt(const ViewRay& ray, std::span<const RayNode> nodes) const;

  /// Direct sunlight scattered once along the samples.
  [[nodiscard]] ScatteredOnce<Real> Scatter(const RaySamples<Real>& samples) const;

  /// Radiance per unit solar irradiance [1/sr]: phase functions applied.
  [[nodiscard]] Bands<Real> Inscatter(const ScatteredOnce<Real>& scattered, double nu) const;

 private:
  Medium medium_;
};

extern template class AirIntegrator<float>;
extern template class AirIntegrator<double>;

}  // namespace alpenglow
