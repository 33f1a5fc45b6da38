// SPDX-License-Identifier: MIT
#include "viewer/ground/ground_block.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "viewer/gl/render_target.h"
#include "viewer/land/land_pass.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {

FlatRectangle CoveredPart(const ColourDrape& drape, const FlatRectangle& of) {
  constexpr int kSteps = 100;
  const double step_x_m = of.width_m / kSteps, step_y_m = of.depth_m / kSteps;
  int west = kSteps, south = kSteps, east = -1, north = -1;
  for (int i = 0; i < kSteps * kSteps; ++i) {
    const int x = i % kSteps, y = i / kSteps;
    const glm::dvec3 middle(of.west_m + step_x_m * (x + 0.5), of.south_m + step_y_m * (y + 0.5),
                            0.0);
    if (!drape.At(middle, 0.0, 0.0)) continue;
    west = std::min(west, x - 1), east = std::max(east, x + 2);
    south = std::min(south, y - 1), north = std::max(north, y + 2);
  }
  if (east < 0) return of;
  west = std::max(west, 0), south = std::max(south, 0);
  east = std::min(east, kSteps), north = std::min(north, kSteps);
  return {of.west_m + west * step_x_m, of.south_m + south * step_y_m, (east - west) * step_x_m,
          (north - south) * step_y_m};
}

// Points at altitude 0 are their own foot points, so the colours are sampled there.
DrapeTexels::DrapeTexels(const ColourDrape& drape, const FlatRectangle& over, std::size_t most)
    : place(over), columns(most), rows(most) {
  const double step_x_m = over.width_m / static_cast<double>(columns);
  const double step_y_m = over.depth_m / static_cast<double>(rows);
  rgba.resize(columns * rows);
  tbb::parallel_for(std::size_t{0}, rgba.size(), [&](std::size_t i) {
    const glm::dvec3 point(over.west_m + step_x_m * (static_cast<double>(i % columns) + 0.5),
                           over.south_m + step_y_m * (static_cast<double>(i / columns) + 0.5), 0.0);
    const auto rgb = drape.At(point, 0.0, std::max(step_x_m, step_y_m));
    std::array<std::uint16_t, 4>& texel = rgba[i];
    for (std::size_t k = 0; rgb && k < 3; ++k)
      texel[k] = static_cast<std::uint16_t>(std::lround(65535.0 * (*rgb)[k]));
    if (rgb) texel[3] = 65535;
  });
}

SceneDrape DrapeOf(const Scene& scene, const SceneGround& ground) {
  if (scene.terrain.Drape().empty()) return {};
  std::optional<SceneGround> loaded;
  if (!ground.terrain) loaded.emplace(LoadGround(scene));
  const SceneGround& draped = loaded ? *loaded : ground;
  std::shared_ptr<const ColourDrape> colours = ColourDrape::Of(scene, draped);
  const FlatRectangle place = CoveredPart(*colours, RectangleOf(draped.terrain->mesh()));
  return {std::move(colours), place};
}

DrapeTexels TexelsOf(const SceneDrape& drape) {
  constexpr double kMostTexels = 4096.0, kTexelsAPixel = 4.0;
  const double side_m = std::max(drape.place.width_m, drape.place.depth_m);
  const double wanted = std::ceil(kTexelsAPixel * side_m / drape.colours->pixel_m());
  const auto texels = static_cast<std::size_t>(std::clamp(wanted, 1.0, kMostTexels));
  return {*drape.colours, drape.place, texels};
}

namespace {

// A height below any ground.
constexpr double kNoSea_m = -1e9;

// Returns the shader's table entry at a step of the square root of a cosine: the total mirrored
// weight of a glossy cover, otherwise the balance of snow.
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
  UploadTexture(GL_TEXTURE_2D, texture,
                {GL_RGBA32F, static_cast<int>(columns), static_cast<int>(rows), 1, GL_RGBA,
                 GL_FLOAT, texels.data()});
}

}  // namespace

