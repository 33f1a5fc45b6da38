// SPDX-License-Identifier: MIT
// Parses times: instants, clock times of a day, events of sun and moon with an offset; and lists of
// instants: single times, or an interval with a step or a number.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/time_place/geodesy.h"
#include "atmosphere/time_place/time.h"

namespace alpenglow::atmosphere {

/// Place and day of "sunrise" and "18:30".
struct EventDay {
  Place place;
  std::optional<std::string> zone;  // zone of local times, IANA
  std::optional<UtcTime> around;    // any instant of the day; required by events and clock times
  UtcTime now = Now();              // reference of "now", "today", "tomorrow", "yesterday"
};

/// Returns the day of an instant at a place, "2026-06-21": in the zone, or in mean solar time
/// without a zone.
[[nodiscard]] std::string DateAt(const UtcTime& instant, const EventDay& day);

/// Returns the noon, in the zone of `day` or in mean solar time without a zone, of "2026-06-21",
/// "today", "tomorrow" or "yesterday". Throws InputError for text that is not a date.
[[nodiscard]] UtcTime DayFromText(std::string_view date, const EventDay& day);

/// Returns whether DayFromText accepts a text: a day without a time.
[[nodiscard]] bool IsDayText(std::string_view text);

/// A time and the day that was written with it, if there was one: "2026-06-21 sunrise" gives the
/// day and "sunrise".
struct TimeOfDay {
  std::string text;
  EventDay day;
};
[[nodiscard]] TimeOfDay TimeOfDayFromText(std::string_view text, const EventDay& day);

/// Returns whether a text is a clock time without a day: "18:30", "1830".
[[nodiscard]] bool IsClockTime(std::string_view text);

/// Returns whether a text denotes a different instant on every day ("sunrise-1h", not "now+1h",
/// "18:30" or "2026-06-21 sunrise").
[[nodiscard]] bool IsDailyEvent(std::string_view text);

/// Returns the instant of a daily event on the day: an event of the sun on the day of mean solar
/// time (FindSunEvent), of the moon on the date of DateAt, of an eclipse of the sun (EclipseEvent)
/// whose maximum falls on the day of mean solar time, visible or not. No value if it does not
/// happen that day (polar day and night; each event of the moon once a month). Throws InputError
/// for an unknown event, naming the nearest, and for an event without a day.
[[nodiscard]] std::optional<UtcTime> FindDailyEvent(std::string_view text, const EventDay& day);

/// Reads a time:
/// - an instant, "2026-06-21T04:00:00Z" (ParseInstant), in the day's zone without Z or offset;
/// - an event of the sun, the moon or an eclipse with an offset, "sunrise-1h", "noon",
///   "civil-dusk", "midnight" (half way from the day's noon to the next), "moonrise",
/// "second-contact-10s";
/// - a clock time, "18:30", "18:30:15", "18:30Z", "1830", of the day;
/// - an event or a clock time after a day: "2026-06-21 sunrise", "tomorrow 18:30", "today moonset";
/// - "today", "tomorrow", "yesterday": the noon of that day;
/// - "now", "now+2h".
/// Throws InputError for other texts, and for an event that does not happen that day.
[[nodiscard]] UtcTime InstantFromText(std::string_view text, const EventDay& day);

/// The times of a series of frames as given on the command line: either `at`, or `from` and `to`
/// with `every` or `count`.
struct TimesText {
  std::vector<std::string> at;
  std::optional<std::string> from, to;
  std::optional<std::string> every;  // duration: frames from `from` on, up to `to`
  std::optional<int> count;          // frames from `from` to `to`, both included
};

/// Largest number of instants in a list.
inline constexpr int kMostInstants = 1000000;

/// Returns the instants. A `to` that is an event or a clock time and not after `from` is moved to
/// the following day, so that "sunset" to "sunrise" and "22:00" to "02:00" are nights. A day in
/// `every`, such as "1d", is a calendar day, after which clocks of the zone show the same time;
/// "24h" is 24 hours. A clock time that is skipped or repeated by a clock change uses the offset
/// before the change. An instant at one end determines the day of the event at the other end. If
/// `every` is whole days, `to` may be a day without a time: the last day with an instant. If `from`
/// is then an event, each instant is the event of its own day, from the day of `from` to that of
/// `to`; days without the event have no instant. Throws InputError for errors of InstantFromText, a
/// `to` before `from`, an `every` that is not positive, a `count` below 1, too many instants, no
/// instant.
[[nodiscard]] std::vector<UtcTime> InstantsFromTimes(const TimesText& times, const EventDay& day);

}  // namespace alpenglow::atmosphere
