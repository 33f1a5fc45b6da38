// SPDX-License-Identifier: MIT
// This header provides light scattered more than once, as spherical-harmonic moments of the diffuse
// radiance.
//
// By symmetry the diffuse radiance at a point depends on altitude h, sun zenith cosine mu_s and
// direction. Its moments on real spherical harmonics around the local vertical, with azimuth
// counted from the sun,
//
//   L_lm(h, mu_s) = integral of L(w) Y_lm(w) dw,   0 <= m <= l <= degree    (cos(m phi) terms only)
//
// are stored on a grid of (h, mu_s). Scattering is diagonal in them: a phase function with Legendre
// coefficients chi_l gives the source
//
//   J(w) = sigma_R sum_lm chi^R_l L_lm Y_lm(w) + sigma_M sum_lm chi^M_l L_lm Y_lm(w),
//
// which is exact for molecules (chi^R = 1, 0, D/10; D as in phase.glsl) with l <= 2. If the
// medium's light is polarised, three additional moments give the molecules' source
// (polarised_scattering.h). The moments of all orders are found by successive orders: the radiance
// of one order along directions of a Gauss grid split at the horizon is projected onto moments,
// which give the source of the next. Light reflected by the (Lambertian) ground is part of every
// order.
//
// All values are per unit solar irradiance. Successive orders: e.g. Herman, Ben-David, Thome
// (1994), Appl. Opt. 33, 1760. The use of moments over (altitude, sun angle) as a rendering table
// comes from this project.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "atmosphere/medium/medium.h"
#include "atmosphere/ray/single_scattering.h"
#include "lut/multiple_scattering/delta_m.h"
#include "lut/multiple_scattering/moment_kernel.h"
#include "lut/multiple_scattering/polarised_scattering.h"
#include "lut/multiple_scattering/spherical_harmonics.h"
#include "lut/tables/table_axes.h"

namespace alpenglow::lut {

struct MultipleScatteringOptions {
  int altitudes = 18;     // nodes, quadratic in altitude, >= 4
  int sun_angles = 32;    // nodes, dense around the terminator, >= 4
  int degree = 6;         // largest l: 2, 4, 6, 8 or 12
  int zenith_nodes = 14;  // directions above the horizon, and as many below, in [1, 64]
  int azimuth_nodes = 8;  // over half a turn, in [1, 32]
  int ray_nodes = 10;     // Gauss nodes along each direction, in [1, 32]
  // Numbers of nodes for the orders after the second, which are smooth. They take effect only if
  // they are smaller than the numbers above.
  int later_zenith_nodes = 6;
  int later_azimuth_nodes = 5;
  int later_ray_nodes = 6;
  int max_orders = 200;  // scatterings to compute, in [1, 10000]
  // Largest fraction of the light that may be summed as a geometric series instead of being
  // computed. In thick air: largest estimated error of the sum of all orders.
  double tolerance = 1e-2;
  /// Computes exactly this number of orders of the multiply scattered light (1: scattered or
  /// reflected once) and sums no rest. InscatterAlong then returns orders 2 to exact_orders + 1.
  /// Some table formats are defined this way.
  std::optional<int> exact_orders = std::nullopt;
  /// Finds the light that aerosol scatters forward in closed form (delta_m.h), for hazy and
  /// thick air. It cannot be combined with exact_orders.
  bool delta_m = false;
};

/// Returns the default options in clear air. If aerosol scatters more than 8 % of a vertical beam
/// or has narrow lobes (NarrowLobes of delta_m.h), returns degree 12 with the forward peak in
/// closed form; if all scattering takes more than 60 %, or molecules more than 33 %, more nodes; if
/// aerosol has an optical depth of more than 3, as many altitudes as its layer needs.
/// Radiances of all orders are then within 0.5 % (rms) of path tracing at an aerosol optical depth
/// of 0.1, 2 % at 1 and in the dust of Mars, 1 % through molecules of optical depth 5.
[[nodiscard]] MultipleScatteringOptions OptionsFor(const Medium& medium);
/// Returns `options` with what the medium needs more than clear air: where OptionsFor has more
/// nodes than the defaults, at least as many, and its degree and forward peak.
[[nodiscard]] MultipleScatteringOptions RaisedFor(const Medium& medium,
                                                  MultipleScatteringOptions options);

/// State of the end of a ray that ends in the air: more air follows, or an object hides it.
enum class SegmentEnd { kOpen, kOpaque };

/// Contents of the table and the state of the solver.
struct SolvedOrders {
  std::vector<float> values;  // indexed like MultipleScattering::values()
  int orders = 0;             // largest number of scatterings computed for any band
  bool converged = true;      // every band reached the tolerance within max_orders
};

/// Multiply scattered light of all orders. Immutable; look-ups are safe from many threads.
class MultipleScattering {
 public:
  /// Solves for the medium. The result does not depend on the number of threads. Very thick air
  /// may need more than max_orders; converged() is then false. A warning on standard error names
  /// each such air once, here and where a stored solution is restored. Scalar light on the ground
  /// under molecules is within 3 % of paths at optical depth 20 and 6 % at 40, and under aerosol with
  /// a lobe of g = 0.85 within 2 % at 15.65.
  explicit MultipleScattering(const Medium& medium, const MultipleScatteringOptions& options = {});

