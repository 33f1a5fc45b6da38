// SPDX-License-Identifier: MIT
#include "viewer/passes/picture_programs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/time_place/geodesy.h"
#include "lut/camera_tables/air_rows.h"
#include "lut/cli/messages.h"
#include "renderer/scene/scene_fields.h"
#include "renderer/surface/ground_pattern.h"
#include "renderer/surface/surface.h"
#include "viewer/air/air_follower.h"
#include "viewer/gl/gl_context.h"
#include "viewer/ground/ground_block.h"
#include "viewer/media/scene_media.h"
#include "viewer/passes/painted_view.h"
#include "viewer/shade/shafts.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {
namespace {

ShaderPiece DefinesOf(const PictureKind& kind, const PictureStage& stage) {
  return {
      "stage",
      fmt::format("#define LAND_PASS 0\n#define SKY_PASS 1\n#define DISK_PASS 2\n"
                  "#define OPEN_SKY_PASS 3\n"
                  "#define PASS {}\n#define HAS_SHADE {}\n#define HAS_LAMPS {}\n"
                  "#define HAS_MEDIA {}\n#define SKY_BY_PIXEL {}\n#define HAS_NIGHT {}\n"
                  "#define HAS_CLOUDS {}\n",
                  static_cast<int>(stage.pass), stage.has_shade ? 1 : 0, stage.has_lamps ? 1 : 0,
                  kind.media.has_layer ? 1 : 0, stage.sky_by_pixel ? 1 : 0, stage.has_night ? 1 : 0,
                  stage.cloud_layers > 0 ? 1 : 0)};
}

void Append(std::vector<ShaderPiece>& texts, std::vector<ShaderPiece> pieces) {
  for (ShaderPiece& piece : pieces) texts.push_back(std::move(piece));
}

}  // namespace

std::vector<ShaderPiece> AirTexts() {
  std::vector<ShaderPiece> texts = WithViewerPieces(
      SharedTexts(), {"viewer/shaders/view/block.glsl", "viewer/shaders/view/refracted_rays.glsl"});
  Append(texts, AirTableTexts());
  return texts;
}

CloudPass ConnectedClouds() {
  const auto colours = [](const CloudPass::Kind& kind) {
    std::vector<ShaderPiece> texts;
    if (kind.two_lights) texts.push_back({"lights", "#define TWO_LIGHTS\n"});
    Append(texts, AirTexts());
    Append(texts, WithViewerPieces(
                      {}, {"viewer/shaders/air/block.glsl", "viewer/shaders/air/sun_light.glsl"}));
    Append(texts, CloudTexts(kind.layers));
    ShaderProgram made = FullScreenProgram(WithViewerPieces(
        std::move(texts),
        {"viewer/shaders/clouds/rays.glsl", "viewer/shaders/clouds/colour.frag.glsl"}));
    made.BindBlock("View", kViewBinding);
    made.BindBlock("Air", kAirBinding);
    AirTextures::Prepare(made, kAirUnit, kTablesBinding);
    AirTextures::PrepareOther(made, kOtherAirUnit, kOtherTablesBinding);
    return made;
  };
  return {WithViewerPieces(SharedTexts(), {"viewer/shaders/view/block.glsl",
                                           "viewer/shaders/view/refracted_rays.glsl"}),
          kViewBinding, colours, kCloudUnits};
}

std::vector<ShaderPiece> PictureTexts(const PictureKind& kind, const PictureStage& stage) {
  std::vector<ShaderPiece> texts;
  const auto add = [&](std::vector<ShaderPiece> pieces) { Append(texts, std::move(pieces)); };
  if (stage.two_lights) texts.push_back({"lights", "#define TWO_LIGHTS\n"});
  if (stage.other_has_set) texts.push_back({"set light", "#define OTHER_HAS_SET\n"});
  add(AirTexts());
  texts.push_back(DefinesOf(kind, stage));
  add(MediaTexts(kind.media));
  // On the ground, the transmittance of sunlight includes that of the media above.
  if (kind.media.has_layer) {
    texts.push_back({"media over the ground",
                     "#define BeamOfSun(h, mu) (BeamOfSun(h, mu) * SunLeftByMedia(h, mu))\n"});
  }
  add(WithViewerPieces(
      {}, {"viewer/shaders/air/block.glsl", "viewer/shaders/gbuffer/octahedral.glsl",
           "viewer/shaders/gbuffer/inverse_depth.glsl", "viewer/shaders/air/sun_light.glsl"}));
  if (stage.pass == PictureStage::Pass::kDisks)
    add(WithViewerPieces({}, {"viewer/shaders/view/refracted_disks.glsl"}));
  if (stage.cloud_layers > 0) {
    add(CloudTexts(stage.cloud_layers));
    add(WithViewerPieces(
        {}, {"viewer/shaders/clouds/near_rays.glsl", "viewer/shaders/clouds/picture.glsl"}));
  }
  add(GroundTexts(kind.material, kind.land));
  if (stage.sky_by_pixel) add(SkyByPixelTexts());
  add(ShaftTexts());
  add(stage.has_lamps ? kind.lamps.texts() : NoLampTexts());
  return texts;
}

