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

/// Adds --white-balance, --tone-map and --look. `options` must outlive the parsing.
/// @param curves  values of --tone-map: LookNames(), or ToneCurveNames() without local exposure.
/// @param curve_help  help text of --tone-map.
inline void AddLookOptions(CLI::App& app, DisplayOptions& options,
                           const std::vector<std::string>& curves, const char* curve_help) {
  app.add_option("--white-balance", options.white_balance,
                 "Light that is shown as white: camera (5500 K by day, 4000 K by night), "
                 "daylight, auto (the mean colour of the picture, limited to 3000 to 7000 K) or a "
                 "temperature in kelvins, 1500 to 25000")
      ->check(ReadableBy([](const std::string& text) { (void)WhiteBalanceFromText(text); }))
      ->capture_default_str();
  app.add_option("--tone-map", options.tone_map, curve_help)
      ->check(CLI::IsMember(curves))
      ->capture_default_str();
  app.add_option(
         "--look", options.look,
         "Look of the tone curve agx: photo, or a look of the authors of agx: none, punchy, "
         "medium or high contrast")
      ->check(CLI::IsMember(AgxLookNames()))
      ->capture_default_str();
}

}  // namespace alpenglow::lut
