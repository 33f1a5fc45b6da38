// SPDX-License-Identifier: MIT
#include "viewer/hud/tapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/math/constants.h"
#include "viewer/hud/hud_model.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {
namespace {

// Lengths in units:
constexpr double kEdge = 10.0;          // from the edge of the picture to the heading tape
constexpr double kTapeWidth = 74.0;     // of the speed and height tapes
constexpr double kTapeHalf = 120.0;     // half of their height, at most
constexpr double kMarkDistance = 26.0;  // between marks
constexpr double kSpeedAt = 0.20;       // inner edges of the speed and height tapes, fraction of
                                        // the picture's width
constexpr double kHeightAt = 0.80;

std::string HeadingLabel(int degrees) {
  switch (degrees) {
    case 0:
      return "N";
    case 90:
      return "E";
    case 180:
      return "S";
    case 270:
      return "W";
    default:
      return fmt::format("{:03d}", degrees);
  }
}

void DrawBoxed(const Canvas& canvas, const glm::dvec2& top, const std::string& text,
               HudAlign align) {
  const double margin = canvas.Pixels(5.0);
  const double width = canvas.WidthOf(text) + 2.0 * margin;
  const double share = align == HudAlign::kLeft ? 0.0 : align == HudAlign::kMiddle ? 0.5 : 1.0;
  const double left = top.x - share * width;
  canvas.Fill({left, top.y}, {left + width, top.y + canvas.LineHeight() + canvas.Pixels(3.0)},
              canvas.colours().panel);
  canvas.TextOnPlate({left + margin, top.y + canvas.Pixels(2.5)}, HudAlign::kLeft, text,
                     canvas.colours().text);
}

/// A scale on the left (-1) or right (1) side of the picture.
struct Scale {
  double side, inner_x;  // side -1 or 1; inner edge [pixels]
  double value;          // at the middle of the tape
  double step;           // between marks
  std::string unit;
  std::optional<double> held;
};

double HalfHeight(const Canvas& canvas, const HudFrame& frame) {
  return std::min(canvas.Pixels(kTapeHalf), 0.26 * frame.height);
}

double YOf(const Canvas& canvas, const HudFrame& frame, const Scale& scale, double value) {
  return frame.middle().y - (value - scale.value) / scale.step * canvas.Pixels(kMarkDistance);
}

void DrawMark(const Canvas& canvas, const HudFrame& frame, const Scale& scale, long index) {
  const double value = static_cast<double>(index) * scale.step;
  const double y = YOf(canvas, frame, scale, value);
  const bool labelled = index % 2 == 0;
  const double length = canvas.Pixels(labelled ? 8.0 : 5.0);
  canvas.Line({scale.inner_x, y}, {scale.inner_x + scale.side * length, y}, canvas.colours().quiet);
  const bool is_hidden = std::abs(y - frame.middle().y) < 1.1 * canvas.LineHeight();
  if (!labelled || is_hidden) return;
  canvas.TextOnPlate(
      {scale.inner_x + scale.side * canvas.Pixels(13.0), y - 0.42 * canvas.LineHeight()},
      scale.side < 0.0 ? HudAlign::kRight : HudAlign::kLeft, fmt::format("{:g}", value),
      canvas.colours().quiet);
}

void DrawHeld(const Canvas& canvas, const HudFrame& frame, const Scale& scale, double half) {
  const double middle = frame.middle().y;
  const double y = std::clamp(YOf(canvas, frame, scale, *scale.held), middle - half, middle + half);
  const double arm = canvas.Pixels(6.0);
  canvas.Triangle({scale.inner_x, y}, {scale.inner_x - scale.side * arm, y - arm},
                  {scale.inner_x - scale.side * arm, y + arm}, canvas.colours().warning);
}

void DrawScale(const Canvas& canvas, const HudFrame& frame, const Scale& scale,
               const std::string& number) {
  const double half = HalfHeight(canvas, frame), middle = frame.middle().y;
  const double outer = scale.inner_x + scale.side * canvas.Pixels(kTapeWidth);
  const glm::dvec2 from{std::min(scale.inner_x, outer), middle - half};
  const glm::dvec2 to{std::max(scale.inner_x, outer), middle + half};
  canvas.Plate(from, to);
  {
    const Canvas::Clip inside(canvas, from, to);
    const auto each_way = static_cast<long>(half / canvas.Pixels(kMarkDistance)) + 1;
    const long nearest = std::lround(scale.value / scale.step);
    for (long index = nearest - each_way; index <= nearest + each_way; ++index)
      DrawMark(canvas, frame, scale, index);
  }
  if (scale.held) DrawHeld(canvas, frame, scale, half);
  DrawBoxed(canvas,
            {scale.inner_x + scale.side * canvas.Pixels(8.0),
             middle - 0.5 * canvas.LineHeight() - canvas.Pixels(1.5)},
            number, scale.side < 0.0 ? HudAlign::kRight : HudAlign::kLeft);
  canvas.Text({0.5 * (from.x + to.x), from.y - canvas.LineHeight()}, HudAlign::kMiddle, scale.unit,
              canvas.colours().quiet);
}

/// Position of headings on their tape [pixels].
class HeadingTape {
 public:
  HeadingTape(const Canvas& canvas, const HudFrame& frame, double heading_rad)
      : heading_rad_(heading_rad),
        middle_(frame.middle().x),
        half_(0.15 * frame.width),
        top_(frame.top + canvas.Pixels(kEdge)),
        bottom_(top_ + canvas.LineHeight() + canvas.Pixels(12.0)) {}

