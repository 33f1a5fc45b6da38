// SPDX-License-Identifier: MIT
#include "renderer/series/frame_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "atmosphere/number/constants.h"
#include "atmosphere/sun/sun.h"
#include "atmosphere/text/error.h"
#include "atmosphere/text/toml_table.h"

namespace alpenglow {
namespace {

constexpr double kSecondsPerDay = 86400.0;

const std::vector<std::string> kEventNames = {
    "noon",          "sunrise",           "sunset",
    "civil-dawn",    "civil-dusk",        "nautical-dawn",
    "nautical-dusk", "astronomical-dawn", "astronomical-dusk"};

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

struct EventText {
  std::string_view name;    // "civil-dusk"
  std::string_view offset;  // "+20m", or nothing
};

/// Cut at the last sign that a digit follows: names have signs too, but no digits.
EventText SplitEvent(std::string_view text) {
  for (std::size_t i = text.size(); i-- > 0;) {
    const bool sign = text[i] == '+' || text[i] == '-';
    if (sign && i + 1 < text.size() && IsDigit(text[i + 1])) {
      return {text.substr(0, i), text.substr(i)};
    }
  }
  return {text, {}};
}

bool IsEventText(std::string_view text) { return !text.empty() && !IsDigit(text.front()); }

SunEvent EventFromText(std::string_view name, std::string_view text) {
  if (const std::optional<SunEvent> event = SunEventFromName(name)) return *event;
  const std::optional<std::string> nearest = NearestName(name, kEventNames);
  throw InputError(fmt::format("time \"{}\": unknown event \"{}\"; {}", text, name,
                               nearest
                                   ? fmt::format("did you mean {}?", *nearest)
                                   : fmt::format("known are {}", fmt::join(kEventNames, ", "))));
}

UtcInstant EventInstant(std::string_view text, const EventDay& day) {
  const EventText parts = SplitEvent(text);
  const SunEvent event = EventFromText(parts.name, text);
  const double offset_s = parts.offset.empty() ? 0.0 : ParseDuration(parts.offset);
  if (!day.around) {
    throw InputError(fmt::format("time \"{}\": of which day? give a date", text));
  }
  const std::optional<UtcInstant> instant = FindSunEvent(event, day.place, *day.around);
  if (!instant) {
    throw InputError(fmt::format(
        "time \"{}\": there is no {} on {} at latitude {:.4f}, longitude "
        "{:.4f} (polar day or night)",
        text, parts.name, FormatUtc(*day.around).substr(0, 10),
        day.place.latitude_rad / kRadiansPerDegree, day.place.longitude_rad / kRadiansPerDegree));
  }
  return AddSeconds(*instant, offset_s);
}

UtcInstant EndOf(const TimesText& times, const EventDay& day, const UtcInstant& from) {
  const UtcInstant to = InstantFromText(*times.to, day);
  if (SecondsBetween(from, to) > 0.0 || !IsEventText(*times.to)) return to;
  EventDay next = day;
  next.around = AddSeconds(*day.around, kSecondsPerDay);
  return InstantFromText(*times.to, next);
}

std::vector<Frame> Numbered(const std::vector<UtcInstant>& instants) {
  std::vector<Frame> frames;
  for (const UtcInstant& instant : instants) {
    frames.push_back({static_cast<int>(frames.size()), instant});
  }
  return frames;
}

std::vector<UtcInstant> EverySeconds(const UtcInstant& from, double span_s,
                                     const std::string& every) {
  const double step_s = ParseDuration(every);
  if (!(step_s > 0.0)) {
    throw InputError(fmt::format("--every is {}; it must be longer than nothing", every));
  }
  constexpr double kRounding_s = 1e-6;  // of the event search and of sums of durations
  const double steps = std::floor((span_s + kRounding_s) / step_s);
  if (steps >= kMostFrames) {
    throw InputError(fmt::format("--every {} gives {:.0f} frames; there may be {}", every,
                                 steps + 1.0, kMostFrames));
  }
  std::vector<UtcInstant> instants;
  for (int i = 0; i <= static_cast<int>(steps); ++i) {
    instants.push_back(AddSeconds(from, i * step_s));
  }
  return instants;
}

std::vector<UtcInstant> CountBetween(const UtcInstant& from, double span_s, int count) {
  if (count < 1 || count > kMostFrames) {
    throw InputError(fmt::format("--count is {}; it must lie in [1, {}]", count, kMostFrames));
  }
  std::vector<UtcInstant> instants;
  for (int i = 0; i < count; ++i) {
    instants.push_back(AddSeconds(from, count == 1 ? 0.0 : span_s * i / (count - 1)));
  }
  return instants;
}

struct Range {
  int first, last;
};

int NumberIn(std::string_view text, std::string_view ranges) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number < 0) {
    throw InputError(fmt::format("frames \"{}\": \"{}\" is no frame; write A-B,C", ranges, text));
  }
  return number;
}

