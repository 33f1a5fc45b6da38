// SPDX-License-Identifier: MIT
// Optical depth: over the species, extinction at the ground times column.
#pragma once

#include <cstddef>

#include "atmosphere/air/medium.h"

namespace alpenglow::atmosphere {

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
