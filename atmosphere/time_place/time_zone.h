// SPDX-License-Identifier: MIT
// Civil time: the offsets of clocks in a zone of the IANA database.
//
// After its last tabulated change a zone follows a rule, written in the last line of a time zone
// file: "CET-1CEST,M3.5.0,M10.5.0/3" (RFC 8536 section 3.3, POSIX.1-2017 8.3 TZ).
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::atmosphere {

/// A yearly change: the `week`-th `weekday` (0 Sunday) of `month`, where week 5 is the last, at
/// `time` after midnight of the local time before the change; `time` may be negative or over a day.
struct YearlyChange {
  unsigned month;
  unsigned week;
  unsigned weekday;
  std::chrono::seconds time;
};

struct DaylightTime {
  std::chrono::seconds offset;  // local minus UTC, during daylight time
  YearlyChange start;
  YearlyChange end;
};

struct PosixZoneRule {
  std::chrono::seconds standard_offset;  // local minus UTC
  std::optional<DaylightTime> daylight;
};

/// Returns the rule; std::nullopt if `text` is not a rule, or counts days of the year (Jn, n),
/// which no zone of the database uses.
[[nodiscard]] std::optional<PosixZoneRule> ParsePosixZoneRule(std::string_view text);

/// Returns local time minus UTC.
[[nodiscard]] std::chrono::seconds OffsetAt(const PosixZoneRule& rule,
                                            std::chrono::sys_seconds instant);

}  // namespace alpenglow::atmosphere

namespace date {
class time_zone;
}

namespace alpenglow::atmosphere {

class TimeZone {
 public:
  /// Throws InputError if the database of this machine has no such zone.
  explicit TimeZone(const std::string& name);

  /// Returns local time minus UTC.
  [[nodiscard]] std::chrono::seconds OffsetAt(std::chrono::sys_seconds instant) const;

  /// Returns the offsets for which clocks show `local` (counted as if it were UTC): normally one,
  /// two (ascending) if clocks are set back over it, none if they are set forward over it.
  [[nodiscard]] std::vector<std::chrono::seconds> OffsetsOf(std::chrono::sys_seconds local) const;

 private:
  const date::time_zone* zone_;             // owned by the database, which is never destroyed
  std::optional<PosixZoneRule> last_rule_;  // after the last tabulated change
};

}  // namespace alpenglow::atmosphere
