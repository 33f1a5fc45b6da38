// SPDX-License-Identifier: MIT
// Colours of instruments and panels: bright ones for the day, red and amber ones that leave the eye
// adapted to the dark. What is written has a plate or a panel behind it, and a contrast to it of 4.5
// at least (Web Content Accessibility Guidelines 2.1, 1.4.3), whatever the picture is, up to white.
#pragma once

#include <array>

namespace alpenglow::viewer {

enum class HudTheme { kDay, kNight };
enum class HudThemeChoice { kAuto, kDay, kNight };

/// Red, green, blue of the display and opacity, each in [0, 1].
using HudColour = std::array<float, 4>;

struct HudColours {
  HudColour text, quiet, accent, warning;  // what is written and drawn
  HudColour shadow;                        // around it
  HudColour plate;                         // behind it
  HudColour panel, control, active;        // of panels
};
[[nodiscard]] const HudColours& ColoursOf(HudTheme theme);

/// The theme of a choice; kAuto takes the night's when the exposure falls below the end of civil
/// twilight, EV 1, and the day's again above EV 3, so that no dusk flickers.
[[nodiscard]] HudTheme ThemeFor(HudThemeChoice choice, double ev100, HudTheme before);

}  // namespace alpenglow::viewer