  /// Returns the x position; headings outside the tape lie beside it.
  [[nodiscard]] double At(double heading_rad) const {
    constexpr double kHalfShown_rad = 30.0 * kRadiansPerDegree;
    return middle_ + std::remainder(heading_rad - heading_rad_, 2.0 * kPi) / kHalfShown_rad * half_;
  }
  [[nodiscard]] double left() const { return middle_ - half_; }
  [[nodiscard]] double right() const { return middle_ + half_; }
  [[nodiscard]] double top() const { return top_; }
  [[nodiscard]] double bottom() const { return bottom_; }

 private:
  double heading_rad_, middle_, half_, top_, bottom_;
};

void DrawHeadingMarks(const Canvas& canvas, const HeadingTape& tape) {
  for (int degrees = 0; degrees < 360; degrees += 5) {
    const double x = tape.At(degrees * kRadiansPerDegree), aside = canvas.Pixels(20.0);
    if (x < tape.left() - aside || x > tape.right() + aside) continue;
    const double mark = canvas.Pixels(degrees % 10 == 0 ? 8.0 : 5.0);
    canvas.Line({x, tape.bottom() - mark}, {x, tape.bottom()}, canvas.colours().quiet);
    if (degrees % 10 != 0) continue;
    canvas.TextOnPlate({x, tape.top() + canvas.Pixels(2.0)}, HudAlign::kMiddle,
                       HeadingLabel(degrees),
                       degrees % 90 == 0 ? canvas.colours().text : canvas.colours().quiet);
  }
}

void DrawSunAndMoon(const Canvas& canvas, const HeadingTape& tape, const HudSky& sky) {
  const double radius = canvas.Pixels(5.0), y = tape.bottom() - canvas.Pixels(7.0);
  canvas.Disk({tape.At(sky.sun_azimuth_rad), y}, radius, canvas.colours().warning);
  if (sky.moon) canvas.Ring({tape.At(sky.moon->azimuth_rad), y}, radius, canvas.colours().text);
}

void DrawHeldHeading(const Canvas& canvas, const HeadingTape& tape, double heading_rad) {
  const double x = std::clamp(tape.At(heading_rad), tape.left(), tape.right());
  const double arm = canvas.Pixels(6.0), y = tape.bottom();
  canvas.Triangle({x, y}, {x - arm, y + arm}, {x + arm, y + arm}, canvas.colours().warning);
}

double ShownSpeed(const HudFlight& flight) {
  return flight.air_speed_m_per_s.value_or(flight.ground_speed_m_per_s);
}
}  // namespace

