// SPDX-License-Identifier: MIT
#include "viewer/hud/scales.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/constants.h"

namespace alpenglow::viewer {
namespace {

// Lengths in units:
constexpr double kHeadingEdge = 10.0;   // from the edge of the picture to the heading tape
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
  canvas.Text({left + margin, top.y + canvas.Pixels(2.5)}, HudAlign::kLeft, text,
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
  canvas.Text({scale.inner_x + scale.side * canvas.Pixels(13.0), y - 0.42 * canvas.LineHeight()},
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
        top_(frame.top + canvas.Pixels(kHeadingEdge)),
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
    canvas.Text({x, tape.top() + canvas.Pixels(2.0)}, HudAlign::kMiddle, HeadingLabel(degrees),
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

Camera CameraOf(const HudFlight& flight) {
  Camera camera;
  camera.heading_rad = flight.heading_rad;
  camera.pitch_rad = flight.pitch_rad;
  camera.roll_rad = flight.roll_rad;
  camera.fov_rad = flight.fov_rad;
  return camera;
}

// Lengths in units:
constexpr double kGap = 38.0;      // from the middle of a rung to its start
constexpr double kRungEnd = 92.0;  // from the middle of a rung to its end
constexpr double kHook = 7.0;      // length of a rung's hook, towards the horizon
constexpr double kMarker = 8.0;    // radius of the flight path marker
constexpr double kLargestRung_deg = 85.0;

/// A line in the picture that is level in the world.
struct Level {
  glm::dvec2 middle, along, down;  // pixels; unit vectors
};

std::optional<Level> LevelAt(const HorizonView& view, const HudFlight& flight, double climb_rad) {
  constexpr double kAside_rad = 1e-3;
  const auto middle = view.PixelOf({flight.heading_rad, climb_rad});
  const auto aside = view.PixelOf({flight.heading_rad + kAside_rad, climb_rad});
  if (!middle || !aside) return std::nullopt;
  const glm::dvec2 along = glm::normalize(*aside - *middle);
  return Level{*middle, along, {-along.y, along.x}};
}

void DrawDashed(const Canvas& canvas, const glm::dvec2& from, const glm::dvec2& to,
                const HudColour& colour) {
  constexpr int kDashes = 3;
  const glm::dvec2 step = (to - from) / (2.0 * kDashes - 1.0);
  for (int dash = 0; dash < kDashes; ++dash) {
    canvas.Line(from + 2.0 * dash * step, from + (2.0 * dash + 1.0) * step, colour);
  }
}

// Draws one side of a rung: -1 left, 1 right.
void DrawHalfRung(const Canvas& canvas, const Level& level, double side, int degrees) {
  const HudColour& colour = canvas.colours().accent;
  const glm::dvec2 begin = level.middle + side * canvas.Pixels(kGap) * level.along;
  const glm::dvec2 end = level.middle + side * canvas.Pixels(kRungEnd) * level.along;
  if (degrees > 0) {
    canvas.Line(begin, end, colour);
  } else {
    DrawDashed(canvas, begin, end, colour);
  }
  const double towards_horizon = degrees > 0 ? 1.0 : -1.0;
  canvas.Line(end, end + towards_horizon * canvas.Pixels(kHook) * level.down, colour);
  const glm::dvec2 beside = end + side * canvas.Pixels(5.0) * level.along;
  canvas.Text({beside.x, beside.y - 0.5 * canvas.LineHeight()},
              side < 0.0 ? HudAlign::kRight : HudAlign::kLeft, fmt::format("{}", degrees), colour);
}

// Returns whether a position is between the tapes, below the bank scale and above the messages.
bool HasRoom(const HudFrame& frame, const glm::dvec2& at) {
  return std::abs(at.x / frame.width - 0.5) < 0.22 && at.y > 0.24 * frame.height &&
         at.y < 0.76 * frame.height;
}

void DrawRungs(const Canvas& canvas, const HudFrame& frame, const HorizonView& view,
               const HudFlight& flight) {
  const double step = RungStep_deg(view.PixelsPerRadian() * kRadiansPerDegree / canvas.Pixels(1.0));
  const double pitch = flight.pitch_rad / kRadiansPerDegree;
  constexpr double kRungsEachWay = 5.0;
  const double first = std::ceil(pitch / step - kRungsEachWay) * step;
  for (double degrees = first; degrees <= pitch + kRungsEachWay * step; degrees += step) {
    const int whole = static_cast<int>(std::lround(degrees));
    if (whole == 0 || std::abs(degrees) > kLargestRung_deg) continue;
    const auto level = LevelAt(view, flight, degrees * kRadiansPerDegree);
    if (!level || !HasRoom(frame, level->middle)) continue;
    for (const double side : {-1.0, 1.0}) DrawHalfRung(canvas, *level, side, whole);
  }
}

void DrawHorizon(const Canvas& canvas, const HudFrame& frame, const HorizonView& view,
                 const HudFlight& flight) {
  const auto level = LevelAt(view, flight, 0.0);
  if (!level) return;
  const double end = std::max(0.22 * frame.width, canvas.Pixels(kRungEnd));
  for (const double side : {-1.0, 1.0}) {
    canvas.Line(level->middle + side * canvas.Pixels(kGap) * level->along,
                level->middle + side * end * level->along, canvas.colours().accent);
  }
}

// Marks the sea horizon where it is visibly below the horizontal plane.
void DrawDip(const Canvas& canvas, const HudFrame& frame, const HorizonView& view,
             const HudFlight& flight) {
  constexpr double kWorthDrawing = 6.0;  // units
  if (flight.horizon_dip_rad * view.PixelsPerRadian() < canvas.Pixels(kWorthDrawing)) return;
  const auto level = LevelAt(view, flight, -flight.horizon_dip_rad);
  if (!level) return;
  for (const double side : {-1.0, 1.0}) {
    DrawDashed(canvas, level->middle + side * 0.13 * frame.width * level->along,
               level->middle + side * 0.19 * frame.width * level->along, canvas.colours().quiet);
  }
}

void DrawPath(const Canvas& canvas, const HorizonView& view, const HudFlight& flight) {
  const auto at = flight.path ? view.PixelOf(*flight.path) : std::nullopt;
  if (!at) return;
  const HudColour& colour = canvas.colours().text;
  const double radius = canvas.Pixels(kMarker);
  canvas.Ring(*at, radius, colour);
  for (const glm::dvec2& side :
       {glm::dvec2(-1.0, 0.0), glm::dvec2(1.0, 0.0), glm::dvec2(0.0, -1.0)}) {
    const double length = side.x == 0.0 ? 1.7 : 2.3;
    canvas.Line(*at + radius * side, *at + length * radius * side, colour);
  }
}

// Marks the view direction.
void DrawWaterline(const Canvas& canvas, const HudFrame& frame) {
  const double arm = canvas.Pixels(10.0);
  const HudColour& colour = canvas.colours().quiet;
  for (const double side : {-1.0, 1.0}) {
    const glm::dvec2 middle = frame.middle();
    canvas.Line(middle + side * glm::dvec2(0.5 * arm, 0.0) + glm::dvec2(0.0, 0.5 * arm), middle,
                colour);
    canvas.Line(middle + side * glm::dvec2(0.5 * arm, 0.0) + glm::dvec2(0.0, 0.5 * arm),
                middle + side * glm::dvec2(1.8 * arm, 0.0) + glm::dvec2(0.0, 0.5 * arm), colour);
  }
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

HorizonView::HorizonView(const HudFlight& flight, int width, int height)
    : rays_(CameraOf(flight), width, height), middle_(0.5 * width, 0.5 * height) {}

std::optional<glm::dvec2> HorizonView::PixelOf(const Course& direction) const {
  const auto place = rays_.PlaceOf(EnuFromAngles(direction.climb_rad, direction.heading_rad).xyz);
  if (!place) return std::nullopt;
  constexpr double kFurthest = 8.0;  // half widths
  const glm::dvec2 pixel((*place)[0], (*place)[1]);
  if (glm::distance(pixel, middle_) > kFurthest * middle_.x) return std::nullopt;
  return pixel;
}

double RungStep_deg(double units_per_degree) {
  constexpr double kApart = 80.0;
  for (const double step : {1.0, 2.0, 5.0, 10.0, 15.0}) {
    if (step * units_per_degree >= kApart) return step;
  }
  return 30.0;
}

void DrawPitchLadder(const Canvas& canvas, const HudFrame& frame, const HudFlight& flight) {
  const HorizonView view(flight, frame.width, frame.height);
  {
    const Canvas::Clip between_tapes(canvas, {0.26 * frame.width, 0.16 * frame.height},
                                     {0.74 * frame.width, 0.84 * frame.height});
    DrawHorizon(canvas, frame, view, flight);
    DrawDip(canvas, frame, view, flight);
  }
  DrawRungs(canvas, frame, view, flight);
  DrawWaterline(canvas, frame);
  DrawPath(canvas, view, flight);
}

void DrawBankScale(const Canvas& canvas, const HudFrame& frame, const HudFlight& flight) {
  constexpr std::array<double, 11> kMarks_deg{-60, -45, -30, -20, -10, 0, 10, 20, 30, 45, 60};
  const double radius = 0.33 * frame.height;
  const auto at = [&](double angle_rad, double from_centre) {
    return frame.middle() + from_centre * glm::dvec2(std::sin(angle_rad), -std::cos(angle_rad));
  };
  const HudColour& colour = canvas.colours().quiet;
  for (const double mark : kMarks_deg) {
    const bool large = mark == 0.0 || std::abs(mark) >= 30.0;
    const double angle = mark * kRadiansPerDegree;
    canvas.Line(at(angle, radius), at(angle, radius + canvas.Pixels(large ? 10.0 : 6.0)), colour);
  }
  // The sky rotates against the wings: rolled to the right, up is to the left.
  constexpr double kFurthest_rad = 65.0 * kRadiansPerDegree;
  const double up =
      std::clamp(-std::remainder(flight.roll_rad, 2.0 * kPi), -kFurthest_rad, kFurthest_rad);
  const double half_width = canvas.Pixels(6.0) / radius;
  const double foot = radius - canvas.Pixels(11.0);
  canvas.Triangle(at(up, radius - canvas.Pixels(1.0)), at(up - half_width, foot),
                  at(up + half_width, foot), canvas.colours().text);
}

}  // namespace alpenglow::viewer
