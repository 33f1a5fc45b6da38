// SPDX-License-Identifier: MIT
// Panels: where they stand, what they ask for, and whether all letters can be read.
#include "viewer/hud/hud.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <imgui.h>

#include <array>
#include <span>
#include <string>
#include <vector>

#include "atmosphere/math/constants.h"
#include "lut/image/white_balance.h"
#include "tests/fixtures/luminance.h"
#include "tests/fixtures/sanitized.h"
#include "tests/viewer/hud/hud_picture.h"

namespace alpenglow::viewer {
namespace {

using tests::Changes;
using tests::FrameOf;

constexpr int kPictureWidth = 1280, kPictureHeight = 800;

class PanelsTest : public tests::HudUnderMouse {
 protected:
  PanelsTest() : HudUnderMouse(kPictureWidth, kPictureHeight) {}

  Changes PressEnter(Hud& hud) {
    InputFrame input = Still(kPictureWidth, kPictureHeight);
    input.events.keys = {{GLFW_KEY_ENTER, 0, GLFW_PRESS, 0, ""},
                         {GLFW_KEY_ENTER, 0, GLFW_RELEASE, 0, ""}};
    return FrameOf(hud, model_, input);
  }
  Changes Type(Hud& hud, const char* text) {
    InputFrame input = Still(kPictureWidth, kPictureHeight);
    input.events.text = text;
    return FrameOf(hud, model_, input);
  }
  /// Clicks down a column until a field takes letters.
  double FieldFrom(Hud& hud, double x, int from_y) {
    for (int y = from_y; y < kPictureHeight; y += 4) {
      static_cast<void>(Click(hud, x, y));
      static_cast<void>(At(hud, x, y, false));
      if (hud.Taken().keyboard) return y;
    }
    ADD_FAILURE() << "there is no field";
    return 0.0;
  }
  /// Opens whatever opens down a column and clicks on what lies below it, until all is asked for.
  template <typename Asked>
  std::vector<std::string> Listed(Hud& hud, double x, int from_y, const Asked& asked) {
    std::vector<std::string> names;
    for (int y = from_y; y < kPictureHeight - 10; y += 6) {
      for (int below = -140; below < 140; below += 7) {
        static_cast<void>(Click(hud, x, y));  // opens the list again
        for (const Changes& request : Click(hud, x, y + below)) {
          const auto name = asked(request);
          if (name && std::find(names.begin(), names.end(), *name) == names.end())
            names.push_back(*name);
        }
        static_cast<void>(Click(hud, 640.0, 300.0));  // closes it
      }
    }
    return names;
  }
};

/// A clock that shows something else everywhere.
HudModel AtAnotherTime(HudModel model) {
  model.time.utc = "1999-08-11 11:33:00Z";
  model.time.local = "07:33:59";
  model.time.zone = "Pacific/Fiji";
  model.time.rate = -60.0;
  model.sky.sun_elevation_rad = -0.9;
  return model;
}

TEST_F(PanelsTest, NoPanelCoversTheClock) {
  struct Case {
    int width, height;
    double scale;
    bool menu;
  };
  const std::vector<Case> all{
      {1280, 800, 1.0, false}, {1280, 800, 1.0, true}, {1280, 800, 1.5, true},
      {1280, 800, 2.0, false}, {1280, 800, 4.0, true}, {320, 240, 1.0, false},
      {320, 240, 1.0, true},   {320, 240, 1.5, false}, {320, 240, 2.0, false}};
  for (const Case& shown : tests::ScaledDown(all, {all[1], all[8]})) {
    Hud hud({.scale = shown.scale});
    if (shown.menu) hud.ToggleMenu();
    const HdrImage bare = Drawn(hud, model_, shown.width, shown.height);
    const Box clock =
        Difference(bare, Drawn(hud, AtAnotherTime(model_), shown.width, shown.height));
    ASSERT_FALSE(clock.empty());
    for (std::size_t panel = 0; panel < kHudPanels; ++panel) {
      SCOPED_TRACE(::testing::Message() << "panel " << panel << ", " << shown.width << " x "
                                        << shown.height << ", scale " << shown.scale);
      hud.Toggle(static_cast<HudPanel>(panel));
      HdrImage with = Drawn(hud, model_, shown.width, shown.height);
      hud.Toggle(static_cast<HudPanel>(panel));
      // The menu, over the clock, marks which panels are open.
      std::copy_n(bare.rgb.begin(), clock.top * shown.width, with.rgb.begin());
      const Box box = Difference(bare, with);
      ASSERT_FALSE(box.empty());
      EXPECT_GE(box.top, clock.bottom);
      EXPECT_LE(box.bottom, shown.height);
      EXPECT_LE(box.right, shown.width);
    }
  }
}

TEST_F(PanelsTest, PanelsFitIntoASmallPictureWithTheLargestFont) {
  Hud hud({.scale = 8.0});
  const HdrImage bare = Drawn(hud, model_, 320, 240);
  for (std::size_t panel = 0; panel < kHudPanels; ++panel) {
    hud.Toggle(static_cast<HudPanel>(panel));
    static_cast<void>(Drawn(hud, model_, 320, 240));
    const Box box = Difference(bare, Drawn(hud, model_, 320, 240));
    hud.Toggle(static_cast<HudPanel>(panel));
    EXPECT_GE(box.bottom - box.top, 60) << panel << ": a quarter of the picture";
    EXPECT_GE(box.right - box.left, 100) << panel;
  }
}

TEST_F(PanelsTest, APanelDraggedOverTheClockMovesBack) {
  Hud hud;
  const HdrImage bare = Drawn(hud, model_, kPictureWidth, kPictureHeight);
  const Box clock =
      Difference(bare, Drawn(hud, AtAnotherTime(model_), kPictureWidth, kPictureHeight));
  hud.Toggle(HudPanel::kAir);
  const Box before = Difference(bare, Drawn(hud, model_, kPictureWidth, kPictureHeight));
  const double title_x = before.right - 100.0, title_y = before.top + 10.0;
  static_cast<void>(At(hud, title_x, title_y, false));
  static_cast<void>(At(hud, title_x, title_y, true));
  for (const double y : {80.0, 20.0}) static_cast<void>(At(hud, title_x - 90.0, y, true));
  EXPECT_LT(Difference(bare, DrawnAsIs(hud, kPictureWidth, kPictureHeight)).top, clock.bottom)
      << "while the hand holds it";
  const Box after = Difference(bare, Drawn(hud, model_, kPictureWidth, kPictureHeight));
  EXPECT_GE(after.top, clock.bottom);
  EXPECT_NEAR(after.left, before.left - 90, 2) << "but it has been moved";
}

TEST_F(PanelsTest, EnterConfirmsLeaving) {
  Hud hud;
  EXPECT_FALSE(PressEnter(hud).leaves) << "nobody has been asked";
  static_cast<void>(Type(hud, ""));
  hud.Toggle(HudPanel::kLeave);
  EXPECT_FALSE(Type(hud, "").leaves);
  EXPECT_TRUE(PressEnter(hud).leaves);
}

TEST_F(PanelsTest, EnterInATextFieldDoesNotLeave) {
  Hud hud;
  hud.Toggle(HudPanel::kPlaceAndTime);
  hud.Toggle(HudPanel::kLeave);
  static_cast<void>(FieldFrom(hud, 120.0, 200));
  static_cast<void>(Type(hud, "2026-06-21T04:00:00Z"));
  const Changes request = PressEnter(hud);
  EXPECT_TRUE(request.time.has_value());
  EXPECT_FALSE(request.leaves);
}

TEST_F(PanelsTest, EnterFliesToTheFirstFoundPlace) {
  Hud hud;
  hud.Toggle(HudPanel::kPlaceAndTime);
  const double instant_y = FieldFrom(hud, 120.0, 200);
  static_cast<void>(FieldFrom(hud, 120.0, static_cast<int>(instant_y) + 26));
  static_cast<void>(Type(hud, "zurich"));
  EXPECT_EQ(PressEnter(hud).named_place, "Zürich");
}

TEST_F(PanelsTest, AClickInTheListFliesToThatPlace) {
  Hud hud;
  hud.Toggle(HudPanel::kPlaceAndTime);
  const double instant_y = FieldFrom(hud, 120.0, 200);
  const double search_y = FieldFrom(hud, 120.0, static_cast<int>(instant_y) + 26);
  const auto clicked = [&] {
    std::vector<std::string> names;
    for (double y = search_y + 24.0; y < search_y + 140.0; y += 4.0) {
      for (const Changes& request : Click(hud, 60.0, y)) {
        if (request.named_place && (names.empty() || names.back() != *request.named_place))
          names.push_back(*request.named_place);
      }
    }
    return names;
  };
  const std::vector<std::string> first = clicked();
  ASSERT_GE(first.size(), 6U);
  EXPECT_EQ(first.front(), "Aconcagua");
  EXPECT_TRUE(std::is_sorted(first.begin(), first.end()));
  static_cast<void>(FieldFrom(hud, 120.0, static_cast<int>(search_y)));
  static_cast<void>(Type(hud, "ZURICH"));
  EXPECT_EQ(clicked(), (std::vector<std::string>{"Zürich", "Zürich Airport"}));
}

TEST_F(PanelsTest, TheExposurePanelOffersLooksAndWhiteBalances) {
  Hud hud;
  hud.Toggle(HudPanel::kExposure);
  const double x = kPictureWidth - 230.0;
  const auto look = [](const Changes& request) {
    return request.look ? std::optional(NameOf(*request.look)) : std::nullopt;
  };
  EXPECT_THAT(Listed(hud, x, 560, look), ::testing::IsSupersetOf({"photo", "punchy"}));
  const auto white = [](const Changes& request) {
    return request.white ? std::optional(NameOf(*request.white)) : std::nullopt;
  };
  const std::vector<std::string> whites = Listed(hud, x, 560, white);
  EXPECT_THAT(whites, ::testing::IsSupersetOf({NameOf(WhiteBalanceFromText("camera")),
                                               NameOf(WhiteBalanceFromText("auto"))}));
  EXPECT_GE(whites.size(), 3U) << "and kelvins of the slider";
}

TEST_F(PanelsTest, TheFlightPanelSetsModeThrottleAndSpeed) {
  Hud hud;
  hud.Toggle(HudPanel::kFlight);
  EXPECT_THAT(Listed(hud, 0.5 * kPictureWidth - 60.0, 560,
                     [](const Changes& request) {
                       return request.messages.empty() ? std::nullopt
                                                       : std::optional(request.messages.back());
                     }),
              ::testing::UnorderedElementsAre("free camera", "aircraft"));
  std::optional<double> throttle;
  std::optional<std::optional<double>> speed;
  for (int y = 540; y < 790; y += 4) {
    for (const Changes& request : Click(hud, 0.5 * kPictureWidth - 102.0, y)) {
      if (request.throttle) throttle = request.throttle;
      if (request.speed_m_per_s && !speed) speed = request.speed_m_per_s;
    }
  }
  ASSERT_TRUE(throttle.has_value());
  EXPECT_GE(*throttle, 0.0);
  EXPECT_LT(*throttle, 0.1) << "the left end of the slider";
  ASSERT_TRUE(speed.has_value());
  ASSERT_TRUE(speed->has_value());
  EXPECT_NEAR(**speed, model_.flight.ground_speed_m_per_s, 1e-9) << "as fast as it flies";
}

TEST_F(PanelsTest, ThrottleIsShownOnlyForTheAircraft) {
  Hud hud;
  model_.flight.throttle.reset();
  hud.Toggle(HudPanel::kFlight);
  for (int y = 600; y < 790; y += 4) {
    for (const Changes& request : Click(hud, 0.5 * kPictureWidth - 80.0, y)) {
      EXPECT_FALSE(request.throttle) << y;
      EXPECT_FALSE(request.heading_rad) << y;
    }
  }
}

// --- letters have contrast over every picture ---

constexpr double kLeastContrast = 4.5;  // WCAG 2.1, 1.4.3

using ScreenColour = std::array<float, 3>;

/// A letter on the screen: its box [pixels] and its colour.
struct Letter {
  ImVec2 from, to;
  ScreenColour colour;
};

bool IsLetter(const ImDrawVert* v) {
  const bool has_area = v[0].uv.x != v[2].uv.x && v[0].uv.y != v[2].uv.y;
  return has_area && v[1].uv.x == v[2].uv.x && v[1].uv.y == v[0].uv.y && v[3].uv.x == v[0].uv.x &&
         v[3].uv.y == v[2].uv.y && v[0].col == v[2].col;
}

enum class Of { kInstruments, kPanels };

/// Takes all letters out of what Dear ImGui has laid out, except the black ones of outlines, and tells of
/// those of instruments or panels. Instruments are the first list, under the panels.
std::vector<Letter> TakeLetters(Of which) {
  std::vector<Letter> letters;
  ImDrawData& data = *ImGui::GetDrawData();
  for (int list = 0; list < data.CmdListsCount; ++list) {
    ImVector<ImDrawVert>& vertices = data.CmdLists[list]->VtxBuffer;
    for (int i = 0; i + 3 < vertices.Size;) {
      ImDrawVert* const v = &vertices[i];
      if (!IsLetter(v)) {
        ++i;
        continue;
      }
      const ImVec4 colour = ImGui::ColorConvertU32ToFloat4(v[0].col);
      const bool is_wanted = (list == 0) == (which == Of::kInstruments);
      i += 4;
      if (colour.x + colour.y + colour.z == 0.0F) continue;
      if (is_wanted) letters.push_back({v[0].pos, v[2].pos, {colour.x, colour.y, colour.z}});
      for (int corner = 0; corner < 4; ++corner) v[corner].col = 0;
    }
  }
  return letters;
}

double LightOf(const ScreenColour& codes) {
  ScreenColour light{};
  for (std::size_t c = 0; c < 3; ++c) {
    light[c] = static_cast<float>(tests::LightOfCode(double{codes[c]}));
  }
  return tests::Luminance(light);
}

double Contrast(const ScreenColour& a, const ScreenColour& b) {
  const double one = LightOf(a) + 0.05, other = LightOf(b) + 0.05;
  return std::max(one, other) / std::min(one, other);
}

/// The pixel of a letter that has the least contrast to what is behind it.
struct Worst {
  double contrast;
  int x, y;
};

/// A picture whose left and right halves have a colour each.
struct Halves {
  const char* name;
  ScreenColour left, right;
};

// Black night, the grey of middle codes, the beige of a lit fog, snow, and edges between them.
constexpr std::array<Halves, 7> kPictures{
    {{"night", {0.0F, 0.0F, 0.0F}, {0.02F, 0.02F, 0.03F}},
     {"grey", {0.35F, 0.35F, 0.35F}, {0.5F, 0.5F, 0.5F}},
     {"beige", {0.76F, 0.66F, 0.52F}, {0.55F, 0.45F, 0.33F}},
     {"snow", {1.0F, 1.0F, 1.0F}, {0.9F, 0.92F, 0.95F}},
     {"colours of the text", {0.45F, 1.0F, 0.55F}, {0.95F, 0.42F, 0.08F}},
     {"dark and bright", {0.0F, 0.0F, 0.0F}, {1.0F, 1.0F, 1.0F}},
     {"bright and dark", {1.0F, 1.0F, 1.0F}, {0.1F, 0.1F, 0.1F}}}};

class Readable : public tests::HudPicture {
 protected:
  static HdrImage Painted(const Hud& hud, int width, int height, const Halves& halves) {
    const RenderTarget target(width, height, RenderTarget::Depth::kNone);
    target.Bind();
    glEnable(GL_SCISSOR_TEST);
    for (const bool right : {false, true}) {
      const ScreenColour& rgb = right ? halves.right : halves.left;
      glScissor(right ? width / 2 : 0, 0, width, height);
      glClearColor(rgb[0], rgb[1], rgb[2], 1.0F);
      glClear(GL_COLOR_BUFFER_BIT);
    }
    glDisable(GL_SCISSOR_TEST);
    hud.Paint(target.framebuffer());
    return target.Read();
  }

