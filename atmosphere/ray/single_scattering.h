// SPDX-License-Identifier: MIT
// Fast single scattering along a ray: Gauss-Legendre quadrature in a mapped distance, with
// closed-form columns.
//
//   L = sum over species  phase(nu)  integral of  sigma_s(h) T(observer to point) T(point to sun)
//   ds
//
// The ray is cut where the integrand is not smooth and sampled densely in dense air (PanelsOf),
// so that a few nodes resolve both scale heights. Transmittance needs no ray marching: columns
// between any two points are differences of the closed form in optical_depth.glsl.
//
// Samples are shared by all integrals along a ray: light of any order, any band.
//
// PhaseNodes holds the aerosol's tabulated phase functions for look-ups in all bands at once: the
// nodes of PhaseTable, with one value per band at each node. A look-up computes the position among
// the nodes once, in float.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "atmosphere/medium/medium.h"
#include "atmosphere/ray/ray.h"
#include "atmosphere/ray/ray_kernel.h"

namespace alpenglow::atmosphere {

class PhaseNodes {
 public:
  PhaseNodes() = default;
  /// @param medium  its phase functions are tables.
  explicit PhaseNodes(const Medium& medium);

  [[nodiscard]] bool empty() const { return value_.empty(); }

  /// Returns the values [1/sr] of every band, within 3e-5 of the tables.
  /// @param nu  in [-1, 1]; values beyond by rounding are clamped.
  [[nodiscard]] Spectrum At(double nu) const;

 private:
  std::size_t bands_ = 0;
  std::vector<float> value_;  // [node * bands + band]
};

/// A medium prepared for evaluation in Real = float or double. Immutable, safe to share between
/// threads.
template <typename Real>
class SingleScattering {
 public:
  /// Throws InputError for a medium that Validate rejects or with more than kMaxBands wavelengths.
  explicit SingleScattering(const Medium& medium);

  [[nodiscard]] const Medium& medium() const { return medium_; }
  [[nodiscard]] std::size_t bands() const { return medium_.wavelengths_nm.size(); }
  /// Returns the medium in the form that kernels use.
  [[nodiscard]] const AirConstants<Real>& constants() const { return constants_; }

  /// Returns the columns [m] from a point along a direction of zenith cosine mu to space:
  /// molecules, aerosol, ozone. Relative error below 3e-6 (double, ozone 6e-6) and 1.2e-5 (float;
  /// ozone: or 1e-7 of its depth) for altitudes in [0, top]. The direction must not hit the ground.
  [[nodiscard]] std::array<Real, 3> ColumnsToSpace(double altitude_m, double mu) const;

  /// Returns the columns for many points and directions, in equal number: molecules, aerosol,
  /// ozone.
  [[nodiscard]] std::array<std::vector<Real>, 3> ColumnsToSpace(std::span<const Real> altitudes_m,
                                                                std::span<const Real> mu) const;

  /// Returns the transmittance from a point to space along mu; 0 if the ground blocks the way.
  [[nodiscard]] SpectrumOf<Real> TransmittanceToSpace(double altitude_m, double mu) const;

  /// Returns the columns between the observer and the end of the ray [km].
  [[nodiscard]] ColumnSet<Real> ColumnsAlong(const ViewRay& ray) const;

  /// Returns the optical depth between the observer and the end of the ray.
  [[nodiscard]] SpectrumOf<Real> OpticalDepthAlong(const ViewRay& ray) const;

  /// Returns the transmittance between the observer and the end of the ray.
  [[nodiscard]] SpectrumOf<Real> TransmittanceAlong(const ViewRay& ray) const;

  [[nodiscard]] RaySamples<Real> Sample(const ViewRay& ray, const Sampling& sampling) const;

  /// Returns samples at the nodes of any other rule, inside the air, at most kMaxRaySamples - 16:
  /// for ray marches that are compared with Sample.
  [[nodiscard]] RaySamples<Real> SampleAt(const ViewRay& ray, std::span<const RayNode> nodes) const;

  /// Returns these samples for a ray whose extent and dark part are known.
  [[nodiscard]] RaySamples<Real> SampleAt(const ViewRay& ray, const RayExtent& extent,
                                          const ShadowSpan& shadow, std::span<const RayNode> nodes,
                                          ViewColumns columns) const;

  /// Returns the single scattering of direct sunlight along the samples.
  [[nodiscard]] ScatteredOnce<Real> Scatter(const RaySamples<Real>& samples) const;

  /// Returns the aerosol's phase function [1/sr] in every band. In float, tables are read from
  /// PhaseNodes, within 1e-4 (for dust with a peak of a degree) of the table's values.
  [[nodiscard]] SpectrumOf<Real> AerosolPhases(double nu) const;

  /// Returns the radiance per unit solar irradiance [1/sr]: phase functions applied.
  [[nodiscard]] SpectrumOf<Real> Inscatter(const ScatteredOnce<Real>& scattered, double nu) const;

 private:
  Medium medium_;
  AirConstants<Real> constants_;
  PhaseNodes phase_nodes_;  // for float, if phase functions are tables
};

extern template class SingleScattering<float>;
extern template class SingleScattering<double>;

}  // namespace alpenglow::atmosphere
