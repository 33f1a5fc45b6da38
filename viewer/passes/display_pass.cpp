// SPDX-License-Identifier: MIT
#include "viewer/passes/display_pass.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <future>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "atmosphere/base/parsing.h"
#include "lut/image/development.h"
#include "lut/image/dither.h"
#include "lut/image/metering.h"
#include "lut/image/tone_mapping.h"
#include "lut/image/white_balance.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/render_target.h"
#include "viewer/land/land_pass.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {

MeterReading ReadingOf(const HdrImage& picture, const Look& look, Projection projection) {
  const WhiteBalance white = Settled(look.white, picture, projection);
  const auto ev100 = [&](const HdrImage& seen) {
    return MeterEv100(seen, kSunDiskLuminance_cd_per_m2, projection);
  };
  return {white.IsDaylight() ? ev100(picture) : ev100(Balanced(picture, white)), white};
}

void ExposureMeter::Copy(const RenderTarget& picture) {
  const int longest = std::max(picture.width(), picture.height());
  const auto shrunk = [&](int side) {
    return std::clamp(side * kLongSide / longest, 1, std::max(side, 1));
  };
  const int width = shrunk(picture.width()), height = shrunk(picture.height());
  Fit(small_, width, height);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, picture.framebuffer());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, small_->framebuffer());
  glBlitFramebuffer(0, 0, picture.width(), picture.height(), 0, 0, width, height,
                    GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void ExposureMeter::LookAt(const RenderTarget& picture) {
  if (reader_.Busy()) return;
  Copy(picture);
  reader_.Begin(*small_, {0, 0, small_->width(), small_->height()});
}

std::optional<MeterReading> ExposureMeter::Poll(const Look& look) {
  std::optional<std::vector<std::array<float, 3>>> rgb = reader_.Poll();
  if (!rgb) return std::nullopt;
  HdrImage copy(small_->width(), small_->height());
  copy.rgb = std::move(*rgb);
  return ReadingOf(copy, look);
}

MeterReading ExposureMeter::Read(const RenderTarget& picture, const Look& look) {
  reader_.Forget();
  Copy(picture);
  return ReadingOf(small_->Read(), look);
}

std::optional<double> SpotMeter::At(const RenderTarget& picture, double right, double down) {
  if (!reader_) reader_.emplace();
  if (const auto pixels = reader_->Poll()) {
    const std::array<float, 3>& rgb = pixels->front();
    luminance_ = shared::Luminance<double>(static_cast<double>(rgb[0]), static_cast<double>(rgb[1]),
                                           static_cast<double>(rgb[2]));
  }
  reader_->Begin(picture, {static_cast<int>(right * picture.width()),
                           picture.height() - 1 - static_cast<int>(down * picture.height()), 1, 1});
  return luminance_;
}

void SpotMeter::Leave() {
  reader_.reset();
  luminance_.reset();
}

DitherTexture::DitherTexture() {
  std::vector<float> noise;
  for (int y = 0; y < kDitherTileSize; ++y) {
    for (int x = 0; x < kDitherTileSize; ++x) {
      for (int channel = 0; channel < 3; ++channel) noise.push_back(DitherNoise(x, y, channel));
      noise.push_back(0.0F);
    }
  }
  UploadTexture(GL_TEXTURE_2D, noise_,
                {GL_RGBA32F, kDitherTileSize, kDitherTileSize, 1, GL_RGBA, GL_FLOAT, noise.data()});
  ClampAndFilter(GL_TEXTURE_2D, false);
}

void DitherTexture::Bind(const ShaderProgram& program, int unit, int width, int height) const {
  BindTexture(unit, GL_TEXTURE_2D, noise_);
  glUniform1i(program.Uniform("dither_noise"), unit);
  glUniform2f(program.Uniform("screen_size"), static_cast<float>(width),
              static_cast<float>(height));
}

namespace {

std::vector<float> Nodes(int side) {
  std::vector<float> nodes(static_cast<std::size_t>(side));
  constexpr double kRange = ToneTable::kHighestStop - ToneTable::kLowestStop;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(nodes.size() - 1);
    nodes[i] = static_cast<float>(std::exp2(ToneTable::kLowestStop + kRange * share));
  }
  return nodes;
}

enum ToneMapPassUnit { kPicture, kDither, kTable };

// Returns the macro that selects a tone curve in the shader: CURVE_PBR_NEUTRAL for "pbr-neutral".
std::string MacroOf(ToneCurve curve) {
  std::string macro = "CURVE_" + NameOf(curve);
  for (char& letter : macro) letter = letter == '-' ? '_' : UpperCase(letter);
  return macro;
}

ShaderProgram ProgramOf(ToneCurve curve, bool dithers) {
  ShaderProgram program = FullScreenProgram(WithViewerPieces(
      ToneMapPassTexts(curve, dithers), {"viewer/shaders/display/tone_map.frag.glsl"}));
  program.BindSampler("linear_picture", kPicture);
  program.BindSampler("tone_table", kTable);
  glUniform2f(program.Uniform("stops"), static_cast<float>(ToneTable::kLowestStop),
              static_cast<float>(ToneTable::kHighestStop));
  return program;
}

void Upload(const GlTexture& texture, const ToneTable& table) {
  BindTexture(kTable, GL_TEXTURE_3D, texture);
  UploadTexture(GL_TEXTURE_3D, texture,
                {GL_RGBA32F, table.side(), table.side(), table.side(), GL_RGB, GL_FLOAT,
                 table.codes().data()});
  CheckGl("ToneMapPass");
}

enum UpscalerUnit { kSmall, kPrintDither, kOutline };

ShaderProgram ProgramOf(Upscaler::Shows shows) {
  ShaderProgram program = FullScreenProgram(WithViewerPieces(
      UpscalerTexts(shows, LandPass::DepthText()), {"viewer/shaders/display/upscale.frag.glsl"}));
  program.BindSampler("small_picture", kSmall);
  program.BindSampler("outline", kOutline);
  return program;
}

}  // namespace

