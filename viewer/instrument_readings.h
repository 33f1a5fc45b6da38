// SPDX-License-Identifier: MIT
// Reads from a flight the values that its instruments and panels show.
#pragma once

#include "viewer/flight_session.h"
#include "viewer/hud/hud_model.h"

namespace alpenglow::viewer {

/// Returns the model of the HUD, without messages and the other values of the user interface.
[[nodiscard]] HudModel ReadInstruments(FlightSession& flight);

}  // namespace alpenglow::viewer
