// SPDX-License-Identifier: MIT
// Small pictures on large screens.
#include "viewer/passes/display_pass.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "renderer/picture/reference_picture.h"
#include "tests/viewer/land/headless_land.h"
#include "viewer/gl/gl_objects.h"

namespace alpenglow::viewer {
namespace {

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
  /// Returns the inverse depth by the formula of gbuffer.inverse_depth.glsl.
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
  /// Depth as gbuffer.reversed_depth.glsl has it: 0.1 m is 1.
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
  [[nodiscard]] static Image Upscaled(const RenderTarget& small, const DepthPrepass& outline) {
    const RenderTarget light(kPrintWidth, kPrintHeight);
    Upscaler(Upscaler::Shows::kLight).Upscale(small, outline, kHalfView, light.framebuffer());
    return light.Read();
  }
};

TEST_F(UpscalerTest, EdgesOfLandAreAsSharpAsTheScreen) {
  const RenderTarget small(kPrintWidth / kSmaller, kPrintHeight / kSmaller);
  Fill(small, [](int x, int y) { return PixelOf(At(kSmaller * (x + 0.5), kSmaller * (y + 0.5))); });
  const DepthPrepass outline(kPrintWidth, kPrintHeight);
  FillDepth(outline, [](int x, int y) { return PixelOf(At(x + 0.5, y + 0.5))[3]; });
  const Image shown = Upscaled(small, outline);
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

TEST_F(UpscalerTest, OnOneSurfaceLightIsInterpolated) {
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
    const Image shown = Upscaled(small, outline);
    for (int y = kSmaller; y < kPrintHeight - kSmaller; ++y) {
      for (int x = kSmaller; x < kPrintWidth - kSmaller; ++x) {
        ASSERT_NEAR(shown.at(x, kPrintHeight - 1 - y)[0], x + 0.5 + 3.0 * (y + 0.5), 1e-3)
            << x << ' ' << y << (is_land ? " on land: rounding of floats" : " in the sky");
      }
    }
  }
}

}  // namespace
}  // namespace alpenglow::viewer
