// SPDX-License-Identifier: MIT
// Windows whose light is painted small, and the quality that suits a machine.
#include "viewer/passes/display_pass.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "atmosphere/math/constants.h"
#include "lut/image/tone_mapping.h"
#include "renderer/picture/reference_picture.h"
#include "renderer/scene/scene_options.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/parity_views.h"
#include "tests/fixtures/sanitized.h"
#include "tests/renderer/picture/sun_seen.h"
#include "tests/viewer/air/shared_air.h"
#include "tests/viewer/land/headless_land.h"
#include "viewer/flight_session.h"
#include "viewer/gl/gl_context.h"
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
    settings.first_air = tests::SharedAirOf(scene);
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
TEST_F(DisplayPassTest, LowQualityLooksLikeMedium) {
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
  // The contrast of the look, 1.4, enlarges differences of light on the display.
  const double contrast = GradeOf(AgxLook::kPhoto).contrast;
  EXPECT_LE(off[off.size() * 99 / 100], 6 * contrast) << "relief is as fine as the pixels of light";
  EXPECT_LE(off[off.size() * 995 / 1000], 9 * contrast) << "crests of coarser land lie a pixel off";
  EXPECT_GT(white, 30) << "the sun";
  EXPECT_GT(white_too, white * 9 / 10) << "its disk is as sharp as the screen";
}

/// A scene in a window, its light painted at some scale.
class SmallPictures : public tests::HeadlessTile {
 protected:
  static constexpr ImageSize kScreen{640, 360};

