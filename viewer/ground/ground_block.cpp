// SPDX-License-Identifier: MIT
#include "viewer/ground/ground_block.h"

namespace alpenglow {
namespace {

glm::vec4 FourOf(const BandLight& light) {
  glm::vec4 four(0.0F);
  for (std::size_t band = 0; band < light.count; ++band)
    four[static_cast<glm::length_t>(band)] = light[band];
  return four;
}

}  // namespace

GroundLightBlock GroundLightBlockOf(const LitGround& ground, double pixel_angle_rad) {
  const SkyTilt& tilt = ground.tilt();
  return {
      FourOf(tilt.level), FourOf(tilt.up), FourOf(tilt.sunward), {pixel_angle_rad, 0.0, 0.0, 0.0}};
}

}  // namespace alpenglow
