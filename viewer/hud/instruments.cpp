// SPDX-License-Identifier: MIT
#include "viewer/hud/instruments.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/math/constants.h"
#include "viewer/hud/scales.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {
namespace {

constexpr double kLineWidth = 2.0;     // units
constexpr double kShadowWidth = 1.0;   // units, on each side
constexpr double kOutlineWidth = 1.2;  // units, of text

ImVec2 At(const glm::dvec2& point) {
  return {static_cast<float>(point.x), static_cast<float>(point.y)};
}
// Snaps to integer pixels, where letters are sharp.
ImVec2 OnPixel(const glm::dvec2& point) { return At({std::round(point.x), std::round(point.y)}); }

struct CornerTexts {
  std::vector<std::string> upper_left, upper_right, lower_left, lower_right;
};

using Lines = std::vector<std::string>;

std::string StateText(const HudModel& model) {
  return std::string(model.recording ? "REC " : "") + (model.time.paused ? "PAUSED" : "");
}

// Returns the mode, and on a second line the state while recording or paused.
Lines ModeLines(const HudModel& model) {
  Lines lines{model.flight.mode};
  if (model.recording || model.time.paused) lines.push_back(StateText(model));
  return lines;
}

std::string AutopilotText(const HudModel& model) {
  std::string text = "holds";
  if (model.autopilot.heading_rad) text += " heading " + HeadingText(*model.autopilot.heading_rad);
  if (model.autopilot.height_m)
    text += " height " + Joined(HeightText(*model.autopilot.height_m, model.units));
  if (model.autopilot.speed_m_per_s)
    text += " speed " + Joined(SpeedText(*model.autopilot.speed_m_per_s, model.units));
  return text;
}

Lines FlightLines(const HudModel& model) {
  Lines lines = ModeLines(model);
  const AutopilotTargets& held = model.autopilot;
  if (held.heading_rad || held.height_m || held.speed_m_per_s)
    lines.push_back(AutopilotText(model));
  if (model.flight.throttle)
    lines.push_back(fmt::format("throttle {:.0f} %", 100.0 * *model.flight.throttle));
  if (model.flight.load_factor) lines.push_back(fmt::format("{:.1f} g", *model.flight.load_factor));
  return lines;
}

std::string AtText(double elevation_rad, double azimuth_rad) {
  return fmt::format("{} at {}", DegreesText(elevation_rad), HeadingText(azimuth_rad));
}

Lines TimeLines(const HudModel& model) {
  Lines lines{model.time.utc, model.time.local + " " + model.time.zone,
              "time " + RateText(model.time.rate, model.time.paused),
              "sun " + AtText(model.sky.sun_elevation_rad, model.sky.sun_azimuth_rad)};
  if (model.sky.moon) {
    lines.push_back(fmt::format("moon {}, {:.0f} % lit",
                                AtText(model.sky.moon->elevation_rad, model.sky.moon->azimuth_rad),
                                100.0 * model.sky.moon->lit_share));
  }
  return lines;
}

Lines PlaceLines(const HudModel& model) {
  const HudUnits units = model.units;
  return {LatitudeText(model.latitude_deg) + "  " + LongitudeText(model.longitude_deg),
          "over the sea " + Joined(HeightText(model.flight.height_m, units)),
          "over ground " + Joined(HeightText(model.flight.above_ground_m, units)),
          "ground speed " + Joined(SpeedText(model.flight.ground_speed_m_per_s, units))};
}

std::string ExposureText(const HudExposure& exposure) {
  const std::string how = exposure.locked ? "locked" : "auto";
  const std::string more =
      exposure.compensation_ev == 0.0 ? "" : fmt::format(" {:+.1f}", exposure.compensation_ev);
  return fmt::format("EV {:.1f} {}{}", exposure.ev100, how, more);
}

std::string FrameText(const HudSpeed& speed) {
  return fmt::format("{:.1f} ms  {:.0f}/s", speed.frame_ms, 1000.0 / speed.frame_ms);
}

std::string VisibilityText(double visibility_km) {
  if (visibility_km < 1.0) return fmt::format("visibility {:.3g} m", 1e3 * visibility_km);
  return fmt::format("visibility {:.3g} km", visibility_km);
}

Lines LightLines(const HudModel& model) {
  Lines lines;
  if (model.exposure.cursor_luminance_cd_per_m2)
    lines.push_back("cursor " + LuminanceText(*model.exposure.cursor_luminance_cd_per_m2));
  lines.push_back(ExposureText(model.exposure));
  lines.push_back(VisibilityText(model.air.visibility_here_km));
  lines.push_back(fmt::format("view {:.3g}°", model.flight.fov_rad / kRadiansPerDegree));
  lines.push_back(model.speed.quality);
  lines.push_back(FrameText(model.speed));
  return lines;
}

double WidestOf(const Canvas& canvas, const Lines& lines) {
  double widest = 0.0;
  for (const std::string& line : lines) widest = std::max(widest, canvas.WidthOf(line));
  return widest;
}

/// A corner of the picture: the position of the block's corner, and its side.
struct Corner {
  glm::dvec2 at;
  bool right, lower;
};

constexpr double kEdge = 3.0;    // from the edges of the picture to blocks of text [units]
constexpr double kMargin = 4.0;  // from the edges of blocks to texts [units]

double HeightOf(const Canvas& canvas, const Lines& lines) {
  return static_cast<double>(lines.size()) * canvas.LineHeight() + 2.0 * canvas.Pixels(kMargin);
}

void DrawBlock(const Canvas& canvas, const Corner& corner, const Lines& lines) {
  if (lines.empty()) return;
  const double margin = canvas.Pixels(kMargin);
  const glm::dvec2 size{WidestOf(canvas, lines) + 2.0 * margin, HeightOf(canvas, lines)};
  const glm::dvec2 from{corner.at.x - (corner.right ? size.x : 0.0),
                        corner.at.y - (corner.lower ? size.y : 0.0)};
  const double x = corner.right ? from.x + size.x - margin : from.x + margin;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    canvas.Text({x, from.y + margin + static_cast<double>(i) * canvas.LineHeight()},
                corner.right ? HudAlign::kRight : HudAlign::kLeft, lines[i], canvas.colours().text);
  }
}

