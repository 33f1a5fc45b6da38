// SPDX-License-Identifier: MIT
#include "viewer/passes/sky_painter.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/sky_bodies.h"
#include "atmosphere/refraction/refracted_view.h"
#include "renderer/illumination/lighting.h"
#include "renderer/surface/scene_ground.h"
#include "viewer/gl/gl_context.h"
#include "viewer/passes/painted_view.h"
#include "viewer/passes/picture_programs.h"

namespace alpenglow::viewer {
namespace {

ShaftPass ConnectedShafts(const PaintedScene& scene) {
  std::vector<ShaderPiece> texts = AirTexts();
  if (scene.fixed().fog_phase)
    for (ShaderPiece& piece : FogTexts(*scene.fixed().fog_phase)) texts.push_back(std::move(piece));
  ShaftPass pass(std::move(texts), scene.fixed().fog_phase.has_value());
  pass.program().BindBlock("View", kViewBinding);
  AirTextures::Prepare(pass.program(), kAirUnit, kTablesBinding);
  if (scene.fog() != nullptr) scene.fog()->Connect(pass.program());
  return pass;
}

// Enables the depth test without depth writes: land is drawn over land, sky and disks elsewhere.
class BesideLand {
 public:
  BesideLand() {
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_FALSE);
  }
  ~BesideLand() {
    glDisable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
  }
  BesideLand(const BesideLand&) = delete;
  BesideLand& operator=(const BesideLand&) = delete;
};

// Enables additive blending with a weight.
class Adding {
 public:
  explicit Adding(double share) {
    const auto weight = static_cast<float>(share);
    glBlendColor(weight, weight, weight, weight);
    glBlendFunc(GL_CONSTANT_ALPHA, GL_ONE);
    glEnable(GL_BLEND);
  }
  ~Adding() { glDisable(GL_BLEND); }
  Adding(const Adding&) = delete;
  Adding& operator=(const Adding&) = delete;
};

}  // namespace

SkyPainter::SkyPainter(const Scene& scene, const LandSource& land, const PaintedView& first,
                       const PaintSizes& sizes, FirstAir first_air)
    : scene_(scene, land, first, sizes, std::move(first_air)),
      lamps_(scene, scene_.fixed().lamp_ground,
             OnOsculatingSphere(scene.medium, scene.place.latitude_rad)),
      lamp_painter_(lamps_, sizes.lamps, kLampUnits),
      shaft_pass_(ConnectedShafts(scene_)),
      night_sky_map_({scene.town_zenith,
                      std::max(GroundHeightUnder(scene_.fixed().lamp_ground, scene.place), 0.0)}),
      has_towns_(scene.town_zenith.has_value()),
      programs_(scene_, lamp_painter_, shaft_pass_) {
  CheckGl("SkyPainter");
}

const SkyPainter::Shining& SkyPainter::LightsOf(const PaintedView& view) {
  const std::shared_ptr<const SolvedAir>& air = scene_.air().air();
  const bool is_known = shining_ && shining_->view.now == view.now &&
                        shining_->view.eye == view.eye && shining_->air == air;
  if (!is_known) {
    const SunPosition sun = ApparentSunAt(view.eye.place, view.now, GentleAirOf(air->medium));
    shining_ = {view, sun, air, LightsOfSkyAt(view.eye.place, view.now, sun, *air)};
  }
  return *shining_;
}

void SkyPainter::Update(const PaintedView& view, double seconds) {
  const LightsOfSky& lights = LightsOf(view).lights;
  Begin("update");
  scene_.Update(view, lights, seconds);
  stars_.Follow(view, lights, *scene_.air().air());
  // After a jump in time into the night, wait for the first map.
  if (HasNightSkyMap()) night_sky_map_.Follow(view, scene_.air().air(), !night_sky_map_.HasAny());
}

void SkyPainter::WaitUntilReady(const PaintedView& view, int samples) {
  scene_.WaitUntilReady(view, LightsOf(view).lights, samples);
  lamps_.WaitForPlans();
  stars_.WaitUntilReady(view, LightsOf(view).lights, *scene_.air().air());
  if (HasNightSkyMap()) night_sky_map_.Follow(view, scene_.air().air(), true);
}

