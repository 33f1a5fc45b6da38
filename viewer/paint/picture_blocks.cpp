// SPDX-License-Identifier: MIT
#include "viewer/paint/picture_blocks.h"

#include <algorithm>
#include <cmath>

#include "renderer/ground/surface.h"
#include "viewer/air/air_rows.h"
#include "viewer/ground/ground_block.h"
#include "viewer/paint/picture_units.h"
#include "viewer/paint/view_bend.h"

namespace alpenglow::viewer {
namespace {

template <typename Block>
void Upload(const GlBuffer& buffer, PictureBinding binding, const Block& block) {
  glBindBufferBase(GL_UNIFORM_BUFFER, binding, buffer.id());
  glBufferData(GL_UNIFORM_BUFFER, sizeof(block), &block, GL_DYNAMIC_DRAW);
}

// The frame of the ground's pattern, which a draped picture lies in too.
LocalFrame PatternOf(const PaintedScene& scene) {
  GeodeticPosition origin = scene.place();
  origin.height_m = 0.0;
  return {scene.ellipsoid(), origin};
}

// In the pattern.
GroundPoint OnPattern(const PaintedScene& scene, const glm::dvec3& eye, const UtcInstant& now) {
  const Medium& medium = scene.air().air()->medium;
  const GeodeticPosition& origin = scene.place();
  const double radius =
      medium.follows_wgs84 ? OsculatingRadius(kWgs84, origin.latitude_rad) : medium.planet_radius_m;
  GroundPoint at{origin.longitude_rad * std::cos(origin.latitude_rad) * radius + eye.x,
                 origin.latitude_rad * radius + eye.y, eye.z, 0.0};
  at.up_m = eye.z;
  at.sea_s = SeaTime(now);
  return at;
}

GroundBlock GroundAround(const PaintedScene& scene, const PaintedView& view) {
  const LocalFrame pattern = PatternOf(scene), here(scene.ellipsoid(), view.eye.place);
  const MountainSurface surface(scene.air().air()->medium.wavelengths_nm,
                                CoverInSeason(view.eye.place, view.now.modified_julian_day),
                                scene.material().cover().wetness);
  GroundBlock block = GroundBlockOf(
      surface, OnPattern(scene, pattern.EnuFromGeodetic(view.eye.place).xyz, view.now));
  const auto axis = [&](const glm::dvec3& of_pattern) {
    return glm::vec4(here.EnuFromEcef(pattern.EcefFromEnu(Vector<Enu>{of_pattern})).xyz, 0.0);
  };
  block.cover_lines.z = static_cast<float>(scene.sizes().dropped_octaves);
  block.mesh_east = axis({1.0, 0.0, 0.0});
  block.mesh_north = axis({0.0, 1.0, 0.0});
  block.mesh_up = axis({0.0, 0.0, 1.0});
  return block;
}

GroundLightBlock LightAround(const PaintedScene& scene, const PaintedView& view,
                             const KeyLight& light) {
  GroundLightBlock block = GroundLightBlockOf(scene.OpenSky(light.source()),
                                              DirectionToSun(light.disk), PixelAngle(view));
  block.ground_view.y = scene.HasEdgesOf(light.source()) ? 1.0F : 0.0F;
  return block;
}

GroundSurfaceBlock SurfaceAround(const PaintedScene& scene, const Eye& eye) {
  const GroundSurfaceBlock cover = GroundSurfaceBlockOf(scene.material());
  if (!scene.drape().colours) return cover;
  const glm::dvec3 at = PatternOf(scene).EnuFromGeodetic(eye.place).xyz;
  return Draped(cover, scene.drape().place, at.x, at.y);
}

// Straight rays: the planet looks as large as it is.
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

void PictureBlocks::UploadAir(const PaintedScene& scene, const Eye& eye) {
  const std::shared_ptr<const SolvedAir>& air = scene.air().air();
  if (known_air_ != air) air_block_ = AirBlockOf(air->medium);
  known_air_ = air;
  air_block_.shell.x = static_cast<float>(RadiusUnder(eye, air->medium));
  Upload(air_, kAirBinding, air_block_);
}

void PictureBlocks::UploadView(const PaintedScene& scene, const PaintedView& view,
                               const KeyLight& key, const PixelRay& ray) const {
  const Medium& medium = scene.air().air()->medium;
  const LandView axes = LandViewOf(view);
  const glm::dvec2 shift = ShiftOf(ray, view);
  const glm::dvec2 moved(view.part.x * view.part.z + shift.x, view.part.y * view.part.w + shift.y);
  const double altitude_km = std::max(view.eye.place.height_m, 0.0) / kMetresPerKilometre;
  ViewBlock block{};
  block.view_right = {glm::vec3(axes.right), 0.0F};
  block.view_up = {glm::vec3(axes.up), 0.0F};
  block.view_forward = {glm::vec3(axes.forward), PixelAngle(view) / std::sqrt(ray.of)};
  block.sun = {glm::vec3(DirectionToSun(key.disk)), key.disk.angular_radius_rad};
  block.sun_for_air = {glm::vec3(DirectionToSun(SunForAir(key.disk))), 0.0F};
  block.sun_irradiance = key.irradiance;
  block.eye = {altitude_km, moved.x, moved.y, RadiusUnder(view.eye, medium)};
  SetBend(block, BendOf(view, medium, scene.land().farthest_m()));
  Upload(view_, kViewBinding, block);
}

void PictureBlocks::UploadGroundLight(const PaintedScene& scene, const PaintedView& view,
                                      const KeyLight& light) const {
  Upload(ground_light_, kGroundLightBinding, LightAround(scene, view, light));
}

void PictureBlocks::UploadSkyByPixel(const PaintedScene& scene, const PaintedView& view,
                                     const KeyLight& light) const {
  const SkyByPixel* sky = scene.sky_by_pixel(light.source());
  if (sky == nullptr) return;
  const LocalFrame eye(scene.ellipsoid(), view.eye.place);
  Upload(sky_by_pixel_, kSkyByPixelBinding,
         sky->BlockOf(light.source(), eye, DirectionToSun(SunForAir(light.disk)),
                      scene.OpenSky(light.source())));
}

void PictureBlocks::UploadGround(const PaintedScene& scene, const PaintedView& view) const {
  Upload(ground_, kGroundBinding, GroundAround(scene, view));
  Upload(ground_surface_, kGroundSurfaceBinding, SurfaceAround(scene, view.eye));
}

}  // namespace alpenglow::viewer
