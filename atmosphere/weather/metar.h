// SPDX-License-Identifier: MIT
// Reads aviation weather reports (METAR and SPECI; see metar_groups.h for the code forms).
//
//   METAR LSZH 211350Z 24008KT 9999 -SHRA FEW040 SCT120 22/12 Q1018 NOSIG
//
// The groups stand in the order of the code: station and time; wind; visibility; runway visual
// range; weather; clouds; temperature; pressure; other groups. A report may lack any of them but
// station and time. A group that no code form has, that stands before one that precedes it, or that is given
// twice is refused; remarks and the trend are not read.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/weather/metar_groups.h"

namespace alpenglow::atmosphere {

struct MetarReport {
  std::string text;     // in capital letters, with one blank between groups
  std::string station;  // "LSZH"
  ReportTime time;
  std::optional<ReportedWind> wind;
  std::optional<ReportedVisibility> visibility;
  std::string fog;  // the group of fog at the station, "FG" or "FZFG"; empty without fog
  /// The report states clouds or their absence (CAVOK, NSC, NCD, SKC, CLR).
  bool states_clouds = false;
  std::vector<ReportedCloud> clouds;  // of known amount and height, in the order of the report
  std::optional<ObscuredSky> obscured;
  ReportedTemperature temperature;
  std::optional<double> pressure_pa;  // reduced to the sea (QNH)
  /// Groups that have no effect on a picture, with their meaning: "-RA (light: rain)".
  std::vector<std::string> not_modelled;
};

/// Reads a report. Throws InputError "group "GROUP": REASON" for the first group that is refused, and
/// for a report that is missing (NIL) or is a forecast (TAF).
[[nodiscard]] MetarReport ReadMetar(std::string_view text);

}  // namespace alpenglow::atmosphere