void SkyPainter::PrepareLamps(const PaintedView& view) {
  // Lamps dimmer than this are invisible against other light.
  constexpr double kDimmest_cd_per_m2 = 1e-5;
  const LampView seen =
      LampViewFrom(scene_.fixed().lamp_ground.frame, view.eye.place, PixelAngle(view));
  const PaintSizes& sizes = scene_.sizes();
  const bool suits = lamp_painter_.Suits(sizes.lamps);
  if (suits) lamp_painter_.SetStep(sizes.lamps.step);
  lamp_painter_.Prepare(lamps_, seen, kDimmest_cd_per_m2, sizes.most_lamps);
  if (lamp_painter_.IsDark() || suits) return;
  // Recreate the programs for another quality, now that they are needed.
  programs_.ForgetThoseWithLamps();
  lamp_painter_ = LampPainter(lamps_, sizes.lamps, kLampUnits);
  lamp_painter_.Prepare(lamps_, seen, kDimmest_cd_per_m2, sizes.most_lamps);
}

void SkyPainter::PaintLand(const PaintedView& view) {
  Begin("land");
  Fit(surface_, view.width, view.height);
  surface_->Bind();
  if (scene_.AwaitsLand()) {
    LandPass::Clear(LandDrawn::kSurface);
  } else {
    scene_.land().Draw(LandDrawn::kSurface, kViewBinding);
  }
  surface_->BindTexture(kSurfaceUnit, GBuffer::kSurface);
}

void SkyPainter::PaintOutline(const DepthPrepass& outline) {
  Begin("outline");
  outline.Bind();
  if (scene_.AwaitsLand()) return LandPass::Clear(LandDrawn::kOutline);
  scene_.land().Draw(LandDrawn::kOutline, kViewBinding);
}

bool SkyPainter::HasShade(const PaintedView& view, const SkyLight& key) const {
  const ShadeFollower& shade = scene_.shade();
  return !scene_.AwaitsLand() && scene_.sizes().has_shafts && shade.shade().Shades() &&
         shade.IsOf(view.eye.place, key.disk);
}

void SkyPainter::PaintShafts(const PaintedView& view) {
  if (!HasShade(view, LightsOf(view).lights.front())) return;
  Begin("shafts");
  const ShadeFollower& shade = scene_.shade();
  shaft_pass_.Paint(shade.shade(), shade.MapFromEye(view.eye.place), view.width, view.height,
                    kSurfaceUnit, kShadeUnit, scene_.sizes().shade.detail);
}

void SkyPainter::PaintLamps(const PaintedView& view) {
  if (!HasLamps()) return;
  Begin("lamps");
  lamp_painter_.PaintGlow(view.width, view.height);
}

namespace {

// Disk without refraction, drawn at its apparent position.
constexpr RefractedDisk kUnbent{};

void SendNodes(const ShaderProgram& program, const char* name,
               const std::array<glm::vec4, RefractedDisk::kNodes>& of_sun,
               const std::array<glm::vec4, RefractedDisk::kNodes>& of_moon) {
  std::array<glm::vec4, 2 * RefractedDisk::kNodes> both{};
  std::copy(of_sun.begin(), of_sun.end(), both.begin());
  std::copy(of_moon.begin(), of_moon.end(), both.begin() + RefractedDisk::kNodes);
  glUniform4fv(program.Uniform(name), static_cast<GLsizei>(both.size()), &both.front().x);
}

void SendAir(const ShaderProgram& program, const RefractedDisk& sun, const RefractedDisk& moon) {
  SendNodes(program, "disk_lift", sun.lift_rad, moon.lift_rad);
  SendNodes(program, "disk_depth", sun.more_depth, moon.more_depth);
  glUniform4f(program.Uniform("disk_nodes"), static_cast<float>(sun.first_rad),
              static_cast<float>(1.0 / sun.step_rad), static_cast<float>(moon.first_rad),
              static_cast<float>(1.0 / moon.step_rad));
}

}  // namespace

