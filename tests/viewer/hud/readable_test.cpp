// SPDX-License-Identifier: MIT
// Text of instruments and panels over pictures: its contrast to what is drawn behind it.
#include <gtest/gtest.h>
#include <imgui.h>

#include <array>
#include <span>
#include <string>
#include <vector>

#include "tests/fixtures/luminance.h"
#include "tests/viewer/hud/hud_picture.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {
namespace {

constexpr double kLeastContrast = 4.5;  // WCAG 2.1, 1.4.3

using Rgb = std::array<float, 3>;

/// A letter on the screen: its box [pixels] and its colour.
struct Letter {
  ImVec2 from, to;
  Rgb colour;
};

bool IsLetter(const ImDrawVert* v) {
  const bool has_area = v[0].uv.x != v[2].uv.x && v[0].uv.y != v[2].uv.y;
  return has_area && v[1].uv.x == v[2].uv.x && v[1].uv.y == v[0].uv.y && v[3].uv.x == v[0].uv.x &&
         v[3].uv.y == v[2].uv.y && v[0].col == v[2].col;
}

enum class Of { kInstruments, kPanels };

/// Takes all letters out of what Dear ImGui has laid out, and tells of those of instruments or
/// panels that are no shadow. Instruments are the first list, under the panels.
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
      if (is_wanted && colour.x + colour.y + colour.z > 0.0F)
        letters.push_back({v[0].pos, v[2].pos, {colour.x, colour.y, colour.z}});
      for (int corner = 0; corner < 4; ++corner) v[corner].col = 0;
      i += 4;
    }
  }
  return letters;
}

double LightOf(const Rgb& codes) {
  Rgb light{};
  for (std::size_t c = 0; c < 3; ++c) {
    light[c] =
        codes[c] <= 0.04045F ? codes[c] / 12.92F : std::pow((codes[c] + 0.055F) / 1.055F, 2.4F);
  }
  return tests::Luminance(light);
}

double Contrast(const Rgb& a, const Rgb& b) {
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
  Rgb left, right;
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
  static Image Painted(const Hud& hud, int width, int height, const Halves& halves) {
    const RenderTarget target(width, height, RenderTarget::Depth::kNone);
    target.Bind();
    glEnable(GL_SCISSOR_TEST);
    for (const bool right : {false, true}) {
      const Rgb& rgb = right ? halves.right : halves.left;
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
    const Image with = Painted(hud, width, height, halves);
    const std::vector<Letter> letters = TakeLetters(which);
    const Image behind = Painted(hud, width, height, halves);
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

TEST_F(Readable, InstrumentsHaveContrastOverEveryPicture) {
  for (const HudThemeChoice theme : {HudThemeChoice::kDay, HudThemeChoice::kNight}) {
    const char* const name = theme == HudThemeChoice::kDay ? "day" : "night";
    Hud hud({.preferences = {theme}}), large({.scale = 2.0, .preferences = {theme}});
    ExpectReadable(Of::kInstruments, name, hud, 1280, 720);
    ExpectReadable(Of::kInstruments, name, hud, 320, 240);
    ExpectReadable(Of::kInstruments, name, large, 640, 480);
  }
}

TEST_F(Readable, PanelsHaveContrastOverDarkAndBright) {
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
