// SPDX-License-Identifier: MIT
// Rays for the flux of sunlight that leaves a field of clouds through its top and its base.
//
// Rays begin at evenly spread points of a plane, in random directions: downwards from the top by the
// law of cosines; upwards from the base by half of it and half of the phase function p around the sun,
// where light is bright. With the density q = cos / (2 pi) + p / 2, a ray from the base counts
// L cos / q.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "renderer/cloud_light/cloud_tracking.h"
#include "renderer/clouds/cloud_field.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// A ray into a field against the light that leaves it.
struct CloudPlaneRay {
  CloudRay ray;
  double weight;  // flux per radiance [sr]; 0 for a ray that does not enter the field
};

/// Draws rays by Halton's sequences. Refers to the phase function.
class CloudPlaneRays {
 public:
  /// @param low  corner of a rectangle on the ground. @param size  of it [m]. @param to_sun  unit vector.
  CloudPlaneRays(const CloudField& field, const glm::dvec2& low, const glm::dvec2& size,
                 const glm::dvec3& to_sun, const PhaseFunction& phase)
      : bounds_(field.Bounds()), low_(low), size_(size), to_sun_(to_sun), phase_(&phase) {}

  /// Returns ray `i` of a plane, i >= 1.
  [[nodiscard]] CloudPlaneRay FromTop(int i) const;
  [[nodiscard]] CloudPlaneRay FromBase(int i) const;

 private:
  [[nodiscard]] glm::dvec2 Place(int i) const;

  CloudBox bounds_;
  glm::dvec2 low_, size_;
  glm::dvec3 to_sun_;
  const PhaseFunction* phase_;
};

}  // namespace alpenglow::renderer
