// SPDX-License-Identifier: MIT
// Sky view: a table of radiance over the whole sphere around one observer under one sun, with sky,
// ground seen through the air, and the limb seen from space.
//
// Radiance per unit solar irradiance [1/sr] in a direction of zenith angle z and azimuth p from the
// sun's, with nu the cosine of the angle to the sun:
//
//   L = p_R(nu) R(z, p) + p_M(nu) M(z, p) + D(z, p)
//
// R and M are single scattering by molecules and by aerosol without the phase function, D is all
// other light: multiple scattering, and light from the ground. Sharp phase functions are applied at
// the look-up, so that the aureole is as accurate as its surroundings; the stored values are
// smooth.
//
// Where the forward peak of the aerosol is separate (delta_m.h), the aerosol's light of all orders
// depends on nu and on the optical depth y of scattering on the path of the light. Divided by its
// transmittance in the medium without the peak, exp(f y - tau), it is interpolated in y between a
// few depths y_k by Lagrange's polynomials l_k,
//
//   L = p_R(nu) R + p_M(nu) M + sum over k of P(nu, y_k) M_k + B(nu) M_B + D,
//   M_k = integral of sigma_M exp(f y - tau) l_k(y) ds,
//
// where P(nu, y) is PeakAtAngle::LightOf aerosol at optical depth f y, and R includes the factor
// exp(f y). Only P varies fast with the direction. With a narrow backward lobe, B is
// PeakAtAngle::twice_back, and M_B is the integral of sigma_M exp(f y - tau) times UpFromBelow.
//
// Rows of one zenith angle are split at the horizon (sky_view_map.h); columns are uniform
// in azimuth over half a turn, and the other half is its mirror image. Between nodes the table is
// interpolated by the tensor product of cubic splines, stored as coefficients of B-splines, of
// which a look-up reads four by four.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "atmosphere/ray/single_scattering.h"
#include "lut/multiple_scattering/multiple_scattering.h"
#include "lut/sky/sky_view_map.h"

namespace alpenglow::lut {

struct SkyViewSize {
  int sky_rows = 40;     // from the horizon to the zenith or the air's upper edge, >= 5
  int ground_rows = 24;  // from the horizon to the nadir, >= 5
  int azimuths = 17;     // from the sun's azimuth to the opposite one, both included, >= 3
  int ray_nodes = 12;    // Gauss nodes on each smooth segment of a ray, for multiple scattering
};

/// Returns the size with the error stated for SkyView: twilight and great heights need more nodes
/// than day on the ground.
[[nodiscard]] SkyViewSize SkyViewSizeFor(const Medium& medium, double altitude_m, double mu_s);

class SkyView;

/// Azimuths of a row of look-ups, prepared once for any number of rows.
class SkyAzimuths {
 public:
  /// @param azimuth_rad  from the sun's azimuth, any finite values.
  SkyAzimuths(const SkyView& view, std::span<const double> azimuth_rad);

  [[nodiscard]] std::size_t count() const { return cell_.size(); }

 private:
  friend class SkyView;
  int columns_;                     // columns of the view for which they are prepared
  std::vector<std::int32_t> cell_;  // first of the four coefficients
  std::vector<float> weights_;      // four per look-up
  std::vector<float> half_sine2_;   // sin^2(p / 2)
};

/// A sky view. Immutable; look-ups are safe from many threads.
///
/// Error of the size that SkyViewSizeFor returns, over the whole sphere and against direct
/// evaluation (SingleScattering<double> with many nodes, MultipleScattering), relative to the
/// radiance or to a thousandth of its mean, whichever is larger: rms below 0.3 %, below 0.6 % for
/// 95 % of directions and bands, for the atmospheres of the earth, from the ground to 400 km, with
/// the sun from the zenith to 10 degrees below the horizon. The largest errors are where the light
/// fades within a degree: at the edge of the planet's shadow in red light, and on the limb behind
/// the terminator.
class SkyView {
 public:
  /// `air` and `multiple_scattering` must have the same medium; no reference to them is kept.
  /// @param mu_s  cosine of the sun's zenith angle at the observer.
  SkyView(const SingleScattering<float>& air, const MultipleScattering& multiple_scattering,
          double altitude_m, double mu_s, const SkyViewSize& size);
  SkyView(const SingleScattering<float>& air, const MultipleScattering& multiple_scattering,
          double altitude_m, double mu_s);

  /// Returns the sky with a visible sun in a direction that differs from that of the sun that
  /// lights the air (SunForAir of sun.h), by a degree at most: the aureole surrounds the visible
  /// sun.
  [[nodiscard]] SkyView WithSunSeenAt(double zenith_angle_rad) && {
    sun_zenith_angle_rad_ = zenith_angle_rad;
    return std::move(*this);
  }

  [[nodiscard]] std::size_t bands() const { return bands_; }
  /// Returns the number of floats from one look-up to the next in a filled row: bands() rounded up
  /// to a multiple of 4.
  [[nodiscard]] std::size_t stride() const { return 4 * blocks_.size(); }
  [[nodiscard]] const SkyViewSize& size() const { return size_; }
  [[nodiscard]] const SkyViewMap& map() const { return map_; }
  /// Returns the memory size of the table.
  [[nodiscard]] std::size_t bytes() const;

  /// Returns the radiance per unit solar irradiance [1/sr] of every band, never negative.
  /// @param zenith_angle_rad  in [0, pi]; up to the zenith angle of the horizon it is the sky,
  /// beyond it the ground.
  [[nodiscard]] Spectrum Radiance(double zenith_angle_rad, double azimuth_rad) const;

  /// Computes the radiance for a row of directions of one zenith angle:
  /// radiance[i * stride() + band]. The caller owns the memory because allocating it would cost as
  /// much as the look-ups.
  void FillRow(double zenith_angle_rad, const SkyAzimuths& azimuths,
               std::span<float> radiance) const;

 private:
  /// Coefficients of four bands: R, D and the terms M of each band for every column of a row. The
  /// rows of the ground follow those of the sky.
  struct Block {
    std::vector<float> coefficients;
    std::vector<float> phase;  // phase functions of the terms M, four values each, by node
  };
  class Builder;
  struct RowPosition;
  /// Returns std::nullopt above the upper edge of the air.
  [[nodiscard]] std::optional<RowPosition> PositionOfRow(double zenith_angle_rad) const;

  SkyViewMap map_;
  SkyViewSize size_;
  std::size_t bands_;
  std::size_t terms_;  // number of terms M
  double sun_zenith_angle_rad_;
  std::vector<Block> blocks_;
};

/// Returns the column of aerosol, relative to its density on the ground [km], that sky views use
/// for the glow around the sun (MultipleScattering::GlowFactor): the column on the path of its
/// light from the sun to the observer, in twilight along the horizon.
[[nodiscard]] float GlowColumn_km(const SingleScattering<float>& air, double altitude_m,
                                  double mu_s);

}  // namespace alpenglow::lut
