// SPDX-License-Identifier: MIT
// What the air that a lamp lights brings to surfaces (renderer/lamp/lamp_glow.h), ready for
// interpolation by a graphics card: six terms over distance and rise of the lamp.
//
//   E(n) = exp(term 0) / d * LampGlowOnSlope(n, terms 1 to 5)             [m^-2], by band
//
// Term 0 is the logarithm of what level ground gets times the distance. The others, of
// atmosphere/lamp/lamp_ray.glsl, are fitted by least squares to slopes of up to 60 degrees, gentle
// ones before steep ones (the fourth power of the cosine).
#pragma once

#include <glm/vec4.hpp>
#include <vector>

#include "renderer/lamp/lamp_glow.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// Places of distances and rises are those of lamp_ray.glsl, each step of LampGlow in four.
inline constexpr int kGlowDistances = 61;
inline constexpr int kGlowRises = 33;
inline constexpr double kNearestGlow_m = 0.2;
inline constexpr double kFarthestGlow_m = 2e4;
inline constexpr int kGlowTerms = 6;

/// [(term * kGlowRises + rise) * kGlowDistances + distance]; bands that there are not have level
/// ground dark and slopes alike. At most four bands.
[[nodiscard]] std::vector<glm::vec4> SampledGlow(const LampGlow& glow);

}  // namespace alpenglow::viewer
