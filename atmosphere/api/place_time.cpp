// SPDX-License-Identifier: MIT
#include <alpenglow/place_time.h>

#include <alpenglow/errors.h>
#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "atmosphere/api/conversions.h"
#include "atmosphere/base/error.h"
#include "atmosphere/time_place/time.h"

namespace alpenglow {
namespace {

std::chrono::days DaysSince1970(const UtcTime& time) {
  return std::chrono::days(time.modified_julian_day) -
         std::chrono::days(UtcTime().modified_julian_day);
}

}  // namespace

UtcTime::operator std::chrono::sys_time<std::chrono::microseconds>() const {
  return std::chrono::sys_days(DaysSince1970(*this)) +
         std::chrono::microseconds(std::llround(1e6 * second_of_day));
}

UtcTime& UtcTime::operator+=(std::chrono::duration<double> step) { return *this = *this + step; }

UtcTime& UtcTime::operator-=(std::chrono::duration<double> step) { return *this = *this - step; }

UtcTime operator+(const UtcTime& time, std::chrono::duration<double> step) {
  return atmosphere::AddSeconds(time, step.count());
}

UtcTime operator-(const UtcTime& time, std::chrono::duration<double> step) { return time + -step; }

std::chrono::duration<double> operator-(const UtcTime& to, const UtcTime& from) {
  return std::chrono::duration<double>(atmosphere::SecondsBetween(from, to));
}

const UtcTime& RequireValid(const UtcTime& time) {
  constexpr UtcTime kFirst =
      std::chrono::sys_days(std::chrono::year(atmosphere::kFirstYear) / 1 / 1);
  constexpr UtcTime kLast =
      std::chrono::sys_days(std::chrono::year(atmosphere::kLastYear) / 12 / 31);
  if (time.modified_julian_day < kFirst.modified_julian_day ||
      time.modified_julian_day > kLast.modified_julian_day) {
    throw InputError(
        fmt::format("time lies {} days after 1970-01-01; its year must lie in [{}, {}]",
                    DaysSince1970(time).count(), atmosphere::kFirstYear, atmosphere::kLastYear));
  }
  // The length of a day takes longer to find, and few instants lie in a leap second.
  if (time.second_of_day >= 0.0 && time.second_of_day < 86400.0) return time;
  const double length_s = atmosphere::DayLength(time.modified_julian_day);
  if (!(time.second_of_day >= 0.0 && time.second_of_day < length_s)) {
    throw InputError(
        fmt::format("second_of_day is {}; it must lie in [0, {})", time.second_of_day, length_s));
  }
  return time;
}

UtcTime TimeFromText(std::string_view text, const std::string& zone) {
  return atmosphere::ParseInstant(text, zone.empty() ? std::nullopt : std::optional(zone));
}

std::string TextFromTime(const UtcTime& time) { return atmosphere::FormatUtc(RequireValid(time)); }

}  // namespace alpenglow
