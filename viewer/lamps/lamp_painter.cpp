// SPDX-License-Identifier: MIT
#include "viewer/lamps/lamp_painter.h"

#include <fmt/format.h>

#include <array>

#include "atmosphere/base/error.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/medium/phase_forms.h"
#include "atmosphere/medium/phase_table.h"
#include "renderer/lamps/lamp_shadow_field.h"
#include "renderer/lamps/sampled_glow.h"
#include "renderer/lamps/scene_lamps.h"
#include "viewer/gl/gl_context.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {
namespace {

enum LampUnit {
  kLampTablesUnit,
  kLampAirlightUnit,
  kLampMieUnit,
  kLampLatticeUnit,
  kLampShadeUnit,
  kLampPlanUnit
};

/// Steps of the lattice from a lamp at which its core fades and ends. Farther away, light that is
/// proportional to 1 / angle is approximately linear between lattice points.
constexpr double kCoreBegin_steps = 2.0, kCoreEnd_steps = 8.0;

std::string DefinesOf(const SceneLamps& shape, const LampQuality& quality) {
  const std::vector<LampLayer>& layers = shape.layers();
  std::string text = fmt::format(
      "#define LAMP_MOST {}\n#define LAMP_CONE {}\n#define LAMP_TABLE {}\n"
      "#define LAMP_NODES {}\n#define LAMP_LATTICE {}\n"
      "#define LAMP_PHASE_MIE(c, p) {}\n#define LAMP_GLOW_NEAREST {:.7f}\n"
      "#define LAMP_GLOW_FARTHEST {:.7f}\n#define LAMP_AIRLIGHT_TERMS {}\n",
      kMostGpuLamps, static_cast<int>(LampProfile::Kind::kCone),
      static_cast<int>(LampProfile::Kind::kTable), quality.nodes, quality.step > 1 ? 1 : 0,
      FormOf(layers[1].phase.kind).expression, LampAirlightIrradiance::kNearest_m,
      LampAirlightIrradiance::kFarthest_m, kGlowTerms);
  if (!shape.tables().empty()) text += "#define LAMP_TABLES\n";
  if (!shape.shades().empty()) {
    text += fmt::format(
        "#define LAMP_SHADE\n#define LAMP_SHADE_NEAREST {:.7f}\n#define LAMP_SHADE_FARTHEST "
        "{:.7f}\n",
        kNearestShade_m, kFarthestShade_m);
    text += fmt::format(
        "#define LAMP_PLAN_STEP {:.7f}\n#define LAMP_PLAN_REACH {:.7f}\n"
        "#define LAMP_PLAN_RANGE {:.7f}\n",
        kPlanStep_m, kPlanReach_steps * kPlanStep_m, kPlanRange_steps);
  }
  // In clear air less than one per cent of a lamp's light reaches the surrounding ground by
  // scattering.
  const bool is_fine = quality.step == 1;
  if (!shape.glows().empty() && (is_fine || shape.HasLayer())) text += "#define LAMP_GLOW_MAP\n";
  if (is_fine) text += "#define LAMP_GLOW_OF_SLOPES\n";
  if (layers[1].phase.kind == PhaseKind::kTable) text += "#define LAMP_MIE_TABLE\n";
  if (shape.HasLayer()) {
    text += fmt::format("#define LAMP_LAYER\n#define LAMP_PHASE_LAYER(c, p) {}\n",
                        FormOf(layers[2].phase.kind).expression);
  }
  return text;
}

}  // namespace

std::vector<ShaderPiece> LampTexts(const SceneLamps& shape, const LampQuality& quality) {
  return WithViewerPieces({{"lamp constants", DefinesOf(shape, quality)}},
                          {"viewer/shaders/lamps/light.glsl", "viewer/shaders/lamps/picture.glsl"});
}

std::vector<ShaderPiece> NoLampTexts() { return {ViewerPiece("viewer/shaders/lamps/none.glsl")}; }

