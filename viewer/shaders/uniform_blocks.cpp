// SPDX-License-Identifier: MIT
#include "viewer/shaders/uniform_blocks.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/common.hpp>

#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "renderer/material/land_cover.h"

namespace alpenglow::viewer {
namespace {

float Kilometres(double metres) { return static_cast<float>(metres / kMetresPerKilometre); }

glm::vec4 PerKilometre(const std::vector<double>& per_m) {
  std::vector<double> per_km(per_m);
  for (double& value : per_km) value *= kMetresPerKilometre;
  return GpuBandsOf(per_km);
}

// Sets the octaves of all families in sequence, with the eye's position in each.
void SetOctaves(GroundBlock& block, const GroundPoint& eye) {
  std::size_t i = 0;
  for (std::size_t family = 0; family < kGroundNoises; ++family) {
    for (const NoiseOctave& octave : OctavesOf(static_cast<GroundNoise>(family))) {
      const glm::dvec2 at = octave.PlaceOf(eye), cell = glm::floor(at), place = at - cell;
      block.octave_cell.at(i) = {glm::ivec2(cell), 0, 0};
      block.octave_place.at(i++) = {place.x, place.y, octave.lean_east, octave.lean_north};
    }
  }
}

}  // namespace

glm::vec4 GpuBandsOf(const std::vector<double>& per_band) {
  ALPENGLOW_ENSURE(per_band.size(), <=, kGpuBands);
  std::array<float, kGpuBands> value{};
  for (std::size_t band = 0; band < per_band.size(); ++band) {
    value[band] = static_cast<float>(per_band[band]);
  }
  return {value[0], value[1], value[2], value[3]};
}

glm::vec4 GpuBandsOf(const BandLight& light) {
  ALPENGLOW_ENSURE(light.count, <=, kGpuBands);
  std::array<float, kGpuBands> value{};
  std::copy_n(light.value.begin(), light.count, value.begin());
  return {value[0], value[1], value[2], value[3]};
}

AirBlock AirBlockOf(const Medium& medium) {
  if (medium.wavelengths_nm.size() > kGpuBands) {
    throw InputError(fmt::format("spectrum: {} wavelengths; the viewer draws with at most {}",
                                 medium.wavelengths_nm.size(), kGpuBands));
  }
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

}  // namespace alpenglow::viewer
