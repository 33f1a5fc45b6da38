// SPDX-License-Identifier: MIT
// Windows whose light is painted small.
#include "viewer/passes/display_pass.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lut/image/tone_mapping.h"
#include "renderer/scene/scene_options.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/parity_views.h"
#include "tests/fixtures/sanitized.h"
#include "tests/viewer/land/headless_land.h"
#include "viewer/flight_session.h"
#include "viewer/passes/auto_quality.h"

namespace alpenglow::viewer {
namespace {

class DisplayPassTest : public tests::HeadlessTile {
 protected:
  static constexpr ImageSize kScreen{480, 270};

  [[nodiscard]] DisplayImage Shown(Quality quality) const {
    const Scene scene = SceneOverTile(tests::PlaceOfSample(225.0, 215.0, 0.0),
                                      CameraFromDegrees({2200.0, false}, 303.0, 0.0, 7.0, 50.0));
    FlightSessionSettings settings;
    settings.land = LandSourceOf(scene);
    settings.quality = {quality};
    settings.size = kScreen;
    FlightSession flight(scene, ParseInstant("2026-06-21T18:40:00Z"), settings);
    flight.WaitUntilReady(kScreen);
    flight.exposure().Set(15.0);
    const RenderTarget screen(kScreen.width, kScreen.height, {PixelFormat::kRgba8},
                              RenderTarget::Depth::kNone);
    flight.Paint({screen.framebuffer(), kScreen.width, kScreen.height}, 0.0);
    return screen.ReadBytes();
  }
};

// The sun stands over a ridge.
TEST_F(DisplayPassTest, LowQualityShowsWhatMediumDoes) {
  const DisplayImage low = Shown(Quality::kLow), medium = Shown(Quality::kMedium);
  ASSERT_EQ(low.rgb.size(), medium.rgb.size());
  std::vector<int> off;
  int white = 0, white_too = 0;
  for (std::size_t i = 0; i < low.rgb.size(); ++i) {
    off.push_back(std::abs(low.rgb[i] - medium.rgb[i]));
    if (medium.rgb[i] == 255) ++white;
    if (medium.rgb[i] == 255 && low.rgb[i] == 255) ++white_too;
  }
  std::sort(off.begin(), off.end());
  EXPECT_LE(off[off.size() / 2], 1) << "codes; dither and rounding";
  // The same light is further apart on the display by the contrast of the look, 1.4.
  const double contrast = GradeOf(AgxLook::kPhoto).contrast;
  EXPECT_LE(off[off.size() * 99 / 100], 6 * contrast) << "relief is as fine as the pixels of light";
  EXPECT_LE(off[off.size() * 995 / 1000], 9 * contrast) << "crests of coarser land lie a pixel off";
  EXPECT_GT(white, 30) << "the sun";
  EXPECT_GT(white_too, white * 9 / 10) << "its disk is as sharp as the screen";
}

/// A scene in a window, its light painted at some scale.
class SmallPictures : public tests::Headless {
 protected:
  static constexpr ImageSize kScreen{640, 360};

  struct Window {
    Scene scene;
    UtcInstant now;
    double ev100;
    bool has_landing_light = false;
  };

