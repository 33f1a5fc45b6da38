// SPDX-License-Identifier: MIT
// Which instants a series shows, from what people type (time_text.h).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/sun/time.h"
#include "renderer/series/time_text.h"

namespace alpenglow::renderer {

/// One picture of a series. Numbers count from 0.
struct Frame {
  int number;
  UtcInstant instant;
  double path_s = 0.0;  // where on the path of the camera, if there is one
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

/// The frames. A `to` that is an event or a clock time and not after `from` is taken on the
/// following day, so that "sunset" to "sunrise" and "22:00" to "02:00" are nights; a day of an
/// `every` such as "1d" is one of the calendar, after which clocks of the zone show the same ("24h"
/// is 24 hours; clocks that skip the time or show it twice go on with the offset before); an
/// instant at one end says of which day the event at the other end is. Where `from` is an event and
/// `every` whole days, each frame is the event of its own day, from that of `from` to that of `to`,
/// which may be a day without a time; days without the event have no frame. Throws InputError for
/// what InstantFromText refuses, a `to` before `from`, an `every` that is not positive, a `count`
/// below 1, too many frames, no frame.
[[nodiscard]] std::vector<Frame> FramesFromTimes(const TimesText& times, const EventDay& day);

/// The frames whose numbers are in "A-B,C"; throws InputError for numbers that the series does not
/// have and for other texts.
[[nodiscard]] std::vector<Frame> SelectFrames(const std::vector<Frame>& frames,
                                              std::string_view ranges);

}  // namespace alpenglow::renderer
