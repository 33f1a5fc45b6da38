// SPDX-License-Identifier: MIT
// Passes over a whole picture or over boxes of it with one fragment stage, and embedded
// shader texts, named by their path in the tree: "viewer/shaders/hud/hud.frag.glsl".
//
// Uniform blocks shared by C++ and the shaders, in std140 layout. They consist of vectors of four,
// so that offsets are equal on both sides (asserted here and checked against the driver by a test).
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec4.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/medium/medium.h"
#include "renderer/surface/ground_pattern.h"
#include "renderer/surface/surface.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/shader.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// Returns a text that the library of its layer embeds, by its path in the tree:
/// "viewer/shaders/land/land.vert.glsl". Throws InternalError if there is none.
[[nodiscard]] ShaderPiece ViewerPiece(const std::string& name);

/// Returns the texts followed by those of these names.
[[nodiscard]] std::vector<ShaderPiece> WithViewerPieces(std::vector<ShaderPiece> texts,
                                                        const std::vector<std::string>& names);

/// Returns a program of view/full_screen.vert.glsl and a fragment stage of these texts.
[[nodiscard]] ShaderProgram FullScreenProgram(const std::vector<ShaderPiece>& fragment);

/// Draws over the whole viewport of the bound target.
void DrawFullScreen(const ShaderProgram& program, const GlVertexArray& no_vertices);

/// The pixels that a pass fills: all, or those of some boxes. Thousands of boxes take one draw
/// call.
class PassArea {
 public:
  /// Restricts the pass to boxes.
  /// @param width, height  of the viewport.
  void Set(std::span<const PixelBox> boxes, int width, int height);

  void Draw(const ShaderProgram& program) const;

 private:
  std::optional<int> boxes_;  // number of boxes; empty: all pixels
  GlBuffer squares_;
  GlVertexArray layout_, no_vertices_;
};

/// Number of bands: one component of a vec4 each. A medium may have fewer; the remaining ones are
/// 0.
inline constexpr std::size_t kGpuBands = 4;
inline constexpr MediumUse kForViewer{
    .most_wavelengths = kGpuBands, .shows_colours = true, .purpose = "skyview"};

/// Mirrors the uniform block `Air` of air/block.glsl. Lengths in km.
struct AirBlock {
  glm::vec4 rayleigh_scattering, mie_scattering, mie_extinction, ozone_absorption, ground_albedo;
  glm::vec4 red_from_bands, green_from_bands, blue_from_bands;
  glm::vec4 shell, ozone_layer, deficit, wavelengths;
};
static_assert(sizeof(AirBlock) == 12 * sizeof(glm::vec4));
static_assert(offsetof(AirBlock, ground_albedo) == 4 * sizeof(glm::vec4));
static_assert(offsetof(AirBlock, wavelengths) == 11 * sizeof(glm::vec4));

/// Mirrors the uniform block `View` of view/block.glsl.
struct ViewBlock {
  glm::vec4 view_right, view_up, view_forward;
  glm::vec4 sun, sun_for_air, sun_irradiance;
  glm::vec4 bend, bend_slopes, bend_falls;
  glm::vec4 eye;
  glm::vec4 other_sun, other_sun_for_air, other_sun_irradiance;
  glm::vec4 night_scattered, night_level;
};
static_assert(sizeof(ViewBlock) == 15 * sizeof(glm::vec4));
static_assert(offsetof(ViewBlock, eye) == 9 * sizeof(glm::vec4));
static_assert(offsetof(ViewBlock, night_level) == 14 * sizeof(glm::vec4));

/// Mirrors the uniform block `Ground` of ground/pattern.glsl.
struct GroundBlock {
  glm::vec4 conifers, leaves, yellow_leaves, bare_trees, meadow, dry_meadow, rock, snow;
  glm::vec4 cover_lines, green_lines;
  std::array<glm::ivec4, 4> noise_cell;
  std::array<glm::vec4, 4> noise_place;
  std::array<glm::ivec4, 14> wave_cell;
  std::array<glm::vec4, 14> wave_place;
  glm::vec4 pattern_east, pattern_north, pattern_up, pole;
};
static_assert(sizeof(GroundBlock) == 50 * sizeof(glm::vec4));
static_assert(offsetof(GroundBlock, wave_cell) == 18 * sizeof(glm::vec4));
static_assert(offsetof(GroundBlock, pole) == 49 * sizeof(glm::vec4));

/// Returns the block of a medium. Throws InputError if it has more than kGpuBands wavelengths, or
/// wavelengths with FaultOfColours.
[[nodiscard]] AirBlock AirBlockOf(const Medium& medium);

/// Returns the materials and the noise around the eye. The caller sets the axes of the pattern and
/// the number of omitted octaves.
/// @param eye  position in the pattern, and the time for its waves.
[[nodiscard]] GroundBlock GroundBlockOf(const MountainSurface& surface, const GroundPoint& eye);
/// Returns the block with the axes of the pattern.
/// @param pattern  in the frame of the eye.
[[nodiscard]] GroundBlock WithAxesOf(const GroundPattern& pattern, GroundBlock block);

/// Return one value per band and 0 for the remaining components.
[[nodiscard]] glm::vec4 GpuBandsOf(const std::vector<double>& per_band);
[[nodiscard]] glm::vec4 GpuBandsOf(const Spectrum& light);

}  // namespace alpenglow::viewer
