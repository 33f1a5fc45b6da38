// SPDX-License-Identifier: MIT
#include "viewer/paint/sky_painter.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <utility>

#include "atmosphere/number/constants.h"
#include "atmosphere/sun/moon_disk.h"
#include "atmosphere/text/error.h"
#include "renderer/ground/colour_drape.h"
#include "renderer/ground/surface.h"
#include "viewer/gl/gl_context.h"
#include "viewer/ground/ground_block.h"
#include "viewer/shaders/full_screen.h"
#include "viewer/shaders/uniform_blocks.h"
#include "viewer/shaders/viewer_texts.h"

namespace alpenglow {
namespace {

enum Binding : GLuint {
  kAirBinding,
  kViewBinding,
  kGroundBinding,
  kGroundLightBinding,
  kGroundSurfaceBinding,
  kTablesBinding,
  kLampsBinding,
  kFogBinding
};
enum Unit {
  kSurfaceUnit,
  kSkyOnSurfaceUnit,
  kShaftUnit,
  kShadeUnit,
  kUploadUnit,
  kAirUnit,
  kGroundUnit = kAirUnit + AirTextures::kUnits,
  kLampUnit = kGroundUnit + 3,
  kFogUnit = kLampUnit + 5,
};
constexpr LampUnits kLampUnits{kLampsBinding, kViewBinding, kSurfaceUnit, kLampUnit};
constexpr FogUnits kFogUnits{kFogBinding, kFogUnit};

// Lamps and fog stand on ground that is there before the first picture; a landing light needs none.
SceneGround LampGroundOf(const Scene& scene) {
  if (!scene.lights.empty() || scene.fog) return LoadGround(scene);
  GeodeticPosition foot = scene.place;
  foot.height_m = 0.0;
  return {LocalFrame(EllipsoidOf(scene.medium), foot), std::nullopt, 0.0, "", true};
}

constexpr double kMetresPerKilometre = 1000.0;

void UploadBlock(const GlBuffer& buffer, GLuint binding, const void* bytes, std::size_t size) {
  glBindBufferBase(GL_UNIFORM_BUFFER, binding, buffer.id());
  glBufferData(GL_UNIFORM_BUFFER, static_cast<GLsizeiptr>(size), bytes, GL_DYNAMIC_DRAW);
}

std::vector<ShaderPiece> AirTexts() {
  std::vector<ShaderPiece> texts =
      WithViewerPieces(SharedTexts(), {"viewer/shaders/view_block.glsl"});
  for (ShaderPiece& piece : AirTableTexts()) texts.push_back(std::move(piece));
  return texts;
}

LandView LandViewOf(const PaintedView& view, int samples = 1) {
  const ViewAxes axes = AxesOf(view.eye);
  const double half_width = std::tan(0.5 * view.eye.fov_rad);
  const double part = half_width / view.part.z;
  return {part * axes.right, part * view.height / view.width * axes.up, axes.forward, samples};
}

// Between neighbouring pixels in the middle of the view [rad].
double PixelAngle(const PaintedView& view) {
  return 2.0 * std::tan(0.5 * view.eye.fov_rad) / (view.width * view.part.z);
}

AirView AirViewOf(const PaintedView& view, const SunPosition& sun) {
  return {std::max(view.eye.place.height_m, 0.0), view.eye.place.latitude_rad,
          DirectionFromAngles(sun.elevation_rad, sun.azimuth_rad).xyz};
}

FogView FogViewOf(const PaintedView& view, const SunPosition& sun) {
  return {view.eye.place.height_m, DirectionFromAngles(sun.elevation_rad, sun.azimuth_rad).xyz,
          sun.angular_radius_rad};
}

// Places of a pixel's rays, spread evenly over it (Roberts 2018, "The unreasonable effectiveness of
// quasirandom sequences"), in half widths and heights of the picture.
glm::dvec2 ShiftOf(int sample, int samples, const PaintedView& view) {
  if (samples == 1) return glm::dvec2(0.0);
  const double x = 0.5 + 0.7548776662466927 * sample, y = 0.5 + 0.5698402909980532 * sample;
  return {(2.0 * (x - std::floor(x)) - 1.0) / view.width,
          (2.0 * (y - std::floor(y)) - 1.0) / view.height};
}

Ellipsoid EllipsoidUnder(const Scene& scene) { return EllipsoidOf(scene.medium); }

LandSize LandSizeOf(const PaintSizes& sizes) {
  LandSize size;
  size.detail = sizes.land_detail;
  return size;
}

}  // namespace

LandSource LandSourceOf(const Scene& scene) {
  LandSource source;
  source.voids = scene.terrain.voids;
  if (scene.terrain.kind == TerrainSource::Kind::kElevationModel)
    source.files = {scene.terrain.file};
  if (scene.terrain.kind == TerrainSource::Kind::kMesh)
    source.mesh = LandSource::Mesh{scene.terrain.file, scene.place};
  if (scene.terrain.kind == TerrainSource::Kind::kBuiltInRange)
    source.range_centre = scene.terrain.centre.value_or(scene.place);
  return source;
}

std::vector<ShaderPiece> PictureTexts(const PictureKind& kind, const PictureStage& stage) {
  std::vector<ShaderPiece> texts = AirTexts();
  const auto add = [&](std::vector<ShaderPiece> pieces) {
    for (ShaderPiece& piece : pieces) texts.push_back(std::move(piece));
  };
  const bool has_lamps = stage.has_lamps && kind.lamps != nullptr;
  texts.push_back(
      {"stage", fmt::format("#define LAND_PASS 0\n#define SKY_PASS 1\n#define DISK_PASS 2\n"
                            "#define PASS {}\n#define HAS_SHADE {}\n#define HAS_LAMPS {}\n"
                            "#define HAS_FOG {}\n",
                            static_cast<int>(stage.pass), stage.has_shade ? 1 : 0,
                            has_lamps ? 1 : 0, kind.fog ? 1 : 0)});
  add(kind.fog ? FogTexts(*kind.fog) : NoFogTexts());
  // What fog leaves of the sun on the ground is part of what the air leaves.
  if (kind.fog) {
    texts.push_back({"fog on the ground",
                     "#define TransmittanceToSun(h, mu) "
                     "(TransmittanceToSun(h, mu) * FogSunLeft(h, mu))\n"});
  }
  add(WithViewerPieces({}, {"viewer/shaders/air_block.glsl", "viewer/shaders/octahedral.glsl",
                            "viewer/shaders/sun_light.glsl"}));
  add(GroundTexts(kind.material));
  add(ShaftTexts());
  add(has_lamps ? kind.lamps->texts() : NoLampTexts());
  return texts;
}

SkyPainter::SkyPainter(const Scene& scene, const LandSource& land, const PaintedView& first,
                       const PaintSizes& sizes)
    : scene_(scene),
      ellipsoid_(EllipsoidUnder(scene)),
      sizes_(sizes),
      lamp_ground_(LampGroundOf(scene)),
      drape_(DrapeOf(scene, lamp_ground_)),
      material_(scene.ground, drape_.colours, scene.medium.wavelengths_nm),
      air_(SolveAir(OnOsculatingSphere(scene.medium, scene.place.latitude_rad)), sizes.air,
           AirViewOf(first, ApparentSunAt(first.eye.place, first.now))),
      land_(land, LandSizeOf(sizes), ellipsoid_),
      ground_(scene.ground, drape_.colours, {}),
      shade_(ellipsoid_),
      shaft_pass_(AirTexts()),
      lamps_(scene, lamp_ground_, OnOsculatingSphere(scene.medium, scene.place.latitude_rad)),
      ground_textures_(air_.air()->diffuse) {
  if (scene.fog) {
    const Medium medium = OnOsculatingSphere(scene.medium, scene.place.latitude_rad);
    fog_.emplace(LocalMedia(scene, lamp_ground_, medium).Only(false, true), kFogUnits);
  }
  shaft_pass_.program().BindBlock("View", kViewBinding);
  shaft_pass_.program().Use();
  AirTextures::Prepare(shaft_pass_.program(), kAirUnit, kTablesBinding);
  shade_.SetSize(sizes.shade.size);
  lamp_painter_.emplace(lamps_, sizes_.lamps, kLampUnits);
  UploadDrape();
  CheckGl("SkyPainter");
}

// Where lamps stand on no terrain, it is loaded for the sake of its frame and its rim.
SkyPainter::Drape SkyPainter::DrapeOf(const Scene& scene, const SceneGround& lamp_ground) {
  if (scene.terrain.colour.empty()) return {};
  std::optional<SceneGround> loaded;
  if (!lamp_ground.terrain) loaded.emplace(LoadGround(scene));
  const SceneGround& ground = loaded ? *loaded : lamp_ground;
  Drape drape{ColourDrape::Of(scene, ground)};
  drape.place = RectangleOf(ground.terrain->mesh());
  return drape;
}

void SkyPainter::UploadDrape() {
  constexpr double kMostTexels = 4096.0;  // a side: 180 MB
  constexpr double kTexelsAPixel = 4.0;   // interpolated once more, edges stay where they are
  if (!drape_.colours) return;
  drape_.place = CoveredPart(*drape_.colours, drape_.place);
  const double side_m = std::max(drape_.place.width_m, drape_.place.depth_m);
  const double wanted = std::ceil(kTexelsAPixel * side_m / drape_.colours->pixel_m());
  const auto texels = static_cast<std::size_t>(std::clamp(wanted, 1.0, kMostTexels));
  ground_textures_.SetDrape(DrapeTexels(*drape_.colours, drape_.place, texels));
}

const ShaderProgram& SkyPainter::ProgramOf(const PictureStage& stage) {
  const auto found = programs_.find(stage);
  if (found != programs_.end()) return found->second;
  const std::optional<PhaseKind> fog =
      scene_.fog ? std::optional(scene_.fog->phase.kind) : std::nullopt;
  const PictureKind kind{material_, &*lamp_painter_, fog};
  ShaderProgram made = FullScreenProgram(
      WithViewerPieces(PictureTexts(kind, stage), {"viewer/shaders/picture.frag.glsl"}));
  made.BindBlock("Air", kAirBinding);
  made.BindBlock("View", kViewBinding);
  made.BindBlock("Ground", kGroundBinding);
  made.BindBlock("GroundLight", kGroundLightBinding);
  made.BindBlock("GroundSurface", kGroundSurfaceBinding);
  made.BindSampler("surface_map", kSurfaceUnit);
  made.BindSampler("sky_on_surface", kSkyOnSurfaceUnit);
  made.BindSampler("shaft_map", kShaftUnit);
  AirTextures::Prepare(made, kAirUnit, kTablesBinding);
  if (stage.has_lamps) lamp_painter_->Connect(made);
  if (fog_) fog_->painter.Connect(made);
  return programs_.emplace(stage, std::move(made)).first->second;
}

void SkyPainter::Use(const PaintSizes& sizes) {
  if (fog_ && !(sizes.fog == sizes_.fog)) fog_->air = nullptr;
  sizes_ = sizes;
  air_.SetQuality(sizes.air);
  shade_.SetSize(sizes.shade.size);
  land_.SetDetail(sizes.land_detail);
}

void SkyPainter::FollowFog(const PaintedView& view, const SunPosition& sun, bool waits) {
  const FogView seen = FogViewOf(view, sun);
  const bool is_new_air = fog_->air != air_.air();
  if (is_new_air) {
    fog_->air = air_.air();
    fog_->follower.emplace([air = fog_->air, media = fog_->media, size = sizes_.fog,
                            latitude_rad = view.eye.place.latitude_rad](const FogView& wanted) {
      tbb::task_arena alone(1);
      return alone.execute([&] {
        const AirIntegrator<float> integrator(OnOsculatingSphere(air->medium, latitude_rad));
        return MakeFogMap(*media->fog(), media->fog_bottom_m(), integrator, air->diffuse, wanted,
                          size);
      });
    });
  }
  bool is_new = false;
  if (waits || is_new_air) {
    fog_->follower->Wait(seen);
    is_new = true;
  }
  is_new = fog_->follower->Follow(seen) || is_new;
  if (is_new && fog_->follower->map()) fog_->painter.Upload(*fog_->follower->map());
}

void SkyPainter::PrepareLamps(const PaintedView& view) {
  // Lamps dimmer than this are not seen beside what else there is.
  constexpr double kDimmest_cd_per_m2 = 1e-5;
  const LampView seen = LampViewFrom(lamp_ground_.frame, view.eye.place, PixelAngle(view));
  lamp_painter_->Prepare(lamps_, seen, kDimmest_cd_per_m2);
  if (lamp_painter_->IsDark() || lamp_painter_->quality() == sizes_.lamps) return;
  // Programs of another quality, now that they are needed.
  std::erase_if(programs_, [](const auto& made) { return made.first.has_lamps; });
  std::erase_if(ready_, [](const PictureStage& stage) { return stage.has_lamps; });
  lamp_painter_.emplace(lamps_, sizes_.lamps, kLampUnits);
  lamp_painter_->Prepare(lamps_, seen, kDimmest_cd_per_m2);
}

const SunPosition& SkyPainter::SunOf(const PaintedView& view) const {
  const bool is_known = sun_ && sun_->first.now == view.now && sun_->first.eye == view.eye;
  if (!is_known) sun_.emplace(view, ApparentSunAt(view.eye.place, view.now));
  return sun_->second;
}

void SkyPainter::TakeHeights() {
  if (heights_version_ == land_.heights_version()) return;
  heights_version_ = land_.heights_version();
  const GroundSampler sampler = land_.Sampler();
  ground_.SetGround(sampler);
  shade_.SetGround(sampler);
}

void SkyPainter::TakeLight() {
  land_.Relight(ground_.Light());
  if (ground_.sea_mirror().empty()) return;
  glActiveTexture(GL_TEXTURE0 + kUploadUnit);
  ground_textures_.SetSeaMirror(ground_.sea_mirror());
}

void SkyPainter::UploadMoon(const ShaderProgram& program) const {
  program.Use();
  glUniform4f(program.Uniform("moon"), static_cast<float>(moon_.to_moon.x),
              static_cast<float>(moon_.to_moon.y), static_cast<float>(moon_.to_moon.z),
              static_cast<float>(moon_.radius_rad));
  glUniform4f(program.Uniform("moon_lit"), static_cast<float>(moon_.to_sun.x),
              static_cast<float>(moon_.to_sun.y), static_cast<float>(moon_.to_sun.z),
              static_cast<float>(moon_.radiance_per_irradiance));
}

void SkyPainter::Update(const PaintedView& view, double seconds) {
  const SunPosition sun = SunOf(view);
  Begin("update");
  air_.Follow(AirViewOf(view, sun));
  land_.Update(view.eye.place, LandViewOf(view), seconds);
  TakeHeights();
  if (ground_.Follow(air_.air(), {view.eye.place, sun, view.now})) TakeLight();
  if (sizes_.has_shafts) shade_.Follow(view.eye.place, sun, kShadeUnit);
  if (fog_) FollowFog(view, sun, false);
}

void SkyPainter::Settle(const PaintedView& view, int samples) {
  const SunPosition sun = SunOf(view);
  air_.Settle(AirViewOf(view, sun));
  land_.Settle(view.eye.place, LandViewOf(view, samples));
  TakeHeights();
  if (ground_.Settle(air_.air(), {view.eye.place, sun, view.now})) {
    TakeLight();
    land_.Settle(view.eye.place, LandViewOf(view, samples));
  }
  if (sizes_.has_shafts) shade_.Settle(view.eye.place, sun, kShadeUnit);
  if (fog_) FollowFog(view, sun, true);
}

void SkyPainter::UploadAir(const PaintedView& view) {
  const Medium& medium = air_.air()->medium;
  auto& [air, block] = air_block_;
  if (air != air_.air()) block = AirBlockOf(medium);
  air = air_.air();
  block.shell.x =
      static_cast<float>(OnOsculatingSphere(medium, view.eye.place.latitude_rad).planet_radius_m /
                         kMetresPerKilometre);
  UploadBlock(blocks_.air, kAirBinding, &block, sizeof(block));
}

void SkyPainter::UploadView(const PaintedView& view, const glm::dvec2& shift) const {
  const LandView axes = LandViewOf(view);
  const SunPosition sun = SunOf(view);
  const glm::dvec2 moved(view.part.x * view.part.z + shift.x, view.part.y * view.part.w + shift.y);
  glm::vec4 irradiance = GpuBandsOf(air_.air()->medium.solar_irradiance);
  irradiance /= static_cast<float>(sun.distance_au * sun.distance_au);
  const double radius_km =
      OnOsculatingSphere(air_.air()->medium, view.eye.place.latitude_rad).planet_radius_m /
      kMetresPerKilometre;
  const ViewBlock block{
      {glm::vec3(axes.right), 0.0F},
      {glm::vec3(axes.up), 0.0F},
      {glm::vec3(axes.forward), 0.0F},
      {glm::vec3(DirectionFromAngles(sun.elevation_rad, sun.azimuth_rad).xyz),
       sun.angular_radius_rad},
      irradiance,
      {std::max(view.eye.place.height_m, 0.0) / kMetresPerKilometre, moved.x, moved.y, radius_km}};
  UploadBlock(blocks_.view, kViewBinding, &block, sizeof(block));
}

void SkyPainter::UploadGround(const PaintedView& view) const {
  GeodeticPosition origin = scene_.place;
  origin.height_m = 0.0;
  const LocalFrame pattern(ellipsoid_, origin), here(ellipsoid_, view.eye.place);
  const Medium& medium = air_.air()->medium;
  const MountainSurface surface(medium.wavelengths_nm,
                                CoverInSeason(origin.latitude_rad, view.now.modified_julian_day));
  const double radius =
      medium.follows_wgs84 ? OsculatingRadius(kWgs84, origin.latitude_rad) : medium.planet_radius_m;
  const glm::dvec3 eye = pattern.EnuFromGeodetic(view.eye.place).xyz;
  const double east_m = origin.longitude_rad * std::cos(origin.latitude_rad) * radius + eye.x;
  const double north_m = origin.latitude_rad * radius + eye.y;
  GroundBlock block = GroundBlockOf(surface, east_m, north_m, true);
  const auto axis = [&](const glm::dvec3& of_pattern) {
    return glm::vec4(here.EnuFromEcef(pattern.EcefFromEnu(Vector<Enu>{of_pattern})).xyz, 0.0);
  };
  block.cover_lines.w = static_cast<float>(sizes_.dropped_octaves);
  block.mesh_east = axis({1.0, 0.0, 0.0});
  block.mesh_north = axis({0.0, 1.0, 0.0});
  block.mesh_up = axis({0.0, 0.0, 1.0});
  UploadBlock(blocks_.ground, kGroundBinding, &block, sizeof(block));
  const double pixel_rad = PixelAngle(view);
  const SunPosition sun = SunOf(view);
  const glm::dvec3 to_sun = DirectionFromAngles(sun.elevation_rad, sun.azimuth_rad).xyz;
  const GroundLightBlock light =
      ground_.lit()
          ? GroundLightBlockOf(ground_.lit()->tilt(), to_sun, sizes_.relief_pixels * pixel_rad)
          : GroundLightBlock{};
  UploadBlock(blocks_.ground_light, kGroundLightBinding, &light, sizeof(light));
  GroundSurfaceBlock cover = GroundSurfaceBlockOf(material_);
  if (drape_.colours) cover = Draped(cover, drape_.place, eye.x, eye.y);
  UploadBlock(blocks_.ground_surface, kGroundSurfaceBinding, &cover, sizeof(cover));
}

void SkyPainter::PaintLand(const PaintedView& view) {
  Begin("land");
  Fit(surface_, view.width, view.height);
  surface_->Bind();
  land_.Draw(kViewBinding, view.part);
  surface_->BindTexture(kSurfaceUnit, SurfaceMap::kSurface);
  surface_->BindTexture(kSkyOnSurfaceUnit, SurfaceMap::kSky);
}

void SkyPainter::PaintShafts(const PaintedView& view) {
  if (!sizes_.has_shafts || !shade_.shade().Shades()) return;
  Begin("shafts");
  shaft_pass_.Paint(shade_.shade(), shade_.MapFromEye(view.eye.place), view.width, view.height,
                    kSurfaceUnit, kShadeUnit, sizes_.shade.detail);
}

void SkyPainter::PaintLamps(const PaintedView& view) {
  if (lamp_painter_->IsDark()) return;
  Begin("lamps");
  lamp_painter_->PaintGlow(view.width, view.height);
}

void SkyPainter::PaintStage(const PictureStage& stage, GLenum land) {
  const ShaderProgram& program = ProgramOf(stage);
  ground_textures_.Bind(program, kGroundUnit);
  if (stage.has_shade) shaft_pass_.Bind(program, kShaftUnit);
  program.Use();
  if (stage.pass == PictureStage::Pass::kDisks)
    glUniform1f(program.Uniform("ray_angle"), static_cast<float>(ray_angle_rad_));
  glDepthFunc(land);
  DrawFullScreen(program, no_vertices_);
  ready_.insert(stage);
}

// Drivers finish a program when it is drawn with, which takes tenths of a second: of stages that
// will be needed when shade begins or ends, or a disk comes into view, that is done in the first
// frames, over one pixel that is painted after. Whether it was to be done.
bool SkyPainter::MakeReady(const PictureStage& stage, GLenum land) {
  if (ready_.contains(stage) || (stage.has_shade && !shaft_pass_.HasMap())) return false;
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, 1, 1);
  PaintStage(stage, land);
  glDisable(GL_SCISSOR_TEST);
  return true;
}

