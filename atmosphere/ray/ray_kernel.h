// SPDX-License-Identifier: MIT
// Kernels of single_scattering.h: loops over the samples of a ray, one table per instruction set.
#pragma once

#include <array>
#include <cstddef>

#include "atmosphere/ray/ray.h"
#include "atmosphere/shared_glsl/instruction_set.h"

namespace alpenglow::atmosphere {

/// A medium in the form that kernels use: lengths in km, coefficients per km.
template <typename Real>
struct AirConstants {
  Real radius, top;
  Real rayleigh_height, mie_height;
  Real deficit, deficit_height;  // deficit of molecules (MoleculeDeficit)
  Real ozone_bottom, ozone_peak, ozone_top;
  bool smooth_ozone;
  bool mie_ends_below_top;  // its column beyond the top is below 1e-12 m
  std::size_t bands;
  std::array<Real, kMaxBands> rayleigh, mie_scattering, mie_extinction, ozone;
};

/// Returns the extinction coefficients of a band [1/km].
template <typename Real>
[[nodiscard]] Extinction<Real> ExtinctionAt(const AirConstants<Real>& air, std::size_t band) {
  return {air.rayleigh[band], air.mie_extinction[band], air.ozone[band]};
}

/// A panel of a ray (RayPanel) and its Gauss rule, both rows padded with zeros to a multiple of
/// the lanes.
template <typename Real>
struct PanelRule {
  Real begin, end;
  Real stretch;  // b of ray_map.glsl; 0: t = length v
  bool rises, lit;
  std::size_t count;
  const Real* node;
  const Real* weight;
};

template <typename Real>
struct RayKernel {
  /// Number of lanes of the instruction set: samples are padded to a multiple.
  std::size_t lanes;
  /// Appends distance, weight and lit of the samples of one panel.
  void (*place)(const PanelRule<Real>& panel, RaySamples<Real>& samples);
  /// Computes everything at the samples that depends on their position, from distance, weight and
  /// lit.
  void (*fill)(const AirConstants<Real>& air, const RayEntry& entry, RaySamples<Real>& samples);
  /// Computes the same values as `fill`, with columns by ViewColumns::kBetweenSamples.
  void (*fill_between)(const AirConstants<Real>& air, const RayEntry& entry,
                       RaySamples<Real>& samples);
  /// Computes ScatteredOnce of all bands.
  void (*scatter)(const AirConstants<Real>& air, const RaySamples<Real>& samples,
                  ScatteredOnce<Real>& scattered);
  /// Computes columns of n points at altitudes [km] to space along zenith cosines; the directions
  /// must not hit the ground. All arrays hold a multiple of `lanes` and begin at multiples of 64
  /// bytes.
  void (*columns_to_space)(const AirConstants<Real>& air, std::size_t n, const Real* altitude,
                           const Real* mu, const ColumnSet<Real*>& columns);
  /// Computes columns to space like `columns_to_space`, for cosines in [0, 1].
  void (*columns_up)(const AirConstants<Real>& air, std::size_t n, const Real* altitude,
                     const Real* mu, const ColumnSet<Real*>& columns);
};

ALPENGLOW_DECLARE_KERNEL(RayKernel<float>);
ALPENGLOW_DECLARE_KERNEL(RayKernel<double>);

}  // namespace alpenglow::atmosphere
