// SPDX-License-Identifier: MIT
// What instruments are drawn with: lines, letters and plates over a picture of any brightness.
//
// All instruments of a flight over one picture: which there are, and where they stand.
#pragma once

#include <imgui.h>

#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "viewer/hud/hud_model.h"

namespace alpenglow::viewer {

enum class HudAlign { kLeft, kMiddle, kRight };

/// Lengths in units, which are pixels of a display of 96 dots an inch; places in pixels.
class Canvas {
 public:
  /// @param scale  pixels a unit.
  Canvas(ImDrawList& list, const HudColours& colours, double scale)
      : list_(list), colours_(colours), scale_(static_cast<float>(scale)) {}

  [[nodiscard]] const HudColours& colours() const { return colours_; }
  [[nodiscard]] double Pixels(double units) const { return units * static_cast<double>(scale_); }
  /// Height of a line of text [pixels].
  [[nodiscard]] double LineHeight() const;
  [[nodiscard]] double WidthOf(const std::string& text) const;
  /// The text in lines no wider than that, broken at spaces.
  [[nodiscard]] std::vector<std::string> Wrapped(const std::string& text, double width_px) const;

  /// With a shadow around it, so that it is seen on snow and on forest.
  void Line(const glm::dvec2& from, const glm::dvec2& to, const HudColour& colour) const;
  void Ring(const glm::dvec2& centre, double radius_px, const HudColour& colour) const;
  void Disk(const glm::dvec2& centre, double radius_px, const HudColour& colour) const;
  void Triangle(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c,
                const HudColour& colour) const;
  /// On a plate of its own: the text is read over any picture.
  /// @param at  its upper left corner, upper middle, or upper right corner.
  void Text(const glm::dvec2& at, HudAlign align, const std::string& text,
            const HudColour& colour) const;
  /// The same where a plate is drawn already.
  void TextOnPlate(const glm::dvec2& at, HudAlign align, const std::string& text,
                   const HudColour& colour) const;
  void Plate(const glm::dvec2& from, const glm::dvec2& to) const;
  void Fill(const glm::dvec2& from, const glm::dvec2& to, const HudColour& colour) const;

  /// Nothing is drawn outside of a rectangle while this lives.
  class Clip {
   public:
    Clip(const Canvas& canvas, const glm::dvec2& from, const glm::dvec2& to);
    ~Clip() { list_.PopClipRect(); }
    Clip(const Clip&) = delete;
    Clip& operator=(const Clip&) = delete;

   private:
    ImDrawList& list_;
  };

 private:
  /// The left edge of a text [pixels].
  [[nodiscard]] double LeftOf(double x, HudAlign align, const std::string& text) const;

  ImDrawList& list_;
  const HudColours& colours_;
  float scale_;
};

/// The colour as Dear ImGui packs it.
[[nodiscard]] ImU32 Packed(const HudColour& colour);

/// The same, less opaque.
[[nodiscard]] HudColour Faded(const HudColour& colour, double opacity);

/// The picture [pixels].
struct HudFrame {
  int width = 0, height = 0;
  int top = 0;  // height of what lies over its upper edge, the menu

  [[nodiscard]] glm::dvec2 middle() const { return {0.5 * width, 0.5 * height}; }
};

/// Draws them. Pictures of less than 800 x 540 units get numbers instead of tapes.
void DrawInstruments(const Canvas& canvas, const HudFrame& frame, const HudModel& model);

/// Height of the part of the picture that the clock needs, the menu's included [pixels].
[[nodiscard]] int ClockHeight(const Canvas& canvas, const HudFrame& frame, const HudModel& model);

}  // namespace alpenglow::viewer
