// SPDX-License-Identifier: MIT
/// @file
/// Places on the earth and instants of UTC.
#pragma once

#include <algorithm>
#include <chrono>
#include <compare>
#include <cstdint>
#include <numbers>
#include <string>
#include <string_view>

#include <alpenglow/export.h>

namespace ALPENGLOW_EXPORT alpenglow {

/// A place in geodetic coordinates (WGS84).
struct Place {
  double latitude_deg = 0.0;   ///< in [-90, 90], north is positive
  double longitude_deg = 0.0;  ///< in [-180, 360], east is positive
  double height_m = 0.0;       ///< above the ellipsoid, at least -12000

  /// Returns the latitude [rad].
  [[nodiscard]] constexpr double latitude_rad() const { return latitude_deg * kRadiansPerDegree; }
  /// Returns the longitude [rad].
  [[nodiscard]] constexpr double longitude_rad() const { return longitude_deg * kRadiansPerDegree; }

  /// Returns whether all coordinates are equal.
  [[nodiscard]] bool operator==(const Place&) const = default;

 private:
  static constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;
};

/// An instant of UTC, as a day and the second in it. Its default is the beginning of 1970.
///
/// The system clock of C++ (std::chrono::sys_time) has no leap seconds: there, a leap second is the
/// first second of the next day. Arithmetic counts as that clock does.
struct UtcTime {
  int modified_julian_day = 40587;  ///< number of the day; 0 is 1858-11-17, 40587 is 1970-01-01
  double second_of_day = 0.0;  ///< in [0, 86400), or [0, 86401) if the day ends in a leap second

  constexpr UtcTime() = default;
  /// Makes an instant from its members.
  constexpr UtcTime(int day, double second) : modified_julian_day(day), second_of_day(second) {}
  /// Makes an instant from a time of the system clock.
  template <typename Duration>
  constexpr UtcTime(std::chrono::sys_time<Duration> time)  // NOLINT: as durations convert
      : UtcTime(time.time_since_epoch()) {}
  /// Makes an instant from the time since the beginning of 1970, counted without leap seconds.
  template <typename Number, typename Period>
  constexpr explicit UtcTime(std::chrono::duration<Number, Period> since_1970) {
    // The days are counted towards 0 first, because the day before the earliest time of a clock may
    // be none of its times. All functions refuse days beyond the limit.
    constexpr std::int64_t kFarthest_days = 1'000'000'000;
    const auto whole = std::chrono::duration_cast<std::chrono::days>(since_1970);
    const bool is_before = since_1970 < whole;
    auto rest = since_1970 - whole;
    if (is_before) rest += std::chrono::days(1);
    modified_julian_day +=
        static_cast<int>(std::clamp<std::int64_t>(whole.count(), -kFarthest_days, kFarthest_days));
    modified_julian_day -= is_before ? 1 : 0;
    second_of_day = std::chrono::duration<double>(rest).count();
  }

  /// Returns the time of the system clock, rounded to microseconds.
  operator std::chrono::sys_time<std::chrono::microseconds>() const;  // NOLINT: as above

  /// Moves the instant. Throws InputError for steps that are not finite or longer than 1e12 s.
  UtcTime& operator+=(std::chrono::duration<double> step);
  UtcTime& operator-=(std::chrono::duration<double> step);  ///< moves it back

  /// Orders instants; a leap second lies before the first second of the next day.
  [[nodiscard]] auto operator<=>(const UtcTime&) const = default;
};

/// Returns the moved instant. Throws InputError for steps that are not finite or longer than 1e12 s.
[[nodiscard]] UtcTime operator+(const UtcTime& time, std::chrono::duration<double> step);
/// Returns the instant, moved back. Throws InputError as operator+ does.
[[nodiscard]] UtcTime operator-(const UtcTime& time, std::chrono::duration<double> step);
/// Returns the time from the right instant to the left one.
[[nodiscard]] std::chrono::duration<double> operator-(const UtcTime& to, const UtcTime& from);

/// Reads ISO 8601, such as "2026-06-21T04:00:00Z" or "2026-06-21T13:00:00+09:00", years 1900 to
/// 2100. Throws InputError for other texts, for an unknown zone, for a local time that exists twice
/// or not at all, and for a second 60 that was no leap second.
/// @param text  the time.
/// @param zone  IANA name of the zone of a text without an offset, such as "Asia/Tokyo".
[[nodiscard]] UtcTime TimeFromText(std::string_view text, const std::string& zone = "");

/// Returns a text such as "2026-06-21T04:00:00Z", rounded to seconds. Throws InputError for a year
/// outside [1900, 2100].
[[nodiscard]] std::string TextFromTime(const UtcTime& time);

}  // namespace alpenglow
