// SPDX-License-Identifier: MIT
#include "viewer/clouds/cloud_pass.h"

#include <fmt/format.h>

#include <utility>

#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {
namespace {

ShaderPiece LayersDefined(int layers) {
  return {"layers of clouds", fmt::format("#define CLOUD_LAYERS {}\n", layers)};
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
      {"viewer/shaders/clouds/light.glsl", "viewer/shaders/clouds/march.glsl",
       "viewer/shaders/clouds/rays.glsl", "viewer/shaders/clouds/march.frag.glsl"}));
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
  program.BindSampler("cloud_surface_map", units_.surface);
}

void CloudPass::UseForRays(const ShaderProgram& program, int width, int height) const {
  program.Use();
  glUniform2i(program.Uniform("picture_size"), width, height);
  glUniform1i(program.Uniform("cloud_scale"), scale_);
}

void CloudPass::PaintLayer(const ShaderProgram& march, const CloudFollower& clouds,
                           std::size_t layer) const {
  ClearToNoCloud();
  const auto draw = [&](const CloudFollower::Shown& of, std::size_t in_block) {
    if (layer >= of.textures->layers()) return;
    of.textures->BindLayer(march, layer, in_block, units_.march, of.made.of.light.direction.seen);
    DrawFullScreen(march, no_vertices_);
  };
  if (clouds.earlier() != nullptr) draw(*clouds.earlier(), kMostCloudLayers + layer);
  const Blending fading(Blending::Kind::kMix, clouds.share());
  draw(clouds.shown(), layer);
}

void CloudPass::Gather(const CloudFollower& clouds, const CloudsBlock& block, int width, int height,
                       const CloudQuality& quality) {
  scale_ = quality.scale;
  const int columns = (width + scale_ - 1) / scale_, rows = (height + scale_ - 1) / scale_;
  if (!clouds_ || clouds_->width() != columns || clouds_->height() != rows) {
    layers_.clear();
    clouds_.emplace(columns, rows, std::vector{PixelFormat::kRgba32F, PixelFormat::kRgba16F},
                    RenderTarget::Depth::kNone);
  }
  while (layers_.size() < clouds.layers()) layers_.emplace_back(columns, rows);
  UploadBlock(block_, units_.block, block);
  clouds.shown().textures->BindLight(units_.first);
  (clouds.earlier() != nullptr ? clouds.earlier() : &clouds.shown())
      ->textures->BindLight(units_.first + 1);
  const ShaderProgram& march = March(quality);
  UseForRays(march, width, height);
  for (std::size_t layer = 0; layer < clouds.layers(); ++layer) {
    layers_[layer].Bind();
    PaintLayer(march, clouds, layer);
  }
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
    layers_[static_cast<std::size_t>(layer)].BindTexture(units_.march + layer);
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
  glUniform1i(program.Uniform("cloud_map_scale"), scale_);
}

}  // namespace alpenglow::viewer
