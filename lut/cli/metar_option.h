// SPDX-License-Identifier: MIT
// The option --metar of all programs. Only sources that parse a command line include this header
// (CLI11 is slow to compile).
#pragma once

#include <optional>
#include <string>

#include "atmosphere/weather/metar.h"
#include "lut/cli/command_line.h"

namespace alpenglow::lut {

inline constexpr char kMetarHelp[] =
    "Weather of a METAR or SPECI: \"LSZH 211350Z 24008KT 9999 FEW040 22/12 Q1018\". Visibility "
    "becomes haze or fog, cloud groups and wind become clouds, temperature, dew point and pressure "
    "the density of the air. A warning names what has no effect";
inline constexpr char kMetarAirHelp[] =
    "Air in the weather of a METAR or SPECI of a station at the ground: \"LSZH 211350Z 24008KT "
    "9999 22/12 "
    "Q1018\". Visibility becomes haze, temperature, dew point and pressure the density of the air. "
    "A "
    "warning names other groups";
inline constexpr char kStationHeightHelp[] =
    "Height of the station of --metar in metres above the ellipsoid, -500 to 6000 (default: that "
    "of "
    "a named airport, or 0)";

/// Adds --metar with a text for its help. `metar` must outlive the parsing.
inline CLI::Option* AddMetarOption(CLI::App& app, std::optional<std::string>& metar,
                                   const char* help = kMetarHelp) {
  return app.add_option("--metar", metar, help)->check(ReadableBy([](const std::string& text) {
    (void)atmosphere::ReadMetar(text);
  }));
}

}  // namespace alpenglow::lut
