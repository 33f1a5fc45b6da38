// SPDX-License-Identifier: MIT
#include "viewer/paint/developer.h"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <utility>
#include <vector>

#include "viewer/gl/gl_context.h"
#include "viewer/paint/tone_table.h"
#include "viewer/shaders/viewer_texts.h"

namespace alpenglow::viewer {
namespace {

enum DeveloperUnit { kPicture, kDither, kTable };

ShaderProgram ProgramOf(ToneCurve curve, bool dithers) {
  ShaderProgram program = FullScreenProgram(
      WithViewerPieces(DeveloperTexts(curve, dithers), {"viewer/shaders/develop.frag.glsl"}));
  program.BindSampler("linear_picture", kPicture);
  program.BindSampler("tone_table", kTable);
  glUniform2f(program.Uniform("stops"), static_cast<float>(ToneTable::kLowestStop),
              static_cast<float>(ToneTable::kHighestStop));
  return program;
}

void Upload(const GlTexture& texture, const ToneTable& table) {
  glActiveTexture(GL_TEXTURE0 + kTable);
  glBindTexture(GL_TEXTURE_3D, texture.id());
  glTexImage3D(GL_TEXTURE_3D, 0, GL_RGBA32F, table.side(), table.side(), table.side(), 0, GL_RGB,
               GL_FLOAT, table.codes().data());
  ClampAndFilter(GL_TEXTURE_3D, true);
  CheckGl("Developer");
}

}  // namespace

std::vector<ShaderPiece> DeveloperTexts(ToneCurve curve, bool dithers) {
  std::vector<ShaderPiece> texts = SharedTexts();
  texts.push_back({"curve", fmt::format("#define CURVE {}\n#define DITHERS {}\n",
                                        static_cast<int>(curve), dithers ? 1 : 0)});
  return WithViewerPieces(std::move(texts), {"viewer/shaders/dither_tile.glsl"});
}

Developer::Developer(const Look& look, FirstPictures first)
    : look_(look),
      program_(ProgramOf(look.curve, true)),
      small_program_(ProgramOf(look.curve, false)),
      first_(first) {
  if (first_ == FirstPictures::kWait) MakeTable();
}

void Developer::MakeTable() const {
  is_asked_ = true;
  coming_ = std::async(std::launch::async, [look = look_.agx] { return ToneTable(look); });
}

void Developer::UploadDraft() const {
  constexpr int kSide = 24;
  Upload(table_, ToneTable(look_.agx, kSide));
}

// The table takes half a second of both processors, which a first frame needs itself: it is asked for in the
// second.
void Developer::TakeTable() const {
  if (!is_asked_ && !std::exchange(has_draft_, true)) return UploadDraft();
  if (!is_asked_) return MakeTable();
  if (!coming_.valid()) return;
  if (first_ == FirstPictures::kDraft &&
      coming_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
    return;
  Upload(table_, coming_.get());
}

void Developer::Use(const Look& look) {
  const Look before = std::exchange(look_, look);
  if (look.curve != before.curve) {
    program_ = ProgramOf(look.curve, true);
    small_program_ = ProgramOf(look.curve, false);
  }
  if (look.agx == before.agx) return;
  is_asked_ = has_draft_ = false;
  if (first_ == FirstPictures::kWait) MakeTable();
}

void Developer::Fill(const ShaderProgram& program, const RenderTarget& picture, double ev100,
                     const Screen& screen, const PassArea& area) const {
  TakeTable();
  glBindFramebuffer(GL_FRAMEBUFFER, screen.framebuffer);
  glViewport(0, 0, screen.width, screen.height);
  picture.BindTexture(kPicture);
  ClampAndFilter(GL_TEXTURE_2D,
                 picture.width() != screen.width || picture.height() != screen.height);
  glActiveTexture(GL_TEXTURE0 + kTable);
  glBindTexture(GL_TEXTURE_3D, table_.id());
  program.Use();
  dither_.Bind(program, kDither, screen.width, screen.height);
  glUniform1f(program.Uniform("exposure"), static_cast<float>(ExposureScale(ev100)));
  const Matrix3 balance = BalancingMatrix(look_.white);
  std::array<GLfloat, 9> rows{};
  for (std::size_t i = 0; i < rows.size(); ++i)
    rows[i] = static_cast<GLfloat>(balance[i / 3][i % 3]);
  glUniformMatrix3fv(program.Uniform("balance"), 1, GL_TRUE, rows.data());
  area.Draw(program);
  CheckGl("Developer::Develop");
}

void Developer::Develop(const RenderTarget& picture, double ev100, const Screen& screen,
                        const PassArea& area) const {
  Fill(program_, picture, ev100, screen, area);
}

void Developer::DevelopSmall(const RenderTarget& picture, double ev100,
                             const RenderTarget& codes) const {
  Fill(small_program_, picture, ev100, {codes.framebuffer(), codes.width(), codes.height()},
       whole_);
}

}  // namespace alpenglow::viewer
