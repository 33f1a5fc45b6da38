// SPDX-License-Identifier: MIT
#include "atmosphere/sun/time_zone.h"

#include <date/tz.h>
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "atmosphere/text/error.h"

namespace alpenglow::atmosphere {
namespace {

using std::chrono::seconds;
using std::chrono::sys_seconds;

const date::time_zone* Located(const std::string& name) {
  try {
    return date::locate_zone(name);
  } catch (const std::runtime_error&) {
    throw InputError(fmt::format(
        "zone \"{}\" is not in the time zone database; it must be a name such as Europe/Zurich",
        name));
  }
}

/// The last line of the zone's file. The date library reads only the table of changes, which ends
/// in 2037, and would keep winter time ever after.
std::optional<PosixZoneRule> LastRule(const std::string& name) {
  // The folders in which the date library looks.
  for (const char* folder : {"/usr/share/zoneinfo/", "/var/db/zoneinfo/"}) {
    std::ifstream file(folder + name, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    if (text.size() < 2 || text.back() != '\n') continue;
    const std::size_t line = text.rfind('\n', text.size() - 2);
    if (line == std::string::npos) continue;
    return ParsePosixZoneRule(std::string_view(text).substr(line + 1, text.size() - line - 2));
  }
  return std::nullopt;
}

}  // namespace

TimeZone::TimeZone(const std::string& name)
    : zone_(Located(name)), last_rule_(LastRule(zone_->name())) {}

seconds TimeZone::OffsetAt(sys_seconds instant) const {
  const date::sys_info info = zone_->get_info(instant);
  // The library says "for ever" by an end in the year 32767.
  const bool is_last =
      info.end > sys_seconds(std::chrono::sys_days(std::chrono::year(3000) / 1 / 1));
  return is_last && last_rule_ ? atmosphere::OffsetAt(*last_rule_, instant) : info.offset;
}

std::vector<seconds> TimeZone::OffsetsOf(sys_seconds local) const {
  // Whatever applies is in force within a day of UTC = local: offsets are less than a day, and two
  // changes are further apart.
  std::vector<seconds> found;
  for (const seconds shift : {-seconds(86400), seconds(86400)}) {
    const seconds offset = OffsetAt(local + shift);
    if (OffsetAt(local - offset) == offset &&
        std::find(found.begin(), found.end(), offset) == found.end()) {
      found.push_back(offset);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace alpenglow::atmosphere
