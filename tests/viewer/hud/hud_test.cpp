// SPDX-License-Identifier: MIT
// Instruments and panels as a whole: hidden, scaled, clicked on.
#include "viewer/hud/hud.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "tests/viewer/hud/hud_picture.h"

namespace alpenglow::viewer {
namespace {

using tests::Changes;
using tests::FrameOf;

constexpr int kWidth = 1280, kHeight = 720;

class HudTest : public tests::HudPicture {
 protected:
  /// A frame with the pointer there.
  Changes At(Hud& hud, double x, double y, bool pressed) {
    InputFrame input = Still(kWidth, kHeight);
    input.events.pointer = PointerPlace{x, y};
    input.events.buttons[0] = pressed;
    return FrameOf(hud, model_, input);
  }
  /// Moves there, presses and lets go: what was asked for in these two frames.
  std::array<Changes, 2> Click(Hud& hud, double x, double y) {
    static_cast<void>(At(hud, x, y, false));
    Changes pressed = At(hud, x, y, true);
    return {std::move(pressed), At(hud, x, y, false)};
  }
  /// Clicks along a column of the picture until that is asked for.
  template <typename Asked>
  std::optional<PointerPlace> Find(Hud& hud, double x, int from_y, int to_y, const Asked& asked) {
    const int step = from_y < to_y ? 4 : -4;
    for (int y = from_y; y != to_y; y += step) {
      const std::array<Changes, 2> requests = Click(hud, x, y);
      if (std::any_of(requests.begin(), requests.end(), asked))
        return PointerPlace{x, static_cast<double>(y)};
    }
    return std::nullopt;
  }

