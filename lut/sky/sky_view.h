// SPDX-License-Identifier: MIT
// The whole sphere around one observer under one sun, tabulated: sky, ground with the air before
// it, and the limb seen from space.
//
// Radiance per unit solar irradiance [1/sr] in a direction of zenith angle z and azimuth p from the
// sun's, nu being the cosine between it and the sun:
//
//   L = p_R(nu) R(z, p) + p_M(nu) M(z, p) + D(z, p)
//
// R and M are the light scattered once by molecules and by aerosol without its phase function, D
// all other light: scattered more than once, or from the ground. Sharp phase functions are applied
// at the look-up, so that the aureole is as exact as its neighbourhood; what is stored is smooth.
// Rows of one zenith angle are split at the horizon (sky_view_map.h); columns are uniform in
// azimuth over half a turn, the other half being its mirror image. Between nodes: the natural
// product of interpolating cubic splines, as coefficients of B-splines, of which a look-up reads
// four by four.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "atmosphere/ray/single_scattering.h"
#include "lut/diffuse/multiple_scattering.h"
#include "lut/sky/sky_view_map.h"

namespace alpenglow::lut {

struct SkyViewSize {
  int sky_rows = 40;     // from the horizon to the zenith or the air's upper edge, >= 5
  int ground_rows = 24;  // from the horizon to the nadir, >= 5
  int azimuths = 17;     // from the sun's azimuth to the opposite one, both included, >= 3
  int ray_nodes = 12;    // Gauss nodes on each smooth piece of a ray, for light of higher orders
};

/// What keeps the error that SkyView states: twilight
/// and great heights need more than day on the ground.
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
  int columns_;                     // of the view they are made for
  std::vector<std::int32_t> cell_;  // first of the four coefficients
  std::vector<float> weights_;      // four a look-up
  std::vector<float> half_sine2_;   // sin^2(p / 2)
};

/// Immutable; look-ups are safe from many threads.
///
/// Error of the size that SkyViewSizeFor gives, over the whole sphere and against direct evaluation
/// (AirIntegrator<double> of many nodes, DiffuseLight), relative to the radiance or to a thousandth
/// of its mean where that is more: rms below 0.3 %, below 0.6 % for 95 % of directions and bands,
/// for the atmospheres of the earth, from the ground to 400 km, the sun from the zenith to 10
/// degrees below the horizon. The rest is where light dies within a degree: at the edge of the
/// planet's shadow in red light, and on the limb behind the terminator.
class SkyView {
 public:
  /// @param mu_s  cosine of the sun's zenith angle at the observer.
  /// `air` and `diffuse` must be of one medium; neither is kept.
  SkyView(const AirIntegrator<float>& air, const DiffuseLight& diffuse, double altitude_m,
          double mu_s, const SkyViewSize& size);
  SkyView(const AirIntegrator<float>& air, const DiffuseLight& diffuse, double altitude_m,
          double mu_s);

  /// Returns the sky under a sun that is seen elsewhere than the one that lights the air (SunForAir of
  /// sun.h), a degree from it at most: the aureole lies about what is seen.
  [[nodiscard]] SkyView WithSunSeenAt(double zenith_angle_rad) && {
    sun_zenith_angle_rad_ = zenith_angle_rad;
    return std::move(*this);
  }

  [[nodiscard]] std::size_t bands() const { return bands_; }
  /// Floats from one look-up to the next in a filled row: bands() rounded up to a multiple of 4.
  [[nodiscard]] std::size_t stride() const { return 4 * blocks_.size(); }
  [[nodiscard]] const SkyViewSize& size() const { return size_; }
  [[nodiscard]] const SkyViewMap& map() const { return map_; }
  /// Memory of the table.
  [[nodiscard]] std::size_t bytes() const;

  /// Radiance per unit solar irradiance [1/sr] of every band, never negative.
  /// @param zenith_angle_rad  in [0, pi]; up to the horizon's the sky is seen, beyond it the
  /// ground.
  [[nodiscard]] Bands<float> Radiance(double zenith_angle_rad, double azimuth_rad) const;

  /// The same for a row of directions of one zenith angle: radiance[i * stride() + band]. The
  /// caller owns the memory because allocating it would cost as much as the look-ups.
  void FillRow(double zenith_angle_rad, const SkyAzimuths& azimuths,
               std::span<float> radiance) const;

 private:
  /// Coefficients of four bands: [(row * columns + column) * 12]: R, M and D of each band. The
  /// ground's rows follow the sky's.
  struct Block {
    std::vector<float> coefficients;
    std::vector<float> phase;  // of the aerosol, four a node
  };
  class Builder;
  struct RowPosition;
  /// Nothing above the upper edge of the air.
  [[nodiscard]] std::optional<RowPosition> PositionOfRow(double zenith_angle_rad) const;

  SkyViewMap map_;
  SkyViewSize size_;
  std::size_t bands_;
  double sun_zenith_angle_rad_;
  std::vector<Block> blocks_;
};

/// Column of aerosol at its density on the ground [km] with which sky views take the glow about the sun
/// (DiffuseLight::GlowFactor): that on the way of its light from the sun to the eye, by twilight along the
/// horizon.
[[nodiscard]] float GlowColumn_km(const AirIntegrator<float>& air, double altitude_m, double mu_s);

}  // namespace alpenglow::lut
