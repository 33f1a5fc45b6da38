// SPDX-License-Identifier: MIT
// What ground_light.glsl reads of C++, byte for byte, as uniform_blocks.h does it.
#pragma once

#include <cstddef>
#include <glm/vec4.hpp>

#include "viewer/ground/lit_ground.h"

namespace alpenglow {

/// `block GroundLight` of ground_light.glsl.
struct GroundLightBlock {
  glm::vec4 sky_level, sky_up, sky_sunward;
  glm::vec4 ground_view;
};
static_assert(sizeof(GroundLightBlock) == 4 * sizeof(glm::vec4));
static_assert(offsetof(GroundLightBlock, ground_view) == 3 * sizeof(glm::vec4));

/// @param pixel_angle_rad  between neighbouring pixels; larger: coarser detail.
[[nodiscard]] GroundLightBlock GroundLightBlockOf(const LitGround& ground, double pixel_angle_rad);

}  // namespace alpenglow
