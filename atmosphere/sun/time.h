// SPDX-License-Identifier: MIT
// Instants: UTC on the proleptic Gregorian calendar, leap seconds included, and the scales that
// astronomy wants (TT, UT1).
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace alpenglow::atmosphere {

/// An instant of UTC as a day and the second in it.
/// Second 86400.x exists on days with a leap second.
struct UtcInstant {
  int modified_julian_day = 60000;  // day number, 0 on 1858-11-17
  double second_of_day = 0.0;       // [0, 86400), [0, 86401) on a day that ends in a leap second

  bool operator==(const UtcInstant&) const = default;
};

/// What the clock of this machine shows, to a millisecond.
[[nodiscard]] UtcInstant Now();

/// Mean solar midnight at a longitude [rad], in (-pi, pi], at or before an instant.
[[nodiscard]] UtcInstant MeanSolarMidnight(double longitude_rad, const UtcInstant& around);

/// Reads ISO 8601: "2026-06-21T04:00:00Z", "2026-06-21T13:00:00+09:00", a space for the T and
/// fractions of a second allowed. Without Z or an offset `zone` (IANA name) is needed; a local time in a DST gap or
/// overlap is refused and the message asks for the offset. Where the text says the offset, `zone`
/// is not asked. Years 1900 to 2100. Throws InputError naming text and fault.
[[nodiscard]] UtcInstant ParseInstant(std::string_view text,
                                      const std::optional<std::string>& zone = std::nullopt);

/// "2026-06-21T04:00:00Z"; rounded to `decimals` digits of a second, 0 to 9.
[[nodiscard]] std::string FormatUtc(const UtcInstant& instant, int decimals = 0);

/// As FormatUtc in a zone, with its offset: "2026-06-21T13:00:00+09:00". Throws InputError when
/// there is no such zone.
[[nodiscard]] std::string FormatInZone(const UtcInstant& instant, const std::string& zone);

/// Length of a day of UTC [s]: 86401 when it ends in a leap second, else 86400.
[[nodiscard]] double DayLength(int modified_julian_day);

/// `instant` moved by seconds (any sign), counted without leap seconds as clocks do: a leap second
/// is the first second of the next day. 0 moves nothing.
[[nodiscard]] UtcInstant AddSeconds(const UtcInstant& instant, double seconds);

/// Seconds from one to the other, counted without leap seconds.
[[nodiscard]] double SecondsBetween(const UtcInstant& from, const UtcInstant& to);

/// "1h30m", "90s", "-20m", "2d": seconds. Throws InputError.
[[nodiscard]] double ParseDuration(std::string_view text);

/// TT - UT1 [s]. Inside 1960-2026 from the leap seconds (|UT1 - UTC| < 0.9 s neglected), outside
/// from the polynomial model of Espenak and Meeus (2006), joined continuously.
[[nodiscard]] double DeltaT(const UtcInstant& instant);

}  // namespace alpenglow::atmosphere