void DrawLineOfMessage(const Canvas& canvas, const HudFrame& frame, double y,
                       const HudMessage& message) {
  const HudColour& colour = message.is_warning ? canvas.colours().warning : canvas.colours().text;
  canvas.Text({frame.middle().x, y}, HudAlign::kMiddle, message.text, colour);
}

// Returns the messages in wrapped lines, the lowest line first.
std::vector<HudMessage> LinesOfMessages(const Canvas& canvas, const HudFrame& frame,
                                        const std::vector<HudMessage>& messages) {
  const double widest = frame.width - canvas.Pixels(24.0);
  std::vector<HudMessage> lines;
  for (const HudMessage& message : messages) {
    for (const std::string& line : canvas.Wrapped(message.text, widest))
      lines.push_back({line, message.is_warning});
  }
  std::reverse(lines.begin(), lines.end());
  return lines;
}

constexpr double kBarHeight = 5.0;  // units

void DrawProgress(const Canvas& canvas, const HudFrame& frame, double y,
                  const HudProgress& progress) {
  const std::string text = fmt::format("{} {:.0f} %", progress.text, 100.0 * progress.share);
  DrawLineOfMessage(canvas, frame, y, {text, false});
  const double half = std::min(canvas.Pixels(140.0), 0.3 * frame.width);
  const double left = frame.middle().x - half;
  const double top = y + canvas.LineHeight();
  const double bottom = top + canvas.Pixels(kBarHeight);
  canvas.Fill({left, top}, {left + 2.0 * half, bottom}, canvas.colours().panel);
  canvas.Fill({left, top}, {left + 2.0 * half * std::clamp(progress.share, 0.0, 1.0), bottom},
              canvas.colours().accent);
}