ToneTable::ToneTable(AgxLook look, int side) : side_(side) {
  const std::vector<float> nodes = Nodes(side);
  codes_.resize(nodes.size() * nodes.size() * nodes.size());
  tbb::parallel_for(std::size_t{0}, nodes.size(), [&](std::size_t blue) {
    auto code = codes_.begin() + static_cast<std::ptrdiff_t>(blue * nodes.size() * nodes.size());
    for (const float green : nodes) {
      for (const float red : nodes) {
        const Rgb<float> light =
            DisplayLight<float>(ToneCurve::kAgx, {red, green, nodes[blue]}, 1.0F, look);
        *code++ = {shared::SrgbCode(light[0]), shared::SrgbCode(light[1]),
                   shared::SrgbCode(light[2])};
      }
    }
  });
}

std::shared_future<ToneTable> ToneTableOf(AgxLook look) {
  static std::mutex mutex;
  static std::map<AgxLook, std::shared_future<ToneTable>> tables;
  const std::lock_guard lock(mutex);
  std::shared_future<ToneTable>& table = tables[look];
  if (!table.valid()) table = std::async(std::launch::async, [look] { return ToneTable(look); });
  return table;
}

std::vector<ShaderPiece> ToneMapPassTexts(ToneCurve curve, bool dithers) {
  std::vector<ShaderPiece> texts = SharedTexts();
  texts.push_back(
      {"curve", fmt::format("#define {}\n#define DITHERS {}\n", MacroOf(curve), dithers ? 1 : 0)});
  return WithViewerPieces(std::move(texts), {"viewer/shaders/display/dither.glsl"});
}

ToneMapPass::ToneMapPass(const Look& look, FirstPictures first)
    : look_(look),
      program_(ProgramOf(look.curve, true)),
      small_program_(ProgramOf(look.curve, false)),
      first_(first) {}

void ToneMapPass::UploadDraft() const {
  constexpr int kSide = 24;
  Upload(table_, ToneTable(look_.agx, kSide));
}