GroundLightBlock GroundLightBlockOf(const SkyIrradianceGradient& tilt, const glm::dvec3& to_light,
                                    double pixel_angle_rad) {
  const double flat = std::max(std::hypot(to_light.x, to_light.y), 1e-9);
  GroundLightBlock block{
      {to_light.x / flat, to_light.y / flat, 0.0, 0.0}, {pixel_angle_rad, 1.0, 0.0, 0.0}, {}};
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

GroundSurfaceBlock Mirrored(GroundSurfaceBlock block, const GlossMirror& mirror) {
  const double rise_km = (mirror.higher_m - mirror.lower_m) / kMetresPerKilometre;
  block.mirror_place = glm::vec4(glm::dvec4(mirror.lower_m / kMetresPerKilometre,
                                            rise_km > 0.0 ? 1.0 / rise_km : 0.0, 0.0, 0.0));
  return block;
}

GroundSurfaceBlock Draped(GroundSurfaceBlock block, const FlatRectangle& picture,
                          const FrameTransform& eye_from_drape, const GroundPattern& pattern) {
  block.drape_place = {picture.west_m, picture.south_m, 1.0 / picture.width_m,
                       1.0 / picture.depth_m};
  block.drape_eye = glm::vec4(eye_from_drape.PointBack(glm::dvec3(0.0)), 0.0);
  block.drape_east = glm::vec4(pattern.ToPattern(eye_from_drape.axes()[0]), 0.0);
  block.drape_north = glm::vec4(pattern.ToPattern(eye_from_drape.axes()[1]), 0.0);
  return block;
}

namespace {

ShaderPiece SkyByPixelSizes() {
  return {"sky by pixel",
          fmt::format("#define SKY_LOWEST ({:.9f})\n#define SKY_NODES {}.0\n"
                      "#define SKY_LEVELS {}.0\n#define SKY_SUNS {}.0\n",
                      HorizonMap::kLowest, OccludedSkyIrradiance::kNodes,
                      OccludedSkyIrradiance::kLevels, OccludedSkyIrradiance::kSuns)};
}

}  // namespace

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
                       "#define HAS_WATER {}\n#define HAS_GLOSS {}\n"
                       "#define GLOSS_MIRROR_SIDE {}.0\n#define GLOSS_MIRROR_HORIZONS {}.0\n"
                       "#define GLOSS_MIRROR_LAYERS {}.0\n#define GLOSS_MIRROR_OF_LAND {}.0\n"
                       "#define OPEN_SKY_COLUMNS {}\n#define OPEN_SKY_ROWS {}\n",
                       static_cast<int>(material.cover().kind), water_line_m ? 1 : 0,
                       material.drape() != nullptr ? 1 : 0,
                       material.drape() != nullptr && material.drape()->IsLandCover() ? 1 : 0,
                       planet_is_water ? 1 : 0, land.is_there ? 1 : 0, land.has_fine_relief ? 1 : 0,
                       LevelSky::kLowest_rad, LevelSky::kRange_rad, LevelSky::kNodes,
                       material.HasWater() ? 1 : 0, material.HasGloss() ? 1 : 0, GlossMirror::kSide,
                       GlossMirror::kHorizons, GlossMirror::kLayers,
                       material.HasWater() ? GlossMirror::kLayers : 0,
                       SkyIrradianceGradient::kColumns, SkyIrradianceGradient::kRows)},
          ViewerPiece("renderer/illumination/sky_irradiance_gradient.glsl"),
          ViewerPiece("viewer/shaders/view/lights.glsl"),
          ViewerPiece("viewer/shaders/ground/pattern.glsl"),
          SkyByPixelSizes(),
          ViewerPiece("viewer/shaders/sky_by_pixel/tables.glsl"),
          ViewerPiece("viewer/shaders/ground/surface.glsl"),
          ViewerPiece("viewer/shaders/ground/light.glsl")};
}

GroundTextures::GroundTextures(const MultipleScattering& multiple_scattering) {
  SetAir(multiple_scattering);
  constexpr BandTexel kBlack{};
  for (const GlTexture& mirror : gloss_mirrors_)
    UploadTexture(GL_TEXTURE_2D_ARRAY, mirror,
                  {GL_RGBA32F, 1, 1, 1, GL_RGBA, GL_FLOAT, kBlack.data()});
}

void GroundTextures::SetAir(const MultipleScattering& multiple_scattering) const {
  Upload(level_sky_, LevelSky::kNodes, 1, LevelSky::Of(multiple_scattering));
}

