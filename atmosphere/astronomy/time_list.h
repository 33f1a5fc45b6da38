// SPDX-License-Identifier: MIT
// Lists of instants from texts (time_text.h): single times, or an interval with a step or a number.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "atmosphere/astronomy/time_text.h"

namespace alpenglow::atmosphere {

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
/// `from` is an event and `every` is whole days, each instant is the event of its own day, from the
/// day of `from` to that of `to`, which may be a day without a time; days without the event have no
/// instant. Throws InputError for errors of InstantFromText, a `to` before `from`, an `every` that
/// is not positive, a `count` below 1, too many instants, no instant.
[[nodiscard]] std::vector<UtcInstant> InstantsFromTimes(const TimesText& times,
                                                        const EventDay& day);

}  // namespace alpenglow::atmosphere
