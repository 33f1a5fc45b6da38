// SPDX-License-Identifier: MIT
#include "viewer/clouds/cloud_pass.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_access.hpp>
#include <utility>

#include "atmosphere/math/constants.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {
namespace {

ShaderPiece LayersDefined(int layers) {
  return {"layers of clouds", fmt::format("#define CLOUD_LAYERS {}\n", layers)};
}

// Light of a layer, and the reach of its rays: outputs of clouds/march.frag.glsl.
RenderTarget MapOfLayer(int columns, int rows) {
  return {
      columns, rows, {PixelFormat::kRgba32F, PixelFormat::kRgba16F}, RenderTarget::Depth::kNone};
}

bool HasSize(const RenderTarget& map, int columns, int rows) {
  return map.width() == columns && map.height() == rows;
}

// Returns how the eye has moved relative to a layer [m].
glm::vec3 MovedIn(std::size_t layer, const CloudsBlock& from, const CloudsBlock& to) {
  const glm::vec2 per_m(to.place[layer].z, to.place[layer].w);
  const glm::vec2 way = glm::vec2(to.place[layer]) - glm::vec2(from.place[layer]);
  return {way - glm::round(way * per_m) / per_m, 0.0F};
}

// Returns the matrix to points of a picture from directions in the frame of its clouds.
glm::mat3 ScreenFromClouds(const CloudFrame& frame, const CloudsBlock& block) {
  const float c = block.turn.x, s = block.turn.y;
  return frame.screen_from_direction * glm::mat3(c, -s, 0.0F, s, c, 0.0F, 0.0F, 0.0F, 1.0F);
}

glm::vec3 ViewInClouds(const CloudFrame& frame, const CloudsBlock& block) {
  return glm::row(ScreenFromClouds(frame, block), 2);
}

void ClearToNoCloud() {
  glClearColor(0.0F, 0.0F, 1.0F, 0.0F);
  glClear(GL_COLOR_BUFFER_BIT);
}

}  // namespace

std::vector<ShaderPiece> CloudTexts(int layers) {
  return WithViewerPieces({LayersDefined(layers)}, {"viewer/shaders/clouds/light.glsl"});
}

CloudPass::CloudPass(std::vector<ShaderPiece> view, GLuint view_binding, MakeColours colours,
                     const CloudUnits& units)
    : view_(std::move(view)),
      view_binding_(view_binding),
      make_colours_(std::move(colours)),
      units_(units) {}

const ShaderProgram& CloudPass::March(const CloudQuality& quality) {
  const MarchKind kind{quality.steps, quality.sun_steps};
  const auto found = marches_.find(kind);
  if (found != marches_.end()) return found->second;
  std::vector<ShaderPiece> texts = view_;
  texts.push_back(LayersDefined(static_cast<int>(kMostCloudLayers)));
  texts.push_back(
      {"steps in clouds", fmt::format("#define CLOUD_STEPS {}\n#define CLOUD_SUN_STEPS {}\n",
                                      quality.steps, quality.sun_steps)});
  ShaderProgram made = FullScreenProgram(WithViewerPieces(
      std::move(texts),
      {"viewer/shaders/clouds/light.glsl", "viewer/shaders/clouds/rays.glsl",
       "viewer/shaders/clouds/march.glsl", "viewer/shaders/clouds/march.frag.glsl"}));
  made.BindBlock("View", view_binding_);
  Connect(made);
  made.BindSampler("surface_map", units_.surface);
  CloudTextures::Prepare(made, units_.march);
  return marches_.emplace(kind, std::move(made)).first->second;
}

void CloudPass::Connect(const ShaderProgram& program) const {
  program.BindBlock("Clouds", units_.block);
  int unit = units_.first;
  for (const char* sampler :
       {"cloud_sun_map", "earlier_cloud_sun_map", "cloud_map", "cloud_beam_map"})
    program.BindSampler(sampler, unit++);
}

void CloudPass::UseForRays(const ShaderProgram& program, int width, int height) const {
  program.Use();
  glUniform2i(program.Uniform("picture_size"), width, height);
  glUniform1i(program.Uniform("cloud_scale"), scale_);
}