void GroundTextures::SetGlossMirror(LightSource source, const GlossMirror& mirror) const {
  std::vector<BandTexel> texels = mirror.waves;
  texels.insert(texels.end(), mirror.land.begin(), mirror.land.end());
  constexpr auto kSide = static_cast<int>(GlossMirror::kSide);
  UploadTexture(GL_TEXTURE_2D_ARRAY, gloss_mirrors_[IndexOf(source)],
                {GL_RGBA32F, kSide, kSide, static_cast<int>(texels.size()) / (kSide * kSide),
                 GL_RGBA, GL_FLOAT, texels.data()});
}

void GroundTextures::SetDrape(const DrapeTexels& texels) const {
  UploadTexture(GL_TEXTURE_2D, drape_,
                {GL_RGBA16, static_cast<int>(texels.columns), static_cast<int>(texels.rows), 1,
                 GL_RGBA, GL_UNSIGNED_SHORT, texels.rgba.data()});
  glGenerateMipmap(GL_TEXTURE_2D);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
}

namespace {

void ConnectSamplers(const ShaderProgram& program, int unit, std::span<const char* const> names) {
  for (const char* const name : names) program.BindSampler(name, unit++);
}

}  // namespace

void GroundTextures::Connect(const ShaderProgram& program, int first_unit) {
  constexpr std::array<const char*, kUnits> kNames{"level_sky", "drape", "gloss_mirror",
                                                   "other_gloss_mirror"};
  ConnectSamplers(program, first_unit, kNames);
}

void GroundTextures::Bind(int first_unit, LightSource source, LightSource other) const {
  BindTexture(first_unit, GL_TEXTURE_2D, level_sky_);
  BindTexture(first_unit + 1, GL_TEXTURE_2D, drape_);
  BindTexture(first_unit + 2, GL_TEXTURE_2D_ARRAY, gloss_mirrors_[IndexOf(source)]);
  BindTexture(first_unit + 3, GL_TEXTURE_2D_ARRAY, gloss_mirrors_[IndexOf(other)]);
}

namespace {

constexpr auto kAzimuths = static_cast<int>(kHorizonAzimuths);
constexpr std::size_t kFour = 4;  // components of a texel
constexpr std::size_t kWeightLayers = kHorizonAzimuths / kFour;

void UploadIntegrals(const GlTexture& texture, const OccludedSkyIrradiance::Tables& tables) {
  constexpr std::size_t kNodes = OccludedSkyIrradiance::kNodes;
  const std::vector<float> texels = IntegralTexels(tables);
  UploadTexture(
      GL_TEXTURE_2D_ARRAY, texture,
      {GL_RGBA16F, static_cast<int>(kNodes), 2 * kAzimuths,
       static_cast<int>(OccludedSkyIrradiance::kLevels), GL_RGBA, GL_FLOAT, texels.data()});
}

void UploadLevels(const GlTexture& texture, const OccludedSkyIrradiance::Tables& tables) {
  UploadTexture(GL_TEXTURE_2D, texture,
                {GL_RGBA32F, static_cast<int>(OccludedSkyIrradiance::kSuns),
                 static_cast<int>(OccludedSkyIrradiance::kLevels), 1, GL_RGBA, GL_FLOAT,
                 tables.level_irradiance.data()});
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
  UploadTexture(
      GL_TEXTURE_2D_ARRAY, texture,
      {GL_RGBA16F, grid.columns, grid.rows, static_cast<int>(kHorizonAzimuths + kWeightLayers),
       GL_RGBA, GL_FLOAT, texels.data()});
}

}  // namespace

std::vector<float> IntegralTexels(const OccludedSkyIrradiance::Tables& tables) {
  constexpr std::size_t kNodes = OccludedSkyIrradiance::kNodes,
                        kHorizonRows = OccludedSkyIrradiance::kLevels * kHorizonAzimuths;
  std::vector<float> texels(tables.integral.size());
  for (std::size_t row = 0; row < kHorizonRows; ++row) {
    for (std::size_t node = 0; node < kNodes; ++node) {
      for (std::size_t part = 0; part < 2; ++part) {
        const float* from = &tables.integral[((row * kNodes + node) * 2 + part) * kFour];
        std::transform(from, from + kFour, &texels[((row * 2 + part) * kNodes + node) * kFour],
                       WithinHalf);
      }
    }
  }
  return texels;
}

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
  UploadTexture(GL_TEXTURE_2D_ARRAY, horizon_texture_,
                {GL_RGBA16, grid.columns, grid.rows, kAzimuths / 4, GL_RGBA, GL_UNSIGNED_SHORT,
                 texels.data()});
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

