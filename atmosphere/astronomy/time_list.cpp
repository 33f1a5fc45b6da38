// SPDX-License-Identifier: MIT
#include "atmosphere/astronomy/time_list.h"

#include <fmt/format.h>

#include <cmath>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"

namespace alpenglow::atmosphere {
namespace {

/// An instant at one end determines the day of the event at the other end.
EventDay DayOfFrom(const TimesText& times, const EventDay& day) {
  EventDay of_from = day;
  if (!day.around && !IsDailyEvent(*times.to) && !IsDayText(*times.to)) {
    of_from.around = InstantFromText(*times.to, day);
  }
  return of_from;
}

UtcInstant EndOf(const TimesText& times, const EventDay& day, const UtcInstant& from) {
  const UtcInstant to = InstantFromText(*times.to, day);
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

std::vector<UtcInstant> EverySeconds(const UtcInstant& from, double span_s, const Step& every) {
  std::vector<UtcInstant> instants;
  const int steps = StepsIn(span_s, every);
  for (int i = 0; i <= steps; ++i) instants.push_back(AddSeconds(from, every.After(i)));
  return instants;
}

/// Returns the instant of a clock time on a day in the zone. A clock time that is skipped or
/// repeated by a clock change uses the offset before the change.
UtcInstant ClockTimeOn(const std::string& date_and_clock, const std::string& zone,
                       const UtcInstant& before) {
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

std::vector<UtcInstant> EveryDays(const UtcInstant& from, double span_s, const Step& every,
                                  const EventDay& day) {
  constexpr double kRounding_s = 1e-6;
  const double fraction_s = from.second_of_day - std::floor(from.second_of_day);
  const UtcInstant whole = AddSeconds(from, -fraction_s);
  const std::string clock = FormatInZone(whole, *day.zone).substr(10, 9);  // "T13:00:00"
  const UtcInstant noon = DayFromText(DateAt(from, day), day);
  std::vector<UtcInstant> instants{from};
  // A span of whole days is an hour longer or shorter if it contains a clock change.
  const int most = StepsIn(span_s + 0.5 * kSecondsPerDay, every);
  for (int i = 1; i <= most; ++i) {
    const std::string date = DateAt(AddSeconds(noon, every.After(i)), day);
    const UtcInstant next =
        AddSeconds(ClockTimeOn(date + clock, *day.zone, instants.back()), fraction_s);
    if (SecondsBetween(from, next) > span_s + kRounding_s) break;
    instants.push_back(next);
  }
  return instants;
}

/// Returns whether a text is an event, after a day or not.
bool IsEvent(const std::string& text) { return IsDailyEvent(TimeOfDayFromText(text, {}).text); }

/// Returns the event of `from` on its day and on the following days, up to the day of `to`.
std::vector<UtcInstant> EventOfEachDay(const TimesText& times, const Step& every,
                                       const EventDay& day) {
  const auto [event, first] = TimeOfDayFromText(*times.from, DayOfFrom(times, day));
  if (!first.around) throw InputError("an event of each day needs a first day: give --date");
  const UtcInstant last =
      IsDayText(*times.to) ? DayFromText(*times.to, day) : InstantFromText(*times.to, first);
  const auto midnight = [&](const UtcInstant& of) {
    return MeanSolarMidnight(WrappedLongitude(day.place.longitude_rad), of);
  };
  const double span_s = SecondsBetween(midnight(*first.around), midnight(last));
  if (span_s < 0.0) {
    throw InputError(fmt::format("--to {} is before the day of --from", *times.to));
  }
  std::vector<UtcInstant> instants;
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

std::vector<UtcInstant> CountBetween(const UtcInstant& from, double span_s, int count) {
  if (count < 1 || count > kMostInstants) {
    throw InputError(fmt::format("--count is {}; it must lie in [1, {}]", count, kMostInstants));
  }
  std::vector<UtcInstant> instants;
  for (int i = 0; i < count; ++i) {
    instants.push_back(AddSeconds(from, count == 1 ? 0.0 : span_s * i / (count - 1)));
  }
  return instants;
}

}  // namespace

std::vector<UtcInstant> InstantsFromTimes(const TimesText& times, const EventDay& day) {
  if (!times.at.empty()) {
    std::vector<UtcInstant> instants;
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
  const UtcInstant from = InstantFromText(*times.from, day_of_from);
  EventDay day_of_to = day_of_from;
  if (!IsDailyEvent(*times.from)) day_of_to.around = from;
  const double span_s = SecondsBetween(from, EndOf(times, day_of_to, from));
  if (span_s < 0.0) {
    throw InputError(fmt::format("--to {} is before --from {}", *times.to, *times.from));
  }
  if (every && IsOfCalendarDays(*every, day)) return EveryDays(from, span_s, *every, day);
  if (every) return EverySeconds(from, span_s, *every);
  if (times.count) return CountBetween(from, span_s, *times.count);
  throw InputError("--from and --to need --every or --count");
}

}  // namespace alpenglow::atmosphere