int TexturesOf(const PictureKind& kind, const PictureStage& stage) {
  using enum PictureStage::Pass;
  const bool is_land = stage.pass == kLand, is_ground = is_land || stage.pass == kSky;
  const int lights = stage.two_lights ? 2 : 1;
  const bool has_gloss = is_ground && kind.material.HasGloss();
  int textures = (is_land ? 1 : 3) + 3 * lights;  // the air: to a point, and all of it
  textures += is_land ? 1 : lights;               // the surface; the whole sky
  // Single scattering of a light that has set, and the phase function that the sky still needs.
  if (stage.other_has_set) textures -= is_land ? 2 : 1;
  if (is_land && !stage.sky_by_pixel) textures += lights;
  if (is_ground) textures += kind.material.drape() != nullptr ? 2 : 1;
  if (has_gloss) textures += 1 + lights;
  // What land mirrors is among the textures of the sky by pixel.
  if (stage.sky_by_pixel) {
    textures += 1 + 3 * lights;
  } else if (has_gloss) {
    textures += 1 + lights;
  }
  textures += kind.media.Textures(lights);
  if (stage.has_shade) textures += kind.media.has_layer ? 2 : 1;
  if (stage.has_lamps) textures += 6;
  if (stage.has_night && !is_land) textures += 1;
  if (stage.cloud_layers > 0) textures += is_ground ? 4 : 2;
  return textures;
}

namespace {

/// Returns advice on the parts of a scene that need textures; empty if it has none.
std::string PartsToOmit(const PictureKind& kind) {
  std::vector<std::string> parts;
  if (kind.media.has_layer) parts.push_back(fmt::format("[{}]", LayerFields().name));
  if (kind.material.HasWater()) parts.push_back("water");
  if (kind.material.HasGloss() && !kind.material.HasWater()) parts.push_back("glossy ground");
  if (kind.material.drape() != nullptr) parts.push_back("the picture on the terrain");
  if (parts.empty()) return "";
  return fmt::format("; the scene needs fewer without {}", fmt::join(parts, " or "));
}

}  // namespace

FittingStage Fitting(const PictureKind& kind, const PictureStage& stage, int units) {
  using enum PictureStage::Pass;
  const auto needed = [&](const PictureStage& of) {
    return std::max({TexturesOf(kind, of.In(kLand)), TexturesOf(kind, of.In(kSky)),
                     TexturesOf(kind, of.In(kUnoccludedSky))});
  };
  FittingStage fitting{stage, {}};
  fitting.stage.pass = kLand;
  for (const auto& [property, name] :
       {std::pair{&PictureStage::has_shade, "shadows of mountains in the air"},
        std::pair{&PictureStage::two_lights, "the weaker light of sun and moon"},
        std::pair{&PictureStage::sky_by_pixel, "light of the sky by pixel instead of by vertex"},
        std::pair{&PictureStage::has_lamps, "lamps"},
        std::pair{&PictureStage::has_night, "the night sky"}}) {
    if (!(fitting.stage.*property)) continue;
    const int with = needed(fitting.stage);
    if (with <= units) break;
    fitting.stage.*property = false;
    fitting.omitted.push_back(fmt::format("{} ({} textures)", name, with));
  }
  if (needed(fitting.stage) > units)
    throw DisplayError(
        fmt::format("a program for this scene reads {} textures, and the OpenGL driver has units "
                    "for {}{}; the software driver, LIBGL_ALWAYS_SOFTWARE=1, has 32",
                    needed(fitting.stage), units, PartsToOmit(kind)));
  fitting.stage = fitting.stage.In(stage.pass);
  return fitting;
}

