// SPDX-License-Identifier: MIT
#include "viewer/ground/sky_by_pixel.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "atmosphere/math/constants.h"
#include "viewer/gl/render_target.h"
#include "viewer/land/land_pass.h"
#include "viewer/shaders/full_screen.h"

namespace alpenglow::viewer {
namespace {

constexpr auto kAzimuths = static_cast<GLsizei>(kHorizonAzimuths);
constexpr std::size_t kFour = 4;  // components of a texel
constexpr std::size_t kWeightLayers = kHorizonAzimuths / kFour;

void Clamp(GLenum target) {
  ClampAndFilter(target, true);
  glTexParameteri(target, GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
}

// Reorders the renderer's layout [level][azimuth][node][A, B][band] to rows of nodes.
void UploadIntegrals(const GlTexture& texture, const OccludedSkyIrradiance::Tables& tables) {
  constexpr std::size_t kNodes = OccludedSkyIrradiance::kNodes,
                        kRows = OccludedSkyIrradiance::kLevels * kHorizonAzimuths;
  std::vector<float> texels(tables.integral.size());
  for (std::size_t row = 0; row < kRows; ++row) {
    for (std::size_t node = 0; node < kNodes; ++node) {
      for (std::size_t part = 0; part < 2; ++part)
        std::copy_n(&tables.integral[((row * kNodes + node) * 2 + part) * kFour], kFour,
                    &texels[((row * 2 + part) * kNodes + node) * kFour]);
    }
  }
  glBindTexture(GL_TEXTURE_2D_ARRAY, texture.id());
  glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA16F, static_cast<GLsizei>(kNodes), 2 * kAzimuths,
               static_cast<GLsizei>(OccludedSkyIrradiance::kLevels), 0, GL_RGBA, GL_FLOAT,
               texels.data());
  Clamp(GL_TEXTURE_2D_ARRAY);
}

void UploadLevels(const GlTexture& texture, const OccludedSkyIrradiance::Tables& tables) {
  glBindTexture(GL_TEXTURE_2D, texture.id());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, static_cast<GLsizei>(OccludedSkyIrradiance::kSuns),
               static_cast<GLsizei>(OccludedSkyIrradiance::kLevels), 0, GL_RGBA, GL_FLOAT,
               tables.level_irradiance.data());
  ClampAndFilter(GL_TEXTURE_2D, true);
}

// Returns the largest light of a slope in each band. Half floats resolve values about ten thousand
// times smaller.
glm::vec4 UnitOf(const TerrainInterreflection& slopes) {
  glm::vec4 most(1e-30F);
  for (std::size_t i = 0; i < slopes.light().size(); ++i) {
    float& of_band = most[static_cast<glm::length_t>(i % kFour)];
    of_band = std::max(of_band, slopes.light()[i]);
  }
  return most;
}

// The layers of azimuths come first, followed by the layers of their weights.
void UploadSlopes(const GlTexture& texture, const TerrainInterreflection& slopes,
                  const glm::vec4& unit) {
  const SlopeViews& views = slopes.views();
  const std::size_t nodes = views.places().size();
  std::vector<float> texels(nodes * (kHorizonAzimuths + kWeightLayers) * kFour);
  for (std::size_t node = 0; node < nodes; ++node) {
    for (std::size_t azimuth = 0; azimuth < kHorizonAzimuths; ++azimuth) {
      for (std::size_t band = 0; band < kFour; ++band)
        texels[(azimuth * nodes + node) * kFour + band] =
            slopes.light()[(node * kHorizonAzimuths + azimuth) * kFour + band] /
            unit[static_cast<glm::length_t>(band)];
      texels[((kHorizonAzimuths + azimuth / kFour) * nodes + node) * kFour + azimuth % kFour] =
          views.Weight(node, azimuth);
    }
  }
  const HeightRaster& grid = views.heights();
  glBindTexture(GL_TEXTURE_2D_ARRAY, texture.id());
  glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA16F, grid.columns, grid.rows,
               static_cast<GLsizei>(kHorizonAzimuths + kWeightLayers), 0, GL_RGBA, GL_FLOAT,
               texels.data());
  Clamp(GL_TEXTURE_2D_ARRAY);
}

}  // namespace