  Worst WorstPixel(Of which, Hud& hud, int width, int height, const Halves& halves) const {
    for (int frame = 0; frame < 3; ++frame) tests::FrameOf(hud, model_, Still(width, height));
    const HdrImage with = Painted(hud, width, height, halves);
    const std::vector<Letter> letters = TakeLetters(which);
    const HdrImage behind = Painted(hud, width, height, halves);
    Worst worst{21.0, 0, 0};
    for (const Letter& letter : letters) {
      const int right = std::min(static_cast<int>(letter.to.x) + 1, width);
      const int bottom = std::min(static_cast<int>(letter.to.y) + 1, height);
      for (int y = std::max(static_cast<int>(letter.from.y), 0); y < bottom; ++y) {
        for (int x = std::max(static_cast<int>(letter.from.x), 0); x < right; ++x) {
          if (with.at(x, y) == behind.at(x, y)) continue;
          const double contrast = Contrast(letter.colour, behind.at(x, y));
          if (contrast < worst.contrast) worst = {contrast, x, y};
        }
      }
    }
    EXPECT_GT(letters.size(), 10U);
    return worst;
  }

  void ExpectReadable(Of which, const std::string& name, Hud& hud, int width, int height,
                      std::span<const Halves> pictures = kPictures) const {
    for (const Halves& halves : pictures) {
      const Worst worst = WorstPixel(which, hud, width, height, halves);
      EXPECT_GE(worst.contrast, kLeastContrast)
          << name << " over " << halves.name << ", " << width << " x " << height << ", at "
          << worst.x << ", " << worst.y;
    }
  }

