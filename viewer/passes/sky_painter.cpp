// SPDX-License-Identifier: MIT
#include "viewer/passes/sky_painter.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/sky_bodies.h"
#include "atmosphere/math/constants.h"
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
  const MediaKind media = scene.media().kind();
  if (media.has_layer)
    for (ShaderPiece& piece : MediaTexts(media)) texts.push_back(std::move(piece));
  ShaftPass pass(std::move(texts), media.has_layer);
  pass.program().BindBlock("View", kViewBinding);
  AirTextures::Prepare(pass.program(), kAirUnit, kTablesBinding);
  scene.media().Connect(pass.program());
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

}  // namespace

SkyPainter::SkyPainter(const Scene& scene, const LandSource& land, const PaintedView& first,
                       const PaintSizes& sizes, FirstAir first_air)
    : scene_(scene, land, first, sizes, std::move(first_air)),
      lamps_(scene, scene_.fixed().lamp_ground,
             OnOsculatingSphere(scene.medium, scene.place.latitude_rad())),
      lamp_painter_(lamps_, sizes.lamps, kLampUnits),
      shaft_pass_(ConnectedShafts(scene_)),
      cloud_pass_(ConnectedClouds()),
      night_sky_map_({scene.town_zenith,
                      std::max(GroundHeightUnder(scene_.fixed().lamp_ground, scene.place), 0.0)}),
      has_towns_(scene.town_zenith.has_value()),
      programs_(scene_, lamp_painter_, shaft_pass_, cloud_pass_) {
  CheckGl("SkyPainter");
}

void SkyPainter::Update(const PaintedView& view, double seconds) {
  Begin("update");
  const std::shared_ptr<const FrameSky> sky = SkyAt(view.eye.place, view.now);
  scene_.Update(view, *sky, seconds);
  continues_ = true;
  stars_.Follow(view, *sky, scene_.air().air());
  // After a jump in time into the night, wait for the first map.
  if (HasNightSkyMap()) night_sky_map_.Follow(view, scene_.air().air(), !night_sky_map_.HasAny());
}

void SkyPainter::WaitUntilReady(const PaintedView& view, int samples) {
  const std::shared_ptr<const FrameSky> before = SkyAt(view.eye.place, view.now);
  scene_.WaitUntilReady(view, before->lights, samples);
  continues_ = false;
  lamps_.WaitForPlans();
  // The medium may be another one now.
  const std::shared_ptr<const FrameSky> sky = SkyAt(view.eye.place, view.now);
  stars_.WaitUntilReady(view, *sky, scene_.air().air());
  if (HasNightSkyMap()) night_sky_map_.Follow(view, scene_.air().air(), true);
}