namespace {

GroundBlock GroundAround(const PaintedScene& scene, const PaintedView& view) {
  const MountainSurface surface(scene.air().air()->medium().wavelengths_nm,
                                CoverInSeason(view.eye.place, view.now.modified_julian_day),
                                scene.fixed().material.cover().wetness);
  const GroundPattern pattern(LocalFrame(scene.fixed().ellipsoid, view.eye.place));
  GroundPoint eye = pattern.At(glm::dvec3(0.0));
  eye.sea_s = SeaTime(view.now);
  GroundBlock block = WithAxesOf(pattern, GroundBlockOf(surface, eye));
  block.cover_lines.z = static_cast<float>(scene.sizes().dropped_octaves);
  return block;
}

GroundLightBlock LightAround(const PaintedScene& scene, const PaintedView& view,
                             const DistantLight& light) {
  GroundLightBlock block = GroundLightBlockOf(scene.UnoccludedSkyIrradiance(light.body),
                                              light.direction.seen, PixelAngle(view));
  block.ground_view.y = scene.HasEdgesOf(light.body) ? 1.0F : 0.0F;
  return block;
}

GroundSurfaceBlock SurfaceAround(const PaintedScene& scene, const CameraPose& eye) {
  const GroundSurfaceBlock cover = Mirrored(GroundSurfaceBlockOf(scene.fixed().material),
                                            scene.ground().gloss_mirror(scene.ground().casts()));
  if (!scene.fixed().drape.colours) return cover;
  Place origin = scene.fixed().place;
  origin.height_m = 0.0;
  const LocalFrame frame(scene.fixed().ellipsoid, eye.place);
  return Draped(cover, scene.fixed().drape.place,
                FrameTransform(frame, LocalFrame(scene.fixed().ellipsoid, origin)),
                GroundPattern(frame));
}

// Returns the direction and the angular radius of a light's disk.
glm::vec4 ApparentDiskOf(const DistantLight& light) {
  return {glm::vec3(light.direction.seen), light.radius_rad};
}

// Sets the refraction of the view. Without refraction the planet appears with its true radius.
void SetBend(ViewBlock& block, const std::optional<LandBend>& bend) {
  block.bend.x = block.eye.w;
  if (!bend) return;
  const auto layers = [](const std::array<double, 3>& of) {
    return glm::vec4(glm::dvec4(of[0], of[1], of[2], 0.0));
  };
  block.bend = glm::vec4(glm::dvec4(bend->look_radius_km, bend->top_km, bend->usual_per_km, 0.0));
  block.bend_slopes = layers(bend->slope_per_km);
  block.bend_falls = layers(bend->fall_per_km);
}

}  // namespace

void PictureBlocks::UploadAir(const PaintedScene& scene, const CameraPose& eye) {
  const std::shared_ptr<const SolvedAir> air = scene.air().air();
  if (known_air_ != air) air_block_ = AirBlockOf(air->medium());
  known_air_ = air;
  air_block_.shell.x = static_cast<float>(RadiusUnder(eye, air->medium()));
  UploadBlock(air_, kAirBinding, air_block_);
}

void PictureBlocks::UploadView(const PaintedScene& scene, const Frame& frame, const PixelRay& ray,
                               const LightsOfView& lights) const {
  const PaintedView& view = frame.view;
  const Medium& medium = scene.air().air()->medium();
  const ViewAxes axes = AxesOf(view);
  const glm::dvec2 shift = ShiftOf(ray, view);
  const glm::dvec2 moved(view.part.x * view.part.z + shift.x, view.part.y * view.part.w + shift.y);
  const double altitude_km = std::max(view.eye.place.height_m, 0.0) / kMetresPerKilometre;
  ViewBlock block{};
  block.view_right = {glm::vec3(axes.right), 0.0F};
  block.view_up = {glm::vec3(axes.up), 0.0F};
  block.view_forward = {glm::vec3(axes.forward), PixelAngle(view) / std::sqrt(ray.of)};
  const DistantLight &first = lights.of_sky.front(), &other = lights.of_sky.back();
  block.sun = ApparentDiskOf(first);
  block.sun_for_air = {glm::vec3(first.direction.for_air), 0.0F};
  block.sun_irradiance = GpuBandsOf(first.irradiance);
  block.other_sun = ApparentDiskOf(other);
  block.other_sun_for_air = {glm::vec3(other.direction.for_air), 0.0F};
  block.other_sun_irradiance = GpuBandsOf(other.irradiance);
  block.night_scattered = lights.night_scattered;
  block.night_level = lights.night_level;
  block.eye = {altitude_km, moved.x, moved.y, RadiusUnder(view.eye, medium)};
  SetBend(block, frame.bend);
  UploadBlock(view_, kViewBinding, block);
}

void PictureBlocks::UploadGroundLight(const PaintedScene& scene, const Frame& frame) const {
  UploadBlock(ground_light_, kGroundLightBinding,
              LightAround(scene, frame.view, frame.lights().front()));
  UploadBlock(other_ground_light_, kOtherGroundLightBinding,
              LightAround(scene, frame.view, frame.lights().back()));
}

void PictureBlocks::UploadSkyByPixel(const PaintedScene& scene, const Frame& frame) const {
  const LocalFrame eye(scene.fixed().ellipsoid, frame.view.eye.place);
  const auto block_of = [&](const DistantLight& light) {
    const SkyByPixel* sky = scene.sky_by_pixel(light.body);
    return sky == nullptr ? SkyByPixelBlock{}
                          : sky->BlockOf(light.body, eye, light.direction.for_air,
                                         scene.UnoccludedSkyIrradiance(light.body));
  };
  UploadBlock(sky_by_pixel_, kSkyByPixelBinding,
              WithLights(block_of(frame.lights().front()), block_of(frame.lights().back())));
}

