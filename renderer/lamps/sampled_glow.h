// SPDX-License-Identifier: MIT
// Provides SampledGlow: the light that the illuminated air around a lamp brings to surfaces, for
// interpolation by the GPU.
//
// SampledGlow tabulates LampAirlightIrradiance (renderer/lamps/lamp_tree.h) with six terms over
// distance and rise of the lamp.
//
//   E(n) = exp(term 0) / d * LampAirlightOnSlope(n, terms 1 to 5)             [m^-2], by band
//
// Term 0 is the logarithm of the light on level ground times the distance. The other terms, defined
// in atmosphere/lamp/lamp_ray.glsl, are fitted by least squares to slopes of up to 60 degrees.
// Gentle slopes have larger weights than steep ones (the fourth power of the cosine).
#pragma once

#include <glm/vec4.hpp>
#include <vector>

#include "renderer/lamps/lamp_tree.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Size of the table. Distances and rises are spaced as in lamp_ray.glsl; each step of
/// LampAirlightIrradiance is divided into four.
inline constexpr int kGlowDistances = 81;
inline constexpr int kGlowRises = 33;
inline constexpr int kGlowTerms = 6;

/// Returns [(term * kGlowRises + rise) * kGlowDistances + distance]. Unused bands have no light on
/// level ground and equal light on all slopes. At most four bands.
[[nodiscard]] std::vector<glm::vec4> SampledGlow(const LampAirlightIrradiance& glow);

}  // namespace alpenglow::renderer
