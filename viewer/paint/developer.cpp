// SPDX-License-Identifier: MIT
#include "viewer/paint/developer.h"

#include <fmt/format.h>

#include <vector>

#include "lut/picture/dither.h"
#include "viewer/gl/gl_context.h"
#include "viewer/paint/tone_table.h"
#include "viewer/shaders/full_screen.h"
#include "viewer/shaders/viewer_texts.h"

namespace alpenglow {
namespace {

enum Unit { kPicture, kDither, kTable };

void UploadDither() {
  std::vector<float> noise;
  for (int y = 0; y < kDitherTileSize; ++y) {
    for (int x = 0; x < kDitherTileSize; ++x) {
      for (int channel = 0; channel < 3; ++channel) noise.push_back(DitherNoise(x, y, channel));
      noise.push_back(0.0F);
    }
  }
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, kDitherTileSize, kDitherTileSize, 0, GL_RGBA, GL_FLOAT,
               noise.data());
  ClampAndFilter(GL_TEXTURE_2D, false);
}

ShaderProgram ProgramOf(ToneCurve curve) {
  std::vector<ShaderPiece> texts = SharedTexts();
  texts.push_back({"curve", fmt::format("#define CURVE {}\n", static_cast<int>(curve))});
  ShaderProgram program =
      FullScreenProgram(WithViewerPieces(texts, {"viewer/shaders/develop.frag.glsl"}));
  program.BindSampler("linear_picture", kPicture);
  program.BindSampler("dither_noise", kDither);
  program.BindSampler("tone_table", kTable);
  glUniform2f(program.Uniform("stops"), static_cast<float>(ToneTable::kLowestStop),
              static_cast<float>(ToneTable::kHighestStop));
  return program;
}

void UploadTable() {
  const ToneTable table;
  glTexImage3D(GL_TEXTURE_3D, 0, GL_RGBA32F, ToneTable::kSide, ToneTable::kSide, ToneTable::kSide,
               0, GL_RGB, GL_FLOAT, table.codes().data());
  ClampAndFilter(GL_TEXTURE_3D, true);
}

}  // namespace

Developer::Developer(ToneCurve curve) : curve_(curve), program_(ProgramOf(curve)) {
  glActiveTexture(GL_TEXTURE0 + kDither);
  glBindTexture(GL_TEXTURE_2D, dither_noise_.id());
  UploadDither();
  glActiveTexture(GL_TEXTURE0 + kTable);
  glBindTexture(GL_TEXTURE_3D, table_.id());
  UploadTable();
  CheckGl("Developer");
}

void Developer::Use(ToneCurve curve) {
  if (curve == curve_) return;
  program_ = ProgramOf(curve);
  curve_ = curve;
}

void Developer::Develop(const RenderTarget& picture, double ev100, const Screen& screen) const {
  glBindFramebuffer(GL_FRAMEBUFFER, screen.framebuffer);
  glViewport(0, 0, screen.width, screen.height);
  picture.BindTexture(kPicture);
  ClampAndFilter(GL_TEXTURE_2D,
                 picture.width() != screen.width || picture.height() != screen.height);
  glActiveTexture(GL_TEXTURE0 + kDither);
  glBindTexture(GL_TEXTURE_2D, dither_noise_.id());
  glActiveTexture(GL_TEXTURE0 + kTable);
  glBindTexture(GL_TEXTURE_3D, table_.id());
  program_.Use();
  glUniform1f(program_.Uniform("exposure"), static_cast<float>(ExposureScale(ev100)));
  glUniform2f(program_.Uniform("screen_size"), static_cast<float>(screen.width),
              static_cast<float>(screen.height));
  DrawFullScreen(program_, no_vertices_);
  CheckGl("Developer::Develop");
}

}  // namespace alpenglow
