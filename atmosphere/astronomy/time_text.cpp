// SPDX-License-Identifier: MIT
#include "atmosphere/astronomy/time_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/sky_bodies.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/base/error.h"
#include "atmosphere/base/names.h"
#include "atmosphere/base/parsing.h"
#include "atmosphere/math/constants.h"

namespace alpenglow::atmosphere {
namespace {

constexpr std::size_t kDateLength = 10;  // "2026-06-21"

constexpr std::array<std::pair<std::string_view, int>, 3> kDayWords = {
    {{"yesterday", -1}, {"today", 0}, {"tomorrow", 1}}};

const std::vector<std::string> kEventNames = {"noon",
                                              "midnight",
                                              "sunrise",
                                              "sunset",
                                              "civil-dawn",
                                              "civil-dusk",
                                              "nautical-dawn",
                                              "nautical-dusk",
                                              "astronomical-dawn",
                                              "astronomical-dusk",
                                              "moonrise",
                                              "moonset",
                                              "moon-transit",
                                              "first-contact",
                                              "second-contact",
                                              "eclipse-maximum",
                                              "third-contact",
                                              "last-contact",
                                              "now"};

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

struct EventText {
  std::string_view name;    // "civil-dusk"
  std::string_view offset;  // "+20m", or empty
};

/// Splits at the last sign that a digit follows: names can contain signs, but no digits.
EventText SplitEvent(std::string_view text) {
  for (std::size_t i = text.size(); i-- > 0;) {
    const bool sign = text[i] == '+' || text[i] == '-';
    if (sign && i + 1 < text.size() && IsDigit(text[i + 1])) {
      return {text.substr(0, i), text.substr(i)};
    }
  }
  return {text, {}};
}

double OffsetOf(const EventText& parts) {
  return parts.offset.empty() ? 0.0 : ParseDuration(parts.offset);
}

bool IsNow(std::string_view text) { return SplitEvent(text).name == "now"; }

std::optional<int> DaysFromToday(std::string_view word) {
  for (const auto& [name, days] : kDayWords) {
    if (name == word) return days;
  }
  return std::nullopt;
}

/// Returns "18:30" for "1830", also with "Z" after it; no value for other texts.
std::optional<std::string> FourDigitClockTime(std::string_view text) {
  const std::string_view zulu = text.ends_with('Z') || text.ends_with('z') ? "Z" : "";
  text.remove_suffix(zulu.size());
  if (text.size() != 4 || !std::all_of(text.begin(), text.end(), IsDigit)) return std::nullopt;
  return fmt::format("{}:{}{}", text.substr(0, 2), text.substr(2), zulu);
}

/// Returns "18:00" for other notations: "6pm", "6:00 pm", "18h00", "18.00", "9:30"; no value for
/// other texts.
std::optional<std::string> ClockTimeMeant(std::string_view text) {
  const auto number = [&](std::size_t most) {
    int value = 0;
    std::size_t digits = 0;
    for (; digits < most && digits < text.size() && IsDigit(text[digits]); ++digits)
      value = 10 * value + (text[digits] - '0');
    text.remove_prefix(digits);
    return digits > 0 ? std::optional<int>(value) : std::nullopt;
  };
  std::optional<int> hour = number(2);
  const bool has_separator = !text.empty() && std::string_view(":.hH").find(text.front()) < 4;
  if (has_separator) text.remove_prefix(1);
  const int minute = has_separator ? number(2).value_or(0) : 0;
  text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  const std::string half = LowerCase(text);
  const bool is_afternoon = half == "pm" || half == "p.m.";
  const bool is_half = is_afternoon || half == "am" || half == "a.m.";
  if (!hour || (!is_half && !half.empty()) || (is_half && (*hour < 1 || *hour > 12)))
    return std::nullopt;
  if (is_half) hour = *hour % 12 + (is_afternoon ? 12 : 0);
  if (*hour > 23 || minute > 59) return std::nullopt;
  return fmt::format("{:02}:{:02}", *hour, minute);
}

/// Rejects a clock time in an unsupported notation, after a day or alone.
void RefuseOtherClockTimes(std::string_view text) {
  const bool after_day = text.size() > kDateLength + 1 && IsDayText(text.substr(0, kDateLength));
  const std::string_view clock = after_day ? text.substr(kDateLength + 1) : text;
  const std::optional<std::string> meant = ClockTimeMeant(clock);
  if (!meant || clock.starts_with(*meant)) return;
  throw InputError(
      fmt::format("time \"{}\": \"{}\" is no time; did you mean {}?", text, clock, *meant));
}

/// Rejects a text that begins with a year with a sign, "-0044-03-15", or of more than four digits:
/// astronomy knows such years, and this program has no positions for them.
void RefuseOtherYears(std::string_view text, std::string_view what) {
  std::string_view digits = text;
  const bool has_sign = digits.starts_with('-') || digits.starts_with('+');
  if (has_sign) digits.remove_prefix(1);
  const std::size_t year = std::min(digits.find_first_not_of("0123456789"), digits.size());
  const std::string_view rest = digits.substr(year);
  const bool is_date = rest.size() >= 6 && rest[0] == '-' && IsDigit(rest[1]) && IsDigit(rest[2]) &&
                       rest[3] == '-' && IsDigit(rest[4]) && IsDigit(rest[5]);
  if (!is_date || year == 0 || (!has_sign && year == 4)) return;
  throw InputError(fmt::format("{} \"{}\": the year must be four digits and lie in [{}, {}]", what,
                               text, kFirstYear, kLastYear));
}

[[noreturn]] void RefuseEvent(std::string_view name, std::string_view text) {
  if (name.empty() && !text.empty()) {
    throw InputError(fmt::format(
        "time \"{}\": an offset follows a time: now+2h, sunrise+20m, 18:30+02:00", text));
  }
  const std::optional<std::string> nearest = NearestName(name, kEventNames);
  throw InputError(fmt::format("time \"{}\": unknown event \"{}\"; {}", text, name,
                               nearest
                                   ? fmt::format("did you mean {}?", *nearest)
                                   : fmt::format("known are {}", fmt::join(kEventNames, ", "))));
}

const UtcTime& AroundOf(std::string_view text, const EventDay& day) {
  if (!day.around) throw InputError(fmt::format("time \"{}\": of which day? give a date", text));
  return *day.around;
}

/// Returns the position of the space before the time in "tomorrow 18:30" and "2026-06-21 sunrise";
/// no value if there is no day in front, or only the digits of an instant that ParseInstant reads.
std::optional<std::size_t> EndOfDay(std::string_view text) {
  const std::size_t space = text.find(' ');
  if (space == std::string_view::npos || space + 1 == text.size()) return std::nullopt;
  const bool is_instant =
      IsDigit(text[0]) && IsDigit(text[space + 1]) && !FourDigitClockTime(text.substr(space + 1));
  if (is_instant || !IsDayText(text.substr(0, space))) return std::nullopt;
  return space;
}

/// Returns the middle between two noons. The sun is lowest then, within the half minute by which
/// noons are unevenly spaced.
std::optional<UtcTime> FindMidnight(const Place& place, const UtcTime& around) {
  const auto noon = FindSunEvent(SunEvent::kNoon, place, around);
  const auto next = FindSunEvent(SunEvent::kNoon, place, AddSeconds(around, kSecondsPerDay));
  return AddSeconds(noon.value(), 0.5 * SecondsBetween(noon.value(), next.value()));
}

/// Returns the event that falls on the date of `around` by the clocks of the place. Each event
/// comes 50 minutes later from day to day, so once a month a date has none.
std::optional<UtcTime> FindMoonEvent(MoonEvent event, const UtcTime& around, const EventDay& day) {
  constexpr double kBefore_s = 14.0 * 3600.0;  // clock changes move the begin of a date by hours
  const std::string date = DateAt(around, day);
  UtcTime after = AddSeconds(DayFromText(date, day), -kBefore_s);
  while (true) {
    const std::optional<UtcTime> next = NextMoonEvent(event, day.place, after);
    if (!next || DateAt(*next, day) > date) return std::nullopt;
    if (DateAt(*next, day) == date) return next;
    after = AddSeconds(*next, 1.0);
  }
}

std::optional<UtcTime> FindEclipseEvent(EclipseEvent event, const UtcTime& around,
                                        const EventDay& day) {
  const UtcTime midnight = MeanSolarMidnight(day.place, around);
  const auto eclipse = FindSolarEclipse(day.place, midnight, kSecondsPerDay);
  return eclipse ? InstantOf(event, *eclipse) : std::nullopt;
}

/// Explains why the sun does not cross the height of an event on a day.
std::string WhyNot(SunEvent event, const EventDay& day) {
  const auto noon = FindSunEvent(SunEvent::kNoon, day.place, *day.around);
  const bool above = IsAboveEvent(event, day.place, noon.value());
  if (event == SunEvent::kSunrise || event == SunEvent::kSunset)
    return above ? " (polar day: the sun stays above the horizon)"
                 : " (polar night: the sun stays below the horizon)";
  return above ? " (the night is light: the sun does not sink so far below the horizon)"
               : " (polar night: the sun stays farther below the horizon)";
}

std::string NoSuchEvent(std::string_view text, const EventDay& day) {
  const EventText parts = SplitEvent(text);
  std::string fault = fmt::format(
      "time \"{}\": there is no {} on {} at latitude {:.4f}, longitude {:.4f}", text, parts.name,
      DateAt(*day.around, day), day.place.latitude_deg, day.place.longitude_deg);
  if (EclipseEventFromName(parts.name)) return fault + ": no such eclipse of the sun";
  if (const std::optional<SunEvent> sun = SunEventFromName(parts.name))
    return fault + WhyNot(*sun, day);
  const std::optional<MoonEvent> moon = MoonEventFromName(parts.name);
  if (const auto next = NextMoonEvent(moon.value(), day.place, *day.around)) {
    fault += fmt::format(" (the next is at {})", FormatUtc(*next));
  }
  return fault;
}

/// An instant at one end determines the day of the event at the other end.
EventDay DayOfFrom(const TimesText& times, const EventDay& day) {
  EventDay of_from = day;
  if (!day.around && !IsDailyEvent(*times.to) && !IsDayText(*times.to)) {
    of_from.around = InstantFromText(*times.to, day);
  }
  return of_from;
}

UtcTime EndOf(const TimesText& times, const EventDay& day, const UtcTime& from) {
  const UtcTime to = InstantFromText(*times.to, day);
  const bool comes_daily = IsDailyEvent(*times.to) || IsClockTime(*times.to);
  if (SecondsBetween(from, to) > 0.0 || !comes_daily) return to;
  EventDay next = day;
  // Step from noon, because a clock change can lie before the next noon.
  next.around = AddSeconds(DayFromText(DateAt(*day.around, day), day), kSecondsPerDay);
  return InstantFromText(*times.to, next);
}

/// The time between frames.
struct Step {
  std::string text;
  double seconds;
  bool is_whole_days;

