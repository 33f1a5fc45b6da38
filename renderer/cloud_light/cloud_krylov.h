// SPDX-License-Identifier: MIT
// The solution of M = K M + b for moments of light in clouds by generalised minimal residuals (Saad
// and Schultz 1986, SIAM J. Sci. Stat. Comput. 7, 856) from a start vector.
//
// The caller applies K, one sweep over all tracks. The sums of scalar products are taken in blocks
// of a fixed size, so that results do not depend on the number of threads.
#pragma once

#include <functional>
#include <vector>

#include "renderer/cloud_light/cloud_optics.h"

namespace alpenglow::renderer {

struct KrylovSolution {
  std::vector<CloudHarmonics> moments;
  int applications;  // of K
  double residual;   // |b + K M - M| / |b|; 0 if b is 0
};

/// Returns M with a residual below `tolerance`, or the best one after `most` applications of K.
/// @param apply  returns K times its argument.
[[nodiscard]] KrylovSolution SolveByKrylov(
    const std::vector<CloudHarmonics>& right_side, std::vector<CloudHarmonics> start,
    double tolerance, int most,
    const std::function<std::vector<CloudHarmonics>(const std::vector<CloudHarmonics>&)>& apply);

}  // namespace alpenglow::renderer
