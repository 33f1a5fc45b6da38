// SPDX-License-Identifier: MIT
#include "viewer/shaders/pass_setup.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/vec4.hpp>
#include <string_view>

#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "lut/embedded_text.h"
#include "renderer/embedded_text.h"
#include "renderer/material/land_cover.h"
#include "viewer/embedded_text.h"

namespace alpenglow::viewer {

ShaderPiece ViewerPiece(const std::string& name) {
  if (name.starts_with("lut/")) return {name, std::string(lut::EmbeddedText(name))};
  if (name.starts_with("renderer/")) return {name, std::string(renderer::EmbeddedText(name))};
  return {name, std::string(viewer::EmbeddedText(name))};
}

std::vector<ShaderPiece> WithViewerPieces(std::vector<ShaderPiece> texts,
                                          const std::vector<std::string>& names) {
  for (const std::string& name : names) texts.push_back(ViewerPiece(name));
  return texts;
}

namespace {

constexpr GLuint kSquare = 0;

float Kilometres(double metres) { return static_cast<float>(metres / kMetresPerKilometre); }

glm::vec4 PerKilometre(const std::vector<double>& per_m) {
  std::vector<double> per_km(per_m);
  for (double& value : per_km) value *= kMetresPerKilometre;
  return GpuBandsOf(per_km);
}

// A position in an octave: the cell, and the fraction of it.
struct PlaceInOctave {
  glm::ivec4 cell;
  glm::vec4 fraction;
};

PlaceInOctave PlaceIn(const NoiseOctave& octave, const GroundPoint& point) {
  const glm::dvec2 at = octave.PlaceOf(point), cell = glm::floor(at), fraction = at - cell;
  return {{glm::ivec2(cell), 0, 0}, {fraction.x, fraction.y, 0.0, 0.0}};
}

// Sets the eye's position in the longest octave of each family that leans, and in all waves.
void SetOctaves(GroundBlock& block, const GroundPoint& eye) {
  GroundPoint foot = eye;
  foot.up_m = 0.0;
  for (std::size_t family = 0; family < block.noise_cell.size(); ++family) {
    const NoiseOctave& longest = OctavesOf(static_cast<GroundNoise>(family)).front();
    const PlaceInOctave at = PlaceIn(longest, foot);
    block.noise_cell[family] = at.cell;
    block.noise_place[family] = at.fraction;
    block.noise_place[family].z = static_cast<float>(eye.up_m / longest.wavelength_m);
  }
  const std::span<const NoiseOctave> waves = OctavesOf(GroundNoise::kWaves);
  for (std::size_t i = 0; i < block.wave_cell.size(); ++i) {
    const PlaceInOctave at = PlaceIn(waves[i], eye);
    block.wave_cell[i] = at.cell;
    block.wave_place[i] = at.fraction;
  }
}

}  // namespace

ShaderProgram FullScreenProgram(const std::vector<ShaderPiece>& fragment) {
  return ShaderProgram({ViewerPiece("viewer/shaders/view/full_screen.vert.glsl")}, fragment,
                       {{kSquare, "square"}});
}

// The attribute has no array, so its value is that of glVertexAttrib.
void DrawFullScreen(const ShaderProgram& program, const GlVertexArray& no_vertices) {
  program.Use();
  glBindVertexArray(no_vertices.id());
  glVertexAttrib4f(kSquare, 0.0F, 0.0F, 0.0F, 0.0F);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void PassArea::Set(std::span<const PixelBox> boxes, int width, int height) {
  boxes_ = static_cast<int>(boxes.size());
  std::vector<glm::vec4> squares;
  squares.reserve(boxes.size());
  const auto place = [](int pixel, int side) {
    return 2.0F * static_cast<float>(pixel) / static_cast<float>(side) - 1.0F;
  };
  for (const PixelBox& box : boxes)
    squares.emplace_back(place(box.x, width), place(box.y, height), place(box.x + box.width, width),
                         place(box.y + box.height, height));
  glBindVertexArray(layout_.id());
  glBindBuffer(GL_ARRAY_BUFFER, squares_.id());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(sizeof(glm::vec4) * squares.size()),
               squares.data(), GL_DYNAMIC_DRAW);
  glEnableVertexAttribArray(kSquare);
  glVertexAttribPointer(kSquare, 4, GL_FLOAT, GL_FALSE, sizeof(glm::vec4), nullptr);
  glVertexAttribDivisor(kSquare, 1);
}

void PassArea::Draw(const ShaderProgram& program) const {
  if (!boxes_) return DrawFullScreen(program, no_vertices_);
  if (boxes_ == 0) return;
  program.Use();
  glBindVertexArray(layout_.id());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, *boxes_);
}

