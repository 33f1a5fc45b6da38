// SPDX-License-Identifier: MIT
// The light in a stack of plane-parallel layers under one source: fluxes at any depth, radiance at
// any depth in any direction.
//
// In each layer and azimuth mode the amplitudes of layer_mode.h follow
//
//   a_j'' = k_j^2 a_j - r_j e^(-tau / mu_s),   e = B a,   o = U (a' + g e^(-tau / mu_s))
//   r = (2 - delta_m0) / pi (E + O / mu_s),   g = -(2 - delta_m0) / pi O
//
// for a beam of unit irradiance across it, with E and O the emission into the direction of the sun
// (EmissionAt). They are kept by their values at both ends of the layer. At k_j mu_s = 1 the
// particular solution has a pole that the boundary values cancel; k_j is moved by a millionth. In
// layers so thin that all this is linear, a and o are interpolated between the ends.
//
// Radiance in a direction between the streams is the integral of the source function (Stamnes, Tsay,
// Wiscombe and Jayaweera 1988, Appl. Opt. 27, 2502). Integrating by parts twice,
//
//   (k^2 - s^2) integral a w = [a' w] + s [a w] + r integral e^(-tau / mu_s) w,   w = e^(-s tau),
//
// with s = 1 / mu.
//
// Light that is scattered once out of the beam has the exact phase function with the forward peak
// of all orders (peak_series.h) instead of that of the streams (Nakajima and Tanaka 1988, J. Quant.
// Spectrosc. Radiat. Transf. 40, 51: TMS; the peak takes the place of their IMS).
//
// Units: for the sun, irradiance 1 across the beam at the top; for the sky, radiance 1 in all
// directions at the top; for the ground, radiance 1 emitted in all directions.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "renderer/layer.h"
#include "renderer/layers/first_order.h"
#include "renderer/layers/layer_mode.h"
#include "renderer/layers/layer_stack.h"
#include "renderer/layers/line_of_sight.h"

namespace alpenglow::renderer {

/// Irradiances of horizontal planes.
struct LayerFluxes {
  double up, down;  // diffuse light
  double direct;    // the beam, attenuated by the whole optical depth
};

/// The light of one source in a stack. Immutable; safe to use from many threads. Refers to the stack.
///
/// With 8 streams, errors over the layers of tests/renderer/layers/layer_accuracy_test.cpp are below
/// 1 % (root mean square) and 4 % (99 of 100 directions) of radiances beyond 3 degrees from the sun
/// and 0.0015 of the incident flux.
class LayerField {
 public:
  /// @param mu_s  cosine of the sun's zenith angle, in (0, 1]; otherwise InputError.
  [[nodiscard]] static LayerField UnderSun(const LayerStack& stack, double mu_s);
  [[nodiscard]] static LayerField UnderUniformSky(const LayerStack& stack);
  /// @param sky  radiance at the top by the direction in which the light travels, even in azimuth.
  ///   Between the streams, Radiance() takes it as 0 at the end of a line of sight.
  [[nodiscard]] static LayerField UnderSky(const LayerStack& stack,
                                           const std::function<double(const LightWay&)>& sky);
  [[nodiscard]] static LayerField OverUniformGround(const LayerStack& stack);

  /// @param depth  optical depth below the top, in [0, that of the stack]; otherwise InputError.
  [[nodiscard]] LayerFluxes Fluxes(double depth) const;

  /// Returns the radiance of diffuse light, without the beam itself.
  /// @param way  directions within 1e-6 of the horizontal count as going upwards with mu = 1e-6;
  ///   InputError unless mu is in [-1, 1].
  [[nodiscard]] double Radiance(double depth, const LightWay& way) const;
  /// Returns the same without sunlight that is scattered once.
  [[nodiscard]] double RadianceOfHigherOrders(double depth, const LightWay& way) const;

  /// Returns the light of all orders but the first of the sun's beam that is scattered into any
  /// direction, per optical depth after delta-M: s_lm of
  /// source = sum over l, m of s_lm Lambda_l^m(mu) cos(m azimuth), at [m * streams + l].
  [[nodiscard]] std::vector<double> SourceOfHigherOrders(double depth) const;

 private:
  /// Values a and slopes a' + g e^(-tau / mu_s) at one depth.
  struct Amplitudes {
    std::vector<double> value, slope;
  };
  /// One mode in one layer: k, r and g times the beam at the top of the layer, and the amplitudes at
  /// both ends.
  struct Solved {
    std::vector<double> decay, source, shift;
    Amplitudes top, bottom;
  };
  explicit LayerField(const LayerStack& stack) : stack_(stack) {}
  void AddSunnyMode(int m);
  void AddMode(int m, const ModeSources& sources, std::vector<Solved> solved);
  /// Returns a mode in a layer under the sun with a = 0 at both ends.
  [[nodiscard]] Solved Sunny(const LayerMode& mode, std::size_t layer, int m) const;
  /// Light that leaves a layer at its top and at its bottom.
  struct Leaving {
    std::vector<double> up, down;
  };
  [[nodiscard]] Leaving LeavingSunny(const LayerMode& mode, const Solved& solved,
                                     double depth) const;

  /// Returns the beam at a depth of a layer, relative to that at its top; 0 without a sun.
  [[nodiscard]] double BeamIn(double depth) const;
  /// Returns the transmittance of the beam to the top of a layer, after delta-M.
  [[nodiscard]] double BeamAbove(std::size_t layer) const;
  [[nodiscard]] Amplitudes At(const Solved& solved, const LayerPlace& place) const;
  [[nodiscard]] bool IsThin(double decay, double depth) const;
  /// Returns the light that enters the stack at the end of a line of sight.
  [[nodiscard]] double Behind(double mu) const;
  /// Returns the light of a line of sight, without sunlight that is scattered once.
  [[nodiscard]] double AlongLine(const std::vector<LineSegment>& line, const LightWay& way) const;
  [[nodiscard]] double InSegment(int m, const LineSegment& segment, double mu) const;

  const LayerStack& stack_;
  std::optional<double> mu_s_;
  double from_above_ = 0.0, of_ground_ = 0.0;
  std::vector<std::vector<Solved>> solved_;  // [m][layer]
};

}  // namespace alpenglow::renderer