void SkyPainter::PaintDisk(const glm::dvec3& direction, double radius_rad,
                           const PaintedView& view) {
  const LandView axes = LandViewOf(view);
  const double along = glm::dot(direction, axes.forward);
  if (along <= 0.0) return;
  const auto pixel = [&](const glm::dvec3& axis, double part, int side) {
    const double at = glm::dot(direction, axis) / glm::dot(axis, axis) / along - part;
    return 0.5 * side * (1.0 + at);
  };
  const double x = pixel(axes.right, view.part.x * view.part.z, view.width);
  const double y = pixel(axes.up, view.part.y * view.part.w, view.height);
  // Twice the radius: off the middle of the view disks are drawn out.
  const double reach = 2.0 * radius_rad / PixelAngle(view) / along + 2.0;
  if (x < -reach || y < -reach || x > view.width + reach || y > view.height + reach) return;
  glEnable(GL_SCISSOR_TEST);
  glScissor(static_cast<GLint>(std::floor(x - reach)), static_cast<GLint>(std::floor(y - reach)),
            static_cast<GLsizei>(std::ceil(2.0 * reach)) + 1,
            static_cast<GLsizei>(std::ceil(2.0 * reach)) + 1);
  PaintStage({PictureStage::Pass::kDisks}, GL_EQUAL);
  glDisable(GL_SCISSOR_TEST);
}

