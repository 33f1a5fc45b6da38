// SPDX-License-Identifier: MIT
// Civil time: what clocks show in a zone of the IANA database.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/sun/posix_zone_rule.h"

namespace date {
class time_zone;
}

namespace alpenglow::atmosphere {

class TimeZone {
 public:
  /// Throws InputError when the database of this machine has no such zone.
  explicit TimeZone(const std::string& name);

  /// Local time minus UTC.
  [[nodiscard]] std::chrono::seconds OffsetAt(std::chrono::sys_seconds instant) const;

  /// The offsets under which clocks show `local` (counted as if it were UTC): one as a rule, two
  /// (ascending) when clocks are set back over it, none when they are set forward over it.
  [[nodiscard]] std::vector<std::chrono::seconds> OffsetsOf(std::chrono::sys_seconds local) const;

 private:
  const date::time_zone* zone_;             // owned by the database, which lives for ever
  std::optional<PosixZoneRule> last_rule_;  // after the last tabulated change
};

}  // namespace alpenglow::atmosphere
