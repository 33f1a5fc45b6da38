// SPDX-License-Identifier: MIT
#include "viewer/passes/frame_renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "lut/cli/program.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/render_target.h"

namespace alpenglow::viewer {
namespace {

// The renderer starts its picture after the eye has been at rest for this time.
constexpr double kStandsStill_s = 0.3;

PaintedView OnScreen(const PaintedView& view, const ToneMapPass::Screen& screen) {
  return {view.eye, view.now, screen.width, screen.height, view.part};
}

// Returns the size of the picture that is painted for a screen.
ImageSize PaintedSize(const ToneMapPass::Screen& screen, double scale) {
  const auto scaled = [&](int side) {
    const int part = std::max(static_cast<int>(std::lround(scale * side)), 1);
    return scale < 1.0 ? OffPowersOfTwo(part) : part;
  };
  return {scaled(screen.width), scaled(screen.height)};
}

}  // namespace

void FrameDisplay::ShowUpscaled(const Shown& shown) {
  painter_.PaintOutline(display_pass_.OutlineFor(shown.screen));
  display_pass_.ShowUpscaled(painter_.picture(), HalfViewOf(shown.view), shown.ev100, shown.screen,
                             shown.timer);
}

void FrameDisplay::ShowBodies(const Shown& shown, const std::vector<PixelBox>& boxes) {
  if (boxes.empty()) return;
  const TimedPass timed(shown.timer, "bodies");
  const RenderTarget& light =
      display_pass_.LightIn(boxes, painter_.picture(), HalfViewOf(shown.view), shown.screen);
  painter_.PaintBodiesOver(light, display_pass_.OutlineFor(shown.screen),
                           OnScreen(shown.view, shown.screen));
  display_pass_.ShowBodies(shown.ev100, shown.screen);
}

// Drivers finish compiling a program on its first draw, which takes tenths of a second. The
// programs are therefore drawn once in the second and third frame, over one pixel that is
// overwritten afterwards, instead of when the picture is first reduced.
void FrameDisplay::MakeReady(const Shown& shown) {
  constexpr PixelBox kOnePixel{0, 0, 1, 1};
  if (shown_ == 2) {
    const Scissor within(kOnePixel);
    ShowUpscaled(shown);
  }
  if (shown_ == 3) ShowBodies(shown, {kOnePixel});
}

void FrameDisplay::Show(const PaintedView& view, double ev100, const ToneMapPass::Screen& screen,
                        PassTimer* timer) {
  const Shown shown{view, ev100, screen, timer};
  ++shown_;
  MakeReady(shown);
  if (DisplayPass::Upscales(view, screen)) {
    ShowUpscaled(shown);
    ShowBodies(shown, painter_.BodiesSeen(OnScreen(view, screen)));
  } else {
    const TimedPass timed(timer, "tone_map");
    display_pass_.tone_map().Develop(painter_.picture(), ev100, screen);
  }
}

FrameRenderer::FrameRenderer(SkyPainter& painter, DisplayPass& display_pass,
                             ExposureControl& exposure, const QualityChoice& quality)
    : painter_(painter),
      display_pass_(display_pass),
      exposure_(exposure),
      display_(painter, display_pass),
      quality_(quality),
      used_(quality.painted()) {}

void FrameRenderer::Use(const QualityRule& rule) {
  quality_.Use(rule);
  reference_.reset();
}

std::string FrameRenderer::QualityText() const {
  if (!rule().fixed) return "auto: " + TextOf(quality_.painted());
  if (*rule().fixed == Quality::kReference && HasReference())
    return fmt::format("reference, {} rays a pixel", reference_->samples());
  return NameOf(*rule().fixed);
}

void FrameRenderer::SetTimer(PassTimer* timer) {
  timer_ = timer;
  painter_.SetTimer(timer);
}

void FrameRenderer::AimLandingLight(const CameraPose& eye) {
  if (!landing_light_) return painter_.SetLandingLight(std::nullopt);
  LandingLight light;
  const ViewAxes axes = AxesOf(eye);
  light.axis = axes.forward;
  light.offset_m = -1.5 * axes.up;
  painter_.SetLandingLight(light);
}

std::optional<double> FrameRenderer::LuminanceAt(double right, double down) {
  const bool is_inside = right >= 0.0 && right < 1.0 && down >= 0.0 && down < 1.0;
  if (exposure_.exposure().ev100 && is_inside) return spot_.At(picture(), right, down);
  spot_.Leave();
  return std::nullopt;
}

void FrameRenderer::CountRest(const CameraPose& eye, double seconds) {
  still_s_ = still_eye_ == eye ? still_s_ + seconds : 0.0;
  still_eye_ = eye;
}

void FrameRenderer::ShowReference(const PaintedView& view, const ReferenceSource& source) {
  const bool wanted =
      rule().fixed == std::optional(Quality::kReference) && still_s_ >= kStandsStill_s;
  if (!wanted) return;
  if (!reference_) reference_ = std::make_unique<ReferencePicture>();
  if (!reference_scene_) reference_scene_ = std::make_shared<const ReferenceScene>(source.scene());
  reference_->Show({reference_scene_, view.eye, view.now, view.width, view.height});
  if (const std::optional<HdrImage> image = reference_->Poll()) painter_.Show(*image);
}

// A clock at 3600 times real time passes these 900 s in a quarter of a second.
bool FrameRenderer::HasJumped(const UtcTime& now) {
  constexpr double kJump_s = 900.0;
  const std::optional<UtcTime> before = std::exchange(painted_at_, now);
  return before && std::abs(SecondsBetween(*before, now)) > kJump_s;
}

// A picture that is unrelated to the previous one is metered at once.
void FrameRenderer::Meter(bool is_another, const UtcTime& now, double seconds) {
  const Look& look = exposure_.look();
  if (std::exchange(metered_for_, look.white) != look.white) metered_.reset();
  if (const std::optional<MeterReading> metered = meter_.Poll(look)) metered_ = metered;
  meter_.LookAt(picture());
  if (!metered_ || is_another) metered_ = meter_.Read(picture(), look);
  if (is_another) exposure_.Forget();
  exposure_.Follow(*metered_, now, seconds);
  display_pass_.tone_map().Use(exposure_.ShownLook());
}

void FrameRenderer::Paint(const CameraPose& eye, const UtcTime& now,
                          const ReferenceSource& reference, const ToneMapPass::Screen& screen,
                          double seconds) {
  const PaintedQuality wanted = quality_.painted();
  if (wanted != used_) painter_.Use(SizesOf(wanted));
  used_ = wanted;
  if (std::exchange(reference_version_, reference.version) != reference.version) {
    reference_.reset();
    reference_scene_.reset();
  }
  CountRest(eye, seconds);
  AimLandingLight(eye);
  const ImageSize size = PaintedSize(screen, wanted.scale);
  const PaintedView view{eye, now, size.width, size.height};
  const bool awaited_land = painter_.AwaitsLand();
  painter_.Update(view, seconds);
  const bool is_another = (awaited_land && !painter_.AwaitsLand()) || HasJumped(now);
  if (!HasReference() || still_s_ == 0.0) {
    painter_.Paint(
        view, 1,
        DisplayPass::Upscales(view, screen) ? SkyPainter::Bodies::kNone : SkyPainter::Bodies::kAll);
  }
  ShowReference(OnScreen(view, screen), reference);
  Meter(is_another, now, seconds);
  display_.Show(view, *exposure_.exposure().ev100, screen, timer_);
}

HdrImage FrameRenderer::PaintInParts(const PaintedView& whole, int samples, int largest_part,
                                     const PictureProgress& progress) {
  AimLandingLight(whole.eye);
  painter_.WaitUntilReady(whole, samples);
  TiledPicture picture(whole.width, whole.height, largest_part);
  const auto slices = static_cast<double>(picture.tiles().size()) * samples;
  int slices_before = 0;
  const auto after_sample = [&](int sample) {
    ThrowIfInterrupted();
    if (!progress) return;
    glFinish();  // completes the GPU's work before other threads use the GPU
    progress((slices_before + sample) / slices);
  };
  for (const TiledPicture::Tile& tile : picture.tiles()) {
    ThrowIfInterrupted();
    painter_.Paint(
        {whole.eye, whole.now, tile.painted.width, tile.painted.height, picture.ViewOf(tile)},
        samples, SkyPainter::Bodies::kAll, after_sample);
    picture.Put(tile, painter_.picture().Read());
    slices_before += samples;
  }
  return picture.Take();
}

void FrameRenderer::ShowStill(const HdrImage& image, const Development& development,
                              const ToneMapPass::Screen& screen) {
  const RenderTarget picture(image.width, image.height, RenderTarget::Depth::kNone);
  picture.Write(image);
  display_pass_.tone_map().Use(development.look);
  display_pass_.tone_map().Develop(picture, development.ev100, screen);
}

std::optional<LandProgress> FrameRenderer::Progress() const {
  LandProgress progress = painter_.land().Progress();
  if (progress.share < 1.0) return progress;
  if (painter_.AwaitsLand()) return LandProgress{1.0, "terrain: light on the land"};
  return std::nullopt;
}

TableFigures FrameRenderer::Figures() const {
  const PaintedScene& scene = painter_.scene();
  return {scene.air().making_s(), scene.ground().making_s(), scene.shade().making_s(),
          scene.land().Figures()};
}

double FrameRenderer::ExtinctionAt(const Place& place, const UtcTime& now) const {
  const PaintedScene& scene = painter_.scene();
  return scene.media().ExtinctionAt(place.height_m) + scene.clouds().ExtinctionAt(place, now);
}

}  // namespace alpenglow::viewer