LampPainter::LampPainter(const SceneLamps& shape, const LampQuality& quality,
                         const LampUnits& units)
    : quality_(quality), units_(units), texts_(LampTexts(shape, quality)) {
  ALPENGLOW_ENSURE(quality.nodes, >=, 2);
  ALPENGLOW_ENSURE(quality.nodes, <=, 32);
  std::vector<ShaderPiece> texts =
      WithViewerPieces(SharedTexts(), {"viewer/shaders/view/block.glsl"});
  std::vector<ShaderPiece> corners = texts;
  texts.insert(texts.end(), texts_.begin(), texts_.end());
  // The last text is for pixels only, so it is omitted here.
  corners.insert(corners.end(), texts_.begin(), texts_.end() - 1);
  corners.push_back(ViewerPiece("viewer/shaders/lamps/corners.glsl"));
  if (quality.step > 1) {
    glow_program_.emplace(
        FullScreenProgram(WithViewerPieces(texts, {"viewer/shaders/lamps/airlight.frag.glsl"})));
    core_program_.emplace(WithViewerPieces(corners, {"viewer/shaders/lamps/core.vert.glsl"}),
                          WithViewerPieces(texts, {"viewer/shaders/lamps/core.frag.glsl"}));
    Connect(*glow_program_);
    Connect(*core_program_);
  }
  disk_program_.emplace(
      WithViewerPieces(corners, {"viewer/shaders/lamps/disk.vert.glsl"}),
      WithViewerPieces(texts, {"viewer/shaders/lamps/disk.frag.glsl"}),
      std::vector<VertexAttribute>{{0, "disk_towards"}, {1, "disk_light"}, {2, "disk_place"}});
  Connect(*disk_program_);
  UploadTables(shape);
  UploadGlows(shape);
  UploadShades(shape);
  UploadPlans(shape);
  CheckGl("LampPainter");
}

void LampPainter::Connect(const ShaderProgram& program) const {
  const GaussRule& rule = GaussLegendre(quality_.nodes);
  std::vector<float> pairs;
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    pairs.push_back(static_cast<float>(rule.node[i]));
    pairs.push_back(static_cast<float>(rule.weight[i]));
  }
  program.Use();
  glUniform2fv(program.Uniform("lamp_gauss"), quality_.nodes, pairs.data());
  program.BindBlock("Lamps", units_.lamps_block);
  program.BindBlock("View", units_.view_block);
  program.BindSampler("surface_map", units_.surface);
  program.BindSampler("lamp_tables", units_.first + kLampTablesUnit);
  program.BindSampler("lamp_airlight_map", units_.first + kLampAirlightUnit);
  program.BindSampler("lamp_mie_table", units_.first + kLampMieUnit);
  program.BindSampler("lamp_shades", units_.first + kLampShadeUnit);
  program.BindSampler("lamp_plans", units_.first + kLampPlanUnit);
  program.BindSampler("lamp_lattice", units_.first + kLampLatticeUnit);
}

void LampPainter::UploadTables(const SceneLamps& shape) {
  std::vector<float> samples;
  for (const LampProfile& profile : shape.tables()) {
    const std::vector<float> sampled = SampledProfile(profile);
    samples.insert(samples.end(), sampled.begin(), sampled.end());
  }
  BindTexture(units_.first + kLampTablesUnit, GL_TEXTURE_2D_ARRAY, tables_);
  if (!samples.empty()) {
    UploadTexture(GL_TEXTURE_2D_ARRAY, tables_,
                  {GL_R32F, kLampGammas, kLampTurns, static_cast<int>(shape.tables().size()),
                   GL_RED, GL_FLOAT, samples.data()});
  }
  const PhaseFunction& mie = shape.layers()[1].phase;
  if (mie.kind != PhaseKind::kTable) return;
  std::vector<float> nodes;
  for (const double node : mie.table->nodes()) nodes.push_back(static_cast<float>(node));
  BindTexture(units_.first + kLampMieUnit, GL_TEXTURE_2D, mie_table_);
  UploadTexture(GL_TEXTURE_2D, mie_table_,
                {GL_R32F, static_cast<int>(nodes.size()), 1, 1, GL_RED, GL_FLOAT, nodes.data()});
}

void LampPainter::UploadGlows(const SceneLamps& shape) {
  if (shape.glows().empty()) return;
  std::vector<glm::vec4> texels;
  for (const LampAirlightIrradiance* glow : shape.glows()) {
    const std::vector<glm::vec4> terms = SampledGlow(*glow);
    texels.insert(texels.end(), terms.begin(), terms.end());
  }
  BindTexture(units_.first + kLampAirlightUnit, GL_TEXTURE_2D_ARRAY, glows_);
  UploadTexture(GL_TEXTURE_2D_ARRAY, glows_,
                {GL_RGBA32F, kGlowDistances, kGlowTerms * kGlowRises,
                 static_cast<int>(shape.glows().size()), GL_RGBA, GL_FLOAT, texels.data()});
}

void LampPainter::UploadShades(const SceneLamps& shape) {
  if (shape.shades().empty()) return;
  std::vector<float> texels;
  for (const std::vector<float>& shade : shape.shades()) {
    texels.insert(texels.end(), shade.begin(), shade.end());
  }
  BindTexture(units_.first + kLampShadeUnit, GL_TEXTURE_2D_ARRAY, shades_);
  UploadTexture(GL_TEXTURE_2D_ARRAY, shades_,
                {GL_R32F, kShadeTurns, kShadeRings, static_cast<int>(shape.shades().size()), GL_RED,
                 GL_FLOAT, texels.data()});
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_S, GL_REPEAT);
}