void SkyPainter::PrepareLamps(const Frame& frame) {
  if (lamps_.IsDark()) return lamp_painter_.PutOut();
  // Lamps dimmer than this are invisible against other light.
  constexpr double kDimmest_cd_per_m2 = 1e-5;
  const LampView seen =
      LampViewFrom(scene_.fixed().lamp_ground.frame, frame.view.eye.place, PixelAngle(frame.view));
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

Frame SkyPainter::FrameOf(const PaintedView& view) {
  return viewer::FrameOf(view, SkyAt(view.eye.place, view.now),
                         BendOf(view, scene_.air().air()->medium(), scene_.land().farthest_m()));
}

LandLook SkyPainter::LookOfLand(const Frame& frame) {
  return {frame.bend.has_value(), OfSource(frame.lights(), LightSource::kMoon) != nullptr};
}

void SkyPainter::PaintLand(const Frame& frame) {
  Begin("land");
  Fit(surface_, frame.view.width, frame.view.height);
  surface_->Bind();
  if (scene_.AwaitsLand()) {
    LandPass::Clear(LandDrawn::kSurface);
  } else {
    scene_.land().Draw(LandDrawn::kSurface, kViewBinding, LookOfLand(frame));
    if (programs_.HasPainted()) scene_.land().pass().MakeOneReady();
  }
  surface_->BindTexture(kSurfaceUnit, GBuffer::kSurface);
}

void SkyPainter::PaintOutline(const DepthPrepass& outline) {
  Begin("outline");
  outline.Bind();
  if (scene_.AwaitsLand()) return LandPass::Clear(LandDrawn::kOutline);
  scene_.land().Draw(LandDrawn::kOutline, kViewBinding, {painted_ && painted_->bend, false});
}

bool SkyPainter::HasShade(const Frame& frame) const {
  const ShadeFollower& shade = scene_.shade();
  return !scene_.AwaitsLand() && scene_.sizes().has_shafts && shade.shade().Shades() &&
         shade.IsOf(frame.view.eye.place, frame.key_light());
}

void SkyPainter::PaintShafts(const Frame& frame) {
  if (!HasShade(frame)) return;
  Begin("shafts");
  const ShadeFollower& shade = scene_.shade();
  shaft_pass_.Paint(shade.shade(), shade.MapFromEye(frame.view.eye.place), frame.view.width,
                    frame.view.height, kSurfaceUnit, kShadeUnit, scene_.sizes().shade.detail);
}

namespace {

// Returns the matrix from directions to points of a picture, times the distance along the view.
glm::mat3 ScreenFromDirection(const PaintedView& view) {
  const ViewAxes axes = AxesOf(view);
  const auto along = [](const glm::dvec3& axis) { return axis / glm::dot(axis, axis); };
  const glm::dvec3 x = along(axes.right) - view.part.x * view.part.z * axes.forward;
  const glm::dvec3 y = along(axes.up) - view.part.y * view.part.w * axes.forward;
  return glm::transpose(glm::mat3(x, y, axes.forward));
}

}  // namespace

void SkyPainter::PaintClouds(const Frame& frame) {
  if (!scene_.clouds().IsShown()) return;
  Begin("clouds");
  const auto& [width, height] = std::pair{frame.view.width, frame.view.height};
  const CloudFrame gathered{width, height, ScreenFromDirection(frame.view),
                            frame.view.eye.place.height_m, std::exchange(continues_, false)};
  cloud_pass_.Gather(scene_.clouds(),
                     scene_.clouds().BlockFor(frame.view.eye.place, frame.view.now), gathered,
                     scene_.sizes().clouds);
  Begin("cloud colours");
  cloud_pass_.Colour(scene_.clouds(), frame.lights().size() > 1, width, height);
}

void SkyPainter::PaintLamps(const Frame& frame) {
  if (!HasLamps()) return;
  Begin("lamps");
  lamp_painter_.PaintGlow(frame.view.width, frame.view.height);
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
SkyPainter::DisksInAir SkyPainter::InAir(const Frame& frame) {
  const PaintedView& view = frame.view;
  const FrameSky& sky = *frame.sky;
  const auto follow = [&](RefractedDiskFollower& follower, const glm::dvec3& apparent,
                          double radius) -> const RefractedDisk* {
    if (!PixelsOfDisk(apparent, radius, view)) return nullptr;
    return follower.Follow(scene_.air().air(), view.eye.place.height_m,
                           std::asin(std::clamp(apparent.z, -1.0, 1.0)), radius,
                           0.5 * PixelAngle(view));
  };
  DisksInAir seen{
      sky.sun, sky.moon.value_or(MoonDisk{}),
      follow(refracted_sun_, DirectionOf(sky.sun).seen, sky.sun.angular_radius_rad()),
      sky.moon ? follow(refracted_moon_, sky.moon->direction.seen, sky.moon->radius_rad) : nullptr};
  if (sky.is_eclipse) seen.refracted_moon = seen.refracted_sun;
  if (seen.refracted_sun != nullptr) seen.sun = sky.bodies.sun;
  if (seen.refracted_moon != nullptr) seen.moon.direction.seen = DirectionOf(sky.bodies.moon).seen;
  return seen;
}

PictureStage SkyPainter::StageOfDisks() const {
  PictureStage stage{PictureStage::Pass::kDisks};
  stage.cloud_layers = static_cast<int>(scene_.clouds().layers());
  return stage;
}

// @param shares  factors of the light of sun and moon.
void SkyPainter::DescribeDisks(const DisksInAir& seen, const glm::dvec2& shares) {
  const MoonDisk& moon = seen.moon;
  const PictureStage stage = StageOfDisks();
  const ShaderProgram& program = programs_.Of(stage);
  program.Use();
  glUniform4f(program.Uniform("moon"), static_cast<float>(moon.direction.seen.x),
              static_cast<float>(moon.direction.seen.y), static_cast<float>(moon.direction.seen.z),
              static_cast<float>(moon.radius_rad));
  glUniform4f(program.Uniform("moon_lit"), static_cast<float>(moon.to_sun.x),
              static_cast<float>(moon.to_sun.y), static_cast<float>(moon.to_sun.z),
              static_cast<float>(moon.radiance_per_irradiance));
  const glm::vec4 colour =
      GpuBandsOf(MoonColour(moon, scene_.air().air()->medium().wavelengths_nm));
  glUniform4f(program.Uniform("moon_colour"), colour.x, colour.y, colour.z, colour.w);
  glUniform1f(program.Uniform("moon_earthshine"),
              static_cast<float>(moon.earthshine_per_irradiance));
  glUniform2f(program.Uniform("disk_shares"), static_cast<float>(shares.x),
              static_cast<float>(shares.y));
  if (stage.cloud_layers > 0) {
    const glm::mat3 screen = ScreenFromDirection(painted_->view);
    glUniformMatrix3fv(program.Uniform("cloud_screen_from_direction"), 1, GL_FALSE, &screen[0][0]);
  }
  SendAir(program, seen.refracted_sun != nullptr ? *seen.refracted_sun : kUnbent,
          seen.refracted_moon != nullptr ? *seen.refracted_moon : kUnbent);
}

namespace {

// Returns the stages that may follow a stage, for all passes, the most urgent first.
std::vector<PictureStage> StagesAfter(const PictureStage& stage, const FrameSky& sky) {
  using enum PictureStage::Pass;
  // From this elevation on, the moon or the night sky may soon become lights.
  constexpr double kBeforeDusk_rad = 5.0 * kRadiansPerDegree;
  std::vector<PictureStage> next(5, stage);
  next[1].has_shade = !stage.has_shade;
  next[2].two_lights = !stage.two_lights;
  next[3].has_night = !stage.has_night;
  next[4].other_has_set = !stage.other_has_set;
  if (!sky.moon || sky.sun.elevation_rad() > kBeforeDusk_rad) next.resize(2);
  std::vector<PictureStage> stages;
  for (const PictureStage& one : next)
    for (const PictureStage::Pass pass : {kSky, kUnoccludedSky, kLand})
      stages.push_back(one.In(pass));
  PictureStage disks{kDisks};
  disks.cloud_layers = stage.cloud_layers;
  stages.insert(stages.begin() + 3, disks);
  return stages;
}

}  // namespace

// Prepares one stage per frame, since each takes tenths of a second.
void SkyPainter::MakeOneReady(const Frame& frame, const PictureStage& stage) {
  for (const PictureStage& next : StagesAfter(stage, *frame.sky))
    if (programs_.MakeReady(programs_.Fitting(next))) return;
  stars_.MakeReady(frame.view, scene_.media());
}

// Returns the number of rows below the horizon. The horizon is that of straight rays over a planet
// with the apparent radius.
int SkyPainter::RowsUnderHorizon(const Frame& frame) const {
  return RowsOfPlanet(frame.view, frame.bend
                                      ? frame.bend->look_radius_km
                                      : RadiusUnder(frame.view.eye, scene_.air().air()->medium()));
}

// Returns the number of rows with the planet's ground. Before land is loaded, sky is drawn in its
// place.
int SkyPainter::RowsOfGround(const Frame& frame) const {
  return scene_.AwaitsLand() ? 0 : RowsUnderHorizon(frame);
}

// Draws the sky in two parts, since software drivers evaluate the planet for every pixel of a
// program that includes it.
void SkyPainter::PaintSky(const Frame& frame, const PictureStage& stage) {
  using enum PictureStage::Pass;
  const PaintedView& view = frame.view;
  const int rows = RowsOfGround(frame);
  if (rows > 0) {
    const Scissor below({0, 0, view.width, rows});
    programs_.Paint(stage.In(kSky));
  }
  if (rows < view.height) {
    const Scissor above({0, rows, view.width, view.height - rows});
    programs_.Paint(stage.In(kUnoccludedSky));
  }
}

namespace {

// Returns the boxes of disks, of which two that overlap become one: light is added in every box, so
// a pixel must not lie in two.
std::vector<PixelBox> BoxesAround(const std::vector<SkyDisk>& disks, const PaintedView& view) {
  std::vector<PixelBox> boxes;
  for (const SkyDisk& disk : disks) {
    const PixelBox box = *PixelsOfDisk(disk.towards, disk.radius_rad, view);
    if (!boxes.empty() && Overlap(boxes.back(), box)) {
      boxes.back() = Around(boxes.back(), box);
    } else {
      boxes.push_back(box);
    }
  }
  return boxes;
}

}  // namespace

std::vector<PixelBox> SkyPainter::BodiesSeen(const PaintedView& view) {
  const Frame frame = FrameOf(view);
  std::vector<PixelBox> boxes = BoxesAround(frame.disks, view);
  const std::vector<PixelBox> stars = stars_.Seen(view, *frame.sky);
  boxes.insert(boxes.end(), stars.begin(), stars.end());
  return boxes;
}

// The sun's disk always uses sunlight, even if the moon lights the air.
void SkyPainter::UploadDisks(const Frame& frame, const DisksInAir& seen, const PixelRay& ray) {
  blocks_.UploadView(scene_, frame, ray, {{SunlightOf(seen.sun, scene_.air().air()->medium())}});
}

// Draws the disks that are large enough for the rays of the view.
void SkyPainter::PaintDisks(const Frame& frame, const PixelRay& ray) {
  const DisksInAir seen = InAir(frame);
  UploadDisks(frame, seen, ray);
  std::vector<SkyDisk> disks = frame.disks;
  std::erase_if(disks, [&](const SkyDisk& disk) {
    return IsSmallDisk(disk.towards, disk.radius_rad, frame.view);
  });
  if (disks.empty()) return;
  const auto share = [&](LightSource of) {
    return std::any_of(disks.begin(), disks.end(),
                       [&](const SkyDisk& disk) { return disk.of == of; })
               ? 1.0
               : 0.0;
  };
  DescribeDisks(seen, {share(LightSource::kSun), share(LightSource::kMoon)});
  const BesideLand beside;
  const Blending adding(Blending::Kind::kAdd, 1.0 / ray.of);
  for (const PixelBox& box : BoxesAround(disks, frame.view)) {
    const Scissor within(box);
    programs_.Paint(StageOfDisks());
  }
}

// Draws one disk and the land before it in the view of this disk.
void SkyPainter::PaintAlone(const SkyDisk& disk, double drawn_rad, const Frame& alone) {
  DisksInAir seen = InAir(alone);
  glm::dvec2 shares(1.0, 0.0);
  if (disk.of == LightSource::kSun) {
    seen.sun.angular_radius_deg =
        drawn_rad / kRadiansPerDegree;  // the sun has its whole irradiance at any size
  } else {
    seen.moon.radius_rad = drawn_rad;
    shares = {0.0, std::pow(disk.radius_rad / drawn_rad, 2)};
  }
  UploadDisks(alone, seen, {});
  small_disk_painter_.outline().Bind();
  if (scene_.AwaitsLand()) {
    LandPass::Clear(LandDrawn::kOutline);
  } else {
    scene_.land().Draw(LandDrawn::kOutline, kViewBinding, {alone.bend.has_value(), false},
                       AxesOf(alone.view));
  }
  small_disk_painter_.light().Bind();
  glClearColor(0.0F, 0.0F, 0.0F, 0.0F);
  glClear(GL_COLOR_BUFFER_BIT);
  DescribeDisks(seen, shares);
  const BesideLand beside;
  programs_.Paint(StageOfDisks());
}

// Adds the light of the other disks.
void SkyPainter::PaintSmallDisks(const Frame& frame, const RenderTarget& target) {
  const PaintedView& view = frame.view;
  for (const SkyDisk& disk : frame.disks) {
    if (!IsSmallDisk(disk.towards, disk.radius_rad, view)) continue;
    const double drawn_rad = std::max(disk.radius_rad, SmallDiskPainter::SmallestRadius(view));
    const PaintedView alone = SmallDiskPainter::ViewOf(disk.towards, drawn_rad, view);
    PaintAlone(disk, drawn_rad, FrameOf(alone));
    target.Bind();
    UploadDisks(frame, InAir(frame), {});
    const Blending adding(Blending::Kind::kAdd, 1.0);
    const Scissor within(*PixelsOfDisk(disk.towards, drawn_rad, view));
    small_disk_painter_.AddTo(view, alone);
  }
}

void SkyPainter::PaintBodiesOver(const RenderTarget& target, const DepthPrepass& outline,
                                 const PaintedView& view) {
  const Frame frame = FrameOf(view);
  target.Bind();
  target.UseDepthOf(outline);
  PaintDisks(frame, {});
  PaintSmallDisks(frame, target);
  if (stars_.HasAny()) {
    const BesideLand beside;
    stars_.Paint(view, *frame.sky, StarPainter::Land::kByDepth, scene_.media());
  }
  CheckGl("SkyPainter::PaintBodiesOver");
}

LightsOfView SkyPainter::LightsOf(const Frame& frame) {
  LightsOfView lights{frame.lights()};
  if (!HasNightSkyMap()) return lights;
  lights.night_scattered = night_sky_map_.scattered();
  lights.night_level = night_sky_map_.level();
  return lights;
}

// Binds the inputs that depend on the lights of the sky.
void SkyPainter::BindLights(const Frame& frame, const PixelRay& ray) {
  const LightSource first = frame.lights().front().body, other = frame.lights().back().body;
  blocks_.UploadView(scene_, frame, ray, LightsOf(frame));
  blocks_.UploadGroundLight(scene_, frame);
  scene_.air_textures(first).Bind(kAirUnit, kTablesBinding);
  scene_.air_textures(other).Bind(kOtherAirUnit, kOtherTablesBinding);
  scene_.ground_textures().Bind(kGroundUnit, first, other);
  blocks_.UploadSkyByPixel(scene_, frame);
  if (const SkyByPixel* const sky = scene_.sky_by_pixel(first)) sky->Bind(kSkyByPixelUnit, first);
  if (const SkyByPixel* const sky = scene_.sky_by_pixel(other))
    sky->BindOther(kSkyByPixelUnit, other);
}

// Binds the inputs that are pictures of land or that passes before the picture may have replaced.
void SkyPainter::BindMaps(const Frame& frame) {
  const DistantLight &first = frame.lights().front(), &other = frame.lights().back();
  const auto sky_of = [](const DistantLight& light) {
    return light.body == LightSource::kMoon ? GBuffer::kMoonSky : GBuffer::kSky;
  };
  surface_->BindTexture(kSkyOnSurfaceUnit, sky_of(first));
  surface_->BindTexture(kOtherSkyOnSurfaceUnit, sky_of(other));
  night_sky_map_.Bind(kNightUnit);
  scene_.media().Bind(frame.view.eye, first, other);
}

// Refraction lets the planet be seen farther than its straight horizon, by less than a quarter.
GroundReach SkyPainter::ReachOf(const PaintedView& view) const {
  constexpr double kMostByRefraction = 1.25;
  const double radius_km = RadiusUnder(view.eye, scene_.air().air()->medium());
  const double altitude_km = std::max(view.eye.place.height_m, 0.0) / kMetresPerKilometre;
  return {scene_.land().farthest_m() / (radius_km * kMetresPerKilometre),
          kMostByRefraction * std::acos(radius_km / (radius_km + altitude_km))};
}

PictureStage SkyPainter::StageOf(const Frame& frame) {
  PictureStage stage{PictureStage::Pass::kLand};
  stage.has_shade = HasShade(frame);
  stage.has_lamps = HasLamps();
  stage.two_lights = frame.lights().size() > 1;
  const DistantLight& other = frame.lights().back();
  stage.other_has_set = stage.two_lights && HasSetOnGround(other, ReachOf(frame.view)) &&
                        scene_.air_textures(other.body).IsOfSetSun();
  stage.has_night = HasNightSkyMap() && night_sky_map_.HasAny();
  stage.sky_by_pixel = HasSkyByPixel(scene_, frame.lights());
  stage.cloud_layers = static_cast<int>(scene_.clouds().layers());
  return programs_.Fitting(stage);
}

void SkyPainter::PaintPicture(const Frame& frame, double share) {
  Begin("picture");
  picture_->Bind();
  picture_->UseDepthOf(*surface_);
  lamp_painter_.Bind();
  const BesideLand beside;
  std::optional<Blending> adding;
  if (share < 1.0) adding.emplace(Blending::Kind::kAdd, share);
  const PictureStage stage = StageOf(frame);
  if (share == 1.0 && programs_.HasPainted()) MakeOneReady(frame, stage);
  if (!scene_.AwaitsLand()) programs_.Paint(stage);
  PaintSky(frame, stage);
}

void SkyPainter::PaintLampsOver(const Frame& frame) {
  if (!HasLamps()) return;
  Begin("lamps over");
  lamp_painter_.PaintOver(PixelAngle(frame.view));
}

// In brighter light a thousandth of a lux is invisible, and so is light pollution.
bool SkyPainter::HasNightSkyMap() const {
  constexpr double kMost_lux = 10.0, kMostOverTowns_lux = 1000.0;
  return stars_.sky_lux() > 0.0 && stars_.sky_lux() < (has_towns_ ? kMostOverTowns_lux : kMost_lux);
}

void SkyPainter::PaintStars(const Frame& frame) {
  if (!stars_.HasAny()) return;
  Begin("stars");
  stars_.Paint(frame.view, *frame.sky, StarPainter::Land::kBySurface, scene_.media());
}

void SkyPainter::PaintSample(const Frame& frame, Bodies bodies, const PixelRay& ray) {
  BindLights(frame, ray);
  PaintLand(frame);
  PaintClouds(frame);
  BindMaps(frame);
  PaintShafts(frame);
  PaintLamps(frame);
  PaintPicture(frame, 1.0 / ray.of);
  if (bodies == Bodies::kAll) PaintDisks(frame, ray);
}

void SkyPainter::Paint(const PaintedView& view, int samples, Bodies bodies,
                       const std::function<void(int)>& after_sample) {
  const Frame& frame = painted_.emplace(FrameOf(view));
  Fit(picture_, view.width, view.height);
  blocks_.UploadAir(scene_, view.eye);
  blocks_.UploadGround(scene_, view);
  PrepareLamps(frame);
  picture_->Bind();
  glClearColor(0.0F, 0.0F, 0.0F, 0.0F);
  if (samples > 1) glClear(GL_COLOR_BUFFER_BIT);
  for (int sample = 0; sample < samples; ++sample) {
    PaintSample(frame, bodies, {sample, samples});
    if (after_sample) after_sample(sample + 1);
  }
  if (bodies == Bodies::kAll) PaintSmallDisks(frame, *picture_);
  PaintLampsOver(frame);
  if (bodies != Bodies::kNone) PaintStars(frame);
  if (timer_ != nullptr) timer_->End();
  CheckGl("SkyPainter::Paint");
}

void SkyPainter::Show(const HdrImage& image) {
  Fit(picture_, image.width, image.height);
  picture_->Write(image);
}

}  // namespace alpenglow::viewer
