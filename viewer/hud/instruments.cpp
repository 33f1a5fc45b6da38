// SPDX-License-Identifier: MIT
#include "viewer/hud/instruments.h"

#include <algorithm>
#include <cmath>

#include "viewer/hud/corner_texts.h"
#include "viewer/hud/pitch_ladder.h"
#include "viewer/hud/tapes.h"

namespace alpenglow::viewer {
namespace {

constexpr double kLineWidth = 2.0;    // units
constexpr double kShadowWidth = 1.0;  // units, on each side
constexpr double kRounding = 3.0;     // units

ImVec2 At(const glm::dvec2& point) {
  return {static_cast<float>(point.x), static_cast<float>(point.y)};
}
// Snaps to integer pixels, where letters are sharp.
ImVec2 OnPixel(const glm::dvec2& point) { return At({std::round(point.x), std::round(point.y)}); }

}  // namespace

ImU32 Packed(const HudColour& colour) {
  return ImGui::ColorConvertFloat4ToU32({colour[0], colour[1], colour[2], colour[3]});
}

HudColour Faded(const HudColour& colour, double opacity) {
  HudColour faded = colour;
  faded[3] *= static_cast<float>(std::clamp(opacity, 0.0, 1.0));
  return faded;
}

double Canvas::LineHeight() const { return static_cast<double>(ImGui::GetFontSize()) * 1.2; }

double Canvas::WidthOf(const std::string& text) const {
  return static_cast<double>(ImGui::CalcTextSize(text.c_str()).x);
}

std::vector<std::string> Canvas::Wrapped(const std::string& text, double width_px) const {
  std::vector<std::string> lines;
  const char* const end = text.data() + text.size();
  for (const char* begin = text.data(); begin < end;) {
    const char* stop =
        ImGui::GetFont()->CalcWordWrapPositionA(1.0F, begin, end, static_cast<float>(width_px));
    stop = std::max(stop, begin + 1);
    lines.emplace_back(begin, stop);
    begin = stop;
    while (begin < end && *begin == ' ') ++begin;
  }
  return lines;
}

void Canvas::Line(const glm::dvec2& from, const glm::dvec2& to, const HudColour& colour) const {
  const auto wide = static_cast<float>(Pixels(kLineWidth + 2.0 * kShadowWidth));
  list_.AddLine(At(from), At(to), Packed(Faded(colours_.shadow, static_cast<double>(colour[3]))),
                wide);
  list_.AddLine(At(from), At(to), Packed(colour), static_cast<float>(Pixels(kLineWidth)));
}

void Canvas::Ring(const glm::dvec2& centre, double radius_px, const HudColour& colour) const {
  const auto radius = static_cast<float>(radius_px);
  list_.AddCircle(At(centre), radius, Packed(colours_.shadow), 0,
                  static_cast<float>(Pixels(kLineWidth + 2.0 * kShadowWidth)));
  list_.AddCircle(At(centre), radius, Packed(colour), 0, static_cast<float>(Pixels(kLineWidth)));
}

void Canvas::Disk(const glm::dvec2& centre, double radius_px, const HudColour& colour) const {
  list_.AddCircleFilled(At(centre), static_cast<float>(radius_px + Pixels(kShadowWidth)),
                        Packed(colours_.shadow));
  list_.AddCircleFilled(At(centre), static_cast<float>(radius_px), Packed(colour));
}

void Canvas::Triangle(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c,
                      const HudColour& colour) const {
  list_.AddTriangle(At(a), At(b), At(c), Packed(colours_.shadow),
                    static_cast<float>(Pixels(2.0 * kShadowWidth)));
  list_.AddTriangleFilled(At(a), At(b), At(c), Packed(colour));
}

double Canvas::LeftOf(double x, HudAlign align, const std::string& text) const {
  const double share = align == HudAlign::kLeft ? 0.0 : align == HudAlign::kMiddle ? 0.5 : 1.0;
  return x - share * WidthOf(text);
}

void Canvas::Text(const glm::dvec2& at, HudAlign align, const std::string& text,
                  const HudColour& colour) const {
  const double margin = Pixels(3.0), left = LeftOf(at.x, align, text);
  // The plate has the height of a line, so that plates of adjacent lines meet; the shadow needs
  // space below.
  const double top = at.y - 0.25 * (LineHeight() - static_cast<double>(ImGui::GetFontSize()));
  Plate({left - margin, std::round(top)},
        {left + WidthOf(text) + margin, std::round(top + LineHeight())});
  TextOnPlate(at, align, text, colour);
}

void Canvas::TextOnPlate(const glm::dvec2& at, HudAlign align, const std::string& text,
                         const HudColour& colour) const {
  const glm::dvec2 corner{LeftOf(at.x, align, text), at.y};
  const double step = std::max(1.0, Pixels(0.9));
  list_.AddText(OnPixel(corner + step), Packed(colours_.shadow), text.c_str());
  list_.AddText(OnPixel(corner), Packed(colour), text.c_str());
}

void Canvas::Plate(const glm::dvec2& from, const glm::dvec2& to) const {
  list_.AddRectFilled(At(from), At(to), Packed(colours_.plate),
                      static_cast<float>(Pixels(kRounding)));
}

void Canvas::Fill(const glm::dvec2& from, const glm::dvec2& to, const HudColour& colour) const {
  list_.AddRectFilled(At(from), At(to), Packed(colour));
}

Canvas::Clip::Clip(const Canvas& canvas, const glm::dvec2& from, const glm::dvec2& to)
    : list_(canvas.list_) {
  list_.PushClipRect(At(from), At(to), true);
}

namespace {

bool IsSmall(const Canvas& canvas, const HudFrame& frame) {
  return frame.width < canvas.Pixels(800.0) || frame.height < canvas.Pixels(540.0);
}

CornerTexts TextsFor(const Canvas& canvas, const HudFrame& frame, const HudModel& model) {
  return IsSmall(canvas, frame) ? ShortCornerTextsOf(model) : CornerTextsOf(model);
}

}  // namespace

int ClockHeight(const Canvas& canvas, const HudFrame& frame, const HudModel& model) {
  return static_cast<int>(std::ceil(BottomOfClock(canvas, frame, TextsFor(canvas, frame, model))));
}

void DrawInstruments(const Canvas& canvas, const HudFrame& frame, const HudModel& model) {
  DrawPitchLadder(canvas, frame, model.flight);
  if (IsSmall(canvas, frame)) {
    DrawHeadingNumber(canvas, frame, model);
    DrawSpeedAndHeightNumbers(canvas, frame, model);
  } else {
    DrawBankScale(canvas, frame, model.flight);
    DrawHeadingTape(canvas, frame, model);
    DrawSpeedTape(canvas, frame, model);
    DrawHeightTape(canvas, frame, model);
  }
  DrawCornerTexts(canvas, frame, TextsFor(canvas, frame, model));
  DrawMessages(canvas, frame, model);
}

}  // namespace alpenglow::viewer