double MarkStep(double value, double least) {
  constexpr double kMarksFromZero = 40.0;
  const double wanted = std::max(std::abs(value) / kMarksFromZero, least);
  const double power = std::pow(10.0, std::floor(std::log10(wanted) + 1e-9));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= wanted * (1.0 - 1e-9)) return factor * power;
  }
  return 10.0 * power;
}

void DrawHeadingTape(const Canvas& canvas, const HudFrame& frame, const HudModel& model) {
  const HeadingTape tape(canvas, frame, model.flight.heading_rad);
  canvas.Plate({tape.left(), tape.top()}, {tape.right(), tape.bottom()});
  {
    const Canvas::Clip inside(canvas, {tape.left(), tape.top()}, {tape.right(), tape.bottom()});
    DrawHeadingMarks(canvas, tape);
    DrawSunAndMoon(canvas, tape, model.sky);
  }
  if (model.autopilot.heading_rad) DrawHeldHeading(canvas, tape, *model.autopilot.heading_rad);
  DrawBoxed(canvas, {frame.middle().x, tape.bottom() + canvas.Pixels(4.0)},
            HeadingText(model.flight.heading_rad), HudAlign::kMiddle);
}

void DrawHeadingNumber(const Canvas& canvas, const HudFrame& frame, const HudModel& model) {
  DrawBoxed(canvas, {frame.middle().x, frame.top + canvas.Pixels(3.0)},
            HeadingText(model.flight.heading_rad), HudAlign::kMiddle);
}

void DrawSpeedTape(const Canvas& canvas, const HudFrame& frame, const HudModel& model) {
  const Quantity speed = SpeedText(ShownSpeed(model.flight), model.units);
  const double value = ShownSpeed(model.flight) * speed.per_si;
  DrawScale(canvas, frame,
            {-1.0, kSpeedAt * frame.width, value, MarkStep(value, 5.0), speed.unit, std::nullopt},
            speed.number);
}

void DrawHeightTape(const Canvas& canvas, const HudFrame& frame, const HudModel& model) {
  const Quantity height = HeightText(model.flight.height_m, model.units);
  const double value = model.flight.height_m * height.per_si;
  const auto held = model.autopilot.height_m
                        ? std::optional(*model.autopilot.height_m * height.per_si)
                        : std::nullopt;
  const double x = kHeightAt * frame.width;
  DrawScale(canvas, frame, {1.0, x, value, MarkStep(value, 10.0), height.unit, held},
            height.number);
  const double below = frame.middle().y + HalfHeight(canvas, frame) + canvas.Pixels(3.0);
  const glm::dvec2 at{x + 0.5 * canvas.Pixels(kTapeWidth), below};
  canvas.Text(at, HudAlign::kMiddle, Joined(ClimbText(model.flight.climb_m_per_s, model.units)),
              canvas.colours().text);
  canvas.Text(at + glm::dvec2(0.0, canvas.LineHeight()), HudAlign::kMiddle,
              "ground " + Joined(HeightText(model.flight.above_ground_m, model.units)),
              canvas.colours().quiet);
}

void DrawSpeedAndHeightNumbers(const Canvas& canvas, const HudFrame& frame, const HudModel& model) {
  const double edge = canvas.Pixels(4.0);
  const double y = frame.middle().y - canvas.LineHeight();
  canvas.Text({edge, y}, HudAlign::kLeft, Joined(SpeedText(ShownSpeed(model.flight), model.units)),
              canvas.colours().text);
  const double right = frame.width - edge;
  canvas.Text({right, y}, HudAlign::kRight, Joined(HeightText(model.flight.height_m, model.units)),
              canvas.colours().text);
  canvas.Text({right, y + canvas.LineHeight()}, HudAlign::kRight,
              Joined(ClimbText(model.flight.climb_m_per_s, model.units)), canvas.colours().quiet);
}

}  // namespace alpenglow::viewer
