// SPDX-License-Identifier: MIT
#include "viewer/media/scene_layer.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "renderer/lamps/scene_lamps.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/render_target.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {
namespace {

constexpr double kMetres = 1000.0;

// @param now  current eye and sun, which may differ from those of the map.
LayerBlock LayerBlockOf(const LayerMap& map, const EyeUnderLight& now) {
  LayerBlock block{};
  const double height_km = std::isinf(map.scale_height_m) ? 0.0 : map.scale_height_m / kMetres;
  block.shape = {map.extinction_per_m * kMetres, height_km, map.base_m / kMetres,
                 map.top_m / kMetres};
  block.eye = {std::max(now.altitude_m, 0.0) / kMetres, map.radius_m / kMetres, map.depth,
               map.peak_scale};
  block.sun = {glm::vec3(now.light.seen), 0.0};
  block.map_size = {map.size.elevations, map.size.azimuths, map.size.depths, LayerMap::kAngles};
  return block;
}

EyeUnderLight EyeUnder(const CameraPose& eye, const DistantLight& light) {
  return {eye.place.height_m, light.direction, light.radius_rad};
}

}  // namespace

std::vector<ShaderPiece> LayerTexts() {
  return {ViewerPiece("viewer/shaders/view/lights.glsl"),
          ViewerPiece("viewer/shaders/media/layer.glsl")};
}

void LayerPainter::Connect(const ShaderProgram& program) const {
  program.Use();
  program.BindBlock("Layer", units_.block);
  program.BindSampler("layer_light_map", units_.first);
  program.BindSampler("layer_surface_map", units_.first + 1);
  program.BindSampler("other_layer_light_map", units_.first + 2);
  program.BindSampler("other_layer_surface_map", units_.first + 3);
}

void LayerPainter::Upload(const LayerMap& map) {
  BindTexture(units_.first, GL_TEXTURE_3D, light_);
  UploadTexture(GL_TEXTURE_3D, light_,
                {GL_RGBA32F, map.size.elevations, map.size.azimuths,
                 LayerMap::kQuantities * map.size.depths, GL_RGBA, GL_FLOAT, map.light.data()});
  // Drivers have few texture units, so that both tables share one.
  static_assert(LayerMap::kAngles % LayerMap::kHeights == 0);
  std::vector<glm::vec4> rows = map.on_surface;
  rows.insert(rows.end(), map.phase.begin(), map.phase.end());
  BindTexture(units_.first + 1, GL_TEXTURE_2D, surface_);
  UploadTexture(GL_TEXTURE_2D, surface_,
                {GL_RGBA32F, LayerMap::kHeights, static_cast<int>(rows.size()) / LayerMap::kHeights,
                 1, GL_RGBA, GL_FLOAT, rows.data()});
  CheckGl("LayerPainter::Upload");
}

void LayerPainter::Bind(const LayerMap& map, const EyeUnderLight& now, const LayerPainter& other,
                        const EyeUnderLight& other_now) const {
  LayerBlock block = LayerBlockOf(map, now);
  block.other_sun = LayerBlockOf(map, other_now).sun;
  UploadBlock(block_, units_.block, block);
  BindTexture(units_.first, GL_TEXTURE_3D, light_);
  BindTexture(units_.first + 1, GL_TEXTURE_2D, surface_);
  BindTexture(units_.first + 2, GL_TEXTURE_3D, other.light_);
  BindTexture(units_.first + 3, GL_TEXTURE_2D, other.surface_);
}

SceneLayer::SceneLayer(std::shared_ptr<const LocalMedia> media, const LayerMapSize& size,
                       const MediaUnits& units)
    : media_(std::move(media)), size_(size), painter_(units) {}

void SceneLayer::SetSize(const LayerMapSize& size) {
  if (size == size_) return;
  size_ = size;
  air_ = nullptr;
}

// Uses one thread, so that drawing keeps the others.
void SceneLayer::BeginIn(const std::shared_ptr<const SolvedAir>& air, double latitude_rad) {
  air_ = air;
  const auto make = [here = air->OnSphereAt(latitude_rad), media = media_,
                     size = size_](const EyeUnderLight& wanted) {
    tbb::task_arena alone(1);
    return alone.execute([&] { return MakeLayerMap(*media->layer(), here, wanted, size); });
  };
  const double scale_height_m = media_->layer()->scale_height_m();
  maps_.emplace(make, [scale_height_m](const EyeUnderLight& made, const EyeUnderLight& wanted) {
    return Serves(made, wanted, scale_height_m);
  });
}

void SceneLayer::Follow(const std::shared_ptr<const SolvedAir>& air, const CameraPose& eye,
                        const DistantLight& light) {
  if (air_ != air) return WaitUntilReady(air, eye, light);
  if (maps_->Update()) painter_.Upload(*maps_->value());
  maps_->RequestWhenIdle(EyeUnder(eye, light));
}

void SceneLayer::WaitUntilReady(const std::shared_ptr<const SolvedAir>& air, const CameraPose& eye,
                                const DistantLight& light) {
  if (air_ != air) BeginIn(air, eye.place.latitude_rad());
  maps_->WaitUntilReady(EyeUnder(eye, light));
  maps_->Update();
  painter_.Upload(*maps_->value());
}

double SceneLayer::ExtinctionAt(double altitude_m) const {
  const ExponentialLayer& layer = *media_->layer();
  return layer.optics().extinction_per_m[0] * layer.DensityAtAltitude(altitude_m);
}

void SceneLayer::Bind(const CameraPose& eye, const DistantLight& light, const SceneLayer& other,
                      const DistantLight& other_light) const {
  painter_.Bind(*maps_->value(), EyeUnder(eye, light), other.painter_, EyeUnder(eye, other_light));
}

}  // namespace alpenglow::viewer
