// SPDX-License-Identifier: MIT
// The forward peak of a phase function with all its own orders of scattering, in closed form.
//
// A solution by moments of degree L leaves out the peak of fraction f = chi_(L+1) and sees the
// extinction (1 - f) sigma (delta-M: Wiscombe 1977, J. Atmos. Sci. 34, 1408). The peak has the
// moments a_l = 1 for l <= L and chi_l / f above. Light that it scatters any number of times stays
// near its way, so that n scatterings by the peak have the moments a_l^n, and over an optical depth
// x of the peak their number follows Poisson's law. With one scattering by the whole phase function
// p among them, at any place of the way, the light of a way looks as if it were scattered once by
//
//   p_eff(nu, x) = (p(nu) + f sum_l w_l ((e^(-x (1 - a_l)) - e^(-x)) / x - a_l) P_l(nu)) / (1 - f)
//
// in the medium of the moments, with w_l = (2 l + 1) / (4 pi). Here x = f times the optical depths
// to the sun and to the eye. Where a path scatters by p in the true medium and only the way to the
// sun is taken in the medium of the moments, the phase function is broadened on that way alone:
//
//   B(nu, x) = p(nu) + sum_l w_l chi_l (e^(-x (1 - a_l)) - 1) P_l(nu)
//
// A beam exp(-(1 - f) tau) times p itself would lose the light that the peak has turned a little.
//
// What the peak leaves may also be a lobe of Henyey and Greenstein, with the moments g'^l. The peak then
// has the moments a_l = (chi_l - (1 - f) g'^l) / f.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "atmosphere/medium/phase.h"
#include "renderer/cloud_phase/peak_moments.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Immutable; safe to use from many threads.
class ForwardPeak {
 public:
  /// Tabulates both functions for 512 angles and 64 depths.
  /// @param degree  L, in [0, 16]. Throws InputError beyond, and for a phase function without a
  /// peak, f outside (0, 1).
  ForwardPeak(const PhaseFunction& phase, int degree);

  /// Returns the peak that leaves a lobe of Henyey and Greenstein. Throws InputError for a fraction
  /// outside (0, 1).
  /// @param g  of the lobe, in [0, 1).
  [[nodiscard]] static ForwardPeak BesideLobe(const PhaseFunction& phase, double fraction,
                                              double g);

  /// Returns f, the fraction of the scattered light in the peak.
  [[nodiscard]] double fraction() const { return fraction_; }

  /// Returns p_eff [1/sr]. Its moments are those of the formula to 0.003; a value may be negative,
  /// because the moments of the rest end at degree L.
  /// @param depth  x >= 0, clamped to [1e-3, kDeepest].
  [[nodiscard]] double Effective(double cos_scattering, double depth) const {
    return At(effective_, cos_scattering, depth);
  }
  /// Returns B [1/sr], likewise; its moments are right to 0.002.
  [[nodiscard]] double Broadened(double cos_scattering, double depth) const {
    return At(broadened_, cos_scattering, depth);
  }

  static constexpr double kDeepest = 200.0;
  static constexpr std::size_t kDepths = 64;

  /// p_eff of one scattering angle, for many depths.
  class Angle {
   public:
    /// Returns what Effective() returns for the angle, within a millionth of its largest value.
    [[nodiscard]] double Effective(double depth) const;

   private:
    friend class ForwardPeak;
    std::array<float, kDepths> value_{};
  };
  [[nodiscard]] Angle AtAngle(double cos_scattering) const;

 private:
  ForwardPeak(const PeakMoments& moments, const PhaseFunction& phase, int degree);
  /// @param peak  the moments a_l.
  ForwardPeak(const PhaseFunction& phase, const PeakMoments& moments, double fraction,
              const std::vector<double>& peak);

  [[nodiscard]] static double At(const std::vector<float>& table, double cos_scattering,
                                 double depth);

  double fraction_;
  std::vector<float> effective_, broadened_;  // [angle][depth]
};

}  // namespace alpenglow::renderer
