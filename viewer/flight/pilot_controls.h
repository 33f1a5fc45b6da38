// SPDX-License-Identifier: MIT
// What hands say to whatever flies, in one frame.
#pragma once

#include "viewer/flight/aircraft.h"
#include "viewer/flight/flight.h"

namespace alpenglow::viewer {

struct PilotControls {
  Steering camera = {};  // the free camera
  Stick stick = {};      // the aircraft
  /// Looking around with the mouse or the right stick, in this frame: in widths of the view.
  double look_right = 0.0, look_up = 0.0;
};

}  // namespace alpenglow::viewer
