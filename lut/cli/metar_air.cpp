// SPDX-License-Identifier: MIT
#include "lut/cli/metar_air.h"

#include <fmt/format.h>

#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/weather/reported_air.h"
#include "lut/cli/messages.h"

namespace alpenglow::lut {

std::vector<std::string> GroupsBesideAir(const MetarReport& report) {
  std::vector<std::string> groups;
  if (report.wind && report.wind->speed_m_per_s > 0.0) groups.emplace_back("wind");
  if (IsInFog(report)) groups.emplace_back("fog");
  for (const ReportedCloud& cloud : report.clouds)
    groups.push_back(fmt::format("{} (clouds)", cloud.group));
  if (report.obscured) groups.push_back(fmt::format("{} (hidden sky)", report.obscured->group));
  groups.insert(groups.end(), report.not_modelled.begin(), report.not_modelled.end());
  return groups;
}

Medium InTypedAir(Medium medium, const std::optional<std::string>& metar) {
  if (!metar) return medium;
  const MetarReport report = ReadMetar(*metar);
  const std::vector<std::string> groups = GroupsBesideAir(report);
  if (!groups.empty()) Warn(fmt::format("--metar: not modelled: {}", fmt::join(groups, ", ")));
  try {
    return InReportedAir(std::move(medium), report, 0.0);
  } catch (const InputError& error) {
    throw InputError(fmt::format("--metar: {}", error.what()));
  }
}

}  // namespace alpenglow::lut
