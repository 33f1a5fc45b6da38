// SPDX-License-Identifier: MIT
// Instruments drawn over a picture without any window, and what was clicked on them.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include "lut/image/white_balance.h"
#include "tests/viewer/input/recorded_commands.h"
#include "tests/viewer/shaders/headless.h"
#include "viewer/gl/render_target.h"
#include "viewer/hud/hud.h"

namespace alpenglow::tests {

using namespace viewer;

/// A flight of which every instrument has something to tell.
inline HudModel Flying() {
  HudModel model;
  model.flight.mode = "aircraft";
  model.flight.heading_rad = 0.8;
  model.flight.ground_speed_m_per_s = 70.0;
  model.flight.air_speed_m_per_s = 68.0;
  model.flight.height_m = 3200.0;
  model.flight.above_ground_m = 1100.0;
  model.flight.throttle = 0.7;
  model.time.utc = "2026-06-21 16:42:07Z";
  model.time.local = "18:42:07";
  model.time.zone = "Europe/Zurich";
  model.speed.quality = "high";
  return model;
}

/// The changes that panels requested in a frame.
struct Changes : RecordedCommands::Requests {
  std::optional<double> day_fraction;  // of the day that the model shows
  std::optional<AgxLook> look;
  std::optional<WhiteBalance> white;
  std::optional<double> throttle;
  std::optional<std::optional<double>> heading_rad, speed_m_per_s;  // of the autopilot
};

/// A frame of a flight in the aircraft whose look and white balance are none of those that panels
/// offer first.
inline Changes FrameOf(Hud& hud, const HudModel& model, const InputFrame& input) {
  RecordedCommands flight;
  flight.controller().Enter(FlightMode::kAircraft);
  Look look;
  look.agx = AgxLook::kNone;
  look.white = WhiteBalanceFromText("3456");
  flight.exposure().Use(look);
  AutopilotTargets held{.heading_rad = model.autopilot.heading_rad};
  flight.controller().pilot().aircraft()->autopilot().Set(held);
  const double first_throttle = flight.controller().pilot().aircraft()->Readout().throttle;
  const UtcTime before = flight.controller().clock().now();
  hud.Update(model, nullptr, input, flight);
  Changes changes;
  static_cast<RecordedCommands::Requests&>(changes) = flight.requests;
  const double shifted_s = SecondsBetween(before, flight.controller().clock().now());
  if (shifted_s != 0.0) changes.day_fraction = model.time.day_fraction + shifted_s / 86400.0;
  const Look& now = flight.exposure().look();
  if (now.agx != look.agx) changes.look = now.agx;
  if (now.white != look.white) changes.white = now.white;
  const PilotedAircraft* aircraft = flight.controller().pilot().aircraft();
  if (aircraft == nullptr) return changes;
  const double throttle = aircraft->Readout().throttle;
  if (throttle != first_throttle) changes.throttle = throttle;
  const AutopilotTargets& targets = aircraft->autopilot().targets();
  if (targets.heading_rad != held.heading_rad) changes.heading_rad = targets.heading_rad;
  if (targets.speed_m_per_s) changes.speed_m_per_s = targets.speed_m_per_s;
  return changes;
}

class HudPicture : public Headless {
 protected:
  static InputFrame Still(int width, int height) { return {{}, {width, height}, 0.02}; }

  /// Over a grey of 0.5. Panels need two frames to find their size.
  static HdrImage Drawn(Hud& hud, const HudModel& model, int width, int height) {
    for (int frame = 0; frame < 3; ++frame) FrameOf(hud, model, Still(width, height));
    return DrawnAsIs(hud, width, height);
  }
  /// Returns the same without another frame.
  static HdrImage DrawnAsIs(const Hud& hud, int width, int height) {
    const RenderTarget target(width, height, RenderTarget::Depth::kNone);
    target.Bind();
    glClearColor(0.5F, 0.5F, 0.5F, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT);
    hud.Paint(target.framebuffer());
    return target.Read();
  }

  /// The area in which two pictures differ, [left, right) x [top, bottom); it is empty if they are
  /// equal.
  struct Box {
    int left, top, right, bottom;
    [[nodiscard]] bool empty() const { return right <= left; }
  };
  static Box Difference(const HdrImage& a, const HdrImage& b) {
    Box box{a.width, a.height, 0, 0};
    const auto row_bytes = static_cast<std::size_t>(a.width) * sizeof(a.rgb[0]);
    for (int y = 0; y < a.height; ++y) {
      if (std::memcmp(&a.at(0, y), &b.at(0, y), row_bytes) == 0) continue;
      for (int x = 0; x < a.width; ++x) {
        if (a.at(x, y) == b.at(x, y)) continue;
        box = {std::min(box.left, x), std::min(box.top, y), std::max(box.right, x + 1),
               std::max(box.bottom, y + 1)};
      }
    }
    return box;
  }
};

/// Instruments of a flight under a mouse, over a picture of one size.
class HudUnderMouse : public HudPicture {
 protected:
  HudUnderMouse(int width, int height) : width_(width), height_(height) {}

  /// Draws a frame with the pointer at a place.
  Changes At(Hud& hud, double x, double y, bool pressed) {
    InputFrame input = Still(width_, height_);
    input.events.pointer = PointerPlace{x, y};
    input.events.buttons[0] = pressed;
    return FrameOf(hud, model_, input);
  }
  /// Moves the pointer to a place and clicks there. Returns the requests while the button was down
  /// and when it was released.
  std::array<Changes, 2> Click(Hud& hud, double x, double y) {
    static_cast<void>(At(hud, x, y, false));
    Changes pressed = At(hud, x, y, true);
    return {std::move(pressed), At(hud, x, y, false)};
  }

  HudModel model_ = Flying();

 private:
  int width_, height_;
};

}  // namespace alpenglow::tests