glm::vec4 GpuBandsOf(const std::vector<double>& per_band) {
  ALPENGLOW_ENSURE(per_band.size(), <=, kGpuBands);
  std::array<float, kGpuBands> value{};
  for (std::size_t band = 0; band < per_band.size(); ++band) {
    value[band] = static_cast<float>(per_band[band]);
  }
  return {value[0], value[1], value[2], value[3]};
}

glm::vec4 GpuBandsOf(const Spectrum& light) {
  ALPENGLOW_ENSURE(light.size(), <=, kGpuBands);
  std::array<float, kGpuBands> value{};
  std::ranges::copy(light.values(), value.begin());
  return {value[0], value[1], value[2], value[3]};
}

AirBlock AirBlockOf(const Medium& medium) {
  if (const auto fault = FaultOfWavelengths(medium.wavelengths_nm, kForViewer))
    throw InputError(fault->text);
  const BandColour colour(medium.wavelengths_nm);
  const auto row = [&](std::size_t channel) {
    const auto all = colour.linear_srgb_from_bands();
    const std::size_t bands = medium.wavelengths_nm.size();
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(channel * bands);
    return GpuBandsOf({first, first + static_cast<std::ptrdiff_t>(bands)});
  };
  AirBlock block{};
  block.rayleigh_scattering = PerKilometre(medium.rayleigh_scattering_per_m);
  block.mie_scattering = PerKilometre(medium.mie_scattering_per_m);
  block.mie_extinction = PerKilometre(medium.mie_extinction_per_m);
  block.ozone_absorption = PerKilometre(medium.ozone_absorption_per_m);
  block.ground_albedo = GpuBandsOf(medium.ground_albedo);
  block.red_from_bands = row(0);
  block.green_from_bands = row(1);
  block.blue_from_bands = row(2);
  block.shell = {Kilometres(medium.planet_radius_m), Kilometres(medium.atmosphere_height_m),
                 Kilometres(medium.rayleigh_scale_height_m), Kilometres(medium.mie_scale_height_m)};
  block.ozone_layer = {Kilometres(medium.ozone.bottom_m), Kilometres(medium.ozone.peak_m),
                       Kilometres(medium.ozone.top_m),
                       medium.ozone.shape == OzoneShape::kSmooth ? 1.0F : 0.0F};
  block.deficit = {static_cast<float>(medium.rayleigh_deficit.share),
                   Kilometres(medium.rayleigh_deficit.scale_height_m), 0.0F, 0.0F};
  constexpr float kMicrometresPerNanometre = 1e-3F;
  block.wavelengths = kMicrometresPerNanometre * GpuBandsOf(medium.wavelengths_nm);
  return block;
}

GroundBlock GroundBlockOf(const MountainSurface& surface, const GroundPoint& eye) {
  const MountainSurface::Materials& materials = surface.materials();
  const MountainCover& cover = surface.cover();
  GroundBlock block{};
  block.conifers = GpuBandsOf(materials.conifers);
  block.leaves = GpuBandsOf(materials.leaves);
  block.yellow_leaves = GpuBandsOf(materials.yellow_leaves);
  block.bare_trees = GpuBandsOf(materials.bare_trees);
  block.meadow = GpuBandsOf(materials.meadow);
  block.dry_meadow = GpuBandsOf(materials.dry_meadow);
  block.rock = GpuBandsOf(materials.rock);
  block.snow = GpuBandsOf(materials.snow);
  block.cover_lines = {cover.tree_line_m, cover.snow_line_m, 0.0, cover.sun_in_south};
  block.green_lines = {cover.leaf_line_m, cover.bare_line_m, cover.grass_line_m,
                       cover.broadleaf_line_m};
  SetOctaves(block, eye);
  return block;
}

GroundBlock WithAxesOf(const GroundPattern& pattern, GroundBlock block) {
  const auto axis = [&](const glm::dvec3& of_pattern) {
    return glm::vec4(pattern.FromPattern(of_pattern), 0.0);
  };
  block.pattern_east = axis({1.0, 0.0, 0.0});
  block.pattern_north = axis({0.0, 1.0, 0.0});
  block.pattern_up = axis({0.0, 0.0, 1.0});
  block.pole = glm::vec4(pattern.pole(), 0.0);
  return block;
}

}  // namespace alpenglow::viewer
