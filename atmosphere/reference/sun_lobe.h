// SPDX-License-Identifier: MIT
// Directions around the sun in which clouds are bright, for paths.
//
// Droplets scatter most light forwards, so that few paths turn near the sun. With the density a(d) of
// the next direction d of a path, the phase function b of clouds around the sun, and the mean c of b
// and of a wide lobe around the sun, each vertex has
//
//   the path                                 weight f / (a + q c)
//   with probability q, a side path from c   weight f / (a + q c)
//   a side ray from b to the first cloud     weight f / (a + q c + b), of that cloud's sunlight
//
// where f(d) is the light scattered into the path, and path and side path take the share
// (a + q c) / (a + q c + b) of the sunlight of a cloud that they meet next (balance heuristic: Veach
// and Guibas 1995, SIGGRAPH, 419). Without side paths, light that droplets turn by a few degrees many
// times is in few paths with great weights.
#pragma once

#include "atmosphere/medium/phase.h"

namespace alpenglow::atmosphere::reference {

/// Probability q that a vertex among clouds has a side path.
inline constexpr double kSidePaths = 0.2;

/// Densities of directions by their angle from the sun [1/sr]. Refers to the phase function.
class SunLobe {
 public:
  /// @param cloud  a phase function of clouds.
  explicit SunLobe(const PhaseFunction& cloud) : cloud_(&cloud) {}

  /// Returns b. @param to_sun  cosine of the angle from the sun.
  [[nodiscard]] double Peak(double to_sun) const { return Phase(*cloud_, to_sun); }
  /// Returns c.
  [[nodiscard]] double Mean(double to_sun) const {
    return 0.5 * (Peak(to_sun) + Phase(kWide, to_sun));
  }
  /// Returns the density of side paths, q c.
  [[nodiscard]] double OfSidePaths(double to_sun) const { return kSidePaths * Mean(to_sun); }

  /// Returns cosines drawn from b and from c. @param u  uniform in [0, 1).
  [[nodiscard]] double DrawnFromPeak(double u) const { return SampleCosine(*cloud_, u); }
  [[nodiscard]] double DrawnFromMean(double u) const {
    return u < 0.5 ? SampleCosine(*cloud_, 2.0 * u) : SampleCosine(kWide, 2.0 * u - 1.0);
  }

 private:
  static inline const PhaseFunction kWide{.kind = PhaseKind::kHenyeyGreenstein, .g = 0.9};

  const PhaseFunction* cloud_;
};

}  // namespace alpenglow::atmosphere::reference
