// SPDX-License-Identifier: MIT
// Display of linear pictures on the GPU: exposure metering, white balance, tone mapping and dither,
// on a screen that may be larger than the picture.
//
// ExposureMeter reads back small copies of pictures without waiting for them. SpotMeter reads the
// luminance under the pointer. DitherTexture holds the tile of dither noise for
// shaders/display/dither.glsl.
//
// ToneTable tabulates AgX in one of its looks as a 3D texture. One fetch replaces nine powers and
// logarithms per pixel and the hue correction. It holds sRGB codes as a function of the exposed
// colour (tone_curve.glsl), which is inside the gamut at that stage: kSide nodes per channel,
// evenly spaced in its logarithm, from kLowestStop to kHighestStop relative to saturation. Colours
// beyond the ends are clamped, since the curve is flat there.
//
// ToneMapPass applies all steps to a linear picture, and DisplayPass shows it on a screen. If the
// picture is smaller than the screen, it is tone-mapped at its own resolution and then upscaled by
// Upscaler, which interpolates smooth areas and uses the edges of land at screen resolution
// (shaders/display/upscale.frag.glsl). The cost of lighting is that of the small picture, and edges
// stay sharp.
#pragma once

#include <array>
#include <future>
#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "lut/image/look.h"
#include "lut/image/tone_mapping.h"
#include "lut/image/white_balance.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/pass_timer.h"
#include "viewer/gl/render_target.h"
#include "viewer/gl/shader.h"
#include "viewer/land/land_pass.h"
#include "viewer/layer.h"
#include "viewer/passes/painted_view.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {

/// Measurements of a picture for exposure and white balance.
struct MeterReading {
  double ev100;        // MeterEv100 of the picture after white balance
  WhiteBalance white;  // resolved
};

/// Returns the reading of a picture of a perspective camera.
/// @param look  white balance not yet resolved.
[[nodiscard]] MeterReading ReadingOf(const HdrImage& picture, const Look& look,
                                     Projection projection = Projection::kCamera);

class ExposureMeter {
 public:
  /// Copies every n-th pixel, at most kLongSide per row, and starts to read them back. Does nothing
  /// while an earlier copy is being read.
  void LookAt(const RenderTarget& picture);
  /// Returns the reading of the copy once it has arrived.
  [[nodiscard]] std::optional<MeterReading> Poll(const Look& look);
  /// Returns the reading of a picture immediately, waiting for the GPU. Pending copies are
  /// discarded.
  [[nodiscard]] MeterReading Read(const RenderTarget& picture, const Look& look);

  static constexpr int kLongSide = 160;

 private:
  void Copy(const RenderTarget& picture);

  std::optional<RenderTarget> small_;
  PixelReader reader_;
};

/// Luminance under the pointer. It is called once per frame and never waits for the GPU; the value
/// is one or two frames old.
class SpotMeter {
 public:
  /// Returns the luminance [cd/m^2] at fractions of width and height from the upper left, each in
  /// [0, 1). Empty until the first value has arrived.
  [[nodiscard]] std::optional<double> At(const RenderTarget& picture, double right, double down);
  /// Stops the measurement: the pointer is not over the picture.
  void Leave();

 private:
  std::optional<PixelReader> reader_;
  std::optional<double> luminance_;
};

/// DitherNoise (lut/image/dither.h) as a texture, four floats per pixel.
class DitherTexture {
 public:
  DitherTexture();

  /// Sets the texture unit and the size of the target [pixels] in a program, which must be in use.
  void Bind(const ShaderProgram& program, int unit, int width, int height) const;

 private:
  GlTexture noise_;
};

/// AgX as a table of display codes. Error of trilinear interpolation for colours whose channels lie
/// within three stops of each other, in 8-bit codes: for photo 50 % below 0.06, 99 % below 0.25,
/// all below 0.9; for other looks, which clip a channel at an edge between nodes, 50 % below 0.1,
/// 95 % below 0.5, 99 % below 3.
class ToneTable {
 public:
  static constexpr int kSide = 96;
  static constexpr double kLowestStop = -13.5;
  static constexpr double kHighestStop = 5.0;

  /// @param side  nodes per channel, >= 2. The errors above are for kSide.
  explicit ToneTable(AgxLook look, int side = kSide);

  [[nodiscard]] int side() const { return side_; }
  /// side()^3 codes in [0, 1], red fastest.
  [[nodiscard]] const std::vector<std::array<float, 3>>& codes() const { return codes_; }

 private:
  int side_;
  std::vector<std::array<float, 3>> codes_;
};

/// Returns the table of a look with kSide nodes per channel. The first call for a look computes it on
/// a worker thread; the process keeps it, 11 MB per look.
[[nodiscard]] std::shared_future<ToneTable> ToneTableOf(AgxLook look);

/// Applies white balance, exposure, gamut mapping, tone curve and dither, as Seen and Develop
/// (look.h) do. Local exposure and night vision are not applied.
class ToneMapPass {
 public:
  /// Behaviour before the table of the look is ready: kWait waits for it and is exact, kDraft uses
  /// a coarse table, with errors up to 9 codes.
  enum class FirstPictures { kWait, kDraft };
  /// The table of the look is requested by the first picture that needs it (ToneTableOf).
  /// @param look  resolved (look.h), here and below.
  explicit ToneMapPass(const Look& look, FirstPictures first = FirstPictures::kWait);

