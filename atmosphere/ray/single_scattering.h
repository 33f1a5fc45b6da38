// SPDX-License-Identifier: MIT
// The aerosol's tabulated phase functions, made ready to be read for all bands at once: the nodes of
// PhaseTable, as many values a node as there are bands. A look-up finds its place among them once,
// in float.
//
// Single scattering along a ray, fast: Gauss-Legendre in a mapped distance, closed-form columns.
//
//   L = sum over species  phase(nu)  integral of  sigma_s(h) T(observer to point) T(point to sun)
//   ds
//
// The ray is cut where the integrand is not smooth and sampled densely in dense air (ray_panels.h),
// so that a few nodes see both scale heights. Transmittance needs no
// march: columns between any two points are differences of the closed form in optical_depth.glsl.
//
// Samples are shared by everything that is integrated along a ray: lights of any order, any band.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "atmosphere/air/medium.h"
#include "atmosphere/ray/ray.h"
#include "atmosphere/ray/ray_kernel.h"

namespace alpenglow::atmosphere {

class PhaseNodes {
 public:
  PhaseNodes() = default;
  /// @param medium  its phase functions are tables.
  explicit PhaseNodes(const Medium& medium);

  [[nodiscard]] bool empty() const { return value_.empty(); }

  /// Values [1/sr] of every band, within 3e-5 of the tables'. @param nu  in [-1, 1]; values beyond by
  /// rounding are clamped.
  [[nodiscard]] Bands<float> At(double nu) const;

 private:
  std::size_t bands_ = 0;
  std::vector<float> value_;  // [node * bands + band]
};

/// A medium made ready for evaluation in Real = float
/// or double. Immutable, safe to share between threads.
template <typename Real>
class AirIntegrator {
 public:
  /// Throws InputError for a medium that Validate refuses or of more than kMaxBands wavelengths.
  explicit AirIntegrator(const Medium& medium);

  [[nodiscard]] const Medium& medium() const { return medium_; }
  [[nodiscard]] std::size_t bands() const { return medium_.wavelengths_nm.size(); }
  /// The medium as kernels read it.
  [[nodiscard]] const AirConstants<Real>& constants() const { return constants_; }

  /// Columns [m] from a point along a direction of zenith cosine mu to space: molecules, aerosol,
  /// ozone. Relative error below 3e-6 (double, ozone 6e-6) and 1.2e-5 (float; ozone: or 1e-7 of its
  /// depth) for altitudes in [0, top]. The direction must not meet the ground.
  [[nodiscard]] std::array<Real, 3> ColumnsToSpace(double altitude_m, double mu) const;

  /// The same for many points and directions, as many of
  /// the one as of the other: molecules, aerosol, ozone.
  [[nodiscard]] std::array<std::vector<Real>, 3> ColumnsToSpace(std::span<const Real> altitudes_m,
                                                                std::span<const Real> mu) const;

  /// Transmittance from a point to space along mu; 0 where the ground is in the way.
  [[nodiscard]] Bands<Real> TransmittanceToSpace(double altitude_m, double mu) const;

  /// Columns between the observer and the end of the ray [km].
  [[nodiscard]] ColumnSet<Real> ColumnsAlong(const ViewRay& ray) const;

  /// Optical depth between the observer and the end of the ray.
  [[nodiscard]] Bands<Real> OpticalDepthAlong(const ViewRay& ray) const;

  /// Transmittance between the observer and the end of the ray.
  [[nodiscard]] Bands<Real> TransmittanceAlong(const ViewRay& ray) const;

  [[nodiscard]] RaySamples<Real> Sample(const ViewRay& ray, const Sampling& sampling) const;

  /// Samples at the nodes of any other rule, inside the air, at most kMaxRaySamples - 16: for
  /// marches that Sample is held against.
  [[nodiscard]] RaySamples<Real> SampleAt(const ViewRay& ray, std::span<const RayNode> nodes) const;

  /// The same of a ray whose extent and dark part are known.
  [[nodiscard]] RaySamples<Real> SampleAt(const ViewRay& ray, const RayExtent& extent,
                                          const ShadowSpan& shadow, std::span<const RayNode> nodes,
                                          ViewColumns columns) const;

  /// Direct sunlight scattered once along the samples.
  [[nodiscard]] ScatteredOnce<Real> Scatter(const RaySamples<Real>& samples) const;

  /// The aerosol's phase function [1/sr] in every band. In float, tables are read at nodes of their
  /// own, within 1e-4 (of dust with a peak of a degree) of what they hold.
  [[nodiscard]] Bands<Real> AerosolPhases(double nu) const;

  /// Radiance per unit solar irradiance [1/sr]: phase functions applied.
  [[nodiscard]] Bands<Real> Inscatter(const ScatteredOnce<Real>& scattered, double nu) const;

 private:
  Medium medium_;
  AirConstants<Real> constants_;
  PhaseNodes phase_nodes_;  // of float, where phase functions are tables
};

extern template class AirIntegrator<float>;
extern template class AirIntegrator<double>;

}  // namespace alpenglow::atmosphere