void PictureBlocks::UploadGround(const PaintedScene& scene, const PaintedView& view) const {
  UploadBlock(ground_, kGroundBinding, GroundAround(scene, view));
  UploadBlock(ground_surface_, kGroundSurfaceBinding, SurfaceAround(scene, view.eye));
}

namespace {

// Fragments have depth 0 and are tested against the depth of land: either it is nearer (land), or
// there is no land.
GLenum DepthTestOf(PictureStage::Pass pass) {
  return pass == PictureStage::Pass::kLand ? GL_LESS : GL_EQUAL;
}

void ConnectBlocks(const ShaderProgram& program) {
  program.BindBlock("Air", kAirBinding);
  program.BindBlock("View", kViewBinding);
  program.BindBlock("Ground", kGroundBinding);
  program.BindBlock("GroundLight", kGroundLightBinding);
  program.BindBlock("OtherGroundLight", kOtherGroundLightBinding);
  program.BindBlock("GroundSurface", kGroundSurfaceBinding);
  program.BindBlock("SkyByPixel", kSkyByPixelBinding);
}

void ConnectMaps(const ShaderProgram& program) {
  program.BindSampler("surface_map", kSurfaceUnit);
  program.BindSampler("sky_on_surface", kSkyOnSurfaceUnit);
  program.BindSampler("other_sky_on_surface", kOtherSkyOnSurfaceUnit);
  program.BindSampler("shaft_map", kShaftUnit);
  program.BindSampler("media_shaft_map", kMediaShaftUnit);
  program.BindSampler("night_sky", kNightUnit);
  GroundTextures::Connect(program, kGroundUnit);
  SkyByPixel::Connect(program, kSkyByPixelUnit);
  AirTextures::Prepare(program, kAirUnit, kTablesBinding);
  AirTextures::PrepareOther(program, kOtherAirUnit, kOtherTablesBinding);
}

}  // namespace

PicturePrograms::PicturePrograms(const PaintedScene& scene, const LampPainter& lamps,
                                 const ShaftPass& shafts, const CloudPass& clouds)
    : scene_(scene),
      lamps_(lamps),
      shafts_(shafts),
      clouds_(clouds),
      units_(TextureUnitsOfDriver()) {}

PictureKind PicturePrograms::Kind() const {
  return {scene_.fixed().material, lamps_, scene_.fixed().land_kind, scene_.media().kind()};
}

PictureStage PicturePrograms::Fitting(const PictureStage& stage) {
  const FittingStage fitting = viewer::Fitting(Kind(), stage, units_);
  for (const std::string& name : fitting.omitted) {
    if (omitted_.insert(name).second)
      Log(fmt::format(
          "skyview: warning: the OpenGL driver has {} texture units; pictures lack {}. The "
          "software driver, LIBGL_ALWAYS_SOFTWARE=1, has 32\n",
          units_, name));
  }
  return fitting.stage;
}

ShaderProgram PicturePrograms::Made(const PictureStage& stage) const {
  ShaderProgram made = FullScreenProgram(
      WithViewerPieces(PictureTexts(Kind(), stage), {"viewer/shaders/picture/picture.frag.glsl"}));
  ConnectBlocks(made);
  ConnectMaps(made);
  if (stage.has_lamps) lamps_.Connect(made);
  scene_.media().Connect(made);
  if (stage.cloud_layers > 0) clouds_.Connect(made);
  return made;
}

const ShaderProgram& PicturePrograms::Of(const PictureStage& stage) {
  const auto found = made_.find(stage);
  if (found != made_.end()) return found->second;
  return made_.emplace(stage, Made(stage)).first->second;
}

void PicturePrograms::Paint(const PictureStage& stage) {
  const ShaderProgram& program = Of(stage);
  if (stage.has_shade) shafts_.Bind(program, kShaftUnit);
  program.Use();
  if (stage.cloud_layers > 0) clouds_.Bind(program);
  glDepthFunc(DepthTestOf(stage.pass));
  DrawFullScreen(program, no_vertices_);
  ready_.insert(stage);
}

bool PicturePrograms::MakeReady(const PictureStage& stage) {
  if (ready_.contains(stage) || (stage.has_shade && !shafts_.HasMap())) return false;
  const Scissor one_pixel({0, 0, 1, 1});
  Paint(stage);
  return true;
}

void PicturePrograms::ForgetThoseWithLamps() {
  std::erase_if(made_, [](const auto& made) { return made.first.has_lamps; });
  std::erase_if(ready_, [](const PictureStage& stage) { return stage.has_lamps; });
}

}  // namespace alpenglow::viewer
