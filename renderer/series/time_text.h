// SPDX-License-Identifier: MIT
// Times as people type them: instants, clock times of a day, events of sun and moon with an offset.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "atmosphere/sun/geodesy.h"
#include "atmosphere/sun/time.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Where, and on which day, "sunrise" and "18:30" are.
struct EventDay {
  GeodeticPosition place;
  std::optional<std::string> zone;   // of local times, IANA
  std::optional<UtcInstant> around;  // any instant of the day; needed by events and clock times
  UtcInstant now = Now();            // of "now", "today", "tomorrow", "yesterday"
};

/// The day that an instant belongs to at a place, "2026-06-21": in the zone, or in mean solar time
/// without a zone.
[[nodiscard]] std::string DateAt(const UtcInstant& instant, const EventDay& day);

/// The noon in the zone of `day`, or in mean solar time without a zone, of "2026-06-21", "today",
/// "tomorrow" or "yesterday". Throws InputError for what is no date.
[[nodiscard]] UtcInstant DayFromText(std::string_view date, const EventDay& day);

/// Whether a text is read by DayFromText: a day without a time.
[[nodiscard]] bool IsDayText(std::string_view text);

/// A time, and the day that it was written with, if it was: of "2026-06-21 sunrise" the day and
/// "sunrise".
struct TimeOfDay {
  std::string text;
  EventDay day;
};
[[nodiscard]] TimeOfDay TimeOfDayFromText(std::string_view text, const EventDay& day);

/// It is true for a clock time without a day: "18:30", "1830".
[[nodiscard]] bool IsClockTime(std::string_view text);

/// Whether every day has its own instant of a text ("sunrise-1h", not "now+1h", "18:30" or
/// "2026-06-21 sunrise").
[[nodiscard]] bool IsDailyEvent(std::string_view text);

/// The instant of a daily event on the day: of the sun on the day of mean solar time (FindSunEvent),
/// of the moon on the date that DateAt has, of an eclipse of the sun (EclipseEvent) whose maximum falls
/// on the day of mean solar time, seen or not. Nothing when it does not happen that day (polar day and
/// night; each event of the moon once a month). Throws InputError for an unknown event, naming the
/// nearest, and for an event without a day.
[[nodiscard]] std::optional<UtcInstant> FindDailyEvent(std::string_view text, const EventDay& day);

/// Reads a time:
/// - an instant, "2026-06-21T04:00:00Z" (ParseInstant), in the day's zone without Z or offset;
/// - an event of the sun, the moon or an eclipse with an offset, "sunrise-1h", "noon", "civil-dusk",
///   "midnight" (half way from the day's noon to the next), "moonrise", "second-contact-10s";
/// - a clock time, "18:30", "18:30:15", "18:30Z", "1830", of the day;
/// - both after a day of their own: "2026-06-21 sunrise", "tomorrow 18:30", "today moonset";
/// - "today", "tomorrow", "yesterday": the noon of that day;
/// - "now", "now+2h".
/// Throws InputError for other texts, and for an event that does not happen that day.
[[nodiscard]] UtcInstant InstantFromText(std::string_view text, const EventDay& day);

}  // namespace alpenglow::renderer