void SkyPainter::PaintPicture(const PaintedView& view, double share) {
  Begin("picture");
  picture_->Bind();
  picture_->UseDepthOf(*surface_);
  lamp_painter_->Bind();
  if (fog_) fog_->painter.Bind(*fog_->follower->map(), FogViewOf(view, SunOf(view)));
  const bool has_shade = sizes_.has_shafts && shade_.shade().Shades();
  const bool has_lamps = !lamp_painter_->IsDark();
  // Fragments of depth 0 against that of the land: it is nearer, or there is none.
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  const auto weight = static_cast<float>(share);
  glBlendColor(weight, weight, weight, weight);
  glBlendFunc(GL_CONSTANT_ALPHA, GL_ONE);
  if (share < 1.0) glEnable(GL_BLEND);
  if (share == 1.0 && !MakeReady({PictureStage::Pass::kLand, !has_shade, has_lamps}, GL_LESS))
    MakeReady({PictureStage::Pass::kSky, !has_shade, has_lamps}, GL_EQUAL);
  PaintStage({PictureStage::Pass::kLand, has_shade, has_lamps}, GL_LESS);
  PaintStage({PictureStage::Pass::kSky, has_shade, has_lamps}, GL_EQUAL);
  glEnable(GL_BLEND);
  UploadMoon(ProgramOf({PictureStage::Pass::kDisks}));
  if (share == 1.0) MakeReady({PictureStage::Pass::kDisks}, GL_EQUAL);
  const SunPosition& sun = SunOf(view);
  PaintDisk(DirectionFromAngles(sun.elevation_rad, sun.azimuth_rad).xyz, sun.angular_radius_rad,
            view);
  PaintDisk(moon_.to_moon, moon_.radius_rad, view);
  glDisable(GL_BLEND);
  glDisable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
}

void SkyPainter::Paint(const PaintedView& view, int samples) {
  Fit(picture_, view.width, view.height);
  UploadAir(view);
  UploadGround(view);
  ray_angle_rad_ = PixelAngle(view) / std::sqrt(samples);
  moon_ = ApparentMoonDisk(view.eye.place, view.now, SunOf(view).distance_au);
  PrepareLamps(view);
  air_.textures().Bind(kAirUnit, kTablesBinding);
  picture_->Bind();
  glClearColor(0.0F, 0.0F, 0.0F, 0.0F);
  if (samples > 1) glClear(GL_COLOR_BUFFER_BIT);
  for (int sample = 0; sample < samples; ++sample) {
    UploadView(view, ShiftOf(sample, samples, view));
    PaintLand(view);
    PaintShafts(view);
    PaintLamps(view);
    PaintPicture(view, 1.0 / samples);
  }
  if (!lamp_painter_->IsDark()) {
    Begin("lamps over");
    lamp_painter_->PaintOver(PixelAngle(view));
  }
  EndTime();
  CheckGl("SkyPainter::Paint");
}

void SkyPainter::Show(const Image& image) {
  Fit(picture_, image.width, image.height);
  picture_->Write(image);
}

}  // namespace alpenglow