void SkyByPixel::UploadHorizons(const TerrainHorizons& horizons) {
  const std::span<const std::uint16_t> packed = horizons.map().packed();
  const std::size_t nodes = packed.size() / kHorizonAzimuths;
  std::vector<std::uint16_t> texels(packed.size());
  for (std::size_t node = 0; node < nodes; ++node) {
    for (std::size_t layer = 0; layer < kHorizonAzimuths / kFour; ++layer)
      std::copy_n(&packed[node * kHorizonAzimuths + layer * kFour], kFour,
                  &texels[(layer * nodes + node) * kFour]);
  }
  const HeightRaster& grid = horizons.map().grid();
  glBindTexture(GL_TEXTURE_2D_ARRAY, horizon_texture_.id());
  glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA16, grid.columns, grid.rows, kAzimuths / 4, 0,
               GL_RGBA, GL_UNSIGNED_SHORT, texels.data());
  Clamp(GL_TEXTURE_2D_ARRAY);
}

void SkyByPixel::Use(LightSource source, const GroundFollower::SkyOfSource& sky) {
  std::optional<OfSource>& of = of_source_[IndexOf(source)];
  if (of && of->sky.sky == sky.sky) return;
  of = OfSource{sky, {}, {}, {}, {}};
  const TerrainIrradiance& light = *sky.sky->lighting().on_terrain;
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  if (const auto horizons = sky.sky->site().horizons(); horizons_ != horizons) {
    horizons_ = horizons;
    UploadHorizons(*horizons_);
  }
  UploadIntegrals(of->integrals, light.sky().tables());
  UploadLevels(of->level_irradiance, light.sky().tables());
  of->slope_unit = UnitOf(*light.slopes());
  UploadSlopes(of->slopes, *light.slopes(), of->slope_unit);
}

SkyByPixelBlock SkyByPixel::BlockOf(LightSource source, const LocalFrame& eye,
                                    const glm::dvec3& to_sun_for_air,
                                    const SkyIrradianceGradient& now) const {
  const OfSource& of = *of_source_[IndexOf(source)];
  const GroundSky& sky = *of.sky.sky;
  const LocalFrame& site = sky.site().ground().frame;
  const PlaceOnGrid horizon = PlaceOnGridOf(horizons_->map().grid(), site, eye);
  const PlaceOnGrid slope = PlaceOnGridOf(horizons_->views().heights(), site, eye);
  const std::array<float, 4> light_now = now.On(1.0, 0.0), light_then = of.sky.open.On(1.0, 0.0);
  SkyByPixelBlock block{horizon.u, horizon.v, slope.u, slope.v, {}, {}, of.slope_unit};
  for (glm::length_t band = 0; band < 4; ++band) {
    const auto i = static_cast<std::size_t>(band);
    block.sky_moment[band] = light_then[i] > 0.0F ? light_now[i] / light_then[i] : 0.0F;
  }
  const OccludedSkyIrradiance::Tables tables = sky.lighting().on_terrain->sky().tables();
  const double mu_s_now = site.EnuFromEcef(eye.EcefFromEnu(Vector<Enu>{to_sun_for_air})).xyz.z;
  const double moved = sky.lighting().to_sun_for_air.z - mu_s_now;
  block.sky_place = {
      -tables.lowest_m / kMetresPerKilometre,
      kMetresPerKilometre / (tables.highest_m - tables.lowest_m), moved - tables.first_mu_s,
      1.0 / (tables.mu_s_step * static_cast<double>(OccludedSkyIrradiance::kSuns - 1))};
  return block;
}

void SkyByPixel::Bind(const ShaderProgram& program, int first_unit, LightSource source) const {
  const OfSource& of = *of_source_[IndexOf(source)];
  struct Slot {
    const char* sampler;
    GLenum target;
    const GlTexture* texture;
  };
  int unit = first_unit;
  for (const Slot& slot : {Slot{"horizons_around", GL_TEXTURE_2D_ARRAY, &horizon_texture_},
                           Slot{"sky_integrals", GL_TEXTURE_2D_ARRAY, &of.integrals},
                           Slot{"level_irradiance", GL_TEXTURE_2D, &of.level_irradiance},
                           Slot{"light_of_slopes", GL_TEXTURE_2D_ARRAY, &of.slopes}}) {
    program.BindSampler(slot.sampler, unit);
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit++));
    glBindTexture(slot.target, slot.texture->id());
  }
}

std::vector<ShaderPiece> SkyByPixelTexts() {
  return {
      {"sky by pixel", fmt::format("#define SKY_LOWEST ({:.9f})\n#define SKY_NODES {}.0\n"
                                   "#define SKY_LEVELS {}.0\n#define SKY_SUNS {}.0\n",
                                   HorizonMap::kLowest, OccludedSkyIrradiance::kNodes,
                                   OccludedSkyIrradiance::kLevels, OccludedSkyIrradiance::kSuns)},
      ViewerPiece("viewer/shaders/sky_by_pixel.glsl")};
}

}  // namespace alpenglow::viewer
