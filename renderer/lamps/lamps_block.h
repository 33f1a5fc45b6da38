// SPDX-License-Identifier: MIT
// Packs lamps for lamps/light.glsl into a uniform block of vec4 alone, with phase functions as
// parameters of shader expressions.
//
// Altitudes are relative to the lowest of eye and lamps. Single precision is then sufficient for
// a layer with a scale height of metres under an eye kilometres above it. Densities are relative to
// those at the base of each layer.
#pragma once

#include <array>
#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/medium/medium.h"
#include "atmosphere/medium/phase.h"
#include "atmosphere/time_place/geodesy.h"
#include "renderer/lamps/placed_lamp.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Returns the vector `p` of PhaseForm::expression.
[[nodiscard]] glm::vec4 ParametersOf(const PhaseFunction& phase);

/// Maximum number of lamps in the block. They fit into the smallest uniform block that every OpenGL
/// supports, and are few enough for a loop in a shader.
inline constexpr std::size_t kMostGpuLamps = 64;

/// Mirrors `struct Lamp` of lamps/light.glsl.
struct GpuLamp {
  glm::vec4 position, intensity, axis, side, profile, up, at_eye, at_lamp, glow, shade;
};

/// Mirrors the uniform block `Lamps` of lamps/light.glsl.
struct LampsBlock {
  glm::vec4 count, planet, falls, bases, molecules, aerosol, dimming, layer, mie_phase, layer_phase;
  glm::vec4 red, green, blue;
  std::array<glm::vec4, 3> ground;
  std::array<GpuLamp, kMostGpuLamps> lamps;
};
static_assert(sizeof(LampsBlock) == (16 + 10 * kMostGpuLamps) * sizeof(glm::vec4));
static_assert(sizeof(LampsBlock) <= 16384);  // the minimum of GL_MAX_UNIFORM_BLOCK_SIZE

/// The part of a view that the choice of lamps depends on.
struct LampView {
  FrameTransform from_eye;  // from east, north, up at the eye to the frame of SceneGround
  double altitude_m = 0.0;  // of the eye above the sphere
  double pixel_angle_rad = 1e-3;
};

/// Returns the view of an eye at any place; `ground` is the frame of SceneGround.
[[nodiscard]] LampView LampViewFrom(const LocalFrame& ground, const Place& eye,
                                    double pixel_angle_rad);

/// A lamp of the block and the indices of its tables.
struct ChosenLamp {
  const PlacedLamp* placed;  // lamp as placed for the eye of the view
  int table = 0;             // layer of its measured profile
  int glow = 0;              // layer of the light that its air brings to surfaces
  int shade = -1;            // layer of the terrain around it; -1: none
  int first_plan = 0;        // first layer of the lit ground around it in the texture of plans
  int plan_levels = 0;       // number of these layers; 0: no plan
};

/// @param layers  layers of LampStage: molecules, aerosol and at most one layer of the scene.
/// @param core_rad  angles from a lamp at which its separately drawn core fades and ends; 0, 0 for
///     no core. Lamps that shine evenly come first in the block.
[[nodiscard]] LampsBlock LampsBlockOf(std::vector<ChosenLamp> lamps,
                                      const std::vector<LampLayer>& layers, const Medium& medium,
                                      const BandColour& colour, const LampView& view,
                                      std::array<double, 2> core_rad);

}  // namespace alpenglow::renderer
