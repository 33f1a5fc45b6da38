// SPDX-License-Identifier: MIT
#include "renderer/terrain/frame_transform.h"

#include <glm/geometric.hpp>

namespace alpenglow::renderer {

FrameTransform::FrameTransform(const LocalFrame& to, const LocalFrame& from)
    : origin_m_(to.EnuFromGeodetic(from.origin()).xyz) {
  for (glm::length_t axis = 0; axis < 3; ++axis) {
    glm::dvec3 unit(0.0);
    unit[axis] = 1.0;
    axes_[axis] = to.EnuFromEcef(from.EcefFromEnu(Vector<Enu>{unit})).xyz;
  }
}

double DistanceBetween(const LocalFrame& a, const LocalFrame& b) {
  return glm::length(a.EnuFromGeodetic(b.origin()).xyz);
}

}  // namespace alpenglow::renderer
