// SPDX-License-Identifier: MIT
// A body that glows (a fire, hot gas) as a lamp that lights other bodies.
#pragma once

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/lamp/lamp.h"
#include "renderer/media/local_body.h"

namespace alpenglow::renderer {

/// A lamp that sends the same light in all directions.
struct BodyGlow {
  Lamp lamp;  // in the frame of SceneGround; its radius is that of a ball of the body's box
  Spectrum intensity;  // W sr^-1 nm^-1; 0 if the body does not glow
};

/// Returns the emission of a body that leaves it: the integral of the emission times the mean
/// transmittance of the body over six directions, absorption alone, on 16 points along each side. For a
/// ball of optical depth 1 the light is within 3 % of the exact one
/// (tests/renderer/media/body_glow_test.cpp).
[[nodiscard]] BodyGlow GlowOf(const LocalBody& body);

}  // namespace alpenglow::renderer
