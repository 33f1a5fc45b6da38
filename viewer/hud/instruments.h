// SPDX-License-Identifier: MIT
// Instruments of a flight over a picture: their layout, and a canvas that draws lines and text
// legibly at any picture brightness, with dark outlines instead of plates, which would cover the picture.
#pragma once

#include <imgui.h>

#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "viewer/hud/hud_model.h"

namespace alpenglow::viewer {

enum class HudAlign { kLeft, kMiddle, kRight };

/// Draws in units, which are pixels of a display of 96 dots per inch; positions are in pixels.
class Canvas {
 public:
  /// @param scale  pixels per unit.
  Canvas(ImDrawList& list, const HudColours& colours, double scale)
      : list_(list), colours_(colours), scale_(static_cast<float>(scale)) {}

  [[nodiscard]] const HudColours& colours() const { return colours_; }
  [[nodiscard]] double Pixels(double units) const { return units * static_cast<double>(scale_); }
  /// Returns the height of a line of text [pixels].
  [[nodiscard]] double LineHeight() const;
  [[nodiscard]] double WidthOf(const std::string& text) const;
  /// Returns the text in lines of at most this width, broken at spaces.
  [[nodiscard]] std::vector<std::string> Wrapped(const std::string& text, double width_px) const;

  /// Shapes have a shadow around them, so that they are visible on snow and on forest.
  void Line(const glm::dvec2& from, const glm::dvec2& to, const HudColour& colour) const;
  void Ring(const glm::dvec2& centre, double radius_px, const HudColour& colour) const;
  void Disk(const glm::dvec2& centre, double radius_px, const HudColour& colour) const;
  void Triangle(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c,
                const HudColour& colour) const;
  /// Draws text in a dark outline, which has a contrast of at least 4.5 to the letters over any
  /// picture.
  /// @param at  upper left, upper middle, or upper right corner of the text.
  void Text(const glm::dvec2& at, HudAlign align, const std::string& text,
            const HudColour& colour) const;
  void Fill(const glm::dvec2& from, const glm::dvec2& to, const HudColour& colour) const;

  /// Clips drawing to a rectangle during its lifetime.
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
  /// Returns the left edge of a text [pixels].
  [[nodiscard]] double LeftOf(double x, HudAlign align, const std::string& text) const;

  ImDrawList& list_;
  const HudColours& colours_;
  float scale_;
};

/// Returns the colour in Dear ImGui's packed format.
[[nodiscard]] ImU32 Packed(const HudColour& colour);

/// Returns the colour with its opacity multiplied by `opacity`.
[[nodiscard]] HudColour Faded(const HudColour& colour, double opacity);

/// Size of the picture [pixels].
struct HudFrame {
  int width = 0, height = 0;
  int top = 0;  // height of the menu over its upper edge

  [[nodiscard]] glm::dvec2 middle() const { return {0.5 * width, 0.5 * height}; }
};

/// Draws all instruments. Pictures of less than 800 x 540 units get numbers instead of tapes.
void DrawInstruments(const Canvas& canvas, const HudFrame& frame, const HudModel& model);

/// Returns the height that clock and menu cover at the upper edge [pixels].
[[nodiscard]] int ClockHeight(const Canvas& canvas, const HudFrame& frame, const HudModel& model);

}  // namespace alpenglow::viewer
