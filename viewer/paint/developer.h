// SPDX-License-Identifier: MIT
// Linear pictures made to look at, on the graphics card.
#pragma once

#include <future>

#include <vector>

#include "lut/picture/look.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/gl/render_target.h"
#include "viewer/gl/shader.h"
#include "viewer/paint/dither_texture.h"
#include "viewer/paint/tone_table.h"
#include "viewer/shaders/full_screen.h"

namespace alpenglow::viewer {

/// White balance, exposure, gamut, tone curve and dither, as Seen and Develop (look.h) do them; local
/// exposure and night vision are left out.
class Developer {
 public:
  /// A picture that is developed before the table of its look is ready waits for it (kWait), so that it is exact, or
  /// is shown by a coarse table at once, up to 9 codes off (kDraft).
  enum class FirstPictures { kWait, kDraft };
  /// The table of the look is made beside drawing.
  /// @param look  settled (look.h), here and below.
  explicit Developer(const Look& look, FirstPictures first = FirstPictures::kWait);

  /// Takes another look; what it has in common with the one in use costs nothing.
  void Use(const Look& look);
  [[nodiscard]] const Look& look() const { return look_; }

  /// Where a developed picture goes: a framebuffer (0: the window) and its size [pixels].
  struct Screen {
    GLuint framebuffer;
    int width, height;
  };
  /// Fills the screen; a picture of another size is scaled, bilinearly.
  void Develop(const RenderTarget& picture, double ev100, const Screen& screen) const {
    Develop(picture, ev100, screen, whole_);
  }
  /// The pixels of an area alone.
  void Develop(const RenderTarget& picture, double ev100, const Screen& screen,
               const PassArea& area) const;
  /// Codes in [0, 1], not dithered, for an Enlarger: into a target of the picture's size, whose
  /// fourth component it gets too.
  void DevelopSmall(const RenderTarget& picture, double ev100, const RenderTarget& codes) const;

 private:
  void MakeTable() const;
  void TakeTable() const;
  void UploadDraft() const;
  void Fill(const ShaderProgram& program, const RenderTarget& picture, double ev100,
            const Screen& screen, const PassArea& area) const;

  Look look_;
  ShaderProgram program_, small_program_;
  PassArea whole_;
  GlTexture table_;
  FirstPictures first_;
  mutable bool has_draft_ = false;         // of the look
  mutable bool is_asked_ = false;          // whether its table is there or coming
  mutable std::future<ToneTable> coming_;  // the table, until it is first used
  DitherTexture dither_;
};

/// What develop.frag.glsl is put together with.
[[nodiscard]] std::vector<ShaderPiece> DeveloperTexts(ToneCurve curve, bool dithers);

}  // namespace alpenglow::viewer
