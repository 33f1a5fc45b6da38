// SPDX-License-Identifier: MIT
// Instruments drawn over a picture without any window, and what was clicked on them.
#pragma once

#include <algorithm>

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

class HudPicture : public Headless {
 protected:
  static HudInput Still(int width, int height) {
    HudInput input;
    input.width = width;
    input.height = height;
    input.seconds = 0.02;
    return input;
  }

  /// Over a grey of 0.5. Panels need two frames to find their size.
  static Image Drawn(Hud& hud, const HudModel& model, int width, int height) {
    for (int frame = 0; frame < 3; ++frame)
      static_cast<void>(hud.Update(model, {}, nullptr, Still(width, height)));
    const RenderTarget target(width, height, RenderTarget::Depth::kNone);
    target.Bind();
    glClearColor(0.5F, 0.5F, 0.5F, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT);
    hud.Paint(target.framebuffer());
    return target.Read();
  }

  /// Where two pictures differ: [left, right) x [top, bottom); empty where they do not.
  struct Box {
    int left, top, right, bottom;
    [[nodiscard]] bool empty() const { return right <= left; }
  };
  static Box Difference(const Image& a, const Image& b) {
    Box box{a.width, a.height, 0, 0};
    for (int y = 0; y < a.height; ++y) {
      for (int x = 0; x < a.width; ++x) {
        if (a.at(x, y) == b.at(x, y)) continue;
        box = {std::min(box.left, x), std::min(box.top, y), std::max(box.right, x + 1),
               std::max(box.bottom, y + 1)};
      }
    }
    return box;
  }
};

}  // namespace alpenglow::tests