// Allocates layers for all plans and uploads the finished ones.
void LampPainter::UploadPlans(const SceneLamps& shape) {
  if (shape.PlanLayerCount() == 0) return;
  BindTexture(units_.first + kLampPlanUnit, GL_TEXTURE_2D_ARRAY, plans_);
  if (uploaded_plans_ == 0) {
    UploadTexture(
        GL_TEXTURE_2D_ARRAY, plans_,
        {GL_R8, kPlanSide, kPlanSide, shape.PlanLayerCount(), GL_RED, GL_UNSIGNED_BYTE, nullptr});
  }
  for (; uploaded_plans_ < shape.plans().size(); ++uploaded_plans_) {
    const LampShadowField& plan = shape.plans()[uploaded_plans_];
    glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, uploaded_layers_, kPlanSide, kPlanSide,
                    plan.levels, GL_RED, GL_UNSIGNED_BYTE, plan.texels.data());
    uploaded_layers_ += plan.levels;
  }
}

void LampPainter::Prepare(SceneLamps& lamps, const LampView& view, double dimmest_cd_per_m2,
                          std::size_t most) {
  std::array<double, 2> core{0.0, 0.0};
  if (quality_.step > 1) {
    const double step_rad = quality_.step * view.pixel_angle_rad;
    core = {kCoreBegin_steps * step_rad, kCoreEnd_steps * step_rad};
  }
  lamps.FollowPlans();
  if (uploaded_plans_ < lamps.plans().size()) UploadPlans(lamps);
  SceneLamps::InView in_view = lamps.Before(view, core, dimmest_cd_per_m2, most);
  in_view.block.planet.z = static_cast<float>(quality_.step);
  lamps_ = static_cast<int>(in_view.block.count.x);
  disks_ = static_cast<int>(in_view.disks.size());
  glBindBuffer(GL_UNIFORM_BUFFER, block_.id());
  glBufferData(GL_UNIFORM_BUFFER, sizeof(in_view.block), &in_view.block, GL_DYNAMIC_DRAW);
  if (disks_ == 0) return;
  glBindVertexArray(disk_vertices_.id());
  glBindBuffer(GL_ARRAY_BUFFER, disk_buffer_.id());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(sizeof(LampDisk) * in_view.disks.size()),
               in_view.disks.data(), GL_DYNAMIC_DRAW);
  for (GLuint i = 0; i < 3; ++i) {
    glEnableVertexAttribArray(i);
    glVertexAttribPointer(i, 4, GL_FLOAT, GL_FALSE, sizeof(LampDisk),
                          reinterpret_cast<const void*>(i * sizeof(glm::vec4)));
    glVertexAttribDivisor(i, 1);
  }
}

void LampPainter::Bind() const {
  glBindBufferBase(GL_UNIFORM_BUFFER, units_.lamps_block, block_.id());
  const auto bind = [&](LampUnit unit, GLenum target, const GlTexture& texture) {
    BindTexture(units_.first + unit, target, texture);
  };
  bind(kLampTablesUnit, GL_TEXTURE_2D_ARRAY, tables_);
  bind(kLampAirlightUnit, GL_TEXTURE_2D_ARRAY, glows_);
  bind(kLampMieUnit, GL_TEXTURE_2D, mie_table_);
  bind(kLampShadeUnit, GL_TEXTURE_2D_ARRAY, shades_);
  bind(kLampPlanUnit, GL_TEXTURE_2D_ARRAY, plans_);
  if (lattice_) lattice_->BindTexture(units_.first + kLampLatticeUnit);
}

void LampPainter::PaintGlow(int width, int height) {
  if (quality_.step == 1) return;
  const int columns = (width + quality_.step - 1) / quality_.step + 1;
  const int rows = (height + quality_.step - 1) / quality_.step + 1;
  Fit(lattice_, columns, rows);
  Bind();
  lattice_->Bind();
  glow_program_->Use();
  glUniform2f(glow_program_->Uniform("picture_size"), static_cast<float>(width),
              static_cast<float>(height));
  DrawFullScreen(*glow_program_, no_vertices_);
  CheckGl("LampPainter::PaintGlow");
}

void LampPainter::PaintOver(double pixel_angle_rad) const {
  if (IsDark()) return;
  Bind();
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  if (core_program_ && lamps_ > 0) {
    core_program_->Use();
    glBindVertexArray(no_vertices_.id());
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, lamps_);
  }
  if (disks_ > 0) {
    disk_program_->Use();
    glUniform1f(disk_program_->Uniform("pixel_angle"), static_cast<float>(pixel_angle_rad));
    glBindVertexArray(disk_vertices_.id());
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, disks_);
  }
  glDisable(GL_BLEND);
  CheckGl("LampPainter::PaintOver");
}

}  // namespace alpenglow::viewer
