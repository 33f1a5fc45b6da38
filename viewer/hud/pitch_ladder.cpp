// SPDX-License-Identifier: MIT
#include "viewer/hud/pitch_ladder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/constants.h"

namespace alpenglow::viewer {
namespace {

Camera CameraOf(const HudFlight& flight) {
  Camera camera;
  camera.heading_rad = flight.heading_rad;
  camera.pitch_rad = flight.pitch_rad;
  camera.roll_rad = flight.roll_rad;
  camera.fov_rad = flight.fov_rad;
  return camera;
}

}  // namespace

HorizonView::HorizonView(const HudFlight& flight, int width, int height)
    : rays_(CameraOf(flight), width, height), middle_(0.5 * width, 0.5 * height) {}

std::optional<glm::dvec2> HorizonView::PixelOf(const HudDirection& direction) const {
  const auto place =
      rays_.PlaceOf(DirectionFromAngles(direction.climb_rad, direction.heading_rad).xyz);
  if (!place) return std::nullopt;
  constexpr double kFurthest = 8.0;  // half widths
  const glm::dvec2 pixel((*place)[0], (*place)[1]);
  if (glm::distance(pixel, middle_) > kFurthest * middle_.x) return std::nullopt;
  return pixel;
}

namespace {

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