  /// Changes the look. Parts that are equal in both looks are not recomputed.
  void Use(const Look& look);
  [[nodiscard]] const Look& look() const { return look_; }

  /// Target of the displayed picture: a framebuffer (0: the window) and its size [pixels].
  struct Screen {
    GLuint framebuffer;
    int width, height;
  };
  /// Fills the screen. A picture of another size is scaled bilinearly.
  void Develop(const RenderTarget& picture, double ev100, const Screen& screen) const {
    Develop(picture, ev100, screen, whole_);
  }
  /// Fills only the pixels of an area.
  void Develop(const RenderTarget& picture, double ev100, const Screen& screen,
               const PassArea& area) const;
  /// Writes codes in [0, 1] without dither, for an Upscaler, to a target of the picture's size. The
  /// fourth component of the picture is copied.
  void DevelopSmall(const RenderTarget& picture, double ev100, const RenderTarget& codes) const;

 private:
  void TakeTable() const;
  void UploadDraft() const;
  void Fill(const ShaderProgram& program, const RenderTarget& picture, double ev100,
            const Screen& screen, const PassArea& area) const;

  Look look_;
  ShaderProgram program_, small_program_;
  PassArea whole_;
  GlTexture table_;
  FirstPictures first_;
  mutable bool has_draft_ = false, has_table_ = false;  // of the current look
  mutable std::shared_future<ToneTable> coming_;        // its table, until it is uploaded
  DitherTexture dither_;
};

/// Returns the shader texts before display/tone_map.frag.glsl. They define the macro of the curve.
[[nodiscard]] std::vector<ShaderPiece> ToneMapPassTexts(ToneCurve curve, bool dithers);

class Upscaler {
 public:
  enum class Shows {
    kCodes,  // display codes, dithered to bytes
    kLight   // linear light, for comparisons
  };
  explicit Upscaler(Shows shows);

  /// Fills the framebuffer (0: the window), which has the size of the outline.
  /// @param small      of any size, with the inverse depth of land (gbuffer/inverse_depth.glsl) in its
  ///   fourth component.
  /// @param half_view  tangents of half the horizontal and half the vertical field of view.
  void Upscale(const RenderTarget& small, const DepthPrepass& outline, const glm::dvec2& half_view,
               GLuint framebuffer) const {
    Upscale(small, outline, half_view, framebuffer, whole_);
  }
  /// Fills only the pixels of an area.
  void Upscale(const RenderTarget& small, const DepthPrepass& outline, const glm::dvec2& half_view,
               GLuint framebuffer, const PassArea& area) const;

 private:
  Shows shows_;
  ShaderProgram program_;
  PassArea whole_;
  DitherTexture dither_;
};

/// Returns the shader texts that display/upscale.frag.glsl is built from.
/// @param depth  text of a depth mode: LandPass::DepthText, or the other one.
[[nodiscard]] std::vector<ShaderPiece> UpscalerTexts(Upscaler::Shows shows,
                                                     const ShaderPiece& depth);

/// Shows pictures of linear light on a screen, whole or upscaled. Bodies, which are disks and
/// stars, are not upscaled: they are added to linear light at screen resolution and developed
/// there.
class DisplayPass {
 public:
  explicit DisplayPass(const Look& look,
                       ToneMapPass::FirstPictures first = ToneMapPass::FirstPictures::kWait)
      : tone_map_(look, first) {}

  [[nodiscard]] ToneMapPass& tone_map() { return tone_map_; }

  /// Returns whether a view is upscaled on this screen. Its picture must then be rendered without
  /// bodies.
  [[nodiscard]] static bool Upscales(const PaintedView& view, const ToneMapPass::Screen& screen) {
    return view.width < screen.width || view.height < screen.height;
  }

  /// Returns the outline of land at screen resolution, for the caller to draw before ShowUpscaled.
  [[nodiscard]] const DepthPrepass& OutlineFor(const ToneMapPass::Screen& screen);
  /// Shows a picture upscaled along the outline.
  /// @param half_view  tangents of half the horizontal and half the vertical field of view.
  /// @param timer      receives the times of the passes; null: none.
  void ShowUpscaled(const RenderTarget& picture, const glm::dvec2& half_view, double ev100,
                    const ToneMapPass::Screen& screen, PassTimer* timer);
  /// Returns the linear light of a picture, upscaled to the screen in some boxes of pixels, for the
  /// caller to add bodies before ShowBodies.
  [[nodiscard]] const RenderTarget& LightIn(const std::vector<PixelBox>& boxes,
                                            const RenderTarget& picture,
                                            const glm::dvec2& half_view,
                                            const ToneMapPass::Screen& screen);
  /// Shows these boxes. Edges of bodies differ from those of land, so the light around them is
  /// upscaled before it is tone-mapped.
  void ShowBodies(double ev100, const ToneMapPass::Screen& screen) const {
    tone_map_.Develop(*light_, ev100, screen, bodies_);
  }

 private:
  ToneMapPass tone_map_;
  Upscaler code_upscaler_{Upscaler::Shows::kCodes}, light_upscaler_{Upscaler::Shows::kLight};
  std::optional<RenderTarget> codes_, light_;  // at picture size; at screen size
  std::optional<DepthPrepass> outline_;
  PassArea bodies_;
};

}  // namespace alpenglow::viewer
