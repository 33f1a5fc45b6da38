// SPDX-License-Identifier: MIT
// This header provides the transmittance from a point to space, tabulated over altitude and view
// zenith cosine.
//
//   texel (i, j) = T(h_j, mu_i) per band, stored as float, rays to space only
//
// The map is that of table_maps.glsl: columns run from the zenith to the horizon, rows from the
// ground to the top. SingleScattering computes this transmittance faster and more accurately (see
// its header). The table is for programs that load tables, and for comparison with it.
//
// This header also includes the shared text table_maps.glsl as C++ templates over double, float and
// SIMD batches. Lengths are kilometres there and metres in the tables.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "atmosphere/medium/medium.h"
#include "atmosphere/ray/ray.h"
#include "atmosphere/ray/shell.h"
#include "atmosphere/ray/single_scattering.h"
#include "lut/layer.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/shared_glsl/shared_begin.h"
#include "lut/tables/table_maps.glsl"
#include "atmosphere/shared_glsl/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared

namespace alpenglow::lut {

struct TransmittanceTableSize {
  std::size_t mu = 256;        // >= 2
  std::size_t altitudes = 64;  // >= 2
};

class TransmittanceTable {
 public:
  /// Fills the table from closed forms in double, in parallel; the bytes do not depend on the
  /// number of threads. Throws InputError, with the size in bytes, for a size that is not allowed.
  explicit TransmittanceTable(const Medium& medium, const TransmittanceTableSize& size = {});

  /// Restores a stored table: texels as returned by texels(). Throws InputError unless their number
  /// matches the size and all lie in [0, 1].
  TransmittanceTable(const Medium& medium, const TransmittanceTableSize& size,
                     std::vector<float> texels);

  /// Returns the transmittance to space, bilinear; 0 if the ground is in the way, 1 for rays that
  /// miss the air. Observers above the top are moved to where the ray enters.
  ///
  /// Error at the default size, earth and bruneton2017, against the reference solution: below 4e-3
  /// everywhere (rays near the horizon through the aerosol), 3e-4 rms.
  [[nodiscard]] Spectrum Lookup(double altitude_m, double mu) const;

  /// Returns the transmittance from the observer to the end of the ray: a quotient of two look-ups.
  /// Their error is divided by the transmittance from the end of the ray to space.
  [[nodiscard]] Spectrum LookupAlong(const ViewRay& ray) const;

  [[nodiscard]] const Medium& medium() const { return medium_; }
  [[nodiscard]] const TransmittanceTableSize& size() const { return size_; }
  /// Size of the texels [bytes].
  [[nodiscard]] std::uint64_t bytes() const { return texels_.size() * sizeof(float); }

  /// texels()[(altitude * size().mu + mu) * bands + band].
  [[nodiscard]] const std::vector<float>& texels() const { return texels_; }

  /// Altitude and zenith cosine of a texel.
  struct Point {
    double altitude_m, mu;
  };
  [[nodiscard]] Point PointOfTexel(std::size_t mu, std::size_t altitude) const;

 private:
  /// Interpolates inside the shell, for a ray that does not hit the ground.
  [[nodiscard]] Spectrum Interpolate(double altitude_km, double mu) const;

  Medium medium_;
  TransmittanceTableSize size_;
  double radius_km_;
  double top_km_;
  std::vector<float> texels_;
};

}  // namespace alpenglow::lut
