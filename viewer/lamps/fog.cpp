// SPDX-License-Identifier: MIT
#include "viewer/lamps/fog.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/phase_forms.h"
#include "renderer/lamps/scene_lamps.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/render_target.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {
namespace {

constexpr double kMetres = 1000.0;

// @param now  current eye and sun, which may differ from those of the map.
FogBlock FogBlockOf(const FogMap& map, const FogView& now) {
  FogBlock block{};
  const double height_km = std::isinf(map.scale_height_m) ? 0.0 : map.scale_height_m / kMetres;
  block.layer = {map.extinction_per_m * kMetres, height_km, map.base_m / kMetres,
                 map.top_m / kMetres};
  block.eye = {std::max(now.altitude_m, 0.0) / kMetres, map.radius_m / kMetres, map.depth,
               map.peak_scale};
  block.sun = {glm::vec3(now.light.seen), map.broad_g};
  block.phase = ParametersOf(map.phase);
  block.map_size = {map.size.elevations, map.size.azimuths, map.size.depths, 0.0};
  return block;
}

}  // namespace

std::vector<ShaderPiece> FogTexts(PhaseKind kind) {
  return {{"fog constants", fmt::format("#define FOG_PHASE(c, p) {}\n", FormOf(kind).expression)},
          ViewerPiece("viewer/shaders/view/lights.glsl"),
          ViewerPiece("viewer/shaders/fog/light.glsl")};
}

std::vector<ShaderPiece> NoFogTexts() { return {ViewerPiece("viewer/shaders/fog/none.glsl")}; }

void FogPainter::Connect(const ShaderProgram& program) const {
  program.Use();
  program.BindBlock("Fog", units_.block);
  program.BindSampler("fog_light_map", units_.first);
  program.BindSampler("fog_surface_map", units_.first + 1);
  program.BindSampler("other_fog_light_map", units_.first + 2);
  program.BindSampler("other_fog_surface_map", units_.first + 3);
}

void FogPainter::Upload(const FogMap& map) {
  BindTexture(units_.first, GL_TEXTURE_3D, light_);
  UploadTexture(GL_TEXTURE_3D, light_,
                {GL_RGBA32F, map.size.elevations, map.size.azimuths, 4 * map.size.depths, GL_RGBA,
                 GL_FLOAT, map.light.data()});
  BindTexture(units_.first + 1, GL_TEXTURE_2D, surface_);
  UploadTexture(GL_TEXTURE_2D, surface_,
                {GL_RGBA32F, FogMap::kHeights, 2, 1, GL_RGBA, GL_FLOAT, map.on_surface.data()});
  CheckGl("FogPainter::Upload");
}

void FogPainter::Bind(const FogBlock& block) const {
  UploadBlock(block_, units_.block, block);
  BindTexture(units_.first, GL_TEXTURE_3D, light_);
  BindTexture(units_.first + 1, GL_TEXTURE_2D, surface_);
}

void FogPainter::Bind(const FogMap& map, const FogView& now) const { Bind(FogBlockOf(map, now)); }

void FogPainter::Bind(const FogMap& map, const FogView& now, const FogPainter& other,
                      const FogView& other_now) const {
  FogBlock block = FogBlockOf(map, now);
  block.other_sun = FogBlockOf(map, other_now).sun;
  Bind(block);
  BindTexture(units_.first + 2, GL_TEXTURE_3D, other.light_);
  BindTexture(units_.first + 3, GL_TEXTURE_2D, other.surface_);
}

namespace {

FogView FogViewOf(const CameraPose& eye, const DistantLight& light) {
  return {eye.place.height_m, light.direction, light.radius_rad};
}

}  // namespace

SceneFog::SceneFog(std::shared_ptr<const LocalMedia> media, const LayerMapSize& size,
                   const MediaUnits& units)
    : media_(std::move(media)), size_(size), painter_(units) {}

void SceneFog::SetSize(const LayerMapSize& size) {
  if (size == size_) return;
  size_ = size;
  air_ = nullptr;
}

// Uses one thread, so that drawing keeps the others.
void SceneFog::BeginIn(const std::shared_ptr<const SolvedAir>& air, double latitude_rad) {
  air_ = air;
  const auto make = [here = air->OnSphereAt(latitude_rad), media = media_,
                     size = size_](const FogView& wanted) {
    tbb::task_arena alone(1);
    return alone.execute([&] { return MakeFogMap(*media->layer(), here, wanted, size); });
  };
  const double scale_height_m = media_->layer()->scale_height_m();
  maps_.emplace(make, [scale_height_m](const FogView& made, const FogView& wanted) {
    return Serves(made, wanted, scale_height_m);
  });
}

void SceneFog::Follow(const std::shared_ptr<const SolvedAir>& air, const CameraPose& eye,
                      const DistantLight& light) {
  if (air_ != air) return WaitUntilReady(air, eye, light);
  if (maps_->Update()) painter_.Upload(*maps_->value());
  maps_->RequestWhenIdle(FogViewOf(eye, light));
}

void SceneFog::WaitUntilReady(const std::shared_ptr<const SolvedAir>& air, const CameraPose& eye,
                              const DistantLight& light) {
  if (air_ != air) BeginIn(air, eye.place.latitude_rad());
  maps_->WaitUntilReady(FogViewOf(eye, light));
  maps_->Update();
  painter_.Upload(*maps_->value());
}

double SceneFog::ExtinctionAt(double altitude_m) const {
  const ExponentialLayer& fog = *media_->layer();
  return fog.optics().extinction_per_m[0] * fog.DensityAtAltitude(altitude_m);
}

void SceneFog::Bind(const CameraPose& eye, const DistantLight& light) const {
  painter_.Bind(*maps_->value(), FogViewOf(eye, light));
}

void SceneFog::Bind(const CameraPose& eye, const DistantLight& light, const SceneFog& other,
                    const DistantLight& other_light) const {
  painter_.Bind(*maps_->value(), FogViewOf(eye, light), other.painter_,
                FogViewOf(eye, other_light));
}

}  // namespace alpenglow::viewer