  /// Restores a stored solution: values, orders and converged as returned by the accessors. Throws
  /// InputError unless the number of values matches the options and all values are finite.
  MultipleScattering(const Medium& medium, const MultipleScatteringOptions& options,
                     SolvedOrders solved);

  [[nodiscard]] const Medium& medium() const { return medium_; }
  [[nodiscard]] bool converged() const { return converged_; }
  [[nodiscard]] int orders() const { return orders_; }
  [[nodiscard]] const MultipleScatteringOptions& options() const { return options_; }
  /// Returns the axes, for code that interpolates values() itself (moment_grid.h).
  [[nodiscard]] const MomentGrid& grid() const { return grid_; }
  [[nodiscard]] std::size_t bands() const { return bands_; }
  /// Returns the forward peak that is added to the moments; std::nullopt without delta_m.
  [[nodiscard]] const std::optional<DeltaM>& peak() const { return peak_; }

  /// Returns the in-scattered light of orders two and up along a sampled ray [1/sr].
  /// The samples must include the dark ones (Sampling::dark_samples).
  /// The result does not include light from the ground at the end of the ray. Beyond an open end it
  /// includes only the light that aerosol scatters forward to the eye (delta_m.h), not the
  /// light of objects there.
  [[nodiscard]] Spectrum InscatterAlong(const RaySamples<float>& samples, double nu,
                                        SegmentEnd end = SegmentEnd::kOpen) const {
    return InscatterAlong(samples, nu, nu, end);
  }
  /// Returns the light for a sun whose apparent position differs from that of the sun that lights
  /// the air (SunForAir of sun.h).
  /// @param nu_seen  cosine between the ray and the apparent sun: light that aerosol scatters
  ///   forward surrounds it.
  [[nodiscard]] Spectrum InscatterAlong(const RaySamples<float>& samples, double nu, double nu_seen,
                                        SegmentEnd end) const;

  /// Returns the part of InscatterAlong that the moments hold. AzimuthFan finds it for many
  /// azimuths.
  [[nodiscard]] Spectrum InscatterByMoments(const RaySamples<float>& samples, double nu) const;

  /// Returns the factor of the light of aerosol that is added near the sun to the moments
  /// (GlowAboutTheSun in thin air, DeltaM::FactorOf with delta_m), over light scattered once by
  /// aerosol without its phase function [1/sr]; 0 with exact_orders.
  /// @param column_km  as for GlowAboutTheSun::FactorOf.
  [[nodiscard]] Spectrum GlowFactor(double nu, float column_km) const;

  /// Returns Q and U of this light, with signs as in PolarisedLight; 0 if light is not polarised.
  [[nodiscard]] PolarisedLight PolarisationAlong(const RaySamples<float>& samples, double nu) const;

