// SPDX-License-Identifier: MIT
// The colours of sunlight that a field of clouds scatters once (cloud_phase/phase_colours.h).
//
// The sunlight along a ray is solved for one grey phase function. In band b it is
//
//   sun_b = sun (1 + sum_k B_k (p_eff,b - p_eff)(nu, x_k) / sun_fast)
//
// where sun_fast is that of the fast method, and B_k its light of first order by hat in the optical
// depth x of the forward peak. The other methods have the same colours, so that their noise has none.
// Light of higher orders, and of sky and ground, is the same in all bands.
#pragma once

#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "renderer/cloud_light/cloud_light.h"
#include "renderer/cloud_phase/cloud_phase.h"
#include "renderer/cloud_phase/phase_colours.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Immutable; safe to use from many threads.
class CloudColours {
 public:
  /// @param light  of a field. @param bands  phase functions of its droplets or crystals by wavelength.
  CloudColours(const CloudLight& light, const std::vector<CloudPhases>& bands);

  /// Returns the sunlight along a ray by band, relative to the grey one; >= 0.
  /// @param sun  of the fast method. @param once  its light of first order.
  [[nodiscard]] Spectrum Of(double sun, const OnceScattered& once) const;

 private:
  PhaseColours colours_;
};

}  // namespace alpenglow::renderer
