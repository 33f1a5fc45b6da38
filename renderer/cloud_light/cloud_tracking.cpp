// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_tracking.h"

namespace alpenglow::renderer {

double CloudTracker::OpticalDepth(const CloudRay& ray, double farthest_m, double step_m) const {
  constexpr double kNode = 0.21132486540518712;  // (1 - 1 / sqrt 3) / 2
  double depth = 0.0;
  EachSpan(ray, farthest_m, [&](double begin_m, double end_m, double) {
    const double steps = std::ceil((end_m - begin_m) / step_m);
    const double length_m = (end_m - begin_m) / steps;
    for (double i = 0.0; i < steps; ++i) {
      depth += 0.5 * length_m *
               (Extinction_per_m(ray.At(begin_m + (i + kNode) * length_m)) +
                Extinction_per_m(ray.At(begin_m + (i + 1.0 - kNode) * length_m)));
    }
    return true;
  });
  return depth;
}

}  // namespace alpenglow::renderer