// If the moon covers part of the sun, both disks use the same refraction, so that their edges
// match.
SkyPainter::DisksInAir SkyPainter::InAir(const SkyDisks& disks, const PaintedView& view) {
  const auto follow = [&](RefractedDiskFollower& follower, const glm::dvec3& apparent,
                          double radius) -> const RefractedDisk* {
    if (!PixelsOfDisk(apparent, radius, view)) return nullptr;
    return follower.Follow(scene_.air().air(), view.eye.place.height_m,
                           std::asin(std::clamp(apparent.z, -1.0, 1.0)), radius,
                           0.5 * PixelAngle(view));
  };
  const GeodeticPosition& place = view.eye.place;
  DisksInAir seen{disks,
                  follow(refracted_sun_, DirectionToSun(disks.sun), disks.sun.angular_radius_rad),
                  follow(refracted_moon_, disks.moon.to_moon, disks.moon.radius_rad)};
  const MoonPosition moon = MoonAt(place, view.now);
  if (EclipsedDiskOf(disks.sun, moon).IsCovered()) seen.moon = seen.sun;
  if (seen.sun != nullptr) seen.disks.sun = SunAt(place, view.now);
  if (seen.moon != nullptr)
    seen.disks.moon.to_moon = DirectionFromAngles(moon.elevation_rad, moon.azimuth_rad).xyz;
  return seen;
}

void SkyPainter::DescribeDisks(const DisksInAir& seen) {
  const MoonDisk& moon = seen.disks.moon;
  const ShaderProgram& program = programs_.Of({PictureStage::Pass::kDisks});
  program.Use();
  glUniform4f(program.Uniform("moon"), static_cast<float>(moon.to_moon.x),
              static_cast<float>(moon.to_moon.y), static_cast<float>(moon.to_moon.z),
              static_cast<float>(moon.radius_rad));
  glUniform4f(program.Uniform("moon_lit"), static_cast<float>(moon.to_sun.x),
              static_cast<float>(moon.to_sun.y), static_cast<float>(moon.to_sun.z),
              static_cast<float>(moon.radiance_per_irradiance));
  const glm::vec4 colour = GpuBandsOf(MoonColour(moon, scene_.air().air()->medium.wavelengths_nm));
  glUniform4f(program.Uniform("moon_colour"), colour.x, colour.y, colour.z, colour.w);
  glUniform1f(program.Uniform("moon_earthshine"),
              static_cast<float>(moon.earthshine_per_irradiance));
  SendAir(program, seen.sun != nullptr ? *seen.sun : kUnbent,
          seen.moon != nullptr ? *seen.moon : kUnbent);
}

// Prepares one stage per frame, since each takes tenths of a second.
void SkyPainter::MakeOneReady(const PaintedView& view, bool has_shade, bool has_lamps) {
  using enum PictureStage::Pass;
  for (const PictureStage& stage :
       {PictureStage{kSky, has_shade, has_lamps},
        PictureStage{kUnoccludedSky, has_shade, has_lamps},
        PictureStage{kLand, !has_shade, has_lamps}, PictureStage{kSky, !has_shade, has_lamps},
        PictureStage{kUnoccludedSky, !has_shade, has_lamps}, PictureStage{kDisks},
        PictureStage{kNight}, PictureStage{kLand}, PictureStage{kSky},
        PictureStage{kUnoccludedSky}})
    if (programs_.MakeReady(stage)) return;
  stars_.MakeReady(view, scene_.fog(), scene_.fixed().fog_phase);
}

// Returns the number of rows below the horizon. The horizon is that of straight rays over a planet
// with the apparent radius.
int SkyPainter::RowsUnderHorizon(const PaintedView& view) const {
  const Medium& medium = scene_.air().air()->medium;
  const auto bend = BendOf(view, medium, scene_.land().farthest_m());
  return RowsOfPlanet(view, bend ? bend->look_radius_km : RadiusUnder(view.eye, medium));
}

// Returns the number of rows with the planet's ground. Before land is loaded, sky is drawn in its
// place.
int SkyPainter::RowsOfGround(const PaintedView& view) const {
  return scene_.AwaitsLand() ? 0 : RowsUnderHorizon(view);
}

// Draws the sky in two parts, since software drivers evaluate the planet for every pixel of a
// program that includes it.
void SkyPainter::PaintSky(const PaintedView& view, const Lit& lit) {
  using enum PictureStage::Pass;
  const int rows = RowsOfGround(view);
  if (rows > 0) {
    const Scissor below({0, 0, view.width, rows});
    programs_.Paint({kSky, lit.has_shade, lit.has_lamps}, lit.source);
  }
  if (rows < view.height) {
    const Scissor above({0, rows, view.width, view.height - rows});
    programs_.Paint({kUnoccludedSky, lit.has_shade, lit.has_lamps}, lit.source);
  }
}

