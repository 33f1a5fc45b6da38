// SPDX-License-Identifier: MIT
// Light scattered more than once, as spherical-harmonic moments of the diffuse radiance.
//
// By symmetry the diffuse radiance at a point depends on altitude h, sun zenith cosine mu_s and
// direction. Its moments on real spherical harmonics around the local vertical, azimuth counted
// from the sun,
//
//   L_lm(h, mu_s) = integral of L(w) Y_lm(w) dw,   0 <= m <= l <= degree    (cos(m phi) terms only)
//
// are stored on a grid of (h, mu_s). Scattering is diagonal in them: a phase function with Legendre
// coefficients chi_l gives the source
//
//   J(w) = sigma_R sum_lm chi^R_l L_lm Y_lm(w) + sigma_M sum_lm chi^M_l L_lm Y_lm(w),
//
// exact for molecules (chi^R = 1, 0, D/10; D as in phase.glsl) with l <= 2. Where the medium's
// light is polarised the molecules' source is made of three moments more (polarised_light.h). The
// moments of all orders are found by successive orders: radiance of one order along directions
// of a Gauss grid split at the horizon, projected, gives the source of the
// next. Light reflected by the (Lambertian) ground is part of every order.
//
// Per unit solar irradiance throughout. Successive orders: e.g.
// Herman, Ben-David, Thome (1994), Appl. Opt. 33, 1760; the moments
// over (altitude, sun angle) as a rendering table are this project's.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "atmosphere/air/medium.h"
#include "atmosphere/ray/single_scattering.h"
#include "lut/diffuse/diffuse_kernel.h"
#include "lut/diffuse/forward_peak.h"
#include "lut/diffuse/polarised_light.h"
#include "lut/diffuse/spherical_harmonics.h"
#include "lut/table/table_axes.h"

namespace alpenglow::lut {

struct DiffuseLightOptions {
  int altitudes = 18;     // nodes, quadratic in altitude, >= 4
  int sun_angles = 32;    // nodes, dense around the terminator, >= 4
  int degree = 6;         // largest l: 2, 4, 6 or 12
  int zenith_nodes = 14;  // directions above and below the horizon, each, in [1, 64]
  int azimuth_nodes = 8;  // over half a turn, in [1, 32]
  int ray_nodes = 10;     // Gauss nodes along each direction, in [1, 32]
  // The same for light scattered twice and more before it arrives, which is smooth: smaller numbers
  // than those above, or they have no effect.
  int later_zenith_nodes = 6;
  int later_azimuth_nodes = 5;
  int later_ray_nodes = 6;
  int max_orders = 200;  // in [1, 10000]
  // Share of the light that is summed as a geometric series, not computed; or, in thick air, what is
  // not known of that, ten times over.
  double tolerance = 1e-2;
  /// Exactly so many orders of the diffuse light (1: scattered or reflected once), no rest summed:
  /// InscatterAlong then gives orders 2 to exact_orders + 1. For tables that are defined so.
  std::optional<int> exact_orders = std::nullopt;
  /// Light that aerosol throws forward is found in closed form (forward_peak.h), for hazy and thick
  /// air; not with exact_orders.
  bool forward_peak = false;
};

/// The usual ones in clear air. Where aerosol scatters more than 8 % of a vertical beam, degree 12
/// with the forward peak in closed form; where all scattering takes more than 60 %, or molecules more
/// than 33 %, more nodes.
/// Radiances of all orders are then within 0.5 % (rms) of path tracing at an aerosol's optical depth
/// of 0.1, 2 % at 1 and in the dust of Mars, 1 % through molecules of optical depth 5.
[[nodiscard]] DiffuseLightOptions OptionsFor(const Medium& medium);

/// What is at the end of a ray that ends in the air: more air, or something that hides it.
enum class SegmentEnd { kOpen, kOpaque };

/// What the table is made of.
struct SolvedOrders {
  std::vector<float> values;  // as DiffuseLight::values()
  int orders = 0;             // largest number of orders computed for any band
  bool converged = true;      // every band reached the tolerance within max_orders
};

/// Diffuse light of all orders. Immutable; lookups are safe from many threads.
class DiffuseLight {
 public:
  /// Solves for the medium. Deterministic for any number of threads. Thick or conservative air may
  /// need more than max_orders: converged() then says false.
  explicit DiffuseLight(const Medium& medium, const DiffuseLightOptions& options = {});

  /// A solution that was stored: values, orders and converged as their accessors gave them. Throws
  /// InputError unless there are as many values as the options say and all are finite.
  DiffuseLight(const Medium& medium, const DiffuseLightOptions& options, SolvedOrders solved);

  [[nodiscard]] const Medium& medium() const { return medium_; }
  [[nodiscard]] bool converged() const { return converged_; }
  [[nodiscard]] int orders() const { return orders_; }
  [[nodiscard]] const DiffuseLightOptions& options() const { return options_; }
  /// The axes, for those who interpolate values() themselves (diffuse_grid.h).
  [[nodiscard]] const DiffuseGrid& grid() const { return grid_; }
  [[nodiscard]] std::size_t bands() const { return bands_; }
  [[nodiscard]] std::size_t moments() const { return moments_; }