void CloudPass::PaintLayer(const ShaderProgram& march, const CloudFollower& clouds,
                           std::size_t layer, const MapRays& rays) const {
  ClearToNoCloud();
  march.Use();
  glUniform3i(march.Uniform("map_rays"), rays.x, rays.y, rays.step);
  const auto draw = [&](const CloudFollower::Shown& of, std::size_t in_block) {
    if (layer >= of.textures->layers()) return;
    of.textures->BindLayer(march, layer, in_block, units_.march, of.made.of.light.direction.seen);
    DrawFullScreen(march, no_vertices_);
  };
  if (clouds.earlier() != nullptr) draw(*clouds.earlier(), kMostCloudLayers + layer);
  const Blending fading(Blending::Kind::kMix, clouds.share());
  draw(clouds.shown(), layer);
}

const ShaderProgram& CloudPass::Renewal() {
  if (renewal_) return *renewal_;
  std::vector<ShaderPiece> texts = view_;
  texts.push_back(LayersDefined(static_cast<int>(kMostCloudLayers)));
  renewal_ = FullScreenProgram(WithViewerPieces(
      std::move(texts),
      {"viewer/shaders/clouds/light.glsl", "viewer/shaders/clouds/rays.glsl",
       "viewer/shaders/clouds/near_rays.glsl", "viewer/shaders/clouds/renew.frag.glsl"}));
  renewal_->BindBlock("View", view_binding_);
  Connect(*renewal_);
  renewal_->BindSampler("surface_map", units_.surface);
  int unit = units_.march;
  for (const char* sampler : {"new_light", "earlier_light", "earlier_reach"})
    renewal_->BindSampler(sampler, unit++);
  return *renewal_;
}

bool CloudPass::Continues(const Gathered& last, const Gathered& next) {
  constexpr double kMostMoved_m = 100.0, kMostTurned_rad = 2.0 * kRadiansPerDegree;
  const bool is_same_map = last.frame.width == next.frame.width &&
                           last.frame.height == next.frame.height && last.quality == next.quality;
  const bool are_same_clouds = last.shown == next.shown && last.earlier == next.earlier &&
                               next.layers.size() == next.shown->layers();
  if (!next.frame.continues || !is_same_map || !are_same_clouds) return false;
  for (std::size_t layer = 0; layer < next.shown->layers(); ++layer) {
    const double along_m = glm::length(MovedIn(layer, last.block, next.block));
    const double up_m = next.frame.eye_altitude_m - last.frame.eye_altitude_m;
    if (std::hypot(along_m, up_m) > kMostMoved_m) return false;
  }
  const double cosine =
      glm::dot(ViewInClouds(last.frame, last.block), ViewInClouds(next.frame, next.block));
  return cosine > std::cos(kMostTurned_rad);
}

void CloudPass::RenewLayer(std::size_t layer, const Gathered& last, const Gathered& next,
                           const MapRays& rays) {
  const ShaderProgram& renewal = Renewal();
  UseForRays(renewal, next.frame.width, next.frame.height);
  glm::vec3 moved = MovedIn(layer, last.block, next.block);
  moved.z = static_cast<float>(next.frame.eye_altitude_m - last.frame.eye_altitude_m);
  const glm::mat3 screen = ScreenFromClouds(last.frame, last.block);
  glUniform2i(renewal.Uniform("first_ray"), rays.x, rays.y);
  glUniform3f(renewal.Uniform("moved"), moved.x, moved.y, moved.z);
  glUniformMatrix3fv(renewal.Uniform("earlier_screen"), 1, GL_FALSE, &screen[0][0]);
  quarter_->BindTexture(units_.march);
  last.layers[layer].BindTexture(units_.march + 1);
  last.layers[layer].BindTexture(units_.march + 2, 1);
  next.layers[layer].Bind();
  DrawFullScreen(renewal, no_vertices_);
}

