// SPDX-License-Identifier: MIT
// Which instants a series shows, from what people type: instants, sun events with an offset.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/sun/geodesy.h"
#include "atmosphere/sun/time.h"

namespace alpenglow {

/// One picture of a series. Numbers count from 0.
struct Frame {
  int number;
  UtcInstant instant;
  double path_s = 0.0;  // where on the path of the camera, if there is one
};

/// Where, and on which day, "sunrise" happens.
struct EventDay {
  GeodeticPosition place;
  std::optional<std::string> zone;   // of local times, IANA
  std::optional<UtcInstant> around;  // any instant of the day; needed by events
};

/// The times of a series as typed. Either `at`, or `from` and `to` with `every` or `count`.
struct TimesText {
  std::vector<std::string> at;
  std::optional<std::string> from, to;
  std::optional<std::string> every;  // duration: frames from `from` on, while not after `to`
  std::optional<int> count;          // frames from `from` to `to`, both included
};

/// Frames in a series, at most.
inline constexpr int kMostFrames = 1000000;

/// The day "2026-06-21" at a place: its noon in the zone, or in mean solar time without a zone.
/// Throws InputError for what is no date.
[[nodiscard]] UtcInstant DayFromText(std::string_view date, const GeodeticPosition& place,
                                     const std::optional<std::string>& zone);

/// An instant ("2026-06-21T04:00:00Z", without Z or offset in the day's zone) or a sun event of the
/// day with an offset ("sunrise-1h", "sunset+20m", "noon", "civil-dusk"). Throws InputError for
/// other texts (naming the nearest event), for an event without a day, and for an event that does
/// not happen that day (polar day and night).
[[nodiscard]] UtcInstant InstantFromText(std::string_view text, const EventDay& day);

/// The frames. A `to` that is an event and not after `from` is taken on the following day, so that
/// "sunset" to "sunrise" is a night; an instant at one end says of which day the event at the other
/// end is. Throws InputError for what InstantFromText refuses, a `to`
/// before `from`, an `every` that is not positive, a `count` below 1, too many frames.
[[nodiscard]] std::vector<Frame> FramesFromTimes(const TimesText& times, const EventDay& day);

/// The frames whose numbers are in "A-B,C"; throws InputError for numbers that the series does not
/// have and for other texts.
[[nodiscard]] std::vector<Frame> SelectFrames(const std::vector<Frame>& frames,
                                              std::string_view ranges);

}  // namespace alpenglow