  /// In-scattered light of orders two and up along a sampled ray [1/sr].
  /// The samples must include the dark ones (Sampling::dark_samples).
  /// Does not include light from the ground at the end of the ray. Of what is behind an open end it
  /// includes what aerosol throws on towards the eye (forward_peak.h), not of what stands there.
  [[nodiscard]] Bands<float> InscatterAlong(const RaySamples<float>& samples, double nu,
                                            SegmentEnd end = SegmentEnd::kOpen) const {
    return InscatterAlong(samples, nu, nu, end);
  }
  /// Returns the light under a sun that is seen elsewhere than the one that lights the air (SunForAir of sun.h).
  /// @param nu_seen  cosine between the ray and the sun that is seen: light that aerosol throws forward lies about it.
  [[nodiscard]] Bands<float> InscatterAlong(const RaySamples<float>& samples, double nu,
                                            double nu_seen, SegmentEnd end) const;

  /// The part of it that the moments hold, as DiffuseFan finds it for many azimuths.
  [[nodiscard]] Bands<float> InscatterByMoments(const RaySamples<float>& samples, double nu) const;

  /// Light that this adds near the sun to moments of thin air (GlowAboutTheSun), over light scattered once
  /// by aerosol without its phase function [1/sr]; nothing where the forward peak is set apart.
  /// @param column_km  as for GlowAboutTheSun::FactorOf.
  [[nodiscard]] Bands<float> GlowFactor(double nu, float column_km) const;

  /// Q and U of the same light, with signs as in PolarisedLight; 0 where light is not polarised.
  [[nodiscard]] PolarisedLight PolarisationAlong(const RaySamples<float>& samples, double nu) const;

  /// Diffuse (sky and ground) irradiance on a surface [1], per unit solar irradiance.
  /// @param normal_mu   cosine of the angle between the surface's normal and the vertical.
  /// @param normal_cos_azimuth  cosine of the azimuth of the normal relative to the sun's.
  /// From the moments by the clamped-cosine coefficients (Ramamoorthi, Hanrahan 2001), corrected
  /// for what the series misses on horizontal surfaces: those within 2 %, with earth's air.
  [[nodiscard]] Bands<float> Irradiance(double altitude_m, double mu_s, double normal_mu,
                                        double normal_cos_azimuth) const;

  /// Diffuse irradiance that falls on a horizontal plane from above [1]: integrated over
  /// directions, not from the moments.
  [[nodiscard]] Bands<float> SkyIrradiance(double altitude_m, double mu_s) const;

  /// Node values, for files and graphics cards: index ((altitude *
  /// sun_angles + sun) * channels() + channel) * bands() + band. Channels:
  /// the moments, l major (00, 10, 11, 20, ...), of polarised light T20, T21, T22
  /// (polarised_light.h), then SkyIrradiance.
  [[nodiscard]] const std::vector<float>& values() const { return values_; }
  [[nodiscard]] std::size_t channels() const {
    return moments_ + 1 + (medium_.polarised ? kTensorMoments : 0);
  }

  /// All channels [channel * bands() + band] at coordinates in [0, 1] (below), by the interpolation
  /// that every look-up uses: cubic, between sun angles after division by the usual fall of light
  /// in twilight, and of polarised light by powers of its sine (DiffuseGrid).
  [[nodiscard]] std::vector<float> ValuesAt(double altitude_coordinate,
                                            double sun_coordinate) const;

  /// Node coordinates: altitude = top u^2, u in [0, 1]; the sun's zenith cosine on SunNodes().
  [[nodiscard]] static const SunAxis& SunNodes();
  [[nodiscard]] static double SunCoordinate(double mu_s);
  [[nodiscard]] static double MuSFromCoordinate(double v);

 private:
  [[nodiscard]] std::vector<DiffuseBlock> BlocksOf() const;
  [[nodiscard]] Bands<float> GlowAlong(const RaySamples<float>& samples, double nu) const;
  [[nodiscard]] Bands<float> GroundLight(double mu_s) const;
  [[nodiscard]] ViewRay RayBehind(const RaySamples<float>& samples, double nu) const;
  [[nodiscard]] Bands<float> PeakBehind(const RaySamples<float>& samples, double nu,
                                        double nu_seen) const;
  /// What is interpolated: values(), or without the beam that peak_ knows in closed form.
  [[nodiscard]] const std::vector<float>& smooth() const { return peak_ ? smooth_ : values_; }
  [[nodiscard]] AlignedFloats Packed() const;
  [[nodiscard]] std::vector<float> PackedSky() const;
  /// Calls visit(node, weight, sun) with the 16 nodes around a point; `sun` is the node's own.
  template <typename Visit>
  void VisitNodes(double altitude_coordinate, double mu_s, const Visit& visit) const;
  /// T2m of polarised light.
  [[nodiscard]] std::array<Bands<float>, kTensorMoments> TensorAt(double altitude_m,
                                                                  double mu_s) const;
  /// Order m of a channel.
  [[nodiscard]] std::size_t OrderOf(std::size_t channel) const;
  [[nodiscard]] double AltitudeCoordinate(double altitude_m) const;

  Medium medium_;
  DiffuseLightOptions options_;
  std::size_t bands_ = 0;
  std::size_t moments_ = 0;
  int orders_ = 0;
  bool converged_ = false;
  std::vector<float> values_;
  DiffuseGrid grid_;
  std::optional<ForwardPeak> peak_;
  AirConstants<float> air_{};
  std::optional<GlowAboutTheSun> glow_;  // where peak_ is not
  std::vector<float> smooth_;
  std::vector<DiffuseBlock> blocks_;
  AlignedFloats packed_;           // the moments again, as kernels read them
  std::vector<float> packed_sky_;  // and SkyIrradiance
};

}  // namespace alpenglow::lut
