// SPDX-License-Identifier: MIT
// Colours of light that a cloud turns once by more than the forward peak: fog bow, glory, corona and
// halo.
//
// Light in clouds is solved with one grey phase function p. Light of higher orders is nearly alike at
// all visible wavelengths, but that of first order has the features of the phase function. In the
// medium of the moments it has the phase function p_eff(nu, x) of forward_peak.h, where x is the
// optical depth of the forward peak on the way. With the phase function p_b of a wavelength it is
//
//   p_eff,b = (p_b + f sum_l w_l ((e^(-x (1 - a_l)) - e^(-x)) / x - a_l) P_l) / (1 - f)
//   a_l = 1 for l <= L,   min(chi_b,l / f, 1) above
//
// with the fraction f of the grey one, so that all wavelengths have the same light in all. This class
// has the differences p_eff,b - p_eff, seen through the disk of the sun or the moon, at angles that
// are dense at both ends and at eight depths x. Between them it is linear in the angle and in
// log(1 + x). As a light of first order is a sum over its way, its difference is one over hats in x.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/medium/phase.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

inline constexpr std::size_t kPeakHats = 8;

/// The hats in log(1 + x) at an optical depth of the forward peak: two neighbouring nodes and the
/// weight of the second. Nodes divide log(1 + x) up to x = 20 evenly; deeper points belong to the last
/// one.
struct PeakHats {
  std::size_t node;
  double share;
};
[[nodiscard]] PeakHats PeakHatsAt(double peak_depth);

/// Light of first order along a ray before it is multiplied by p_eff.
struct OnceScattered {
  double cos_scattering = 1.0;
  std::array<double, kPeakHats> by_depth{};  // per unit of p_eff [1], by hat in x

  /// Adds light with an optical depth of the peak on its way.
  void Add(double light, double peak_depth) {
    const PeakHats hats = PeakHatsAt(peak_depth);
    by_depth[hats.node] += (1.0 - hats.share) * light;
    by_depth[hats.node + 1] += hats.share * light;
  }
};

/// Immutable; safe to use from many threads.
class PhaseColours {
 public:
  /// @param grey  with a forward peak. @param bands  the phase functions of the same droplets or
  ///     crystals by wavelength. @param degree  L, in [0, 16]. Throws InputError beyond, and for a grey
  ///     phase function without a peak.
  PhaseColours(const PhaseFunction& grey, const std::vector<PhaseFunction>& bands, int degree);

  [[nodiscard]] std::size_t bands() const { return bands_; }

  /// Returns the light of each band less that of the grey phase function [1/sr]. Its integral over all
  /// directions is 0 within 0.003 of the light.
  [[nodiscard]] SpectrumOf<double> Differences(const OnceScattered& once) const;

 private:
  std::size_t bands_;
  std::vector<float> table_;  // p_eff,b - p_eff [angle][hat][band]
};

}  // namespace alpenglow::renderer
