// SPDX-License-Identifier: MIT
// This header provides the adaptation of the eye to light over time.
//
// EyeAdaptation follows light that changes. The eye adapts to more light within seconds. It adapts
// to less light in two ways: at once, by pupil and nerves, to 4 EV below the adaptation of its
// pigments (Ferwerda et al. 1996, "A model of visual adaptation for realistic image synthesis":
// neural adaptation serves over a range of about a log unit and a half); beyond that as fast as
// rods regenerate, 0.24 log units (0.8 EV) a minute (Lamb and Pugh 2004, "Dark adaptation and the
// retinoid cycle of vision", Prog. Retin. Eye Res. 23, 307-380, component S2). Adaptation follows a
// dusk, which loses 0.5 EV a minute at most, without a lag, but lags behind the light of a total
// eclipse.
#pragma once

#include <optional>

#include "lut/layer.h"

namespace alpenglow::lut {

class EyeAdaptation {
 public:
  static constexpr double kAtOnce_ev = 4.0, kRegenerated_ev_per_min = 0.8;

  /// Returns the EV that the eye is adapted to. The first call returns the metered EV.
  /// @param metered_ev100  MeterEv100 of the scene in view.
  /// @param seconds  scene time since the last call, of either sign: a step backwards in time
  ///   counts as a step forwards.
  double Follow(double metered_ev100, double seconds);

 private:
  std::optional<double> pigment_ev100_;
};

}  // namespace alpenglow::lut