  /// Throws InputError for a text that is no positive duration.
  explicit Step(const std::string& every)
      : text(every),
        seconds(ParseDuration(every)),
        is_whole_days(std::fmod(seconds, kSecondsPerDay) == 0.0) {
    if (!(seconds > 0.0))
      throw InputError(fmt::format("--every is {}; it must be longer than nothing", every));
  }

  /// Returns the seconds from the first frame to frame i.
  [[nodiscard]] double After(int i) const { return i * seconds; }
};

/// Returns the number of steps that fit into a span.
int StepsIn(double span_s, const Step& every) {
  constexpr double kRounding_s = 1e-6;  // rounding of the event search and of sums of durations
  const double steps = std::floor((span_s + kRounding_s) / every.seconds);
  if (steps >= kMostInstants) {
    throw InputError(fmt::format("--every {} gives {:.0f} frames; there may be {}", every.text,
                                 steps + 1.0, kMostInstants));
  }
  return static_cast<int>(steps);
}

std::vector<UtcTime> EverySeconds(const UtcTime& from, double span_s, const Step& every) {
  std::vector<UtcTime> instants;
  const int steps = StepsIn(span_s, every);
  for (int i = 0; i <= steps; ++i) instants.push_back(AddSeconds(from, every.After(i)));
  return instants;
}

/// Returns the instant of a clock time on a day in the zone. A clock time that is skipped or
/// repeated by a clock change uses the offset before the change.
UtcTime ClockTimeOn(const std::string& date_and_clock, const std::string& zone,
                    const UtcTime& before) {
  constexpr std::size_t kOffsetAt = 19;  // position of the offset in "2026-06-21T13:00:00+09:00"
  try {
    return ParseInstant(date_and_clock, zone);
  } catch (const InputError&) {
    return ParseInstant(date_and_clock + FormatInZone(before, zone).substr(kOffsetAt));
  }
}

/// Returns whether `every` counts whole calendar days of a zone, so that clocks show the same time
/// at every frame.
bool IsOfCalendarDays(const Step& every, const EventDay& day) {
  return day.zone && every.text.ends_with('d') && every.is_whole_days;
}

std::vector<UtcTime> EveryDays(const UtcTime& from, double span_s, const Step& every,
                               const EventDay& day) {
  constexpr double kRounding_s = 1e-6;
  const double fraction_s = from.second_of_day - std::floor(from.second_of_day);
  const UtcTime whole = AddSeconds(from, -fraction_s);
  const std::string clock = FormatInZone(whole, *day.zone).substr(10, 9);  // "T13:00:00"
  const UtcTime noon = DayFromText(DateAt(from, day), day);
  std::vector<UtcTime> instants{from};
  // A span of whole days is an hour longer or shorter if it contains a clock change.
  const int most = StepsIn(span_s + 0.5 * kSecondsPerDay, every);
  for (int i = 1; i <= most; ++i) {
    const std::string date = DateAt(AddSeconds(noon, every.After(i)), day);
    const UtcTime next =
        AddSeconds(ClockTimeOn(date + clock, *day.zone, instants.back()), fraction_s);
    if (SecondsBetween(from, next) > span_s + kRounding_s) break;
    instants.push_back(next);
  }
  return instants;
}

[[noreturn]] void RefuseDayBefore(const TimesText& times) {
  throw InputError(fmt::format("--to {} is before the day of --from", *times.to));
}

/// Returns the day that a time was written with; that of the place for "now".
std::string DayOf(std::string_view text, const UtcTime& instant, const EventDay& day) {
  const std::string_view begin = text.substr(0, kDateLength);
  if (IsDayText(begin)) return std::string(begin);
  const auto [time, written] = TimeOfDayFromText(text, day);
  return DateAt(IsClockTime(time) ? AroundOf(time, written) : instant, day);
}

/// Returns the seconds from the first frame to the middle between the frame on the day of `to`,
/// which clock changes move by hours, and the next one.
double SpanUpToDay(const TimesText& times, const UtcTime& from, const EventDay& day) {
  const UtcTime first = DayFromText(DayOf(*times.from, from, day), day);
  const double days =
      std::round(SecondsBetween(first, DayFromText(*times.to, day)) / kSecondsPerDay);
  if (days < 0.0) RefuseDayBefore(times);
  return (days + 0.5) * kSecondsPerDay;
}

/// Returns whether a text is an event, after a day or not.
bool IsEvent(const std::string& text) { return IsDailyEvent(TimeOfDayFromText(text, {}).text); }

/// Returns the event of `from` on its day and on the following days, up to the day of `to`.
std::vector<UtcTime> EventOfEachDay(const TimesText& times, const Step& every,
                                    const EventDay& day) {
  const auto [event, first] = TimeOfDayFromText(*times.from, DayOfFrom(times, day));
  if (!first.around) throw InputError("an event of each day needs a first day: give --date");
  const UtcTime last =
      IsDayText(*times.to) ? DayFromText(*times.to, day) : InstantFromText(*times.to, first);
  const auto midnight = [&](const UtcTime& of) { return MeanSolarMidnight(day.place, of); };
  const double span_s = SecondsBetween(midnight(*first.around), midnight(last));
  if (span_s < 0.0) RefuseDayBefore(times);
  std::vector<UtcTime> instants;
  const int steps = StepsIn(span_s, every);
  for (int i = 0; i <= steps; ++i) {
    EventDay of_frame = first;
    of_frame.around = AddSeconds(*first.around, every.After(i));
    if (const auto instant = FindDailyEvent(event, of_frame)) instants.push_back(*instant);
  }
  if (instants.empty()) {
    throw InputError(
        fmt::format("there is no {} on any of the days up to --to {}", event, *times.to));
  }
  return instants;
}

std::vector<UtcTime> CountBetween(const UtcTime& from, double span_s, int count) {
  if (count < 1 || count > kMostInstants) {
    throw InputError(fmt::format("--count is {}; it must lie in [1, {}]", count, kMostInstants));
  }
  std::vector<UtcTime> instants;
  for (int i = 0; i < count; ++i) {
    instants.push_back(AddSeconds(from, count == 1 ? 0.0 : span_s * i / (count - 1)));
  }
  return instants;
}

}  // namespace

std::string DateAt(const UtcTime& instant, const EventDay& day) {
  if (day.zone) return FormatInZone(instant, *day.zone).substr(0, kDateLength);
  const double turns = WrappedLongitude(day.place.longitude_deg) / 360.0;
  return FormatUtc(AddSeconds(instant, kSecondsPerDay * turns)).substr(0, kDateLength);
}

UtcTime DayFromText(std::string_view date, const EventDay& day) {
  RefuseOtherYears(date, "date");
  if (const std::optional<int> days = DaysFromToday(date)) {
    const UtcTime noon_today = DayFromText(DateAt(day.now, day), day);
    const UtcTime near_noon = AddSeconds(noon_today, *days * kSecondsPerDay);
    return DayFromText(DateAt(near_noon, day), day);  // the clocks can change in between
  }
  if (date.size() != kDateLength) {
    throw InputError(
        fmt::format("date is \"{}\"; write it as 2026-06-21, today, tomorrow or yesterday", date));
  }
  const std::string noon = fmt::format("{}T12:00:00", date);
  if (day.zone) return ParseInstant(noon, day.zone);
  const double turns = WrappedLongitude(day.place.longitude_deg) / 360.0;
  return AddSeconds(ParseInstant(noon + "Z"), -kSecondsPerDay * turns);
}

bool IsDayText(std::string_view text) {
  return DaysFromToday(text).has_value() ||
         (text.size() == kDateLength && IsDigit(text[0]) && text[4] == '-' && text[7] == '-');
}

TimeOfDay TimeOfDayFromText(std::string_view text, const EventDay& day) {
  TimeOfDay time{std::string(text), day};
  if (const std::optional<std::size_t> end = EndOfDay(text)) {
    time.text = text.substr(*end + 1);
    time.day.around = DayFromText(text.substr(0, *end), day);
  }
  return time;
}

bool IsClockTime(std::string_view text) {
  return (text.size() >= 5 && IsDigit(text[0]) && IsDigit(text[1]) && text[2] == ':') ||
         FourDigitClockTime(text).has_value();
}

bool IsDailyEvent(std::string_view text) {
  return !text.empty() && !IsDigit(text.front()) && !IsNow(text) && !IsDayText(text) &&
         !EndOfDay(text);
}

std::optional<UtcTime> FindDailyEvent(std::string_view text, const EventDay& day) {
  const EventText parts = SplitEvent(text);
  if (parts.name.empty()) RefuseEvent(parts.name, text);
  const double offset_s = OffsetOf(parts);
  std::optional<UtcTime> instant;
  if (parts.name == "midnight") {
    instant = FindMidnight(day.place, AroundOf(text, day));
  } else if (const std::optional<SunEvent> sun = SunEventFromName(parts.name)) {
    instant = FindSunEvent(*sun, day.place, AroundOf(text, day));
  } else if (const std::optional<MoonEvent> moon = MoonEventFromName(parts.name)) {
    instant = FindMoonEvent(*moon, AroundOf(text, day), day);
  } else if (const std::optional<EclipseEvent> eclipse = EclipseEventFromName(parts.name)) {
    instant = FindEclipseEvent(*eclipse, AroundOf(text, day), day);
  } else {
    RefuseEvent(parts.name, text);
  }
  if (instant) instant = AddSeconds(*instant, offset_s);
  return instant;
}

UtcTime InstantFromText(std::string_view text, const EventDay& day) {
  RefuseOtherYears(text, "time");
  if (IsNow(text)) return AddSeconds(day.now, OffsetOf(SplitEvent(text)));
  if (EndOfDay(text)) {
    const TimeOfDay time = TimeOfDayFromText(text, day);
    return InstantFromText(time.text, time.day);
  }
  if (DaysFromToday(text)) return InstantFromText(fmt::format("{} noon", text), day);
  if (IsDayText(text)) {
    throw InputError(fmt::format(
        "time \"{0}\": at what time of that day? write \"{0} 18:30\" or \"{0} sunrise\"", text));
  }
  if (const std::optional<std::string> clock = FourDigitClockTime(text))
    return InstantFromText(*clock, day);
  if (IsClockTime(text)) {
    return ParseInstant(fmt::format("{}T{}", DateAt(AroundOf(text, day), day), text), day.zone);
  }
  if (!IsDailyEvent(text)) {
    RefuseOtherClockTimes(text);
    return ParseInstant(text, day.zone);
  }
  const std::optional<UtcTime> instant = FindDailyEvent(text, day);
  if (!instant) throw InputError(NoSuchEvent(text, day));
  return *instant;
}

std::vector<UtcTime> InstantsFromTimes(const TimesText& times, const EventDay& day) {
  if (!times.at.empty()) {
    std::vector<UtcTime> instants;
    for (const std::string& text : times.at) instants.push_back(InstantFromText(text, day));
    return instants;
  }
  if (!times.from || !times.to) {
    throw InputError("no time is given: give --at, or --from and --to, or [time] in the scene");
  }
  const std::optional<Step> every = times.every ? std::optional<Step>(*times.every) : std::nullopt;
  if (every && every->is_whole_days && IsEvent(*times.from))
    return EventOfEachDay(times, *every, day);
  const EventDay day_of_from = DayOfFrom(times, day);
  const UtcTime from = InstantFromText(*times.from, day_of_from);
  EventDay day_of_to = day_of_from;
  if (!IsDailyEvent(*times.from)) day_of_to.around = from;
  const bool ends_with_a_day = every && every->is_whole_days && IsDayText(*times.to);
  const double span_s = ends_with_a_day ? SpanUpToDay(times, from, day_of_from)
                                        : SecondsBetween(from, EndOf(times, day_of_to, from));
  if (span_s < 0.0) {
    throw InputError(fmt::format("--to {} is before --from {}", *times.to, *times.from));
  }
  if (every && IsOfCalendarDays(*every, day)) return EveryDays(from, span_s, *every, day);
  if (every) return EverySeconds(from, span_s, *every);
  if (times.count) return CountBetween(from, span_s, *times.count);
  throw InputError("--from and --to need --every or --count");
}

}  // namespace alpenglow::atmosphere
