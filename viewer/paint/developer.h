// SPDX-License-Identifier: MIT
// The exposure meter beside drawing: reads small copies of pictures without waiting for them.
//
// The luminance of the picture under the pointer.
//
// The tile of dither noise on the graphics card, for shaders/dither_tile.glsl.
//
// AgX in one of its looks as a table that a graphics card interpolates: nine powers and logarithms a
// pixel, and its hue, are one fetch.
//
// Codes of sRGB over the exposed colour (tone_curve.glsl), which is inside the gamut by then: kSide
// nodes a channel at even steps of its logarithm, from kLowestStop to kHighestStop over saturation.
// Of colours beyond the ends the end is shown: there the curve is flat.
//
// Linear pictures made to look at, on the graphics card.
#pragma once

#include <array>
#include <future>
#include <optional>
#include <vector>

#include "lut/picture/look.h"
#include "lut/picture/tone_mapping.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/gl/render_target.h"
#include "viewer/gl/shader.h"
#include "viewer/layer.h"
#include "viewer/shaders/full_screen.h"

namespace alpenglow::viewer {

/// What a picture says of its light.
struct MeterReading {
  double ev100;        // MeterEv100 of the picture as it is seen
  WhiteBalance white;  // settled
};

/// Of a picture as a camera has it. @param look  not settled.
[[nodiscard]] MeterReading ReadingOf(const Image& picture, const Look& look);

class ExposureMeter {
 public:
  /// Copies every so-manieth pixel, at most kLongSide a row, and begins to read them; nothing while
  /// an earlier copy is still being read.
  void LookAt(const RenderTarget& picture);
  /// The reading of the copy, once it has arrived.
  [[nodiscard]] std::optional<MeterReading> Take(const Look& look);
  /// Of a picture at once, waiting for the graphics card. Copies of earlier ones are not read any more.
  [[nodiscard]] MeterReading Read(const RenderTarget& picture, const Look& look);

  static constexpr int kLongSide = 160;

 private:
  void Copy(const RenderTarget& picture);

  std::optional<RenderTarget> small_;
  PixelReader reader_;
};

/// Asked once a frame, it never waits for the graphics card: what it tells is a frame or two old.
class SpotMeter {
 public:
  /// [cd/m^2], at shares of width and height from the upper left, each in [0, 1). Nothing before the
  /// first has arrived.
  [[nodiscard]] std::optional<double> At(const RenderTarget& picture, double right, double down);
  /// Nothing is pointed at.
  void Leave();

 private:
  std::optional<PixelReader> reader_;
  std::optional<double> luminance_;
};

/// DitherNoise (lut/picture/develop.h), four floats a pixel.
class DitherTexture {
 public:
  DitherTexture();

  /// Tells a program, in use, the unit and the size [pixels] of what it fills.
  void Bind(const ShaderProgram& program, int unit, int width, int height) const;

 private:
  GlTexture noise_;
};

/// Error of trilinear interpolation for colours whose channels lie within three stops of each other,
/// in codes of 8 bits: of photo half below 0.06, all but one in a hundred below 0.25, all below 0.9;
/// of other looks, which clip a channel at an edge between nodes, half below 0.1, all but one in
/// twenty below 0.5, all but one in a hundred below 3.
class ToneTable {
 public:
  static constexpr int kSide = 96;
  static constexpr double kLowestStop = -13.5;
  static constexpr double kHighestStop = 5.0;

  /// @param side  nodes a channel, >= 2; the stated errors are those of kSide.
  explicit ToneTable(AgxLook look, int side = kSide);

  [[nodiscard]] int side() const { return side_; }
  /// side()^3 codes in [0, 1], red fastest.
  [[nodiscard]] const std::vector<std::array<float, 3>>& codes() const { return codes_; }

 private:
  int side_;
  std::vector<std::array<float, 3>> codes_;
};

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