  static DisplayImage Shown(const Window& window, const PaintedQuality& painted) {
    const double eye_m = LoadGround(window.scene).eye_height_m;
    CameraPose eye{window.scene.place, window.scene.camera.heading_rad,
                   window.scene.camera.pitch_rad, 0.0, window.scene.camera.fov_rad};
    eye.place.height_m = eye_m;
    const auto part = [&](int side) { return static_cast<int>(std::lround(painted.scale * side)); };
    const PaintedView view{eye, window.now, part(kScreen.width), part(kScreen.height)};
    SkyPainter painter(window.scene, LandSourceOf(window.scene), view, SizesOf(painted));
    if (window.has_landing_light) painter.SetLandingLight(LandingLightOf(eye));
    painter.WaitUntilReady(view);
    const RenderTarget screen(kScreen.width, kScreen.height, {PixelFormat::kRgba8},
                              RenderTarget::Depth::kNone);
    const ToneMapPass::Screen on{screen.framebuffer(), kScreen.width, kScreen.height};
    painter.Paint(
        view, 1,
        DisplayPass::Upscales(view, on) ? SkyPainter::Bodies::kNone : SkyPainter::Bodies::kAll);
    DisplayPass display_pass(Look{});
    FrameDisplay(painter, display_pass).Show(view, window.ev100, on);
    return screen.ReadBytes();
  }
  static LandingLight LandingLightOf(const CameraPose& eye) {
    LandingLight light;
    const ViewAxes axes = AxesOf(eye);
    light.axis = axes.forward;
    light.offset_m = -1.5 * axes.up;
    return light;
  }
};

TEST_F(SmallPictures, StarsAreAsSharpAsTheScreen) {
  const Window night{BareScene(2000.0, 180.0, 30.0, 40.0), ParseInstant("2026-01-15T22:00:00Z"),
                     -8.0};
  const DisplayImage full = Shown(night, {Quality::kHigh, 1.0});
  const DisplayImage small = Shown(night, {Quality::kLow, 0.25, Saving::kNearLand});
  int stars = 0, alike = 0;
  for (std::size_t i = 0; i < full.rgb.size(); ++i) {
    if (full.rgb[i] < 128) continue;
    ++stars;
    if (std::abs(full.rgb[i] - small.rgb[i]) <= 4) ++alike;
  }
  EXPECT_GT(stars, 100) << "channels of pixels that a bright star is in";
  EXPECT_GT(alike, stars * 95 / 100) << "the sky behind them is interpolated";
}

TEST_F(SmallPictures, ALandingLightInFogHasNoSteps) {
  Window window{BareScene(60.0, 200.0, -5.0, 60.0), ParseInstant("2026-12-09T23:30:00Z"), 3.0,
                true};
  window.scene.fog.emplace();
  window.scene.fog->extinction_per_m = 3.0 / 900.0;
  window.scene.fog->scale_height_m = 400.0;
  const DisplayImage full = Shown(window, {Quality::kHigh, 1.0});
  const DisplayImage small = Shown(window, {Quality::kLow, 0.25, Saving::kNearLand});
  std::vector<int> off;
  int lit = 0;
  for (std::size_t i = 0; i < full.rgb.size(); ++i) {
    off.push_back(std::abs(full.rgb[i] - small.rgb[i]));
    if (full.rgb[i] > 60) ++lit;
  }
  std::sort(off.begin(), off.end());
  EXPECT_GT(lit, static_cast<int>(off.size()) / 50) << "what is asked";
  EXPECT_LE(off[off.size() * 99 / 100], 6)
      << "codes; a beam's edge between rays a 320th of it apart";
  EXPECT_LE(off.back(), 16);
}

// One ray a pixel against many: an edge of shade that one ray sees or does not makes stairs.
TEST_F(SmallPictures, EdgesOfShadeAreAsWideAsTheirPixels) {
  const Scene scene = RangeScene({4000.0, false}, 130.0, -25.0);
  CameraPose eye{scene.place, scene.camera.heading_rad, scene.camera.pitch_rad, 0.0,
                 scene.camera.fov_rad};
  eye.place.height_m = LoadGround(scene).eye_height_m;
  const PaintedView view{eye, ParseInstant("2026-06-21T18:10:00Z"), 160, 90};
  SkyPainter painter(scene, LandSourceOf(scene), view, SizesOf(Quality::kLow));
  painter.WaitUntilReady(view);
  painter.Paint(view, 1, SkyPainter::Bodies::kNone);
  const Image one = painter.picture().Read();
  painter.Paint(view, tests::ScaledDown(36, 16), SkyPainter::Bodies::kNone);
  const Image many = painter.picture().Read();
  double sum2 = 0.0;
  for (std::size_t i = 0; i < one.rgb.size(); ++i) {
    const double error = static_cast<double>(one.rgb[i][1] / many.rgb[i][1]) - 1.0;
    sum2 += error * error / static_cast<double>(one.rgb.size());
  }

  EXPECT_LT(std::sqrt(sum2), 0.026) << "noise of materials; 0.030 without the width of pixels";
}

}  // namespace
}  // namespace alpenglow::viewer
