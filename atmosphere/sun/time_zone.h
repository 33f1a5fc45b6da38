// SPDX-License-Identifier: MIT
// The rule that a time zone follows after its last tabulated change, as the last line of a time
// zone file writes it: "CET-1CEST,M3.5.0,M10.5.0/3" (RFC 8536 section 3.3, POSIX.1-2017 8.3 TZ).
//
// Civil time: what clocks show in a zone of the IANA database.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::atmosphere {

/// A change every year: the `week`-th `weekday` (0 Sunday) of `month`,
/// 5 meaning the last, at `time` after midnight of local time as it
/// was before the change; `time` may be negative or over a day.
struct YearlyChange {
  unsigned month;
  unsigned week;
  unsigned weekday;
  std::chrono::seconds time;
};

struct DaylightTime {
  std::chrono::seconds offset;  // local minus UTC, during it
  YearlyChange start;
  YearlyChange end;
};

struct PosixZoneRule {
  std::chrono::seconds standard_offset;  // local minus UTC
  std::optional<DaylightTime> daylight;
};

/// Nothing when `text` is not a rule, or one that counts days of the year (Jn, n), which no zone of
/// the database uses.
[[nodiscard]] std::optional<PosixZoneRule> ParsePosixZoneRule(std::string_view text);

/// Local time minus UTC.
[[nodiscard]] std::chrono::seconds OffsetAt(const PosixZoneRule& rule,
                                            std::chrono::sys_seconds instant);

}  // namespace alpenglow::atmosphere

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