std::vector<Range> RangesFromText(std::string_view ranges) {
  std::vector<Range> found;
  for (std::size_t begin = 0; begin <= ranges.size();) {
    const std::size_t end = std::min(ranges.find(',', begin), ranges.size());
    const std::string_view part = ranges.substr(begin, end - begin);
    const std::size_t dash = part.find('-');
    const int first = NumberIn(part.substr(0, dash), ranges);
    const int last =
        dash == std::string_view::npos ? first : NumberIn(part.substr(dash + 1), ranges);
    if (last < first) {
      throw InputError(fmt::format("frames \"{}\": {} ends before it begins", ranges, part));
    }
    found.push_back({first, last});
    begin = end + 1;
  }
  return found;
}

}  // namespace

UtcInstant DayFromText(std::string_view date, const GeodeticPosition& place,
                       const std::optional<std::string>& zone) {
  if (date.size() != 10) {
    throw InputError(fmt::format("date is \"{}\"; write it as 2026-06-21", date));
  }
  const std::string noon = fmt::format("{}T12:00:00", date);
  if (zone) return ParseInstant(noon, zone);
  const double longitude_turns = std::remainder(place.longitude_rad, 2.0 * kPi) / (2.0 * kPi);
  return AddSeconds(ParseInstant(noon + "Z"), -kSecondsPerDay * longitude_turns);
}

UtcInstant InstantFromText(std::string_view text, const EventDay& day) {
  return IsEventText(text) ? EventInstant(text, day) : ParseInstant(text, day.zone);
}

std::vector<Frame> FramesFromTimes(const TimesText& times, const EventDay& day) {
  if (!times.at.empty()) {
    std::vector<UtcInstant> instants;
    for (const std::string& text : times.at) instants.push_back(InstantFromText(text, day));
    return Numbered(instants);
  }
  if (!times.from || !times.to) {
    throw InputError("no time is given: give --at, or --from and --to, or [time] in the scene");
  }
  // An instant at one end says of which day the event at the other end is.
  EventDay day_of_from = day;
  if (!day.around && !IsEventText(*times.to))
    day_of_from.around = ParseInstant(*times.to, day.zone);
  const UtcInstant from = InstantFromText(*times.from, day_of_from);
  EventDay day_of_to = day_of_from;
  if (!IsEventText(*times.from)) day_of_to.around = from;
  const double span_s = SecondsBetween(from, EndOf(times, day_of_to, from));
  if (span_s < 0.0) {
    throw InputError(fmt::format("--to {} is before --from {}", *times.to, *times.from));
  }
  if (times.every) return Numbered(EverySeconds(from, span_s, *times.every));
  if (times.count) return Numbered(CountBetween(from, span_s, *times.count));
  throw InputError("--from and --to need --every or --count");
}

std::vector<Frame> SelectFrames(const std::vector<Frame>& frames, std::string_view ranges) {
  std::vector<Frame> selected;
  const std::vector<Range> wanted = RangesFromText(ranges);
  ALPENGLOW_ENSURE(frames.size(), >, 0U);
  for (const Range& range : wanted) {
    if (range.last > frames.back().number) {
      throw InputError(
          fmt::format("frames \"{}\": the series has 0 to {}", ranges, frames.back().number));
    }
  }
  for (const Frame& frame : frames) {
    const auto holds = [&](const Range& range) {
      return range.first <= frame.number && frame.number <= range.last;
    };
    if (std::any_of(wanted.begin(), wanted.end(), holds)) selected.push_back(frame);
  }
  return selected;
}

}  // namespace alpenglow
