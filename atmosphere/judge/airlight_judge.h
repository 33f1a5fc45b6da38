// SPDX-License-Identifier: MIT
// The judge of airlight: adaptive Gauss-Legendre quadrature in the plain distance along the ray, in
// extended precision, from the definition. Nothing here uses the substitutions, the panels or the
// columns of airlight.cpp.
#pragma once

#include <vector>

#include "atmosphere/lamp/airlight.h"

namespace alpenglow::atmosphere::judge {

struct LampLight {
  std::vector<double> radiance;  // for unit intensity [sr^-1 m^-2], a value a band
  double error = 0.0;            // estimate, relative
  bool converged = true;
};

/// As Airlight; the segment may be infinite in homogeneous air only. Relative error below 1e-9 by
/// its own estimate; the stored cases agree to 1e-9.
[[nodiscard]] LampLight AirlightAlong(const LampAir& air, const Lamp& lamp,
                                      const LampSegment& segment);

}  // namespace alpenglow::atmosphere::judge