void CloudPass::Renew(const CloudFollower& clouds, const Gathered& last, const Gathered& next) {
  constexpr std::array<MapRays, 4> kRounds{{{0, 0, 2}, {1, 1, 2}, {1, 0, 2}, {0, 1, 2}}};
  const MapRays& rays = kRounds[static_cast<std::size_t>(renewals_++ % 4)];
  const int columns = (next.layers.front().width() + 1) / 2;
  const int rows = (next.layers.front().height() + 1) / 2;
  if (!quarter_ || !HasSize(*quarter_, columns, rows)) quarter_ = MapOfLayer(columns, rows);
  for (std::size_t layer = 0; layer < next.layers.size(); ++layer) {
    quarter_->Bind();
    PaintLayer(March(next.quality), clouds, layer, rays);
    RenewLayer(layer, last, next, rays);
  }
}

void CloudPass::Gather(const CloudFollower& clouds, const CloudsBlock& block,
                       const CloudFrame& frame, const CloudQuality& quality) {
  scale_ = quality.scale;
  const int columns = (frame.width + scale_ - 1) / scale_;
  const int rows = (frame.height + scale_ - 1) / scale_;
  if (!clouds_ || !HasSize(*clouds_, columns, rows)) {
    clouds_.emplace(columns, rows, std::vector{PixelFormat::kRgba32F, PixelFormat::kRgba16F},
                    RenderTarget::Depth::kNone);
  }
  const CloudFollower::Shown& last_shown = clouds.earlier() ? *clouds.earlier() : clouds.shown();
  Gathered next{frame,
                block,
                quality,
                clouds.shown().textures,
                last_shown.textures,
                std::exchange(spare_, {})};
  if (!next.layers.empty() && !HasSize(next.layers.front(), columns, rows)) next.layers.clear();
  while (next.layers.size() > clouds.layers()) next.layers.pop_back();
  while (next.layers.size() < clouds.layers()) next.layers.push_back(MapOfLayer(columns, rows));
  UploadBlock(block_, units_.block, block);
  next.shown->BindLight(units_.first);
  next.earlier->BindLight(units_.first + 1);
  const ShaderProgram& march = March(quality);
  UseForRays(march, frame.width, frame.height);
  if (gathered_ && Continues(*gathered_, next)) {
    Renew(clouds, *gathered_, next);
  } else {
    for (std::size_t layer = 0; layer < next.layers.size(); ++layer) {
      next.layers[layer].Bind();
      PaintLayer(march, clouds, layer, {0, 0, 1});
    }
  }
  if (gathered_) spare_ = std::move(gathered_->layers);
  gathered_ = std::move(next);
  CheckGl("CloudPass::Gather");
}

void CloudPass::Colour(const CloudFollower& clouds, bool two_lights, int width, int height) {
  const Kind kind{static_cast<int>(clouds.layers()), two_lights};
  auto found = colours_.find(kind);
  if (found == colours_.end()) {
    found = colours_.emplace(kind, make_colours_(kind)).first;
    Connect(found->second);
    found->second.BindSampler("surface_map", units_.surface);
    for (int layer = 0; layer < kind.layers; ++layer)
      found->second.BindSampler(fmt::format("layer_light_{}", layer).c_str(), units_.march + layer);
  }
  const ShaderProgram& colours = found->second;
  UseForRays(colours, width, height);
  for (int layer = 0; layer < kind.layers; ++layer)
    gathered_->layers[static_cast<std::size_t>(layer)].BindTexture(units_.march + layer);
  clouds_->Bind();
  DrawFullScreen(colours, no_vertices_);
  CheckGl("CloudPass::Colour");
}

void CloudPass::Bind(const ShaderProgram& program) const {
  clouds_->BindTexture(units_.first + 2);
  clouds_->BindTexture(units_.first + 3, 1);
  const float step = 1.0F / static_cast<float>(scale_);
  const float first = 0.5F + static_cast<float>(scale_ / 2);  // pixel of the first ray
  glUniform2f(program.Uniform("cloud_map_place"), step, -first * step);
}

}  // namespace alpenglow::viewer
