// SPDX-License-Identifier: MIT
#include "viewer/ground/ground_block.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "viewer/gl/render_target.h"
#include "viewer/shaders/uniform_blocks.h"
#include "viewer/shaders/viewer_texts.h"

namespace alpenglow::viewer {
namespace {

// Lower than any ground.
constexpr double kNoSea_m = -1e9;

// What the shader's cover has at a step of the root of a cosine.
double ByRootOfMu(const GroundMaterial& material, std::size_t node) {
  if (material.cover().kind != GroundCover::Kind::kBlinnPhong) return Snow::BalanceNodes()[node];
  const double root = static_cast<double>(node) / (Snow::kBalanceNodes - 1);
  const double mu = std::max(root * root, 1e-4);
  return material.glossy()
      .Mirrored({0.0, 0.0, 1.0}, {std::sqrt(1.0 - mu * mu), 0.0, mu})
      .TotalWeight();
}

void Upload(const GlTexture& texture, std::size_t columns, std::size_t rows,
            const std::vector<BandTexel>& texels) {
  glBindTexture(GL_TEXTURE_2D, texture.id());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, static_cast<GLsizei>(columns),
               static_cast<GLsizei>(rows), 0, GL_RGBA, GL_FLOAT, texels.data());
  ClampAndFilter(GL_TEXTURE_2D, true);
}

}  // namespace

GroundLightBlock GroundLightBlockOf(const SkyTilt& tilt, const glm::dvec3& to_sun,
                                    double pixel_angle_rad) {
  const double flat = std::max(std::hypot(to_sun.x, to_sun.y), 1e-9);
  GroundLightBlock block{
      {to_sun.x / flat, to_sun.y / flat, 0.0, 0.0}, {pixel_angle_rad, 1.0, 0.0, 0.0}, {}};
  for (std::size_t i = 0; i < tilt.nodes.size(); ++i)
    block.open_sky[i] = {tilt.nodes[i][0], tilt.nodes[i][1], tilt.nodes[i][2], tilt.nodes[i][3]};
  return block;
}

GroundSurfaceBlock GroundSurfaceBlockOf(const GroundMaterial& material) {
  const RoughDiffuse& rough = material.rough();
  const Glossy& glossy = material.glossy();
  const BandsOfColour& colours = material.bands_of_colour();
  GroundSurfaceBlock block{};
  block.cover_albedo = GpuBandsOf(material.albedo());
  block.rough = {rough.roughness(), rough.scale(), rough.mean_single(), 0.0};
  block.coat = {glossy.exponent(), glossy.f0(), glossy.normalisation(), 0.0};
  block.water = {material.water().slope_variance(), material.WaterLine_m().value_or(kNoSea_m),
                 material.cover().wetness, 0.0};
  block.under_water = GpuBandsOf(material.water().under_surface());
  block.snow_y = GpuBandsOf(material.snow().y());
  block.drape_red = GpuBandsOf(colours.OfPrimary(0));
  block.drape_green = GpuBandsOf(colours.OfPrimary(1));
  block.drape_blue = GpuBandsOf(colours.OfPrimary(2));
  for (std::size_t node = 0; node < Snow::kBalanceNodes; ++node) {
    block.by_root_mu[node / 4][static_cast<glm::length_t>(node % 4)] =
        static_cast<float>(ByRootOfMu(material, node));
  }
  return block;
}

GroundSurfaceBlock Draped(GroundSurfaceBlock block, const FlatRectangle& picture, double eye_x_m,
                          double eye_y_m) {
  block.drape_place = {picture.west_m, picture.south_m, 1.0 / picture.width_m,
                       1.0 / picture.depth_m};
  block.drape_eye = {eye_x_m, eye_y_m, 0.0, 0.0};
  return block;
}

std::vector<ShaderPiece> GroundTexts(const GroundMaterial& material, const LandKind& land) {
  const auto water_line_m = material.WaterLine_m();
  const bool planet_is_water =
      (water_line_m && *water_line_m >= 0.0) || material.cover().kind == GroundCover::Kind::kWater;
  return {{"ground constants",
           fmt::format("#define GROUND_COVER {}\n#define HAS_SEA {}\n#define HAS_DRAPE {}\n#define "
                       "HAS_LAND_COVER {}\n"
                       "#define PLANET_IS_WATER {}\n#define PLANET_IS_LAND {}\n"
                       "#define HAS_FINE_RELIEF {}\n"
                       "#define LEVEL_SKY_LOWEST {:.9f}\n"
                       "#define LEVEL_SKY_RANGE {:.9f}\n#define LEVEL_SKY_NODES {}.0\n"
                       "#define SEA_MIRROR_SIDE {}.0\n"
                       "#define OPEN_SKY_COLUMNS {}\n#define OPEN_SKY_ROWS {}\n",
                       static_cast<int>(material.cover().kind), water_line_m ? 1 : 0,
                       material.drape() != nullptr ? 1 : 0,
                       material.drape() != nullptr && material.drape()->IsLandCover() ? 1 : 0,
                       planet_is_water ? 1 : 0, land.is_there ? 1 : 0, land.has_fine_relief ? 1 : 0,
                       LevelSky::kLowest_rad, LevelSky::kRange_rad, LevelSky::kNodes,
                       SeaMirror::kSide, SkyTilt::kColumns, SkyTilt::kRows)},
          ViewerPiece("viewer/ground/sky_tilt.glsl"),
          ViewerPiece("viewer/shaders/ground.glsl"),
          ViewerPiece("viewer/shaders/ground_surface.glsl"),
          ViewerPiece("viewer/shaders/ground_light.glsl")};
}

GroundTextures::GroundTextures(const DiffuseLight& diffuse) {
  SetAir(diffuse);
  const std::vector<BandTexel> black(SeaMirror::kSide * SeaMirror::kSide);
  for (const LightSource source : {LightSource::kSun, LightSource::kMoon})
    SetSeaMirror(source, black);
}

void GroundTextures::SetAir(const DiffuseLight& diffuse) const {
  Upload(level_sky_, LevelSky::kNodes, 1, LevelSky::Of(diffuse));
}

void GroundTextures::SetSeaMirror(LightSource source, const std::vector<BandTexel>& texels) const {
  Upload(sea_mirrors_[IndexOf(source)], SeaMirror::kSide, SeaMirror::kSide, texels);
}

void GroundTextures::SetDrape(const DrapeTexels& texels) const {
  glBindTexture(GL_TEXTURE_2D, drape_.id());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA16, static_cast<GLsizei>(texels.columns),
               static_cast<GLsizei>(texels.rows), 0, GL_RGBA, GL_UNSIGNED_SHORT,
               texels.rgba.data());
  ClampAndFilter(GL_TEXTURE_2D, true);
  glGenerateMipmap(GL_TEXTURE_2D);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
}

void GroundTextures::Bind(const ShaderProgram& program, int first_unit, LightSource source) const {
  int unit = first_unit;
  for (const auto& [sampler, texture] : {std::pair{"level_sky", &level_sky_},
                                         {"sea_mirror", &sea_mirrors_[IndexOf(source)]},
                                         {"drape", &drape_}}) {
    program.BindSampler(sampler, unit);
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit++));
    glBindTexture(GL_TEXTURE_2D, texture->id());
  }
}

}  // namespace alpenglow::viewer
