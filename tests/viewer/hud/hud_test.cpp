// SPDX-License-Identifier: MIT
// The HUD: what it shows, its keys and its help.
#include "viewer/hud/hud.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "tests/fixtures/flat_picture.h"
#include "tests/fixtures/report_files.h"
#include "tests/viewer/hud/hud_picture.h"
#include "viewer/hud/imgui_backend.h"
#include "viewer/hud/key_help.h"

namespace alpenglow::viewer {
namespace {

using tests::Changes;
using tests::FrameOf;

constexpr int kHudWidth = 1280, kHudHeight = 720;

class HudTest : public tests::HudUnderMouse {
 protected:
  HudTest() : HudUnderMouse(kHudWidth, kHudHeight) {}

  /// Clicks along a column of the picture until a click makes the request that `asked` accepts.
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
};

TEST_F(HudTest, HiddenInstrumentsChangeNoByteOfThePicture) {
  Hud hud;
  hud.Toggle(HudPanel::kHelp);
  hud.ToggleMenu();
  const HdrImage shown = Drawn(hud, model_, kHudWidth, kHudHeight);
  hud.ToggleVisible();
  const HdrImage hidden = Drawn(hud, model_, kHudWidth, kHudHeight);
  const HdrImage grey = tests::FlatPicture(kHudWidth, kHudHeight, 0.5F);
  EXPECT_FALSE(Difference(grey, shown).empty());
  EXPECT_TRUE(Difference(grey, hidden).empty());
  EXPECT_FALSE(hud.Taken().mouse);
  hud.ToggleVisible();
  EXPECT_TRUE(Difference(shown, Drawn(hud, model_, kHudWidth, kHudHeight)).empty())
      << "and it comes back as it was";
}

TEST_F(HudTest, CanBeHiddenBetweenLayoutAndPaint) {
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

TEST_F(HudTest, PaintingKeepsTheOpenGlStateOfPasses) {
  Hud hud;
  static_cast<void>(Drawn(hud, model_, 320, 240));
  EXPECT_FALSE(glIsEnabled(GL_BLEND));
  EXPECT_FALSE(glIsEnabled(GL_SCISSOR_TEST));
  EXPECT_FALSE(glIsEnabled(GL_DEPTH_TEST));
  GLint layout = -1;
  glGetIntegerv(GL_VERTEX_ARRAY_BINDING, &layout);
  EXPECT_EQ(layout, 0);
}

TEST_F(HudTest, APictureWithoutPixelsIsNotPainted) {
  Hud hud;
  FrameOf(hud, model_, Still(0, 0));
  hud.Paint(0);
  EXPECT_FALSE(hud.Taken().mouse);
}

TEST_F(HudTest, RefusesAScaleOutOfRangeAndAnInvalidFont) {
  EXPECT_THROW(Hud({.scale = 0.4}), InputError);
  EXPECT_THROW(Hud({.scale = std::nan("")}), InputError);
  HudSettings settings;
  settings.font = "/nowhere/letters.ttf";
  EXPECT_THROW(Hud{settings}, InputError);
}

TEST_F(HudTest, PanelsTakeTheMouseOnlyInsideThem) {
  Hud hud;
  hud.Toggle(HudPanel::kLeave);  // in the middle below the clock
  for (int frame = 0; frame < 3; ++frame)
    static_cast<void>(At(hud, 0.5 * kHudWidth, 0.57 * kHudHeight, false));
  EXPECT_TRUE(hud.Taken().mouse);
  static_cast<void>(At(hud, 0.2 * kHudWidth, 0.8 * kHudHeight, false));
  EXPECT_FALSE(hud.Taken().mouse);
  static_cast<void>(At(hud, 0.2 * kHudWidth, 0.8 * kHudHeight, true));
  static_cast<void>(At(hud, 0.5 * kHudWidth, 0.57 * kHudHeight, true));
  EXPECT_FALSE(hud.Taken().mouse) << "a drag that began in the picture stays the flight's";
}

TEST_F(HudTest, AClickOnTheDayStripGivesAFractionOfTheDay) {
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

TEST_F(HudTest, ASliderRequestsTheValueItIsDraggedTo) {
  Hud hud;
  hud.Toggle(HudPanel::kAir);
  // Beside the knob: Dear ImGui 1.90 changes nothing where the knob is pressed.
  const double x = kHudWidth - 10.0 - 150.0;
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

TEST_F(HudTest, AClickOnItsNameSwitchesTheLandingLight) {
  Hud hud;
  hud.Toggle(HudPanel::kLights);
  EXPECT_TRUE(Find(hud, kHudWidth - 100.0, 250, 482, [](const Changes& request) {
                return request.landing_light;
              }).has_value());
}

TEST_F(HudTest, EnterRequestsTheTypedInstant) {
  Hud hud;
  hud.Toggle(HudPanel::kPlaceAndTime);
  std::optional<double> field_y;
  for (int y = 150; y < 400 && !field_y; y += 4) {
    static_cast<void>(Click(hud, 120.0, y));
    static_cast<void>(At(hud, 120.0, y, false));
    if (hud.Taken().keyboard) field_y = y;
  }
  ASSERT_TRUE(field_y.has_value()) << "a field that takes letters";
  InputFrame typing = Still(kHudWidth, kHudHeight);
  typing.events.text = "2026-06-21T04:00:00Z";
  FrameOf(hud, model_, typing);
  typing.events.text.clear();
  typing.events.keys = {{GLFW_KEY_ENTER, 0, GLFW_PRESS, 0, ""}};
  EXPECT_EQ(FrameOf(hud, model_, typing).time, "2026-06-21T04:00:00Z");
}

TEST_F(HudTest, APictureIsRequestedInTheShownSize) {
  Hud hud;
  hud.Toggle(HudPanel::kCapture);
  std::optional<PictureOrder> capture;
  // From below: the recorder, then the buttons.
  const auto found = Find(hud, 0.5 * kHudWidth - 105.0, 260, 80, [&](const Changes& request) {
    capture = request.picture;
    return capture.has_value();
  });
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(capture->extension, ".png");
  ASSERT_TRUE(capture->size.has_value());
  EXPECT_EQ(capture->size->width, kHudWidth);
  EXPECT_EQ(capture->size->height, kHudHeight);
  EXPECT_FALSE(capture->with_instruments);
}

TEST_F(HudTest, HoldingAHeadingHoldsTheCurrentOne) {
  Hud hud;
  model_.flight.heading_rad = -0.5;
  hud.Toggle(HudPanel::kFlight);
  std::optional<std::optional<double>> hold;
  const auto asked = [&](const Changes& request) {
    hold = request.heading_rad;
    return hold.has_value();
  };
  ASSERT_TRUE(Find(hud, 0.5 * kHudWidth - 100.0, 500, 680, asked).has_value());
  ASSERT_TRUE(hold->has_value());
  EXPECT_NEAR(**hold, 2.0 * kPi - 0.5, 1e-9) << "in [0, 2 pi]";
  model_.autopilot.heading_rad = **hold;
  ASSERT_TRUE(Find(hud, 0.5 * kHudWidth - 100.0, 500, 680, asked).has_value());
  EXPECT_FALSE(hold->has_value()) << "a second click lets it go";
}

TEST_F(HudTest, LeavingIsRequestedOnce) {
  Hud hud;
  hud.Toggle(HudPanel::kLeave);
  const auto quits = [](const Changes& request) { return request.leaves; };
  EXPECT_FALSE(At(hud, 1.0, 1.0, false).leaves);
  EXPECT_TRUE(Find(hud, 0.5 * kHudWidth - 110.0, 360, 470, quits).has_value());
}

TEST_F(HudTest, PanelsGrowWithTheScale) {
  Hud once({.scale = 1.0}), twice({.scale = 2.0});
  const auto panel = [&](Hud& hud, int times) {
    const HdrImage bare = Drawn(hud, model_, times * kHudWidth, times * kHudHeight);
    hud.Toggle(HudPanel::kAir);
    return Difference(bare, Drawn(hud, model_, times * kHudWidth, times * kHudHeight));
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
    const HdrImage bare = Drawn(hud, model_, 320, 240);
    hud.Toggle(static_cast<HudPanel>(panel));
    for (int frame = 0; frame < 4; ++frame) FrameOf(hud, model_, Still(320, 240));
    const HdrImage with = Drawn(hud, model_, 320, 240);
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
  const HdrImage bare = Drawn(hud, model_, 320, 240);
  hud.Toggle(HudPanel::kAir);  // on the right
  static_cast<void>(Drawn(hud, model_, kHudWidth, kHudHeight));
  const Box box = Difference(bare, Drawn(hud, model_, 320, 240));
  ASSERT_FALSE(box.empty());
  EXPECT_GT(box.left, 0);
  EXPECT_LT(box.right, 320);
  EXPECT_LT(box.bottom, 240);
}

TEST_F(HudTest, IsDimAtNight) {
  Hud hud;
  HudModel night = model_;
  night.exposure.ev100 = -4.0;
  const auto brightest = [](const HdrImage& image) {
    float most = 0.0F;
    for (const auto& pixel : image.rgb) most = std::max(most, pixel[2]);
    return most;
  };
  EXPECT_GT(brightest(Drawn(hud, model_, kHudWidth, kHudHeight)), 0.9F);
  EXPECT_LE(brightest(Drawn(hud, night, kHudWidth, kHudHeight)), 0.5F + 1e-4F)
      << "the grey behind has that; blending rounds";
  EXPECT_EQ(hud.theme(), HudTheme::kNight);
}

// --- keys ---

WindowEvents Keys(std::vector<KeyEvent> keys) {
  WindowEvents events;
  events.keys = std::move(keys);
  return events;
}

TEST(PanelKeys, AKeyPressedAndReleasedWithinAFrameIsSeenOnce) {
  PanelKeys keys;
  keys.Take(Keys({{GLFW_KEY_BACKSPACE, 0, GLFW_PRESS}, {GLFW_KEY_BACKSPACE, 0, GLFW_RELEASE}}));
  EXPECT_TRUE(keys.IsDown(GLFW_KEY_BACKSPACE));
  keys.Take({});
  EXPECT_FALSE(keys.IsDown(GLFW_KEY_BACKSPACE));
}

TEST(PanelKeys, AHeldKeyStaysDownUntilItIsReleased) {
  PanelKeys keys;
  keys.Take(Keys({{GLFW_KEY_LEFT, 0, GLFW_PRESS}}));
  EXPECT_TRUE(keys.IsDown(GLFW_KEY_LEFT));
  keys.Take({});
  EXPECT_TRUE(keys.IsDown(GLFW_KEY_LEFT));
  keys.Take(Keys({{GLFW_KEY_LEFT, 0, GLFW_REPEAT}}));
  EXPECT_TRUE(keys.IsDown(GLFW_KEY_LEFT));
  keys.Take(Keys({{GLFW_KEY_LEFT, 0, GLFW_RELEASE}}));
  EXPECT_FALSE(keys.IsDown(GLFW_KEY_LEFT));
}

TEST(PanelKeys, LosingFocusReleasesAllKeys) {
  PanelKeys keys;
  keys.Take(Keys({{GLFW_KEY_RIGHT_CONTROL, 0, GLFW_PRESS}}));
  WindowEvents away;
  away.focused = false;
  keys.Take(away);
  EXPECT_FALSE(keys.IsDown(GLFW_KEY_RIGHT_CONTROL));
}

// --- the help on keys ---

/// All that the panel writes, whether it fits into the picture or not.
std::string WrittenHelp(int width) {
  std::string written;
  ImGuiContext* const before = ImGui::GetCurrentContext();
  ImGuiContext* const context = ImGui::CreateContext();
  ImGui::SetCurrentContext(context);
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.DisplaySize = {static_cast<float>(width), 4000.0F};
  io.Fonts->Build();
  io.ClipboardUserData = &written;
  io.SetClipboardTextFn = [](void* to, const char* text) { *static_cast<std::string*>(to) = text; };
  const HudModel model;
  for (int frame = 0; frame < 3; ++frame) {
    ImGui::NewFrame();
    ImGui::Begin("Help", nullptr, ImGuiWindowFlags_AlwaysAutoResize);
    ImGui::LogToClipboard();
    ShowKeyHelp({model, nullptr, HudTheme::kDay, 1.0, width, 4000, 0});
    ImGui::LogFinish();
    ImGui::End();
    ImGui::EndFrame();
  }
  ImGui::DestroyContext(context);
  ImGui::SetCurrentContext(before);
  return written;
}

TEST(KeyHelp, ListsEveryActionUnderItsHeading) {
  for (const int width : {320, 1280}) {
    const std::string written = WrittenHelp(width);
    for (const ActionSection& section : ActionSections()) {
      const std::size_t heading = written.find(section.heading);
      ASSERT_NE(heading, std::string::npos) << section.heading;
      for (const Action& row : section.rows) {
        EXPECT_GE(CountOf(written, std::string(row.help)), 1U) << row.help << ", " << width;
        EXPECT_NE(written.find(row.help, heading), std::string::npos) << row.help;
        EXPECT_GE(CountOf(written, KeysText(row)), 1U) << KeysText(row);
      }
    }
  }
}

TEST(KeyHelp, ColumnsKeepTheOrderAndHaveSimilarHeights) {
  const std::vector<ActionSection> sections = ActionSections();
  for (const std::size_t most : {1U, 2U, 3U, 40U}) {
    const HelpColumns columns = InColumns(sections, most);
    EXPECT_LE(columns.size(), most);
    std::vector<std::string_view> headings;
    std::size_t longest = 0, all = 0;
    for (const auto& column : columns) {
      std::size_t lines = 0;
      for (const ActionSection& section : column) {
        headings.push_back(section.heading);
        lines += section.rows.size() + 2;
      }
      longest = std::max(longest, lines);
      all += lines;
    }
    ASSERT_EQ(headings.size(), sections.size());
    for (std::size_t i = 0; i < sections.size(); ++i) EXPECT_EQ(headings[i], sections[i].heading);
    if (most > 3) continue;
    EXPECT_LE(longest, all / most + 6) << "a section is not cut, and most have 6 lines or more";
  }
}

}  // namespace
}  // namespace alpenglow::viewer
