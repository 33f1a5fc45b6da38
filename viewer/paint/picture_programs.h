// SPDX-License-Identifier: MIT
// The programs of a picture, one a stage, made when a stage is first drawn with and kept.
//
// Drivers finish a program when it is drawn with, which takes tenths of a second. Stages that will
// be needed later, when shade begins or ends, or a disk comes into view, are drawn with in the
// first frames, over one pixel that is painted after.
#pragma once

#include <map>
#include <set>

#include "viewer/gl/gl_objects.h"
#include "viewer/gl/shader.h"
#include "viewer/paint/painted_scene.h"
#include "viewer/paint/picture_texts.h"
#include "viewer/shade/shaft_pass.h"

namespace alpenglow::viewer {

class PicturePrograms {
 public:
  /// Everything that programs read must outlive this.
  PicturePrograms(const PaintedScene& scene, const LampPainter& lamps, const ShaftPass& shafts);

  /// Paints the whole viewport, but land only over land, and sky and disks only beside it: by the
  /// depth of the target that is bound, which must be tested.
  /// @param source  whose sky waves mirror; its air, blocks and maps are bound.
  void Paint(const PictureStage& stage, LightSource source = LightSource::kSun);
  /// Draws with a stage that Paint was not called for yet. Whether that was to be done.
  bool MakeReady(const PictureStage& stage);

  /// Whether any stage has been drawn with.
  [[nodiscard]] bool HasPainted() const { return !ready_.empty(); }

  /// For uniforms of the stage's own.
  [[nodiscard]] const ShaderProgram& Of(const PictureStage& stage);

  /// The lamp painter is another.
  void ForgetThoseWithLamps();

 private:
  [[nodiscard]] ShaderProgram Made(const PictureStage& stage) const;

  const PaintedScene& scene_;
  const LampPainter& lamps_;
  const ShaftPass& shafts_;
  std::map<PictureStage, ShaderProgram> made_;
  std::set<PictureStage> ready_;  // those that have been drawn with
  GlVertexArray no_vertices_;
};

}  // namespace alpenglow::viewer