  struct Window {
    Scene scene;
    UtcTime now;
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
    SkyPainter painter(window.scene, LandSourceOf(window.scene), view, SizesOf(painted),
                       tests::SharedAirOf(window.scene));
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

/// Numbers of channels that are bright, and of those that are alike in the other picture.
struct Channels {
  int bright = 0, alike = 0;
};

Channels BrightChannels(const DisplayImage& full, const DisplayImage& small) {
  Channels channels;
  for (std::size_t i = 0; i < full.rgb.size(); ++i) {
    if (full.rgb[i] < 128) continue;
    ++channels.bright;
    if (std::abs(full.rgb[i] - small.rgb[i]) <= 4) ++channels.alike;
  }
  return channels;
}

TEST_F(SmallPictures, StarsHaveTheResolutionOfTheScreen) {
  const Window night{BareScene(2000.0, 180.0, 30.0, 40.0), ParseInstant("2026-01-15T22:00:00Z"),
                     -8.0};
  const DisplayImage full = Shown(night, {Quality::kHigh, 1.0});
  const DisplayImage small = Shown(night, {Quality::kLow, 0.25, Saving::kNearLand});
  const auto [stars, alike] = BrightChannels(full, small);
  EXPECT_GT(stars, 100) << "channels of pixels that a bright star is in";
  EXPECT_GT(alike, stars * 95 / 100) << "the sky behind them is interpolated";
}

TEST_F(SmallPictures, ALandingLightInFogHasNoSteps) {
  Window window{BareScene(60.0, 200.0, -5.0, 60.0), ParseInstant("2026-12-09T23:30:00Z"), 3.0,
                true};
  window.scene.layers.emplace_back();
  window.scene.layers[0].extinction_per_m = 3.0 / 900.0;
  window.scene.layers[0].scale_height_m = 400.0;
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

// The outline of land is drawn before the sun, in a pass with a uniform block of its own.
TEST_F(SmallPictures, TheSunInFogIsAsBrightAsAtScreenResolution) {
  const Height eye{2500.0, false};
  Window window{SceneOverTile(tests::PlaceOfSample(225.0, 215.0, 0.0),
                              CameraFromDegrees(eye, 0.0, 0.0, 0.0, 40.0)),
                ParseInstant("2026-06-21T16:00:00Z"), 20.0};
  window.scene.layers.emplace_back();
  window.scene.layers[0].extinction_per_m = 0.002;
  window.scene.layers[0].scale_height_m = 1500.0;
  const SunInSky sun = tests::SunSeenIn(window.scene, window.now);
  window.scene.camera = CameraFromDegrees(eye, sun.azimuth_deg, sun.elevation_deg - 8.0, 0.0, 40.0);
  const DisplayImage full = Shown(window, {Quality::kHigh, 1.0});
  const DisplayImage small = Shown(window, {Quality::kLow, 0.25, Saving::kNearLand});
  const auto [disk, alike] = BrightChannels(full, small);
  EXPECT_GT(disk, 50) << "channels of pixels of the sun's disk, 8 pixels wide";
  EXPECT_GT(alike, disk * 9 / 10) << "the air before the sun is interpolated";
}

// One ray a pixel against many: an edge of shade that one ray sees or does not makes stairs.
TEST_F(SmallPictures, ShadowEdgesAreAsWideAsTheirPixels) {
  const Scene scene = RangeScene({4000.0, false}, 130.0, -25.0);
  CameraPose eye{scene.place, scene.camera.heading_rad, scene.camera.pitch_rad, 0.0,
                 scene.camera.fov_rad};
  eye.place.height_m = scene.camera.height.value_m;
  const PaintedView view{eye, ParseInstant("2026-06-21T18:10:00Z"), 160, 90};
  SkyPainter painter(scene, LandSourceOf(scene), view, SizesOf(Quality::kLow),
                     tests::SharedAirOf(scene));
  painter.WaitUntilReady(view);
  painter.Paint(view, 1, SkyPainter::Bodies::kNone);
  const HdrImage one = painter.picture().Read();
  painter.Paint(view, tests::ScaledDown(36, 16), SkyPainter::Bodies::kNone);
  const HdrImage many = painter.picture().Read();
  double sum2 = 0.0;
  for (std::size_t i = 0; i < one.rgb.size(); ++i) {
    const double error = static_cast<double>(one.rgb[i][1] / many.rgb[i][1]) - 1.0;
    sum2 += error * error / static_cast<double>(one.rgb.size());
  }

  EXPECT_LT(std::sqrt(sum2), 0.026) << "noise of materials; 0.030 without the width of pixels";
}

// --- small pictures on large screens ---

constexpr int kPrintWidth = 64, kPrintHeight = 36, kSmaller = 4;
constexpr glm::dvec2 kHalfView{0.577, 0.325};

/// A screen with a hill before a mountain under a sky, whose edges run between pixels of the small
/// picture.
class UpscalerTest : public tests::Headless {
 protected:
  enum class Seen { kSky, kMountain, kHill };
  static constexpr double kHill_m = 500.0, kMountain_m = 800.0;

  /// @param x, y  pixels of the screen, row 0 at the bottom.
  [[nodiscard]] static Seen At(double x, double y) {
    if (y < 0.4 * x) return Seen::kHill;
    return y < 27.0 - 0.3 * x ? Seen::kMountain : Seen::kSky;
  }
  [[nodiscard]] static std::array<float, 4> PixelOf(Seen seen) {
    switch (seen) {
      case Seen::kHill:
        return {0.1F, 0.5F, 0.2F, InverseDepthAt(kHill_m)};
      case Seen::kMountain:
        return {0.3F, 0.3F, 0.4F, InverseDepthAt(kMountain_m)};
      case Seen::kSky:
        break;
    }
    return {0.5F, 0.7F, 0.9F, 0.0F};
  }
  /// Returns the inverse depth by the formula of gbuffer/inverse_depth.glsl.
  [[nodiscard]] static float InverseDepthAt(double along_view_m) {
    return static_cast<float>(100.0 / along_view_m);
  }

  static void Fill(const RenderTarget& target,
                   const std::function<std::array<float, 4>(int x, int y)>& pixel) {
    target.Bind();
    for (int y = 0; y < target.height(); ++y) {
      for (int x = 0; x < target.width(); ++x) {
        const Scissor one({x, y, 1, 1});
        glClearBufferfv(GL_COLOR, 0, pixel(x, y).data());
      }
    }
  }
  /// Depth as gbuffer/reversed_depth.glsl has it: 0.1 m is 1.
  static void FillDepth(const DepthPrepass& outline,
                        const std::function<float(int x, int y)>& inverse_depth) {
    outline.Bind();
    for (int y = 0; y < outline.height(); ++y) {
      for (int x = 0; x < outline.width(); ++x) {
        const Scissor one({x, y, 1, 1});
        const float depth = 1e-3F * inverse_depth(x, y);
        glClearBufferfv(GL_DEPTH, 0, &depth);
      }
    }
  }
  [[nodiscard]] static HdrImage Upscaled(const RenderTarget& small, const DepthPrepass& outline) {
    const RenderTarget light(kPrintWidth, kPrintHeight);
    Upscaler(Upscaler::Shows::kLight).Upscale(small, outline, kHalfView, light.framebuffer());
    return light.Read();
  }
};

TEST_F(UpscalerTest, EdgesOfLandHaveTheResolutionOfTheScreen) {
  const RenderTarget small(kPrintWidth / kSmaller, kPrintHeight / kSmaller);
  Fill(small, [](int x, int y) { return PixelOf(At(kSmaller * (x + 0.5), kSmaller * (y + 0.5))); });
  const DepthPrepass outline(kPrintWidth, kPrintHeight);
  FillDepth(outline, [](int x, int y) { return PixelOf(At(x + 0.5, y + 0.5))[3]; });
  const HdrImage shown = Upscaled(small, outline);
  int wrong = 0;
  for (int y = 0; y < kPrintHeight; ++y) {
    for (int x = 0; x < kPrintWidth; ++x) {
      const std::array<float, 4> right = PixelOf(At(x + 0.5, y + 0.5));
      for (std::size_t c = 0; c < 3; ++c) {
        if (std::abs(shown.at(x, kPrintHeight - 1 - y)[c] - right[c]) > 0.01F) ++wrong;
      }
    }
  }
  EXPECT_LE(wrong, 3 * 2)
      << "all but where three meet and no small pixel saw the one in the middle; "
         "a hundredth is what pixels beyond an edge still count";
}

TEST_F(UpscalerTest, LightOfOneSurfaceIsInterpolated) {
  const DepthPrepass outline(kPrintWidth, kPrintHeight);
  const RenderTarget small(kPrintWidth / kSmaller, kPrintHeight / kSmaller);
  // Level ground: inverse depth falls to 0 at the horizon, here the upper rim of the picture.
  const auto inverse_depth = [](double y) {
    return static_cast<float>(2.0 * (1.0 - y / kPrintHeight));
  };
  for (const bool is_land : {false, true}) {
    Fill(small, [&](int x, int y) {
      const auto light = static_cast<float>(kSmaller * (x + 0.5) + 3.0 * kSmaller * (y + 0.5));
      return std::array{light, 0.0F, 0.0F, is_land ? inverse_depth(kSmaller * (y + 0.5)) : 0.0F};
    });
    FillDepth(outline, [&](int, int y) { return is_land ? inverse_depth(y + 0.5) : 0.0F; });
    const HdrImage shown = Upscaled(small, outline);
    for (int y = kSmaller; y < kPrintHeight - kSmaller; ++y) {
      for (int x = kSmaller; x < kPrintWidth - kSmaller; ++x) {
        ASSERT_NEAR(shown.at(x, kPrintHeight - 1 - y)[0], x + 0.5 + 3.0 * (y + 0.5), 1e-3)
            << x << ' ' << y << (is_land ? " on land: rounding of floats" : " in the sky");
      }
    }
  }
}

// --- the quality that suits a machine ---

/// A machine on which a frame takes so long at full resolution and high quality; low costs 0.4 of
/// that, medium 0.6, and pixels weigh as their number.
double FrameOf(const PaintedQuality& painted, double full_s) {
  const std::map<Quality, double> cost{
      {Quality::kLow, 0.4}, {Quality::kMedium, 0.6}, {Quality::kHigh, 1.0}};
  return full_s * cost.at(painted.quality) * (0.15 + 0.85 * painted.scale * painted.scale);
}

struct FrameSeries {
  PaintedQuality last;
  double frame_s;
  double longest_s;
  int changes;  // in the second half of the run
};
FrameSeries FramesFor(double full_s, int frames) {
  AutoQuality quality(1.0 / 30.0);
  FrameSeries run{};
  for (int frame = 0; frame < frames; ++frame) {
    const PaintedQuality before = quality.painted();
    run.frame_s = FrameOf(before, full_s);
    run.longest_s = std::max(run.longest_s, run.frame_s);
    quality.Record(run.frame_s);
    if (frame > frames / 2 && !(quality.painted() == before)) ++run.changes;
  }
  run.last = quality.painted();
  return run;
}

TEST(AutoQuality, AFastMachineDrawsAtHighQuality) {
  EXPECT_EQ(FramesFor(0.005, 2000).last, (PaintedQuality{Quality::kHigh, 1.0}));
}

TEST(AutoQuality, AFastMachineWaitsTwoSecondsForHighQuality) {
  EXPECT_EQ(FramesFor(0.005, 70).last, (PaintedQuality{Quality::kHigh, 1.0}));  // 70 frames: 2.3 s
}

// A flight's worst frame may take three times its median: half of that is left to land that
// arrives.
TEST(AutoQuality, FirstFramesOfASlowMachineTakeLittleLonger) {
  for (const double full_s : {0.05, 0.1, 0.2, 0.3, 2.0}) {
    const FrameSeries run = FramesFor(full_s, 600);
    EXPECT_LT(run.longest_s, 2.0 * run.frame_s) << full_s;
  }
}

TEST(AutoQuality, FramesTakeTheWantedTimeIfAnyQualityCan) {
  for (const double full_s : {0.02, 0.04, 0.06, 0.1, 0.2, 0.3}) {
    const FrameSeries run = FramesFor(full_s, 6000);
    EXPECT_LT(run.frame_s, 1.16 / 30.0) << full_s;
    EXPECT_LE(run.changes, 4) << "it settles: a step up that fails is tried ever more rarely";
  }
}

TEST(AutoQuality, ASlowMachineGetsTheCheapestPicture) {
  EXPECT_EQ(FramesFor(2.0, 200).last, (PaintedQuality{Quality::kLow, 0.25, Saving::kNearLand}));
}

TEST(AutoQuality, ResolutionFallsBelowHalfOnlyAtLowQuality) {
  for (const double full_s : {0.08, 0.1, 0.12, 0.15, 0.2, 0.3, 0.4, 2.0}) {
    AutoQuality quality(1.0 / 30.0);
    for (int frame = 0; frame < 400; ++frame) {
      quality.Record(FrameOf(quality.painted(), full_s));
      const PaintedQuality& painted = quality.painted();
      EXPECT_TRUE(painted.scale >= 0.5 || painted.saving == Saving::kNearLand) << full_s;
      EXPECT_TRUE(painted.scale <= 0.5 || painted.saving == Saving::kNone) << full_s;
    }
  }
}

TEST(AutoQuality, SpacingOfRaysOnTheScreenIsKept) {
  const PaintSizes half = SizesOf(PaintedQuality{Quality::kLow, 0.5, Saving::kNearLand});
  const PaintSizes quarter = SizesOf(PaintedQuality{Quality::kLow, 0.25, Saving::kNearLand});
  EXPECT_EQ(2 * quarter.lamps.step, half.lamps.step);
  EXPECT_EQ(2 * quarter.shade.detail.scale, half.shade.detail.scale);
}

TEST(AutoQuality, ReactsToThreeVeryLongFrames) {
  AutoQuality quality(1.0 / 30.0);
  for (int frame = 0; frame < 3; ++frame) quality.Record(0.6);
  EXPECT_EQ(quality.painted(), (PaintedQuality{Quality::kLow, 0.25, Saving::kNearLand}));
}

TEST(AutoQuality, IgnoresOneLongFrame) {
  AutoQuality quality(1.0 / 30.0);
  const PaintedQuality first = quality.painted();
  quality.Record(0.7);
  for (int frame = 0; frame < 20; ++frame) {
    quality.Record(frame % 5 == 4 ? 0.3 : 0.03);
    EXPECT_EQ(quality.painted(), first) << frame;
  }
}

TEST(QualityRule, IsParsedFromItsName) {
  EXPECT_EQ(QualityRuleFromText("auto").fixed, std::nullopt);
  EXPECT_EQ(QualityRuleFromText("reference").fixed, Quality::kReference);
  EXPECT_NE(tests::FaultOf([] { return QualityRuleFromText("best"); }).find("--quality"),
            std::string::npos);
  EXPECT_EQ(TextOf(PaintedQuality{Quality::kLow, 0.7}), "low, light at 0.7x");
  EXPECT_EQ(TextOf(PaintedQuality{Quality::kLow, 0.5, Saving::kFewLamps}),
            "low, light at 0.5x, coarse shafts, few lamps");
}

}  // namespace
}  // namespace alpenglow::viewer