void SkyPainter::PaintLandAndSky(const PaintedView& view, const Lit& lit) {
  if (!scene_.AwaitsLand())
    programs_.Paint({PictureStage::Pass::kLand, lit.has_shade, lit.has_lamps,
                     scene_.sizes().sky_by_pixel && scene_.sky_by_pixel(lit.source) != nullptr},
                    lit.source);
  PaintSky(view, lit);
}

std::vector<PixelBox> SkyPainter::DisksSeen(const PaintedView& view) {
  const SkyDisks disks = DisksOf(view);
  std::vector<PixelBox> boxes;
  const auto add = [&](const std::optional<PixelBox>& box) {
    if (box) boxes.push_back(*box);
  };
  add(PixelsOfDisk(DirectionToSun(disks.sun), disks.sun.angular_radius_rad, view));
  add(PixelsOfDisk(disks.moon.to_moon, disks.moon.radius_rad, view));
  return boxes;
}

std::vector<PixelBox> SkyPainter::BodiesSeen(const PaintedView& view) {
  std::vector<PixelBox> boxes = DisksSeen(view);
  const std::vector<PixelBox> stars = stars_.Seen(view, DisksOf(view).moon);
  boxes.insert(boxes.end(), stars.begin(), stars.end());
  return boxes;
}

// Draws the disks. The sun's disk always uses sunlight, even if the moon lights the air.
void SkyPainter::PaintDisks(const PaintedView& view, const PixelRay& ray) {
  const DisksInAir seen = InAir(DisksOf(view), view);
  const SkyLight sun = SunAsLight(seen.disks.sun, scene_.air().air()->medium);
  blocks_.UploadView(scene_, view, sun, ray);
  const std::vector<PixelBox> boxes = DisksSeen(view);
  if (boxes.empty()) return;
  const double share = 1.0 / ray.of;
  DescribeDisks(seen);
  const BesideLand beside;
  const Adding adding(share);
  for (const PixelBox& box : boxes) {
    const Scissor within(box);
    programs_.Paint({PictureStage::Pass::kDisks});
  }
}

void SkyPainter::PaintBodiesOver(const RenderTarget& target, const DepthPrepass& outline,
                                 const PaintedView& view) {
  target.Bind();
  target.UseDepthOf(outline);
  PaintDisks(view, {});
  if (stars_.HasAny()) {
    const BesideLand beside;
    stars_.Paint(view, DisksOf(view).moon, StarPainter::Land::kByDepth, scene_.fog(),
                 scene_.fixed().fog_phase);
  }
  CheckGl("SkyPainter::PaintBodiesOver");
}

// Binds the inputs that depend on one light of the sky.
void SkyPainter::BindLight(const PaintedView& view, const SkyLight& light, const PixelRay& ray) {
  blocks_.UploadView(scene_, view, light, ray);
  blocks_.UploadGroundLight(scene_, view, light);
  blocks_.UploadSkyByPixel(scene_, view, light);
  scene_.air_textures(light.source()).Bind(kAirUnit, kTablesBinding);
}

void SkyPainter::BindMaps(const PaintedView& view, const SkyLight& light) {
  surface_->BindTexture(kSkyOnSurfaceUnit, light.is_moon ? GBuffer::kMoonSky : GBuffer::kSky);
  if (scene_.fog() != nullptr) scene_.fog(light.source())->Bind(view.eye, light.disk);
}

void SkyPainter::PaintPicture(const PaintedView& view, double share) {
  Begin("picture");
  picture_->Bind();
  picture_->UseDepthOf(*surface_);
  lamp_painter_.Bind();
  const SkyLight& key = LightsOf(view).lights.front();
  const BesideLand beside;
  std::optional<Adding> adding;
  if (share < 1.0) adding.emplace(share);
  const Lit lit{key.source(), HasShade(view, key), HasLamps()};
  if (share == 1.0 && programs_.HasPainted()) MakeOneReady(view, lit.has_shade, lit.has_lamps);
  PaintLandAndSky(view, lit);
}

