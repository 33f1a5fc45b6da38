// SPDX-License-Identifier: MIT
// The option --metar of all programs. Only sources that parse a command line include this header
// (CLI11 is slow to compile).
#pragma once

#include <optional>
#include <string>

#include "atmosphere/weather/metar.h"
#include "lut/cli/command_line.h"

namespace alpenglow::lut {

/// The help of programs that have neither clouds nor fog.
inline constexpr char kMetarAirHelp[] =
    "Air in the weather of a METAR or SPECI, whose station is at the ground: \"LSZH 211350Z "
    "24008KT 9999 22/12 Q1018\". Visibility becomes haze; temperature, dew point and pressure set "
    "the density of the air. A warning names other groups";

/// Adds --metar with a text for its help. `metar` must outlive the parsing.
inline CLI::Option* AddMetarOption(CLI::App& app, std::optional<std::string>& metar,
                                   const char* help) {
  return app.add_option("--metar", metar, help)->check(ReadableBy([](const std::string& text) {
    (void)atmosphere::ReadMetar(text);
  }));
}

}  // namespace alpenglow::lut
