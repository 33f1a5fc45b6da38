// SPDX-License-Identifier: MIT
#include "viewer/hud/hud_theme.h"

namespace alpenglow::viewer {

const HudColours& ColoursOf(HudTheme theme) {
  static constexpr HudColours kDay{
      .text = {0.94F, 1.0F, 0.95F, 1.0F},
      .quiet = {0.83F, 0.90F, 0.87F, 1.0F},
      .accent = {0.45F, 1.0F, 0.55F, 1.0F},
      .warning = {1.0F, 0.88F, 0.40F, 1.0F},
      .shadow = {0.0F, 0.0F, 0.0F, 0.55F},
      .plate = {0.03F, 0.05F, 0.07F, 0.64F},
      .panel = {0.07F, 0.09F, 0.12F, 0.93F},
      .control = {0.22F, 0.30F, 0.38F, 0.90F},
      .active = {0.24F, 0.46F, 0.60F, 1.0F},
  };
  static constexpr HudColours kNight{
      .text = {0.95F, 0.42F, 0.08F, 1.0F},
      .quiet = {0.90F, 0.41F, 0.08F, 1.0F},
      .accent = {0.95F, 0.48F, 0.06F, 1.0F},
      .warning = {1.0F, 0.34F, 0.08F, 1.0F},
      .shadow = {0.0F, 0.0F, 0.0F, 0.75F},
      .plate = {0.02F, 0.0F, 0.0F, 0.86F},
      .panel = {0.04F, 0.01F, 0.005F, 0.92F},
      .control = {0.20F, 0.05F, 0.02F, 0.95F},
      .active = {0.33F, 0.09F, 0.03F, 1.0F},
  };
  return theme == HudTheme::kDay ? kDay : kNight;
}

HudTheme ThemeFor(HudThemeChoice choice, double ev100, HudTheme before) {
  constexpr double kNightBelow = 1.0, kDayAbove = 3.0;
  if (choice == HudThemeChoice::kDay) return HudTheme::kDay;
  if (choice == HudThemeChoice::kNight) return HudTheme::kNight;
  if (before == HudTheme::kDay) return ev100 < kNightBelow ? HudTheme::kNight : HudTheme::kDay;
  return ev100 > kDayAbove ? HudTheme::kDay : HudTheme::kNight;
}

}  // namespace alpenglow::viewer
