// SPDX-License-Identifier: MIT
// Lamps as lamp_light.glsl reads them: a uniform block of vec4 alone.
//
// Altitudes count from that of the lowest of eye and lamps, so that float holds fog of metres' scale
// height under an eye kilometres above it. Densities are relative to those at each layer's base.
#pragma once

#include <array>
#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/vec4.hpp>

#include "atmosphere/air/medium.h"
#include "atmosphere/sun/geodesy.h"
#include "renderer/lamp/placed_lamp.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// As many as the smallest uniform block that every OpenGL has room for can hold, and a loop in a
/// shader should.
inline constexpr std::size_t kMostGpuLamps = 64;

/// `struct Lamp` of lamp_light.glsl.
struct GpuLamp {
  glm::vec4 position, intensity, axis, side, profile, up, at_eye, at_lamp, glow, shade;
};

/// `block Lamps` of lamp_light.glsl.
struct LampsBlock {
  glm::vec4 count, planet, falls, bases, molecules, aerosol, dimming, fog, mie_phase, fog_phase;
  glm::vec4 red, green, blue;
  std::array<glm::vec4, 3> ground;
  std::array<GpuLamp, kMostGpuLamps> lamps;
};
static_assert(sizeof(LampsBlock) == (16 + 10 * kMostGpuLamps) * sizeof(glm::vec4));
static_assert(sizeof(LampsBlock) <= 16384);  // GL_MAX_UNIFORM_BLOCK_SIZE is at least that

/// From where lamps are seen, and how finely.
struct LampView {
  glm::dvec3 eye_m{0.0};  // in the frame of SceneGround
  glm::dmat3 eye_from_ground{
      1.0};                 // turns directions of that frame into east, north, up at the eye
  double altitude_m = 0.0;  // of the eye over the sphere
  double pixel_angle_rad = 1e-3;
};

/// Of an eye anywhere; `ground` is the frame of SceneGround.
[[nodiscard]] LampView LampViewFrom(const LocalFrame& ground, const GeodeticPosition& eye,
                                    double pixel_angle_rad);

/// Layers of the texture of plans that are of a lamp; levels 0: none.
struct PlanLayers {
  int first = 0, levels = 0;
};

/// A lamp of the block, and what its picture needs beside it.
struct ChosenLamp {
  const PlacedLamp* placed;  // before the eye of the view
  int table = 0;             // layer of its measured profile
  int glow = 0;              // of what its air brings to surfaces
  int shade = -1;            // of the terrain around it; -1: none
  PlanLayers plan{};         // of where it lights the ground
};

/// @param layers  of LampStage: molecules, aerosol and perhaps fog.
/// @param core_rad  angles from a lamp at which what is drawn of it by itself fades and ends; 0, 0:
///     nothing is. Lamps that shine evenly come first in the block.
[[nodiscard]] LampsBlock LampsBlockOf(std::vector<ChosenLamp> lamps,
                                      const std::vector<LampLayer>& layers, const Medium& medium,
                                      const LampView& view, std::array<double, 2> core_rad);

}  // namespace alpenglow::viewer