SkyByPixelBlock WithLights(const SkyByPixelBlock& first, const SkyByPixelBlock& other) {
  const bool has_first = first.slope_unit.x > 0.0F;
  SkyByPixelBlock block = has_first ? first : other;
  block.sky_moment = first.sky_moment;
  block.sky_place = first.sky_place;
  block.slope_unit = first.slope_unit;
  block.other_sky_moment = other.sky_moment;
  block.other_sky_place = other.sky_place;
  block.other_slope_unit = other.slope_unit;
  return block;
}

SkyByPixelBlock SkyByPixel::BlockOf(LightSource source, const LocalFrame& eye,
                                    const glm::dvec3& to_light_for_air,
                                    const SkyIrradianceGradient& now) const {
  const OfSource& of = *of_source_[IndexOf(source)];
  const GroundSky& sky = *of.sky.sky;
  const LocalFrame& site = sky.site().ground().frame;
  const PlaceOnGrid horizon = PlaceOnGridOf(horizons_->map().grid(), site, eye);
  const PlaceOnGrid slope = PlaceOnGridOf(horizons_->views().heights(), site, eye);
  const std::array<float, 4> light_now = now.On(1.0, 0.0), light_then = of.sky.open.On(1.0, 0.0);
  SkyByPixelBlock block{horizon.u, horizon.v, slope.u, slope.v, {}, {}, of.slope_unit, {}, {}, {}};
  for (glm::length_t band = 0; band < 4; ++band) {
    const auto i = static_cast<std::size_t>(band);
    block.sky_moment[band] = light_then[i] > 0.0F ? light_now[i] / light_then[i] : 0.0F;
  }
  const OccludedSkyIrradiance::Tables tables = sky.lighting().on_terrain->sky().tables();
  const double mu_s_now = site.EnuFromEcef(eye.EcefFromEnu(Vector<Enu>{to_light_for_air})).xyz.z;
  const double moved = sky.lighting().source.direction.for_air.z - mu_s_now;
  block.sky_place = {
      -tables.lowest_m / kMetresPerKilometre,
      kMetresPerKilometre / (tables.highest_m - tables.lowest_m), moved - tables.first_mu_s,
      1.0 / (tables.mu_s_step * static_cast<double>(OccludedSkyIrradiance::kSuns - 1))};
  return block;
}

void SkyByPixel::Connect(const ShaderProgram& program, int first_unit) {
  constexpr std::array<const char*, kUnits> kNames{
      "horizons_around",     "sky_integrals",          "level_irradiance",     "light_of_slopes",
      "other_sky_integrals", "other_level_irradiance", "other_light_of_slopes"};
  ConnectSamplers(program, first_unit, kNames);
}

void SkyByPixel::BindLight(int first_unit, LightSource source) const {
  const OfSource& of = *of_source_[IndexOf(source)];
  BindTexture(first_unit, GL_TEXTURE_2D_ARRAY, of.integrals);
  BindTexture(first_unit + 1, GL_TEXTURE_2D, of.level_irradiance);
  BindTexture(first_unit + 2, GL_TEXTURE_2D_ARRAY, of.slopes);
}

void SkyByPixel::Bind(int first_unit, LightSource source) const {
  BindTexture(first_unit, GL_TEXTURE_2D_ARRAY, horizon_texture_);
  BindLight(first_unit + 1, source);
}

void SkyByPixel::BindOther(int first_unit, LightSource source) const {
  BindLight(first_unit + 4, source);
}

std::vector<ShaderPiece> SkyByPixelTexts() {
  return {ViewerPiece("viewer/shaders/sky_by_pixel/irradiance.glsl")};
}

}  // namespace alpenglow::viewer