  HudModel model_ = [] {
    HudModel model = tests::Flying();
    model.flight.pitch_rad = -0.02;
    model.flight.stall = true;
    model.flight.load_factor = 1.2;
    model.autopilot = {0.7, 3300.0};
    model.sky.moon = HudMoon{0.9, 0.3, 0.8};
    model.exposure.cursor_luminance_cd_per_m2 = 12.0;
    model.messages = {{"a file is missing", true}, {"screenshot is written", false}};
    model.progress = HudProgress{"loading", 0.4};
    model.recording = true;
    return model;
  }();
};

TEST_F(Readable, InstrumentsContrastWithEveryPicture) {
  for (const HudThemeChoice theme : {HudThemeChoice::kDay, HudThemeChoice::kNight}) {
    const char* const name = theme == HudThemeChoice::kDay ? "day" : "night";
    Hud hud({.preferences = {theme}}), large({.scale = 2.0, .preferences = {theme}});
    ExpectReadable(Of::kInstruments, name, hud, 1280, 720);
    ExpectReadable(Of::kInstruments, name, hud, 320, 240);
    ExpectReadable(Of::kInstruments, name, large, 640, 480);
  }
}

TEST_F(Readable, PanelsContrastWithDarkAndBrightPictures) {
  model_.tables = {{"air", "50 ms", ""}};
  for (const HudThemeChoice theme : {HudThemeChoice::kDay, HudThemeChoice::kNight}) {
    Hud hud({.preferences = {theme}});
    hud.ToggleMenu();
    for (std::size_t panel = 0; panel < kHudPanels; ++panel) {
      hud.Toggle(static_cast<HudPanel>(panel));
      ExpectReadable(Of::kPanels, std::to_string(panel), hud, 800, 600,
                     std::span(kPictures).last(2));
      hud.Toggle(static_cast<HudPanel>(panel));
    }
  }
}

}  // namespace
}  // namespace alpenglow::viewer