  /// Returns the diffuse (sky and ground) irradiance on a surface [1], per unit solar irradiance.
  /// @param normal_mu   cosine of the angle between the surface's normal and the vertical.
  /// @param normal_cos_azimuth  cosine of the azimuth of the normal relative to the sun's.
  /// It is computed from the moments by the clamped-cosine coefficients (Ramamoorthi, Hanrahan
  /// 2001) and corrected for the truncation error on horizontal surfaces. The error of those is
  /// within 2 % with earth's air.
  [[nodiscard]] Spectrum Irradiance(double altitude_m, double mu_s, double normal_mu,
                                    double normal_cos_azimuth) const;

  /// Returns the diffuse irradiance on a horizontal plane from above [1], which is integrated over
  /// directions, not computed from the moments.
  [[nodiscard]] Spectrum SkyIrradiance(double altitude_m, double mu_s) const;

  /// Returns the node values, for files and graphics cards: index ((altitude * sun_angles + sun) *
  /// channels() + channel) * bands() + band. Channels: the moments, l major (00, 10, 11, 20, ...),
  /// for polarised light T20, T21, T22 (polarised_scattering.h), then SkyIrradiance.
  [[nodiscard]] const std::vector<float>& values() const { return values_; }
  [[nodiscard]] std::size_t channels() const {
    return moments_ + 1 + (medium_.polarised ? kTensorMoments : 0);
  }

  /// Returns all channels [channel * bands() + band] at coordinates in [0, 1] (below), by the
  /// interpolation that every look-up uses: cubic, and between sun angles after division by the
  /// usual fall of light in twilight and, for polarised light, by powers of the sun's zenith sine
  /// (MomentGrid).
  [[nodiscard]] std::vector<float> ValuesAt(double altitude_coordinate,
                                            double sun_coordinate) const;

  /// Node coordinates: altitude = top u^2, u in [0, 1]; zenith cosine of the sun on SunNodes().
  [[nodiscard]] static const SunAxis& SunNodes();
  [[nodiscard]] static double SunCoordinate(double mu_s);

 private:
  friend class AzimuthFan;  // reads smooth()

  /// Returns the values that are interpolated: values(), minus the beam of peak() if that exists.
  [[nodiscard]] const std::vector<float>& smooth() const { return peak_ ? smooth_ : values_; }
  [[nodiscard]] std::vector<MomentBlock> BlocksOf() const;
  [[nodiscard]] Spectrum GlowAlong(const RaySamples<float>& samples, double nu) const;
  [[nodiscard]] Spectrum GroundLight(double mu_s) const;
  [[nodiscard]] ViewRay RayBehind(const RaySamples<float>& samples, double nu) const;
  [[nodiscard]] Spectrum PeakBehind(const RaySamples<float>& samples, double nu,
                                    double nu_seen) const;
  [[nodiscard]] AlignedFloats Packed() const;
  [[nodiscard]] std::vector<float> PackedSky() const;
  /// Calls visit(node, weight, sun) with the 16 nodes around a point; `sun` is the index of the
  /// node's sun angle.
  template <typename Visit>
  void VisitNodes(double altitude_coordinate, double mu_s, const Visit& visit) const;
  /// Returns T2m of polarised light.
  [[nodiscard]] std::array<Spectrum, kTensorMoments> TensorAt(double altitude_m, double mu_s) const;
  /// Returns the order m of a channel.
  [[nodiscard]] std::size_t OrderOf(std::size_t channel) const;
  [[nodiscard]] double AltitudeCoordinate(double altitude_m) const;

  Medium medium_;
  MultipleScatteringOptions options_;
  std::size_t bands_ = 0;
  std::size_t moments_ = 0;
  int orders_ = 0;
  bool converged_ = false;
  std::vector<float> values_;
  MomentGrid grid_;
  std::optional<DeltaM> peak_;
  AirConstants<float> air_{};
  std::optional<GlowAboutTheSun> glow_;  // only without delta_m and exact_orders
  std::vector<float> smooth_;
  std::vector<MomentBlock> blocks_;
  AlignedFloats packed_;           // a copy of the moments in the layout of the kernels
  std::vector<float> packed_sky_;  // a copy of SkyIrradiance in that layout
};

}  // namespace alpenglow::lut
