// SPDX-License-Identifier: MIT
// The reference solution for airlight of a lamp: adaptive Gauss-Legendre quadrature in the distance
// along the ray, in extended precision, from the definition. It uses none of the substitutions,
// panels and columns of airlight.cpp.
#pragma once

#include <vector>

#include "atmosphere/lamp/airlight.h"

namespace alpenglow::atmosphere::reference {

struct LampLight {
  std::vector<double> radiance;  // for unit intensity [sr^-1 m^-2], one value per band
  double error = 0.0;            // estimate, relative
  bool converged = true;
};

/// Computes the same light as Airlight; the segment may be infinite in homogeneous air only. The
/// relative error is below 1e-9 by its own estimate; the stored cases agree to 1e-9.
[[nodiscard]] LampLight AirlightAlong(const LampAir& air, const Lamp& lamp,
                                      const LampSegment& segment);

}  // namespace alpenglow::atmosphere::reference