  HudModel model_ = tests::Flying();
};

TEST_F(HudTest, HiddenItLeavesEveryByteOfThePictureAsItWas) {
  Hud hud;
  hud.Toggle(HudPanel::kHelp);
  hud.ToggleMenu();
  const Image shown = Drawn(hud, model_, kWidth, kHeight);
  hud.ToggleVisible();
  const Image hidden = Drawn(hud, model_, kWidth, kHeight);
  const Image grey = [] {
    Image image(kWidth, kHeight);
    for (auto& pixel : image.rgb) pixel = {0.5F, 0.5F, 0.5F};
    return image;
  }();
  EXPECT_FALSE(Difference(grey, shown).empty());
  EXPECT_TRUE(Difference(grey, hidden).empty());
  EXPECT_FALSE(hud.Taken().mouse);
  hud.ToggleVisible();
  EXPECT_TRUE(Difference(shown, Drawn(hud, model_, kWidth, kHeight)).empty())
      << "and it comes back as it was";
}

TEST_F(HudTest, HidingWorksBetweenLayoutAndPaint) {
  Hud hud;
  FrameOf(hud, model_, Still(64, 48));
  hud.ToggleVisible();
  const RenderTarget target(64, 48, RenderTarget::Depth::kNone);
  target.Bind();
  glClearColor(0.25F, 0.5F, 0.75F, 1.0F);
  glClear(GL_COLOR_BUFFER_BIT);
  hud.Paint(target.framebuffer());
  for (const auto& pixel : target.Read().rgb) {
    ASSERT_EQ(pixel, (std::array<float, 3>{0.25F, 0.5F, 0.75F}));
  }
}

TEST_F(HudTest, PaintingLeavesTheStateThatPassesExpect) {
  Hud hud;
  static_cast<void>(Drawn(hud, model_, 320, 240));
  EXPECT_FALSE(glIsEnabled(GL_BLEND));
  EXPECT_FALSE(glIsEnabled(GL_SCISSOR_TEST));
  EXPECT_FALSE(glIsEnabled(GL_DEPTH_TEST));
  GLint layout = -1;
  glGetIntegerv(GL_VERTEX_ARRAY_BINDING, &layout);
  EXPECT_EQ(layout, 0);
}

TEST_F(HudTest, APictureWithoutPixelsIsNotDrawnOn) {
  Hud hud;
  FrameOf(hud, model_, Still(0, 0));
  hud.Paint(0);
  EXPECT_FALSE(hud.Taken().mouse);
}

TEST_F(HudTest, RefusesAScaleOutOfRangeAndAFontThatIsNone) {
  EXPECT_THROW(Hud({.scale = 0.4}), InputError);
  EXPECT_THROW(Hud({.scale = std::nan("")}), InputError);
  HudSettings settings;
  settings.font = "/nowhere/letters.ttf";
  EXPECT_THROW(Hud{settings}, InputError);
}

TEST_F(HudTest, TheMouseIsThePanelsWhereTheyAreAndTheFlightsElsewhere) {
  Hud hud;
  hud.Toggle(HudPanel::kLeave);  // in the middle below the clock
  for (int frame = 0; frame < 3; ++frame)
    static_cast<void>(At(hud, 0.5 * kWidth, 0.57 * kHeight, false));
  EXPECT_TRUE(hud.Taken().mouse);
  static_cast<void>(At(hud, 0.2 * kWidth, 0.8 * kHeight, false));
  EXPECT_FALSE(hud.Taken().mouse);
  static_cast<void>(At(hud, 0.2 * kWidth, 0.8 * kHeight, true));
  static_cast<void>(At(hud, 0.5 * kWidth, 0.57 * kHeight, true));
  EXPECT_FALSE(hud.Taken().mouse) << "a drag that began in the picture stays the flight's";
}

TEST_F(HudTest, AClickIntoTheStripOfTheDayIsAShareOfTheDay) {
  Hud hud;
  hud.Toggle(HudPanel::kPlaceAndTime);
  const auto found = Find(hud, 200.0, 40, 300,
                          [](const Changes& request) { return request.day_fraction.has_value(); });
  ASSERT_TRUE(found.has_value());
  static_cast<void>(At(hud, found->right, found->down + 4.0, false));
  const double here = At(hud, found->right, found->down + 4.0, true).day_fraction.value();
  const double there = At(hud, found->right + 110.0, found->down + 4.0, true).day_fraction.value();
  EXPECT_NEAR(there - here, 110.0 / 440.0, 1e-6) << "the strip is 440 pixels wide";
  EXPECT_EQ(At(hud, 0.0, found->down, true).day_fraction, 0.0) << "midnight, while held";
  EXPECT_EQ(At(hud, 900.0, found->down, true).day_fraction, 1.0);
  EXPECT_EQ(At(hud, 900.0, found->down, false).day_fraction, std::nullopt);
}

TEST_F(HudTest, ASliderAsksForWhatItIsDraggedTo) {
  Hud hud;
  hud.Toggle(HudPanel::kAir);
  const double x = kWidth - 10.0 - 200.0;
  // From below: the ground's albedo, then ozone; lists are above them.
  const auto found = Find(
      hud, x, 300, 60, [](const Changes& request) { return request.air && request.air->ozone_du; });
  ASSERT_TRUE(found.has_value());
  static_cast<void>(At(hud, x, found->down, false));
  static_cast<void>(At(hud, x, found->down, true));
  EXPECT_EQ(At(hud, x - 500.0, found->down, true).air.value().ozone_du, 0.0);
  EXPECT_EQ(At(hud, x + 500.0, found->down, true).air.value().ozone_du, 600.0);
  const Changes none = At(hud, x + 500.0, found->down, false);
  EXPECT_FALSE(none.air) << "nothing is asked for once it is let go";
}

TEST_F(HudTest, TheLandingLightIsSwitchedWhereItsNameStands) {
  Hud hud;
  hud.Toggle(HudPanel::kLights);
  EXPECT_TRUE(Find(hud, kWidth - 100.0, 250, 482, [](const Changes& request) {
                return request.landing_light;
              }).has_value());
}

TEST_F(HudTest, ATypedInstantIsAskedForWithEnter) {
  Hud hud;
  hud.Toggle(HudPanel::kPlaceAndTime);
  std::optional<double> field_y;
  for (int y = 150; y < 400 && !field_y; y += 4) {
    static_cast<void>(Click(hud, 120.0, y));
    static_cast<void>(At(hud, 120.0, y, false));
    if (hud.Taken().keyboard) field_y = y;
  }
  ASSERT_TRUE(field_y.has_value()) << "a field that takes letters";
  InputFrame typing = Still(kWidth, kHeight);
  typing.events.text = "2026-06-21T04:00:00Z";
  FrameOf(hud, model_, typing);
  typing.events.text.clear();
  typing.events.keys = {{GLFW_KEY_ENTER, 0, GLFW_PRESS, 0, ""}};
  EXPECT_EQ(FrameOf(hud, model_, typing).time, "2026-06-21T04:00:00Z");
}

TEST_F(HudTest, APictureIsAskedForInTheSizeThatIsSeen) {
  Hud hud;
  hud.Toggle(HudPanel::kCapture);
  std::optional<PictureOrder> capture;
  // From below: the recorder, then the buttons.
  const auto found = Find(hud, 0.5 * kWidth - 105.0, 260, 80, [&](const Changes& request) {
    capture = request.picture;
    return capture.has_value();
  });
  ASSERT_TRUE(found.has_value());
  EXPECT_FALSE(capture->is_exr);
  ASSERT_TRUE(capture->size.has_value());
  EXPECT_EQ(capture->size->width, kWidth);
  EXPECT_EQ(capture->size->height, kHeight);
  EXPECT_FALSE(capture->with_instruments);
}

TEST_F(HudTest, TheHeadingThatIsHeldIsTheOneFlown) {
  Hud hud;
  model_.flight.heading_rad = -0.5;
  hud.Toggle(HudPanel::kFlight);
  std::optional<std::optional<double>> hold;
  const auto asked = [&](const Changes& request) {
    hold = request.heading_rad;
    return hold.has_value();
  };
  ASSERT_TRUE(Find(hud, 0.5 * kWidth - 100.0, 500, 680, asked).has_value());
  ASSERT_TRUE(hold->has_value());
  EXPECT_NEAR(**hold, 2.0 * kPi - 0.5, 1e-9) << "in [0, 2 pi]";
  model_.autopilot.heading_rad = **hold;
  ASSERT_TRUE(Find(hud, 0.5 * kWidth - 100.0, 500, 680, asked).has_value());
  EXPECT_FALSE(hold->has_value()) << "a second click lets it go";
}

TEST_F(HudTest, LeavingIsAskedOnce) {
  Hud hud;
  hud.Toggle(HudPanel::kLeave);
  const auto quits = [](const Changes& request) { return request.leaves; };
  EXPECT_FALSE(At(hud, 1.0, 1.0, false).leaves);
  EXPECT_TRUE(Find(hud, 0.5 * kWidth - 110.0, 360, 470, quits).has_value());
}

TEST_F(HudTest, PanelsGrowWithTheScale) {
  Hud once({.scale = 1.0}), twice({.scale = 2.0});
  const auto panel = [&](Hud& hud, int times) {
    const Image bare = Drawn(hud, model_, times * kWidth, times * kHeight);
    hud.Toggle(HudPanel::kAir);
    return Difference(bare, Drawn(hud, model_, times * kWidth, times * kHeight));
  };
  const Box small = panel(once, 1), large = panel(twice, 2);
  EXPECT_NEAR(large.right - large.left, 2 * (small.right - small.left), 12)
      << "letters are hinted at their size";
  EXPECT_NEAR(large.bottom - large.top, 2 * (small.bottom - small.top), 12);
}

TEST_F(HudTest, KeysClosePanelsFirst) {
  Hud hud;
  EXPECT_FALSE(hud.ClosePanels());
  hud.Toggle(HudPanel::kTables);
  EXPECT_TRUE(hud.IsOpen(HudPanel::kTables));
  EXPECT_TRUE(hud.ClosePanels());
  EXPECT_FALSE(hud.IsOpen(HudPanel::kTables));
}

TEST_F(HudTest, EveryPanelFitsIntoTheSmallestPicture) {
  for (std::size_t panel = 0; panel < kHudPanels; ++panel) {
    Hud hud;
    const Image bare = Drawn(hud, model_, 320, 240);
    hud.Toggle(static_cast<HudPanel>(panel));
    for (int frame = 0; frame < 4; ++frame) FrameOf(hud, model_, Still(320, 240));
    const Image with = Drawn(hud, model_, 320, 240);
    const Box box = Difference(bare, with);
    ASSERT_FALSE(box.empty()) << panel;
    EXPECT_GT(box.left, 0) << panel;
    EXPECT_GT(box.top, 0) << panel;
    EXPECT_LT(box.right, 320) << panel;
    EXPECT_LT(box.bottom, 240) << panel;
  }
}

TEST_F(HudTest, PanelsStayInAPictureThatShrinks) {
  Hud hud;
  const Image bare = Drawn(hud, model_, 320, 240);
  hud.Toggle(HudPanel::kAir);  // on the right
  static_cast<void>(Drawn(hud, model_, kWidth, kHeight));
  const Box box = Difference(bare, Drawn(hud, model_, 320, 240));
  ASSERT_FALSE(box.empty());
  EXPECT_GT(box.left, 0);
  EXPECT_LT(box.right, 320);
  EXPECT_LT(box.bottom, 240);
}

TEST_F(HudTest, ItIsDimAtNight) {
  Hud hud;
  HudModel night = model_;
  night.exposure.ev100 = -4.0;
  const auto brightest = [](const Image& image) {
    float most = 0.0F;
    for (const auto& pixel : image.rgb) most = std::max(most, pixel[2]);
    return most;
  };
  EXPECT_GT(brightest(Drawn(hud, model_, kWidth, kHeight)), 0.9F);
  EXPECT_LE(brightest(Drawn(hud, night, kWidth, kHeight)), 0.5F + 1e-4F)
      << "the grey behind has that; blending rounds";
  EXPECT_EQ(hud.theme(), HudTheme::kNight);
}

}  // namespace
}  // namespace alpenglow::viewer