// Returns mode and autopilot; time, sun and moon; place; light and speed.
CornerTexts CornerTextsOf(const HudModel& model) {
  return {FlightLines(model), TimeLines(model), PlaceLines(model), LightLines(model)};
}

// Returns shorter texts for small pictures, of one or two lines each.
CornerTexts ShortCornerTextsOf(const HudModel& model) {
  return {ModeLines(model),
          {model.time.local, RateText(model.time.rate, model.time.paused)},
          {LatitudeText(model.latitude_deg), LongitudeText(model.longitude_deg)},
          {ExposureText(model.exposure), FrameText(model.speed)}};
}

// Returns the lower end of the upper right block, which shows the clock [pixels from the upper
// edge].
double BottomOfClock(const Canvas& canvas, const HudFrame& frame, const CornerTexts& texts) {
  return frame.top + canvas.Pixels(kEdge) + HeightOf(canvas, texts.upper_right);
}

void DrawCornerTexts(const Canvas& canvas, const HudFrame& frame, const CornerTexts& texts) {
  const double edge = canvas.Pixels(kEdge);
  const double left = edge, right = frame.width - edge;
  const double top = frame.top + edge, bottom = frame.height - edge;
  DrawBlock(canvas, {{left, top}, false, false}, texts.upper_left);
  DrawBlock(canvas, {{right, top}, true, false}, texts.upper_right);
  DrawBlock(canvas, {{left, bottom}, false, true}, texts.lower_left);
  DrawBlock(canvas, {{right, bottom}, true, true}, texts.lower_right);
}

// Draws messages, loading progress and warnings in the lower middle.
void DrawMessages(const Canvas& canvas, const HudFrame& frame, const HudModel& model) {
  constexpr double kLinesBelow = 3.8;  // leaves space for the corner texts of small pictures
  double y = std::min(0.86 * frame.height, frame.height - kLinesBelow * canvas.LineHeight());
  if (model.flight.stall) DrawLineOfMessage(canvas, frame, 0.36 * frame.height, {"STALL", true});
  if (model.progress) {
    DrawProgress(canvas, frame, y - canvas.Pixels(kBarHeight), *model.progress);
    y -= canvas.LineHeight() + canvas.Pixels(kBarHeight);
  }
  for (const HudMessage& line : LinesOfMessages(canvas, frame, model.messages)) {
    DrawLineOfMessage(canvas, frame, y, line);
    y -= canvas.LineHeight();
  }
}

bool IsSmall(const Canvas& canvas, const HudFrame& frame) {
  return frame.width < canvas.Pixels(800.0) || frame.height < canvas.Pixels(540.0);
}

CornerTexts TextsFor(const Canvas& canvas, const HudFrame& frame, const HudModel& model) {
  return IsSmall(canvas, frame) ? ShortCornerTextsOf(model) : CornerTextsOf(model);
}

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
  const glm::dvec2 corner{LeftOf(at.x, align, text), at.y};
  const double outline = std::max(1.0, std::round(Pixels(kOutlineWidth)));
  // Copies half an outline apart leave no gap: dots of letters are as wide as that.
  const double step = std::max(1.0, std::floor(0.5 * outline));
  for (double x = -outline; x <= outline; x += step) {
    for (double y = -outline; y <= outline; y += step) {
      // Dots and thin strokes cover their pixels in part only: one copy would be too faint there.
      for (int copy = 0; copy < 2; ++copy)
        list_.AddText(OnPixel(corner + glm::dvec2(x, y)), Packed(colours_.outline), text.c_str());
    }
  }
  list_.AddText(OnPixel(corner), Packed(colour), text.c_str());
}

void Canvas::Fill(const glm::dvec2& from, const glm::dvec2& to, const HudColour& colour) const {
  list_.AddRectFilled(At(from), At(to), Packed(colour));
}

Canvas::Clip::Clip(const Canvas& canvas, const glm::dvec2& from, const glm::dvec2& to)
    : list_(canvas.list_) {
  list_.PushClipRect(At(from), At(to), true);
}

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