// The table takes half a second on both processors, which the first frame needs itself. After a
// draft it is therefore requested in the second frame.
void ToneMapPass::TakeTable() const {
  const bool waits = first_ == FirstPictures::kWait;
  if (!waits && !std::exchange(has_draft_, true)) return UploadDraft();
  if (has_table_) return;
  if (!coming_.valid()) coming_ = ToneTableOf(look_.agx);
  if (!waits && coming_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  Upload(table_, coming_.get());
  coming_ = {};
  has_table_ = true;
}

void ToneMapPass::Use(const Look& look) {
  const Look before = std::exchange(look_, look);
  if (look.curve != before.curve) {
    program_ = ProgramOf(look.curve, true);
    small_program_ = ProgramOf(look.curve, false);
  }
  if (look.agx == before.agx) return;
  has_draft_ = has_table_ = false;
  coming_ = {};
}

void ToneMapPass::Fill(const ShaderProgram& program, const RenderTarget& picture, double ev100,
                       const Screen& screen, const PassArea& area) const {
  TakeTable();
  glBindFramebuffer(GL_FRAMEBUFFER, screen.framebuffer);
  glViewport(0, 0, screen.width, screen.height);
  picture.BindTexture(kPicture);
  ClampAndFilter(GL_TEXTURE_2D,
                 picture.width() != screen.width || picture.height() != screen.height);
  BindTexture(kTable, GL_TEXTURE_3D, table_);
  program.Use();
  dither_.Bind(program, kDither, screen.width, screen.height);
  glUniform1f(program.Uniform("exposure"), static_cast<float>(ExposureScale(ev100)));
  const Matrix3 balance = BalancingMatrix(look_.white);
  std::array<GLfloat, 9> rows{};
  for (std::size_t i = 0; i < rows.size(); ++i)
    rows[i] = static_cast<GLfloat>(balance[i / 3][i % 3]);
  glUniformMatrix3fv(program.Uniform("balance"), 1, GL_TRUE, rows.data());
  area.Draw(program);
  CheckGl("ToneMapPass::Develop");
}

void ToneMapPass::Develop(const RenderTarget& picture, double ev100, const Screen& screen,
                          const PassArea& area) const {
  Fill(program_, picture, ev100, screen, area);
}

void ToneMapPass::DevelopSmall(const RenderTarget& picture, double ev100,
                               const RenderTarget& codes) const {
  Fill(small_program_, picture, ev100, {codes.framebuffer(), codes.width(), codes.height()},
       whole_);
}

std::vector<ShaderPiece> UpscalerTexts(Upscaler::Shows shows, const ShaderPiece& depth) {
  const bool dithers = shows == Upscaler::Shows::kCodes;
  std::vector<ShaderPiece> texts =
      WithViewerPieces(SharedTexts(), {"viewer/shaders/gbuffer/inverse_depth.glsl"});
  texts.push_back(depth);
  texts.push_back({"shown", dithers ? "#define DITHERS 1\n" : "#define DITHERS 0\n"});
  return dithers ? WithViewerPieces(std::move(texts), {"viewer/shaders/display/dither.glsl"})
                 : texts;
}

Upscaler::Upscaler(Shows shows) : shows_(shows), program_(ProgramOf(shows)) {}

void Upscaler::Upscale(const RenderTarget& small, const DepthPrepass& outline,
                       const glm::dvec2& half_view, GLuint framebuffer,
                       const PassArea& area) const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, outline.width(), outline.height());
  small.BindTexture(kSmall);
  outline.BindDepth(kOutline);
  program_.Use();
  if (shows_ == Shows::kCodes)
    dither_.Bind(program_, kPrintDither, outline.width(), outline.height());
  glUniform2f(program_.Uniform("half_view"), static_cast<float>(half_view.x),
              static_cast<float>(half_view.y));
  area.Draw(program_);
  CheckGl("Upscaler::Enlarge");
}

const DepthPrepass& DisplayPass::OutlineFor(const ToneMapPass::Screen& screen) {
  Fit(outline_, screen.width, screen.height);
  return *outline_;
}

void DisplayPass::ShowUpscaled(const RenderTarget& picture, const glm::dvec2& half_view,
                               double ev100, const ToneMapPass::Screen& screen, PassTimer* timer) {
  {
    const TimedPass timed(timer, "tone_map");
    Fit(codes_, picture.width(), picture.height(), PixelFormat::kRgba16F);
    tone_map_.DevelopSmall(picture, ev100, *codes_);
  }
  const TimedPass timed(timer, "upscale");
  code_upscaler_.Upscale(*codes_, *outline_, half_view, screen.framebuffer);
}

const RenderTarget& DisplayPass::LightIn(const std::vector<PixelBox>& boxes,
                                         const RenderTarget& picture, const glm::dvec2& half_view,
                                         const ToneMapPass::Screen& screen) {
  Fit(light_, screen.width, screen.height, PixelFormat::kRgba32F);
  bodies_.Set(boxes, screen.width, screen.height);
  light_upscaler_.Upscale(picture, *outline_, half_view, light_->framebuffer(), bodies_);
  return *light_;
}

}  // namespace alpenglow::viewer
