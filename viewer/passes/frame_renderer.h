// SPDX-License-Identifier: MIT
// Provides FrameRenderer, which draws the frames of a flight onto a screen: linear light by a
// SkyPainter at the quality of the moment, metered, and displayed by a DisplayPass.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "lut/image/white_balance.h"
#include "renderer/picture/reference_picture.h"
#include "viewer/passes/auto_quality.h"
#include "viewer/passes/display_pass.h"
#include "viewer/passes/exposure_control.h"
#include "viewer/passes/sky_painter.h"

namespace alpenglow::viewer {

/// Displays the pictures of a painter. If a picture is upscaled, the painter draws the outline of
/// land and the bodies at screen resolution.
class FrameDisplay {
 public:
  /// Keeps references to both.
  FrameDisplay(SkyPainter& painter, DisplayPass& display_pass)
      : painter_(painter), display_pass_(display_pass) {}

  /// Shows the most recent picture of the painter, which must be of this view.
  /// @param timer  receives the times of the passes; null: none.
  void Show(const PaintedView& view, double ev100, const ToneMapPass::Screen& screen,
            PassTimer* timer = nullptr);

 private:
  struct Shown {
    PaintedView view;
    double ev100;
    ToneMapPass::Screen screen;
    PassTimer* timer;
  };
  void ShowUpscaled(const Shown& shown);
  void ShowBodies(const Shown& shown, const std::vector<PixelBox>& boxes);
  void MakeReady(const Shown& shown);

  SkyPainter& painter_;
  DisplayPass& display_pass_;
  int shown_ = 0;  // pictures
};

/// Receives the completed fraction [0, 1] between the steps of a picture that is being made. A step
/// of the GPU is at most one ray per pixel. An exception of this function ends the picture.
using PictureProgress = std::function<void(double share)>;

/// Times and sizes of the tables that a picture is painted from.
struct TableFigures {
  double air_s, ground_s, shade_s;  // time that the newest ones took
  LandFigures land;
};

class FrameRenderer {
 public:
  /// Keeps references to painter, display pass and exposure.
  FrameRenderer(SkyPainter& painter, DisplayPass& display_pass, ExposureControl& exposure,
                const QualityChoice& quality);

  void Use(const QualityRule& rule);
  [[nodiscard]] const QualityRule& rule() const { return quality_.rule(); }
  /// Returns "auto: medium at 0.7x", "high", or "reference, 16 rays a pixel".
  [[nodiscard]] std::string QualityText() const;
  /// Turns a landing light on or off. It points forward and is mounted below the eye.
  void SetLandingLight(bool is_on) { landing_light_ = is_on; }
  [[nodiscard]] bool has_landing_light() const { return landing_light_; }

  /// Source of the scene that the renderer draws for the quality `reference`, and its version.
  struct ReferenceSource {
    std::function<ReferenceScene()> scene;
    int version;
  };
  /// Paints onto a screen with the exposure of the meter. `seconds` is the time since the previous
  /// frame.
  void Paint(const CameraPose& eye, const UtcTime& now, const ReferenceSource& reference,
             const ToneMapPass::Screen& screen, double seconds);
  /// Records the time that the last frame took without the wait for the screen.
  void RecordFrame(double seconds) { quality_.Record(seconds); }
  /// Returns the linear picture of the last frame.
  [[nodiscard]] const RenderTarget& picture() const { return painter_.picture(); }
  /// Returns the sky of an eye (SkyPainter::SkyAt).
  [[nodiscard]] const std::shared_ptr<const FrameSky>& SkyAt(const Place& eye, const UtcTime& now) {
    return painter_.SkyAt(eye, now);
  }
  /// Returns the luminance [cd/m^2] in a picture of one or two frames ago, at fractions of its
  /// width and height from the upper left corner. Call it once a frame. Returns nullopt outside of
  /// the picture.
  [[nodiscard]] std::optional<double> LuminanceAt(double right, double down);
  /// Stops this measurement: the pointer is not over the picture.
  void LeavePicture() { spot_.Leave(); }

  /// Sets the timer that receives the times of the passes; null: none.
  void SetTimer(PassTimer* timer);
  [[nodiscard]] PassTimer* timer() const { return timer_; }

  /// Waits until everything is ready for a view, and returns its linear picture, which is painted
  /// in tiles of at most `largest_part` pixels a side. Call it with StillSizes.
  /// @param progress  called after each ray of a tile; may be empty.
  [[nodiscard]] HdrImage PaintInParts(const PaintedView& whole, int samples, int largest_part,
                                      const PictureProgress& progress);
  /// Returns the quality of written pictures.
  [[nodiscard]] Quality still_quality() const { return rule().fixed.value_or(Quality::kHigh); }
  /// Paints with the sizes of written pictures while it exists.
  class StillSizes {
   public:
    explicit StillSizes(FrameRenderer& frames) : frames_(frames) {
      frames_.painter_.Use(SizesOf(frames_.still_quality()));
    }
    ~StillSizes() { frames_.painter_.Use(SizesOf(frames_.used_)); }
    StillSizes(const StillSizes&) = delete;
    StillSizes& operator=(const StillSizes&) = delete;

   private:
    FrameRenderer& frames_;
  };
  /// Develops a linear picture onto a screen.
  void ShowStill(const HdrImage& image, const Development& development,
                 const ToneMapPass::Screen& screen);

  /// Returns the progress of the land and of the light on it; nothing while the land is complete.
  [[nodiscard]] std::optional<LandProgress> Progress() const;
  [[nodiscard]] TableFigures Figures() const;
  /// Returns the extinction by media and clouds [1/m] at a place.
  [[nodiscard]] double ExtinctionAt(const Place& place, const UtcTime& now) const;
  /// Returns the medium that is displayed.
  [[nodiscard]] std::shared_ptr<const SolvedAir> air() const {
    return painter_.scene().air().air();
  }

 private:
  [[nodiscard]] bool HasReference() const { return reference_ && reference_->samples() > 0; }
  /// Returns whether the clock has jumped by more than a quarter of an hour since the last frame.
  [[nodiscard]] bool HasJumped(const UtcTime& now);
  void AimLandingLight(const CameraPose& eye);
  void CountRest(const CameraPose& eye, double seconds);
  void ShowReference(const PaintedView& view, const ReferenceSource& source);
  void Meter(bool is_another, const UtcTime& now, double seconds);

  SkyPainter& painter_;
  DisplayPass& display_pass_;
  ExposureControl& exposure_;
  FrameDisplay display_;
  QualityChoice quality_;
  PaintedQuality used_;
  PassTimer* timer_ = nullptr;
  bool landing_light_ = false;
  ExposureMeter meter_;
  SpotMeter spot_;
  std::optional<MeterReading> metered_;
  WhiteBalance metered_for_;  // as selected by the look of metered_
  std::optional<UtcTime> painted_at_;
  std::unique_ptr<ReferencePicture> reference_;
  std::shared_ptr<const ReferenceScene> reference_scene_;
  int reference_version_ = 0;
  std::optional<CameraPose> still_eye_;
  double still_s_ = 0.0;  // how long the eye has been at rest
};

}  // namespace alpenglow::viewer