// Adds the lights that cast no shadows. The inverse depth of land in the fourth component is not
// written again.
void SkyPainter::PaintOtherLights(const PaintedView& view, const PixelRay& ray) {
  const LightsOfSky& lights = LightsOf(view).lights;
  if (lights.size() == 1) return;
  Begin("other light");
  for (std::size_t i = 1; i < lights.size(); ++i) {
    BindLight(view, lights[i], ray);
    BindMaps(view, lights[i]);
    const BesideLand beside;
    const Adding adding(1.0 / ray.of);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_FALSE);
    PaintLandAndSky(view, {lights[i].source(), false, false});
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  }
  BindLight(view, lights.front(), ray);
  BindMaps(view, lights.front());
}

void SkyPainter::PaintLampsOver(const PaintedView& view) {
  if (!HasLamps()) return;
  Begin("lamps over");
  lamp_painter_.PaintOver(PixelAngle(view));
}

// In brighter light a thousandth of a lux is invisible, and so is light pollution.
bool SkyPainter::HasNightSkyMap() const {
  constexpr double kMost_lux = 10.0, kMostOverTowns_lux = 1000.0;
  return stars_.sky_lux() > 0.0 && stars_.sky_lux() < (has_towns_ ? kMostOverTowns_lux : kMost_lux);
}

void SkyPainter::PaintNightSkyMap(const PaintedView& view, double share) {
  Begin("night sky");
  const BesideLand any_depth;
  const Adding adding(share);
  const PictureStage stage{PictureStage::Pass::kNight};
  std::optional<Scissor> above;
  if (scene_.AwaitsLand()) {
    const int rows = RowsUnderHorizon(view);
    above.emplace(PixelBox{0, rows, view.width, view.height - rows});
  }
  night_sky_map_.Bind(programs_.Of(stage), kNightUnit);
  programs_.Paint(stage);
}

void SkyPainter::PaintStars(const PaintedView& view, const MoonDisk& moon) {
  if (!stars_.HasAny()) return;
  Begin("stars");
  stars_.Paint(view, moon, StarPainter::Land::kBySurface, scene_.fog(), scene_.fixed().fog_phase);
}

void SkyPainter::PaintSample(const PaintedView& view, Bodies bodies, const PixelRay& ray) {
  BindLight(view, LightsOf(view).lights.front(), ray);
  PaintLand(view);
  BindMaps(view, LightsOf(view).lights.front());
  PaintShafts(view);
  PaintLamps(view);
  PaintPicture(view, 1.0 / ray.of);
  PaintOtherLights(view, ray);
  if (HasNightSkyMap() && night_sky_map_.HasAny()) PaintNightSkyMap(view, 1.0 / ray.of);
  if (bodies == Bodies::kAll) PaintDisks(view, ray);
}

SkyPainter::SkyDisks SkyPainter::DisksOf(const PaintedView& view) {
  const SunPosition& sun = LightsOf(view).sun;
  const SkyBodies bodies = SkyBodiesAt(view.eye.place, view.now);
  SkyDisks disks{sun, bodies.ApparentMoonDisk(GentleAirOf(scene_.air().air()->medium))};
  if (bodies.Eclipse().IsCovered()) disks.moon.to_moon = ToMoonBefore(sun, bodies);
  return disks;
}

void SkyPainter::Paint(const PaintedView& view, int samples, Bodies bodies,
                       const std::function<void(int)>& after_sample) {
  const SkyDisks disks = DisksOf(view);
  Fit(picture_, view.width, view.height);
  blocks_.UploadAir(scene_, view.eye);
  blocks_.UploadGround(scene_, view);
  PrepareLamps(view);
  picture_->Bind();
  glClearColor(0.0F, 0.0F, 0.0F, 0.0F);
  if (samples > 1) glClear(GL_COLOR_BUFFER_BIT);
  for (int sample = 0; sample < samples; ++sample) {
    PaintSample(view, bodies, {sample, samples});
    if (after_sample) after_sample(sample + 1);
  }
  PaintLampsOver(view);
  if (bodies != Bodies::kNone) PaintStars(view, disks.moon);
  if (timer_ != nullptr) timer_->End();
  CheckGl("SkyPainter::Paint");
}

void SkyPainter::Show(const Image& image) {
  Fit(picture_, image.width, image.height);
  picture_->Write(image);
}

}  // namespace alpenglow::viewer
