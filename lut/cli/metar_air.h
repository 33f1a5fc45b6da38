// SPDX-License-Identifier: MIT
// Air in the weather of --metar, for programs that have neither clouds nor fog.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "atmosphere/medium/medium.h"
#include "atmosphere/weather/metar.h"
#include "lut/layer.h"

namespace alpenglow::lut {

/// Returns the groups of a report that have no effect on the air, with their meaning: "FEW040
/// (clouds)".
[[nodiscard]] std::vector<std::string> GroupsBesideAir(const MetarReport& report);

/// Returns the medium in the air of a report (InReportedAir) whose station is at altitude 0, and
/// writes a warning that names GroupsBesideAir. Without a report the medium is unchanged. Throws
/// InputError "--metar: ...".
[[nodiscard]] Medium InTypedAir(Medium medium, const std::optional<std::string>& metar);

}  // namespace alpenglow::lut
