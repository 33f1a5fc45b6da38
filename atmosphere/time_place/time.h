// SPDX-License-Identifier: MIT
// Instants: UTC on the proleptic Gregorian calendar, leap seconds included, and the time scales of
// astronomy (TT, UT1).
#pragma once

#include <alpenglow/place_time.h>

#include <optional>
#include <string>
#include <string_view>

namespace alpenglow::atmosphere {

/// Range of the years of instants: positions of sun and moon are known within stated errors.
inline constexpr int kFirstYear = 1900, kLastYear = 2100;

/// Returns the time of this machine's clock, to a millisecond.
[[nodiscard]] UtcTime Now();

/// Returns the mean solar midnight at a place, at or before an instant.
[[nodiscard]] UtcTime MeanSolarMidnight(const Place& place, const UtcTime& around);

/// Reads ISO 8601: "2026-06-21T04:00:00Z", "2026-06-21T13:00:00+09:00"; a space for the T, t and z
/// (RFC 3339), and fractions of a second after a point or a comma are allowed. Without Z or an
/// offset, `zone` (IANA name) is needed; a local time in a DST gap or overlap is rejected with a
/// message that requests the offset. If the text contains the offset, `zone` is not used. Years
/// kFirstYear to kLastYear. Throws InputError naming text and fault.
[[nodiscard]] UtcTime ParseInstant(std::string_view text,
                                   const std::optional<std::string>& zone = std::nullopt);

/// Returns "2026-06-21T04:00:00Z"; rounded to `decimals` digits of a second, 0 to 9.
[[nodiscard]] std::string FormatUtc(const UtcTime& instant, int decimals = 0);

/// Formats an instant like FormatUtc in a zone, with its offset: "2026-06-21T13:00:00+09:00".
/// Throws InputError if there is no such zone.
[[nodiscard]] std::string FormatInZone(const UtcTime& instant, const std::string& zone);

/// Returns the length of a day of UTC [s]: 86401 if it ends in a leap second, else 86400.
[[nodiscard]] double DayLength(int modified_julian_day);

/// Returns `instant` moved by seconds (any sign), counted without leap seconds as clocks do: a leap
/// second is the first second of the next day. For 0 the instant is unchanged.
[[nodiscard]] UtcTime AddSeconds(const UtcTime& instant, double seconds);

/// Returns the seconds from one instant to the other, counted without leap seconds.
[[nodiscard]] double SecondsBetween(const UtcTime& from, const UtcTime& to);

/// Reads "1h30m", "90s", "-20m", "2d" and returns seconds. Throws InputError.
[[nodiscard]] double ParseDuration(std::string_view text);

/// Returns TT - UT1 [s]. Within 1960-2026 it is computed from the leap seconds
/// (|UT1 - UTC| < 0.9 s neglected), outside from the polynomial model of Espenak and Meeus (2006),
/// joined continuously.
[[nodiscard]] double DeltaT(const UtcTime& instant);

}  // namespace alpenglow::atmosphere
