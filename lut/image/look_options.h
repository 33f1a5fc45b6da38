// SPDX-License-Identifier: MIT
// Command-line options of the look of a picture, which all programs have. Only sources that parse a
// command line include this header (CLI11 is slow to compile).
#pragma once

#include <string>
#include <vector>

#include "lut/cli/command_line.h"
#include "lut/image/look.h"
#include "lut/image/white_balance.h"

namespace alpenglow::lut {

/// The options as typed.
struct LookTexts {
  std::string white_balance = "camera", tone_curve = "agx", agx_look = "photo";
};

/// Adds --white-balance, --tone-map and --look. `texts` must outlive the parsing.
/// @param curves  values of --tone-map: LookNames(), or ToneCurveNames() without local exposure.
/// @param curve_help  help text of --tone-map.
inline void AddLookOptions(CLI::App& app, LookTexts& texts, const std::vector<std::string>& curves,
                           const char* curve_help) {
  app.add_option("--white-balance", texts.white_balance,
                 "Light that is shown as white: camera (daylight by day, 4000 K by night), "
                 "daylight, auto (the mean colour of the picture, limited to 3000 to 7000 K) or a "
                 "temperature in kelvins, 1500 to 25000")
      ->check(ReadableBy([](const std::string& text) { (void)WhiteBalanceFromText(text); }))
      ->capture_default_str();
  app.add_option("--tone-map", texts.tone_curve, curve_help)
      ->check(CLI::IsMember(curves))
      ->capture_default_str();
  app.add_option(
         "--look", texts.agx_look,
         "Look of the tone curve agx: photo, or a look of the authors of agx: none, punchy, "
         "medium or high contrast")
      ->check(CLI::IsMember(AgxLookNames()))
      ->capture_default_str();
}

/// Returns the look that the options name.
[[nodiscard]] inline Look LookFromTexts(const LookTexts& texts) {
  Look look = LookFromName(texts.tone_curve);
  look.agx = AgxLookFromName(texts.agx_look);
  look.white = WhiteBalanceFromText(texts.white_balance);
  return look;
}

}  // namespace alpenglow::lut
