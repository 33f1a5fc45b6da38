// SPDX-License-Identifier: MIT
// Panels: where they stand beside the clock, what lists and fields ask for.
#include "viewer/hud/panels.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "atmosphere/math/constants.h"
#include "tests/viewer/hud/hud_picture.h"

namespace alpenglow::viewer {
namespace {

using tests::Changes;
using tests::FrameOf;

constexpr int kPictureWidth = 1280, kPictureHeight = 800;

class PanelsTest : public tests::HudPicture {
 protected:
  Changes At(Hud& hud, double x, double y, bool pressed) {
    InputFrame input = Still(kPictureWidth, kPictureHeight);
    input.events.pointer = PointerPlace{x, y};
    input.events.buttons[0] = pressed;
    return FrameOf(hud, model_, input);
  }
  /// The requests while the button was down and when it was let go.
  std::vector<Changes> Click(Hud& hud, double x, double y) {
    static_cast<void>(At(hud, x, y, false));
    std::vector<Changes> requests{At(hud, x, y, true)};
    requests.push_back(At(hud, x, y, false));
    return requests;
  }
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

  HudModel model_ = tests::Flying();
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
  for (const Case& shown :
       {Case{1280, 800, 1.0, false}, Case{1280, 800, 1.0, true}, Case{1280, 800, 1.5, true},
        Case{1280, 800, 2.0, false}, Case{1280, 800, 4.0, true}, Case{320, 240, 1.0, false},
        Case{320, 240, 1.0, true}, Case{320, 240, 1.5, false}, Case{320, 240, 2.0, false}}) {
    Hud hud({.scale = shown.scale});
    if (shown.menu) hud.ToggleMenu();
    const Image bare = Drawn(hud, model_, shown.width, shown.height);
    const Box clock =
        Difference(bare, Drawn(hud, AtAnotherTime(model_), shown.width, shown.height));
    ASSERT_FALSE(clock.empty());
    for (std::size_t panel = 0; panel < kHudPanels; ++panel) {
      SCOPED_TRACE(::testing::Message() << "panel " << panel << ", " << shown.width << " x "
                                        << shown.height << ", scale " << shown.scale);
      hud.Toggle(static_cast<HudPanel>(panel));
      Image with = Drawn(hud, model_, shown.width, shown.height);
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

TEST_F(PanelsTest, PanelsAreSeenInASmallPictureWithTheLargestLetters) {
  Hud hud({.scale = 8.0});
  const Image bare = Drawn(hud, model_, 320, 240);
  for (std::size_t panel = 0; panel < kHudPanels; ++panel) {
    hud.Toggle(static_cast<HudPanel>(panel));
    static_cast<void>(Drawn(hud, model_, 320, 240));
    const Box box = Difference(bare, Drawn(hud, model_, 320, 240));
    hud.Toggle(static_cast<HudPanel>(panel));
    EXPECT_GE(box.bottom - box.top, 60) << panel << ": a quarter of the picture";
    EXPECT_GE(box.right - box.left, 100) << panel;
  }
}

TEST_F(PanelsTest, APanelThatIsDraggedOverTheClockComesBack) {
  Hud hud;
  const Image bare = Drawn(hud, model_, kPictureWidth, kPictureHeight);
  const Box clock =
      Difference(bare, Drawn(hud, AtAnotherTime(model_), kPictureWidth, kPictureHeight));
  hud.Toggle(HudPanel::kAir);
  const Box before = Difference(bare, Drawn(hud, model_, kPictureWidth, kPictureHeight));
  const double title_x = before.right - 100.0, title_y = before.top + 10.0;
  static_cast<void>(At(hud, title_x, title_y, false));
  static_cast<void>(At(hud, title_x, title_y, true));
  for (const double y : {80.0, 20.0}) static_cast<void>(At(hud, title_x - 90.0, y, true));
  EXPECT_LT(Difference(bare,
                       [&] {
                         const RenderTarget target(kPictureWidth, kPictureHeight,
                                                   RenderTarget::Depth::kNone);
                         target.Bind();
                         glClearColor(0.5F, 0.5F, 0.5F, 1.0F);
                         glClear(GL_COLOR_BUFFER_BIT);
                         hud.Paint(target.framebuffer());
                         return target.Read();
                       }())
                .top,
            clock.bottom)
      << "while the hand holds it";
  const Box after = Difference(bare, Drawn(hud, model_, kPictureWidth, kPictureHeight));
  EXPECT_GE(after.top, clock.bottom);
  EXPECT_NEAR(after.left, before.left - 90, 2) << "but it has been moved";
}

TEST_F(PanelsTest, EnterLeavesTheFlight) {
  Hud hud;
  EXPECT_FALSE(PressEnter(hud).leaves) << "nobody has been asked";
  static_cast<void>(Type(hud, ""));
  hud.Toggle(HudPanel::kLeave);
  EXPECT_FALSE(Type(hud, "").leaves);
  EXPECT_TRUE(PressEnter(hud).leaves);
}

TEST_F(PanelsTest, EnterInAFieldDoesNotLeaveTheFlight) {
  Hud hud;
  hud.Toggle(HudPanel::kPlaceAndTime);
  hud.Toggle(HudPanel::kLeave);
  static_cast<void>(FieldFrom(hud, 120.0, 200));
  static_cast<void>(Type(hud, "2026-06-21T04:00:00Z"));
  const Changes request = PressEnter(hud);
  EXPECT_TRUE(request.time.has_value());
  EXPECT_FALSE(request.leaves);
}

TEST_F(PanelsTest, EnterFliesToTheFirstPlaceThatIsFound) {
  Hud hud;
  hud.Toggle(HudPanel::kPlaceAndTime);
  const double instant_y = FieldFrom(hud, 120.0, 200);
  static_cast<void>(FieldFrom(hud, 120.0, static_cast<int>(instant_y) + 26));
  static_cast<void>(Type(hud, "zurich"));
  EXPECT_EQ(PressEnter(hud).named_place, "Zürich");
}

TEST_F(PanelsTest, ClicksInTheListOfPlacesAreThoseThatWereFound) {
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

TEST_F(PanelsTest, OutsideOfTheAircraftThereIsNoThrottle) {
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

}  // namespace
}  // namespace alpenglow::viewer
