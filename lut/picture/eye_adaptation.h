// SPDX-License-Identifier: MIT
// How an eye follows light that changes. To more light it adapts within seconds. To less light it
// adapts in two ways: at once, by pupil and nerves, to 4 EV less than what its pigments are used to
// (Ferwerda et al. 1996, "A model of visual adaptation for realistic image synthesis": neural
// adaptation serves over a range of about a log unit and a half); beyond that as fast as rods
// regenerate, 0.24 log units (0.8 EV) a minute (Lamb and Pugh 2004, "Dark adaptation and the retinoid
// cycle of vision", Prog. Retin. Eye Res. 23, 307-380, component S2). A dusk, which loses 0.5 EV a
// minute at most, is followed without a lag; the light of a total eclipse is not.
#pragma once

#include <optional>

namespace alpenglow::lut {

class EyeAdaptation {
 public:
  static constexpr double kAtOnce_ev = 4.0, kRegenerated_ev_per_min = 0.8;

  /// The EV that the eye is adapted to. At first that is the metered one.
  /// @param metered_ev100  MeterEv100 of what is seen. @param seconds  since the last call, of the
  /// time of the scene; of either sign: light of a moment before is as new as that of one after.
  double Follow(double metered_ev100, double seconds);

 private:
  std::optional<double> pigment_ev100_;
};

}  // namespace alpenglow::lut
